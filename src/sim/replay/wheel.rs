//! What happens when: a wheel of cycles, and a heap for what is too far ahead for it.
//!
//! Events are of some classes, and those of one class in one cycle happen in the order in which they were entered, so a run depends on nothing else.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Cycles that the wheel sees ahead. (Few: that every slot is still in the caches of the machine we run on is worth more than that no event lies beyond.)
const SLOTS: u64 = 64;

/// Classes of events.
pub const CLASSES: usize = 5;

/// Events of a cycle, by class.
type Lists = [Vec<u32>; CLASSES];

/// Events by cycle; a `u32` each.
pub struct Wheel {
    slots: Vec<Lists>,
    /// Bit k: slot k has events.
    full: u64,
    now: u64,
    /// Events of this cycle, and how many of them have happened.
    current: Lists,
    happened: [usize; CLASSES],
    /// Beyond the wheel: by cycle, then in order of entry, with their classes.
    far: BinaryHeap<Reverse<(u64, u64, usize, u32)>>,
    entered: u64,
}

impl Wheel {
    /// Cycle 0, and nothing to happen.
    pub fn new() -> Self {
        let slots = vec![Lists::default(); SLOTS as usize];
        Self { slots, full: 0, now: 0, current: Lists::default(), happened: [0; CLASSES], far: BinaryHeap::new(), entered: 0 }
    }

    /// This cycle.
    #[inline(always)]
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Enters an event of `cycle`, this one or a later one.
    #[inline]
    pub fn at(&mut self, cycle: u64, class: usize, event: u32) {
        debug_assert!(cycle >= self.now, "cycle {cycle} was before {}", self.now);
        if cycle == self.now {
            self.current[class].push(event);
        } else if cycle - self.now < SLOTS {
            let slot = cycle % SLOTS;
            self.slots[slot as usize][class].push(event);
            self.full |= 1 << slot;
        } else {
            self.far.push(Reverse((cycle, self.entered, class, event)));
            self.entered += 1;
        }
    }

    /// The next event of `class` in this cycle.
    #[inline(always)]
    pub fn take(&mut self, class: usize) -> Option<u32> {
        let event = self.current[class].get(self.happened[class]).copied();
        self.happened[class] += usize::from(event.is_some());
        event
    }

    /// The event of `class` that comes behind `ahead` others, if it is in this cycle.
    #[inline(always)]
    pub fn peek(&self, class: usize, ahead: usize) -> Option<u32> {
        self.current[class].get(self.happened[class] + ahead).copied()
    }

    /// The next cycle with events, after this one.
    pub fn next(&self) -> Option<u64> {
        let near = self.next_near();
        let far = self.far.peek().map(|Reverse((cycle, ..))| *cycle);
        near.into_iter().chain(far).min()
    }

    fn next_near(&self) -> Option<u64> {
        let first = self.now + 1;
        // Slots in the order of their cycles.
        let ahead = self.full.rotate_right((first % SLOTS) as u32);
        (ahead != 0).then(|| first + u64::from(ahead.trailing_zeros()))
    }

    /// Goes to `cycle`; no event may lie between.
    pub fn go(&mut self, cycle: u64) {
        debug_assert!((0..CLASSES).all(|class| self.peek(class, 0).is_none()), "events are left behind");
        debug_assert!(self.next().is_none_or(|next| next >= cycle), "events are passed over");
        self.now = cycle;
        let slot = cycle % SLOTS;
        for (current, later) in self.current.iter_mut().zip(&mut self.slots[slot as usize]) {
            current.clear();
            std::mem::swap(current, later);
        }
        self.happened = [0; CLASSES];
        self.full &= !(1 << slot);
        while let Some(&Reverse((far, _, class, event))) = self.far.peek()
            && far < cycle + SLOTS
        {
            self.far.pop();
            self.at(far, class, event);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_come_by_cycle_and_class_and_in_the_order_of_entry() {
        let mut wheel = Wheel::new();
        let mut expected: Vec<(u64, u32)> = Vec::new();
        for (event, cycle) in [5, 3, 5, 4095, 4096, 100_000, 0, 3, 4100, 100_000, 64, 63].into_iter().enumerate() {
            wheel.at(cycle, event % 2, event as u32);
            expected.push((cycle, event as u32));
        }
        expected.sort_by_key(|&(cycle, event)| (cycle, event % 2));
        let mut happened = Vec::new();
        loop {
            while let Some(event) = wheel.take(0).or_else(|| wheel.take(1)) {
                happened.push((wheel.now(), event));
            }
            let Some(next) = wheel.next() else { break };
            wheel.go(next);
        }
        assert_eq!(happened, expected);
    }

    #[test]
    fn an_event_may_enter_another_of_the_same_cycle() {
        let mut wheel = Wheel::new();
        wheel.at(7, 0, 1);
        wheel.go(7);
        assert_eq!(wheel.take(0), Some(1));
        wheel.at(7, 0, 2);
        assert_eq!((wheel.take(1), wheel.peek(0, 0), wheel.peek(0, 1)), (None, Some(2), None));
        assert_eq!((wheel.take(0), wheel.take(0), wheel.next()), (Some(2), None, None));
    }
}
