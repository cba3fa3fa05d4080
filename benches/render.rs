//! LOD rendering: hitting rays per second and core, full hit record, terrain of the paper's size at 2 radii, delta 1.
//!
//! `LODRAY_TERRAIN_LEVELS` makes the scene smaller for a quick look.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lodray::bvh::{FullBvh, FullOptions, LeafLayout, over_trees};
use lodray::format::{self, SceneInfo};
use lodray::mesh::procedural::{self, Options};
use lodray::num::Ray;
use lodray::render::{Camera, View};
use lodray::traverse::{BvhTraverser, ClosestHit, LodImage, LodTraverser, ModelSpace, NoProbe};
use std::hint::black_box;

/// One row of pixels in `ROW_STEP` is traced: a frame's mixture in less time.
const ROW_STEP: u32 = 16;

fn benches(c: &mut Criterion) {
    let levels = std::env::var("LODRAY_TERRAIN_LEVELS").ok().and_then(|v| v.parse().ok());
    let options = Options { levels, ..Options::new(procedural::Scene::Terrain) };
    let surface = procedural::generate(&options).expect("options");
    let scene = format::build(&surface, SceneInfo::default(), over_trees).expect("a scene");
    drop(surface);
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 1024, 1024).expect("a view");
    let pixels = (0..1024).step_by(ROW_STEP as usize).flat_map(|y| (0..1024).map(move |x| (x, y)));
    let rays: Vec<Ray> = pixels.filter_map(|(x, y)| Some(space.enter(&camera.ray(x, y), 1.0)?.ray)).collect();

    let image = LodImage::of(&scene);
    let mut lod = LodTraverser::new(image);
    let mut hit_by = |ray: &Ray| {
        let mut closest = ClosestHit::new(image.levels);
        lod.trace(ray, &mut NoProbe, &mut closest);
        closest.record()
    };
    // Only rays that hit are counted and timed.
    let rays: Vec<Ray> = rays.into_iter().filter(|r| hit_by(r).is_some()).collect();
    let mut group = c.benchmark_group("terrain at 2 radii, one core");
    group.throughput(Throughput::Elements(rays.len() as u64)).sample_size(20);
    group.bench_function("lod, hitting rays", |b| b.iter(|| rays.iter().filter(|r| black_box(hit_by(r)).is_some()).count()));

    let bvh = FullBvh::build(&scene.decode(), &FullOptions::new(4, false, LeafLayout::Line)).expect("a valid model");
    let mut traverser = BvhTraverser::new(&bvh);
    group.bench_function("16-bit quad-BVH, hitting rays", |b| {
        b.iter(|| {
            rays.iter()
                .filter(|ray| {
                    let mut closest = ClosestHit::new(image.levels);
                    traverser.trace(ray, &mut NoProbe, &mut closest);
                    black_box(closest.record()).is_some()
                })
                .count()
        })
    });
    group.finish();
}

criterion_group!(render, benches);
criterion_main!(render);
