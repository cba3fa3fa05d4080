//! The replay: the steps of a frame's rays on a machine, cycle by cycle, driven by events.
//!
//! - `wheel`: what happens when.
//! - `dispatch`: rays, from the functional layer ([`step`](crate::step)), given to groups (`feed`) as they ask; `order`: rays that wait for others.
//! - `cores`: who asks for lines when compute takes no time; `units`: traversal units, who do in the cycles of the RTL; `work_first`: both, where rays wait for work.
//! - `prefetch`: what is read soon.
//! - `event`: what happens, and what others are told of it; `messages`: what the sides tell each other.
//! - `group_side`: groups with their L1s; `shared_side`: crossbar, L2 and memory; `level`, `tags`, `mshr` and `slots` are their parts.
//! - `rounds`: how the sides go on together, on one thread or several.
//! - `intervals`: everything counted, over time; `wave`: a window of cycles as a waveform.
//!
//! A run does not depend on its threads. Frames on several machines are several replays, fed by one functional pass.

mod causes;
mod cores;
mod counts;
mod dispatch;
mod error;
mod event;
mod fed_ray;
mod feed;
mod front_end;
mod group_side;
mod intervals;
mod level;
mod messages;
mod mshr;
mod order;
mod prefetch;
mod rounds;
mod shared_side;
mod slots;
mod stalls;
mod tags;
mod units;
mod wave;
mod wheel;
mod work_first;

#[cfg(test)]
mod tests;

pub use causes::MissCauses;
pub use counts::{CacheCounts, Counts, KindTraffic, Waits};
pub use dispatch::{Chunk, ChunkSource};
pub use error::ReplayError;
pub use intervals::Interval;
pub use rounds::FrameRun;
pub use stalls::{CAUSES, Cause, Histogram, Stalls};
pub use wave::Window;

use super::dram::{ChannelCounts, Device, Dram, DramConfig, DramEnergy};
use super::timing::Phases;
use super::unit::{State, UnitCounts};
use crate::block::Operations;
use crate::machine::Machine;
use crate::step::Nodes;
use cores::FreeCores;
use dispatch::Dispatcher;
use front_end::FrontEnd;
use rounds::Partition;
use shared_side::SharedSide;
use std::sync::Mutex;
use units::Units;
use wave::Wave;
use work_first::WorkThenRays;

/// Latencies in cycles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Latencies {
    /// Of rays, from their start to their end.
    pub rays: Histogram,
    /// Of misses of the L1s, from the look-up to the line.
    pub l1_misses: Histogram,
    /// The same of the L2.
    pub l2_misses: Histogram,
}

/// How to run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Running {
    /// The cycles of which a waveform is wanted: one thread alone.
    pub window: Option<Window>,
    /// Threads, of which the run does not depend; at least 1.
    pub threads: usize,
}

impl Default for Running {
    fn default() -> Self {
        Self { window: None, threads: 1 }
    }
}

/// What a run gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Cycles from the first ray's start to the last one's end, of all frames.
    pub cycles: u64,
    /// What was counted.
    pub counts: Counts,
    /// Operations of the blocks.
    pub operations: Operations,
    /// What the traversal units did, all together; none if compute takes no time.
    pub units: Option<UnitCounts>,
    /// How full the parts of each of them were.
    pub phases: Vec<Phases>,
    /// Cycles of the units' contexts, by state, in which they waited for lines, but for `FETCH`.
    pub late: [u64; State::ALL.len()],
    /// Cycles of rays and of misses.
    pub latencies: Latencies,
    /// Requests that each bank of the L1s looked up.
    pub l1_banks: Vec<u64>,
    /// Why the L2 missed; different lines that fall into its busiest set, and into all.
    pub l2_causes: (MissCauses, (u64, u64)),
    /// Lines that the L2 had and memory had not at the end.
    pub dirty_lines: u64,
    /// What each memory channel did.
    pub channels: Vec<ChannelCounts>,
    /// Requests to each bank of the memory.
    pub dram_banks: Vec<u64>,
    /// Command clocks of the memory.
    pub dram_clocks: u64,
    /// The memory's energy.
    pub dram: DramEnergy,
    /// The frames, one after another.
    pub frames: Vec<FrameRun>,
    /// The same over time.
    pub intervals: Vec<Interval>,
    /// The waveform of the window asked for.
    pub wave: Option<Vec<u8>>,
}

