//! Traversal units on a machine: a unit whose lines are all in its L1 takes the cycles of the RTL, and many of them lose nothing.

use lodray::machine::Machine;
use lodray::method::Knobs;
use lodray::method::bvh::{self, NoStore};
use lodray::method::lod::LodImage;
use lodray::num::{Ray, VertexForm};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::FrameRays;
use lodray::sim::replay::{self, Chunk, Run, Running};
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
    use VertexForm::{Compact, Exact};
    for (form, h, seed) in [(Compact, ball(4, 0.4, 1), 1), (Exact, terrain(3, 5, 0.5, 2), 2), (Compact, ball(0, 0.4, 3), 3)] {
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
    assert_eq!(compared, 3 * 60 * 4);
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

/// In a frame of this size groups are given rays in cycles in which ports wake, and lines come in those in which others are asked for.
#[test]
fn a_frame_does_not_depend_on_threads() {
    let scene = scene_of(&terrain(16, 3, 0.5, 1));
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 512, 512).expect("a camera");
    let sight = Sight::new(&camera, &space, 1.0);
    let method = (bvh::METHOD.make)(&scene, &Knobs::default(), &NoStore).expect("a method on a scene");
    let mut chunks: Vec<Chunk> = Vec::new();
    FrameRays { method: &*method, rays: &camera, sight: &sight }.produce(|traced| {
        chunks.push(traced.batches.into());
        true
    });
    let nodes = method.map(&sight).nodes();
    let run = |threads| {
        let how = Running { threads, ..Running::default() };
        replay::run_free(&machine(&[]), nodes, chunks.iter().cloned(), how).expect("a run")
    };
    let one = run(1);
    assert!((2..9).all(|threads| run(threads) == one));
}
