//! Lines that are written.

use super::*;
use std::collections::{BTreeMap, BTreeSet};

/// A ray's lines, one after the other: whether each is written.
fn mixed(lines: &[Vec<(u32, bool)>]) -> Batch {
    let step = |&(line, stores): &(u32, bool)| {
        let fetch = Fetch { stores, ..Fetch::new(LEAVES, line, 1) };
        [Step::on(fetch, Act::Fetch), Step::of(Act::Triangles { count: 1, hits: 0 })]
    };
    Batch::new(&lines.iter().map(|ray| ray.iter().flat_map(step).chain([Step::end(false, false)]).collect()).collect::<Vec<_>>())
}

fn run_mixed(machine: &Machine, lines: &[Vec<(u32, bool)>], threads: usize) -> Run {
    let how = Running { threads, ..Running::default() };
    run_free(machine, nodes(), std::iter::once(Chunk::from([mixed(lines)])), how).unwrap()
}

#[test]
fn a_store_takes_as_long_as_a_hit_of_the_l2_and_is_found_there() {
    let machine = machine(&[]);
    let (there, back) = way(&machine);
    let stored = run_mixed(&machine, &[vec![(7, true)]], 1);
    assert_eq!(stored.cycles, there + back);
    assert_eq!((stored.counts.l2.stores, stored.counts.l2.misses, stored.dirty_lines), (1, 0, 1));
    assert_eq!(stored.channels.iter().map(|channel| channel.reads + channel.writes).sum::<u64>(), 0);
    conserved(&stored);
    // Read behind it: the L2 has it, the L1 does not, then does. Written again: in both, and nowhere else.
    let read = run_mixed(&machine, &[vec![(7, true), (7, false), (7, false), (7, true)]], 1);
    let (l1, l2) = (read.counts.l1, read.counts.l2);
    assert_eq!((l1.misses, l1.hits, l1.stores, l1.updates), (1, 1, 2, 1));
    assert_eq!((l2.misses, l2.hits, l2.stores, l2.updates, read.dirty_lines), (0, 1, 2, 2, 1));
    assert_eq!(read.cycles, 3 * (there + back) + u64::from(machine.l1.latency_cycles));
    conserved(&read);
}

#[test]
fn an_independent_cache_predicts_every_write_back() {
    // One request at a time at an L2 of 16 sets of 4 ways; reads too, so that clean lines go as well.
    let machine = machine(&[("l1.banks", 1), ("l1.ways", 1), ("l1.bytes", 64), ("l2.banks", 1), ("l2.ways", 4), ("l2.bytes", 64 * 32)]);
    let mut random = Random::new(11);
    let lines: Vec<(u32, bool)> = (0..6000).map(|_| (random.below(160) as u32, random.below(3) == 0)).collect();
    let run = run_mixed(&machine, std::slice::from_ref(&lines), 1);
    conserved(&run);
    // By set, lines with the time of their last use; a line of the L1 of two lines is not asked for again.
    let mut sets = vec![BTreeMap::<usize, u32>::new(); 16];
    let (mut l1, mut dirty) = (BTreeMap::<u32, u32>::new(), BTreeSet::<u32>::new());
    let (mut write_backs, mut misses) = (0, 0);
    for (now, &(line, stores)) in lines.iter().enumerate() {
        if !stores && l1.insert(line % 2, line) == Some(line) {
            continue;
        }
        let set = &mut sets[line as usize % 16];
        let last = set.iter().find(|(_, held)| **held == line).map(|(&at, _)| at);
        misses += u64::from(last.is_none() && !stores);
        if let Some(last) = last {
            set.remove(&last);
        } else if set.len() == 4 {
            write_backs += u64::from(set.pop_first().is_some_and(|(_, gone)| dirty.remove(&gone)));
        }
        set.insert(now, line);
        if stores {
            dirty.insert(line);
        }
    }
    assert_eq!((run.counts.l2.write_backs, run.counts.l2.misses), (write_backs, misses));
    assert_eq!(run.dirty_lines, dirty.len() as u64);
    assert!(write_backs > 500, "{write_backs}");
}

