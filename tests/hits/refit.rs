//! Refitted scenes: hits are the golden traverser's in every field, and closed ones are neither missed nor hit twice, whatever jump they made.

use lodray::format::{RefitOptions, Scene};
use lodray::golden::exact::Exact;
use lodray::lab::crack::measure;
use lodray::mesh::Motion;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, Crossings};
use lodray::num::VertexForm;
use lodray::num::random::Random;
use lodray::rays::ModelSpace;
use lodray::step::NoSteps;
use lodray_test_support::models::{any_rays, ball, build_with, scene_of, with_vertices};
use lodray_test_support::plain::plain;
use lodray_test_support::surfaces::{grid, octahedron};

/// Rays over all models (`LODRAY_RAYS`).
fn total() -> u64 {
    std::env::var("LODRAY_RAYS").map_or(200_000, |text| text.parse().expect("LODRAY_RAYS is a number"))
}

/// Scenes moved: gently, turned, to a plane, by a million, and by noise of the size of finest edges and of the whole.
fn refitted(scene: &Scene) -> Vec<(String, Scene)> {
    let mut refit = scene.refitting().unwrap();
    let rest = refit.positions();
    let size = 2.0 * ModelSpace::of(scene).radius();
    let mut random = Random::new(3);
    let mut noise =
        |amount: f64| rest.iter().map(|p| p.map(|c| c + amount * size * (random.next() as f64 / 2f64.powi(63) - 1.0))).collect();
    let mut moved = vec![
        ("noise".to_owned(), noise(0.3)),
        ("fine noise".to_owned(), noise(0.001)),
        ("plane".to_owned(), rest.iter().map(|&[x, y, z]| [x + 0.3 * z, y, 0.0]).collect()),
        ("large".to_owned(), rest.iter().map(|&[x, y, z]| [1e6 * x, 1e6 * y, z]).collect::<Vec<[f64; 3]>>()),
    ];
    moved.extend(Motion::ALL.map(|motion| (motion.name().to_owned(), motion.at(&rest, 0.2))));
    moved.into_iter().map(|(name, to)| (name, refit.move_to(&to, RefitOptions::default()).unwrap().clone())).collect()
}

#[test]
fn hits_are_the_golden_traversers() {
    let scenes = VertexForm::ALL.map(|form| [build_with(&grid(3, 3), form), build_with(&octahedron(4), form)]);
    let (mut rays, mut hits) = (0, 0);
    for (name, scene) in scenes.iter().flatten().flat_map(refitted) {
        let h = scene.decode();
        let (golden, mut lod) = (Exact::new(&h), LodTraverser::new(LodImage::of(&scene)));
        for ray in any_rays(&h, 400, 5) {
            let mut closest = ClosestHit::new(h.levels);
            lod.trace(&ray, &mut NoSteps, &mut closest);
            let wanted = golden.trace(&ray);
            assert_eq!(closest.record().as_ref().map(plain), wanted, "{name}: {ray:?}");
            let mut counted = Crossings::default();
            lod.trace(&ray, &mut NoSteps, &mut counted);
            let crossings = golden.crossings(&ray);
            assert_eq!((counted.front, counted.back), (crossings.front, crossings.back), "{name}: {ray:?}");
            (rays, hits) = (rays + 1, hits + usize::from(wanted.is_some()));
        }
    }
    assert!(hits > rays / 4, "{hits} of {rays}");
}

#[test]
fn closed_models_have_neither_misses_nor_double_hits_after_jumps() {
    let scenes = VertexForm::ALL.map(|form| scene_of(&with_vertices(form, ball(4, 0.5, 1))));
    let models: Vec<_> = scenes.iter().flat_map(refitted).collect();
    let each = total().div_ceil(models.len() as u64);
    let mut rays = 0;
    for (seed, (name, scene)) in models.iter().enumerate() {
        let report = measure(&scene.decode(), &LodImage::of(scene), &ModelSpace::of(scene), true, each, seed as u64, &|_| ());
        assert_eq!(report.breaches(), 0, "{name}: first breach at ray {:?}", report.first_breach);
        rays += report.rays();
    }
    println!("{rays} rays, no breach");
    assert!(rays >= total());
}
