//! Rates of building, writing, opening and auditing a terrain-like scene.
#![allow(missing_docs)]

use lodray_test_support::surfaces::grid;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lodray::format::audit::audit;
use lodray::format::{Scene, build};
use lodray::mesh::quantise;

fn build_and_write(c: &mut Criterion) {
    // 512 trees of 7 splits: 8.4 million triangles.
    let surface = grid(7, 16);
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("bench.lod");
    let mut group = c.benchmark_group("scene");
    group.sample_size(10).throughput(Throughput::Elements(surface.finest_triangles()));
    group.bench_function("quantise and bounds", |b| b.iter(|| quantise(&surface).expect("a valid surface")));
    group.bench_function("build", |b| b.iter(|| build(&surface, lodray_test_support::surfaces::info("bench"), lodray::bvh::over_trees).expect("a valid surface")));
    group.bench_function("build and write", |b| {
        b.iter(|| build(&surface, lodray_test_support::surfaces::info("bench"), lodray::bvh::over_trees).and_then(|s| s.save(&path)).expect("written"));
    });
    group.bench_function("open", |b| b.iter(|| Scene::open(&path).expect("valid")));
    let scene = Scene::open(&path).expect("valid");
    group.bench_function("audit", |b| b.iter(|| assert!(audit(&scene).passed())));
    group.finish();
}

criterion_group!(benches, build_and_write);
criterion_main!(benches);
