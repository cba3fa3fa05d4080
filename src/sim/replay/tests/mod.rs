//! Machines small enough to be worked out by hand.

mod order;
mod stores;

use super::feed::Feed;
use super::group_side::GroupSide;
use super::*;
use crate::block::Operation;
use crate::num::Random;
use crate::sim::dram::Dram;
use crate::step::{Act, Batch, Fetch, MemoryMap, NodeShape, Section, SectionId, Step};
use std::collections::HashSet;

/// One core, and the keys that are set.
fn machine(sets: &[(&str, u32)]) -> Machine {
    let mut machine = Machine::shipped("haydel2023").unwrap();
    for (key, value) in [("cores.groups", 1), ("cores.per_group", 1)].iter().chain(sets) {
        machine.set(key, &value.to_string()).unwrap();
    }
    machine
}

const LEAVES: SectionId = SectionId::new(0);

/// No node is pinned.
fn nodes() -> Nodes {
    Nodes::default()
}

/// Rays in one batch; each reads its lines one after the other.
fn rays(lines: &[Vec<u32>]) -> Chunk {
    let ray = |lines: &Vec<u32>| {
        // A triangle test between two lines keeps them from being asked for together.
        let line = |&line: &u32| [Step::on(Fetch::new(LEAVES, line, 1), Act::Fetch), Step::of(Act::Triangles { count: 1, hits: 0 })];
        lines.iter().flat_map(line).chain([Step::end(false, false)]).collect()
    };
    Chunk::from([Batch::new(&lines.iter().map(ray).collect::<Vec<_>>())])
}

fn run(machine: &Machine, lines: &[Vec<u32>]) -> Run {
    run_free(machine, nodes(), std::iter::once(rays(lines)), Running::default()).unwrap()
}

/// Cycles on the way to the L2's miss, and back from memory.
fn way(machine: &Machine) -> (u64, u64) {
    let there = machine.l1.latency_cycles + machine.crossbar.request_cycles + machine.l2.latency_cycles;
    (there.into(), machine.crossbar.answer_cycles.into())
}

#[test]
fn a_chase_in_the_l1_takes_its_latency_each_time() {
    for latency in [1, 3, 20] {
        let machine = machine(&[("l1.latency_cycles", latency)]);
        let cold = run(&machine, &[vec![5]]).cycles;
        let chased = run(&machine, &[vec![5; 101]]);
        assert_eq!(chased.cycles - cold, 100 * u64::from(latency));
        assert_eq!((chased.counts.l1.hits, chased.counts.l1.misses), (100, 1));
        assert_eq!(chased.counts.waits.l1, 100 * u64::from(latency));
    }
}

#[test]
fn a_chase_in_the_l2_takes_the_sum_of_the_table() {
    for (l1, request, l2, answer) in [(1, 1, 4, 1), (2, 3, 5, 7)] {
        let keys = [
            ("l1.latency_cycles", l1),
            ("crossbar.request_cycles", request),
            ("l2.latency_cycles", l2),
            ("crossbar.answer_cycles", answer),
        ];
        let machine = machine(&keys);
        // Three lines of one set of two ways: each evicts the one that comes next.
        let apart = machine.l1.sets_per_bank() as u32 * machine.l1.banks;
        let lap = [0, apart, 2 * apart];
        let laps = |count: usize| run(&machine, &[lap.repeat(count)]);
        let (one, many) = (laps(1), laps(11));
        assert_eq!(many.cycles - one.cycles, 30 * u64::from(l1 + request + l2 + answer));
        assert_eq!((many.counts.l1.hits, many.counts.l2.hits, many.counts.l2.misses), (0, 30, 3));
    }
}

