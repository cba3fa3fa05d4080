//! How fast frames are simulated on the paper's machine, in rays and accesses per second: tracing alone, replay alone (on one thread and on all up to eight; also with eight rays in flight per core), and both together.
//!
//! `cargo bench --bench simulate -- SCENE.lod...`: 1024 x 1024 rays at two bounding radii; without a scene, a terrain of 131,072 triangles. Each figure is the best of three.

use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, Method, bvh, lod};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::{Compute, Frame, FrameRays, Job, simulate};
use lodray::sim::replay::{self, Chunk, Running};
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
        for method in [&lod::METHOD, &bvh::METHOD] {
            let made = (method.make)(scene, &Knobs::default(), &NoStore).expect("a method on a scene");
            measure(&format!("{name} {}", method.name), &*made, scene);
        }
    }
}

fn measure(name: &str, method: &dyn Method, scene: &Scene) {
    let space = ModelSpace::of(scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, SIDE, SIDE).expect("a camera");
    let sight = Sight::new(&camera, &space, 1.0);
    let frame = FrameRays { method, rays: &camera, sight: &sight };
    let machine = Machine::shipped("haydel2023").expect("a machine");
    let nodes = method.map(&sight).nodes();

    let mut chunks: Vec<Chunk> = Vec::new();
    let tracing = best(|| {
        chunks.clear();
        frame.produce(&mut |traced| {
            chunks.push(traced.batches.into());
            true
        });
    });
    let mut accesses = 0;
    let replaying = best(|| {
        let run = replay::run_free(&machine, nodes, chunks.iter().cloned(), Running::default()).expect("a run");
        accesses = run.counts.l1.requests;
    });
    let threads = rayon::current_num_threads().min(8);
    let beside = best(|| {
        let run = replay::run_free(&machine, nodes, chunks.iter().cloned(), Running { threads, ..Running::default() }).expect("a run");
        assert_eq!(run.counts.l1.requests, accesses);
    });
    let mut many = machine.clone();
    many.cores.rays_in_flight = 8;
    let mut many_accesses = 0;
    let crowded = best(|| {
        let run = replay::run_free(&many, nodes, chunks.iter().cloned(), Running::default()).expect("a run");
        many_accesses = run.counts.l1.requests;
    });
    assert_eq!(accesses, many_accesses);
    let mut units_requests = 0;
    let units = best(|| {
        let run = replay::run_units(&machine, chunks.iter().cloned(), Running::default()).expect("a run");
        units_requests = run.counts.l1.requests;
    });
    assert_eq!(accesses, units_requests);
    let job = Job { machine: machine.clone(), compute: Compute::Free, window: None };
    let together = best(|| simulate(&frame, std::slice::from_ref(&job), &mut |_| ()).pop().expect("a run").map(drop).expect("a run"));
    let rays = f64::from(SIDE * SIDE) / 1e3;
    println!(
        "{name:<30} tracing {:8.0} k rays/s   replay {:8.0} k rays/s {:6.1} M accesses/s   on {threads} threads {:6.1} M accesses/s   of 8 rays a core {:6.1} M accesses/s   with units {:8.0} k rays/s   together {:8.0} k rays/s   {:.1} accesses per ray",
        rays / tracing,
        rays / replaying,
        accesses as f64 / 1e6 / replaying,
        accesses as f64 / 1e6 / beside,
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
