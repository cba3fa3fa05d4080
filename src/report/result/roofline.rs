//! What each part of the machine would need for its share of the frame, if nothing else took time: the largest share names the limit.

use super::ratio::ratio;
use crate::block::{Operation, Operations};
use crate::machine::Machine;
use crate::method::lod;
use crate::run::Compute;
use crate::sim::dram::{ChannelCounts, DramConfig};
use crate::sim::replay::Counts;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Bounds of the frame's time, from how much a part can take at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Roofline {
    /// By part:
    /// `l1_banks`, `l2_banks`: requests, over what the banks, and the ports before the L1s, take in a cycle;
    /// `l1_queues`, `l2_queues`: cycles in the banks' queues, over their places;
    /// `l1_mshrs`, `l2_mshrs`: cycles of miss registers in use, over all registers (Little's law);
    /// `crossbar_requests`, `crossbar_answers`: lines there and back, over the groups' ports;
    /// `dram_queues`: clocks in the channels' queues, over their places;
    /// `dram_bus`: clocks with data; `dram_activates`: activates times the larger of nRRD_S and nFAW / 4; `dram_banks`: activates times nRC, over all banks;
    /// and by name of the block, where there are traversal units and it has something to do: operations times its interval, over all units.
    pub limits: BTreeMap<String, Bound>,
    /// The part with the largest share.
    pub largest: String,
}

/// Names of the parts of every machine, in the order of a line's way.
pub(in crate::report) const LIMITS: [&str; 12] = [
    "l1_banks",
    "l1_queues",
    "l1_mshrs",
    "crossbar_requests",
    "crossbar_answers",
    "l2_banks",
    "l2_queues",
    "l2_mshrs",
    "dram_queues",
    "dram_bus",
    "dram_activates",
    "dram_banks",
];

/// What one part would need.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// Cycles of the cores.
    pub cycles: f64,
    /// The same as a share of the frame; the largest one near 1 says that it limits the frame.
    pub share: f64,
}

/// What was done in a frame or a stretch of it.
pub(super) struct Done<'a> {
    pub counts: &'a Counts,
    pub channels: &'a ChannelCounts,
    pub operations: &'a Operations,
    pub cycles: u64,
}

/// The machine that has the parts.
pub(super) struct Parts<'a> {
    pub machine: &'a Machine,
    pub dram: &'a DramConfig,
    pub compute: Compute,
}

impl Parts<'_> {
    /// Cycles of the cores that each part would need for what was done.
    fn cycles(&self, done: &Done<'_>) -> Vec<(&'static str, f64)> {
        let Done { counts, channels, .. } = done;
        let Self { machine, dram, compute } = self;
        let (cores, l1, l2, crossbar) = (&machine.cores, &machine.l1, &machine.l2, &machine.crossbar);
        let product = |factors: &[u32]| factors.iter().copied().map(f64::from).product::<f64>();
        let ports = match compute {
            Compute::Free => cores.per_group,
            Compute::Units => machine.units.per_group,
        };
        let per = |count: u64, rate: f64| count as f64 / rate;
        let clock = self.cycles_per_clock();
        let (t, organisation) = (&dram.device.timing, &dram.device.organisation);
        // Writes have a queue of their own, which counts where there are any.
        let writes = if channels.writes > 0 { dram.controller.write_queue } else { 0 };
        let places = u32::from(dram.controller.read_queue) + u32::from(writes);
        let activate = (t.n_rrd_s as f64).max(t.n_faw as f64 / 4.0);
        let [groups, channel_count] = [cores.groups, dram.channels];
        let memory = [
            per(counts.l1.requests, product(&[groups, l1.banks.min(ports)])),
            per(counts.l1.queued_cycles, product(&[groups, l1.banks, l1.queue])),
            per(counts.l1.register_cycles, product(&[groups, l1.banks, l1.mshrs])),
            per(counts.l2.requests, product(&[groups, crossbar.per_group])),
            // Lines, and word that stores have arrived.
            per(counts.l1.fills + counts.l1.stores, product(&[groups, crossbar.per_group])),
            // A bank takes one request a cycle, whatever it may be handed.
            per(counts.l2.requests, f64::from(l2.banks)),
            per(counts.l2.queued_cycles, product(&[l2.banks, l2.queue])),
            per(counts.l2.register_cycles, product(&[l2.banks, l2.mshrs])),
            clock * per(channels.queued_clocks, product(&[channel_count, places])),
            clock * per(channels.bus_clocks, f64::from(channel_count)),
            clock * activate * per(channels.activates, product(&[channel_count, organisation.ranks])),
            clock * t.n_rc as f64 * per(channels.activates, product(&[channel_count, dram.device.banks()])),
        ];
        LIMITS.into_iter().zip(memory).chain(self.blocks(done.operations)).collect()
    }

    /// Cycles that each block of the units would need, where there are any.
    fn blocks(&self, operations: &Operations) -> Vec<(&'static str, f64)> {
        if self.compute == Compute::Free {
            return Vec::new();
        }
        let (units, hardware) = (&self.machine.units, self.machine.units.config());
        let form = hardware.form();
        let all = f64::from(self.machine.cores.groups * units.per_group);
        let of = |operation| operations.get(operation);
        // Operations, and the cycles that they take. Nodes of all kinds go through `child_test`: those of a BVH count as their sorts.
        let taken = |block: Operation| {
            let interval = u64::from(hardware.interval(block));
            match block {
                Operation::ChildTest => {
                    let [fours, sixes] = [of(Operation::ChildTest) + of(Operation::ChildSort), of(Operation::ChildSort6)];
                    (fours + sixes, interval * fours + u64::from(form.boxes_per_cycle.passes(6)) * sixes)
                }
                _ => (of(block), interval * of(block)),
            }
        };
        // Of all blocks that contexts share, which our own unit has, those with something to do.
        let blocks = lod::METHOD.unit.into_iter().flat_map(|unit| unit.blocks);
        blocks.filter(|&&block| taken(block).0 > 0).map(|&block| (hardware.block(block).name(), taken(block).1 as f64 / all)).collect()
    }

    /// Cycles of the cores in a clock of the memory.
    pub(super) fn cycles_per_clock(&self) -> f64 {
        self.dram.device.clock_ps as f64 * f64::from(self.machine.cores.clock_mhz) * 1e-6
    }

    /// The part with the largest share of the time for what was done, and that share.
    pub(super) fn largest(&self, done: &Done<'_>) -> (&'static str, f64) {
        let largest = self.cycles(done).into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(("", 0.0));
        (largest.0, ratio(largest.1, done.cycles as f64))
    }

    /// All of a frame.
    pub(super) fn roofline(&self, done: &Done<'_>) -> Roofline {
        let bound = |needed: f64| Bound { cycles: needed, share: ratio(needed, done.cycles as f64) };
        let limits = self.cycles(done).into_iter().map(|(name, needed)| (name.to_owned(), bound(needed))).collect();
        Roofline { limits, largest: self.largest(done).0.to_owned() }
    }
}
