//! Host time of a scene that was pruned for a job over that of the whole, which hold the same hits: every field of every hit is compared first, by the functional traverser
//! for all rays of the job, and for some of them by the cycle model of the unit that the pruned scene's plan has.
//!
//! `cargo bench --bench leaving_out -- WHOLE.lod PRUNED.lod PLAN.toml` for scenes of one's own and the plan that the one was pruned by; without arguments a room and a terrain from two views each.

use lodray::bvh::over_trees;
use lodray::format::{self, Job, JobView, Scene, SceneInfo};
use lodray::hardware::Hardware;
use lodray::mesh::procedural::{self, Options};
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, Hit};
use lodray::num::Ray;
use lodray::plan::{Measure, Plan, Reach};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::sim::unit::environment::run;
use lodray::sim::unit::{Latency, SceneMemory, Traffic, TraversalUnit};
use lodray::step::NoSteps;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// Rays that one scene and then the other traces.
const STRETCH: usize = 512;
/// Times that all are traced; either scene is first in half of them.
const ROUNDS: usize = 6;
/// Rays of which one goes through the cycle model.
const STEP: usize = 41;

fn main() {
    let files: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let open = |file: &String| Scene::open(Path::new(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    match &files[..] {
        [] => [procedural::Scene::Room, procedural::Scene::Terrain].into_iter().for_each(|kind| {
            let (whole, pruned) = generated(kind);
            compare(&whole, &pruned, &pruned.meta().job);
        }),
        [whole, pruned, file] => {
            let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
            let plan: Plan = toml::from_str(&text).unwrap_or_else(|error| panic!("{file}: {error}"));
            let (whole, pruned) = (open(whole), open(pruned));
            compare(&whole, &pruned, plan.views.get(&whole.meta().name).expect("views of the scene in the plan"));
        }
        _ => panic!("two scenes, one of them pruned, and the plan of that; or nothing"),
    }
}

fn generated(kind: procedural::Scene) -> (Scene, Scene) {
    let surface = procedural::generate(&Options { levels: Some(4), base: Some(64), ..Options::new(kind) }).expect("options");
    let scene = format::build(&surface, SceneInfo::default(), over_trees).expect("a scene");
    let (space, reach) = (ModelSpace::of(&scene), Reach::of(&scene));
    let cameras =
        [1.5, 3.0].map(|distance| Camera::new(&View { distance: Some(distance), ..View::default() }, &space, 256, 256).expect("a view"));
    cameras.iter().for_each(|camera| reach.add(camera, 1.0));
    let pruned =
        reach.pruned(Job { views: cameras.iter().map(|camera| camera.job_view(1.0)).collect(), ..Job::default() }).expect("memory");
    (scene, pruned)
}

fn traced(traverser: &mut LodTraverser<'_>, levels: u32, ray: &Ray) -> Option<Hit> {
    let mut closest = ClosestHit::new(levels);
    traverser.trace(ray, &mut NoSteps, &mut closest);
    closest.record()
}

fn compare(whole: &Scene, pruned: &Scene, views: &[JobView]) {
    let (space, levels, measure) = (ModelSpace::of(whole), whole.levels(), Measure::of(pruned));
    let mut plan = Plan::new(true);
    plan.add("it", &measure.needs());
    let mut rays = Vec::new();
    for view in views {
        let (camera, delta) = (Camera::of_job(view).expect("a view"), view.quality().expect("a quality"));
        plan.add_rays(&measure.rays(&camera, delta));
        let pixels = (0..camera.width * camera.height).map(|i| camera.ray(i % camera.width, i / camera.width));
        rays.extend(pixels.filter_map(|world| Some(space.enter(&world, delta)?.ray)));
    }
    assert!(!rays.is_empty(), "no views, or none from which the scene is seen");
    let mut both = [whole, pruned].map(|scene| LodTraverser::new(LodImage::of(scene)));
    let [full, less] = &mut both;
    let hits: Vec<Option<Hit>> = rays.iter().map(|ray| traced(full, levels, ray)).collect();
    for (ray, hit) in rays.iter().zip(&hits) {
        assert_eq!(traced(less, levels, ray), *hit, "{ray:?}");
    }
    let (some, expected): (Vec<Ray>, Vec<Option<Hit>>) = rays.iter().copied().zip(hits.iter().cloned()).step_by(STEP).unzip();
    let memory = SceneMemory::new(LodImage::of(pruned), 0);
    let hardware = plan.hardware(&Hardware::default());
    let mut unit = TraversalUnit::new(hardware, memory.config());
    let report = run(&mut unit, &memory, &Traffic::smooth(Latency::Fixed(20)), &some).expect("a run without errors");
    assert!(report.rays.iter().map(|ray| ray.hit.found.then_some(ray.hit.hit)).eq(expected), "the unit of the plan");

    // Of each stretch the least time that it took, so that what else runs on the machine counts for little.
    let mut best = [Duration::ZERO; 2];
    for stretch in rays.chunks(STRETCH) {
        let mut least = [Duration::MAX; 2];
        for round in 0..ROUNDS {
            for k in if round % 2 == 0 { [0, 1] } else { [1, 0] } {
                let start = Instant::now();
                for ray in stretch {
                    black_box(traced(&mut both[k], levels, ray));
                }
                least[k] = least[k].min(start.elapsed());
            }
        }
        best = std::array::from_fn(|k| best[k] + least[k]);
    }
    let found = hits.iter().flatten().count();
    let ratio = best[0].as_secs_f64() / best[1].as_secs_f64();
    println!(
        "{}: {} rays, {found} hits, the same in every field; {} of them through the unit of the plan",
        whole.meta().name,
        rays.len(),
        some.len()
    );
    println!("rays a second, pruned over whole: {ratio:.3}");
}
