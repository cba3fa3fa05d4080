//! R-LODs: without planes, hits are those of the full-resolution BVH and of the f64 reference; with them, a ray has at most what it asks for.

use crate::grid::{bvh, fan, pillow, six_models, some_ray, total};
use glam::DVec3;
use lodray::golden::Reference;
use lodray::mesh::Hierarchy;
use lodray::method::bvh::{BvhTraverser, FullBvh, FullOptions, LeafLayout, NodeBoxes};
use lodray::method::rlod::{KdOrder, Metric, Nearest, Planes, RlodOptions, RlodTraverser, Tree, Width, map};
use lodray::method::{ClosestHit, Departure, Hit};
use lodray::num::{Cone, Ray, RayT, VertexForm};
use lodray::rays::{Camera, ModelRay, ModelSpace, View};
use lodray::step::NoSteps;
use lodray_test_support::bounces::leaving;
use lodray_test_support::models::{Rng, any_rays, ball, terrain, with_vertices};
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;

/// An integer ray by itself: world units are units, and distances steps of t.
fn whole(ray: Ray) -> ModelRay {
    ModelRay { ray, start: 0.0, step: 1.0, range: [RayT::ZERO, RayT::MAX] }
}

/// No planes, whatever the tree has.
const FULL: Metric = Metric { pixels: 0.0, reach: 1.0 };

fn tree(h: &Hierarchy, every: u32, order: KdOrder) -> Arc<Tree> {
    let options = RlodOptions { planes: Planes { every, ..RlodOptions::default().planes }, order, ..RlodOptions::default() };
    Arc::new(Tree::over(h, &|_| DVec3::ONE, &options).expect("a valid model"))
}

fn traverser(tree: &Arc<Tree>) -> RlodTraverser {
    RlodTraverser::new(Arc::clone(tree), map(tree), FULL)
}

/// What a ray meets: t, face, the number of the finest triangle and the weights of its corners.
type Found = (u64, bool, u64, [u64; 3]);

fn met(own: &mut RlodTraverser, ray: Ray, from: Option<&Departure>) -> Option<Found> {
    let ray = whole(ray);
    let mut hit = Nearest::of(&ray, false);
    own.descend(&ray, from, Width::default(), &mut NoSteps, &mut hit);
    let hit: Hit = hit.triangle().record()?;
    Some((hit.t.get(), hit.front, hit.tree.get(), [hit.b0, hit.b1, hit.b2].map(|b| b.get())))
}

fn wanted(levels: u32, hit: &ClosestHit) -> Option<Found> {
    let hit = hit.record()?;
    Some((hit.t.get(), hit.front, hit.tree.get() << (2 * levels) | hit.node.get(), [hit.b0, hit.b1, hit.b2].map(|b| b.get())))
}

/// A ray, and one that leaves from where it hits, by both; how many hits there were.
fn compare(name: &str, h: &Hierarchy, ray: Ray, truth: &mut BvhTraverser, own: &mut RlodTraverser, rng: &mut Rng) -> [usize; 2] {
    let mut by_bvh = ClosestHit::new(h.levels);
    truth.trace(&ray, &mut NoSteps, &mut by_bvh);
    assert_eq!(met(own, ray, None), wanted(h.levels, &by_bvh), "{name}, {ray:?}");
    let (Some(hit), Some(corners)) = (by_bvh.record(), by_bvh.corners()) else { return [0; 2] };
    let from = BvhTraverser::departure(&hit, &corners);
    let at = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
    let next = Ray { origin: from.start.point, direction: leaving(rng, &corners, from.start.point, at), cone: Cone::default() };
    let mut by_bvh = ClosestHit::new(h.levels);
    truth.trace_from(&next, &from, &mut NoSteps, &mut by_bvh);
    assert_eq!(met(own, next, Some(&from)), wanted(h.levels, &by_bvh), "{name}, from {from:?}, {next:?}");
    [1, usize::from(by_bvh.record().is_some())]
}

