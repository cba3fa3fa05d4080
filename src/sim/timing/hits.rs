//! Hits on their way from the triangle test to the division.

use std::collections::VecDeque;

/// Hits in the order of their tests, from the test on.
#[derive(Clone, Debug, Default)]
pub struct HitQueue {
    /// The first cycle in which a hit is in the RTL's queue, and its context.
    hits: VecDeque<(u64, usize)>,
    /// How many of them, from the front, were in the queue when last looked.
    there: usize,
    longest: usize,
}

impl HitQueue {
    /// A hit of context `who` will be in the queue from cycle `from` on.
    pub fn push(&mut self, from: u64, who: usize) {
        self.hits.push_back((from, who));
    }

    /// Since when the head is in the queue, or will be.
    #[inline]
    pub fn head(&self) -> Option<u64> {
        self.hits.front().map(|hit| hit.0)
    }

    /// Takes the head, if it is there in cycle `now`: since when, and its context.
    #[inline]
    pub fn pop(&mut self, now: u64) -> Option<(u64, usize)> {
        let head = *self.hits.front().filter(|hit| hit.0 <= now)?;
        // The queue grows until something leaves it.
        while self.hits.get(self.there).is_some_and(|hit| hit.0 <= now) {
            self.there += 1;
        }
        self.longest = self.longest.max(self.there);
        self.there -= 1;
        self.hits.pop_front();
        Some(head)
    }

    /// The most hits that waited at once, as far as popped.
    pub fn longest(&self) -> usize {
        self.longest
    }
}
