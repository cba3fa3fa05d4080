//! LOD rendering: hitting rays per second and core, full hit record, terrain of the paper's size at 2 radii, delta 1.
//!
//! `LODRAY_TERRAIN_LEVELS` makes the scene smaller for a quick look.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use lodray::bvh::over_trees;
use lodray::format::{self, SceneInfo};
use lodray::mesh::BoundKind;
use lodray::mesh::procedural::{self, Options};
use lodray::method::ClosestHit;
use lodray::method::bvh::BvhTraverser;
use lodray::method::bvh::{FullBvh, FullOptions, LeafLayout, NodeBoxes};
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::Ray;
use lodray::rays::ModelSpace;
use lodray::rays::{Camera, View};
use lodray::step::NoSteps;
use std::hint::black_box;

/// Tiles of the frame as the renderer traces them.
const TILE: (u32, u32) = (32, 8);
const SIDE: u32 = 1024;

/// All rays of a frame that meet the model's box, tile by tile.
fn rays(space: &ModelSpace) -> Vec<Ray> {
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, space, SIDE, SIDE).expect("a view");
    let (columns, tile) = (SIDE / TILE.0, TILE.0 * TILE.1);
    let pixel = |i: u32| {
        let (tile, within) = (i / tile, i % tile);
        (tile % columns * TILE.0 + within % TILE.0, tile / columns * TILE.1 + within / TILE.0)
    };
    (0..SIDE * SIDE).map(pixel).filter_map(|(x, y)| Some(space.enter(&camera.ray(x, y), 1.0)?.ray)).collect()
}

fn benches(c: &mut Criterion) {
    let levels = std::env::var("LODRAY_TERRAIN_LEVELS").ok().and_then(|v| v.parse().ok());
    for roughness in [0.45, 0.55] {
        let options = Options { levels, roughness: Some(roughness), ..Options::new(procedural::Scene::Terrain) };
        let surface = procedural::generate(&options).expect("options");
        let scene = format::build(&surface, SceneInfo { bounds: BoundKind::Largest, ..SceneInfo::default() }, over_trees).expect("a scene");
        drop(surface);
        let image = LodImage::of(&scene);
        let mut lod = LodTraverser::new(image);
        let mut hit_by = |ray: &Ray| {
            let mut closest = ClosestHit::new(image.levels);
            lod.trace(ray, &mut NoSteps, &mut closest);
            closest.record()
        };
        // Only rays that hit are counted and timed.
        let rays: Vec<Ray> = rays(&ModelSpace::of(&scene)).into_iter().filter(|r| hit_by(r).is_some()).collect();
        let mut group = c.benchmark_group(format!("terrain of roughness {roughness} at 2 radii, one core"));
        group.throughput(Throughput::Elements(rays.len() as u64)).sample_size(10).sampling_mode(SamplingMode::Flat);
        group.bench_function("LOD, hitting rays", |b| b.iter(|| rays.iter().filter(|r| black_box(hit_by(r)).is_some()).count()));

        let bvh = FullBvh::build(&scene.decode(), &FullOptions::new(4, NodeBoxes::Local, LeafLayout::Line)).expect("a valid model");
        let mut traverser = BvhTraverser::new(&bvh);
        let mut hit_by = |ray: &Ray| {
            let mut closest = ClosestHit::new(image.levels);
            traverser.trace(ray, &mut NoSteps, &mut closest);
            closest.record()
        };
        group.bench_function("quad-BVH, boxes in steps, a line a triangle, hitting rays", |b| {
            b.iter(|| rays.iter().filter(|r| black_box(hit_by(r)).is_some()).count())
        });
        group.finish();
    }
}

criterion_group!(render, benches);
criterion_main!(render);
