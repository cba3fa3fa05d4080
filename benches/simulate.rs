//! How fast frames are simulated on the paper's machine, in rays and accesses per second: tracing alone, replay alone (also with eight rays in flight per core), and both together.
//!
//! `cargo bench --bench simulate -- SCENE.lod...`: 1024 x 1024 rays at two bounding radii; without a scene, a terrain of 131,072 triangles. Each figure is the best of three.

use lodray::bvh::{FullBvh, FullOptions, LeafLayout};
use lodray::format::Scene;
use lodray::render::{Camera, FrameRays, Method, View};
use lodray::report::result::Compute;
use lodray::report::{Job, simulate};
use lodray::sim::machine::Machine;
use lodray::sim::replay::{self, Chunk};
use lodray::traverse::{LodImage, ModelSpace};
use lodray_test_support::models::{scene_of, terrain};
use std::path::PathBuf;
use std::time::Instant;

const SIDE: u32 = 1024;

fn main() {
    let mut scenes: Vec<(String, Scene)> = Vec::new();
    for path in std::env::args().skip(1).filter(|arg| !arg.starts_with('-')).map(PathBuf::from) {
        scenes.push((path.display().to_string(), Scene::open(&path).expect("a scene")));
    }
    if scenes.is_empty() {
        scenes.push(("terrain".to_owned(), scene_of(&terrain(16, 4, 0.5, 1))));
    }
    for (name, scene) in &scenes {
        let full = FullBvh::build(&scene.decode(), &FullOptions::new(4, false, LeafLayout::Line)).expect("a BVH");
        measure(&format!("{name} lod"), &Method::Lod(LodImage::of(scene)), scene);
        measure(&format!("{name} bvh"), &Method::Bvh(&full), scene);
    }
}

fn measure(name: &str, method: &Method<'_>, scene: &Scene) {
    let space = ModelSpace::of(scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, SIDE, SIDE).expect("a camera");
    let frame = FrameRays { method, space: &space, camera: &camera, delta: 1.0 };
    let machine = Machine::shipped("haydel2023").expect("a machine");
    let nodes = method.map().nodes();

    let mut chunks: Vec<Chunk> = Vec::new();
    let tracing = best(|| {
        chunks.clear();
        frame.produce(|batches| {
            chunks.push(batches.into());
            true
        });
    });
    let mut accesses = 0;
    let replaying = best(|| {
        let run = replay::run_free(&machine, nodes, chunks.iter().cloned(), None).expect("a run");
        accesses = run.counts.l1.requests;
    });
    let mut many = machine.clone();
    many.cores.rays_in_flight = 8;
    let mut many_accesses = 0;
    let crowded = best(|| {
        let run = replay::run_free(&many, nodes, chunks.iter().cloned(), None).expect("a run");
        many_accesses = run.counts.l1.requests;
    });
    assert_eq!(accesses, many_accesses);
    let mut units_requests = 0;
    let units = best(|| {
        let run = replay::run_units(&machine, chunks.iter().cloned(), None).expect("a run");
        units_requests = run.counts.l1.requests;
    });
    assert_eq!(accesses, units_requests);
    let job = Job { machine: machine.clone(), compute: Compute::Free, window: None };
    let together = best(|| simulate(&frame, std::slice::from_ref(&job), &|_| ()).pop().expect("a run").map(drop).expect("a run"));
    let rays = f64::from(SIDE * SIDE) / 1e3;
    println!(
        "{name:<30} tracing {:8.0} k rays/s   replay {:8.0} k rays/s {:6.1} M accesses/s   of 8 rays a core {:6.1} M accesses/s   with units {:8.0} k rays/s   together {:8.0} k rays/s   {:.1} accesses per ray",
        rays / tracing,
        rays / replaying,
        accesses as f64 / 1e6 / replaying,
        accesses as f64 / 1e6 / crowded,
        rays / units,
        rays / together,
        accesses as f64 / 1e3 / rays
    );
}

/// Seconds of the fastest of three runs.
fn best(mut run: impl FnMut()) -> f64 {
    let seconds = |_| {
        let begun = Instant::now();
        run();
        begun.elapsed().as_secs_f64()
    };
    (0..3).map(seconds).fold(f64::INFINITY, f64::min)
}
