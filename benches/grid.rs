//! Grid primitives on this processor: bytes, seconds to build, and rays a second on one thread, beside the full-resolution BVH and the binary BVH that is their reference. One line of JSON for each.
//!
//! `cargo bench --bench grid -- SCENE.lod...`; `scripts/grid` makes tables of it. `LODRAY_GRID_SIZE` is the side of the frame (default 512), `LODRAY_GRID_DISTANCE` the camera's distance
//! in radii (default 1.5). `LODRAY_GRID_BUILD=1` takes primitives of three and four levels with two left out alone: what it takes to build large scenes.

use lodray::format::Scene;
use lodray::method::ClosestHit;
use lodray::method::binary16::{self, FloatTree, Traverser, Tree};
use lodray::method::bvh::{BvhTraverser, FullBvh, FullOptions, LeafLayout, NodeBoxes, bvh_map};
use lodray::method::floats::FloatRay;
use lodray::method::grid::{Caps, FloatGrid, GridMesh, GridOptions, GridTraverser, PointForm, Width};
use lodray::num::Ray;
use lodray::rays::{Camera, ModelSpace, View};
use lodray::step::{MemoryMap, NoSteps};
use serde_json::json;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

fn variable(name: &str, default: f64) -> f64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

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

/// Seconds for all rays, and how many met something.
fn rate(rays: &[Ray], mut hits: impl FnMut(&Ray) -> bool) -> (f64, usize) {
    best(|| rays.iter().filter(|ray| hits(ray)).count())
}

fn sections(map: &MemoryMap) -> serde_json::Map<String, serde_json::Value> {
    map.sections().map(|(_, section)| (section.name.to_owned(), json!(section.lines * 32))).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for file in std::env::args().skip(1).filter(|word| !word.starts_with('-')) {
        let scene = Scene::open(Path::new(&file))?;
        let (h, space) = (scene.decode(), ModelSpace::of(&scene));
        let side = variable("LODRAY_GRID_SIZE", 512.0) as u32;
        let view = View { distance: Some(variable("LODRAY_GRID_DISTANCE", 1.5)), ..View::default() };
        let camera = Camera::new(&view, &space, side, side)?;
        let rays: Vec<Ray> =
            (0..side * side).filter_map(|i| Some(space.enter(&camera.ray(i % side, i / side), f64::INFINITY)?.ray)).collect();
        let floats: Vec<FloatRay> = rays.iter().map(FloatRay::new).collect();
        let common = |what: &str| json!({"scene": scene.meta().name, "triangles": h.finest_triangles(), "rays": rays.len(), "of": what});
        let tell = |what: &str, more: serde_json::Value| {
            let mut line = common(what);
            if let (Some(line), Some(more)) = (line.as_object_mut(), more.as_object()) {
                line.extend(more.clone());
            }
            println!("{line}");
        };

        let (build, bvh) = best(|| FullBvh::build(&h, &FullOptions::new(16, NodeBoxes::Local, LeafLayout::Block)));
        let bvh = bvh?;
        let mut traverser = BvhTraverser::new(&bvh);
        let (seconds, hits) = rate(&rays, |ray| {
            let mut hit = ClosestHit::new(h.levels);
            traverser.trace(ray, &mut NoSteps, &mut hit);
            hit.record().is_some()
        });
        tell("bvh", json!({"build": build, "seconds": seconds, "hits": hits, "bytes": sections(&bvh_map(&[&bvh]))}));
        drop(traverser);
        drop(bvh);

        let (build, tree) = best(|| Tree::new(&h));
        let tree = tree?;
        let mut traverser = Traverser::new(&tree, binary16::memory(&tree));
        let (seconds, hits) = rate(&rays, |ray| {
            let mut hit = ClosestHit::new(h.levels);
            traverser.trace(ray, None, &mut NoSteps, &mut hit);
            hit.record().is_some()
        });
        let mut float = FloatTree::new(&tree);
        let (float_seconds, float_hits) = best(|| float.hits(&floats));
        let bytes = sections(&binary16::memory(&tree));
        tell(
            "binary16",
            json!({"build": build, "seconds": seconds, "hits": hits, "float_seconds": float_seconds, "float_hits": float_hits, "bytes": bytes}),
        );
        drop(traverser);
        drop(float);
        drop(tree);
        let only_builds = std::env::var_os("LODRAY_GRID_BUILD").is_some();
        // What the paper's leaves of 16 are worth on a processor.
        for leaf in [2, 4, 8, 16].into_iter().filter(|_| !only_builds) {
            let mut float = FloatTree::with_leaves(&h, leaf)?;
            let (float_seconds, float_hits) = best(|| float.hits(&floats));
            tell("leaves", json!({"leaf": leaf, "float_seconds": float_seconds, "float_hits": float_hits}));
        }

        for splits in 1..=4 {
            for left_out in 0..=splits {
                if only_builds && (splits < 3 || left_out != 2) {
                    continue;
                }
                for (width, nodes) in [(Width::Two, 2), (Width::Four, 4), (Width::Six, 6)] {
                    // What is less telling is told once.
                    if nodes == 6 && (splits, left_out) != (4, 2) {
                        continue;
                    }
                    let options = GridOptions { splits, left_out, width, points: PointForm::Float, ..GridOptions::default() };
                    let of = |form: &str| json!({"levels": splits, "left_out": left_out, "nodes": nodes, "points": form});
                    let (build, mesh) = best(|| GridMesh::build(&h, &options));
                    let mesh = Arc::new(mesh?);
                    let mut own = of("float");
                    (own["build"], own["bytes"]) = (json!(build), json!(sections(mesh.map())));
                    let mut traverser = GridTraverser::new(Arc::clone(&mesh), Caps::Frame(mesh.pattern.splits));
                    let (seconds, hits) = rate(&rays, |ray| {
                        let mut hit = ClosestHit::new(h.levels);
                        traverser.trace(ray, &mut NoSteps, &mut hit);
                        hit.record().is_some()
                    });
                    (own["seconds"], own["hits"]) = (json!(seconds), json!(hits));
                    drop(traverser);
                    if let Some(mut floating) = FloatGrid::new(mesh) {
                        let (seconds, hits) = best(|| floats.iter().filter(|ray| floating.trace(ray).is_some()).count());
                        (own["float_seconds"], own["float_hits"]) = (json!(seconds), json!(hits));
                    }
                    tell("grid", own);
                    if nodes == 4 && left_out == splits.min(2) {
                        let mut packed = of("packed");
                        packed["bytes"] =
                            json!(sections(GridMesh::build(&h, &GridOptions { points: PointForm::Packed, ..options })?.map()));
                        tell("grid", packed);
                    }
                }
            }
        }
    }
    Ok(())
}
