//! Energies of the hardware blocks, from what each is made of and published energies per operation (`machines/energy/blocks22.toml`).
//!
//! With P the sum of a x b over the products of a x b bits, A the bits added, S the bits selected and R the registers of a block whose operation takes
//! c cycles: one operation costs P multiply / 32^2 + A add / 32 + S select / 32 + R c register. The block leaks as much hardware as
//! it has: P / c, A / c, S / c and R.

use super::caches::not_negative;
use super::operation::Operation;
use crate::sim::machine::{Breach, MachineError, from_toml};
use serde::Deserialize;
use std::collections::BTreeMap;

/// Bits of the operations that the table is for.
const WORD: f64 = 32.0;

/// Energies of the blocks.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockTable {
    /// What to call it in reports.
    pub name: String,
    operations: Prices,
    scale: Scale,
    unit: UnitHardware,
    blocks: BTreeMap<String, Row>,
}

/// Energies and leakage of operations of 32 bits and of a register of one, at the node of their source.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Prices {
    multiply_32_pj: f64,
    add_32_pj: f64,
    select_32_pj: f64,
    register_pj: f64,
    clock_pj: f64,
    multiply_32_mw: f64,
    add_32_mw: f64,
    select_32_mw: f64,
    register_mw: f64,
}

/// From the sources' nodes to that of the table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Scale {
    /// Products and sums.
    from_45: f64,
    /// Selections and registers.
    from_40: f64,
    /// Leakage.
    leakage: f64,
}

/// What a traversal unit has besides its blocks.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct UnitHardware {
    context_registers: u32,
    context_level_registers: u32,
    registers_per_clock_gate: u32,
}

/// What a block is made of.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Row {
    /// Products of an operation: how many, bits of one factor, bits of the other.
    pub products: Vec<[u32; 3]>,
    /// Bits added in an operation.
    pub add_bits: u32,
    /// Bits selected in an operation.
    pub select_bits: u32,
    /// Registers.
    pub registers: u32,
    /// Cycles that an operation takes of the hardware.
    pub cycles: u32,
}

impl BlockTable {
    /// Reads and checks a table; `file` is what to call it in errors.
    ///
    /// # Errors
    /// It is not TOML, lacks a key or block or has an unknown one, or a value is impossible.
    pub fn parse(text: &str, file: &str) -> Result<Self, MachineError> {
        let table: Self = from_toml(text, file)?;
        table.validate().map_err(|breach| breach.in_file(file))?;
        Ok(table)
    }

    /// Energy of one operation of a block, in pJ; `one_edge`: of the triangle test with one edge function.
    pub fn operation_pj(&self, operation: Operation, one_edge: bool) -> f64 {
        let (row, prices) = (self.row(operation, one_edge), &self.operations);
        let logic = row.products() * prices.multiply_32_pj / (WORD * WORD) + f64::from(row.add_bits) * prices.add_32_pj / WORD;
        let written = f64::from(row.registers) * f64::from(row.cycles);
        let cells = f64::from(row.select_bits) * prices.select_32_pj / WORD + written * prices.register_pj;
        logic * self.scale.from_45 + cells * self.scale.from_40
    }

    /// Leakage of a traversal unit with `blocks`, one for each entry, in mW.
    pub fn unit_leakage_mw(&self, blocks: &[Operation], contexts: u32, one_edge: bool) -> f64 {
        let prices = &self.operations;
        let of_block = |&operation: &Operation| {
            let row = self.row(operation, one_edge);
            let logic = row.products() * prices.multiply_32_mw / (WORD * WORD)
                + f64::from(row.add_bits) * prices.add_32_mw / WORD
                + f64::from(row.select_bits) * prices.select_32_mw / WORD;
            logic / f64::from(row.cycles)
        };
        let logic: f64 = blocks.iter().map(of_block).sum();
        (logic + self.unit_registers(blocks, contexts, one_edge) * prices.register_mw) * self.scale.leakage
    }

    /// Energy of the clock of a traversal unit with `blocks`, one for each entry, in a cycle in which nothing is written, in pJ.
    pub fn unit_clock_pj(&self, blocks: &[Operation], contexts: u32, one_edge: bool) -> f64 {
        let gates = self.unit_registers(blocks, contexts, one_edge) / f64::from(self.unit.registers_per_clock_gate);
        gates * self.operations.clock_pj * self.scale.from_40
    }

    /// Registers of a traversal unit with `blocks`, one for each entry.
    fn unit_registers(&self, blocks: &[Operation], contexts: u32, one_edge: bool) -> f64 {
        let of_blocks: f64 = blocks.iter().map(|&operation| f64::from(self.row(operation, one_edge).registers)).sum();
        of_blocks + f64::from(contexts) * f64::from(self.context_registers(blocks))
    }

    /// Registers of a ray context of a unit with `blocks`: split triangles, and the levels and codes of the stack's entries, only where it tessellates.
    fn context_registers(&self, blocks: &[Operation]) -> u32 {
        let levels = if blocks.contains(&Operation::Tessellate) { self.unit.context_level_registers } else { 0 };
        self.unit.context_registers + levels
    }

    /// The row of a block; the table was checked to have it.
    pub(super) fn row(&self, operation: Operation, one_edge: bool) -> &Row {
        &self.blocks[row_name(operation, one_edge)]
    }

    fn validate(&self) -> Result<(), Breach> {
        let (prices, scale) = (&self.operations, &self.scale);
        let numbers = [
            ("operations.multiply_32_pj", prices.multiply_32_pj),
            ("operations.add_32_pj", prices.add_32_pj),
            ("operations.select_32_pj", prices.select_32_pj),
            ("operations.register_pj", prices.register_pj),
            ("operations.clock_pj", prices.clock_pj),
            ("operations.multiply_32_mw", prices.multiply_32_mw),
            ("operations.add_32_mw", prices.add_32_mw),
            ("operations.select_32_mw", prices.select_32_mw),
            ("operations.register_mw", prices.register_mw),
            ("scale.from_45", scale.from_45),
            ("scale.from_40", scale.from_40),
            ("scale.leakage", scale.leakage),
        ];
        numbers.iter().try_for_each(|&(key, value)| not_negative(key, value))?;
        if self.unit.registers_per_clock_gate == 0 {
            return Err(Breach::new("unit.registers_per_clock_gate", "must be at least 1", 0));
        }
        let known: Vec<&str> = [false, true].iter().flat_map(|&one| Operation::ALL.map(|operation| row_name(operation, one))).collect();
        if let Some(missing) = known.iter().find(|name| !self.blocks.contains_key(**name)) {
            return Err(Breach::new(&format!("blocks.{missing}"), "must be given", "absent"));
        }
        for (name, row) in &self.blocks {
            if !known.contains(&name.as_str()) {
                return Err(Breach::new(&format!("blocks.{name}"), format!("must be one of {}", known[..].join(", ")), "another"));
            }
            if row.cycles == 0 {
                return Err(Breach::new(&format!("blocks.{name}.cycles"), "must be at least 1", 0));
            }
        }
        Ok(())
    }
}

impl Row {
    /// Sum over the products of bits times bits.
    fn products(&self) -> f64 {
        self.products.iter().map(|of| of.iter().map(|&n| f64::from(n)).product::<f64>()).sum()
    }
}

/// The row that holds an operation.
fn row_name(operation: Operation, one_edge: bool) -> &'static str {
    if one_edge && operation == Operation::TriTest { "tri_test_one_edge" } else { operation.name() }
}
