//! Total bounds make delta a promise (docs/error-bound.md): every point that is seen is near the point of the full-resolution surface that it stands for.
//!
//! `LODRAY_RAYS` asks for that many rays over all models (default 200,000), `LODRAY_SEED` for another seed, `LODRAY_MODEL` for the models with this in their names alone.

use lodray::format::Scene;
use lodray::golden::naive_bounds;
use lodray::mesh::lattice::{self, LatticePoint};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, FinestSurface, Hierarchy, edge_index};
use lodray::method::ClosestHit;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::{Ray, VertexForm};
use lodray::rays::{ModelSpace, Query};
use lodray::step::NoSteps;
use lodray_test_support::is_nightly;
use lodray_test_support::models::{Rng, any_rays, ball, scene_of, terrain, with_vertices};

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
    /// Hits beyond the promise where it says that it does not hold.
    left_out: u64,
    /// Largest distance in tolerances D from the point that a hit stands for, where D is a thousand units or more.
    worst: f64,
    /// Largest distance in tolerances from the nearest point of the surface.
    nearest: f64,
}

impl Seen {
    fn and(self, other: &Self) -> Self {
        Self {
            hits: self.hits + other.hits,
            coarse: self.coarse + other.coarse,
            left_out: self.left_out + other.left_out,
            worst: self.worst.max(other.worst),
            nearest: self.nearest.max(other.nearest),
        }
    }
}

/// A ray's hit.
struct Met {
    tree: usize,
    /// Corners of the full-resolution triangle that it stands for.
    corners: [LatticePoint; 3],
    /// Place, in units.
    point: [f64; 3],
    /// Distance from the full-resolution point that it stands for, and the tolerance there, in units.
    apart: f64,
    tolerance: f64,
}

/// A ray's cone in units, not rounded.
struct Tolerance<'a> {
    ray: &'a Ray,
    offset: f64,
    /// How much it grows in a unit.
    slope: f64,
}

impl<'a> Tolerance<'a> {
    fn of(ray: &'a Ray) -> Self {
        let scale = 2f64.powi(ray.cone.shift.get() as i32);
        Self { ray, offset: ray.cone.offset.get() as f64 / scale, slope: ray.cone.slope.get() as f64 / scale }
    }

    /// At a point; negative behind the apex.
    fn at(&self, p: [f64; 3]) -> f64 {
        let (origin, direction) = (self.ray.origin.get(), self.ray.direction.get());
        let along = (0..3).map(|k| (p[k] - origin[k] as f64) * direction[k] as f64).sum::<f64>() / 2f64.powi(30);
        self.offset + self.slope * along
    }

    /// Whether the promise leaves out what stands on this vertex: it, or an end of an edge of bound 0 that it was inserted on, lies behind the apex.
    fn leaves_out(&self, h: &Hierarchy, tree: usize, v: LatticePoint) -> bool {
        let at = h.tree(tree)[lattice::index(h.levels, v)].map(f64::from);
        if self.at(at) < 0.0 {
            return true;
        }
        let level = lattice::level_of(h.levels, v);
        if level == 0 {
            return false;
        }
        let step = 1 << (h.levels - level);
        let ends = match ((v.0 / step) % 2, (v.1 / step) % 2) {
            (1, 0) => [(v.0 - step, v.1), (v.0 + step, v.1)],
            (0, _) => [(v.0, v.1 - step), (v.0, v.1 + step)],
            _ => [(v.0 - step, v.1 + step), (v.0 + step, v.1 - step)],
        };
        let is_flat = h.codes(tree)[edge_index(h.levels, level - 1, ends[0], ends[1])] == 0;
        is_flat && ends.into_iter().any(|end| self.leaves_out(h, tree, end))
    }
}

fn meet(h: &Hierarchy, ray: &Ray, cone: &Tolerance<'_>, closest: &ClosestHit) -> Option<Met> {
    let hit = closest.record()?;
    let tree = hit.tree.get() as usize;
    let corners = lattice::node(h.levels, h.levels, hit.full_node.get() as u32);
    let triangle = corners.map(|at| h.tree(tree)[lattice::index(h.levels, at)].map(f64::from));
    let weights = [hit.full_b0, hit.full_b1, hit.full_b2].map(|b| b.get() as f64 / 2f64.powi(31));
    let (origin, direction) = (ray.origin.get(), ray.direction.get());
    let t = hit.t.get() as f64 / 2f64.powi(32);
    let point: [f64; 3] = std::array::from_fn(|k| origin[k] as f64 + t * direction[k] as f64);
    let full = |k: usize| (0..3).map(|i| weights[i] * triangle[i][k]).sum::<f64>();
    let apart = (0..3).map(|k| (point[k] - full(k)).powi(2)).sum::<f64>().sqrt();
    Some(Met { tree, corners, point, apart, tolerance: cone.at(point) })
}

