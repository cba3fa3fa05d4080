//! What CACTI says of caches, as rows of comma-separated values (`machines/energy/*.csv`): one geometry a row, energies of an access to the whole cache (data
//! and tags, one line in or out), leakage of one of its banks, and timing.

use super::geometry::{Geometry, Level};
use crate::machine::{LineFault, MachineError};

/// The columns, as the first line names them.
const COLUMNS: [&str; 10] =
    ["level", "bytes", "ways", "banks", "line_bytes", "read_pj", "write_pj", "leakage_mw_per_bank", "access_ns", "cycle_ns"];

/// A row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CactiRow {
    /// What the geometry is for; the tool knows no levels.
    pub level: Level,
    /// Which cache.
    pub geometry: Geometry,
    /// A line read.
    pub read_pj: f64,
    /// A line written.
    pub write_pj: f64,
    /// Leakage of one bank.
    pub leakage_mw_per_bank: f64,
    /// From the address to the data.
    pub access_ns: f64,
    /// From one access of a bank to its next.
    pub cycle_ns: f64,
}

impl CactiRow {
    /// The least whole cycles at `clock_mhz` in which an access is done.
    pub fn access_cycles(&self, clock_mhz: u32) -> u32 {
        cycles(self.access_ns, clock_mhz)
    }

    /// The least whole cycles at `clock_mhz` after which a bank takes its next access.
    pub fn interval_cycles(&self, clock_mhz: u32) -> u32 {
        cycles(self.cycle_ns, clock_mhz)
    }

    fn parse(line: &str) -> Result<Self, LineFault> {
        let cells: Vec<&str> = line.split(',').collect();
        let cells: [&str; COLUMNS.len()] = cells
            .try_into()
            .map_err(|cells: Vec<_>| LineFault::new("the row", format!("must have {} values", COLUMNS.len()), cells.len()))?;
        let level = match cells[0] {
            "l1" => Level::L1,
            "l2" => Level::L2,
            other => return Err(LineFault::new(COLUMNS[0], "must be l1 or l2", other)),
        };
        let count = |k: usize| match cells[k].parse::<u32>() {
            Ok(n) if n > 0 => Ok(n),
            _ => Err(LineFault::new(COLUMNS[k], "must be a whole number above 0", cells[k])),
        };
        let number = |k: usize| match cells[k].parse::<f64>() {
            Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
            _ => Err(LineFault::new(COLUMNS[k], "must be a number and not negative", cells[k])),
        };
        Ok(Self {
            level,
            geometry: Geometry { bytes: u64::from(count(1)?), ways: count(2)?, banks: count(3)?, line_bytes: count(4)? },
            read_pj: number(5)?,
            write_pj: number(6)?,
            leakage_mw_per_bank: number(7)?,
            access_ns: number(8)?,
            cycle_ns: number(9)?,
        })
    }
}

/// All rows of a file; `file` is what to call it in errors.
///
/// # Errors
/// The first line is not the columns' names, or a row has too many or too few values, or one that is none of its column's.
pub fn rows(text: &str, file: &str) -> Result<Vec<CactiRow>, MachineError> {
    let mut lines = (1..).zip(text.lines());
    let (number, head) = lines.next().unwrap_or((1, ""));
    if head != COLUMNS.join(",") {
        return Err(LineFault::new("the head", format!("must be {}", COLUMNS.join(",")), format!("{head:?}")).in_line(file, number));
    }
    lines.map(|(number, line)| CactiRow::parse(line).map_err(|fault| fault.in_line(file, number))).collect()
}

/// Nanoseconds as whole cycles, rounded up.
fn cycles(ns: f64, clock_mhz: u32) -> u32 {
    (ns * f64::from(clock_mhz) * 1e-3).ceil() as u32
}
