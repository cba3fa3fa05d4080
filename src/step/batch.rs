//! Rays as their steps. Which lines a ray reads does not depend on when they come, so rays are traced once, in parallel, and their steps replayed on any number
//! of machines.

use super::{Act, Moved, Step, StepSink, StepWord};

/// Rays that a group of cores takes at once: a tile of the picture, or 64 of a file.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    words: Box<[StepWord]>,
    /// Where each ray's steps end.
    ends: Box<[u32]>,
    /// Number of each ray and of the one behind whose end it starts; empty if no ray of the frame waits for another.
    links: Box<[Link]>,
    /// They are no rays, but work before a frame.
    is_work: bool,
}

/// A ray's place among all rays of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// Its number.
    pub number: u64,
    /// The earlier ray behind whose end it starts, by its number.
    pub after: Option<u64>,
}

impl Batch {
    /// A batch of these rays.
    pub fn new(rays: &[Vec<Step>]) -> Self {
        let mut recorder = Recorder::default();
        rays.iter().flatten().for_each(|&step| recorder.step(step));
        recorder.batch()
    }

    /// Number of ray `ray`, and what it starts behind; `None` if no ray of the frame waits for another.
    #[inline(always)]
    pub fn link(&self, ray: usize) -> Option<Link> {
        self.links.get(ray).copied()
    }

    /// Numbers its rays from `first` on, as they were from 0.
    pub fn number_from(&mut self, first: u64) {
        for link in &mut self.links {
            link.number += first;
            link.after = link.after.map(|after| after + first);
        }
    }

    /// The same with all lines moved.
    #[must_use]
    pub fn moved(mut self, by: &Moved) -> Self {
        for word in &mut self.words {
            *word = StepWord::pack(by.step(word.step()));
        }
        self
    }

    /// They are no rays, but pieces of work before a frame: nothing is set up for them, and none is counted as a ray.
    pub fn is_work(&self) -> bool {
        self.is_work
    }

    /// Number of rays.
    pub fn rays(&self) -> usize {
        self.ends.len()
    }

    /// The steps of all rays.
    #[inline(always)]
    pub fn words(&self) -> &[StepWord] {
        &self.words
    }

    /// Where the steps of ray `ray` end.
    #[inline(always)]
    pub fn end(&self, ray: usize) -> u32 {
        self.ends[ray]
    }

    /// Where the steps of ray `ray` begin; they end with [`Act::End`].
    #[inline(always)]
    pub fn start(&self, ray: usize) -> u32 {
        ray.checked_sub(1).map_or(0, |before| self.ends[before])
    }
}

/// Keeps the steps of rays, one ray after the other.
#[derive(Debug, Default)]
pub struct Recorder {
    words: Vec<StepWord>,
    ends: Vec<u32>,
    links: Vec<Link>,
}

impl Recorder {
    /// The next ray is `link`; told of every ray of a frame in which some wait for others, or of none.
    pub fn link(&mut self, link: Link) {
        self.links.push(link);
    }

    /// The rays so far, in as little memory as they take.
    ///
    /// # Panics
    /// The last ray has no [`Act::End`], or some have links and others none.
    pub fn batch(self) -> Batch {
        assert_eq!(self.ends.last().map_or(0, |&end| end as usize), self.words.len(), "a ray without its end");
        assert!(self.links.is_empty() || self.links.len() == self.ends.len(), "a ray without its link");
        Batch { words: self.words.into(), ends: self.ends.into(), links: self.links.into(), is_work: false }
    }

    /// The same, of pieces of work before a frame in place of rays.
    pub fn work(self) -> Batch {
        Batch { is_work: true, ..self.batch() }
    }
}

impl StepSink for Recorder {
    #[inline(always)]
    fn step(&mut self, step: Step) {
        self.words.push(StepWord::pack(step));
        if let Act::End { .. } = step.act {
            self.ends.push(u32::try_from(self.words.len()).expect("a batch has fewer than 2^32 steps"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_are_told_apart_by_their_ends() {
        let pop = Step::of(Act::Pop { dropped: true });
        let rays = [vec![pop, pop, Step::end(true, false)], vec![Step::end(false, false)], vec![pop, Step::end(false, true)]];
        let batch = Batch::new(&rays);
        assert_eq!((batch.rays(), batch.words().len()), (3, 6));
        for (k, ray) in rays.iter().enumerate() {
            let words = &batch.words()[batch.start(k) as usize..batch.end(k) as usize];
            assert_eq!(words.iter().map(|word| word.step()).collect::<Vec<_>>(), *ray);
        }
    }

    #[test]
    #[should_panic(expected = "a ray without its end")]
    fn a_ray_without_an_end_is_refused() {
        Batch::new(&[vec![Step::of(Act::Pop { dropped: false })]]);
    }
}