#[test]
fn a_lines_way_is_charged_stretch_by_stretch() {
    let machine =
        machine(&[("l1.latency_cycles", 2), ("crossbar.request_cycles", 3), ("l2.latency_cycles", 5), ("crossbar.answer_cycles", 7)]);
    let run = run(&machine, &[vec![5, 5]]);
    let of = |cause: Cause| run.counts.stalls[cause as usize];
    // Missed, and then found.
    assert_eq!([of(Cause::L1LookUp), of(Cause::CrossbarRequest), of(Cause::L2LookUp), of(Cause::CrossbarAnswer)], [4, 3, 5, 7]);
    let memory = [Cause::DramOpening, Cause::DramAccess, Cause::DramBank].map(of);
    let t = &dram_of(&machine).unwrap().device.timing;
    let cycles = |clocks: u64| clocks * 800 * 2000 / 1_000_000;
    // Half a clock is a cycle: the command waits for its clock.
    assert!(
        memory[0].abs_diff(cycles(t.n_rcd_rd)) <= 2 && memory[1].abs_diff(cycles(t.n_cl + t.n_bl)) <= 2 && memory[2] <= 2,
        "{memory:?}"
    );
    assert_eq!(run.counts.stalls.iter().sum::<u64>(), run.cycles);
    assert_eq!(memory.iter().sum::<u64>() + 19, run.cycles);
    assert_eq!(run.latencies.rays.steps().map(|step| step.1).sum::<u64>(), 1);
}

#[test]
fn rays_that_want_one_line_wait_for_the_rest_of_its_way() {
    // The second core asks in the same cycle, is served a cycle later, and merges.
    let machine = machine(&[("cores.per_group", 2), ("l1.banks", 1)]);
    let run = run(&machine, &[vec![5], vec![5]]);
    assert_eq!(run.counts.l1.merges, 1);
    let of = |cause: Cause| run.counts.stalls[cause as usize];
    assert_eq!([of(Cause::L1Turn), of(Cause::L1LookUp), of(Cause::L2LookUp), of(Cause::CrossbarAnswer)], [1, 1, 8, 2]);
    assert_eq!(run.counts.stalls.iter().sum::<u64>(), 2 * run.cycles);
    // One miss register: another line waits until it is free.
    let few = self::machine(&[("cores.per_group", 2), ("l1.banks", 1), ("l1.mshrs", 1)]);
    let (both, one) = (self::run(&few, &[vec![5], vec![9]]), self::run(&few, &[vec![5]]));
    let still = both.counts.stalls[Cause::L1Mshr as usize];
    assert_eq!(both.counts.stalls[Cause::L1Turn as usize], 1);
    assert_eq!(still + 1, one.cycles, "from its turn to the line of the first");
}

#[test]
fn a_chase_in_memory_takes_the_way_and_the_memorys_own_time() {
    for device in ["dram/gddr5.toml", "dram/gddr6.toml", "dram/ddr3-scaled.toml"] {
        let mut machine = machine(&[("dram.channels", 1)]);
        machine.set("dram.device", device).unwrap();
        // Neighbours (rows hit), and jumps by a row of every bank (conflicts).
        for stride in [1, 1 << 13] {
            let lines: Vec<u32> = (0..200).map(|k| k * stride).collect();
            let run = run(&machine, std::slice::from_ref(&lines));
            let config = dram_of(&machine).unwrap();
            let (there, back) = way(&machine);
            let mut dram = Dram::new(&config).unwrap();
            let mut cycle = 0;
            for (id, &line) in lines.iter().enumerate() {
                let pushed = machine.cores.start_ps(cycle + there);
                let mut end = None;
                dram.advance(pushed, &mut |_, _| ());
                dram.push(pushed, u64::from(line), id as u64, false);
                while end.is_none() {
                    let next = dram.next_event().unwrap();
                    dram.advance(next, &mut |_, ps| end = Some(ps));
                }
                cycle = machine.cores.cycle_at(end.unwrap()) + back;
            }
            assert_eq!(run.cycles, cycle, "{device}, stride {stride}");
            let channel = run.channels[0];
            assert_eq!(channel.reads, 200);
            if stride == 1 {
                assert!(channel.row_hits > 180, "{channel:?}");
            } else {
                assert!(channel.row_hits < 20, "{channel:?}");
            }
        }
    }
}

