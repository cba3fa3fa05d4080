//! What the traversal units did.

use super::ratio::ratio;
use crate::sim::timing::{Phases, STEPS, STRETCH};
use crate::sim::unit::{State, UnitCounts};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// All traversal units together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UnitsResult {
    /// How many there are.
    pub units: u64,
    /// Gate equivalents of one, with its contexts, by the model of areas; none where a block of it was never synthesised.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gate_equivalents: Option<f64>,
    /// By block.
    pub blocks: BTreeMap<String, BlockResult>,
    /// Shares of the cycles of all contexts, by state; states that never were are left out.
    pub states: BTreeMap<String, f64>,
    /// Most hits of a unit that waited for their division at once.
    pub longest_hit_queue: u64,
    /// How full blocks were over time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phases: Option<PhasesResult>,
    /// Cycles of the run if no ray waited for this in any unit (`simulate --ease`, [`Eased`](crate::hardware::Eased)).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub eased: BTreeMap<String, u64>,
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

/// How full the blocks of units were, unit by unit and stretch by stretch. A stretch's load is the share of its cycles in which a block could take nothing, as it had taken something
/// a moment before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PhasesResult {
    /// Cycles of a stretch.
    pub stretch_cycles: u64,
    /// By block; the memory port's is `node_address`.
    pub blocks: BTreeMap<String, BlockPhases>,
    /// Share of the time of all units in which no block had a load of nine tenths or more.
    pub none_full: f64,
}

/// How full a block was.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockPhases {
    /// Load in the mean, 0 to 1.
    pub load: f64,
    /// Share of the time of all units with a load of nine tenths or more.
    pub full: f64,
    /// The least and the largest such share of a unit.
    pub full_of_units: [f64; 2],
    /// Share of the time in which it was the fullest block, with such a load.
    pub fullest: f64,
    /// Shares of the time by load: from each tenth up to the next.
    pub by_load: [f64; STEPS],
}

impl PhasesResult {
    fn new(units: &[Phases]) -> Option<Self> {
        let cycles: u64 = units.iter().map(|unit| unit.cycles).sum();
        let (first, full) = (units.first()?, STEPS - 1);
        let block = |at: usize| {
            let share = |of: &dyn Fn(&Phases) -> u64| ratio(units.iter().map(of).sum::<u64>() as f64, cycles as f64);
            let full_of_units = units.iter().map(|unit| ratio(unit.parts[at].1.by_load[full] as f64, unit.cycles as f64));
            BlockPhases {
                load: share(&|unit| unit.parts[at].1.loaded),
                full: share(&|unit| unit.parts[at].1.by_load[full]),
                full_of_units: full_of_units.fold([1.0, 0.0], |[least, most], of| [f64::min(least, of), f64::max(most, of)]),
                fullest: share(&|unit| unit.parts[at].1.fullest),
                by_load: std::array::from_fn(|step| share(&|unit| unit.parts[at].1.by_load[step])),
            }
        };
        let limited: u64 = units.iter().flat_map(|unit| &unit.parts).map(|part| part.1.fullest).sum();
        let blocks = first.parts.iter().enumerate().map(|(at, (name, _))| ((*name).to_owned(), block(at))).collect();
        Some(Self { stretch_cycles: STRETCH, blocks, none_full: ratio((cycles - limited) as f64, cycles as f64) })
    }
}

impl UnitsResult {
    pub(super) fn new(counts: &UnitCounts, phases: &[Phases], gate_equivalents: Option<f64>) -> Self {
        let units = phases.len() as u64;
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
            gate_equivalents,
            blocks: blocks.collect(),
            states: states.map(|(state, cycles)| (state.name().to_owned(), ratio(cycles as f64, all as f64))).collect(),
            longest_hit_queue: counts.longest_queue as u64,
            phases: PhasesResult::new(phases),
            eased: BTreeMap::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::timing::PartPhases;

    #[test]
    fn shares_are_of_the_time_of_all_units() {
        let part = |loaded, idle, full, fullest| PartPhases { loaded, by_load: [idle, 0, 0, 0, 0, 0, 0, 0, 0, full], fullest };
        let unit = |a, b| Phases { cycles: 100, parts: vec![("a", a), ("b", b)] };
        let units = [unit(part(40, 60, 40, 40), part(10, 90, 10, 10)), unit(part(0, 100, 0, 0), part(30, 70, 30, 30))];
        let result = PhasesResult::new(&units).unwrap();
        let [a, b] = ["a", "b"].map(|name| &result.blocks[name]);
        assert_eq!([a.load, a.full, a.fullest, b.load, b.full], [0.2, 0.2, 0.2, 0.2, 0.2]);
        assert_eq!([a.full_of_units, b.full_of_units], [[0.0, 0.4], [0.1, 0.3]]);
        assert_eq!([a.by_load[0], a.by_load[9], result.none_full], [0.8, 0.2, 0.6]);
        assert_eq!(PhasesResult::new(&[]), None);
    }
}
