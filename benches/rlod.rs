//! R-LODs on this processor: seconds to build, what a tree takes, and by pixels of error the nodes and pages that a frame visits, its rays a second on one thread, its holes and how far it is off.
//! One line of JSON for each.
//!
//! `cargo bench --bench rlod -- SCENE.lod...`; `scripts/rlod` makes tables of it. `LODRAY_RLOD_DISTANCE` is the camera's distance in radii (default 2), `LODRAY_RLOD_SWEEP=1` also builds trees of other
//! costs, with more and fewer R-LODs, other weights and reaches.

use lodray::format::Scene;
use lodray::method::rlod::{Costs, KdOrder, Metric, Planes, RlodOptions, RlodTracer, RlodTraverser, Tree, map};
use lodray::method::{SurfaceHit, Tracer};
use lodray::rays::{Camera, ModelSpace, Query, View};
use lodray::step::{MemoryMap, Step, StepCounts, StepSink};
use serde_json::json;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Columns and rows of the frame: the paper's, with two by two samples.
const SIDE: u32 = 1024;
/// Deviations by which planes reach beyond their cells.
const REACH: f64 = 3.0;
/// Lines of a page of 4 KB.
const PAGE_LINES: u32 = 128;

fn timed<T>(run: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let out = run();
    (start.elapsed().as_secs_f64(), out)
}

/// Counts steps, and which lines and pages they touch.
struct Touched {
    counts: StepCounts,
    nodes: u64,
    lines: Vec<bool>,
}

impl StepSink for Touched {
    fn step(&mut self, step: Step) {
        self.nodes += u64::from(step.visits);
        if let Some(fetch) = step.fetch {
            self.lines[fetch.line as usize..][..fetch.lines as usize].fill(true);
        }
        self.counts.step(step);
    }
}

/// A frame of rays.
struct Frame<'a> {
    scene: &'a Scene,
    rays: Vec<Query>,
    tan_theta: f64,
    /// What they meet at full detail.
    full: Vec<Option<SurfaceHit>>,
}

impl Frame<'_> {
    fn tracer(&self, tree: &Arc<Tree>, metric: Metric) -> (RlodTracer, MemoryMap) {
        let own = map(tree);
        (RlodTracer::new(RlodTraverser::new(Arc::clone(tree), own, metric), ModelSpace::of(self.scene)), own)
    }

    /// Traces all rays, twice: for time alone, and for what they touch.
    fn row(&self, tree: &Arc<Tree>, metric: Metric) -> serde_json::Value {
        let (mut tracer, own) = self.tracer(tree, metric);
        let (seconds, hits): (f64, Vec<_>) = timed(|| self.rays.iter().map(|ray| tracer.hit(ray)).collect());
        let mut touched = Touched { counts: StepCounts::default(), nodes: 0, lines: vec![false; own.lines() as usize] };
        for ray in &self.rays {
            tracer.heard(ray, &mut touched);
        }
        let lines = touched.lines.iter().filter(|touched| **touched).count();
        let pages = touched.lines.chunks(PAGE_LINES as usize).filter(|page| page.contains(&true)).count();
        let count = |of: fn(&Option<SurfaceHit>, &Option<SurfaceHit>) -> bool| {
            hits.iter().zip(&self.full).filter(|(own, full)| of(own, full)).count()
        };
        // In pixels at the distance of the full resolution.
        let mut off: Vec<f64> = hits
            .iter()
            .zip(&self.full)
            .filter_map(|(own, full)| Some((own.as_ref()?.distance, full.as_ref()?.distance)))
            .map(|(own, full)| (own - full).abs() / (2.0 * self.tan_theta * full))
            .collect();
        off.sort_by(f64::total_cmp);
        let at = |share: f64| off.get(((off.len() as f64 - 1.0) * share) as usize).copied();
        let planes = hits.iter().flatten().filter(|hit| hit.tree as usize >= tree.triangles.len()).count();
        json!({
            "pixels": metric.pixels, "reach": metric.reach, "rays": self.rays.len(), "seconds": seconds, "hits": hits.iter().flatten().count(), "planes": planes,
            "holes": count(|own, full| own.is_none() && full.is_some()), "beyond": count(|own, full| own.is_some() && full.is_none()),
            "nodes": touched.nodes, "lines": lines, "pages": pages, "off_50": at(0.5), "off_99": at(0.99),
        })
    }
}

fn print(scene: &str, of: &str, more: serde_json::Value) {
    let mut line = json!({"scene": scene, "of": of});
    if let (Some(line), serde_json::Value::Object(more)) = (line.as_object_mut(), more) {
        line.extend(more);
    }
    println!("{line}");
}