#[test]
fn pinned_nodes_are_not_asked_for() {
    type Test = fn(u32) -> Act;
    let tests: [(Test, u32); 5] = [
        (|met| Act::Children { shape: NodeShape::Tree, met }, 1),
        (|met| Act::Children { shape: NodeShape::Local, met }, 1),
        (|met| Act::Children { shape: NodeShape::Plain, met }, 2),
        (|met| Act::Children { shape: NodeShape::Wide, met }, 4),
        (|met| Act::Children { shape: NodeShape::Six, met }, 2),
    ];
    for (test, lines) in tests {
        let sections = ["node", "leaf"].map(|name| Section::of_bytes(name, 64 * 32));
        let layout = MemoryMap::new(&sections, Some((SectionId::new(0), lines))).unwrap().nodes();
        let node = |(number, met): (u32, u32)| Step::on(Fetch::new(SectionId::new(0), number * lines, lines), test(met)).visiting();
        let nodes = [(0, 1), (1, 1), (2, 1), (3, 1), (0, 0)].map(node);
        // Lines of other data are asked for, however many nodes there could be.
        let other = Step::on(Fetch::new(SectionId::new(1), 64, 1), Act::Fetch);
        let end = [other, Step::end(false, false)];
        let chunk = Chunk::from([Batch::new(&[nodes.into_iter().chain(end).collect()])]);
        // Steps without lines are no nodes.
        let pops = nodes.into_iter().flat_map(|node| [node, Step::of(Act::Pop { dropped: false })]).chain(end);
        let with_pops = Chunk::from([Batch::new(&[pops.collect()])]);
        for (pinned, asked) in [(0, 5), (1, 3), (3, 1), (9, 0), (4000, 0)] {
            let machine = machine(&[("cores.pinned_nodes", pinned)]);
            for chunk in [&chunk, &with_pops] {
                let run = run_free(&machine, layout, std::iter::once(chunk.clone()), Running::default()).unwrap();
                assert_eq!(run.counts.l1.requests, u64::from(asked * lines + 1), "{pinned} of {lines} lines");
            }
            let charged = run_units(&machine, std::iter::once(chunk.clone()), Running::default());
            assert_eq!(charged.is_ok(), pinned == 0);
        }
    }
}

#[test]
fn two_lines_of_one_bank_take_a_cycle_longer_than_two_of_two() {
    const HITS: usize = 50;
    for latency in [1, 2, 3, 20] {
        let machine = machine(&[("cores.per_group", 2), ("l1.latency_cycles", latency)]);
        let banks = machine.l1.banks;
        // Both rays have their line in the L1 before they meet; what they ask for before is one line for both, so that they start in one cycle.
        let meet = |other: u32| {
            let warm = [0, other];
            let hits = |line: u32| warm.iter().copied().chain([line; HITS]).collect::<Vec<_>>();
            run(&machine, &[hits(0), hits(other)])
        };
        let (apart, together) = (meet(1), meet(banks));
        let alone = run(&machine, &[[0, 1].into_iter().chain([0; HITS]).collect::<Vec<_>>()]);
        assert_eq!(apart.cycles, alone.cycles, "two banks: nobody waits");
        assert!(apart.counts.l1.conflicts < 3, "{:?}", apart.counts.l1);
        assert!(together.counts.l1.conflicts >= 1 && together.counts.l1.queued_cycles >= together.counts.l1.conflicts);
        // One that has waited a cycle comes a cycle behind the other ever after; only a bank whose answer takes one cycle has both in every cycle, one of whom waits.
        let hits = HITS as u64;
        let longer = if latency == 1 { hits } else { 1 };
        assert_eq!(together.cycles - apart.cycles, longer, "latency {latency}");
        // The two requests for each of the warm lines are of one bank too, in both runs.
        let more = if latency == 1 { 2 * hits - 1 } else { 1 };
        assert_eq!(together.counts.l1.conflicts - apart.counts.l1.conflicts, more);
        assert_eq!(together.counts.l1.queued_cycles - apart.counts.l1.queued_cycles, more);
    }
}

