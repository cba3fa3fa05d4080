//! Traversal units on a machine: a unit whose lines are all in its L1 takes the cycles of the RTL, and many of them lose nothing.

use lodray::machine::Machine;
use lodray::method::Knobs;
use lodray::method::bvh::{self, NoStore};
use lodray::method::lod::LodImage;
use lodray::num::{Ray, VertexForm};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::{Frame, FrameRays};
use lodray::sim::replay::{self, Chunk, Interval, Run, Running};
use lodray::sim::unit::environment::run;
use lodray::sim::unit::{Latency, SceneMemory, Traffic, TraversalUnit};
use lodray::step::{Batch, Step};
use lodray_test_support::models::{any_rays, ball, scene_of, terrain, with_vertices};
use lodray_test_support::timing::steps_of;

fn machine(sets: &[(&str, u32)]) -> Machine {
    let mut machine = Machine::shipped("haydel2023").expect("a machine");
    for (key, value) in sets {
        machine.set(key, &value.to_string()).expect("a key and its value");
    }
    machine
}

/// The steps of each ray.
fn steps(image: LodImage<'_>, rays: &[Ray]) -> Vec<Vec<Step>> {
    let batch = steps_of(image, rays);
    let ray = |ray| batch.words()[batch.start(ray) as usize..batch.end(ray) as usize].iter().map(|word| word.step()).collect();
    (0..batch.rays()).map(ray).collect()
}

fn units(machine: &Machine, rays: &[Vec<Step>]) -> Run {
    let chunks: Vec<Chunk> = rays.chunks(64).map(|rays| Chunk::from([Batch::new(rays)])).collect();
    replay::run_units(machine, chunks.into_iter(), Running::default()).expect("a run")
}

#[test]
fn a_unit_before_a_full_cache_takes_the_cycles_of_the_cycle_model() {
    let mut compared = 0;
    use VertexForm::{Compact, Exact, Short};
    for (form, h, seed) in
        [(Compact, ball(4, 0.4, 1), 1), (Exact, terrain(3, 5, 0.5, 2), 2), (Compact, ball(0, 0.4, 3), 3), (Short, ball(4, 0.4, 4), 4)]
    {
        let h = with_vertices(form, h);
        let scene = scene_of(&h);
        let image = LodImage::of(&scene);
        let memory = SceneMemory::new(image, 0);
        let rays = any_rays(&h, 60, seed);
        for latency in [1, 7] {
            for edges in [1, 3] {
                let machine = machine(&[
                    ("cores.groups", 1),
                    ("units.contexts", 1),
                    ("units.edges_per_cycle", edges),
                    ("l1.latency_cycles", latency),
                    ("l1.bytes", 1 << 21),
                ]);
                for (ray, steps) in rays.iter().zip(steps(image, &rays)) {
                    // The second time, every line is there.
                    let [cold, both] = [1, 2].map(|times| units(&machine, &vec![steps.clone(); times]));
                    assert_eq!(both.counts.l1.misses, cold.counts.l1.misses);
                    let mut unit = TraversalUnit::new(machine.units.config(), memory.config());
                    let report = run(&mut unit, &memory, &Traffic::smooth(Latency::Fixed(latency)), &[*ray, *ray]).expect("a run");
                    assert_eq!(both.cycles - cold.cycles, report.rays[1].done - report.rays[0].done);
                    compared += 1;
                }
            }
        }
    }
    assert_eq!(compared, 4 * 60 * 4);
}

#[test]
fn many_units_lose_nothing_however_little_room_there_is() {
    let h = with_vertices(VertexForm::Compact, terrain(4, 5, 0.5, 2));
    let scene = scene_of(&h);
    let image = LodImage::of(&scene);
    let rays = steps(image, &any_rays(&h, 1000, 4));
    let shape = [("cores.groups", 4), ("units.per_group", 2), ("units.contexts", 16)];
    let little =
        [("l1.mshrs", 1), ("l1.targets", 1), ("l1.queue", 1), ("l2.mshrs", 1), ("l2.queue", 1), ("l2.banks", 1), ("dram.queue", 1)];
    let roomy = units(&machine(&shape), &rays);
    let tight = units(&machine(&[&shape[..], &little].concat()), &rays);
    for run in [&roomy, &tight] {
        let (l1, l2) = (run.counts.l1, run.counts.l2);
        assert_eq!(run.counts.rays, 1000);
        assert_eq!(l1.requests, l1.hits + l1.misses + l1.merges);
        assert_eq!((l1.misses, l2.misses), (l2.requests, run.channels.iter().map(|channel| channel.reads).sum()));
        let lines: u64 = rays.iter().flatten().filter_map(|step| step.fetch).map(|fetch| u64::from(fetch.lines)).sum();
        assert_eq!(l1.requests, lines);
        let counts = run.units.as_ref().expect("units");
        assert_eq!(counts.states.iter().sum::<u64>(), run.cycles * 8 * 16, "every context is in some state in every cycle");
    }
    assert!(tight.cycles > roomy.cycles && tight.counts.l1.refused_cycles > 0);
}

