//! The adapter between a memory port and a memory: every line, tag and error, every request's burst, no cycle lost.

use crate::bus::{Bus, Manners, Memory, Request, SMOOTH, input, output};
use lodray::hardware::ports::{MemoryAnswer, MemoryRequest};
use lodray::num::{LineAddress, U, Wire};
use lodray_test_support::models::Rng;
use std::collections::BTreeMap;
use tb::{Build, Sim};

/// What lies at a byte address: no two words alike.
fn word(address: u64) -> u32 {
    (address.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as u32
}

/// The line at a byte address: the byte of the lowest address lowest.
fn line(address: u64) -> [U<64>; 4] {
    std::array::from_fn(|k| {
        let at = address + 8 * k as u64;
        U::new(u64::from(word(at)) | u64::from(word(at + 4)) << 32)
    })
}

/// Requests of a run: `LODRAY_TRANSACTIONS`, or a hundred thousand.
fn transactions() -> u64 {
    let parse = |text: String| text.replace('_', "").parse().unwrap_or_else(|_| panic!("LODRAY_TRANSACTIONS={text}: not a number"));
    std::env::var("LODRAY_TRANSACTIONS").map_or(100_000, parse)
}

/// Cycles of a run, most reads under way, beats between those of another read, and answers with errors.
struct Ran {
    cycles: u64,
    most: usize,
    between: u64,
    wrong: u64,
}

/// Takes so many requests through an adapter of `READS` places; `pauses` of eight cycles none is offered.
fn lines<const N: usize, const ID: u32>(reads: u64, manners: Manners, pauses: u64, count: u64) -> Ran {
    let seed = tb::seed(0xa41).unwrap_or_else(|error| panic!("{error}"));
    let model = Build::rtl("axi_read_adapter").parameter("DATA_W", 32 * N).parameter("READS", reads).model();
    let mut sim = Sim::new(&model.unwrap_or_else(|error| panic!("{error}")), seed);
    let bus = Bus::<N, ID, 64>::new(&sim);
    let (reset, base_i, busy) = (input::<bool>(&sim, "rst_ni"), input::<U<64>>(&sim, "base_i"), output::<bool>(&sim, "busy_o"));
    let (valid_i, mem_i) = (input::<bool>(&sim, "mem_valid_i"), input::<MemoryRequest>(&sim, "mem_i"));
    let (ready, valid_o) = (output::<bool>(&sim, "mem_ready_o"), output::<bool>(&sim, "mem_valid_o"));
    let mem_o = output::<MemoryAnswer>(&sim, "mem_o");

    let mut rng = Rng(seed);
    // Anywhere, up to the last line that the bus has.
    let base = (rng.draw() >> 1) & !31;
    let mut memory = Memory::new(manners, rng.draw(), word);
    sim.poke(base_i, &U::<64>::new(base));
    sim.poke(valid_i, &false);
    sim.poke(reset, &false);
    bus.drive(&mut sim, false, None, &mut rng);
    sim.clock();
    sim.poke(reset, &true);

    // Requests by tag and epoch until they are answered, those on their way to the bus, and the one that is offered.
    let mut due: BTreeMap<[u64; 2], u64> = BTreeMap::new();
    let mut asked: Vec<u64> = Vec::new();
    let mut offered: Option<MemoryRequest> = None;
    let (mut sent, mut answered, mut wrong, mut cycles, mut quiet) = (0, 0, 0, 0, 0);
    let what = format!("{} bits, {reads} reads, {manners:?}, seed {seed}", 32 * N);
    while answered < count {
        // A reset of both sides forgets all that is under way.
        if manners.latency.0 < manners.latency.1 && rng.below(2000) == 0 {
            sim.poke(reset, &false);
            sim.clock();
            sim.poke(reset, &true);
            memory.forget();
            (due, asked, offered, sent) = (BTreeMap::new(), Vec::new(), None, answered);
        }
        // The answers of the last cycle's last beat.
        let beat = memory.beat();
        let ended = beat.is_some_and(|beat| beat.last);
        if offered.is_none() && sent < count && rng.below(8) >= pauses {
            let mark = std::iter::repeat_with(|| [rng.below(256), rng.below(256)]).find(|mark| !due.contains_key(mark)).unwrap_or_default();
            let [tag, epoch] = mark.map(U::new);
            offered = Some(MemoryRequest { tag, epoch, address: U::new(rng.draw() >> (64 - LineAddress::WIDTH)) });
        }
        let takes = memory.ready();
        bus.drive(&mut sim, takes, beat, &mut rng);
        sim.poke(valid_i, &offered.is_some());
        let rubbish = MemoryRequest { tag: U::new(rng.below(256)), epoch: U::new(rng.below(256)), address: U::new(rng.draw() >> 40) };
        sim.poke(mem_i, &offered.unwrap_or(rubbish));
        sim.eval();
        // The place of an answer is free already when it is given.
        let places = due.len() - usize::from(sim.peek::<bool>(valid_o));
        assert_eq!(sim.peek::<bool>(busy), places > 0, "{what}: busy_o");
        if let Some(request) = bus.request(&mut sim).filter(|_| takes) {
            let at = asked.iter().position(|address| *address == request.address).unwrap_or_else(|| panic!("{what}: {request:?}"));
            asked.remove(at);
            let Request { len, size, id, .. } = request;
            assert!(len + 1 == Bus::<N, ID, 64>::BEATS && size == Bus::<N, ID, 64>::SIZE && id < reads, "{what}: {request:?}");
            memory.take(request);
        }
        quiet += 1;
        if sim.peek::<bool>(valid_o) {
            let answer: MemoryAnswer = sim.peek(mem_o);
            let mark = [answer.tag.get(), answer.epoch.get()];
            let address = due.remove(&mark).unwrap_or_else(|| panic!("{what}: an answer with tag and epoch {mark:?}"));
            let (last, error) = memory.finished.pop_front().unwrap_or_else(|| panic!("{what}: an answer before its last beat"));
            assert_eq!((address, answer.error), (last, error), "{what}");
            assert_eq!(answer.line, line(address), "{what}: line at {address:#x}");
            (answered, wrong, quiet) = (answered + 1, wrong + u64::from(error), 0);
        }
        // One cycle behind its last beat.
        assert_eq!(memory.finished.len(), usize::from(ended), "{what}: an answer came late");
        if let Some(request) = offered.filter(|_| sim.peek::<bool>(ready)) {
            let address = base + 32 * request.address.get();
            due.insert([request.tag.get(), request.epoch.get()], address);
            asked.push(address);
            (sent, offered, quiet) = (sent + 1, None, 0);
        }
        assert!(quiet < 1000, "{what}: nothing moves");
        sim.clock();
        cycles += 1;
    }
    assert!(!sim.failed(), "{what}: an assertion of the RTL failed");
    Ran { cycles, most: memory.most, between: memory.between, wrong }
}

/// Any traffic at one width.
fn any_traffic<const N: usize, const ID: u32>(reads: u64) {
    let mut seen = Ran { cycles: 0, most: 0, between: 0, wrong: 0 };
    for (refuses, rests, latency, interleaves, pauses) in
        [(0, 0, (1, 1), false, 0), (4, 0, (1, 40), true, 2), (1, 5, (1, 9), true, 0), (6, 2, (3, 100), false, 1), (0, 0, (1, 60), true, 6)]
    {
        let errors = if latency.1 > 1 { 40 } else { 0 };
        let ran = lines::<N, ID>(reads, Manners { refuses, rests, latency, interleaves, errors }, pauses, transactions() / 5);
        seen = Ran {
            cycles: seen.cycles + ran.cycles,
            most: seen.most.max(ran.most),
            between: seen.between + ran.between,
            wrong: seen.wrong + ran.wrong,
        };
    }
    let Ran { cycles, most, between, wrong } = seen;
    println!("{} bits, {reads} reads: {cycles} cycles, {most} reads under way, {between} beats between others, {wrong} errors", 32 * N);
    assert!(most as u64 == reads && wrong > 0 && (between > 0) == (N < 8));
}

#[test]
fn lines_of_one_beat() {
    any_traffic::<8, 3>(8);
}

#[test]
fn lines_of_two_beats() {
    any_traffic::<4, 3>(7);
}

#[test]
fn lines_of_four_beats() {
    any_traffic::<2, 1>(2);
}

#[test]
fn lines_of_eight_beats() {
    any_traffic::<1, 4>(16);
}

#[test]
fn no_cycle_is_lost() {
    const LATENCY: u64 = 10;
    const COUNT: u64 = 1000;
    let manners = Manners { latency: (LATENCY, LATENCY), ..SMOOTH };
    // A line's beats a line, as soon as the way there and back is over: the register of the request, the memory, the register of the answer.
    let whole = |beats| COUNT * beats + 1 + LATENCY + 1;
    let cycles = [lines::<8, 4>(16, manners, 0, COUNT), lines::<4, 4>(16, manners, 0, COUNT), lines::<2, 4>(16, manners, 0, COUNT)]
        .map(|ran| ran.cycles);
    assert_eq!(cycles, [1, 2, 4].map(whole));
}