/// Lines of one set of bank `bank` of the L1, one more than its ways: read in turn, each evicts the one that comes next.
fn lap(machine: &Machine, bank: u32) -> Vec<u32> {
    let apart = machine.l1.sets_per_bank() as u32 * machine.l1.banks;
    (0..=machine.l1.ways).map(|k| bank + k * apart).collect()
}

#[test]
fn a_latency_longer_by_a_cycle_costs_a_cycle_wherever_it_is_waited_for() {
    const LAPS: usize = 10;
    const HITS: usize = 100;
    // What a frame takes beyond its lines' first coming from memory: laps in the L2, then hits in the L1.
    let warm = |sets: &[(&str, u32)]| {
        let machine = machine(sets);
        let lap = lap(&machine, 0);
        let cold = run(&machine, std::slice::from_ref(&lap));
        let all = run(&machine, &[[lap.repeat(1 + LAPS), vec![lap[2]; HITS]].concat()]);
        assert_eq!((all.counts.l1.hits, all.counts.l2.hits, all.counts.l2.misses), (HITS as u64, 3 * LAPS as u64, 3));
        all.cycles - cold.cycles
    };
    let (laps, hits) = (3 * LAPS as u64, HITS as u64);
    let plain = machine(&[]);
    for (key, now, uses) in [
        ("l1.latency_cycles", plain.l1.latency_cycles, laps + hits),
        ("crossbar.request_cycles", plain.crossbar.request_cycles, laps),
        ("l2.latency_cycles", plain.l2.latency_cycles, laps),
        ("crossbar.answer_cycles", plain.crossbar.answer_cycles, laps),
    ] {
        for more in [1, 2] {
            assert_eq!(warm(&[(key, now + more)]) - warm(&[]), u64::from(more) * uses, "{key} longer by {more}");
        }
    }
    // Room and width that nobody asks for cost nothing.
    for key in [
        "l1.mshrs",
        "l1.targets",
        "l1.queue",
        "l2.mshrs",
        "l2.targets",
        "l2.queue",
        "crossbar.per_group",
        "crossbar.per_bank",
        "dram.queue",
    ] {
        assert_eq!(warm(&[(key, 1)]), warm(&[(key, 2)]), "{key}");
    }
}

#[test]
fn a_group_sends_as_many_misses_a_cycle_as_its_port_is_wide() {
    // Four rays of one group, each in a bank of its own, miss in the same cycle, round after round; the L2 has all lines.
    let cycles = |rays: u32, per_group| {
        let machine = machine(&[("cores.per_group", 4), ("crossbar.per_group", per_group)]);
        let laps: Vec<Vec<u32>> = (0..rays).map(|bank| lap(&machine, bank)).collect();
        // All read all lines first, together.
        let warm = (0..4).flat_map(|bank| lap(&machine, bank)).collect::<Vec<_>>();
        let lines: Vec<_> = laps.iter().map(|lap| [warm.clone(), lap.repeat(5)].concat()).collect();
        let run = run(&machine, &lines);
        assert_eq!(run.counts.l2.hits, u64::from(rays) * 15);
        (run.cycles, run.counts.crossbar_cycles)
    };
    let alone = cycles(1, 1);
    // The last goes so many cycles behind the first, and stays there: the first is back before it is sent.
    for (per_group, behind, waited) in [(4, 0, 0), (3, 1, 1), (2, 1, 2), (1, 3, 6)] {
        let together = cycles(4, per_group);
        assert_eq!(together.0 - alone.0, behind, "{per_group} a cycle");
        assert_eq!(together.1 - alone.1, waited, "{per_group} a cycle");
    }
}

#[test]
fn misses_of_one_line_merge_and_are_answered_together() {
    let machine = machine(&[("cores.per_group", 8)]);
    let run_of = |rays: usize| run(&machine, &vec![vec![7]; rays]);
    let (one, all) = (run_of(1), run_of(8));
    assert_eq!((all.counts.l1.misses, all.counts.l1.merges, all.counts.l2.requests), (1, 7, 1));
    assert_eq!(one.cycles, all.cycles, "the last look-up is over long before the line comes");
}