#[test]
fn stores_among_reads_are_the_same_with_any_threads_and_never_stand_still() {
    let mut random = Random::new(5);
    let rays: Vec<Vec<(u32, bool)>> =
        (0..200).map(|_| (0..40).map(|_| (random.below(3000) as u32, random.below(2) == 0)).collect()).collect();
    let shape = [("cores.groups", 4), ("cores.per_group", 4), ("cores.rays_in_flight", 4), ("l2.bytes", 64 * 1024)];
    for sets in [shape.to_vec(), [&shape[..], LITTLE].concat()] {
        let one = run_mixed(&machine(&sets), &rays, 1);
        conserved(&one);
        assert!(one.counts.l2.write_backs > 100 && one.counts.rays == 200, "{:?}", one.counts.l2);
        for threads in [2, 3] {
            let other = run_mixed(&machine(&sets), &rays, threads);
            assert_eq!((one.cycles, one.counts, one.dirty_lines), (other.cycles, other.counts, other.dirty_lines));
            assert_eq!((&one.channels, &one.dram, one.dram_clocks), (&other.channels, &other.dram, other.dram_clocks));
            assert_eq!((&one.frames, &one.intervals), (&other.frames, &other.intervals));
        }
    }
}

#[test]
fn rays_wait_for_all_work_before_their_frame() {
    let machine = machine(&[]);
    let work = |lines: &[Vec<(u32, bool)>]| {
        let mut recorder = crate::step::Recorder::default();
        for ray in lines {
            for &(line, stores) in ray {
                crate::step::StepSink::step(&mut recorder, Step::on(Fetch { stores, ..Fetch::new(LEAVES, line, 1) }, Act::Fetch));
                crate::step::StepSink::step(&mut recorder, Step::of(Act::Work { work: 2, count: 5 }));
            }
            crate::step::StepSink::step(&mut recorder, Step::end(false, false));
        }
        Chunk::from([recorder.work()]).before_frame()
    };
    let stored = [(3, true), (9, true)];
    let frame = || Chunk::from([mixed(&[vec![(3, false), (4, false)]])]).beginning_frame();
    let chunks = [work(&[stored.to_vec()]), frame(), work(&[vec![(5, true)], vec![]]).beginning_frame(), frame()];
    let run = run_free(&machine, nodes(), chunks.into_iter(), Running::default()).unwrap();
    conserved(&run);
    assert_eq!(run.frames.iter().map(|frame| frame.is_before).collect::<Vec<_>>(), [true, false, true, false]);
    // Work is no ray, and nothing is set up for it; its own operations count.
    assert_eq!((run.counts.rays, run.operations.get(Operation::RaySetup), run.operations.works()[2]), (2, 2, 15));
    assert_eq!(run.latencies.rays.steps().map(|step| step.1).sum::<u64>(), 2);
    // The first frame finds in the L2 what was written before it, and only then begins; the second finds both lines there, as its L1 is empty again.
    assert_eq!((run.counts.l2.hits, run.counts.l2.misses, run.counts.l1.hits), (3, 1, 0));
    for two in run.frames.windows(2) {
        assert!(two[0].end.end < two[1].start);
    }
    // Without work it begins at once.
    let alone = run_free(&machine, nodes(), [Chunk::from([mixed(&[vec![(3, false)]])])].into_iter(), Running::default()).unwrap();
    assert_eq!((alone.frames.len(), alone.frames[0].start), (1, 0));
}

/// Work that writes these lines, one after the other, and no ray.
fn writing(lines: std::ops::Range<u32>) -> Chunk {
    let mut recorder = crate::step::Recorder::default();
    for line in lines {
        crate::step::StepSink::step(&mut recorder, Step::on(Fetch::new(LEAVES, line, 1).storing(), Act::Fetch));
    }
    crate::step::StepSink::step(&mut recorder, Step::end(false, false));
    Chunk::from([recorder.work()]).before_frame()
}

#[test]
fn work_ends_when_what_had_to_go_is_in_memory() {
    let machine = machine(&[("l1.banks", 1), ("l1.ways", 1), ("l1.bytes", 64), ("l2.banks", 1), ("l2.ways", 4), ("l2.bytes", 64 * 32)]);
    let frame = Chunk::from([mixed(&[vec![(0, false)]])]).beginning_frame();
    let run = run_free(&machine, nodes(), [writing(0..400), frame].into_iter(), Running::default()).unwrap();
    conserved(&run);
    let work = &run.frames[0];
    assert_eq!((work.end.counts.l2.write_backs, work.end.channels.writes), (400 - 64, 400 - 64));
    // Its stores alone, one after the other, are through before.
    let (there, back) = way(&machine);
    assert!(work.end.end > 400 * (there + back), "{}", work.end.end);
    // The first line has gone to memory, and is read from there.
    assert_eq!((run.counts.l2.misses, run.dirty_lines), (1, 63));
}