fn built(name: &str, of: &str, scene: &Scene, options: &RlodOptions) -> Result<Arc<Tree>, Box<dyn std::error::Error>> {
    let (seconds, tree) = timed(|| Tree::new(scene, options));
    let tree = tree?;
    let RlodOptions { planes, order, costs } = options;
    print(
        name,
        "build",
        json!({
            "what": of, "every": planes.every, "weight": planes.weight, "order": format!("{order:?}"), "cost": costs.node / costs.triangle, "cut": costs.cut, "empty": costs.empty,
            "seconds": seconds, "triangles": tree.triangles.len(), "nodes": tree.nodes.len(), "references": tree.references.len(), "rlods": tree.rlods.len(),
            "bytes": tree.bytes(), "ratio": tree.errors.ratio(),
        }),
    );
    Ok(Arc::new(tree))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let distance = std::env::var("LODRAY_RLOD_DISTANCE").ok().and_then(|text| text.parse().ok()).unwrap_or(2.0);
    let sweeps = std::env::var_os("LODRAY_RLOD_SWEEP").is_some();
    for file in std::env::args().skip(1).filter(|word| !word.starts_with('-')) {
        let scene = Scene::open(Path::new(&file))?;
        let space = ModelSpace::of(&scene);
        let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, SIDE, SIDE)?;
        let rays: Vec<Query> = (0..SIDE * SIDE).map(|i| camera.ray(i % SIDE, i / SIDE)).collect();
        let name = &scene.meta().name;
        let usual = RlodOptions::default();
        let with = |every, weight| RlodOptions { planes: Planes { every, weight }, ..usual };
        let mut frame = Frame { scene: &scene, rays, tan_theta: camera.tan_theta, full: Vec::new() };

        // Without any R-LODs, nodes of 8 bytes: what testing for them costs, at no pixel of error, is against this.
        let plain = built(name, "plain", &scene, &with(0, usual.planes.weight))?;
        let full = Metric { pixels: 0.0, reach: REACH };
        {
            let (mut tracer, _) = frame.tracer(&plain, full);
            frame.full = frame.rays.iter().map(|ray| tracer.hit(ray)).collect();
        }
        let tree = built(name, "usual", &scene, &usual)?;
        // In turn, as machines are noisy.
        for _ in 0..3 {
            print(name, "overhead", json!({"plain": frame.row(&plain, full), "own": frame.row(&tree, full)}));
        }
        drop(plain);
        for k in -2..=8 {
            print(name, "pixels", frame.row(&tree, Metric { pixels: f64::from(k).exp2(), reach: REACH }));
        }
        if !sweeps {
            continue;
        }
        for reach in [0.0, 1.0, 2.0, 4.0, 6.0] {
            for pixels in [1.0, 5.0, 16.0] {
                print(name, "reach", frame.row(&tree, Metric { pixels, reach }));
            }
        }
        let depth = built(name, "order", &scene, &RlodOptions { order: KdOrder::Depth, ..usual })?;
        for pixels in [0.0, 4.0] {
            print(name, "order", frame.row(&depth, Metric { pixels, reach: REACH }));
        }
        for every in [1, 2, 4] {
            let tree = built(name, "every", &scene, &with(every, usual.planes.weight))?;
            for pixels in [1.0, 4.0, 16.0] {
                let mut row = frame.row(&tree, Metric { pixels, reach: REACH });
                row["every"] = every.into();
                print(name, "every", row);
            }
        }
        for weight in [0.0, 1.0, 4.0, 64.0] {
            let tree = built(name, "weight", &scene, &with(3, weight))?;
            for pixels in [1.0, 4.0, 16.0, 64.0] {
                let mut row = frame.row(&tree, Metric { pixels, reach: REACH });
                row["weight"] = weight.into();
                print(name, "weight", row);
            }
        }
        for (node, cut) in [(1.0, 0.3), (2.0, 0.3), (4.0, 0.1), (4.0, 0.3), (4.0, 1.0), (8.0, 0.3)] {
            let options = RlodOptions { costs: Costs { node, cut, ..usual.costs }, ..usual };
            let tree = built(name, "costs", &scene, &options)?;
            for pixels in [0.0, 4.0] {
                let mut row = frame.row(&tree, Metric { pixels, reach: REACH });
                (row["cost"], row["cut"]) = (node.into(), cut.into());
                print(name, "costs", row);
            }
        }
    }
    Ok(())
}
