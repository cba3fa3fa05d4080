//! Area of a traversal unit, from what `scripts/synth` measured of its blocks (`docs/hardware.md`).

use super::{Hardware, Memory};
use crate::block::Operation;
use crate::method::MethodUnit;

const MEASURED: &str = include_str!("../../docs/hardware.md");

/// A flip-flop with enable, in gate equivalents: what a context's state is made of. As in the table of `docs/hardware.md`.
const FLIP_FLOP: f64 = 7.67;

/// A memory: gate equivalents of a bit, of a column, of a word, and of its control (`docs/hardware.md`, "Memories").
const BIT: f64 = 1.0;
const COLUMN: f64 = 12.0;
const WORD: f64 = 4.0;
const CONTROL: f64 = 250.0;

/// The logic of a context, without registers and memories: of the default, such that a context has what it has in the unit whole. Less hardware has less.
const CONTEXT_LOGIC: f64 = 13_555.0;

/// Gate equivalents of a memory.
fn memory_gates(memory: &Memory) -> f64 {
    f64::from(memory.bits()) * BIT + f64::from(memory.width) * COLUMN + f64::from(memory.words) * WORD + CONTROL
}

/// Gate equivalents of a ray context: flip-flops, memories and logic.
pub fn context_gates(hardware: &Hardware, has_levels: bool) -> f64 {
    let memories: f64 = hardware.context_memories(has_levels).iter().map(memory_gates).sum();
    f64::from(hardware.context_flip_flops(has_levels)) * FLIP_FLOP + memories + CONTEXT_LOGIC
}

/// Gate equivalents of one unit: its blocks, of the default sizes, and its contexts. None if a block was not measured.
pub fn unit_gates(unit: MethodUnit, hardware: &Hardware) -> Option<f64> {
    let blocks: f64 = hardware.blocks(unit.blocks).map(|operation| block_gates(operation, hardware)).sum::<Option<f64>>()?;
    Some(blocks + hardware.contexts as f64 * context_gates(hardware, unit.has_levels))
}

/// Gate equivalents of a block of this hardware: of all of its kind, with what lets them take turns, as measured of the default's. None if it was not measured.
pub fn block_gates(operation: Operation, hardware: &Hardware) -> Option<f64> {
    let (copies, one) = (hardware.copies(operation), one_block_gates(operation, hardware)?);
    if copies == 1 {
        return Some(one);
    }
    let turns = hardware.module(operation);
    let usual = if turns == "setup_copies" { Operation::RaySetup } else { Operation::HitDivide };
    let beside = block_row(&format!("{turns}-COPIES={copies}"))? - f64::from(copies) * one_block_gates(usual, &Hardware::DEFAULT)?;
    Some(f64::from(copies) * one + beside)
}

fn one_block_gates(operation: Operation, hardware: &Hardware) -> Option<f64> {
    let (own, default) = (hardware.form(), Hardware::DEFAULT.form());
    let parameter = match operation {
        Operation::LodTest | Operation::LodTestBy => {
            ("EDGES_PER_CYCLE", own.lod_edges_per_cycle.count(), default.lod_edges_per_cycle.count())
        }
        Operation::TriTest | Operation::StartTest => ("EDGES_PER_CYCLE", own.edges_per_cycle.count(), default.edges_per_cycle.count()),
        Operation::ChildTest => ("BOXES_PER_CYCLE", own.boxes_per_cycle.count(), default.boxes_per_cycle.count()),
        Operation::HitDivide | Operation::StartDivide => ("DIVIDE_BITS", own.divide_bits, default.divide_bits),
        Operation::RaySetup | Operation::StartSetup => ("SETUP_BITS", own.setup_bits, default.setup_bits),
        _ => ("", 0, 0),
    };
    let form = if let (name, value, usual) = parameter
        && value != usual
    {
        format!("-{name}={value}")
    } else {
        String::new()
    };
    block_row(&format!("{}{form}", operation.name()))
}

/// Gate equivalents in the row of that name.
fn block_row(name: &str) -> Option<f64> {
    let row = format!("| `{name}` | ");
    let cells = MEASURED.lines().find_map(|line| line.strip_prefix(&row))?;
    cells.split(" | ").next()?.replace(',', "").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::{BoxesPerCycle, EdgesPerCycle};
    use crate::method::{METHODS, rlod};

    #[test]
    fn a_context_has_what_was_measured() {
        let counted = context_gates(&Hardware::default(), true);
        // Flip-flops without enable are smaller than those that are counted, and some bits are of no use.
        let (_, rest) = MEASURED.split_once("A context has ").unwrap();
        let measured: f64 = rest.split(' ').next().unwrap().replace(',', "").parse().unwrap();
        assert!(measured <= counted && counted - measured < measured / 50.0, "{counted}, {measured}");
        // By itself it has more: in the unit some of its operands are known.
        let alone = block_row("ray_context").unwrap();
        assert!(measured < alone && alone - counted < alone / 50.0, "{counted}, {alone}");
        assert!(counted < 60_000.0, "{counted}");
    }

    #[test]
    fn every_method_with_a_unit_has_an_area() {
        assert!(MEASURED.contains(&format!("| {FLIP_FLOP} |")), "the table of cells has another");
        for method in METHODS.iter().filter(|method| method.unit.is_some()) {
            let unit = method.unit.unwrap();
            let [one, two] = [1, 2].map(|contexts| unit_gates(unit, &Hardware { contexts, ..Hardware::default() }).unwrap());
            let context = context_gates(&Hardware::default(), unit.has_levels);
            assert!(one > 3e5 && (two - one - context).abs() < 1e-3, "{}: {one}, {two}", method.name);
            // Each way to do more in a cycle, and by how much it is larger at least.
            let of = |hardware: Hardware| unit_gates(unit, &hardware).unwrap();
            let larger = |least: f64, gates: &[f64]| {
                assert!(gates.windows(2).all(|pair| pair[0] + least < pair[1]), "{}: {gates:?}", method.name);
            };
            let default = Hardware::default();
            larger(4e5, &EdgesPerCycle::ALL.map(|edges_per_cycle| of(Hardware { edges_per_cycle, ..default })));
            let boxes = BoxesPerCycle::ALL.map(|boxes_per_cycle| of(Hardware { boxes_per_cycle, ..default }));
            // Nodes of two children never have more than two boxes to test.
            let are_two = unit.blocks.iter().filter(|&&block| block == Operation::BoxTest32).count() == 2;
            // Nor does a kd-tree have any: its splits are works of its own.
            let has_none = method.name == rlod::METHOD.name;
            larger(6e4, if are_two { &boxes[..2] } else { &boxes[..if has_none { 1 } else { 3 }] });
            assert!(!are_two || boxes[1] == boxes[2], "{}: {boxes:?}", method.name);
            assert!(!has_none || boxes == [boxes[0]; 3], "{}: {boxes:?}", method.name);
            larger(0.0, &[1, 2, 3].map(|bits| of(Hardware { divide_bits: bits, setup_bits: bits, ..default })));
            larger(5e4, &[1, 2, 3, 4].map(|copies| of(Hardware { setup_copies: copies, divide_copies: copies, ..default })));
            let lod = EdgesPerCycle::ALL.map(|lod_edges_per_cycle| of(Hardware { lod_edges_per_cycle, ..default }));
            if unit.blocks.contains(&Operation::LodTest) { larger(1e5, &lod) } else { assert_eq!(lod[0], lod[1]) }
        }
    }
}
