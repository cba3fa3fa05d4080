//! Total bounds make delta a promise (docs/exactness.md, T3): every point that is seen is near the point of the full-resolution surface that it stands for.
//!
//! `LODRAY_RAYS` asks for that many rays (default 400,000), `LODRAY_SEED` for another seed.

use lodray::format::Scene;
use lodray::golden::naive_bounds;
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, Hierarchy, lattice};
use lodray::method::ClosestHit;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::Ray;
use lodray::rays::{ModelSpace, Query};
use lodray::step::NoSteps;
use lodray_test_support::models::{Rng, any_rays, ball, scene_of, terrain};

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |text| text.parse().expect("a number"))
}

/// The same model with total bounds.
fn total(mut h: Hierarchy) -> Hierarchy {
    h.bounds.kind = BoundKind::Total;
    naive_bounds(&mut h);
    h
}

/// What the rays that hit have seen.
#[derive(Default)]
struct Seen {
    hits: u64,
    coarse: u64,
    /// Largest distance in tolerances D, where D is a thousand units or more.
    worst: f64,
}

/// Distance of a ray's hit from the full-resolution point that it stands for, and the tolerance there, in units; and how much D grows in a unit.
fn distance(h: &Hierarchy, ray: &Ray, traverser: &mut LodTraverser<'_>) -> Option<[f64; 3]> {
    let mut closest = ClosestHit::new(h.levels);
    traverser.trace(ray, &mut NoSteps, &mut closest);
    let hit = closest.record()?;
    let tree = h.tree(hit.tree.get() as usize);
    let corners = lattice::node(h.levels, h.levels, hit.full_node.get() as u32);
    let triangle = corners.map(|at| tree[lattice::index(h.levels, at)].map(f64::from));
    let weights = [hit.full_b0, hit.full_b1, hit.full_b2].map(|b| b.get() as f64 / 2f64.powi(31));
    let (origin, direction) = (ray.origin.get(), ray.direction.get());
    let t = hit.t.get() as f64 / 2f64.powi(32);
    let apart = |k: usize| {
        let full: f64 = (0..3).map(|i| weights[i] * triangle[i][k]).sum();
        origin[k] as f64 + t * direction[k] as f64 - full
    };
    // Where the finest triangle itself reaches behind the camera, its corners' tolerances say nothing of the point's.
    let scale = 2f64.powi(ray.cone.shift.get() as i32);
    let (offset, slope) = (ray.cone.offset.get() as f64 / scale, ray.cone.slope.get() as f64 / scale);
    let along = |p: [f64; 3]| (0..3).map(|k| (p[k] - origin[k] as f64) * direction[k] as f64).sum::<f64>() / 2f64.powi(30);
    if triangle.iter().any(|&p| offset + slope * along(p) < 0.0) {
        return None;
    }
    let apart = (0..3).map(|k| apart(k).powi(2)).sum::<f64>().sqrt();
    let length = t * direction.iter().map(|&d| (d as f64).powi(2)).sum::<f64>() / 2f64.powi(30);
    Some([apart, offset + slope * length, slope])
}

fn promised(levels: u32, tolerance: f64, slope: f64) -> f64 {
    let levels = f64::from(levels);
    // Roundings: inserted vertices to their grids, s, l, and what `distance` itself loses.
    (1.5 + 1.0 / 256.0 + 6.0 * levels * slope) * tolerance + 3f64.sqrt() * 2f64.powf(levels) + 64.0
}

fn check(name: &str, h: &Hierarchy, scene: &Scene, rays: impl Iterator<Item = Ray>) -> Seen {
    let mut traverser = LodTraverser::new(LodImage::of(scene));
    let mut seen = Seen::default();
    for ray in rays {
        let Some([apart, tolerance, slope]) = distance(h, &ray, &mut traverser) else { continue };
        assert!(apart <= promised(h.levels, tolerance, slope), "{name}: {apart} units apart where {tolerance} are tolerated, {ray:?}");
        seen.hits += 1;
        seen.coarse += u64::from(apart > 0.1 * tolerance);
        if tolerance >= 1000.0 && slope < 0.01 {
            seen.worst = seen.worst.max(apart / tolerance);
        }
    }
    seen
}

/// Rays of a camera's kind: from outside, cones of a pixel or of some.
fn views<'a>(space: &'a ModelSpace, count: u64, seed: u64) -> impl Iterator<Item = Ray> + 'a {
    let mut rng = Rng(seed);
    let (centre, radius) = (space.centre(), space.radius());
    let ray = move |_| {
        let away = radius * 2f64.powf(-1.3 + 5.3 * rng.unit());
        let towards: [f64; 3] = [rng.signed(), rng.signed(), rng.signed()];
        let length = towards.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-3);
        let from: [f64; 3] = std::array::from_fn(|k| centre[k] + away * towards[k] / length);
        let at: [f64; 3] = std::array::from_fn(|k| centre[k] + 0.6 * radius * rng.signed());
        let delta = 2f64.powf(-4.0 + 8.0 * rng.unit());
        space.enter(&Query::new(from, std::array::from_fn(|k| at[k] - from[k])).with_cone(0.0, 7e-4), delta)
    };
    (0..count).filter_map(ray).map(|ray| ray.ray)
}

#[test]
fn what_is_seen_is_within_one_and_a_half_tolerances() {
    let (rays, seed) = (number("LODRAY_RAYS", 400_000), number("LODRAY_SEED", 1));
    let procedural = |scene, roughness| {
        let options = Options { levels: Some(6), base: Some(128), roughness, ..Options::new(scene) };
        let h = lodray::mesh::quantise(&procedural::generate(&options).expect("options"), BoundKind::Total).expect("a surface");
        (format!("{}", scene.name()), h)
    };
    let mut models = vec![
        ("ball".to_owned(), total(ball(7, 0.6, seed))),
        ("rough ball".to_owned(), total(ball(5, 1.5, seed + 1))),
        ("rough terrain".to_owned(), total(terrain(4, 7, 1.5, seed + 2))),
        ("terrain of tests".to_owned(), total(terrain(16, 5, 0.5, seed + 3))),
    ];
    models.extend([
        procedural(procedural::Scene::Terrain, Some(0.6)),
        procedural(procedural::Scene::Terrain, Some(0.95)),
        procedural(procedural::Scene::Cloth, None),
        procedural(procedural::Scene::Spikes, None),
        procedural(procedural::Scene::Room, None),
    ]);
    let each = rays / models.len() as u64;
    let mut all = Seen::default();
    for (name, h) in &models {
        let scene = scene_of(h);
        let space = ModelSpace::of(&scene);
        let cameras = check(name, h, &scene, views(&space, each * 3 / 4, seed));
        let others = check(name, h, &scene, any_rays(h, each as usize / 4, seed).into_iter());
        println!("{name}: {} and {} hits, worst {:.3} and {:.3} tolerances", cameras.hits, others.hits, cameras.worst, others.worst);
        for seen in [cameras, others] {
            all = Seen { hits: all.hits + seen.hits, coarse: all.coarse + seen.coarse, worst: all.worst.max(seen.worst) };
        }
    }
    println!("{} hits, {} of them a tenth of a tolerance apart or more, worst {:.3} tolerances", all.hits, all.coarse, all.worst);
    // The test would see it if the promise were broken: it comes near, and most hits are not on the full-resolution surface.
    assert!(all.hits > rays / 3 && all.coarse > all.hits / 10 && all.worst > 0.75, "{} hits", all.hits);
}
