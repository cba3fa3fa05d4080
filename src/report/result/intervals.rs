//! A run over time: what each stretch of cycles added.

use super::energy::dram_parts;
use super::ratio::ratio;
use super::roofline::{Done, Parts};
use crate::block::Operations;
use crate::method::Computing;
use crate::num::LINE_BYTES;
use crate::sim::dram::{ChannelCounts, DramEnergy};
use crate::sim::energy::{EnergyCounts, EnergyModel, EnergyReport, EnergyUnit};
use crate::sim::replay::{CacheCounts, Counts, Interval};
use serde::{Deserialize, Serialize};

/// What happened in a stretch of cycles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IntervalResult {
    /// The cycle in which it ended; it began where the one before ended.
    pub end: u64,
    /// Its length.
    pub cycles: u64,
    /// Rays done.
    pub rays: u64,
    /// Requests to the L1s.
    pub l1_requests: u64,
    /// Misses there.
    pub l1_misses: u64,
    /// Requests to the L2.
    pub l2_requests: u64,
    /// Misses there.
    pub l2_misses: u64,
    /// Bytes read and written in memory.
    pub dram_bytes: u64,
    /// Requests to memory that found their row open.
    pub row_hits: u64,
    /// Requests that did not.
    pub row_misses: u64,
    /// Miss registers in use and requests in queues of the L1s, the L2 and (`dram_queue`) the memory, in the mean, all together: those of requests that left them in this stretch.
    pub l1_registers: f64,
    #[expect(missing_docs, reason = "above")]
    pub l1_queue: f64,
    #[expect(missing_docs, reason = "above")]
    pub l2_registers: f64,
    #[expect(missing_docs, reason = "above")]
    pub l2_queue: f64,
    #[expect(missing_docs, reason = "above")]
    pub dram_queue: f64,
    /// The part of the machine with the largest share ([`Roofline`](super::Roofline)), and that share.
    pub limit: String,
    #[expect(missing_docs, reason = "above")]
    pub limit_share: f64,
    /// Power; none for relative energies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub watts: Option<IntervalPower>,
}

/// Mean power of a stretch, in watts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IntervalPower {
    /// The L1s, without leakage.
    pub l1: f64,
    /// The L2, without leakage.
    pub l2: f64,
    /// Memory.
    pub dram: f64,
    /// The blocks, and the units' clocks, without leakage.
    pub compute: f64,
    /// Leakage of what is on the chip.
    pub leakage: f64,
}

/// The stretches of a run that `of` computes for.
pub(super) fn intervals(cumulative: &[Interval], model: &EnergyModel, parts: &Parts<'_>, of: Computing) -> Vec<IntervalResult> {
    let zero = zero();
    let begins = std::iter::once(&zero).chain(cumulative);
    begins.zip(cumulative).map(|(begin, end)| between(begin, end, model, parts, of)).collect()
}

/// What was counted between two cycles, and its energy; what leaks does so for `cycles`.
pub(super) fn energy_between(
    begin: &Interval,
    end: &Interval,
    cycles: u64,
    model: &EnergyModel,
    of: Computing,
) -> (EnergyCounts, EnergyReport) {
    let added = |of: fn(&Interval) -> u64| of(end) - of(begin);
    let counts = EnergyCounts {
        cycles,
        l1_reads: added(|i| i.counts.l1.read()),
        l1_fills: added(|i| i.counts.l1.written()),
        l2_reads: added(|i| i.counts.l2.read()),
        l2_fills: added(|i| i.counts.l2.written()),
        dram_lines: added(|i| i.channels.reads + i.channels.writes),
        operations: end.operations.since(&begin.operations),
        unit: of.unit,
        works: of.works,
    };
    let [before, after] = [begin, end].map(|interval| dram_parts(&interval.dram));
    let dram: Vec<_> = before.into_iter().zip(after).map(|((name, before), (_, after))| (name, after - before)).collect();
    let energy = model.report(&counts, &dram);
    (counts, energy)
}

/// Before the first cycle.
pub(super) fn zero() -> Interval {
    Interval {
        end: 0,
        counts: Counts::default(),
        channels: ChannelCounts::default(),
        dram: DramEnergy::default(),
        operations: Operations::default(),
    }
}

fn between(begin: &Interval, end: &Interval, model: &EnergyModel, parts: &Parts<'_>, of: Computing) -> IntervalResult {
    let added = |of: fn(&Interval) -> u64| of(end) - of(begin);
    let cycles = added(|i| i.end);
    let lines = added(|i| i.channels.reads + i.channels.writes);
    let (l1_requests, l2_requests) = (added(|i| i.counts.l1.requests), added(|i| i.counts.l2.requests));
    let (counts, energy) = energy_between(begin, end, cycles, model, of);
    // Picojoules in a time to watts.
    let watts = |pj: f64| pj * 1e-12 * f64::from(parts.machine.cores.clock_mhz) * 1e6 / cycles as f64;
    let power = || IntervalPower {
        l1: watts(energy.l1_read + energy.l1_fill),
        l2: watts(energy.l2_read + energy.l2_fill),
        dram: watts(energy.dram()),
        compute: watts(energy.compute() - energy.unit_leakage),
        leakage: watts(energy.l1_leakage + energy.l2_leakage + energy.unit_leakage),
    };
    // What the roofline takes, between the two.
    let limiting = Counts {
        l1: CacheCounts {
            requests: l1_requests,
            fills: added(|i| i.counts.l1.fills),
            stores: added(|i| i.counts.l1.stores),
            register_cycles: added(|i| i.counts.l1.register_cycles),
            queued_cycles: added(|i| i.counts.l1.queued_cycles),
            ..CacheCounts::default()
        },
        l2: CacheCounts {
            requests: l2_requests,
            register_cycles: added(|i| i.counts.l2.register_cycles),
            queued_cycles: added(|i| i.counts.l2.queued_cycles),
            ..CacheCounts::default()
        },
        ..Counts::default()
    };
    let channels = ChannelCounts {
        queued_clocks: added(|i| i.channels.queued_clocks),
        writes: added(|i| i.channels.writes),
        bus_clocks: added(|i| i.channels.bus_clocks),
        activates: added(|i| i.channels.activates),
        ..ChannelCounts::default()
    };
    let mean = |cycles_of_all: u64| ratio(cycles_of_all as f64, cycles as f64);
    let (limit, limit_share) = parts.largest(&Done { counts: &limiting, channels: &channels, operations: &counts.operations, cycles });
    IntervalResult {
        end: end.end,
        cycles,
        rays: added(|i| i.counts.rays),
        l1_requests,
        l1_misses: added(|i| i.counts.l1.misses),
        l2_requests,
        l2_misses: added(|i| i.counts.l2.misses),
        dram_bytes: lines * LINE_BYTES,
        row_hits: added(|i| i.channels.row_hits),
        row_misses: added(|i| i.channels.row_misses + i.channels.row_conflicts),
        l1_registers: mean(limiting.l1.register_cycles),
        l1_queue: mean(limiting.l1.queued_cycles),
        l2_registers: mean(limiting.l2.register_cycles),
        l2_queue: mean(limiting.l2.queued_cycles),
        dram_queue: mean(channels.queued_clocks) * parts.cycles_per_clock(),
        limit: limit.to_owned(),
        limit_share,
        watts: (energy.unit == EnergyUnit::Picojoules && cycles > 0).then(power),
    }
}
