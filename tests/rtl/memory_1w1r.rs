//! The memory of the unit: every word as it was written, and with a parity bit every wrong one told, when it is used.

use crate::draw::Draw;
use crate::suite::{fail, transactions};
use lodray::hardware::ports::MemoryTest;
use lodray::num::{U, Wire};
use tb::{Build, Direction, Sim};

const WORDS: usize = 11;
const W: u32 = 37;

/// Random writes and reads, some words of wrong parity, for `count` cycles; `parity` is whether the memory has a bit for it.
fn play(parity: bool, count: u64) {
    let seed = tb::seed(0x1d0).unwrap_or_else(fail);
    let build = Build::rtl("memory_1w1r").parameter("W", W).parameter("WORDS", WORDS).parameter("PARITY", u32::from(parity));
    let mut sim = Sim::new(&build.model().unwrap_or_else(fail), seed);
    let port = |name, width, direction| sim.port(name, width, direction).unwrap_or_else(fail);
    let input = |name, width| port(name, width, Direction::In);
    let (test, used) = (input("test_i", MemoryTest::WIDTH), input("use_i", 1));
    let (write, write_place, data_i) = (input("write_i", 1), input("write_place_i", 4), input("data_i", W));
    let (read, read_place) = (input("read_i", 1), input("read_place_i", 4));
    let (data_o, fault) = (port("data_o", W, Direction::Out), port("fault_o", 1, Direction::Out));

    let mut draw = Draw::new(seed);
    // Of each place what was written there, and whether its parity is wrong; and what was read last.
    let mut words: [Option<(U<W>, bool)>; WORDS] = [None; WORDS];
    let mut last = None;
    let (mut read_back, mut told, mut kept_to_itself) = (0u64, 0u64, 0u64);
    for cycle in 0..count {
        let (place, word, wrong) = (draw.below(WORDS as u64) as usize, draw.bits::<W>(), draw.once_in(5));
        let at = draw.below(WORDS as u64) as usize;
        // Never the same place in one cycle.
        let (writes, reads, uses) = (draw.once_in(2), at != place && draw.once_in(2), draw.once_in(2));
        sim.poke(test, &MemoryTest { flip: wrong, pins: draw.bits() });
        sim.poke(write, &writes);
        sim.poke(write_place, &U::<4>::new(place as u64));
        sim.poke(data_i, &word);
        sim.poke(read, &reads);
        sim.poke(read_place, &U::<4>::new(at as u64));
        sim.poke(used, &uses);
        sim.eval();
        if let Some((word, wrong)) = last {
            assert_eq!(sim.peek::<U<W>>(data_o), word, "seed {seed}, cycle {cycle}");
            assert_eq!(sim.peek::<bool>(fault), parity && wrong && uses, "seed {seed}, cycle {cycle}");
            read_back += 1;
            told += u64::from(wrong && uses);
            kept_to_itself += u64::from(wrong && !uses);
        }
        if reads {
            last = words[at];
        }
        if writes {
            words[place] = Some((word, wrong));
        }
        sim.clock();
    }
    println!("memory_1w1r, parity {parity}: {read_back} words seen, {told} wrong ones used, {kept_to_itself} not");
    assert!(read_back > 0 && told > 0 && kept_to_itself > 0);
}

#[test]
fn words_come_back() {
    play(false, transactions() / 4);
}

#[test]
fn a_word_that_changed_is_told() {
    play(true, transactions() / 4);
}
