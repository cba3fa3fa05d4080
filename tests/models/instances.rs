//! Models that stand in many places: stretched, mirrored, ten thousand times.

use glam::DVec3;
use lodray::format::Scene;
use lodray::mesh::procedural::{self, Options};
use lodray::method::bvh::{self, NoStore};
use lodray::method::{Knobs, Method, discrete, lod};
use lodray::paths::{Instance, Pose, Starts, World};
use lodray::rays::{Query, RaySource};
use lodray::run::HitRow;
use lodray::scene::BuildOptions;
use lodray_test_support::models::{Rng, build};

fn generated(scene: procedural::Scene, levels: u32, base: u32) -> Scene {
    let options = Options { levels: Some(levels), base: Some(base), ..Options::new(scene) };
    build(&procedural::generate(&options).expect("a surface"))
}

fn made(scene: &Scene, method: &'static lodray::method::Registered) -> Box<dyn Method> {
    (method.make)(scene, &Knobs::default(), &NoStore).expect("a method on a scene")
}

/// Rays as a source.
struct Rays(Vec<Query>);

impl RaySource for Rays {
    fn rays(&self) -> u64 {
        self.0.len() as u64
    }
    fn batches(&self) -> usize {
        self.0.len().div_ceil(64)
    }
    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query)) {
        self.0.iter().enumerate().skip(64 * batch).take(64).for_each(|(k, query)| each(k as u64, query));
    }
    fn least_radius(&self, _: &lodray::rays::ModelSpace) -> f64 {
        0.0
    }
    fn eyes(&self, _: &lodray::rays::ModelSpace) -> Vec<lodray::rays::Eye> {
        vec![lodray::rays::Eye::ANYWHERE]
    }
}

fn vector(rng: &mut Rng) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| rng.signed()))
}

/// From around a box of this size into it.
fn rays(rng: &mut Rng, count: usize, size: f64, tan_theta: f64) -> Rays {
    let ray = |_| {
        let (from, to) = (vector(rng).normalize_or(DVec3::X) * 3.0 * size, vector(rng) * size);
        Query::new(from.to_array(), (to - from).to_array()).with_cone(0.0, tan_theta)
    };
    Rays((0..count).map(ray).collect())
}

/// Turned, stretched by other factors along each axis, sheared a little; mirrored by the last.
fn affine(rng: &mut Rng, mirrored: bool) -> ([[f64; 4]; 3], Pose) {
    let stretch = [1.0, 2.0 + rng.unit(), if mirrored { -0.5 } else { 0.5 }];
    let rows = std::array::from_fn(|row| {
        std::array::from_fn(|column| match column {
            3 => rng.signed(),
            _ if row == column => stretch[row],
            _ => 0.3 * rng.signed(),
        })
    });
    (rows, Pose::affine(rows).expect("an inverse"))
}