#[test]
fn a_miss_that_merges_is_answered_no_sooner_than_a_look_up_takes() {
    // Memory reads a line in less time than the L2 looks one up. Both rays read line 5, the first in another group than the second, or in the same; what they
    // read before that lies in other channels and banks, so that they meet there alone.
    for (groups, per_group) in [(2, 1), (1, 2)] {
        let shape = [("cores.groups", groups), ("cores.per_group", per_group), ("crossbar.per_group", 4)];
        let keys = [&shape[..], &[("l1.latency_cycles", 7), ("l2.latency_cycles", 160)]].concat();
        let machine = machine(&keys);
        let sum = machine.l1.latency_cycles + machine.crossbar.request_cycles + machine.l2.latency_cycles + machine.crossbar.answer_cycles;
        let hit = u64::from(if groups == 2 { sum } else { machine.l1.latency_cycles });
        let reading = |line: u32, more: usize| vec![line; 1 + more];
        let first = [reading(73, 3), vec![5]].concat();
        let line_comes = run(&machine, std::slice::from_ref(&first)).cycles;
        let mut look_ups_last = 0;
        for more in 3..100 {
            let asks = run(&machine, &[reading(136, more)]).cycles;
            let both = [first.clone(), [reading(136, more), vec![5]].concat()];
            // A batch for each group.
            let chunks: Vec<_> = both.chunks(per_group as usize).map(rays).collect();
            let run = run_free(&machine, nodes(), chunks.into_iter(), Running::default()).unwrap();
            assert_eq!(run.cycles, line_comes.max(asks + hit), "{groups} groups, {more} reads before");
            let merged = if groups == 2 { run.counts.l2.merges } else { run.counts.l1.merges };
            look_ups_last += u64::from(merged > 0 && asks + hit > line_comes);
            assert_eq!(run.counts.stalls.iter().sum::<u64>(), line_comes + line_comes.max(asks + hit));
        }
        assert!(look_ups_last > 0, "no ray merged while the line was about to come");
    }
}

#[test]
fn a_full_miss_register_holds_the_bank_back() {
    let lines: Vec<Vec<u32>> = (0..8).map(|ray| vec![ray * 64]).collect();
    let with = |mshrs, targets| {
        let machine = machine(&[("cores.per_group", 8), ("l1.mshrs", mshrs), ("l1.targets", targets)]);
        (run(&machine, &lines), run(&machine, &vec![vec![7]; 8]))
    };
    let ((free, _), (one, _)) = (with(8, 8), with(1, 8));
    assert_eq!(free.counts.l1.blocked_cycles, 0);
    assert!(one.counts.l1.blocked_cycles > 0 && one.cycles > free.cycles, "{one:?}");
    let (_, no_target) = with(8, 1);
    assert!(no_target.counts.l1.blocked_cycles > 0);
    assert_eq!((no_target.counts.l1.misses, no_target.counts.l1.hits), (1, 7));
}

/// Every request is found, a miss or merged; every miss is a request one level down, and a line filled.
fn conserved(run: &Run) {
    let (l1, l2) = (run.counts.l1, run.counts.l2);
    let traffic = |of: fn(&KindTraffic) -> u64| run.counts.traffic.iter().map(of).sum::<u64>();
    let reads: u64 = run.channels.iter().map(|channel| channel.reads).sum();
    assert_eq!(l1.requests, l1.hits + l1.misses + l1.merges + l1.stores);
    assert_eq!(l2.requests, l2.hits + l2.misses + l2.merges + l2.stores);
    assert_eq!((l1.misses + l1.stores, l1.misses, l1.requests), (l2.requests, l1.fills, traffic(|t| t.l1)));
    // Stores go through the L1 to the L2, and from there to memory when their place is needed, or stay.
    let writes: u64 = run.channels.iter().map(|channel| channel.writes).sum();
    assert_eq!((l1.stores, l2.stores, l1.write_backs), (l2.stores, l2.updates, 0));
    assert_eq!([writes, traffic(|t| t.written)], [l2.write_backs; 2]);
    assert!(l2.write_backs + run.dirty_lines <= l2.stores);
    let count = |histogram: &Histogram| histogram.steps().map(|step| step.1).sum::<u64>();
    assert_eq!([count(&run.latencies.l1_misses), count(&run.latencies.l2_misses)], [l1.misses, l2.misses]);
    assert_eq!((l2.misses, l2.misses, l2.requests), (reads, l2.fills, traffic(|t| t.l2)));
    assert_eq!(reads, traffic(|t| t.dram));
    let last = run.intervals.last().unwrap();
    assert_eq!((last.end, last.counts), (run.cycles, run.counts));
    assert!(run.intervals.windows(2).all(|two| two[0].end < two[1].end && two[0].counts.l1.requests <= two[1].counts.l1.requests));
}

