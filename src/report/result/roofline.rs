//! What each part of the memory system would need for its share of the frame, if nothing else took time.

use super::memory::DramResult;
use super::ratio;
use super::setup::Setup;
use crate::run::Compute;
use crate::sim::replay::Run;
use serde::{Deserialize, Serialize};

/// Bounds of the frame's time from bandwidths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Roofline {
    /// Requests to the L1s, over what their banks, and the ports before them, can take.
    pub l1: Bound,
    /// Requests to the L2, over what its banks, and the crossbar before them, can take.
    pub l2: Bound,
    /// Bytes of memory, over its peak.
    pub dram: Bound,
    /// Which of them is the largest: `l1`, `l2` or `dram`.
    pub largest: String,
}

/// What one part would need.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// Cycles of the cores.
    pub cycles: f64,
    /// The same as a share of the frame; the largest one near 1 says that it limits the frame.
    pub share: f64,
}

impl Roofline {
    pub(super) fn new(setup: &Setup, run: &Run, dram: &DramResult) -> Self {
        let machine = &setup.machine.description;
        let (cores, crossbar) = (&machine.cores, &machine.crossbar);
        let product = |factors: [u32; 2]| factors.into_iter().map(f64::from).product::<f64>();
        let ports = match setup.compute {
            Compute::Free => cores.per_group,
            Compute::Units => machine.units.per_group,
        };
        let l1_rate = product([cores.groups, machine.l1.banks.min(ports)]);
        // A bank takes one request a cycle, whatever it may be handed.
        let l2_rate = f64::from(machine.l2.banks).min(product([cores.groups, crossbar.per_group]));
        let cycles = [
            ("l1", run.counts.l1.requests as f64 / l1_rate),
            ("l2", run.counts.l2.requests as f64 / l2_rate),
            ("dram", dram.bytes as f64 / dram.peak_bytes_per_second * f64::from(cores.clock_mhz) * 1e6),
        ];
        let bound = |k: usize| Bound { cycles: cycles[k].1, share: ratio(cycles[k].1, run.cycles as f64) };
        let largest = cycles.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or("", |part| part.0);
        Self { l1: bound(0), l2: bound(1), dram: bound(2), largest: largest.to_owned() }
    }
}
