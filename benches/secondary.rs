//! Host time of a ray that leaves the surface over that of a primary ray: diffuse bounces and rays to a light from what a camera sees; beside them the same rays as if they started at a
//! whole point and no ray came before them.
//!
//! `cargo bench --bench secondary`, with scene files or without.

use lodray::bvh::over_trees;
use lodray::format::{self, Scene, SceneInfo};
use lodray::mesh::procedural::{self, Options};
use lodray::method::leave::side;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, Departure};
use lodray::num::{DIRECTION_SCALE, Direction, Random, Ray};
use lodray::rays::{Camera, ModelSpace, View, cone};
use lodray::step::NoSteps;
use std::cmp::Ordering;
use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

/// Rays that one kind and then the others trace.
const STRETCH: usize = 512;
/// Times that all are traced.
const ROUNDS: usize = 6;
/// Tangent of the half angle of a diffuse ray's cone.
const DIFFUSE: f64 = 0.05;

fn main() {
    let files: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    for file in &files {
        compare(file, &Scene::open(Path::new(file)).unwrap_or_else(|error| panic!("{file}: {error}")));
    }
    if files.is_empty() {
        for (name, kind, levels, base) in [("terrain", procedural::Scene::Terrain, 5, 512), ("cloth", procedural::Scene::Cloth, 4, 512)] {
            let surface = procedural::generate(&Options { levels: Some(levels), base: Some(base), ..Options::new(kind) }).expect("options");
            compare(name, &format::build(&surface, SceneInfo::default(), over_trees).expect("a scene"));
        }
    }
}

/// A ray that leaves the surface, and from where.
type Leaving = (Ray, Departure);

fn compare(name: &str, scene: &Scene) {
    let (space, levels) = (ModelSpace::of(scene), scene.levels());
    let mut lod = LodTraverser::new(LodImage::of(scene));
    let camera = Camera::new(&View { distance: Some(1.5), ..View::default() }, &space, 256, 256).expect("a view");
    let pixels = (0..camera.width * camera.height).map(|i| camera.ray(i % camera.width, i / camera.width));
    let all: Vec<Ray> = pixels.filter_map(|world| Some(space.enter(&world, 1.0)?.ray)).collect();
    let mut random = Random::of(1, 1);
    let (mut primary, mut leaving) = (Vec::new(), Vec::<Leaving>::new());
    for ray in all {
        let mut closest = ClosestHit::new(levels);
        lod.trace(&ray, &mut NoSteps, &mut closest);
        let (Some(hit), Some(corners)) = (closest.record(), closest.corners()) else { continue };
        let from = lod.departure(&ray, None, &hit, &corners);
        let d = {
            let v = [random.signed(), random.signed(), random.signed() + 1e-9];
            let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
            let [x, y, z] = v.map(|c| (c / length * f64::from(DIRECTION_SCALE)) as i64);
            Direction::new(x, y, z)
        };
        let towards = if side(&from.corners, ray.direction) == Ordering::Less { Ordering::Greater } else { Ordering::Less };
        let [x, y, z] = d.get();
        let direction = if side(&from.corners, d) == towards { d } else { Direction::new(-x, -y, -z) };
        // As wide as the primary ray's cone where it hit.
        let units = hit.t.get() as f64 / 2f64.powi(32) * f64::from(DIRECTION_SCALE);
        leaving.push((Ray { origin: from.start.point, direction, cone: cone(1.0, units * camera.tan_theta, DIFFUSE) }, from));
        primary.push(ray);
    }

    let mut found = [0u64; 3];
    let mut total = [Duration::ZERO; 3];
    for (rays, onward) in primary.chunks(STRETCH).zip(leaving.chunks(STRETCH)) {
        let mut least = [Duration::MAX; 3];
        for round in 0..ROUNDS {
            for k in [round % 3, (round + 1) % 3, (round + 2) % 3] {
                let start = Instant::now();
                let mut hits = 0;
                for (ray, (next, from)) in rays.iter().zip(onward) {
                    let mut closest = ClosestHit::new(levels);
                    match k {
                        0 => lod.trace(ray, &mut NoSteps, &mut closest),
                        1 => lod.trace_from(next, from, &mut NoSteps, &mut closest),
                        _ => lod.trace(next, &mut NoSteps, &mut closest),
                    }
                    hits += u64::from(black_box(closest.record()).is_some());
                }
                least[k] = least[k].min(start.elapsed());
                if round == 0 {
                    found[k] += hits;
                }
            }
        }
        total = std::array::from_fn(|k| total[k] + least[k]);
    }
    let rays = primary.len() as f64;
    let rate = total.map(|time| rays / time.as_secs_f64());
    println!(
        "{name}: {rays} rays of each kind; primary {:.0} k rays/s; leaving the surface {:.2} times as many, {:.2} from whole points without prior rays (hits: {found:?})",
        rate[0] / 1e3,
        rate[1] / rate[0],
        rate[2] / rate[0],
    );
}
