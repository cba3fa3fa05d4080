//! The registers and queues that carry items, and the arbiter that chooses among them, against plain models.

use crate::draw::Draw;
use crate::suite::{fail, transactions};
use lodray::hardware::ports::MemoryTest;
use lodray::num::{U, Wire};
use std::collections::VecDeque;
use tb::{Build, Direction, Sim};

/// An elastic register of `top`: takes items and gives them in order; `room` of them at most, `ready` depending on the receiver or not.
fn elastic(top: &str, room: usize) {
    let seed = tb::seed(0xe1a5).unwrap_or_else(fail);
    let model = Build::rtl(top).parameter("W", 24).model().unwrap_or_else(fail);
    let mut sim = Sim::new(&model, seed);
    let input = |name, width| sim.port(name, width, Direction::In).unwrap_or_else(fail);
    let (reset, valid_i, ready_i, data_i) = (input("rst_ni", 1), input("valid_i", 1), input("ready_i", 1), input("data_i", 24));
    let output = |name, width| sim.port(name, width, Direction::Out).unwrap_or_else(fail);
    let (ready_o, valid_o, data_o) = (output("ready_o", 1), output("valid_o", 1), output("data_o", 24));

    let mut draw = Draw::new(seed);
    let mut items: VecDeque<U<24>> = VecDeque::new();
    let (mut moved, mut stalled, mut resets) = (0u64, 0u64, 0u64);
    for cycle in 0..transactions() {
        let clears = cycle == 0 || draw.once_in(10_000);
        let (gives, takes, item) = (!draw.once_in(3), !draw.once_in(3), draw.bits::<24>());
        sim.poke(reset, &!clears);
        sim.poke(valid_i, &gives);
        sim.poke(ready_i, &takes);
        sim.poke(data_i, &item);
        sim.eval();
        if cycle > 0 {
            // One cycle after it was taken an item is offered.
            assert_eq!(sim.peek::<bool>(valid_o), !items.is_empty(), "{top}: seed {seed}, cycle {cycle}");
            let ready = items.len() < room || (room == 1 && takes);
            assert_eq!(sim.peek::<bool>(ready_o), ready, "{top}: seed {seed}, cycle {cycle}");
            if let Some(&first) = items.front() {
                assert_eq!(sim.peek::<U<24>>(data_o), first, "{top}: seed {seed}, cycle {cycle}");
                moved += u64::from(takes);
                stalled += u64::from(!takes);
                if takes {
                    items.pop_front();
                }
            }
            if ready && gives {
                items.push_back(item);
            }
        }
        if clears {
            items.clear();
            resets += 1;
        }
        sim.clock();
    }
    println!("{top}: {moved} items moved, {stalled} cycles stalled, {resets} resets");
    assert!(moved > 0 && stalled > 0 && resets > 0);
}

#[test]
fn pipe_stage_loses_and_reorders_nothing() {
    elastic("pipe_stage", 1);
}

#[test]
fn pipe_skid_loses_and_reorders_nothing() {
    elastic("pipe_skid", 2);
}

#[test]
fn hit_queue_is_first_in_first_out() {
    // Not a power of two: the pointers must turn around by themselves.
    const DEPTH: usize = 6;
    let seed = tb::seed(0xf1f0).unwrap_or_else(fail);
    let model = Build::rtl("hit_queue").parameter("W", 24).parameter("DEPTH", DEPTH).model().unwrap_or_else(fail);
    let mut sim = Sim::new(&model, seed);
    let input = |name, width| sim.port(name, width, Direction::In).unwrap_or_else(fail);
    let (reset, push, pop, data_i) = (input("rst_ni", 1), input("push_i", 1), input("pop_i", 1), input("data_i", 24));
    let test = input("test_i", MemoryTest::WIDTH);
    let output = |name, width| sim.port(name, width, Direction::Out).unwrap_or_else(fail);
    let (empty, data_o) = (output("empty_o", 1), output("data_o", 24));

    let mut draw = Draw::new(seed);
    let mut items: VecDeque<U<24>> = VecDeque::new();
    let (mut pushes, mut full, mut both) = (0u64, 0u64, 0u64);
    sim.poke(reset, &false);
    sim.poke(push, &false);
    sim.poke(pop, &false);
    sim.poke(test, &MemoryTest::default());
    sim.clock();
    sim.poke(reset, &true);
    for cycle in 0..transactions() {
        let pops = !items.is_empty() && draw.once_in(2);
        let pushes_now = (items.len() < DEPTH || pops) && draw.once_in(2);
        let item = draw.bits::<24>();
        sim.poke(push, &pushes_now);
        sim.poke(pop, &pops);
        sim.poke(data_i, &item);
        sim.eval();
        assert_eq!(sim.peek::<bool>(empty), items.is_empty(), "seed {seed}, cycle {cycle}");
        if let Some(&first) = items.front() {
            assert_eq!(sim.peek::<U<24>>(data_o), first, "seed {seed}, cycle {cycle}");
        }
        if pops {
            items.pop_front();
        }
        if pushes_now {
            items.push_back(item);
        }
        pushes += u64::from(pushes_now);
        both += u64::from(pushes_now && pops);
        full += u64::from(items.len() == DEPTH);
        sim.clock();
    }
    assert!(!sim.failed());
    println!("hit_queue: {pushes} items, {both} cycles with push and pop, {full} cycles full");
    assert!(pushes > 0 && full > 0 && both > 0);
}

/// `N` requesters for a while; the winner of each cycle is the first at or behind the place after the last one taken.
fn arbiter<const N: u32>() {
    let seed = tb::seed(0xa5b1).unwrap_or_else(fail);
    let model = Build::rtl("arbiter").parameter("N", N).model().unwrap_or_else(fail);
    let mut sim = Sim::new(&model, seed);
    let input = |name, width| sim.port(name, width, Direction::In).unwrap_or_else(fail);
    let (reset, request, take) = (input("rst_ni", 1), input("request_i", N), input("take_i", 1));
    let output = |name, width| sim.port(name, width, Direction::Out).unwrap_or_else(fail);
    let (grant, index) = (output("grant_o", N), output("index_o", 6));

    let mut draw = Draw::new(seed);
    let mut next = 0;
    let mut wins = vec![0u64; N as usize];
    sim.poke(reset, &false);
    sim.clock();
    sim.poke(reset, &true);
    for cycle in 0..transactions() / 4 {
        let some = U::<N>::new(draw.bits::<N>().get() | 1 << draw.below(u64::from(N)));
        let (requests, takes) = (if draw.once_in(4) { draw.bits() } else { some }, !draw.once_in(3));
        sim.poke(request, &requests);
        sim.poke(take, &takes);
        sim.eval();
        let winner = (0..u64::from(N)).map(|k| (next + k) % u64::from(N)).find(|k| requests.get() >> k & 1 == 1);
        assert_eq!(sim.peek::<U<N>>(grant).get(), winner.map_or(0, |k| 1 << k), "N = {N}, seed {seed}, cycle {cycle}");
        assert_eq!(sim.peek::<U<6>>(index).get(), winner.unwrap_or(0), "N = {N}, seed {seed}, cycle {cycle}");
        if let (Some(k), true) = (winner, takes) {
            next = (k + 1) % u64::from(N);
            wins[k as usize] += 1;
        }
        sim.clock();
    }
    println!("arbiter of {N}: wins {wins:?}");
    assert!(wins.iter().all(|&n| n > 0));
}

#[test]
fn arbiter_goes_round() {
    arbiter::<1>();
    arbiter::<5>();
    arbiter::<64>();
}
