//! What the traversal units did.

use super::ratio::ratio;
use crate::sim::unit::{State, UnitCounts};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// All traversal units together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnitsResult {
    /// How many there are.
    pub units: u64,
    /// By block.
    pub blocks: BTreeMap<String, BlockResult>,
    /// Shares of the cycles of all contexts, by state; states that never were are left out.
    pub states: BTreeMap<String, f64>,
    /// Most hits of a unit that waited for their division at once.
    pub longest_hit_queue: u64,
}

/// A block of all units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockResult {
    /// Operations.
    pub operations: u64,
    /// Share of the cycles in which an operation began.
    pub utilisation: f64,
    /// Share of the cycles with an operation inside.
    pub busy: f64,
    /// Share of the cycles in which a context asked in vain.
    pub refused: f64,
}

impl UnitsResult {
    pub(super) fn new(counts: &UnitCounts, units: u64) -> Self {
        let share = |n: u64| ratio(n as f64, (counts.cycles * units) as f64);
        let blocks = counts.blocks.iter().map(|(name, block)| {
            let result = BlockResult {
                operations: block.taken,
                utilisation: share(block.taken),
                busy: share(block.busy),
                refused: share(block.refused),
            };
            ((*name).to_owned(), result)
        });
        let all: u64 = counts.states.iter().sum();
        let states = State::ALL.iter().zip(counts.states).filter(|&(_, cycles)| cycles > 0);
        Self {
            units,
            blocks: blocks.collect(),
            states: states.map(|(state, cycles)| (state.name().to_owned(), ratio(cycles as f64, all as f64))).collect(),
            longest_hit_queue: counts.longest_queue as u64,
        }
    }
}
