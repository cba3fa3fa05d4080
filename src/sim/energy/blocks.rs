//! Energies of the hardware blocks, from what each is made of and published energies per operation (`machines/energy/blocks22.toml`).
//!
//! With P the sum of a x b over the products of a x b bits, A the bits added, S the bits selected, R the registers and W the bits written in them by an
//! operation ([`Parts`]), which takes the block c cycles, its interval: one operation costs P multiply / 32^2 + A add / 32 + S select / 32 + W register.
//! The block leaks as much hardware as it has: P / c, A / c, S / c and R; of blocks that take turns each does.

use super::caches::not_negative;
use crate::block::parts::{Parts, Registers};
use crate::block::{Operation, Work};
use crate::hardware::Hardware;
use crate::machine::{Breach, MachineError, from_toml};
use crate::method::MethodUnit;
use serde::Deserialize;

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
    unit: Clock,
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

/// The clock of a traversal unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Clock {
    registers_per_clock_gate: u32,
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

    /// Energy of one operation of a block of this hardware, in pJ; none of one that it does not have.
    pub fn operation_pj(&self, operation: Operation, hardware: &Hardware) -> f64 {
        if !hardware.has(operation) {
            return 0.0;
        }
        self.parts_pj(&hardware.block(operation).parts(&hardware.form()))
    }

    /// Energy of an operation that no block does, in pJ: that of a block of the same parts.
    pub fn work_pj(&self, work: &Work) -> f64 {
        let registers = Registers { written: work.written_bits, ..Registers::default() };
        let (products, add_bits, select_bits) = (work.products.to_vec(), work.add_bits, work.select_bits);
        self.parts_pj(&Parts { products, add_bits, select_bits, registers })
    }

    fn parts_pj(&self, parts: &Parts) -> f64 {
        let prices = &self.operations;
        let logic = products(parts) * prices.multiply_32_pj / (WORD * WORD) + f64::from(parts.add_bits) * prices.add_32_pj / WORD;
        let written = f64::from(parts.registers.written);
        let cells = f64::from(parts.select_bits) * prices.select_32_pj / WORD + written * prices.register_pj;
        logic * self.scale.from_45 + cells * self.scale.from_40
    }

    /// Leakage of a traversal unit, in mW.
    pub fn unit_leakage_mw(&self, unit: MethodUnit, hardware: &Hardware) -> f64 {
        let prices = &self.operations;
        let of_block = |operation: Operation| {
            let form = hardware.form();
            let (parts, cycles) = (operation.parts(&form), f64::from(operation.timing(&form).interval));
            let logic = products(&parts) * prices.multiply_32_mw / (WORD * WORD)
                + f64::from(parts.add_bits) * prices.add_32_mw / WORD
                + f64::from(parts.select_bits) * prices.select_32_mw / WORD;
            f64::from(hardware.copies(operation)) * logic / cycles
        };
        let logic: f64 = hardware.blocks(unit.blocks).map(of_block).sum();
        (logic + unit_registers(unit, hardware) * prices.register_mw) * self.scale.leakage
    }

    /// Energy of the clock of a traversal unit, in a cycle in which nothing is written, in pJ.
    pub fn unit_clock_pj(&self, unit: MethodUnit, hardware: &Hardware) -> f64 {
        let gates = unit_registers(unit, hardware) / f64::from(self.unit.registers_per_clock_gate);
        gates * self.operations.clock_pj * self.scale.from_40
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
        Ok(())
    }
}

/// Sum over the products of bits times bits.
fn products(parts: &Parts) -> f64 {
    parts.products.iter().map(|of| of.iter().map(|&n| f64::from(n)).product::<f64>()).sum()
}

/// Registers of a traversal unit.
fn unit_registers(unit: MethodUnit, hardware: &Hardware) -> f64 {
    let of_block = |operation: Operation| hardware.copies(operation) * operation.parts(&hardware.form()).registers.kept;
    let of_blocks: f64 = hardware.blocks(unit.blocks).map(|operation| f64::from(of_block(operation))).sum();
    let context = hardware.context_registers(unit.has_levels);
    of_blocks + hardware.contexts as f64 * f64::from(context.kept)
}