/// The theorem's bound in units; none where it says nothing.
fn promised(levels: u32, tolerance: f64, slope: f64) -> Option<f64> {
    let growth = f64::from(levels) * slope;
    // What `meet` itself loses: steps of t, and of barycentrics.
    let lost = 16.0;
    (growth <= 0.2).then(|| (1.5 + 1.0 / 256.0 + 6.0 * growth) * tolerance + 3.0 * 2f64.powf(f64::from(levels)) + lost)
}

/// Rays with what each has hit, as many together as `lanes` says: alone, or as a packet.
fn traced(h: &Hierarchy, scene: &Scene, lanes: usize, rays: &[Ray]) -> Vec<ClosestHit> {
    let mut traverser = LodTraverser::new(LodImage::of(scene));
    let none = || ClosestHit::new(h.levels);
    if lanes > 1 {
        let packets = rays.chunks(lanes).map(|packet| traverser.trace_packet(packet, &mut NoSteps, packet.iter().map(|_| none())));
        return packets.flatten().collect();
    }
    let alone = |ray| {
        let mut closest = none();
        traverser.trace(ray, &mut NoSteps, &mut closest);
        closest
    };
    rays.iter().map(alone).collect()
}

fn check(name: &str, h: &Hierarchy, (scene, surface): (&Scene, &FinestSurface), lanes: usize, rays: &[Ray]) -> Seen {
    let mut seen = Seen::default();
    for (&ray, closest) in rays.iter().zip(traced(h, scene, lanes, rays)) {
        let cone = Tolerance::of(&ray);
        let Some(met) = meet(h, &ray, &cone, &closest) else { continue };
        let (apart, tolerance) = (met.apart, met.tolerance);
        let Some(most) = promised(h.levels, tolerance, cone.slope) else { continue };
        let is_worse = tolerance >= 1000.0 && apart > tolerance * seen.worst.min(seen.nearest);
        if (apart > most || is_worse) && met.corners.iter().any(|&corner| cone.leaves_out(h, met.tree, corner)) {
            seen.left_out += u64::from(apart > most);
            continue;
        }
        assert!(apart <= most, "{name}: {apart} units apart where {tolerance} are tolerated, {ray:?}");
        seen.hits += 1;
        seen.coarse += u64::from(apart > 0.1 * tolerance);
        // Of wide cones the share that a tolerance grows by is no longer small beside it.
        if is_worse && cone.slope < 0.01 {
            seen.worst = seen.worst.max(apart / tolerance);
            if apart > tolerance * seen.nearest {
                seen.nearest = seen.nearest.max(surface.distance(met.point, apart + 1.0) / tolerance);
            }
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

/// A model of this form.
type Make = Box<dyn Fn(VertexForm) -> Hierarchy>;

/// Every procedural scene with so many levels, and models that are rougher than surfaces are.
fn models(seed: u64) -> Vec<(String, Make)> {
    let mut all: Vec<(String, Make)> = vec![
        ("ball".to_owned(), Box::new(move |form| with_vertices(form, total(ball(7, 0.6, seed))))),
        ("rough ball".to_owned(), Box::new(move |form| with_vertices(form, total(ball(5, 1.5, seed + 1))))),
        ("rough terrain".to_owned(), Box::new(move |form| with_vertices(form, total(terrain(4, 7, 1.5, seed + 2))))),
        ("terrain of tests".to_owned(), Box::new(move |form| with_vertices(form, total(terrain(16, 5, 0.5, seed + 3))))),
    ];
    let rough = [(procedural::Scene::Terrain, Some(0.95)), (procedural::Scene::Spikes, Some(0.9))];
    for (scene, roughness) in procedural::Scene::ALL.map(|scene| (scene, None)).into_iter().chain(rough) {
        let levels = if scene == procedural::Scene::Wall { 4 } else { 5 + u32::from(is_nightly()) };
        let options = Options { levels: Some(levels), base: Some(128), roughness, seed, ..Options::new(scene) };
        let surface = move || procedural::generate(&options).expect("options");
        let name = format!("{}{}", scene.name(), roughness.map_or_else(String::new, |roughness| format!(" {roughness}")));
        all.push((name, Box::new(move |form| lodray::mesh::quantise(&surface(), BoundKind::Total, form, 0).expect("a surface"))));
    }
    all
}

#[test]
fn what_is_seen_is_within_one_and_a_half_tolerances() {
    let (rays, seed) = (number("LODRAY_RAYS", 200_000), number("LODRAY_SEED", 1));
    let models = models(seed);
    let each = rays / models.len() as u64;
    let mut all = Seen::default();
    let only = std::env::var("LODRAY_MODEL").unwrap_or_default();
    for (index, (name, make)) in (0..).zip(&models).filter(|(_, (name, _))| name.contains(&only)) {
        // One in three has vertices of each form, and with the next seed others have.
        let form = VertexForm::ALL[((index + seed + 1) % 3) as usize];
        let (name, scene) = (&format!("{name}, {} vertices", form.name()), scene_of(&make(form)));
        // Its trees have an order of their own.
        let h = scene.decode();
        let surface = FinestSurface::new(&h);
        let space = ModelSpace::of(&scene);
        let truth = (&scene, &surface);
        let others = check(name, &h, truth, 1, &any_rays(&h, each as usize / 4, seed));
        let seen = check(name, &h, truth, 1, &views(&space, each * 3 / 4, seed).collect::<Vec<_>>()).and(&others);
        let Seen { hits, worst, nearest, left_out, .. } = seen;
        println!("{name}: {hits} hits, worst {worst:.3} tolerances, {nearest:.3} from the nearest point; {left_out} left out");
        all = all.and(&seen);
    }
    println!("{} hits, {} of them a tenth of a tolerance apart or more", all.hits, all.coarse);
    println!("worst {:.3} tolerances, {:.3} from the nearest point; {} left out", all.worst, all.nearest, all.left_out);
    // The test would see it if the promise were broken: it comes near, and most hits are not on the full-resolution surface.
    let rays = if only.is_empty() { rays } else { each };
    assert!(all.hits > rays / 3 && all.coarse > all.hits / 10, "{} hits, {} of them coarse", all.hits, all.coarse);
    // Within twice of what was seen: no bound that says nothing.
    assert!(all.worst > 0.75 && all.nearest > 0.75, "worst {}, {} from the nearest point", all.worst, all.nearest);
    assert!(all.left_out <= all.hits / 1000, "{} left out", all.left_out);
}

/// A packet has the most detail that any of its rays asks for: each keeps its own promise, whatever rays go with it.
#[test]
fn rays_of_packets_see_within_their_own_tolerances() {
    let rays = number("LODRAY_RAYS", 200_000) / 4;
    let models = models(2);
    let each = rays / models.len() as u64;
    let mut all = Seen::default();
    for (index, (name, make)) in models.iter().enumerate() {
        let form = VertexForm::ALL[index % 3];
        let scene = scene_of(&make(form));
        let h = scene.decode();
        let (surface, space) = (FinestSurface::new(&h), ModelSpace::of(&scene));
        for lanes in [2, 32] {
            let seen = check(name, &h, (&scene, &surface), lanes, &any_rays(&h, each as usize / 8, 3));
            let views = check(name, &h, (&scene, &surface), lanes, &views(&space, each * 3 / 8, 3).collect::<Vec<_>>());
            all = all.and(&seen).and(&views);
        }
    }
    println!("{} hits, {} of them coarse, worst {:.3} tolerances", all.hits, all.coarse, all.worst);
    assert!(all.hits > rays / 3 && all.coarse > all.hits / 100, "{} hits, {} of them coarse", all.hits, all.coarse);
}

/// By how much s may be rounded down.
const C: f64 = 1.0 / 256.0;

/// The potential of the proof.
fn potential(y: f64) -> f64 {
    (1.5 + C - y).max((2.0 + C - y) / 2.0).max(0.0)
}

/// The most that is left of a displacement whose bound is x tolerances.
fn left(x: f64) -> f64 {
    if x >= 2.0 { 0.0 } else { (2.0 + C - x).min(1.0) }
}

#[test]
fn the_inequality_of_the_proof_holds() {
    let mut rng = Rng(number("LODRAY_SEED", 1));
    let (mut least, mut farthest) = (f64::INFINITY, 0f64);
    for k in 0..2_000_000 {
        // In units of the tolerance at the end where it is smaller; every other one near a kink.
        let r = 1.0 + if k % 3 == 0 { 0.0 } else { 2f64.powf(-8.0 + 12.0 * rng.unit()) };
        let kinks = [1.0, 1.0 + C, 1.5 + C, 2.0];
        let x = if k % 2 == 0 { 2.0 * rng.unit() } else { kinks[rng.below(4) as usize] + 1e-3 * rng.signed() };
        let y = x * [0.0, rng.unit(), 1.0][rng.below(3) as usize];
        let (mean, both) = ((1.0 + r) / 2.0, (potential(x) + r * potential(x / r)) / 2.0);
        least = least.min(mean * potential(y / mean) - left(x) * (x - y + both));
        // How far a vertex is from its midpoint where it is not wholly open.
        if x < 2.0 {
            farthest = farthest.max((x + both) / mean);
        }
    }
    assert!(least > -1e-9, "{least}");
    assert!(farthest <= 2.0 + C, "{farthest}");
}

#[test]
fn roundings_add_up_to_less_than_the_theorem_gives_them() {
    for levels in 1..=10 {
        for share in 1..=20 {
            let k = 0.01 * f64::from(share) / f64::from(levels);
            // In tolerances, and in units.
            let (mut lambda, mut mu) = (0.0, 0.0);
            for level in 0..levels {
                let rounding = 3f64.sqrt() * 2f64.powi(levels - level - 1);
                let (moved, falls) = (2.0 + C + lambda, 1.5 + C + lambda);
                mu = (mu + rounding) * (1.0 + falls * k / (1.0 - moved * k));
                lambda = (lambda + (1.5 + C) * moved * k) / (1.0 - moved * k);
            }
            let growth = f64::from(levels) * k;
            assert!(lambda <= 6.0 * growth && mu <= 3.0 * 2f64.powi(levels), "{levels} levels, growth {growth}: {lambda}, {mu}");
        }
    }
}
