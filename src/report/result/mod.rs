//! A run on a machine as figures to read and to compare: everything in it follows from counts, nothing from wall time.
//!
//! - `memory`: caches, crossbar, DRAM and what contexts waited for.
//! - `traffic`: lines by what they hold.
//! - `energy`: the energy model's report, split.
//! - `roofline`: what each part of the machine would need alone.
//! - `stalls`: what contexts did with each of their cycles; `latency`: how long rays and misses took.
//! - `intervals`: the same over time.

mod energy;
mod frames;
mod intervals;
mod latency;
mod memory;
mod ratio;
mod roofline;
mod setup;
mod stalls;
mod traffic;
mod units;

pub use energy::{ComputeEnergy, DramParts, EnergyResult, LeakageEnergy, ReadFill};
pub use frames::{BeforeResult, FrameResult, WarmFrames};
pub use intervals::{IntervalPower, IntervalResult};
pub use latency::{Distribution, LatencyResult};
pub use memory::{CacheResult, ChannelResult, CrossbarResult, DramResult, WaitShares};
#[cfg(test)]
pub(in crate::report) use roofline::LIMITS;
pub use roofline::{Bound, Roofline};
pub use setup::{MachineFacts, MethodFacts, ModelFacts, ModelsFacts, RayFileFacts, SceneFacts, Setup, ViewFacts};
pub use stalls::StallResult;
#[cfg(test)]
pub(in crate::report) use stalls::part_of;
pub use traffic::{KindResult, LevelBytes, TrafficResult};
pub use units::{BlockPhases, BlockResult, PhasesResult, UnitsResult};

