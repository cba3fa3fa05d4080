//! The energy of a frame, split: what is spent on accesses and operations by place, and leakage apart.

use super::ratio::ratio;
use crate::sim::dram::DramEnergy;
use crate::sim::energy::{EnergyReport, EnergyUnit, Prices};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The energy of a frame; all of it in `unit`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnergyResult {
    /// `uJ`, or `L1 accesses` where the machine's table is relative.
    pub unit: String,
    /// Sum of the five parts below.
    pub total: f64,
    /// The same over the frame's time, in watts; none for relative energies.
    pub average_watts: Option<f64>,
    /// The L1s, without leakage.
    pub l1: ReadFill,
    /// The L2, without leakage.
    pub l2: ReadFill,
    /// Memory.
    pub dram: DramParts,
    /// All that computes, without leakage.
    pub compute: ComputeEnergy,
    /// Leakage of what is on the chip.
    pub leakage: LeakageEnergy,
    /// What one of each costs: with the counts of the result, all of the above (`scripts/energy.py` adds it up).
    pub prices: Prices,
}

/// A cache without its leakage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReadFill {
    /// Both.
    pub total: f64,
    /// Requests looked up.
    pub read: f64,
    /// Lines written.
    pub fill: f64,
}

/// Memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DramParts {
    /// All of it.
    pub total: f64,
    /// By what it is spent on: `background`, `activate`, `read`, `write`, `refresh` and `io`, or `lines` where the table is relative.
    pub parts: BTreeMap<String, f64>,
}

/// What computes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ComputeEnergy {
    /// All of it.
    pub total: f64,
    /// Clock of the traversal units, where compute takes time.
    pub clock: f64,
    /// Operations, by block.
    pub operations: BTreeMap<String, f64>,
}

/// Leakage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LeakageEnergy {
    /// All of it.
    pub total: f64,
    /// The L1s.
    pub l1: f64,
    /// The L2.
    pub l2: f64,
    /// Traversal units, where compute takes time.
    pub units: f64,
}

/// Name and energy of the memory's parts, as the energy model takes them.
pub(super) fn dram_parts(energy: &DramEnergy) -> [(&'static str, f64); 6] {
    [
        ("background", energy.background_pj),
        ("activate", energy.activate_pj),
        ("read", energy.read_pj),
        ("write", energy.write_pj),
        ("refresh", energy.refresh_pj),
        ("io", energy.io_pj),
    ]
}

/// How much of its unit in JSON is one of the model's, and the name of that.
pub(super) fn unit_of(unit: EnergyUnit) -> (f64, &'static str) {
    match unit {
        EnergyUnit::Picojoules => (1e-6, "uJ"),
        EnergyUnit::L1Accesses => (1.0, "L1 accesses"),
    }
}

impl EnergyResult {
    pub(super) fn new(report: &EnergyReport, prices: Prices, seconds: f64) -> Self {
        let (scale, unit) = unit_of(report.unit);
        let named = |parts: &[(&'static str, f64)]| parts.iter().map(|&(name, energy)| (name.to_owned(), energy * scale)).collect();
        let cache = |read: f64, fill: f64| ReadFill { total: (read + fill) * scale, read: read * scale, fill: fill * scale };
        let leakage = report.l1_leakage + report.l2_leakage + report.unit_leakage;
        let watts = ratio(report.total() * 1e-12, seconds);
        Self {
            unit: unit.to_owned(),
            total: report.total() * scale,
            average_watts: (report.unit == EnergyUnit::Picojoules).then_some(watts),
            l1: cache(report.l1_read, report.l1_fill),
            l2: cache(report.l2_read, report.l2_fill),
            dram: DramParts { total: report.dram() * scale, parts: named(&report.dram) },
            compute: ComputeEnergy {
                total: (report.compute() - report.unit_leakage) * scale,
                clock: report.unit_clock * scale,
                operations: named(&report.compute),
            },
            leakage: LeakageEnergy {
                total: leakage * scale,
                l1: report.l1_leakage * scale,
                l2: report.l2_leakage * scale,
                units: report.unit_leakage * scale,
            },
            prices,
        }
    }

    /// Name and energy of the five parts.
    pub fn split(&self) -> [(&'static str, f64); 5] {
        [
            ("L1", self.l1.total),
            ("L2", self.l2.total),
            ("DRAM", self.dram.total),
            ("compute", self.compute.total),
            ("leakage", self.leakage.total),
        ]
    }
}
