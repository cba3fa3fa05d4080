//! Ten thousand instances (`scenes/forest.toml`, seen from above) against one of their models with as many hits in its picture: hits per second, all cores, and memory.
//!
//! `LODRAY_SIDE` changes the pictures' width and height (default 1024).

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use lodray::format::Scene;
use lodray::method::Method;
use lodray::paths::{Instance, SceneFile, Starts, World};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::{HitRow, cast};
use lodray::scene::SceneMethod;
use std::hint::black_box;
use std::path::Path;

/// How many rows hit.
fn hits(rows: &[HitRow]) -> u64 {
    rows.iter().filter(|row| row.tree >= 0).count() as u64
}

/// Bytes of this process that are in memory, where the system says so.
fn resident() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}

fn benches(c: &mut Criterion) {
    let side = std::env::var("LODRAY_SIDE").ok().and_then(|v| v.parse().ok()).unwrap_or(1024);
    let file = SceneFile::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/forest.toml")).expect("the scene that is shipped");
    let models = file.model.iter().map(|model| Scene::generate(&model.generate.expect("it is generated").into()).expect("options"));
    let scenes: Vec<Scene> = models.collect();
    let bytes: u64 = scenes.iter().map(|scene| scene.bytes().len() as u64).sum();
    let seen = file.camera(Some("above")).expect("a camera");
    let view = View { eye: Some(seen.eye), target: Some(seen.target), up: Some(seen.up), fov: seen.fov, ..View::default() };

    let mut group = c.benchmark_group("10,000 instances, from above");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for name in ["lod", "bvh"] {
        let methods: Vec<SceneMethod> = scenes.iter().map(|scene| scene.method(name).expect("a method")).collect();
        let before = resident();
        let places = file.places().into_iter().map(|(k, pose)| Instance::for_any_ray(&scenes[k], methods[k].method(), pose, 1.0));
        let world = World::new(places.collect(), Starts::Exact);
        let more = resident().zip(before).map(|(now, before)| now.saturating_sub(before));
        let camera = Camera::new(&view, &ModelSpace::of(&scenes[0]), side, side).expect("a view");
        let met = world.cast(&camera, &|_| ());
        let (all, bodies) = (hits(&met), met.iter().filter(|row| row.instance > 0).count());
        println!("{name}: {} instances, {all} hits, {bodies} of them on bodies", world.instances().len());
        if let Some(more) = more {
            println!("  models {bytes} bytes, instances {more} more: {:.3} of the models'", (bytes + more) as f64 / bytes as f64);
        }
        group.throughput(Throughput::Elements(all));
        group.bench_function(format!("{name}, instances"), |b| b.iter(|| hits(black_box(&world.cast(&camera, &|_| ())))));

        // One body, at the distance at which about as many rays meet it.
        let (body, own): (&Scene, &dyn Method) = (&scenes[1], methods[1].method());
        let space = ModelSpace::of(body);
        let at = |distance: f64| Camera::new(&View { distance: Some(distance), ..View::default() }, &space, side, side).expect("a view");
        let count = |camera: &Camera| hits(&cast(own, body, camera, &Sight::new(camera, &space, 1.0), &|_| ()));
        let (mut near, mut far) = (1.05, 30.0);
        for _ in 0..12 {
            let middle = 0.5 * (near + far);
            if count(&at(middle)) > all { near = middle } else { far = middle }
        }
        let (camera, alone) = (at(near), count(&at(near)));
        println!("{name}: one body at {near:.2} radii, {alone} hits");
        group.throughput(Throughput::Elements(alone));
        group.bench_function(format!("{name}, one model"), |b| b.iter(|| black_box(count(&camera))));
    }
    group.finish();
}

criterion_group!(all, benches);
criterion_main!(all);
