//! Which memory lines a frame touched.

use crate::traverse::{Kind, Probe, RayCounts, Section};
use std::sync::atomic::{AtomicU64, Ordering};

/// One bit per 32-byte line of each section of a method's memory; may be marked from many threads.
pub struct LineSets {
    sets: [Vec<AtomicU64>; Kind::ALL.len()],
}

impl LineSets {
    /// Nothing touched yet.
    pub fn new(sections: &[Section]) -> Self {
        let lines = |kind| sections.iter().filter(|s| s.kind == kind).map(|s| s.lines).sum::<u64>();
        Self { sets: Kind::ALL.map(|kind| (0..lines(kind).div_ceil(64)).map(|_| AtomicU64::new(0)).collect()) }
    }

    #[inline(always)]
    pub(super) fn mark(&self, kind: Kind, line: u64) {
        let word = &self.sets[kind as usize][(line / 64) as usize];
        let bit = 1 << (line % 64);
        // Most lines are marked already: reading first keeps the cache line shared.
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }

    /// Distinct lines touched, by kind.
    pub fn counts(&self) -> [u64; Kind::ALL.len()] {
        let ones = |set: &Vec<AtomicU64>| set.iter().map(|w| u64::from(w.load(Ordering::Relaxed).count_ones())).sum();
        std::array::from_fn(|k| ones(&self.sets[k]))
    }
}

/// Counts and marks.
pub(super) struct LineProbe<'a> {
    pub counts: RayCounts,
    pub sets: &'a LineSets,
}

impl Probe for LineProbe<'_> {
    #[inline(always)]
    fn line(&mut self, kind: Kind, line: u64) {
        self.counts.line(kind, line);
        self.sets.mark(kind, line);
    }
    #[inline(always)]
    fn node(&mut self, met: u32) {
        self.counts.node(met);
    }
    #[inline(always)]
    fn lod_test(&mut self, refine: bool) {
        self.counts.lod_test(refine);
    }
    #[inline(always)]
    fn triangle(&mut self, hit: bool) {
        self.counts.triangle(hit);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_counts_once_in_the_set_and_each_time_in_the_total() {
        let sets = LineSets::new(&[Section { kind: Kind::BoundData, lines: 70 }, Section { kind: Kind::VertexData, lines: 1 }]);
        let mut probe = LineProbe { counts: RayCounts::default(), sets: &sets };
        for line in [0, 69, 69, 3, 0] {
            probe.line(Kind::BoundData, line);
        }
        probe.line(Kind::VertexData, 0);
        assert_eq!(sets.counts(), [0, 0, 3, 1, 0]);
        assert_eq!(probe.counts.lines, [0, 0, 5, 1, 0]);
    }
}
