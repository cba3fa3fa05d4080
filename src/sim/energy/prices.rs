//! What each thing costs that is counted: with the counts, all that a frame's energy is made of.

use crate::sim::dram::DramPrices;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Energies of one each, in picojoules, or in accesses of an L1 where the machine's table is relative; leakage in milliwatts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prices {
    /// A request that an L1 looks up.
    pub l1_read: f64,
    /// A line written into an L1.
    pub l1_fill: f64,
    /// Leakage of all L1s.
    pub l1_leakage_mw: f64,
    /// A request that the L2 looks up.
    pub l2_read: f64,
    /// A line written into the L2.
    pub l2_fill: f64,
    /// Leakage of the L2.
    pub l2_leakage_mw: f64,
    /// A line of memory, where the table is relative.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dram_line: Option<f64>,
    /// What the memory's commands and clocks cost, where it is not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dram: Option<DramPrices>,
    /// Operations of the hardware blocks, by block; those that occurred.
    pub operations: BTreeMap<String, f64>,
    /// Leakage of all traversal units; 0 where there are none.
    pub units_leakage_mw: f64,
    /// Clock of all traversal units, of a cycle.
    pub units_clock: f64,
}
