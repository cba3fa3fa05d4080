//! Caches, crossbar and DRAM, and what contexts waited for.

use super::ratio::ratio;
use crate::num::LINE_BYTES;
use crate::sim::dram::{ChannelCounts, DramConfig};
use crate::sim::replay::{CacheCounts, MissCauses, Run, Waits};
use crate::sim::unit::{State, UnitCounts};
use serde::{Deserialize, Serialize};

/// What few methods do is not in results of all others.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
pub(super) fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// A level of cache.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CacheResult {
    /// Requests looked up: hits, misses, merges and stores.
    pub requests: u64,
    /// Found.
    pub hits: u64,
    /// Not found: asked of the next level.
    pub misses: u64,
    /// Not found, but asked for already.
    pub merges: u64,
    /// Hits of all requests.
    pub hit_rate: f64,
    /// Lines written that were read from the next level.
    pub fills: u64,
    /// Requests to write a line, of methods that write.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub stores: u64,
    /// Lines that stores have written here.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub updates: u64,
    /// Written lines that memory did not have at the end.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub dirty_lines: u64,
    /// Written lines that went on to memory to make room.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub write_backs: u64,
    /// Requests that waited for their bank.
    pub conflicts: u64,
    /// Their cycles.
    pub queued_cycles: u64,
    /// Cycles of banks that could not go on for want of a miss register.
    pub blocked_cycles: u64,
    /// Cycles of requesters whose bank's queue was full.
    pub refused_cycles: u64,
    /// Miss registers in use, and requests that waited in queues, in the mean over the frame, all banks together.
    pub mean_registers: f64,
    #[expect(missing_docs, reason = "above")]
    pub mean_queue: f64,
    /// Most of both that a bank had at once.
    pub most_registers: u64,
    #[expect(missing_docs, reason = "above")]
    pub longest_queue: u64,
    /// Requests of the busiest bank over the mean of all, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub busiest_bank_over_mean: Option<f64>,
    /// The same of groups.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub busiest_group_over_mean: Option<f64>,
    /// Different lines of the busiest set over the mean of all, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub busiest_set_over_mean: Option<f64>,
    /// Misses by their cause, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub causes: Option<MissCauses>,
}

impl CacheResult {
    /// What a level did in `cycles`.
    pub(super) fn new(counts: &CacheCounts, cycles: u64) -> Self {
        let CacheCounts { requests, hits, misses, merges, fills, conflicts, queued_cycles, refused_cycles, blocked_cycles, .. } = *counts;
        let CacheCounts { register_cycles, most_registers, longest_queue, stores, updates, write_backs, .. } = *counts;
        Self {
            requests,
            hits,
            misses,
            merges,
            hit_rate: ratio(hits as f64, requests as f64),
            fills,
            stores,
            updates,
            write_backs,
            dirty_lines: 0,
            conflicts,
            queued_cycles,
            blocked_cycles,
            refused_cycles,
            mean_registers: ratio(register_cycles as f64, cycles as f64),
            mean_queue: ratio(queued_cycles as f64, cycles as f64),
            most_registers,
            longest_queue,
            busiest_bank_over_mean: None,
            busiest_group_over_mean: None,
            busiest_set_over_mean: None,
            causes: None,
        }
    }

    /// The same of the L2 of so many sets, with why it missed, and different lines of the busiest set and of all.
    pub(super) fn explained(self, (causes, (busiest, all)): (MissCauses, (u64, u64)), sets: u64) -> Self {
        Self { busiest_set_over_mean: Some(ratio((busiest * sets) as f64, all as f64)), causes: Some(causes), ..self }
    }

    /// The same of the L1s, of which each of `groups` has its banks among `looked_up`.
    pub(super) fn of_groups(counts: &CacheCounts, cycles: u64, looked_up: &[u64], groups: u32) -> Self {
        let of_group: Vec<u64> = looked_up.chunks(looked_up.len() / groups as usize).map(|banks| banks.iter().sum()).collect();
        let (bank, group) = (Some(over_mean(looked_up)), Some(over_mean(&of_group)));
        Self { busiest_bank_over_mean: bank, busiest_group_over_mean: group, ..Self::new(counts, cycles) }
    }
}

/// The largest over the mean of all.
fn over_mean(each: &[u64]) -> f64 {
    let (most, all) = (each.iter().max().copied().unwrap_or(0), each.iter().sum::<u64>());
    ratio((most * each.len() as u64) as f64, all as f64)
}

/// Waits for the crossbar's ports, in cycles summed over misses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrossbarResult {
    /// Of misses on their way to the L2.
    pub request_cycles: u64,
    /// Of answers on their way back.
    pub answer_cycles: u64,
}

/// Memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DramResult {
    /// Name of the device.
    pub device: String,
    /// Lines read.
    pub reads: u64,
    /// Lines written.
    pub writes: u64,
    /// Requests that found their row open.
    pub row_hits: u64,
    /// Requests that found their bank closed.
    pub row_misses: u64,
    /// Requests for which another row had to be closed.
    pub row_conflicts: u64,
    /// Refreshes.
    pub refreshes: u64,
    /// Activates, and precharges of single banks and of those open when all of a rank are closed.
    pub activates: u64,
    #[expect(missing_docs, reason = "above")]
    pub precharges: u64,
    /// Command clocks of the frame, and picoseconds of one.
    pub clocks: u64,
    #[expect(missing_docs, reason = "above")]
    pub clock_picoseconds: u64,
    /// Clocks with data on the bus, summed over the channels.
    pub bus_clocks: u64,
    /// Clocks with a bank active or in refresh, summed over the ranks of all channels; and of them, and of the others, those in power-down.
    pub active_clocks: u64,
    #[expect(missing_docs, reason = "above")]
    pub active_down_clocks: u64,
    #[expect(missing_docs, reason = "above")]
    pub precharged_down_clocks: u64,
    /// The other clocks, with all banks precharged and no power-down.
    pub precharged_clocks: u64,
    /// Requests that waited, in the mean over the frame, all channels together.
    pub mean_queue: f64,
    /// Bytes read and written.
    pub bytes: u64,
    /// The same in a second.
    pub bytes_per_second: f64,
    /// Most bytes in a second, of all channels.
    pub peak_bytes_per_second: f64,
    /// How much of it was used.
    pub bandwidth_share: f64,
    /// Mean nanoseconds from a request's arrival to its command.
    pub mean_queue_nanoseconds: f64,
    /// Cycles of misses of the L2 that waited for room in a channel's queue.
    pub refused_cycles: u64,
    /// Bytes of the busiest channel over the mean of all; 1 is balanced.
    pub busiest_over_mean: f64,
    /// Requests to the busiest bank over the mean of all, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub busiest_bank_over_mean: Option<f64>,
    /// Rows opened for a thousand requests, where that is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub activates_per_thousand: Option<f64>,
    /// Channel by channel.
    pub channels: Vec<ChannelResult>,
}

/// A channel of memory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelResult {
    /// Lines read.
    pub reads: u64,
    /// Requests that found their row open.
    pub row_hits: u64,
    /// Share of its peak that it used.
    pub bandwidth_share: f64,
    /// Most requests that waited at once.
    pub longest_queue: u64,
}

impl DramResult {
    /// What the channels of `config` did in a run of `seconds`.
    pub(super) fn new(run: &Run, config: &DramConfig, seconds: f64) -> Self {
        let (channels, clocks) = (&run.channels, run.dram_clocks);
        let mut sum = ChannelCounts::default();
        channels.iter().for_each(|channel| sum.add(channel));
        let device = &config.device;
        let peak = device.peak_bytes_per_second();
        let lines = |counts: &ChannelCounts| counts.reads + counts.writes;
        let per_second = |counts: &ChannelCounts| ratio((lines(counts) * LINE_BYTES) as f64, seconds);
        let all_peak = peak * channels.len() as f64;
        let busiest = channels.iter().map(lines).max().unwrap_or(0);
        Self {
            device: device.name.clone(),
            reads: sum.reads,
            writes: sum.writes,
            row_hits: sum.row_hits,
            row_misses: sum.row_misses,
            row_conflicts: sum.row_conflicts,
            refreshes: sum.refreshes,
            activates: sum.activates,
            precharges: sum.precharges,
            clocks,
            clock_picoseconds: device.clock_ps,
            bus_clocks: sum.bus_clocks,
            active_clocks: sum.active_clocks,
            active_down_clocks: sum.active_down_clocks,
            precharged_down_clocks: sum.precharged_down_clocks,
            precharged_clocks: channels.iter().map(|counts| counts.precharged_clocks(device.organisation.ranks, clocks)).sum(),
            mean_queue: ratio(sum.queued_clocks as f64, clocks as f64),
            bytes: lines(&sum) * LINE_BYTES,
            bytes_per_second: per_second(&sum),
            peak_bytes_per_second: all_peak,
            bandwidth_share: per_second(&sum) / all_peak,
            mean_queue_nanoseconds: ratio((sum.queued_clocks * device.clock_ps) as f64 * 1e-3, lines(&sum) as f64),
            refused_cycles: run.counts.dram_refused_cycles,
            busiest_over_mean: ratio((busiest * channels.len() as u64) as f64, lines(&sum) as f64),
            busiest_bank_over_mean: Some(over_mean(&run.dram_banks)),
            activates_per_thousand: Some(ratio(1000.0 * sum.activates as f64, lines(&sum) as f64)),
            channels: channels
                .iter()
                .map(|counts| ChannelResult {
                    reads: counts.reads,
                    row_hits: counts.row_hits,
                    bandwidth_share: per_second(counts) / peak,
                    longest_queue: counts.longest_queue,
                })
                .collect(),
        }
    }
}

/// What contexts did with their cycles, all contexts of the machine together, as shares.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaitShares {
    /// Contexts times cycles of the frame.
    pub context_cycles: u64,
    /// Waited for lines, the last of which came from the L1. With traversal units only the sum of the three is known: see `memory`.
    pub l1: f64,
    /// The same from the L2.
    pub l2: f64,
    /// The same from memory.
    pub dram: f64,
    /// Waited for lines from anywhere.
    pub memory: f64,
    /// Computed, or waited for a block.
    pub compute: f64,
    /// Had no ray.
    pub idle: f64,
}

impl WaitShares {
    /// Where compute takes no time, contexts only wait; a traversal unit's wait for lines in `FETCH` (and, for splits of exact vertices, in `CHILD`).
    pub(super) fn new(waits: &Waits, units: Option<&UnitCounts>, context_cycles: u64) -> Self {
        let share = |cycles: u64| ratio(cycles as f64, context_cycles as f64);
        let (memory, idle) = match units {
            Some(counts) => (counts.states[State::Fetch as usize], counts.states[State::Idle as usize]),
            None => {
                let memory = waits.l1 + waits.l2 + waits.dram;
                (memory, context_cycles.saturating_sub(memory))
            }
        };
        Self {
            context_cycles,
            l1: share(waits.l1),
            l2: share(waits.l2),
            dram: share(waits.dram),
            memory: share(memory),
            compute: share(context_cycles.saturating_sub(memory + idle)),
            idle: share(idle),
        }
    }
}