/// The memory of a machine.
///
/// # Errors
/// Its description cannot be read or is impossible.
pub fn dram_of(machine: &Machine) -> Result<DramConfig, ReplayError> {
    let (text, file) = machine.read(&machine.dram.device)?;
    let device = Device::from_toml(&text).map_err(|source| ReplayError::Dram { file: file.clone(), source })?;
    let mut config = DramConfig::new(device, machine.dram.channels);
    if let Some(mapping) = &machine.dram.mapping {
        config.mapping.clone_from(mapping);
    }
    config.controller.read_queue = machine.dram.queue as u16; // at most 4096
    (config.controller.scheduler, config.controller.hit_cap) = (machine.dram.scheduler, machine.dram.hit_cap);
    config.validate().map_err(|source| ReplayError::Dram { file, source })?;
    Ok(config)
}

/// Refuses what [`run_free`], or [`run_units`] if there are `units`, would refuse of a machine before the first ray.
///
/// # Errors
/// The machine is impossible or too large.
pub fn check(machine: &Machine, units: bool) -> Result<(), ReplayError> {
    if units && machine.cores.pinned_nodes > 0 {
        return Err(ReplayError::PinnedNodes(machine.cores.pinned_nodes));
    }
    check_size(machine, units)?;
    Dram::check(&dram_of(machine)?).map_err(|source| ReplayError::Dram { file: machine.dram.device.clone(), source })
}

/// Runs the rays of `source`, which begin with `nodes`, on `machine`; compute takes no time.
///
/// # Errors
/// The machine is impossible or too large, or nothing happens any more while rays are under way.
pub fn run_free(machine: &Machine, nodes: Nodes, source: impl ChunkSource, how: Running) -> Result<Run, ReplayError> {
    check(machine, false)?;
    let make = |part: &Machine, first| FreeCores::<0>::new(part, first, nodes);
    Ok(drive(make, machine, cores::contexts_of_group(machine), source, how)?.0)
}

/// The same with traversal units that take the cycles of the RTL.
///
/// # Errors
/// As [`run_free`].
pub fn run_units(machine: &Machine, source: impl ChunkSource, how: Running) -> Result<Run, ReplayError> {
    check(machine, true)?;
    let (run, fronts) = drive(Units::new, machine, units::contexts_of_group(machine), source, how)?;
    Ok(with_units(run, &fronts))
}

/// The same where rays wait for work before their frame: the groups' cores do it, whose compute takes no time, and the units the rays.
///
/// # Errors
/// As [`run_free`].
pub fn run_work_then_units(machine: &Machine, nodes: Nodes, source: impl ChunkSource, how: Running) -> Result<Run, ReplayError> {
    check(machine, true)?;
    check_size(machine, false)?;
    let count = u64::from(machine.cores.groups) * u64::from(machine.units.per_group);
    if count > work_first::MOST_UNITS {
        return Err(ReplayError::TooLarge { what: "traversal units behind work before a frame", most: work_first::MOST_UNITS, count });
    }
    let make = |part: &Machine, first| WorkThenRays::new(part, first, nodes);
    let (run, fronts) = drive(make, machine, units::contexts_of_group(machine), source, how)?;
    Ok(with_units(run, fronts.iter().map(|front| &front.units)))
}

/// What the units did besides.
fn with_units<'a>(run: Run, all: impl IntoIterator<Item = &'a Units>) -> Run {
    let mut run = Run { units: Some(UnitCounts::default()), ..run };
    for units in all {
        if let Some(sum) = &mut run.units {
            sum.add(&units.counts(run.cycles));
        }
        run.phases.extend(units.phases(run.cycles));
        let (late, port) = units.line_waits();
        run.late.iter_mut().zip(late).for_each(|(sum, cycles)| *sum += cycles);
        run.counts.stalls[Cause::Port as usize] += port;
    }
    run
}

