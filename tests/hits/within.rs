//! Scenes on coarser grids: what is seen moves by no more pixels than a plan was asked for, against the surface and the rays as they were.
//!
//! `LODRAY_RAYS` asks for that many rays over all models (default 400,000).

use lodray::bvh::over_trees;
use lodray::format::{Scene, SceneInfo, audit, build};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, FinestSurface};
use lodray::method::ClosestHit;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::VertexForm;
use lodray::plan::{Narrowest, Plan, Within};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::step::NoSteps;

fn scene(kind: procedural::Scene, vertices: VertexForm) -> Scene {
    let options = Options { levels: Some(4), base: Some(128), ..Options::new(kind) };
    let surface = procedural::generate(&options).expect("options");
    build(&surface, SceneInfo { bounds: BoundKind::Total, vertices, ..SceneInfo::default() }, over_trees).expect("a surface")
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Largest share of what may be moved that a ray of the camera sees moved: how far its hit lies from the full-resolution surface, and how far from the ray that was asked for.
fn worst(of: [&Scene; 2], camera: &Camera, side: u32, delta: f64, pixels: f64) -> (u64, f64) {
    let [fine, coarse] = of;
    let (surface, space) = (FinestSurface::new(&fine.decode()), ModelSpace::of(coarse));
    let mut traverser = LodTraverser::new(LodImage::of(coarse));
    let (mut hits, mut worst) = (0, 0.0f64);
    for i in 0..side * side {
        let query = camera.ray(i % side, i / side);
        let Some(entered) = space.enter(&query, delta) else { continue };
        let mut closest = ClosestHit::new(coarse.levels());
        traverser.trace(&entered.ray, &mut NoSteps, &mut closest);
        let Some(hit) = closest.record() else { continue };
        let (x, d, t) = (entered.ray.origin.get(), entered.ray.direction.get(), hit.t.get() as f64 / 2f64.powi(32));
        let point: [f64; 3] = std::array::from_fn(|k| x[k] as f64 + t * d[k] as f64);
        let from = space.to_units(query.origin);
        let scale = length(query.direction);
        let way: [f64; 3] = std::array::from_fn(|k| point[k] - from[k]);
        let along = (0..3).map(|k| way[k] * query.direction[k] / scale).sum::<f64>();
        let beside = length(std::array::from_fn(|k| way[k] - along * query.direction[k] / scale));
        let pixel = 2.0 * (query.radius / space.placement.scale + along * query.tan_theta);
        // The promise of delta, and the move; full detail promises the surface itself.
        let most = (1.6 / delta + pixels) * pixel;
        let apart = beside + surface.distance(point, most);
        worst = worst.max(apart / most);
        hits += 1;
    }
    (hits, worst)
}

#[test]
fn nothing_that_is_seen_moves_by_more_than_was_said() {
    let rays: u64 = std::env::var("LODRAY_RAYS").map_or(400_000, |text| text.parse().expect("a number"));
    let kinds = [procedural::Scene::Terrain, procedural::Scene::Cloth, procedural::Scene::Sphere, procedural::Scene::Wall];
    let cases = kinds.len() * 2 * 2 * 2;
    let side = ((rays as f64 / cases as f64).sqrt() as u32).max(8);
    let (mut all, mut farthest) = (0, 0.0f64);
    for (kind, form) in kinds.into_iter().flat_map(|kind| VertexForm::ALL.map(|form| (kind, form))) {
        let fine = scene(kind, form);
        let space = ModelSpace::of(&fine);
        for (distance, pixels) in [(1.6, 0.03), (4.0, 0.005)] {
            // Pixels as narrow as those of a picture that people look at.
            let camera =
                Camera::new(&View { distance: Some(distance), fov: 40.0 * f64::from(side) / 512.0, ..View::default() }, &space, side, side)
                    .expect("a view");
            let within = Within::of(&fine, &Narrowest::of(&space, &camera), pixels);
            let zeros = [within.coordinate_zeros, within.direction_zeros];
            let coarse = fine.coarsened(zeros, over_trees).expect("room");
            assert!(zeros[0] > 2 && zeros[0] < 12, "{kind:?}: {zeros:?}");
            for delta in [f64::INFINITY, 64.0] {
                let (hits, worst) = worst([&fine, &coarse], &camera, side, delta, pixels);
                println!("{kind:?}, {} vertices, {zeros:?}, delta {delta}: {hits} hits, {worst:.3} of what may move", form.name());
                assert!(worst <= 1.0, "{kind:?}: {worst}");
                (all, farthest) = (all + hits, farthest.max(worst));
            }
        }
    }
    assert!(all > rays / 10 && farthest > 0.05, "{all} hits, at most {farthest}");
}

#[test]
fn a_coarser_scene_is_the_same_but_for_its_grids() {
    for (kind, form) in [(procedural::Scene::Room, VertexForm::Compact), (procedural::Scene::Terrain, VertexForm::Exact)] {
        let fine = scene(kind, form);
        let coarse = fine.coarsened([6, 9], over_trees).expect("room");
        assert_eq!((coarse.meta().coordinate_zeros, coarse.meta().direction_zeros), (6, 9));
        assert!(coarse.meta().moved > fine.meta().moved);
        let report = audit::audit(&coarse);
        assert!(report.passed(), "{kind:?}: {report:?}");
        assert_eq!(coarse.colours(), fine.colours());
        let by_source = |scene: &Scene| {
            let mut trees: Vec<_> =
                (0..scene.trees()).map(|tree| ([scene.source(tree), scene.material(tree).into()], scene.triangles()[tree], tree)).collect();
            trees.sort_by_key(|&([source, _], ..)| source);
            trees
        };
        for ((a, ends, tree), (b, others, other)) in by_source(&fine).into_iter().zip(by_source(&coarse)) {
            assert_eq!((a, ends), (b, others));
            let normals = |scene: &Scene, tree: usize| scene.normals()[tree * fine.normals().len() / fine.trees()..][..15].to_vec();
            assert_eq!(normals(&fine, tree), normals(&coarse, other));
        }
        // A unit for the one does not serve the other.
        let needs = |scene: &Scene| lodray::plan::Measure::of(scene).needs();
        let mut plan = Plan::new(false);
        plan.add("coarse", &needs(&coarse));
        assert_eq!(plan.check("coarse", &needs(&coarse)), Ok(()));
        let told = plan.check("fine", &needs(&fine)).expect_err("finer").to_string();
        assert!(told.contains("coordinate-zeros is 0, and the plan has 6"), "{told}");
        let hardware = plan.hardware(&lodray::hardware::Hardware::default());
        assert_eq!((hardware.coordinate_zeros, hardware.direction_zeros), (6, 9));
        assert_eq!(hardware.validate(), Ok(()));
    }
    let Err(told) = scene(procedural::Scene::Sphere, VertexForm::Compact).coarsened([13, 0], over_trees) else {
        panic!("there is no room")
    };
    assert!(told.to_string().contains("at most 12 are possible"), "{told}");
}