/// What replays a terrain from `distance` radii through a BVH on so many threads.
fn replayed(distance: f64) -> impl Fn(&Machine, usize) -> Run {
    let scene = scene_of(&terrain(16, 3, 0.5, 1));
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, 512, 512).expect("a camera");
    let sight = Sight::new(&camera, &space, 1.0);
    let method = (bvh::METHOD.make)(&scene, &Knobs::default(), &NoStore).expect("a method on a scene");
    let mut chunks: Vec<Chunk> = Vec::new();
    FrameRays { method: &*method, rays: &camera, sight: &sight }.produce(&mut |traced| {
        chunks.push(traced.batches.into());
        true
    });
    let nodes = method.map(&sight).nodes();
    move |machine, threads| {
        let how = Running { threads, ..Running::default() };
        replay::run_free(machine, nodes, chunks.iter().cloned(), how).expect("a run")
    }
}

/// In a frame of this size groups are given rays in cycles in which ports wake, and lines come in those in which others are asked for.
#[test]
fn a_frame_does_not_depend_on_threads() {
    let run = replayed(2.0);
    let one = run(&machine(&[]), 1);
    assert!((2..9).all(|threads| run(&machine(&[]), threads) == one));
}

/// A memory that answers late: whole stretches go by in which a group waits and does nothing.
#[test]
fn nothing_is_fuller_than_full_in_any_stretch_of_time() {
    let run = replayed(2.0);
    for sets in [&[][..], &[("l1.mshrs", 2), ("l2.mshrs", 1), ("l2.queue", 2), ("crossbar.answer_cycles", 5000), ("dram.queue", 2)]] {
        let machine = machine(sets);
        let one = run(&machine, 1);
        assert!(run(&machine, 3) == one);
        let (groups, l1, l2) = (u64::from(machine.cores.groups), &machine.l1, &machine.l2);
        let mut before = (0, [0; 5]);
        for interval in &one.intervals {
            let Interval { end, counts, channels, .. } = interval;
            let taken = [
                counts.l1.register_cycles,
                counts.l1.queued_cycles,
                counts.l2.register_cycles,
                counts.l2.queued_cycles,
                channels.queued_clocks,
            ];
            let room = [
                groups * u64::from(l1.banks * l1.mshrs),
                groups * u64::from(l1.banks * l1.queue),
                u64::from(l2.banks * l2.mshrs),
                u64::from(l2.banks * l2.queue),
            ];
            let cycles = end - before.0;
            for (k, room) in room.into_iter().enumerate() {
                let added = taken[k] - before.1[k];
                assert!(added <= cycles * room, "{k}: {added} of {} up to cycle {end}", cycles * room);
            }
            // Clocks begin and end within cycles.
            let clocks = (cycles as f64 * one.dram_clocks as f64 / one.cycles as f64) as u64 + 2;
            let room = u64::from(machine.dram.channels) * u64::from(machine.dram.queue);
            assert!(taken[4] - before.1[4] <= clocks * room, "{} of {} up to cycle {end}", taken[4] - before.1[4], clocks * room);
            before = (*end, taken);
        }
        assert!(one.intervals.len() > 8);
        assert_eq!(
            before.1[..4],
            [one.counts.l1.register_cycles, one.counts.l1.queued_cycles, one.counts.l2.register_cycles, one.counts.l2.queued_cycles]
        );
        assert_eq!([one.counts.l1.registers_now, one.counts.l2.registers_now, one.counts.l1.queued_now, one.counts.l2.queued_now], [0; 4]);
    }
}