/// Lines with some locality, as a ray's.
fn wandering(rays: usize, steps: usize) -> Vec<Vec<u32>> {
    let mut random = Random::new(3);
    let mut draw = move |n: u64| random.below(n) as u32;
    (0..rays).map(|_| (0..steps).map(|_| if draw(3) == 0 { draw(40_000) } else { draw(600) }).collect()).collect()
}

/// One place in everything that has places.
const LITTLE: &[(&str, u32)] = &[
    ("l1.mshrs", 1),
    ("l1.targets", 1),
    ("l1.queue", 1),
    ("l2.mshrs", 1),
    ("l2.targets", 1),
    ("l2.queue", 1),
    ("l2.banks", 1),
    ("dram.queue", 1),
    ("dram.channels", 1),
];

#[test]
fn nothing_is_lost_and_nothing_stands_still_however_little_room_there_is() {
    let lines = wandering(200, 40);
    for rays_in_flight in [1, 4] {
        let shape = [("cores.groups", 4), ("cores.per_group", 4), ("cores.rays_in_flight", rays_in_flight)];
        let roomy = run(&machine(&shape), &lines);
        conserved(&roomy);
        let tight = run(&machine(&[&shape, LITTLE].concat()), &lines);
        conserved(&tight);
        assert!(tight.cycles > 2 * roomy.cycles, "{} and {}", tight.cycles, roomy.cycles);
        for counts in [tight.counts.l1, tight.counts.l2] {
            assert!(counts.refused_cycles > 0 && counts.blocked_cycles > 0, "{counts:?}");
        }
        assert_eq!((roomy.counts.rays, tight.counts.rays), (200, 200));
    }
}

#[test]
fn an_independent_count_of_reuse_distances_predicts_every_hit() {
    // Fully associative, one request at a time: a line is found if fewer others than the cache holds came since its last use.
    let machine = machine(&[("l1.banks", 1), ("l1.ways", 64), ("l1.bytes", 64 * 32)]);
    let lines = wandering(20, 300);
    let run = run(&machine, &lines);
    let all: Vec<u32> = lines.concat();
    let found = |k: usize| {
        let last = all[..k].iter().rposition(|&line| line == all[k])?;
        (all[last + 1..k].iter().collect::<HashSet<_>>().len() < 64).then_some(())
    };
    let hits = (0..all.len()).filter(|&k| found(k).is_some()).count() as u64;
    assert_eq!(run.counts.l1.hits, hits);
    assert!(hits > 200 && hits < 5000, "{hits}");
}

#[test]
fn a_stream_reaches_most_of_the_peak() {
    for (device, share) in [("dram/gddr5.toml", 0.85), ("dram/gddr6.toml", 0.85)] {
        let mut machine =
            machine(&[("cores.groups", 64), ("cores.per_group", 16), ("cores.rays_in_flight", 8), ("l1.mshrs", 64), ("l2.mshrs", 64)]);
        machine.set("dram.device", device).unwrap();
        // Every ray reads its own stretch, all together one stream.
        let lines: Vec<Vec<u32>> = (0..4096).map(|ray| (0..64).map(|k| k * 4096 + ray).collect()).collect();
        let chunks: Vec<Chunk> = lines.chunks(64).map(rays).collect();
        let run = run_free(&machine, nodes(), chunks.into_iter(), Running::default()).unwrap();
        conserved(&run);
        let config = dram_of(&machine).unwrap();
        let peak = config.device.peak_bytes_per_second() * f64::from(config.channels);
        let used = 32.0 * 4096.0 * 64.0 / (machine.cores.start_ps(run.cycles) as f64 * 1e-12) / peak;
        assert!(used > share && used <= 1.0, "{device}: {used}");
    }
}

