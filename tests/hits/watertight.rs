//! Watertight, measured: no miss and no double hit on closed models, aimed at vertices and edges and within one unit of them.

use lodray::format::Scene;
use lodray::lab::crack::{Closedness, CrackReport, closedness, measure};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{Hierarchy, RemeshOptions, TriangleMesh, remesh};
use lodray::method::lod::LodImage;
use lodray::num::{COORD_LIMIT, VertexForm};
use lodray::rays::ModelSpace;
use lodray_test_support::models::{ball, build, build_with, model, octahedron, scene_of, with_vertices};

/// Rays over all models; `LODRAY_RAYS` asks for more, `scripts/nightly` for a hundred million.
fn total() -> u64 {
    match std::env::var("LODRAY_RAYS") {
        Ok(text) => text.parse().expect("LODRAY_RAYS is a number"),
        Err(_) => 700_000,
    }
}

fn shoot(h: &Hierarchy, scene: &Scene, rays: u64, seed: u64) -> CrackReport {
    let closed = closedness(&h.triangles);
    assert_ne!(closed, Closedness::Open);
    measure(h, &LodImage::of(scene), &ModelSpace::of(scene), closed == Closedness::Oriented, rays, seed, &|_| ())
}

/// A bumpy octahedron up to the limit of the coordinates; with `turned`, some triangles face the wrong way, so that only parity is kept.
fn large(levels: u32, turned: bool) -> Hierarchy {
    let (base, mut triangles) = octahedron();
    if turned {
        triangles.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
    }
    model(levels, &base, triangles, |p, _| {
        let scale = f64::from(COORD_LIMIT) / f64::from(1u32 << levels);
        let ripple = 1.0 - 0.1 * (p.iter().map(|&v| v * v).sum::<i64>() % 7) as f64 / 7.0;
        p.map(|v| v as f64 * scale * ripple)
    })
}

/// A remeshed closed mesh: a box of twelve triangles.
fn remeshed_box() -> Scene {
    let corner = |i: usize| [f64::from(i as u32 & 1), f64::from(i as u32 >> 1 & 1) * 1.3, f64::from(i as u32 >> 2) * 0.7];
    let positions: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    let mesh = TriangleMesh::from_parts(&positions, &triangles, &[], Vec::new()).expect("a box");
    let (surface, _) = remesh(&mesh, &RemeshOptions { levels: Some(3), ..RemeshOptions::default() }, &|_, _, _| ()).expect("remeshed");
    build(&surface)
}

#[test]
fn closed_models_have_neither_misses_nor_double_hits() {
    let mut models: Vec<(String, Hierarchy, Scene)> = Vec::new();
    let mut add =
        |name: String, scene: Scene| models.push((format!("{name}, {} vertices", scene.meta().vertices.name()), scene.decode(), scene));
    for (levels, roughness) in [(0, 0.3), (1, 1.0), (3, 0.1), (3, 2.0), (5, 0.6)] {
        for form in VertexForm::ALL {
            let h = with_vertices(form, ball(levels, roughness, u64::from(levels)));
            add(format!("ball N = {levels}, roughness {roughness}"), scene_of(&h));
        }
    }
    for kind in [procedural::Scene::Sphere, procedural::Scene::Spikes, procedural::Scene::Pot] {
        let options = Options { levels: Some(4), base: Some(128), ..Options::new(kind) };
        let surface = procedural::generate(&options).expect("options");
        VertexForm::ALL.into_iter().for_each(|form| add(format!("{kind:?}"), build_with(&surface, form)));
    }
    for turned in [false, true] {
        let scenes = VertexForm::ALL.map(|form| scene_of(&with_vertices(form, large(4, turned))));
        scenes.into_iter().for_each(|scene| add(format!("to the limit, turned {turned}"), scene));
    }
    add("remeshed box".to_owned(), remeshed_box());

    let each = total().div_ceil(models.len() as u64);
    let mut rays = 0;
    for (seed, (name, h, scene)) in models.iter().enumerate() {
        let report = shoot(h, scene, each, seed as u64);
        println!("{name}:");
        for row in &report.rows {
            println!("  {row:?}");
            assert!(row.crossing > row.rays / 10, "{name}: rays aimed at {:?} do not reach the surface", row.target);
        }
        // A box is flat: its base mesh always serves.
        let flat = h.bounds.codes.iter().all(|&c| c == 0);
        assert!(h.levels < 2 || flat || report.rows.iter().all(|r| r.mixed_levels > r.rays / 100), "{name}: edge states are all alike");
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