use crate::block::FIRST_SHARED;
use crate::hardware::unit_gates;
use crate::machine::MachineError;
use crate::method::{Computing, Registered};
use crate::run::Compute;
use crate::sim::dram::{ChannelCounts, DramPrices};
use crate::sim::energy::{EnergyCounts, EnergyModel};
use crate::sim::replay::{ReplayError, Run, dram_of};
use crate::step::MemoryMap;
use ratio::ratio;
use roofline::{Done, Parts};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// Why a run has no figures.
#[derive(Debug, Error)]
pub enum ResultError {
    /// The energy tables of the machine.
    #[error(transparent)]
    Energy(#[from] MachineError),
    /// The memory of the machine.
    #[error(transparent)]
    Memory(#[from] ReplayError),
}

/// What a frame, or several after one another, took on a machine: figures are of all of them where nothing else is said.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SimResult {
    /// What was run, and on what.
    pub setup: Setup,
    /// Cycles of the cores from the first ray's start to the last one's end.
    pub cycles: u64,
    /// The same in milliseconds.
    pub milliseconds: f64,
    /// Frames in a second.
    pub frames_per_second: f64,
    /// Rays shot.
    pub rays: u64,
    /// Rays that hit.
    pub hits: u64,
    /// Lines asked of the L1s for each ray.
    pub accesses_per_ray: f64,
    /// The L1s, all together.
    pub l1: CacheResult,
    /// The L2.
    pub l2: CacheResult,
    /// Between them.
    pub crossbar: CrossbarResult,
    /// Memory.
    pub dram: DramResult,
    /// What contexts did with their cycles.
    pub waits: WaitShares,
    /// Energy of the frame.
    pub energy: EnergyResult,
    /// Lines and bytes by what they hold.
    pub traffic: TrafficResult,
    /// What the parts of the machine would need alone.
    pub roofline: Roofline,
    /// What contexts did with each of their cycles.
    pub stalls: StallResult,
    /// How long rays and misses took.
    pub latencies: LatencyResult,
    /// The traversal units, if compute takes time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<UnitsResult>,
    /// Operations of the hardware blocks, by block; those that occurred.
    pub operations: BTreeMap<String, u64>,
    /// Frame by frame, where several came after one another, and of a single one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub frames: Vec<FrameResult>,
    /// The mean of the second half of several frames, whose caches hold what the frames before left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warm: Option<WarmFrames>,
    /// Over time; may be left out of tables of many runs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub intervals: Vec<IntervalResult>,
}

impl SimResult {
    /// The figures of `run`, of `method`, whose memory is `map`.
    ///
    /// # Errors
    /// The machine's energy tables or its memory cannot be read.
    ///
    /// # Panics
    /// Steps name operations that the method does not have.
    pub fn new(setup: Setup, method: &Registered, map: &MemoryMap, run: &Run) -> Result<Self, ResultError> {
        let machine = &setup.machine.description;
        let model = EnergyModel::new(machine)?;
        let dram = dram_of(machine)?;
        let seconds = run.cycles as f64 / (f64::from(machine.cores.clock_mhz) * 1e6);
        let counts = &run.counts;
        // Where compute takes no time there are no units.
        let of = Computing { unit: method.unit.filter(|_| setup.compute == Compute::Units), works: method.works };
        let parts = Parts { machine, dram: &dram, compute: setup.compute };
        let hardware = machine.units.config();
        let mut channels = ChannelCounts::default();
        run.channels.iter().for_each(|channel| channels.add(channel));
        let roofline = parts.roofline(&Done { counts, channels: &channels, operations: &run.operations, cycles: run.cycles });
        let intervals = intervals::intervals(&run.intervals, &model, &parts, of);
        let frames = frames::frames(&run.frames, &model, of);
        let dram_prices = DramPrices::new(&dram.device);
        let dram = DramResult::new(run, &dram, seconds);
        let energy_counts = EnergyCounts {
            cycles: run.cycles,
            l1_reads: counts.l1.read(),
            l1_fills: counts.l1.written(),
            l2_reads: counts.l2.read(),
            l2_fills: counts.l2.written(),
            dram_lines: dram.reads + dram.writes,
            operations: run.operations.clone(),
            unit: of.unit,
            works: of.works,
        };
        let l2 = CacheResult::new(&counts.l2, run.cycles).explained(run.l2_causes, machine.l2.lines() / u64::from(machine.l2.ways));
        let unknown: u64 = run.operations.works()[method.works.len()..FIRST_SHARED as usize].iter().sum();
        assert_eq!(unknown, 0, "{}: operations that it does not have", method.name);
        let mut prices = model.prices(&energy_counts);
        let blocks = run.operations.iter().filter(|&(_, n)| n > 0).map(|(o, n)| (hardware.block(o).name().to_owned(), n));
        let works = energy_counts.works().map(|(work, n)| (work.name.to_owned(), n));
        prices.dram = prices.dram_line.is_none().then_some(dram_prices);
        Ok(Self {
            cycles: run.cycles,
            milliseconds: seconds * 1e3,
            frames_per_second: ratio(frames.len() as f64, seconds),
            rays: counts.rays,
            hits: counts.hits,
            accesses_per_ray: ratio(counts.l1.requests as f64, counts.rays as f64),
            l1: CacheResult::of_groups(&counts.l1, run.cycles, &run.l1_banks, machine.cores.groups),
            l2: CacheResult { dirty_lines: run.dirty_lines, ..l2 },
            crossbar: CrossbarResult { request_cycles: counts.crossbar_cycles, answer_cycles: counts.answer_cycles },
            waits: WaitShares::new(&counts.waits, run.units.as_ref(), run.cycles * setup.contexts()),
            energy: EnergyResult::new(&model.report(&energy_counts, &energy::dram_parts(&run.dram)), prices, seconds),
            traffic: TrafficResult::new(map, &counts.traffic, counts.rays),
            roofline,
            stalls: StallResult::new(run, run.cycles * setup.contexts()),
            latencies: (&run.latencies).into(),
            units: run
                .units
                .as_ref()
                .map(|counts| UnitsResult::new(counts, &run.phases, of.unit.and_then(|unit| unit_gates(unit, &hardware)))),
            operations: blocks.chain(works).collect(),
            warm: frames::warm(&frames),
            frames,
            intervals,
            dram,
            setup,
        })
    }
}
