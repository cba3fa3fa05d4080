//! Clusters: the hits on whatever is chosen are those that the reference finds on the same triangles.

use lodray::format::Scene;
use lodray::golden::Reference;
use lodray::mesh::procedural::{Options, Scene as Kinds};
use lodray::method::ClosestHit;
use lodray::method::bvh::{BvhTraverser, FullOptions, LeafLayout, NodeBoxes};
use lodray::method::cluster::{Cut, FrameBvh, Graph, Kind, Rule};
use lodray::num::{DIRECTION_SCALE, Point, Ray, Vec3};
use lodray::rays::Eye;
use lodray::step::NoSteps;
use lodray_test_support::is_nightly;
use lodray_test_support::models::Rng;

/// Rays from around the model to places in it.
fn rays(graph: &Graph, count: usize) -> Vec<Ray> {
    let mut rng = Rng(5);
    let side = 65_535 * i64::from(graph.grid.step);
    let mut between = |low: f64, high: f64| low + (high - low) * rng.below(1 << 30) as f64 / f64::from(1 << 30);
    (0..count)
        .map(|_| {
            let mut place = |beyond: f64| -> [f64; 3] {
                std::array::from_fn(|k| f64::from(graph.grid.lo[k]) + side as f64 * between(-beyond, 1.0 + beyond))
            };
            let (from, to) = (place(0.0), place(0.0));
            let origin = from.map(|c| c.clamp(-2_147_000_000.0, 2_147_000_000.0) as i64);
            let way: [f64; 3] = std::array::from_fn(|k| to[k] - origin[k] as f64);
            let length = way.iter().map(|c| c * c).sum::<f64>().sqrt().max(1.0);
            let [x, y, z] = way.map(|c| (c / length * f64::from(DIRECTION_SCALE)) as i64);
            let [ox, oy, oz] = origin;
            Ray { origin: Point::new(ox, oy, oz), direction: Vec3::new(x, y, z), ..Ray::default() }
        })
        .collect()
}

/// Hits of so many rays through six choices and the whole of each model and graph, against the reference; how many there were.
fn compare(count: usize) -> usize {
    let options = FullOptions::new(16, NodeBoxes::Six, LeafLayout::Block);
    let (mut met, finer) = (0, u32::from(is_nightly()));
    for (of, levels) in [(Kinds::Sphere, 3), (Kinds::Terrain, 2), (Kinds::Cloth, 2)] {
        let scene = Scene::generate(&Options { levels: Some(levels + finer), ..Options::new(of) }).unwrap();
        for kind in [Kind::Shipped, Kind::Paper] {
            let graph = Graph::build(&scene, kind, 16).unwrap();
            let middle = graph.grid.lo.map(|c| f64::from(c) + 32_768.0 * f64::from(graph.grid.step));
            let eye = Eye::at(middle, 1e-3);
            let whole = Rule { error: Some(0.0), size: Some(0.0), outside: 1.0 };
            let errors = [0.25, 1.0, 8.0].map(|error| Rule { error: Some(error), size: None, ..whole });
            let sizes = [8.0, 24.0, 200.0].map(|size| Rule { error: None, size: Some(size), ..whole });
            for rule in [[whole].as_slice(), &errors, &sizes].concat() {
                let cut = Cut::new(&graph, &rule, &[eye]);
                let frame = FrameBvh::new(&graph, cut, &options).unwrap();
                let reference = Reference::new(&graph.hierarchy(&frame.triangles));
                let mut traverser = BvhTraverser::new(&frame.bvh);
                for ray in rays(&graph, count) {
                    let mut hit = ClosestHit::new(0);
                    traverser.trace(&ray, &mut NoSteps, &mut hit);
                    let own = hit.record();
                    let expected = reference.trace(ray.origin.get().map(|c| c as f64), ray.direction.get().map(|c| c as f64));
                    assert_eq!(own.is_some(), expected.is_some(), "{of:?} {kind:?} {rule:?} {ray:?}");
                    let (Some(own), Some(expected)) = (own, expected) else { continue };
                    met += 1;
                    let corners = |local: u64| graph.triangles[frame.triangles[local as usize] as usize];
                    // At an edge or a vertex either triangle may be named, where both are met at once.
                    let (a, b) = (corners(own.tree.get()), corners(expected.tree.into()));
                    let is_tie = a.iter().any(|v| b.contains(v)) && (own.t.get() as f64 / 4.0 - expected.t).abs() < 16.0;
                    assert!(own.tree.get() == u64::from(expected.tree) || is_tie, "{of:?} {kind:?} {rule:?} {ray:?}: {own:?} {expected:?}");
                }
            }
        }
    }
    met
}

/// Rays in all; `LODRAY_RAYS` asks for a tenth of what closed models get, so `scripts/nightly` for ten million.
#[test]
fn hits_are_those_of_the_reference_on_the_same_triangles() {
    let count: usize = std::env::var("LODRAY_RAYS").map_or(16_800, |text| text.parse::<usize>().expect("LODRAY_RAYS is a number") / 10);
    let met = compare(count / 42);
    println!("{met} hits of {count} rays");
    assert!(met * 4 > count, "{met}");
}
