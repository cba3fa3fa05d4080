//! The stack against its Rust twin, operation by operation.

use crate::draw::Draw;
use crate::suite::{fail, transactions};
use lodray::hardware::Hardware;
use lodray::hardware::ports::MemoryTest;
use lodray::method::{Entry, Op, TraversalStack};
use lodray::num::{U, Wire};
use tb::{Build, Direction, Sim};

/// Any that the hardware can meet.
fn entry(hardware: &Hardware, draw: &mut Draw) -> Entry {
    let any = Entry {
        t_near: draw.bits(),
        kind: U::new(draw.below(3)),
        level: draw.bits(),
        index: draw.bits(),
        e0: draw.bits(),
        e1: draw.bits(),
        e2: draw.bits(),
    };
    let index = U::new(any.index.get() & ((1 << hardware.index_bits) - 1));
    match hardware.split_triangles() {
        0 => Entry { index, t_near: any.t_near, kind: any.kind, ..Entry::default() },
        _ => Entry { index, ..any },
    }
}

#[test]
fn rtl_equals_rust() {
    play(&Hardware::default(), transactions());
}

/// As deep as the hardware's, for `count` cycles.
pub fn play(hardware: &Hardware, count: u64) {
    let room = hardware.stack_entries() as usize;
    let seed = tb::seed(0x57ac).unwrap_or_else(fail);
    let model = Build::rtl("traversal_stack").hardware(hardware).and_then(|build| build.model()).unwrap_or_else(fail);
    let mut sim = Sim::new(&model, seed);
    let port = |name, width, direction| sim.port(name, width, direction).unwrap_or_else(fail);
    let (clear, push, pop) = (port("clear_i", 1, Direction::In), port("push_i", 1, Direction::In), port("pop_i", 1, Direction::In));
    let (entry_i, entry_o) = (port("entry_i", Entry::WIDTH, Direction::In), port("entry_o", Entry::WIDTH, Direction::Out));
    let (empty, reset) = (port("empty_o", 1, Direction::Out), port("rst_ni", 1, Direction::In));
    sim.poke(port("test_i", MemoryTest::WIDTH, Direction::In), &MemoryTest::default());

    let mut draw = Draw::new(seed);
    let mut stack = TraversalStack::default();
    let (mut pushes, mut pops, mut clears, mut full, mut drained) = (0u64, 0u64, 0u64, 0u64, 0u64);
    for p in [clear, push, pop, reset] {
        sim.poke(p, &false);
    }
    sim.clock();
    sim.poke(reset, &true);
    // Long climbs and long falls, so that both ends are met.
    let mut climbing = true;
    // In the cycle after a push the top is not there.
    let mut pushed = false;
    for _ in 0..count {
        climbing ^= draw.once_in(300);
        let wants_push = draw.below(8) < if climbing { 6 } else { 2 };
        let does_clear = draw.once_in(5000);
        let does_push = !does_clear && wants_push && stack.len() < room;
        let does_pop = !does_clear && !does_push && !stack.is_empty() && !pushed && draw.below(8) < 7;
        let item = entry(hardware, &mut draw);
        sim.poke(clear, &does_clear);
        sim.poke(push, &does_push);
        sim.poke(pop, &does_pop);
        sim.poke(entry_i, &item);
        sim.eval();
        let cycle = sim.cycle();
        assert_eq!(sim.peek::<bool>(empty), stack.is_empty(), "seed {seed}, cycle {cycle}");
        if !stack.is_empty() && !pushed {
            let top = stack.clone().step(Op::Pop);
            assert_eq!(Some(sim.peek::<Entry>(entry_o)), top, "seed {seed}, cycle {cycle}");
        }
        if does_clear {
            stack.clear();
        } else if does_push {
            stack.step(Op::Push(item));
        } else if does_pop {
            stack.step(Op::Pop);
            drained += u64::from(stack.is_empty());
        }
        (pushes, pops, clears) = (pushes + u64::from(does_push), pops + u64::from(does_pop), clears + u64::from(does_clear));
        full += u64::from(does_push && stack.len() == room);
        pushed = does_push;
        sim.clock();
    }
    assert!(!sim.failed());
    println!("traversal_stack of {room}: {pushes} pushes, {pops} pops, {clears} clears, {full} times full, {drained} times emptied");
    assert!([pushes, pops, clears, full, drained].iter().all(|&n| n > 0));
}
