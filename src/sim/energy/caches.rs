//! Energies of the caches, read from `machines/energy/*.toml`.

use crate::sim::machine::{Breach, MachineError, from_toml};
use serde::{Deserialize, Serialize};

/// What a table counts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum EnergyUnit {
    /// Picojoules.
    #[serde(rename = "pJ")]
    Picojoules,
    /// Accesses of an L1: relative energies.
    #[serde(rename = "L1 accesses")]
    L1Accesses,
}

/// Energies of both levels.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CacheTable {
    /// What to call it in reports.
    pub name: String,
    /// What the energies are in.
    pub unit: EnergyUnit,
    /// A line read from or written to memory; in a relative table only, as otherwise the DRAM model tells.
    pub dram_line: Option<f64>,
    /// First level.
    pub l1: CacheEnergy,
    /// Second level.
    pub l2: CacheEnergy,
}

/// Energies of a level.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CacheEnergy {
    /// A request looked up, whether it hits or not.
    pub read: f64,
    /// A line written from the level behind.
    pub fill: f64,
    /// Leakage of a bank, in mW; 0 in a relative table.
    pub leakage_mw_per_bank: f64,
}

impl CacheTable {
    /// Reads and checks a table; `file` is what to call it in errors.
    ///
    /// # Errors
    /// It is not TOML, lacks a key or has an unknown one, or a value is impossible.
    pub fn parse(text: &str, file: &str) -> Result<Self, MachineError> {
        let table: Self = from_toml(text, file)?;
        table.validate().map_err(|breach| breach.in_file(file))?;
        Ok(table)
    }

    fn validate(&self) -> Result<(), Breach> {
        let relative = self.unit == EnergyUnit::L1Accesses;
        for (level, cache) in [("l1", &self.l1), ("l2", &self.l2)] {
            not_negative(&format!("{level}.read"), cache.read)?;
            not_negative(&format!("{level}.fill"), cache.fill)?;
            let key = format!("{level}.leakage_mw_per_bank");
            not_negative(&key, cache.leakage_mw_per_bank)?;
            if relative && cache.leakage_mw_per_bank != 0.0 {
                return Err(Breach::new(&key, "must be 0 where energies are relative", cache.leakage_mw_per_bank));
            }
        }
        match (relative, self.dram_line) {
            (true, Some(line)) => not_negative("dram_line", line),
            (true, None) => Err(Breach::new("dram_line", "must be given where energies are relative", "absent")),
            (false, Some(line)) => Err(Breach::new("dram_line", "must be absent where energies are in pJ", line)),
            (false, None) => Ok(()),
        }
    }
}

/// `value` is a number, and not negative.
pub(super) fn not_negative(key: &str, value: f64) -> Result<(), Breach> {
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(Breach::new(key, "must be a number and not negative", value)) }
}