/// Runs the rays of `source` on `machine` with a front end for each partition of its groups, which have so many contexts each. Gives the front ends too.
fn drive<F: FrontEnd + Send>(
    make: impl Fn(&Machine, u32) -> F,
    machine: &Machine,
    contexts: u32,
    source: impl ChunkSource,
    how: Running,
) -> Result<(Run, Vec<F>), ReplayError> {
    let dram = dram_of(machine)?;
    let reply = SharedSide::reply(machine, &dram);
    let mut shared = SharedSide::new(machine, &dram).map_err(|source| ReplayError::Dram { file: machine.dram.device.clone(), source })?;
    let mut dispatcher = Dispatcher::new(source, machine.cores.groups, contexts, u64::from(machine.l1.latency_cycles) + reply);
    let threads = if how.window.is_some() { 1 } else { how.threads.max(1) };
    let half = (machine.cores.groups as usize * contexts as usize).div_ceil(2);
    let partitions = partitions(machine, threads, half, make);
    let mut wave = how.window.map(Wave::new);
    let frames = rounds::run(machine, &partitions, &mut shared, reply, &mut dispatcher, threads, half, wave.as_mut())?;
    let cycles = frames.last().map_or(0, |frame| frame.end.end);

    let (mut fronts, mut of_groups, mut of_blocks) = (Vec::new(), Vec::new(), Vec::new());
    let mut operations = Operations::default();
    let (mut latencies, mut l1_banks) = (Latencies::default(), Vec::new());
    for partition in partitions {
        let Partition { front, side, operations: over_time, .. } = partition.into_inner().expect("a replay's thread has panicked");
        let (rays, misses, looked_up) = side.distributions();
        latencies.rays.join(rays);
        latencies.l1_misses.join(misses);
        l1_banks.extend(looked_up);
        of_groups.push((side.counts(), side.over_time));
        operations.join(&front.operations());
        of_blocks.push((front.operations(), over_time));
        fronts.push(front);
    }
    latencies.l2_misses = shared.latencies().clone();
    let of_shared = shared.counts();
    let mut counts = of_shared.counts;
    of_groups.iter().for_each(|side| counts.add(&side.0));
    let (channels, dram_clocks, dram) = (shared.dram().counts(), shared.dram().clocks(), shared.dram().energy());
    let intervals = intervals::join(&of_groups, (&of_shared, &shared.over_time), &of_blocks, cycles);
    let run = Run {
        cycles,
        l2_causes: shared.l2_causes(),
        dirty_lines: shared.dirty_lines(),
        channels,
        dram_banks: shared.dram().requests_of_banks(),
        dram_clocks,
        dram,
        counts,
        operations,
        units: None,
        phases: Vec::new(),
        late: [0; State::ALL.len()],
        latencies,
        l1_banks,
        frames,
        intervals,
        wave: wave.map(Wave::into_bytes),
    };
    Ok((run, fronts))
}

/// The groups of `machine`, divided into at most so many partitions, of each of which the last `ends` of its rays are kept.
fn partitions<F: FrontEnd>(machine: &Machine, most: usize, ends: usize, make: impl Fn(&Machine, u32) -> F) -> Vec<Mutex<Partition<F>>> {
    let groups = machine.cores.groups;
    let count = groups.min(most as u32);
    let first = |partition: u32| (u64::from(partition) * u64::from(groups) / u64::from(count)) as u32; // at most `groups`
    let partition = |at: u32| {
        let mut part = machine.clone();
        part.cores.groups = first(at + 1) - first(at);
        Mutex::new(Partition::new(make(&part, first(at)), &part, first(at), ends))
    };
    (0..count).map(partition).collect()
}

/// Events name contexts, cores and miss registers by 28 bits.
fn check_size(machine: &Machine, units: bool) -> Result<(), ReplayError> {
    let product = |factors: &[u32]| factors.iter().map(|&f| u64::from(f)).product::<u64>();
    let (cores, l1, l2) = (&machine.cores, &machine.l1, &machine.l2);
    let sizes = [
        if units {
            ("traversal units", product(&[cores.groups, machine.units.per_group]), units::MOST_UNITS)
        } else {
            ("rays in flight", product(&[cores.groups, cores.per_group, cores.rays_in_flight]), 1 << 22)
        },
        ("miss registers of the L1s", product(&[cores.groups, l1.banks, l1.mshrs]), 1 << 26),
        ("lines of the L1s", cores.groups as u64 * l1.lines(), 1 << 30),
        ("miss registers of the L2", product(&[l2.banks, l2.mshrs]), 1 << 26),
    ];
    match sizes.into_iter().find(|&(_, count, most)| count > most) {
        Some((what, count, most)) => Err(ReplayError::TooLarge { what, most, count }),
        None => Ok(()),
    }
}
