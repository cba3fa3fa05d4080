//! Rays per second through one traversal unit of 16 contexts: its timing alone, from event to event, and the cycle model.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lodray::hardware::Hardware;
use lodray::method::lod::LodImage;
use lodray::sim::timing::UnitTiming;
use lodray::sim::unit::environment::run;
use lodray::sim::unit::{Latency, SceneMemory, Traffic, TraversalUnit};
use lodray_test_support::models::{any_rays, scene_of, terrain};
use lodray_test_support::timing::{Smooth, steps_of};
use std::hint::black_box;

const RAYS: usize = 5000;
const LATENCY: u32 = 10;

fn rays(c: &mut Criterion) {
    let h = terrain(4, 5, 0.4, 7);
    let scene = scene_of(&h);
    let image = LodImage::of(&scene);
    let memory = SceneMemory::new(image, 0);
    let rays = any_rays(&h, RAYS, 9);
    let batch = steps_of(image, &rays);
    let config = Hardware { contexts: 16, ..Hardware::default() };

    let mut group = c.benchmark_group("unit");
    group.throughput(Throughput::Elements(RAYS as u64)).sample_size(10);
    group.bench_function("timing", |b| {
        b.iter(|| black_box(Smooth::new(&batch, u64::from(LATENCY)).run(&mut UnitTiming::new(config))));
    });
    let traffic = Traffic::smooth(Latency::Fixed(LATENCY));
    group.bench_function("cycle model", |b| {
        b.iter(|| {
            black_box(run(&mut TraversalUnit::new(config, memory.config()), &memory, &traffic, &rays).expect("a run without errors"))
        });
    });
    group.finish();
}

criterion_group!(benches, rays);
criterion_main!(benches);
