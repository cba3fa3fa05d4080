//! Rays that start behind the end of others.

use super::*;
use crate::step::{Link, Recorder, StepSink};

/// Rays of one chunk of two batches, each of which reads a line of its own; `after` tells what each starts behind.
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
    let half = after.len() / 2;
    Chunk::from([batch(0..half), batch(half..after.len())])
}

#[test]
fn a_ray_starts_behind_the_end_of_the_one_that_it_waits_for() {
    let free = |machine: &Machine, after: &[Option<u64>]| run_free(machine, nodes(), std::iter::once(ordered(after)), None).unwrap();
    let units = |machine: &Machine, after: &[Option<u64>]| run_units(machine, std::iter::once(ordered(after)), None).unwrap();
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
        // Where compute takes no time, a chain is one ray that reads the lines one after the other.
        let chain: Vec<_> = (0..8).map(|number: u64| number.checked_sub(1)).collect();
        let chase = run(&machine, &[(0..8).map(|number| 64 * number).collect()]);
        assert!(groups > 1 || free(&machine, &chain).cycles == chase.cycles);
    }
}
