//! What a unit did, as the cycle model reports it.

use super::unit::UnitTiming;
use crate::sim::unit::{State, UnitCounts};

impl<R> UnitTiming<R> {
    /// What it did in its first `cycles` cycles, behind which all contexts are idle. While rays are under way, the counts run ahead to where each is asked next.
    pub fn counts(&self, cycles: u64) -> UnitCounts {
        let blocks = self.named().into_iter().map(|(name, _, station)| (name, station.counts())).collect();
        let mut states = self.states;
        let busy: u64 = states.iter().sum();
        states[State::Idle as usize] = (cycles * self.contexts.len() as u64).saturating_sub(busy);
        UnitCounts { cycles, states, blocks, longest_queue: self.hits.longest() }
    }
}
