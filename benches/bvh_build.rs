//! Triangles per second of the full-resolution quad-BVH, by leaf size, on the terrain of the paper's size (8,388,608 triangles).
//!
//! `LODRAY_TERRAIN_LEVELS` makes the scene smaller for a quick look.

use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use lodray::mesh::procedural::{self, generate};
use lodray::mesh::{BoundKind, quantise};
use lodray::method::bvh::{FullBvh, FullOptions, LeafLayout, NodeBoxes};
use lodray::num::VertexForm;
use std::hint::black_box;

fn benches(c: &mut Criterion) {
    let levels = std::env::var("LODRAY_TERRAIN_LEVELS").ok().and_then(|v| v.parse().ok());
    let surface = generate(&procedural::Options { levels, ..procedural::Options::new(procedural::Scene::Terrain) }).expect("options");
    let hierarchy = quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).expect("a valid surface");
    drop(surface);
    let mut group = c.benchmark_group("full-resolution quad-BVH of the terrain");
    group.throughput(Throughput::Elements(hierarchy.finest_triangles())).sample_size(10).sampling_mode(SamplingMode::Flat);
    for max_leaf in [1, 2, 4] {
        let options = FullOptions::new(max_leaf, NodeBoxes::Local, LeafLayout::Line);
        group.bench_with_input(BenchmarkId::new("leaf", max_leaf), &options, |b, options| {
            b.iter(|| black_box(FullBvh::build(&hierarchy, options).expect("a valid model")));
        });
    }
    group.finish();
}

criterion_group!(bvh_build, benches);
criterion_main!(bvh_build);
