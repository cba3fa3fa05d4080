//! The binary BVH of 16-triangle leaves beside the quad-BVH: bytes a triangle, seconds to build, and rays a second on one thread, exact and in floats. A line of JSON for each scene.
//!
//! `cargo bench --bench binary16 -- SCENE.lod...`

use lodray::format::Scene;
use lodray::method::ClosestHit;
use lodray::method::binary16::{FloatTree, Traverser, Tree, memory};
use lodray::method::bvh::{BvhTraverser, FullBvh, FullOptions, LeafLayout, NodeBoxes};
use lodray::method::floats::FloatRay;
use lodray::num::Ray;
use lodray::rays::{Camera, ModelSpace, View};
use lodray::step::NoSteps;
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// Columns and rows of the frame.
const SIDE: u32 = 512;

/// Seconds of the fastest of three runs, and what the last gave.
fn best<T>(mut run: impl FnMut() -> T) -> (f64, T) {
    let mut timed = || {
        let start = Instant::now();
        let out = run();
        (start.elapsed().as_secs_f64(), out)
    };
    let (mut least, mut out) = timed();
    for _ in 0..2 {
        let (seconds, next) = timed();
        (least, out) = (least.min(seconds), next);
    }
    (least, out)
}

/// Rays a second, and how many met something.
fn rate(rays: &[Ray], mut trace: impl FnMut(&Ray) -> bool) -> (f64, usize) {
    let (seconds, hits) = best(|| rays.iter().filter(|ray| trace(ray)).count());
    (rays.len() as f64 / seconds, hits)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for file in std::env::args().skip(1).filter(|word| !word.starts_with('-')) {
        let scene = Scene::open(Path::new(&file))?;
        let (hierarchy, space) = (scene.decode(), ModelSpace::of(&scene));
        let camera = Camera::new(&View::default(), &space, SIDE, SIDE)?;
        let all = (0..SIDE * SIDE).filter_map(|i| space.enter(&camera.ray(i % SIDE, i / SIDE), f64::INFINITY));
        let rays: Vec<Ray> = all.map(|ray| ray.ray).collect();

        let (quad_build, quad) = best(|| FullBvh::build(&hierarchy, &FullOptions::new(16, NodeBoxes::Local, LeafLayout::Block)));
        let quad = quad?;
        let mut traverser = BvhTraverser::new(&quad);
        let (quad_rate, quad_hits) = rate(&rays, |ray| {
            let mut hit = ClosestHit::new(hierarchy.levels);
            traverser.trace(ray, &mut NoSteps, &mut hit);
            hit.record().is_some()
        });
        drop(traverser);
        drop(quad);

        let (build, tree) = best(|| Tree::new(&hierarchy));
        let tree = tree?;
        let mut traverser = Traverser::new(&tree, memory(&tree));
        let (exact_rate, hits) = rate(&rays, |ray| {
            let mut hit = ClosestHit::new(hierarchy.levels);
            traverser.trace(ray, None, &mut NoSteps, &mut hit);
            hit.record().is_some()
        });
        let floats: Vec<FloatRay> = rays.iter().map(FloatRay::new).collect();
        let mut float = FloatTree::new(&tree);
        let (seconds, float_hits) = best(|| float.hits(&floats));
        let line = json!({
            "scene": scene.meta().name, "triangles": tree.triangles, "rays": rays.len(),
            "bytes": tree.bytes(), "bytes_a_triangle": tree.bytes() as f64 / tree.triangles as f64,
            "triangles_a_leaf": tree.triangles as f64 / tree.leaves() as f64, "floats": tree.has_floats,
            "build_seconds": build, "rays_per_second": exact_rate, "hits": hits,
            "float_rays_per_second": rays.len() as f64 / seconds, "float_hits": float_hits,
            "bvh": { "build_seconds": quad_build, "rays_per_second": quad_rate, "hits": quad_hits },
        });
        println!("{line}");
    }
    Ok(())
}
