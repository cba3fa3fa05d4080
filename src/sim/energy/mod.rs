//! Energy: what was counted, times tables, at report time. No part of the simulator holds joules.
//!
//! - [`caches`]: energies of L1 and L2 per read and fill, and their leakage, by geometry ([`geometry`]); several tables, of which the machine names one, with
//!   rows of their own and those of CACTI ([`cacti`]). A machine takes the rows of its own geometry, or is refused.
//! - [`blocks`]: energies of the hardware blocks, from what each is made of, and a traversal unit's leakage and clock.
//! - DRAM is counted by its own model, in picojoules, and handed in; a relative table has a price per line instead.
//!
//! Leakage and clock run over the whole frame. `docs/energy.md` tells where the figures come from and what is not counted.

pub mod blocks;
pub mod caches;
pub mod cacti;
pub mod geometry;
mod prices;
mod report;

#[cfg(test)]
mod tests;

pub use blocks::BlockTable;
pub use caches::{CacheEnergy, CacheTable, EnergyUnit};
pub use geometry::{Geometry, Level};

pub use prices::Prices;
pub use report::EnergyReport;

use crate::block::{FIRST_SHARED, Operation, Operations, SHARED_WORKS, Work};
use crate::hardware::Hardware;
use crate::machine::{Breach, Machine, MachineError};
use crate::method::MethodUnit;

/// Picojoules of a milliwatt in a second.
const PJ_PER_MW_S: f64 = 1e9;

/// What a frame did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EnergyCounts {
    /// Cycles of the cores from its first to its last.
    pub cycles: u64,
    /// Requests that the L1s looked up, hit or miss, all groups together.
    pub l1_reads: u64,
    /// Lines written into the L1s.
    pub l1_fills: u64,
    /// Requests that the L2 looked up.
    pub l2_reads: u64,
    /// Lines written into the L2.
    pub l2_fills: u64,
    /// Lines read from or written to memory; used by relative tables only.
    pub dram_lines: u64,
    /// Operations of the blocks.
    pub operations: Operations,
    /// A traversal unit, which leaks and is clocked for the whole frame. None where compute takes no time.
    pub unit: Option<MethodUnit>,
    /// What the method's own operations are, by number.
    pub works: &'static [Work],
}

impl EnergyCounts {
    /// Operations that no block does, and how often they occurred: the method's own, and those of scenes of several models.
    pub fn works(&self) -> impl Iterator<Item = (&'static Work, u64)> + '_ {
        let counts = self.operations.works();
        let shared = SHARED_WORKS.iter().zip(counts[FIRST_SHARED as usize..].iter().copied());
        self.works.iter().zip(counts.iter().copied()).chain(shared).filter(|&(_, count)| count > 0)
    }
}

/// The energies of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyModel {
    unit: EnergyUnit,
    l1: CacheEnergy,
    l2: CacheEnergy,
    dram_line: Option<f64>,
    blocks: Option<BlockTable>,
    groups: f64,
    units: f64,
    hardware: Hardware,
    cycles_per_second: f64,
}

/// Paths of the tables that `machine`'s energies come from, relative to its own file.
///
/// # Errors
/// The table of its caches cannot be read or is broken.
pub fn files(machine: &Machine) -> Result<Vec<String>, MachineError> {
    let mut files = CacheTable::files(machine)?;
    files.extend(machine.energy.blocks.as_deref().map(block_path));
    Ok(files)
}

/// Where a table of blocks lies, relative to the machine's own file.
fn block_path(name: &str) -> String {
    format!("energy/{name}.toml")
}

