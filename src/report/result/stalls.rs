//! What contexts did with each of their cycles.

use super::ratio::ratio;
use crate::sim::replay::{Cause, Run};
use crate::sim::unit::{State, UnitCounts};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Cycles of all contexts by cause: a frame's contexts times its cycles in all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StallResult {
    /// Contexts times cycles.
    pub context_cycles: u64,
    /// By cause: those of a line's way ([`Cause`]); with traversal units also the block that a context waited for or was in, `stack`, and `hit_port`; and `idle`, without a ray.
    pub cycles: BTreeMap<String, u64>,
    /// The largest of them but `idle`.
    pub largest: String,
    /// Its share of the cycles of contexts with rays.
    pub largest_share: f64,
}

/// What a context does in a state, but for waiting for lines.
pub(in crate::report) const fn part_of(state: State) -> &'static str {
    match state {
        State::Idle => "idle",
        State::Setup | State::SetupWait => "ray_setup",
        State::Visit | State::Push | State::Pop => "stack",
        State::Fetch => Cause::NAMES[Cause::Port as usize],
        State::Child | State::ChildWait => "child_test",
        State::Decide | State::DecideWait => "tree_deciders",
        State::Lod | State::LodWait => "lod_test",
        State::Morph | State::MorphWait => "tessellate",
        State::Tri => "tri_test",
        State::DivideV | State::DivideW | State::DivideWait | State::Sum => "hit_divide",
        State::Map | State::MapWait => "bary_map",
        State::Done => "hit_port",
    }
}

impl StallResult {
    pub(super) fn new(run: &Run, context_cycles: u64) -> Self {
        let mut cycles: BTreeMap<String, u64> = BTreeMap::new();
        let mut add = |name: &str, more: u64| {
            if more > 0 {
                *cycles.entry(name.to_owned()).or_default() += more;
            }
        };
        let lines: u64 = run.counts.stalls.iter().sum();
        Cause::NAMES.iter().zip(run.counts.stalls).for_each(|(name, of)| add(name, of));
        match &run.units {
            None => add("idle", context_cycles.saturating_sub(lines)),
            Some(UnitCounts { states, .. }) => {
                // What contexts waited for lines in other states is with the lines.
                for (&state, (&all, &late)) in State::ALL.iter().zip(states.iter().zip(&run.late)) {
                    if state != State::Fetch {
                        add(part_of(state), all - late);
                    }
                }
            }
        }
        let (largest, most) = cycles
            .iter()
            .filter(|(name, _)| *name != "idle")
            .max_by_key(|(_, cycles)| **cycles)
            .map_or((String::new(), 0), |(n, c)| (n.clone(), *c));
        let with_rays = context_cycles - cycles.get("idle").copied().unwrap_or(0).min(context_cycles);
        Self { context_cycles, cycles, largest, largest_share: ratio(most as f64, with_rays as f64) }
    }
}
