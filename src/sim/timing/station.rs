//! The time of a block: what it takes when, and what is reported of it.

use crate::block::Timing;
use crate::sim::unit::BlockCounts;

/// A block whose results always have a taker.
#[derive(Clone, Debug)]
pub struct Station {
    timing: Timing,
    /// The first cycle in which it takes an input again.
    free: u64,
    /// The cycle behind the last input.
    behind: u64,
    /// The last cycle with an item inside.
    drained: u64,
    /// Cycles in which it takes nothing, as it took something before; those behind the last input.
    loaded: u64,
    last: u64,
    /// It takes any number of inputs in a cycle.
    eased: bool,
    counts: BlockCounts,
}

impl Station {
    /// An empty block.
    pub fn new(timing: Timing) -> Self {
        Self { timing, free: 0, behind: 0, drained: 0, loaded: 0, last: 0, eased: false, counts: BlockCounts::default() }
    }

    /// The same one, which takes any number of inputs in a cycle.
    pub fn eased(self) -> Self {
        Self { eased: true, ..self }
    }

    /// The same one, which has each result a cycle later.
    pub fn at_once(self) -> Self {
        Self { timing: self.timing.at_once(), ..self }
    }

    /// It takes any number of inputs in a cycle.
    pub fn is_eased(&self) -> bool {
        self.eased
    }

    /// Cycles from an input to its result.
    pub fn latency(&self) -> u64 {
        u64::from(self.timing.latency)
    }

    /// The first cycle in which it takes an input.
    pub fn free(&self) -> u64 {
        self.free
    }

    /// Takes an input in cycle `now`; inputs were offered from `since` on, if not since before the last; gives the cycle of its result.
    #[inline]
    pub fn take(&mut self, since: u64, now: u64) -> u64 {
        self.take_for(self.timing, since, now)
    }

    /// The same with another timing.
    #[inline]
    pub fn take_for(&mut self, timing: Timing, since: u64, now: u64) -> u64 {
        let left = now + u64::from(timing.latency);
        self.begin(timing.interval, since, now);
        self.inside(now, left);
        left
    }

    /// Takes an input whose time inside is not known yet.
    #[inline]
    pub fn enter(&mut self, since: u64, now: u64) {
        self.begin(self.timing.interval, since, now);
    }

    #[inline(always)]
    fn begin(&mut self, interval: u32, since: u64, now: u64) {
        if !self.eased {
            self.last = u64::from(interval);
            self.free = now + self.last;
            self.loaded += self.last;
        }
        self.counts.taken += 1;
        // Of what is offered it takes one as soon as it can; several in a cycle wait for none.
        self.counts.refused += now.saturating_sub(since.max(self.behind));
        self.behind = now + 1;
    }

    /// An item taken in cycle `taken` leaves in cycle `left`.
    #[inline]
    pub fn inside(&mut self, taken: u64, left: u64) {
        self.counts.busy += left.saturating_sub(self.drained.max(taken));
        self.counts.occupancy += left - taken;
        self.drained = self.drained.max(left);
    }

    /// Cycles before cycle `end` in which it took nothing, as it had taken something before; nothing was taken since.
    pub fn loaded(&self, end: u64) -> u64 {
        self.loaded - self.free.saturating_sub(end).min(self.last)
    }

    /// What it did so far, with what is inside counted to its end.
    pub fn counts(&self) -> BlockCounts {
        self.counts
    }
}