#[test]
fn silence_is_an_error_that_tells_what_everyone_does() {
    struct Silent(Feed);
    impl FrontEnd for Silent {
        fn slots(&self) -> (usize, fn(u32) -> usize) {
            (0, |waiter| waiter as usize)
        }
        fn feed(&mut self) -> &mut Feed {
            &mut self.0
        }
        fn granted(&mut self, _: u32, memory: &mut GroupSide) {
            memory.wake_at(9, 0);
        }
        fn wake(&mut self, _: u32, _: &mut GroupSide) {}
        fn answer(&mut self, _: u32, _: counts::Supplier, _: &mut GroupSide) {}
        fn under_way(&self) -> u64 {
            1
        }
        fn operations(&self) -> Operations {
            Operations::default()
        }
        fn describe(&self) -> String {
            "one context waits for ever".to_owned()
        }
    }
    for threads in [1, 2] {
        let how = Running { threads, ..Running::default() };
        let silent = |_: &Machine, first| Silent(Feed::new(first, 1, 1));
        let error = drive(silent, &machine(&[]), 1, std::iter::once(rays(&[vec![0]])), how).map(drop).unwrap_err().to_string();
        assert!(error.starts_with("deadlock after cycle 9:\none context waits for ever\nL1: 0 requests queued"), "{error}");
    }
}

#[test]
fn neither_threads_nor_rounds_change_a_run() {
    let lines = wandering(400, 40);
    let shape = [("cores.groups", 6), ("cores.per_group", 4)];
    let slow = [("l1.latency_cycles", 3), ("l2.latency_cycles", 40), ("crossbar.answer_cycles", 5), ("cores.rays_in_flight", 3)];
    let tight = [("l1.mshrs", 1), ("l1.queue", 1), ("l2.mshrs", 1), ("l2.queue", 2), ("l2.banks", 2), ("dram.queue", 1)];
    // A memory so fast that it answers before the L2's latency is over.
    let quick = [("l2.latency_cycles", 400), ("crossbar.answer_cycles", 1)];
    for sets in [&[][..], &slow, &tight, &quick] {
        let machine = machine(&[&shape, sets].concat());
        let free = |how| run_free(&machine, nodes(), lines.chunks(10).map(rays), how).unwrap();
        let units = |how| run_units(&machine, lines.chunks(10).map(rays), how).unwrap();
        for run in [&free as &dyn Fn(Running) -> Run, &units] {
            let one = run(Running::default());
            conserved(&one);
            for threads in [2, 3, 16] {
                assert!(run(Running { threads, ..Running::default() }) == one, "{threads} threads");
            }
            // Every cycle is a round of its own.
            let window = Some(Window { from: 0, to: 9 });
            assert!(Run { wave: None, ..run(Running { window, threads: 1 }) } == one, "cycle by cycle");
        }
    }
}

#[test]
fn operations_count_when_they_run() {
    const READS: u64 = 400;
    let machine = machine(&[]);
    // Each ray reads lines from memory, one after the other, and tests a triangle with each: its tests are spread over its time.
    let lines: Vec<Vec<u32>> = (0..8).map(|ray| (0..READS as u32).map(|k| (ray * READS as u32 + k) << 9).collect()).collect();
    let free = run(&machine, &lines);
    let units = run_units(&machine, std::iter::once(rays(&lines)), Running::default()).unwrap();
    for run in [free, units] {
        let tests = |operations: &Operations| operations.get(Operation::TriTest);
        let of = |operation| run.operations.get(operation);
        assert_eq!([of(Operation::RaySetup), of(Operation::NodeAddress), tests(&run.operations)], [8, 8 * READS, 8 * READS]);
        let last = run.intervals.last().unwrap();
        assert_eq!((last.end, &last.operations), (run.cycles, &run.operations), "all stretches together have all operations");
        assert!(run.intervals.len() > 20, "{} stretches", run.intervals.len());
        for two in run.intervals.windows(2) {
            // Contexts wait for each line: in no stretch are there more tests than lines that came, and the last steps of each context.
            let [added, came] = [tests(&two[1].operations) - tests(&two[0].operations), two[1].counts.l1.fills - two[0].counts.l1.fills];
            assert!(added.abs_diff(came) <= 8, "cycle {}: {added} tests, {came} lines", two[1].end);
        }
    }
}