impl EnergyModel {
    /// The energies of `machine`, from the tables that it names.
    ///
    /// # Errors
    /// A table cannot be read, is broken, does not go with the other, or has no energies for the geometry of the machine's caches.
    pub fn new(machine: &Machine) -> Result<Self, MachineError> {
        let caches = CacheTable::of(machine)?;
        let blocks = match &machine.energy.blocks {
            Some(name) => {
                if caches.unit != EnergyUnit::Picojoules {
                    return Err(Breach::new("energy.blocks", "must be absent where energies are relative", name).in_file(&machine.name));
                }
                let (text, file) = machine.read(&block_path(name))?;
                Some(BlockTable::parse(&text, &file)?)
            }
            None => None,
        };
        let (cores, units) = (&machine.cores, &machine.units);
        Ok(Self {
            unit: caches.unit,
            l1: caches.energies(machine, Level::L1)?,
            l2: caches.energies(machine, Level::L2)?,
            dram_line: caches.dram_line,
            blocks,
            groups: f64::from(cores.groups),
            units: f64::from(cores.groups) * f64::from(units.per_group),
            hardware: units.config(),
            cycles_per_second: f64::from(cores.clock_mhz) * 1e6,
        })
    }

    /// The block that does it.
    fn name(&self, operation: Operation) -> &'static str {
        self.hardware.block(operation).name()
    }

    /// What each thing costs that `counts` counts; the memory's commands are priced by its own model.
    pub fn prices(&self, counts: &EnergyCounts) -> Prices {
        let (l1, l2) = (&self.l1, &self.l2);
        let blocks = self.blocks.as_ref();
        let occurred = counts.operations.iter().filter(|&(_, count)| count > 0);
        let priced =
            |(operation, _): (Operation, u64)| Some((self.name(operation).to_owned(), blocks?.operation_pj(operation, &self.hardware)));
        let works = counts.works().filter_map(|(work, _)| Some((work.name.to_owned(), blocks?.work_pj(work))));
        let units = blocks.zip(counts.unit);
        Prices {
            l1_read: l1.read,
            l1_fill: l1.fill,
            l1_leakage_mw: self.groups * l1.leakage_mw(),
            l2_read: l2.read,
            l2_fill: l2.fill,
            l2_leakage_mw: l2.leakage_mw(),
            dram_line: self.dram_line,
            dram: None,
            operations: occurred.filter_map(priced).chain(works).collect(),
            units_leakage_mw: units.map_or(0.0, |(table, unit)| self.units * table.unit_leakage_mw(unit, &self.hardware)),
            units_clock: units.map_or(0.0, |(table, unit)| self.units * table.unit_clock_pj(unit, &self.hardware)),
        }
    }

    /// The energy of a frame. `dram_pj` is the memory's, by part, as its model has it; with relative energies it is not used.
    pub fn report(&self, counts: &EnergyCounts, dram_pj: &[(&'static str, f64)]) -> EnergyReport {
        let mw_to_pj = counts.cycles as f64 / self.cycles_per_second * PJ_PER_MW_S;
        let prices = self.prices(counts);
        let of = |count: u64, price: f64| count as f64 * price;
        let occurred = counts.operations.iter().filter(|&(_, count)| count > 0);
        let compute = |(operation, count): (Operation, u64)| {
            let name = self.name(operation);
            Some((name, of(count, *prices.operations.get(name)?)))
        };
        let works = counts.works().filter_map(|(work, count)| Some((work.name, of(count, *prices.operations.get(work.name)?))));
        EnergyReport {
            unit: self.unit,
            l1_read: of(counts.l1_reads, prices.l1_read),
            l1_fill: of(counts.l1_fills, prices.l1_fill),
            l1_leakage: prices.l1_leakage_mw * mw_to_pj,
            l2_read: of(counts.l2_reads, prices.l2_read),
            l2_fill: of(counts.l2_fills, prices.l2_fill),
            l2_leakage: prices.l2_leakage_mw * mw_to_pj,
            compute: occurred.filter_map(compute).chain(works).collect(),
            unit_leakage: prices.units_leakage_mw * mw_to_pj,
            unit_clock: of(counts.cycles, prices.units_clock),
            dram: match self.dram_line {
                Some(line) => vec![("lines", of(counts.dram_lines, line))],
                None => dram_pj.to_vec(),
            },
        }
    }
}
