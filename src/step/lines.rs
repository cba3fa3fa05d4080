//! Which memory lines a frame touched.

use super::{MAX_SECTIONS, MemoryMap, Step, StepCounts, StepSink};
use std::sync::atomic::{AtomicU64, Ordering};

/// One bit per line of a method's memory; may be marked from many threads.
pub struct LineSets {
    map: MemoryMap,
    words: Vec<AtomicU64>,
}

impl LineSets {
    /// Nothing touched yet.
    pub fn new(map: &MemoryMap) -> Self {
        Self { map: *map, words: (0..map.lines().div_ceil(64)).map(|_| AtomicU64::new(0)).collect() }
    }

    /// Line `line` was read.
    #[inline(always)]
    pub fn mark(&self, line: u32) {
        let word = &self.words[(line / 64) as usize];
        let bit = 1 << (line % 64);
        // Most lines are marked already: reading first keeps the cache line shared.
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }

    /// The lines of a step were read.
    #[inline(always)]
    pub fn mark_step(&self, step: &Step) {
        if let Some(fetch) = step.fetch {
            (fetch.line..fetch.line + fetch.lines).for_each(|line| self.mark(line));
        }
    }

    /// Distinct lines touched, by the place of their section.
    pub fn counts(&self) -> [u64; MAX_SECTIONS] {
        let mut counts = [0; MAX_SECTIONS];
        // A section may be empty: a scene of base triangles alone has no splits.
        for (id, section) in self.map.sections().filter(|(_, section)| section.lines > 0) {
            let first = u64::from(self.map.first(id));
            let words = (first / 64..(first + section.lines).div_ceil(64)).map(|at| {
                // Sections share a word where one ends and the next begins.
                let (from, to) = (first.saturating_sub(64 * at), (first + section.lines - 64 * at).min(64));
                let inside = u64::MAX >> (64 - (to - from)) << from;
                u64::from((self.words[at as usize].load(Ordering::Relaxed) & inside).count_ones())
            });
            counts[id.place()] = words.sum();
        }
        counts
    }
}

/// Counts and marks.
pub struct LineCounter<'a> {
    /// Steps and lines, each time.
    pub counts: StepCounts,
    /// Which lines.
    pub sets: &'a LineSets,
}

impl StepSink for LineCounter<'_> {
    #[inline(always)]
    fn step(&mut self, step: Step) {
        self.sets.mark_step(&step);
        self.counts.step(step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::{Act, Fetch, Section, SectionId};

    #[test]
    fn a_line_counts_once_in_the_set_and_each_time_in_the_total() {
        let map =
            MemoryMap::new(&[("a", 70), ("b", 1), ("c", 200), ("d", 0)].map(|(name, lines)| Section::of_bytes(name, 32 * lines)), None);
        let map = map.unwrap();
        let sets = LineSets::new(&map);
        let mut counter = LineCounter { counts: StepCounts::default(), sets: &sets };
        let [a, b, c] = [0, 1, 2].map(SectionId::new);
        let mut read = |section, line, lines| counter.step(Step::on(Fetch::new(section, map.line(section, line), lines), Act::Fetch));
        [0, 69, 69, 3, 0].into_iter().for_each(|line| read(a, line, 1));
        read(b, 0, 1);
        (0..28).for_each(|k| read(c, 7 * k, 7));
        assert_eq!(sets.counts()[..4], [3, 1, 196, 0]);
        assert_eq!(counter.counts.lines[..4], [5, 1, 196, 0]);
    }
}
