//! Everything counted, over time: what each stretch of cycles added.

use super::counts::Counts;
use super::hierarchy::Hierarchy;
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
    /// Operations of the blocks since the start of the run: those of a tile's rays count from when the first of them begins.
    pub operations: Operations,
}

/// The stretches so far.
pub struct Intervals {
    length: u64,
    done: Vec<Interval>,
}

impl Intervals {
    /// None yet.
    pub fn new() -> Self {
        Self { length: FIRST, done: Vec::new() }
    }

    /// Ends the stretches that end before `next`, the next cycle in which something happens. Those in which nothing did are left out.
    #[inline]
    pub fn up_to(&mut self, next: u64, memory: &mut Hierarchy, operations: &Operations) {
        let begun = self.done.last().map_or(0, |interval| interval.end);
        if next >= begun + self.length {
            let end = next / self.length * self.length;
            self.note(end, memory, operations);
            if self.done.len() == MOST {
                self.length *= 2;
                let length = self.length;
                self.done.retain(|interval| interval.end % length == 0);
            }
        }
    }

    fn note(&mut self, end: u64, memory: &mut Hierarchy, operations: &Operations) {
        let counts = memory.counts();
        let dram = memory.dram();
        let mut channels = ChannelCounts::default();
        dram.counts().iter().for_each(|channel| channels.add(channel));
        let energy = dram.energy();
        self.done.push(Interval { end, counts, channels, dram: energy, operations: operations.clone() });
    }

    /// All of them, the last one ending now.
    pub fn end(mut self, memory: &mut Hierarchy, operations: &Operations) -> Vec<Interval> {
        let now = memory.now();
        // A stretch that ended with this cycle has not seen it.
        self.done.pop_if(|last| last.end == now);
        self.note(now, memory, operations);
        self.done
    }
}