/// A model that is stretched has the hits of a mesh that was.
#[test]
fn a_placed_mesh_is_hit_where_the_moved_mesh_is() {
    let mut rng = Rng(5);
    let sphere =
        procedural::generate(&Options { levels: Some(3), base: Some(128), ..Options::new(procedural::Scene::Sphere) }).expect("a sphere");
    let mesh = build(&sphere);
    let placement = mesh.meta().placement;
    // The full resolution's triangles, each with corners of its own.
    let per_tree = 1 << (2 * mesh.levels());
    let corners: Vec<DVec3> = (0..mesh.trees())
        .flat_map(|tree| (0..per_tree).flat_map(move |i| [(tree, i)]))
        .flat_map(|(tree, i)| mesh.full_resolution_triangle(tree, i))
        .map(|p| DVec3::from_array(placement.offset) + DVec3::from_array(p.map(f64::from)) * placement.scale)
        .collect();
    let faces: Vec<[u32; 3]> = (0..corners.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let scene_of = |points: Vec<[f64; 3]>| Scene::build(&points, &faces, &BuildOptions::own_triangles()).expect("a scene");
    let scene = scene_of(corners.iter().map(|p| p.to_array()).collect());
    for mirrored in [false, true] {
        let (_, pose) = affine(&mut rng, mirrored);
        let moved = scene_of(corners.iter().map(|&p| pose.out(p).to_array()).collect());
        let [placed, moved_method] = [&scene, &moved].map(|scene| made(scene, &lod::METHOD));
        let still = Pose::new([0.0; 3], 1.0, [0.0; 3]);
        let cast = |scene, method, pose, rays: &Rays| {
            World::new(vec![Instance::for_any_ray(scene, method, pose, f64::INFINITY)], Starts::Exact).cast(rays, &|_| ())
        };
        let rays = rays(&mut rng, 20_000, 2.5, 0.0);
        let [own, wanted] = [cast(&scene, &*placed, pose, &rays), cast(&moved, &*moved_method, still, &rays)];
        let (mut hits, mut apart, mut facing) = (0, 0, 0);
        for ((own, wanted), query) in own.iter().zip(&wanted).zip(&rays.0) {
            // Rounded in other places: rays along the outline may differ.
            let same = own.t.is_finite() == wanted.t.is_finite() && (own.t == wanted.t || (own.t - wanted.t).abs() < 1e-4);
            hits += u32::from(own.t.is_finite());
            apart += u32::from(!same);
            if same && own.t.is_finite() {
                // Normals are shaded: only nearly always do they see the ray where the triangle does.
                let n = DVec3::from_array(own.normal.map(f64::from));
                assert!((n.length() - 1.0).abs() < 1e-5, "{own:?}");
                facing += u32::from((n.dot(DVec3::from_array(query.direction)) < 0.0) == (own.front == 1));
                assert_eq!(own.front == 1, (wanted.front == 1) != mirrored);
                let at = DVec3::from_array(own.point);
                assert!((at - DVec3::from_array(wanted.point)).length() < 1e-4);
            }
        }
        println!("mirrored {mirrored}: {hits} hits, {apart} rays differ");
        assert!(hits > 2_000 && apart <= 2 && facing > hits * 98 / 100, "{hits} hits, {apart} differ, {facing} normals see their rays");
    }
}

/// However a model is stretched, what is seen is as near the full resolution, in the scene, as the cone there promises.
#[test]
fn what_is_tolerated_in_the_scene_is_not_exceeded_by_a_stretched_model() {
    let mut rng = Rng(8);
    let options = Options { levels: Some(6), base: Some(128), ..Options::new(procedural::Scene::Sphere) };
    let scene = Scene::generate(&options).expect("a sphere");
    let method = made(&scene, &lod::METHOD);
    let placement = scene.meta().placement;
    let (mut hits, mut coarse, mut worst) = (0, 0, 0.0f64);
    for turn in 0..8 {
        let (_, pose) = affine(&mut rng, turn % 2 == 0);
        let world = World::new(vec![Instance::for_any_ray(&scene, &*method, pose, 1.0)], Starts::Exact);
        let tan_theta = 2e-3;
        for row in world.cast(&rays(&mut rng, 5_000, 2.0, tan_theta), &|_| ()).iter().filter(|row| row.t.is_finite()) {
            let finest = row.triangle as usize;
            let (tree, i) = (finest >> (2 * scene.levels()), finest & ((1 << (2 * scene.levels())) - 1));
            let corners = scene.full_resolution_triangle(tree, i).map(|p| DVec3::from_array(p.map(f64::from)));
            let own: DVec3 = corners.iter().zip(row.finest_barycentrics).map(|(p, b)| *p * f64::from(b)).sum();
            let full = pose.out(DVec3::from_array(placement.offset) + own * placement.scale);
            let apart = (full - DVec3::from_array(row.point)).length();
            // A pixel is two radii wide.
            let tolerance = 2.0 * tan_theta * row.t;
            worst = worst.max(apart / tolerance);
            hits += 1;
            coarse += u32::from(apart > 0.05 * tolerance);
        }
    }
    println!("{hits} hits, {coarse} of them coarse, worst {worst:.3} tolerances");
    // The theorem's bound, with what the cone's growth and roundings add.
    assert!(worst > 0.5 && worst < 1.55 && hits > 10_000 && coarse > hits / 20, "{hits} hits, {coarse} coarse, worst {worst}");
}

/// Ten thousand places of three models: as each of them alone, with a tracer for each model.
#[test]
fn of_ten_thousand_instances_rays_meet_the_nearest() {
    let mut rng = Rng(2);
    let scenes = [
        generated(procedural::Scene::Sphere, 3, 128),
        generated(procedural::Scene::Spikes, 3, 128),
        generated(procedural::Scene::Terrain, 3, 128),
    ];
    for registered in [&lod::METHOD, &bvh::METHOD_SIX, &discrete::METHOD] {
        let methods: Vec<_> = scenes.iter().map(|scene| made(scene, registered)).collect();
        let count = 10_000;
        let poses: Vec<_> = (0..count)
            .map(|k| {
                let at = vector(&mut rng) * 30.0;
                if k % 3 == 0 {
                    affine(&mut rng, k % 2 == 0).1
                } else {
                    Pose::new([0.0, 360.0 * rng.unit(), 0.0], 0.2 + 0.3 * rng.unit(), at.to_array())
                }
            })
            .collect();
        let own = |k: usize| Instance::for_any_ray(&scenes[k % 3], &*methods[k % 3], poses[k], 1.0);
        let world = World::new((0..count).map(own).collect(), Starts::Exact);
        assert!(world.tracers().len() == 3, "{}: {} tracers", registered.name, world.tracers().len());
        let rays = rays(&mut rng, 60, 20.0, 1e-3);
        let found = world.cast(&rays, &|_| ());
        let mut wanted = vec![HitRow::NONE; rays.0.len()];
        for k in 0..count {
            let alone = World::new(vec![own(k)], Starts::Exact).cast(&rays, &|_| ());
            for (best, row) in wanted.iter_mut().zip(alone).filter(|(best, row)| row.t < best.t) {
                *best = HitRow { instance: k as i32, ..row };
            }
        }
        // No hit is equal to itself: it has no number for what was not met.
        assert!(found.iter().zip(&wanted).all(|(a, b)| format!("{a:?}") == format!("{b:?}")), "{}", registered.name);
        assert!(found.iter().filter(|row| row.t.is_finite()).count() > 20);
    }
}

/// Of rays from inside closed models none gets out, whatever is done to them; half of them aim at corners and edges. `LODRAY_RAYS` asks for so many in place of 200,000.
#[test]
fn no_ray_escapes_a_closed_instance() {
    let total = std::env::var("LODRAY_RAYS").map_or(200_000, |text| text.parse::<usize>().expect("LODRAY_RAYS is a number"));
    let (turns, each) = (total.div_ceil(5_000).max(40), 5_000);
    let mut rng = Rng(3);
    let scene = generated(procedural::Scene::Sphere, 4, 128);
    let method = made(&scene, &lod::METHOD);
    let placement = scene.meta().placement;
    let mut rays = 0;
    for turn in 0..turns {
        let (_, pose) = affine(&mut rng, turn % 2 == 0);
        let world = World::new(vec![Instance::for_any_ray(&scene, &*method, pose, 1.0)], Starts::Exact);
        let centre = pose.out(DVec3::ZERO);
        let inside = |k: usize| {
            let towards = if k.is_multiple_of(2) {
                vector(&mut rng)
            } else {
                // A corner of some full-resolution triangle, or the middle of one of its sides, where it stands.
                let (tree, i) = (rng.below(scene.trees() as u64) as usize, rng.below(1 << (2 * scene.levels())) as usize);
                let [a, b, _] = scene.full_resolution_triangle(tree, i).map(|p| DVec3::from_array(p.map(f64::from)));
                let at = if k % 4 == 1 { a } else { 0.5 * (a + b) };
                pose.out(DVec3::from_array(placement.offset) + at * placement.scale) - centre
            };
            Query::new(centre.to_array(), towards.to_array()).with_cone(0.0, if k % 8 < 4 { 1e-2 } else { 0.0 })
        };
        let cast = world.cast(&Rays((0..each).map(inside).collect()), &|_| ());
        assert!(cast.iter().all(|row| row.t.is_finite() && row.front == 0));
        rays += cast.len();
    }
    assert!(rays >= total, "{rays}");
}
