//! Area of a traversal unit, from what `scripts/synth` measured of its blocks (`docs/hardware.md`).

use super::Hardware;
use crate::block::Operation;
use crate::method::MethodUnit;

const MEASURED: &str = include_str!("../../docs/hardware.md");

/// A flip-flop with enable, in gate equivalents: what a context's state is made of. As in the table of `docs/hardware.md`.
const FLIP_FLOP: f64 = 7.67;

/// Gate equivalents of one unit: its blocks, of the default sizes, and the registers of its contexts. None if a block was not measured.
pub fn unit_gates(unit: MethodUnit, hardware: &Hardware) -> Option<f64> {
    let blocks: f64 = hardware.blocks(unit.blocks).map(|&operation| block_gates(operation, hardware)).sum::<Option<f64>>()?;
    let context = f64::from(hardware.context_registers(unit.has_levels).kept);
    Some(blocks + hardware.contexts as f64 * context * FLIP_FLOP)
}

fn block_gates(operation: Operation, hardware: &Hardware) -> Option<f64> {
    let (own, default) = (hardware.form(), Hardware::DEFAULT.form());
    let parameter = match operation {
        Operation::TriTest => ("EDGES_PER_CYCLE", own.edges_per_cycle.count(), default.edges_per_cycle.count()),
        Operation::ChildTest => ("BOXES_PER_CYCLE", own.boxes_per_cycle.count(), default.boxes_per_cycle.count()),
        Operation::HitDivide => ("DIVIDE_BITS", own.divide_bits, default.divide_bits),
        Operation::RaySetup => ("SETUP_BITS", own.setup_bits, default.setup_bits),
        _ => ("", 0, 0),
    };
    let form = if let (name, value, usual) = parameter
        && value != usual
    {
        format!("-{name}={value}")
    } else {
        String::new()
    };
    let row = format!("| `{}{form}` | ", operation.name());
    let cells = MEASURED.lines().find_map(|line| line.strip_prefix(&row))?;
    cells.split(" | ").next()?.replace(',', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::{BoxesPerCycle, EdgesPerCycle};
    use crate::method::METHODS;

    #[test]
    fn every_method_with_a_unit_has_an_area() {
        assert!(MEASURED.contains(&format!("| {FLIP_FLOP} |")), "the table of cells has another");
        for method in METHODS.iter().filter(|method| method.unit.is_some()) {
            let unit = method.unit.unwrap();
            let [one, two] = [1, 2].map(|contexts| unit_gates(unit, &Hardware { contexts, ..Hardware::default() }).unwrap());
            let context = f64::from(Hardware::default().context_registers(unit.has_levels).kept) * FLIP_FLOP;
            assert!(one > 1e6 && (two - one - context).abs() < 1e-3, "{}: {one}, {two}", method.name);
            let narrow = Hardware { contexts: 1, edges_per_cycle: EdgesPerCycle::One, ..Hardware::default() };
            assert!(unit_gates(unit, &narrow).unwrap() < one - 4e5);
            let [three, two, single] =
                [3, 2, 1].map(|bits| unit_gates(unit, &Hardware { divide_bits: bits, setup_bits: bits, ..Hardware::default() }).unwrap());
            assert!(single < two && two < three, "{}: {single}, {two}, {three}", method.name);
            let [four, two, single] = [BoxesPerCycle::Four, BoxesPerCycle::Two, BoxesPerCycle::One]
                .map(|boxes_per_cycle| unit_gates(unit, &Hardware { boxes_per_cycle, ..Hardware::default() }).unwrap());
            assert!(single + 6e4 < two && two + 6e4 < four, "{}: {single}, {two}, {four}", method.name);
        }
    }
}