#[test]
fn machines_that_events_cannot_name_are_refused() {
    let machine = machine(&[("cores.groups", 4096), ("cores.per_group", 4096)]);
    let error = run_free(&machine, nodes(), std::iter::empty(), Running::default()).unwrap_err().to_string();
    assert_eq!(error, "rays in flight of the machine are more than 4194304: 16777216");
}

#[test]
fn a_waveform_shows_the_events_of_its_window() {
    let lines = wandering(50, 20);
    let machine = machine(&[("cores.groups", 2), ("cores.per_group", 4)]);
    let run_with =
        |window| run_free(&machine, nodes(), std::iter::once(rays(&lines)), Running { window: Some(window), threads: 1 }).unwrap();
    let whole = run_with(Window { from: 0, to: u64::MAX });
    let text = String::from_utf8(whole.wave.clone().unwrap()).unwrap();
    let mut vcd = vcd::Parser::new(text.as_bytes());
    let header = vcd.parse_header().unwrap();
    let hits = header.find_var(&["machine", "events", "l1_hits"]).unwrap().code;
    assert!(header.find_var(&["machine", "group_1", "l1_misses_under_way"]).is_some());
    // A value stands until the next: sum it over cycles.
    let (mut sum, mut value, mut cycle) = (0, 0, 0);
    for command in vcd {
        match command.unwrap() {
            vcd::Command::Timestamp(ps) => {
                let next = machine.cores.cycle_at(ps);
                sum += value * (next - cycle);
                cycle = next;
            }
            vcd::Command::ChangeVector(id, bits) if id == hits => {
                value = bits.iter().fold(0, |v, bit| 2 * v + u64::from(bit == vcd::Value::V1));
            }
            _ => (),
        }
    }
    assert_eq!(sum + value, whole.counts.l1.hits);
    let window = run_with(Window { from: 200, to: 260 });
    let part = window.wave.as_ref().unwrap().len();
    assert!(part > 500 && part < text.len() / 2, "{part} of {}", text.len());
    assert_eq!(Run { wave: None, ..window }, Run { wave: None, ..whole }, "to look changes nothing");
    // A window of any one cycle of the frame has that cycle's values, also where nothing happens.
    for from in [0, 7, 8, 9, whole.cycles - 1, whole.cycles] {
        let one = run_with(Window { from, to: from }).wave.unwrap();
        let mut vcd = vcd::Parser::new(&one[..]);
        vcd.parse_header().unwrap();
        let times: Vec<_> =
            vcd.filter_map(|command| if let vcd::Command::Timestamp(ps) = command.unwrap() { Some(ps) } else { None }).collect();
        assert_eq!(times.first(), Some(&machine.cores.start_ps(from)), "{from}");
    }
}

#[test]
fn the_last_stretch_has_the_last_cycle() {
    // Runs that end with a stretch, one cycle before and one behind.
    let mut ends = HashSet::new();
    for cycles in 1..1100 {
        let machine = machine(&[("crossbar.answer_cycles", cycles)]);
        let run = run_free(&machine, nodes(), std::iter::once(rays(&[vec![0]])), Running::default()).unwrap();
        let last = run.intervals.last().unwrap();
        assert_eq!((last.end, last.counts, last.counts.rays), (run.cycles, run.counts, 1));
        ends.insert(run.cycles % 1024);
    }
    assert!([1023, 0, 1].iter().all(|end| ends.contains(end)), "{} ends", ends.len());
}

mod frames;
