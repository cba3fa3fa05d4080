//! Rates of generating, building, writing, opening and auditing the terrain of the paper's size: 8,388,608 triangles.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lodray::bvh::over_trees;
use lodray::format::audit::audit;
use lodray::format::{Scene, SceneInfo, build};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, quantise};
use lodray::num::VertexForm;

fn terrain(c: &mut Criterion) {
    let options = Options::new(procedural::Scene::Terrain);
    let surface = procedural::generate(&options).expect("default options");
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("bench.lod");
    let built = || build(&surface, SceneInfo { bounds: BoundKind::Largest, ..SceneInfo::default() }, over_trees).expect("a valid surface");
    let mut group = c.benchmark_group("terrain");
    group.sample_size(10).throughput(Throughput::Elements(surface.finest_triangles()));
    group.bench_function("generate", |b| b.iter(|| procedural::generate(&options).expect("default options")));
    group.bench_function("quantise and bounds", |b| {
        b.iter(|| quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).expect("a valid surface"))
    });
    group.bench_function("build and write", |b| b.iter(|| built().save(&path).expect("written")));
    group.bench_function("open", |b| b.iter(|| Scene::open(&path).expect("valid")));
    let scene = Scene::open(&path).expect("valid");
    group.bench_function("audit", |b| b.iter(|| assert!(audit(&scene).passed())));
    group.bench_function("build, write and audit", |b| {
        b.iter(|| {
            let scene = built();
            scene.save(&path).expect("written");
            assert!(audit(&scene).passed());
        });
    });
    group.finish();
}

criterion_group!(benches, terrain);
criterion_main!(benches);
