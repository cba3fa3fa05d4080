//! Everything counted, over time: what each stretch of cycles added.
//!
//! Every side of a replay counts for itself, and notes what it had counted when a stretch ended; where a stretch may end is the same for all, so that what they noted adds up whatever
//! the partitions are.

use super::counts::{Counts, Earlier};
use crate::block::Operations;
use crate::sim::dram::{ChannelCounts, DramEnergy};

/// Most stretches; when there are more, neighbours become one and stretches twice as long.
const MOST: usize = 256;

/// Cycles of the first stretches.
const FIRST: u64 = 1024;

/// What had been counted when a stretch ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// The cycle in which it ended.
    pub end: u64,
    /// Since the start of the run.
    pub counts: Counts,
    /// All channels, since the start of the run.
    pub channels: ChannelCounts,
    /// The memory's energy since the start of the run.
    pub dram: DramEnergy,
    /// Operations of the blocks since the start of the run, each counted when it is begun; where compute takes no time, when the lines that it waits for are there.
    pub operations: Operations,
}

impl Earlier for Operations {
    fn earlier(&mut self, _: u64) {}
}

/// What one side had counted at the ends of stretches: of those in which it did something after that.
pub struct Series<T> {
    length: u64,
    done: Vec<(u64, T)>,
}

impl<T: Earlier> Series<T> {
    /// None yet.
    pub fn new() -> Self {
        Self { length: FIRST, done: Vec::new() }
    }

    /// The side does something in cycle `next`, behind all that it did before: the end of the stretch before that cycle's, if it is to be noted.
    #[inline]
    pub fn end_before(&self, next: u64) -> Option<u64> {
        let last = self.done.last().map_or(0, |done| done.0);
        (next >= last + self.length).then(|| next / self.length * self.length)
    }

    /// What was counted when a stretch ended.
    pub fn note(&mut self, end: u64, counted: T) {
        self.done.push((end, counted));
        if self.done.len() == MOST {
            self.length *= 2;
            self.coarsen(self.length);
        }
    }

    /// Keeps the ends of stretches of `length` alone: an end that is none becomes the one before, for in between nothing was done.
    fn coarsen(&mut self, length: u64) {
        self.length = length;
        let mut last = 0;
        self.done.retain_mut(|(end, counted)| {
            let late = *end % length;
            *end -= late;
            let is_kept = *end > last;
            if is_kept {
                counted.earlier(late);
                last = *end;
            }
            is_kept
        });
    }

    fn ends(&self) -> impl Iterator<Item = u64> {
        self.done.iter().map(|done| done.0)
    }

    /// What was counted before cycle `end`; `all` was in the end, when nothing waited.
    fn before(&self, end: u64, all: &T) -> T {
        let at = self.done.partition_point(|done| done.0 < end);
        let Some((noted, counted)) = self.done.get(at) else { return all.clone() };
        let mut counted = counted.clone();
        counted.earlier(noted - end);
        counted
    }
}

/// What the side that all groups share counts.
#[derive(Clone)]
pub struct SharedCounts {
    /// Of the L2 and the crossbar.
    pub counts: Counts,
    /// All channels.
    pub channels: ChannelCounts,
    /// The memory's energy.
    pub dram: DramEnergy,
}

impl Earlier for SharedCounts {
    /// (Not the memory: while requests wait there it gives commands, so that no stretch goes by in which nothing happens.)
    fn earlier(&mut self, cycles: u64) {
        self.counts.earlier(cycles);
    }
}

/// The stretches of a run of so many cycles: of each side what it had counted in the end, and over time.
pub fn join(
    groups: &[(Counts, Series<Counts>)],
    shared: (&SharedCounts, &Series<SharedCounts>),
    blocks: &[(Operations, Series<Operations>)],
    cycles: u64,
) -> Vec<Interval> {
    let mut ends: Vec<u64> =
        groups.iter().flat_map(|side| side.1.ends()).chain(shared.1.ends()).chain(blocks.iter().flat_map(|side| side.1.ends())).collect();
    let lengths = groups.iter().map(|side| side.1.length).chain(blocks.iter().map(|side| side.1.length)).chain([shared.1.length]);
    let mut length = lengths.max().unwrap_or(FIRST);
    let mut coarsen = |length: u64| {
        ends.iter_mut().for_each(|end| *end = *end / length * length);
        ends.sort_unstable();
        ends.dedup();
        // A stretch that ended with the last cycle has not seen it.
        ends.retain(|&end| end > 0 && end < cycles);
        ends.len()
    };
    while coarsen(length) >= MOST {
        length *= 2;
    }
    let interval = |end: u64, is_last: bool| {
        let before = if is_last { u64::MAX } else { end };
        let of = shared.1.before(before, shared.0);
        let mut counts = of.counts;
        groups.iter().for_each(|(all, series)| counts.add(&series.before(before, all)));
        let mut operations = Operations::default();
        blocks.iter().for_each(|(all, series)| operations.join(&series.before(before, all)));
        Interval { end, counts, channels: of.channels, dram: of.dram, operations }
    };
    ends.iter().map(|&end| interval(end, false)).chain([interval(cycles, true)]).collect()
}
