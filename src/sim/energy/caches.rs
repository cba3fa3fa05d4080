//! Energies of the caches by geometry, read from `machines/energy/*.toml` and the rows of CACTI that they name.

use super::cacti::{self, CactiRow};
use super::geometry::{Geometry, Level};
use crate::machine::{Breach, Machine, MachineError, from_toml};
use serde::{Deserialize, Serialize};

/// Rows that an error lists where the right one is not there.
const NEAREST: usize = 4;

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

/// Energies of both levels, one row for each geometry: a machine takes the rows of its own.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CacheTable {
    /// What to call it in reports.
    pub name: String,
    /// What the energies are in.
    pub unit: EnergyUnit,
    /// A line read from or written to memory; in a relative table only, as otherwise the DRAM model tells.
    pub dram_line: Option<f64>,
    /// A file beside this one with more rows, those of [`cacti`].
    rows: Option<String>,
    /// Rows of the first level.
    #[serde(default)]
    l1: Vec<CacheEnergy>,
    /// Rows of the second level.
    #[serde(default)]
    l2: Vec<CacheEnergy>,
}

/// Energies of a cache.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CacheEnergy {
    /// Which cache.
    pub geometry: Geometry,
    /// A request looked up, whether it hits or not.
    pub read: f64,
    /// A line written from the level behind.
    pub fill: f64,
    /// Leakage of a bank, in mW; 0 in a relative table.
    pub leakage_mw_per_bank: f64,
}

impl CacheEnergy {
    /// CACTI's row as energies: a request looked up is a line read, hit or miss, and a line filled is a line written.
    pub fn of_cacti(row: &CactiRow) -> Self {
        let CactiRow { geometry, read_pj, write_pj, leakage_mw_per_bank, .. } = *row;
        Self { geometry, read: read_pj, fill: write_pj, leakage_mw_per_bank }
    }

    /// Leakage of all banks of the cache, in mW.
    pub fn leakage_mw(&self) -> f64 {
        f64::from(self.geometry.banks) * self.leakage_mw_per_bank
    }
}

impl CacheTable {
    /// The table that a machine names, with all its rows.
    ///
    /// # Errors
    /// It or its file of rows cannot be read, is broken, or has two rows of a geometry.
    pub fn of(machine: &Machine) -> Result<Self, MachineError> {
        let (mut table, file) = Self::alone(machine)?;
        if let Some(path) = table.rows_path() {
            let (text, file) = machine.read(&path)?;
            for row in cacti::rows(&text, &file)? {
                table.level_mut(row.level).push(CacheEnergy::of_cacti(&row));
            }
        }
        table.validate_rows().map_err(|breach| breach.in_file(&file))?;
        Ok(table)
    }

    /// Paths of the files of which the table that a machine names is made, relative to the machine's own.
    ///
    /// # Errors
    /// The table cannot be read or is broken.
    pub fn files(machine: &Machine) -> Result<Vec<String>, MachineError> {
        let (table, _) = Self::alone(machine)?;
        Ok(std::iter::once(path(machine)).chain(table.rows_path()).collect())
    }

    /// The energies of a level of `machine`.
    ///
    /// # Errors
    /// The table has no row of its geometry.
    pub fn energies(&self, machine: &Machine, level: Level) -> Result<CacheEnergy, MachineError> {
        let geometry = Geometry::from(level.of(machine));
        let rows = self.level(level);
        rows.iter().find(|row| row.geometry == geometry).copied().ok_or_else(|| {
            let mut near: Vec<_> = rows.iter().map(|row| row.geometry).collect();
            near.sort_by(|a, b| a.doublings_to(&geometry).total_cmp(&b.doublings_to(&geometry)));
            MachineError::NoEnergies {
                machine: machine.name.clone(),
                level: level.to_string(),
                geometry: geometry.to_string(),
                table: path(machine),
                nearest: near.iter().take(NEAREST).map(Geometry::to_string).collect::<Vec<_>>().join("; "),
            }
        })
    }

    /// Reads and checks a table without the rows of the file that it names; `file` is what to call it in errors.
    ///
    /// # Errors
    /// It is not TOML, lacks a key or has an unknown one, or a value is impossible.
    pub fn parse(text: &str, file: &str) -> Result<Self, MachineError> {
        let table: Self = from_toml(text, file)?;
        table.validate().map_err(|breach| breach.in_file(file))?;
        Ok(table)
    }

    /// The table that a machine names, without the rows of the file that it names, and what to call it in errors.
    fn alone(machine: &Machine) -> Result<(Self, String), MachineError> {
        let (text, file) = machine.read(&path(machine))?;
        Ok((Self::parse(&text, &file)?, file))
    }

    /// Where the file of rows lies, relative to the machine's own.
    fn rows_path(&self) -> Option<String> {
        self.rows.as_ref().map(|rows| format!("energy/{rows}"))
    }

    /// The rows of a level.
    pub(super) fn level(&self, level: Level) -> &[CacheEnergy] {
        match level {
            Level::L1 => &self.l1,
            Level::L2 => &self.l2,
        }
    }

    fn level_mut(&mut self, level: Level) -> &mut Vec<CacheEnergy> {
        match level {
            Level::L1 => &mut self.l1,
            Level::L2 => &mut self.l2,
        }
    }

    fn validate(&self) -> Result<(), Breach> {
        let relative = self.unit == EnergyUnit::L1Accesses;
        for (level, row) in Level::BOTH.iter().flat_map(|&level| self.level(level).iter().map(move |row| (level, row))) {
            not_negative(&format!("{level}.read"), row.read)?;
            not_negative(&format!("{level}.fill"), row.fill)?;
            let key = format!("{level}.leakage_mw_per_bank");
            not_negative(&key, row.leakage_mw_per_bank)?;
            if relative && row.leakage_mw_per_bank != 0.0 {
                return Err(Breach::new(&key, "must be 0 where energies are relative", row.leakage_mw_per_bank));
            }
        }
        match &self.rows {
            Some(rows) if relative => return Err(Breach::new("rows", "must be absent where energies are relative", rows)),
            Some(rows) if rows.contains(['/', '\\']) || !rows.ends_with(".csv") => {
                return Err(Breach::new("rows", "must be the name of a file beside the table, with .csv", format!("{rows:?}")));
            }
            _ => (),
        }
        match (relative, self.dram_line) {
            (true, Some(line)) => not_negative("dram_line", line),
            (true, None) => Err(Breach::new("dram_line", "must be given where energies are relative", "absent")),
            (false, Some(line)) => Err(Breach::new("dram_line", "must be absent where energies are in pJ", line)),
            (false, None) => Ok(()),
        }
    }

    /// Each level has rows, and one of a geometry.
    fn validate_rows(&self) -> Result<(), Breach> {
        for level in Level::BOTH {
            let rows = self.level(level);
            if rows.is_empty() {
                return Err(Breach::new(&level.to_string(), "must have a row", "absent"));
            }
            let twice = rows.iter().enumerate().find(|(k, row)| rows[..*k].iter().any(|before| before.geometry == row.geometry));
            if let Some((_, row)) = twice {
                return Err(Breach::new(
                    &level.to_string(),
                    "must have one row of a geometry",
                    format!("there twice for {}", row.geometry),
                ));
            }
        }
        Ok(())
    }
}

/// Where the table that a machine names lies, relative to the machine's own file.
fn path(machine: &Machine) -> String {
    format!("energy/{}.toml", machine.energy.caches)
}

/// `value` is a number, and not negative.
pub(super) fn not_negative(key: &str, value: f64) -> Result<(), Breach> {
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(Breach::new(key, "must be a number and not negative", value)) }
}
