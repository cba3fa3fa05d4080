//! Watertight, measured: no miss and no double hit on closed models, aimed at vertices and edges and within one unit of them.

use lodray::format::Scene;
use lodray::mesh::Hierarchy;
use lodray::mesh::procedural::{self, Options};
use lodray::report::crack::{Closedness, CrackReport, closedness, measure};
use lodray::traverse::{LodImage, ModelSpace};
use lodray_test_support::models::{ball, build, scene_of};

/// Rays over all models; `LODRAY_RAYS` asks for more.
fn total() -> u64 {
    match std::env::var("LODRAY_RAYS") {
        Ok(text) => text.parse().expect("LODRAY_RAYS is a number"),
        Err(_) => 10_000_000,
    }
}

fn shoot(h: &Hierarchy, scene: &Scene, rays: u64, seed: u64) -> CrackReport {
    assert_eq!(closedness(&h.triangles), Closedness::Oriented);
    measure(h, &LodImage::of(scene), &ModelSpace::of(scene), true, rays, seed, &|_| ())
}

#[test]
fn closed_models_have_neither_misses_nor_double_hits() {
    let mut models: Vec<(String, Hierarchy, Scene)> = Vec::new();
    for (levels, roughness) in [(0, 0.3), (1, 1.0), (3, 0.1), (3, 2.0), (5, 0.6)] {
        let h = ball(levels, roughness, u64::from(levels));
        let scene = scene_of(&h);
        models.push((format!("ball N = {levels}, roughness {roughness}"), h, scene));
    }
    for kind in [procedural::Scene::Sphere, procedural::Scene::Spikes] {
        let options = Options { levels: Some(4), base: Some(128), ..Options::new(kind) };
        let surface = procedural::generate(&options).expect("options");
        let scene = build(&surface);
        models.push((format!("{kind:?}"), scene.decode(), scene));
    }

    let each = total().div_ceil(models.len() as u64);
    let mut rays = 0;
    for (seed, (name, h, scene)) in models.iter().enumerate() {
        let report = shoot(h, scene, each, seed as u64);
        println!("{name}:");
        for row in &report.rows {
            println!("  {row:?}");
            assert!(row.crossing > row.rays / 10, "{name}: rays aimed at {:?} do not reach the surface", row.target);
        }
        assert!(h.levels < 2 || report.rows.iter().all(|r| r.mixed_levels > r.rays / 100), "{name}: edge states are all alike");
        assert_eq!(report.breaches(), 0, "{name}: first breach at ray {:?}", report.first_breach);
        rays += report.rays();
    }
    println!("{rays} rays, no breach");
    assert!(rays >= total());
}

#[test]
fn a_surface_with_a_hole_is_noticed() {
    let mut h = ball(2, 0.3, 1);
    h.triangles.pop();
    h.points.truncate(h.triangles.len() * lodray::mesh::lattice::len(2));
    lodray::golden::naive_bounds(&mut h);
    assert_eq!(closedness(&h.triangles), Closedness::Open);
    let scene = scene_of(&h);
    let report = measure(&h, &LodImage::of(&scene), &ModelSpace::of(&scene), true, 20_000, 3, &|_| ());
    assert!(report.breaches() > 100, "a measurement that cannot fail measures nothing");
    assert!(report.first_breach.is_some());
}
