//! Rays that start behind the end of others.

use super::*;
use crate::step::{Link, Recorder, StepSink};

/// Rays of one chunk of two batches or more, each of which reads a line of its own; `after` tells what each starts behind.
fn ordered(after: &[Option<u64>]) -> Chunk {
    let batch = |numbers: std::ops::Range<usize>| {
        let mut recorder = Recorder::default();
        for number in numbers {
            recorder.link(Link { number: number as u64, after: after[number] });
            recorder.step(Step::on(Fetch::new(LEAVES, 64 * number as u32, 1), Act::Fetch));
            recorder.step(Step::of(Act::Triangles { count: 1, hits: 0 }));
            recorder.step(Step::end(false, false));
        }
        recorder.batch()
    };
    // Two batches, of many rays or of few: groups take one at a time.
    let size = if after.len() == 1024 { 16 } else { after.len().div_ceil(2) };
    (0..after.len()).step_by(size).map(|first| batch(first..after.len().min(first + size))).collect()
}

#[test]
fn a_ray_starts_behind_the_end_of_the_one_that_it_waits_for() {
    let free =
        |machine: &Machine, after: &[Option<u64>]| run_free(machine, nodes(), std::iter::once(ordered(after)), Running::default()).unwrap();
    let units = |machine: &Machine, after: &[Option<u64>]| run_units(machine, std::iter::once(ordered(after)), Running::default()).unwrap();
    for groups in [1, 2] {
        let machine = machine(&[("cores.groups", groups), ("cores.per_group", 8), ("units.contexts", 8)]);
        for run in [&free as &dyn Fn(&Machine, &[Option<u64>]) -> Run, &units] {
            let alone = run(&machine, &[None, None]);
            let none = run(&machine, &[None; 8]);
            // One behind the other, across batches and groups, in whatever order they are taken.
            let chain: Vec<_> = (0..8).map(|number: u64| number.checked_sub(1)).collect();
            let chain = run(&machine, &chain);
            let star = run(&machine, &[None, Some(0), Some(0), Some(0), Some(0), Some(0), Some(0), Some(0)]);
            for whole in [&none, &chain, &star] {
                conserved(whole);
                assert_eq!(whole.counts.rays, 8);
            }
            assert!(2 * none.cycles < chain.cycles, "rays that wait for nobody run side by side: {} of {}", none.cycles, chain.cycles);
            assert!(chain.cycles > 3 * alone.cycles, "{} of {}", chain.cycles, alone.cycles);
            assert!(star.cycles > none.cycles && star.cycles < chain.cycles, "{} of {}", star.cycles, chain.cycles);
        }
        // Where compute takes no time, a chain is one ray that reads the lines one after the other, but for the dispatcher's delay between two.
        let chain: Vec<_> = (0..8).map(|number: u64| number.checked_sub(1)).collect();
        let chase = run(&machine, &[(0..8).map(|number| 64 * number).collect()]);
        let delay = u64::from(machine.l1.latency_cycles + machine.l2.latency_cycles + machine.crossbar.answer_cycles);
        // (The memory's clock is another.)
        let longer = free(&machine, &chain).cycles - chase.cycles;
        assert!(groups > 1 || longer.abs_diff(7 * delay) <= 7, "{longer} cycles longer, of {}", 7 * delay);
    }
}

/// Pixels whose rays bounce: the next of a pixel starts behind the end of the one before; rays in the order of their bounces.
fn bounces(pixels: u64, bounces: u64) -> Vec<Option<u64>> {
    (0..pixels * bounces).map(|number: u64| number.checked_sub(pixels)).collect()
}

#[test]
fn rays_that_wait_are_shared_by_all_groups() {
    // The same 1024 rays, bounce by bounce and pixel by pixel; groups take 16 at once.
    let breadth = bounces(128, 8);
    let depth: Vec<_> = (0..1024u64).map(|number| if number % 8 == 0 { None } else { Some(number - 1) }).collect();
    let cycles = |after: &[Option<u64>], groups, is_free: bool| {
        let machine = machine(&[("cores.groups", groups), ("cores.per_group", 1), ("units.contexts", 1)]);
        let chunk = std::iter::once(ordered(after));
        let run =
            if is_free { run_free(&machine, nodes(), chunk, Running::default()) } else { run_units(&machine, chunk, Running::default()) }
                .unwrap();
        conserved(&run);
        assert_eq!(run.counts.rays, 1024);
        run.cycles
    };
    for is_free in [true, false] {
        let [breadth, depth] = [&breadth, &depth].map(|after| [1, 2, 4, 8].map(|groups| cycles(after, groups, is_free)));
        println!("{breadth:?} cycles bounce by bounce, {depth:?} pixel by pixel");
        // Eight are as fast as the memory.
        assert!(breadth[..3].windows(2).all(|two| 3 * two[1] < 2 * two[0]), "{breadth:?}");
        assert!(
            breadth.iter().zip(&depth).all(|(&breadth, &depth)| 4 * breadth < 5 * depth && 4 * depth < 5 * breadth),
            "{breadth:?} {depth:?}"
        );
    }
    // One ray, and all others behind its end: whoever is idle takes some.
    let star: Vec<_> = (0..256u64).map(|number| (number > 0).then_some(0)).collect();
    for contexts in [1, 16] {
        let machine = machine(&[("cores.groups", 8), ("cores.per_group", 2), ("units.contexts", contexts)]);
        let [free, units] = [
            run_free(&machine, nodes(), std::iter::once(ordered(&star)), Running::default()).unwrap(),
            run_units(&machine, std::iter::once(ordered(&star)), Running::default()).unwrap(),
        ];
        assert_eq!([free.counts.rays, units.counts.rays], [256, 256]);
    }
}

#[test]
fn more_rays_wait_than_are_put_aside() {
    // The first and all others behind it, of which most cannot be taken before it ends; and chains that cross the border.
    let count = 3 * crate::sim::replay::order::MOST_WAITING as u64;
    let star: Vec<_> = (0..count).map(|number| (number > 0).then_some(0)).collect();
    let far = bounces(count / 3, 3);
    for after in [star, far] {
        let machine = machine(&[("cores.groups", 2), ("cores.per_group", 8)]);
        let [free, units] = [
            run_free(&machine, nodes(), std::iter::once(ordered(&after)), Running::default()).unwrap(),
            run_units(&machine, std::iter::once(ordered(&after)), Running::default()).unwrap(),
        ];
        assert_eq!([free.counts.rays, units.counts.rays], [count, count]);
    }
}
