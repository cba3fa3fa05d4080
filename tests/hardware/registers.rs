//! The registers that blocks and contexts are counted to have: those that the RTL declares, as slang finds them, and those that synthesis leaves, as
//! `docs/hardware.md` has them.

use lodray::block::node_deciders::NodeDeciders;
use lodray::block::parts::Registers;
use lodray::block::{Block, BoxesPerCycle, EdgesPerCycle, Operation};
use lodray::hardware::{Hardware, Memory};
use lodray_test_support::hardware::{LESS, NARROW, NARROWS, OTHERS, SMALL};

/// Blocks whose registers depend on the levels.
const BY_LEVEL: [Operation; 2] = [Operation::BaryMap, Operation::HitSelect];

/// Blocks whose registers depend on the bits of coordinates and directions.
const BY_WIDTH: [Operation; 5] = [Operation::BoxTest, Operation::ChildTest, Operation::LodTest, Operation::Tessellate, Operation::TriTest];

/// Blocks whose registers depend on the bits of a division's step.
const DIVIDERS: [Operation; 4] = [Operation::HitDivide, Operation::RaySetup, Operation::StartDivide, Operation::StartSetup];

/// Blocks that take the edges of a triangle in turn or at once.
const EDGERS: [Operation; 4] = [Operation::LodTest, Operation::TriTest, Operation::LodTestBy, Operation::StartTest];

/// The default with all at once.
fn all_edges() -> Hardware {
    Hardware { edges_per_cycle: EdgesPerCycle::Three, lod_edges_per_cycle: EdgesPerCycle::Three, ..Hardware::default() }
}

/// The default with so many bits of a division in a cycle.
fn dividing(bits: u32) -> Hardware {
    Hardware { divide_bits: bits, setup_bits: bits, ..Hardware::default() }
}

fn counted(operation: Operation, hardware: &Hardware) -> Registers {
    operation.parts(&hardware.form()).registers
}

fn declared(top: &str, hardware: &Hardware) -> u32 {
    tb::registers(top, &[], hardware).unwrap_or_else(|error| panic!("{top}: {error}"))
}