#[test]
fn a_ray_finds_no_line_in_its_l1_that_work_has_written_since() {
    let machine = machine(&[]);
    let frame = || Chunk::from([mixed(&[vec![(5, false)]])]).beginning_frame();
    let chunks = [Chunk::from([mixed(&[vec![(5, false)]])]), writing(5..6).beginning_frame(), frame()];
    let run = run_free(&machine, nodes(), chunks.into_iter(), Running::default()).unwrap();
    conserved(&run);
    assert_eq!((run.counts.l1.misses, run.counts.l1.hits, run.counts.l2.hits), (2, 0, 1));
}

/// Rays of several groups, each of lines in the L2 that work has written before.
fn among(written: u32, rays: u64) -> Chunk {
    let mut random = Random::new(rays);
    let lines: Vec<Vec<(u32, bool)>> =
        (0..rays).map(|_| (0..1 + random.below(9)).map(|_| (random.below(written.into()) as u32, false)).collect()).collect();
    lines.chunks(4).map(mixed).collect()
}

#[test]
fn cores_do_the_work_before_a_frame_and_units_its_rays() {
    let sets = [("cores.groups", 5), ("cores.per_group", 4), ("units.per_group", 2), ("units.contexts", 3)];
    let machine = machine(&sets);
    let by_units = |chunks: &[Chunk], threads| {
        let how = Running { threads, ..Running::default() };
        run_work_then_units(&machine, nodes(), chunks.iter().cloned(), how).unwrap()
    };
    let frame = || among(300, 200).beginning_frame();
    let chunks = [writing(0..300), frame(), writing(0..700).beginning_frame(), frame()];
    let run = by_units(&chunks, 1);
    conserved(&run);
    for threads in [2, 3, 8] {
        assert_eq!(by_units(&chunks, threads), run, "{threads} threads");
    }
    assert_eq!(run.frames.iter().map(|frame| frame.is_before).collect::<Vec<_>>(), [true, false, true, false]);
    assert_eq!((run.counts.rays, run.operations.get(Operation::RaySetup)), (400, 400));
    // The work takes what it takes where compute is free, and the rays begin when they begin there.
    let free = run_free(&machine, nodes(), chunks.iter().cloned(), Running::default()).unwrap();
    let mut work = free.frames[0].clone();
    work.end.counts.stalls = run.frames[0].end.counts.stalls;
    assert_eq!((&run.frames[0], run.frames[0].end.counts.stalls), (&work, [0; CAUSES]));
    assert_eq!(run.frames[1].start, free.frames[1].start);
    assert_eq!(run.frames[2].end.end - run.frames[2].start, free.frames[2].end.end - free.frames[2].start);
    // All lines of the rays are in the L2, and their L1s are empty: they take as long in either frame, whatever the work before them, and longer than with compute free.
    let cycles = |run: &Run, frame: usize| run.frames[frame].end.end - run.frames[frame].start;
    assert_eq!(cycles(&run, 1), cycles(&run, 3));
    assert!(cycles(&run, 1) > cycles(&free, 1));
    assert_eq!((run.counts.l2.misses, run.counts.l2.stores), (0, 1000));
    // Contexts are idle while cores work, and what these wait for is none of theirs.
    let states = run.units.as_ref().unwrap().states;
    let contexts = 5 * 2 * 3;
    assert_eq!(states.iter().sum::<u64>(), contexts * run.cycles);
    let lines = states[State::Fetch as usize] + run.late.iter().sum::<u64>();
    assert_eq!(run.counts.stalls.iter().sum::<u64>(), lines);
    // Without work the cores do nothing.
    let rays = [among(300, 200), frame()];
    let alone = run_units(&machine, rays.iter().cloned(), Running::default()).unwrap();
    assert_eq!(by_units(&rays, 1), alone);
    // Half as many units can be named.
    let mut many = machine;
    many.set("cores.groups", "2048").unwrap();
    let why = run_work_then_units(&many, nodes(), [].into_iter(), Running::default()).unwrap_err().to_string();
    assert_eq!(why, "traversal units behind work before a frame of the machine are more than 2048: 4096");
}
