//! The replay: the steps of a frame's rays on a machine, cycle by cycle, driven by events.
//!
//! - `wheel`: what happens when.
//! - `feed`: rays, from the functional layer ([`step`](crate::step)).
//! - `cores`: who asks for lines when compute takes no time; `units`: traversal units, who do in the cycles of the RTL.
//! - `prefetch`: what is read soon.
//! - `event`: what happens, and what others are told of it.
//! - `hierarchy`: L1s, crossbar, L2 and memory; `level`, `tags`, `mshr` and `slots` are its parts.
//! - `intervals`: everything counted, over time; `wave`: a window of cycles as a waveform.
//!
//! One thread runs a replay; frames on several machines are several replays, fed by one functional pass.

mod cores;
mod counts;
mod error;
mod event;
mod feed;
mod hierarchy;
mod intervals;
mod level;
mod mshr;
mod prefetch;
mod slots;
mod stalls;
mod tags;
mod units;
mod wave;
mod wheel;

#[cfg(test)]
mod tests;

pub use counts::{CacheCounts, Counts, KindTraffic, Waits};
pub use error::ReplayError;
pub use feed::{Chunk, ChunkSource};
pub use hierarchy::Latencies;
pub use intervals::Interval;
pub use stalls::{CAUSES, Cause, Histogram, Stalls};
pub use wave::Window;

use super::dram::{ChannelCounts, Device, Dram, DramConfig, DramEnergy};
use super::unit::{State, UnitCounts};
use crate::block::Operations;
use crate::machine::Machine;
use crate::step::Nodes;
use cores::FreeCores;
use event::Happening;
use hierarchy::Hierarchy;
use intervals::Intervals;
use units::Units;
use wave::Wave;

/// What a run gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Cycles from the first ray's start to the last one's end.
    pub cycles: u64,
    /// What was counted.
    pub counts: Counts,
    /// Operations of the blocks.
    pub operations: Operations,
    /// What the traversal units did, all together; none if compute takes no time.
    pub units: Option<UnitCounts>,
    /// Cycles of the units' contexts, by state, in which they waited for lines, but for `FETCH`.
    pub late: [u64; State::ALL.len()],
    /// Cycles of rays and of misses.
    pub latencies: Latencies,
    /// Requests that each bank of the L1s looked up.
    pub l1_banks: Vec<u64>,
    /// What each memory channel did.
    pub channels: Vec<ChannelCounts>,
    /// Command clocks of the memory.
    pub dram_clocks: u64,
    /// The memory's energy.
    pub dram: DramEnergy,
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
    let dram = Dram::new(&dram_of(machine)?);
    dram.map(|_| ()).map_err(|source| ReplayError::Dram { file: machine.dram.device.clone(), source })
}

/// Runs the rays of `source`, which begin with `nodes`, on `machine`; compute takes no time.
///
/// # Errors
/// The machine is impossible or too large, or nothing happens any more while rays are under way.
pub fn run_free(machine: &Machine, nodes: Nodes, source: impl ChunkSource, window: Option<Window>) -> Result<Run, ReplayError> {
    check(machine, false)?;
    let mut cores = FreeCores::new(&machine.cores, nodes, source);
    drive(&mut cores, machine, window)
}

/// The same with traversal units that take the cycles of the RTL.
///
/// # Errors
/// As [`run_free`].
pub fn run_units(machine: &Machine, source: impl ChunkSource, window: Option<Window>) -> Result<Run, ReplayError> {
    check(machine, true)?;
    let mut units = Units::new(machine, source);
    let mut run = drive(&mut units, machine, window)?;
    let (late, port) = units.line_waits();
    run.counts.stalls[Cause::Port as usize] += port;
    Ok(Run { units: Some(units.counts(run.cycles)), late, ..run })
}

/// Who asks the memory hierarchy for lines.
trait FrontEnd {
    /// Of how many waiters at once the way of the last line is kept, and where each one's is.
    fn slots(&self) -> (usize, fn(u32) -> usize);
    /// Begins, in cycle 0.
    fn start(&mut self, memory: &mut Hierarchy);
    /// The cycle it asked for has come, or its held request was taken.
    fn wake(&mut self, id: u32, memory: &mut Hierarchy);
    /// `waiter`'s line comes from the L1 in `cycle`.
    fn comes(&mut self, waiter: u32, cycle: u64, memory: &mut Hierarchy) {
        memory.answer_at(cycle, waiter, counts::Supplier::L1);
    }
    /// What happens soon to those, far ahead and near, is like `happening`.
    fn prefetch(&self, _happening: Happening, _soon: [Option<u32>; 2]) {}
    /// A line came for `waiter`.
    fn answer(&mut self, waiter: u32, from: counts::Supplier, memory: &mut Hierarchy);
    /// What the rays of tiles begun have the hardware blocks do.
    fn operations(&self) -> &Operations;
    /// Rays are under way.
    fn is_busy(&self) -> bool;
    /// What it does, for error messages.
    fn describe(&self) -> String;
}

/// Lets `front` run on `machine` until it is done.
fn drive(front: &mut impl FrontEnd, machine: &Machine, window: Option<Window>) -> Result<Run, ReplayError> {
    let dram = dram_of(machine)?;
    let mut memory =
        Hierarchy::new(machine, &dram, front.slots()).map_err(|source| ReplayError::Dram { file: machine.dram.device.clone(), source })?;
    let mut intervals = Intervals::new();
    let mut wave = window.map(Wave::new);
    front.start(&mut memory);
    loop {
        while let Some(happening) = memory.take() {
            front.prefetch(happening, memory.soon(happening));
            match happening {
                Happening::Wake(id) => front.wake(id, &mut memory),
                Happening::Comes(waiter, cycle) => front.comes(waiter, cycle, &mut memory),
                Happening::Answer(waiter, from) => front.answer(waiter, from, &mut memory),
            }
        }
        let is_busy = front.is_busy();
        let next = if is_busy { memory.next() } else { None };
        if let Some(wave) = &mut wave {
            wave.sample(&memory, &machine.cores, next)?;
        }
        if !is_busy {
            break;
        }
        let Some(next) = next else {
            let state = format!("{}\n{}", front.describe(), memory.describe());
            return Err(ReplayError::Deadlock { cycle: memory.now(), state });
        };
        intervals.up_to(next, &mut memory, front.operations());
        memory.go(next);
    }
    let cycles = memory.now();
    let intervals = intervals.end(&mut memory, front.operations());
    let (latencies, l1_banks) = memory.distributions();
    let dram = memory.dram();
    let (channels, dram_clocks, dram) = (dram.counts(), dram.clocks(), dram.energy());
    Ok(Run {
        cycles,
        channels,
        dram_clocks,
        dram,
        counts: memory.counts(),
        operations: front.operations().clone(),
        units: None,
        late: [0; State::ALL.len()],
        latencies,
        l1_banks,
        intervals,
        wave: wave.map(Wave::into_bytes),
    })
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