#[test]
fn hits_without_planes_are_those_of_the_full_resolution() {
    let mut all = [0; 2];
    for seed in 0..3 {
        let levels = 2 + seed as u32;
        for (name, h) in [
            ("ball", ball(levels, 0.3, seed)),
            ("terrain", terrain(3, levels, 0.5, seed)),
            ("compact", with_vertices(VertexForm::Compact, terrain(2, levels, 0.4, seed))),
            ("fan", fan(levels)),
            ("pillow", pillow(levels)),
        ] {
            let mut truth = bvh(&h);
            for (every, order) in [(0, KdOrder::Area), (1, KdOrder::Depth), (3, KdOrder::Area)] {
                let tree = tree(&h, every, order);
                assert_eq!((tree.rlods.is_empty(), tree.node_bytes), (every == 0, if every == 0 { 8 } else { 12 }));
                let (mut own, mut rng) = (traverser(&tree), Rng(7));
                for ray in any_rays(&h, 400, seed) {
                    let hits = compare(name, &h, ray, &mut truth, &mut own, &mut rng);
                    all = [0, 1].map(|k| all[k] + hits[k]);
                }
            }
        }
    }
    assert!(all[0] > 6_000 && all[1] > all[0] / 20, "{all:?}");
}

#[test]
fn hits_on_six_models_are_those_of_bvh_and_of_the_reference() {
    const PIECE: usize = 5_000;
    let models = six_models();
    let mut sum = [0; 3];
    for (name, scene) in &models {
        let start = Instant::now();
        let (h, space) = (scene.decode(), ModelSpace::of(scene));
        let near = |distance| Camera::new(&View { distance: Some(distance), ..View::default() }, &space, 1024, 1024).expect("a view");
        let cameras = [0.4, 1.2, 2.5, 9.0].map(near);
        let full = FullBvh::build(&h, &FullOptions::new(16, NodeBoxes::Local, LeafLayout::Block)).expect("a valid model");
        let (tree, reference) = (tree(&h, 3, KdOrder::Area), Reference::new(&h));
        let piece = |piece: usize| {
            let mut rng = Rng(piece as u64 + 1);
            let (mut truth, mut own) = (BvhTraverser::new(&full), traverser(&tree));
            let mut compared = [0; 3];
            while compared[0] < PIECE {
                let ray = Ray { cone: Cone::default(), ..some_ray(&mut rng, &h, &space, &cameras) };
                let [primary, secondary] = compare(name, &h, ray, &mut truth, &mut own, &mut rng);
                compared = [compared[0] + 1 + primary, compared[1] + primary + secondary, compared[2]];
                if compared[0] % 16 == 0 {
                    let found = met(&mut own, ray, None);
                    let expected = reference.trace(ray.origin.get().map(|c| c as f64), ray.direction.get().map(|c| c as f64));
                    // Floats alone are not sure whether a ray through an edge or a vertex on an open border goes by.
                    let is_sure = expected.as_ref().is_none_or(|hit| hit.bary.iter().all(|b| *b > 1e-6))
                        && found.is_none_or(|hit| hit.3.iter().all(|b| *b > 1 << 11));
                    if is_sure {
                        assert_eq!(found.is_some(), expected.is_some(), "{name}, {ray:?}: {found:?} {expected:?}");
                    }
                    if let (true, Some(found), Some(expected)) = (is_sure, found, expected) {
                        let t = expected.t;
                        assert!((found.0 as f64 / 4.0 - t).abs() < 16.0 + 1e-9 * t, "{name}, {ray:?}: {found:?} {expected:?}");
                        compared[2] += 1;
                    }
                }
            }
            compared
        };
        let pieces = total().div_ceil(models.len() * PIECE);
        let add = |a: [usize; 3], b: [usize; 3]| std::array::from_fn(|k| a[k] + b[k]);
        let own = (0..pieces).into_par_iter().map(piece).reduce(Default::default, add);
        println!("{name}: {} rays, {} hits, {} of them by the reference too, {:.1?}", own[0], own[1], own[2], start.elapsed());
        assert!(own[1] > own[0] / 4 && own[2] > own[0] / 200, "{name}: {own:?}");
        sum = add(sum, own);
    }
    println!("{} models: {} rays, {} hits, {} by the reference", models.len(), sum[0], sum[1], sum[2]);
    assert!(sum[0] >= total());
}
