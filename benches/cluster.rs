//! Clusters on this processor: seconds to make graphs, their bytes, seconds to make a frame's BVH, and rays a second on one thread beside the BVH of the full resolution. One line of JSON for each.
//!
//! `cargo bench --bench cluster -- SCENE.lod...`; `scripts/cluster` makes tables of it. `LODRAY_CLUSTER_DISTANCE` is the camera's distance in radii (default 2).

use lodray::format::Scene;
use lodray::method::ClosestHit;
use lodray::method::bvh::{BvhTraverser, FullBvh, FullOptions, LeafLayout, NodeBoxes};
use lodray::method::cluster::{Cut, FrameBvh, Graph, Kind, Rule, Snapped, pack, pack_dense};
use lodray::num::Ray;
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::step::NoSteps;
use rayon::prelude::*;
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// Columns and rows of the frame.
const SIDE: u32 = 512;

fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let out = run();
    (start.elapsed().as_secs_f64(), out)
}

/// Seconds for all rays, and how many met something.
fn rate(bvh: &FullBvh, levels: u32, rays: &[Ray]) -> (f64, usize) {
    let mut traverser = BvhTraverser::new(bvh);
    let hits = |ray: &&Ray| {
        let mut hit = ClosestHit::new(levels);
        traverser.trace(ray, &mut NoSteps, &mut hit);
        hit.record().is_some()
    };
    timed(|| rays.iter().filter(hits).count())
}

/// Most memory that this process has had, in bytes; none where the system does not say.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<u64>().ok()? * 1024)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let distance = std::env::var("LODRAY_CLUSTER_DISTANCE").ok().and_then(|text| text.parse().ok()).unwrap_or(2.0);
    for file in std::env::args().skip(1).filter(|word| !word.starts_with('-')) {
        let scene = Scene::open(Path::new(&file))?;
        let space = ModelSpace::of(&scene);
        let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, SIDE, SIDE)?;
        let rays: Vec<Ray> =
            (0..SIDE * SIDE).filter_map(|i| Some(space.enter(&camera.ray(i % SIDE, i / SIDE), f64::INFINITY)?.ray)).collect();
        let options = FullOptions::new(16, NodeBoxes::Six, LeafLayout::Block);
        let name = &scene.meta().name;
        {
            let (build, bvh) = timed(|| FullBvh::build(&scene.decode(), &options));
            let (seconds, hits) = rate(&bvh?, scene.levels(), &rays);
            println!("{}", json!({"scene": name, "of": "bvh6", "build": build, "seconds": seconds, "rays": rays.len(), "hits": hits}));
        }
        for (of, kind, rule) in [
            ("cluster", Kind::Shipped, Rule { error: Some(1.0), size: None, outside: 2.0 }),
            ("cluster-paper", Kind::Paper, Rule { error: None, size: Some(24.0), outside: 2.0 }),
        ] {
            let (snapping, snapped) = timed(|| Snapped::new(&scene));
            drop(snapped);
            let (graphing, graph) = timed(|| Graph::build(&scene, kind, 16));
            let graph = graph?;
            let bytes: usize = graph.clusters.iter().map(|cluster| pack(&graph, cluster).len()).sum();
            let dense: usize = graph.clusters.par_iter().map(|cluster| size_of_val(pack_dense(&graph, cluster).0.as_slice())).sum();
            let sight = Sight::new(&camera, &space, 1.0);
            let (selecting, cut) = timed(|| Cut::new(&graph, &rule, &sight.eyes));
            let (clusters, asked) = (cut.clusters.len(), cut.asked.len());
            let (building, frame) = timed(|| FrameBvh::new(&graph, cut, &options));
            let frame = frame?;
            let (seconds, hits) = rate(&frame.bvh, 0, &rays);
            let [roots, coarsest] = graph.roots();
            println!(
                "{}",
                json!({
                    "scene": name, "of": of, "finest": graph.finest, "clusters": graph.clusters.len(), "groups": graph.groups.len(),
                    "triangles": graph.triangles.len(), "bytes": bytes, "dense": dense, "roots": roots, "coarsest": coarsest,
                    "snapping": snapping, "graph": graphing - snapping, "selecting": selecting, "building": building,
                    "frame": frame.triangles.len(), "frame_clusters": clusters, "asked": asked,
                    "seconds": seconds, "rays": rays.len(), "hits": hits, "peak": peak(),
                })
            );
        }
    }
    Ok(())
}
