//! What a unit shows for test and debugging. In every comparison of these tests view and counters equal the cycle model's; here is what they mean, and that a wrong word of a memory is told.

use crate::{QUEUED, SideBySide};
use lodray::hardware::ports::UnitCounters;
use lodray::method::lod::LodImage;
use lodray::num::{U, VertexForm};
use lodray::sim::unit::environment::{UnitPort, run};
use lodray::sim::unit::{Inputs, Latency, SceneMemory, Stall, Traffic};
use lodray_test_support::models::{any_rays, ball, scene_of, with_vertices};

#[test]
fn counters_add_up_and_start_anew() {
    let h = with_vertices(VertexForm::Short, ball(4, 0.4, 1));
    let scene = scene_of(&h);
    let memory = SceneMemory::new(LodImage::of(&scene), 0);
    let rays = any_rays(&h, 200, 1);
    let mut both = SideBySide::new(QUEUED, &memory.config(), 1, "counters".to_owned());
    let memory_stall = Stall::Random { eighths: 3, stretch: 4, seed: 1 };
    let report = run(&mut both, &memory, &Traffic { memory_stall, ..Traffic::smooth(Latency::Fixed(20)) }, &rays).expect("a run");
    let counters = both.rtl.watched(0).expect("counters").counters;
    println!("{counters:?}");
    let UnitCounters { cycles, busy, rays: taken, hits, misses, errors, requests, answers, requests_wait, .. } = counters;
    assert_eq!(cycles.get(), report.cycles);
    assert!(busy.get() > 0 && busy <= cycles);
    assert_eq!((taken.get(), hits.get() + misses.get(), errors), (200, 200, U::ZERO));
    assert_eq!(hits.get(), report.rays.iter().filter(|ray| ray.hit.found).count() as u64);
    assert_eq!((requests.get(), answers.get()), (report.requests, report.requests));
    assert_eq!(requests_wait.get(), report.waited[0]);
    // A ray is set up once; a node_address has an address for each request; all else is asked for by some.
    let [setup, fetch, child, decide, lod, morph, tri, divide, map, hit] = counters.taken.map(U::get);
    assert_eq!((setup, fetch, hit, decide), (200, report.requests, 200, 0));
    assert_eq!((divide, map), (2 * hits.get(), hits.get()));
    assert!(child > setup && lod > morph && morph > 0 && tri > hits.get());
    assert!(counters.compared.get() >= hits.get() && counters.refused.iter().any(|count| count.get() > 0));

    both.rtl.clear_counters(true);
    both.tick(&Inputs::default());
    both.rtl.clear_counters(false);
    both.model.clear_counters();
    both.outputs();
    both.tick(&Inputs::default());
    assert_eq!(both.rtl.watched(0).expect("counters").counters, UnitCounters { cycles: U::new(1), ..UnitCounters::default() });
}

#[test]
fn a_wrong_word_of_a_memory_is_told() {
    let h = with_vertices(VertexForm::Exact, ball(4, 0.4, 1));
    let scene = scene_of(&h);
    let memory = SceneMemory::new(LodImage::of(&scene), 0);
    let rays = any_rays(&h, 100, 1);
    let mut both = SideBySide::new(QUEUED, &memory.config(), 1, "faults".to_owned());
    both.parity_broken = true;
    both.rtl.memory_parity(false);
    // The words themselves are right, and so are the hits.
    run(&mut both, &memory, &Traffic::smooth(Latency::Fixed(20)), &rays).expect("a run");
    println!("{} cycles with a fault", both.faults);
    assert!(both.faults > 1000);
}
