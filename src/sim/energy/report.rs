//! The energy of a frame, part by part.

use super::caches::EnergyUnit;
use serde::Serialize;

/// The energy of a frame; all parts are in `unit`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnergyReport {
    /// What the parts are in.
    pub unit: EnergyUnit,
    /// Requests looked up in the L1s.
    pub l1_read: f64,
    /// Lines written into the L1s.
    pub l1_fill: f64,
    /// Leakage of the L1s.
    pub l1_leakage: f64,
    /// Requests looked up in the L2.
    pub l2_read: f64,
    /// Lines written into the L2.
    pub l2_fill: f64,
    /// Leakage of the L2.
    pub l2_leakage: f64,
    /// Operations, by block; those that occurred.
    pub compute: Vec<(&'static str, f64)>,
    /// Leakage of the traversal units.
    pub unit_leakage: f64,
    /// Clock of the traversal units.
    pub unit_clock: f64,
    /// Memory, by part.
    pub dram: Vec<(&'static str, f64)>,
}

impl EnergyReport {
    /// The L1s.
    pub fn l1(&self) -> f64 {
        self.l1_read + self.l1_fill + self.l1_leakage
    }

    /// The L2.
    pub fn l2(&self) -> f64 {
        self.l2_read + self.l2_fill + self.l2_leakage
    }

    /// All that computes: operations, and leakage and clock of the units.
    pub fn compute(&self) -> f64 {
        sum(&self.compute) + self.unit_leakage + self.unit_clock
    }

    /// Memory.
    pub fn dram(&self) -> f64 {
        sum(&self.dram)
    }

    /// All but the memory.
    pub fn total_without_dram(&self) -> f64 {
        self.l1() + self.l2() + self.compute()
    }

    /// All.
    pub fn total(&self) -> f64 {
        self.total_without_dram() + self.dram()
    }
}

fn sum(parts: &[(&'static str, f64)]) -> f64 {
    parts.iter().map(|part| part.1).sum()
}