#[test]
fn blocks_and_contexts_declare_the_registers_that_are_counted() {
    let default = Hardware::default();
    let mut all: Vec<(Operation, Hardware)> = Operation::ALL.map(|operation| (operation, default)).to_vec();
    all.extend(EDGERS.map(|operation| (operation, all_edges())));
    all.extend(
        [BoxesPerCycle::One, BoxesPerCycle::Four].map(|boxes_per_cycle| (Operation::ChildTest, Hardware { boxes_per_cycle, ..default })),
    );
    all.extend([1, 2].into_iter().flat_map(|bits| DIVIDERS.map(|operation| (operation, dividing(bits)))));
    all.extend(OTHERS.iter().flat_map(|&hardware| BY_LEVEL.map(|operation| (operation, hardware))));
    all.extend(NARROWS.iter().flat_map(|&hardware| BY_WIDTH.map(|operation| (operation, hardware))));
    all.extend(LESS.map(|hardware| (Operation::Tessellate, hardware)));
    let mut wrong = Vec::new();
    for (operation, hardware) in &all {
        let (rtl, rust) = (declared(operation.name(), hardware), counted(*operation, hardware));
        println!("{}: {rtl} bits declared, {} kept; {hardware:?}", operation.name(), rust.kept);
        if rtl != rust.declared {
            wrong.push(format!("{}: {rtl} bits in the RTL, {} counted; {hardware:?}", operation.name(), rust.declared));
        }
    }
    // A part of each context that others decide for.
    let (rtl, rust) = (declared(NodeDeciders::NAME, &default), NodeDeciders::parts(&default.form()).registers);
    if rtl != rust.declared {
        wrong.push(format!("node_deciders: {rtl} bits in the RTL, {} counted", rust.declared));
    }
    for hardware in [default].into_iter().chain(OTHERS) {
        let (rtl, rust) = (declared("ray_context", &hardware), hardware.context_registers(true));
        println!("ray_context: {rtl} bits; {hardware:?}");
        if rtl != rust.declared {
            wrong.push(format!("ray_context: {rtl} bits in the RTL, {} counted; {hardware:?}", rust.declared));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Flip-flops of the generic netlist of a block, as `scripts/synth --doc` wrote them.
fn flip_flops(block: &str) -> u32 {
    let table = include_str!("../../docs/hardware.md");
    let row = table.lines().find(|line| line.starts_with(&format!("| `{block}` |"))).unwrap_or_else(|| panic!("no row for {block}"));
    row.split('|').nth(3).and_then(|cell| cell.trim().replace(',', "").parse().ok()).unwrap_or_else(|| panic!("no number in {row}"))
}

#[test]
fn what_is_kept_are_the_flip_flops_of_the_netlists() {
    // Bits that synthesis drops besides: products with a limb of one bit are no multiplications, and some signs repeat. At most 1 in 180.
    let edge_function = 22i64;
    let besides = |block: &str| match block {
        "tri_test-EDGES_PER_CYCLE=3" => 3 * edge_function,
        "tri_test" => edge_function,
        "start_test" => 49,
        // And a sign of each of its multipliers stays that repeats.
        "child_prisms" => -4,
        // Signs of the direction and what they are taken with stand in `ray_setup` too.
        "start_setup" => 6,
        _ => 0,
    };
    let default = Hardware::default();
    let mut wrong = Vec::new();
    let named = Operation::ALL.map(|operation| (operation.name(), counted(operation, &default)));
    let further = [
        ("tri_test-EDGES_PER_CYCLE=3", counted(Operation::TriTest, &all_edges())),
        ("lod_test-EDGES_PER_CYCLE=3", counted(Operation::LodTest, &all_edges())),
        ("child_test-BOXES_PER_CYCLE=4", counted(Operation::ChildTest, &Hardware { boxes_per_cycle: BoxesPerCycle::Four, ..default })),
        ("child_test-BOXES_PER_CYCLE=1", counted(Operation::ChildTest, &Hardware { boxes_per_cycle: BoxesPerCycle::One, ..default })),
        ("hit_divide-DIVIDE_BITS=2", counted(Operation::HitDivide, &dividing(2))),
        ("hit_divide-DIVIDE_BITS=1", counted(Operation::HitDivide, &dividing(1))),
        ("ray_setup-SETUP_BITS=2", counted(Operation::RaySetup, &dividing(2))),
        ("ray_setup-SETUP_BITS=1", counted(Operation::RaySetup, &dividing(1))),
    ];
    for (name, registers) in named.into_iter().chain(further) {
        println!("{name}: {} declared, {} kept, {} in the netlist", registers.declared, registers.kept, flip_flops(name));
        if i64::from(registers.kept) != i64::from(flip_flops(name)) + besides(name) {
            wrong.push(format!("{name}: {} counted, {} in the netlist", registers.kept, flip_flops(name)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_context_has_the_flip_flops_and_memories_of_its_netlist() {
    let hardware = Hardware::default();
    let memories: u32 = hardware.context_memories(true).iter().map(Memory::bits).sum();
    let (counted, found) = (hardware.context_flip_flops(true), flip_flops("ray_context"));
    println!("ray_context: {counted} flip-flops counted, {found} in the netlist, {memories} bits in memories");
    // Bits of a record that nothing reads.
    assert!(found <= counted && counted - found < counted / 100);
    assert_eq!(memories, 18_669);
}

#[test]
fn hardware_for_less_is_smaller() {
    let [default, small] = [Hardware::default(), SMALL].map(|hardware| hardware.context_registers(true).kept);
    println!("a context: {default} bits for 10 levels below 24, {small} for {} below {}", SMALL.levels, SMALL.bvh_depth);
    assert!(small * 10 < default * 7);
    let less = BY_LEVEL.map(|operation| (operation, SMALL)).into_iter().chain(BY_WIDTH.map(|operation| (operation, NARROW)));
    for (operation, hardware) in less {
        let Hardware { edges_per_cycle, lod_edges_per_cycle, boxes_per_cycle, .. } = hardware;
        let alike = Hardware { edges_per_cycle, lod_edges_per_cycle, boxes_per_cycle, ..Hardware::default() };
        let [default, small] = [alike, hardware].map(|hardware| counted(operation, &hardware).kept);
        println!("{}: {default} and {small} bits", operation.name());
        assert!(small < default);
    }
}
