//! The displacement bounds that scenes store equal those of the plain definition, code by code; they cover what they must, and are one on both sides of an edge.

use lodray::golden::{Exact, naive_bounds, true_bounds};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, Hierarchy, Surface, edge_index, lattice, quantise};
use lodray::num::BoundEncoder;
use lodray_test_support::cases;
use lodray_test_support::models::{Rng, any_cone, ball, direction, model, ray_through, terrain};
use lodray_test_support::surfaces::{bumps, fan, grid, octahedron, surface};
use proptest::prelude::*;

/// Edges with a bound, both kinds together.
fn check(surface: &Surface, name: &str) -> usize {
    BoundKind::ALL.map(|kind| check_kind(surface, kind, &format!("{name}, {}", kind.name()))).iter().sum()
}

fn check_kind(surface: &Surface, kind: BoundKind, name: &str) -> usize {
    let built = quantise(surface, kind).expect("a valid surface");
    assert_eq!(built.bounds.kind, kind);
    let mut plain = built.clone();
    naive_bounds(&mut plain);
    assert_eq!(built.bounds.scale, plain.bounds.scale, "{name}");
    let differing = built.bounds.codes.iter().zip(&plain.bounds.codes).position(|(a, b)| a != b);
    assert_eq!(differing, None, "{name}: first differing edge");
    assert_eq!(built.bounds.codes.len(), plain.bounds.codes.len(), "{name}");
    built.bounds.codes.iter().filter(|&&c| c > 0).count()
}

#[test]
fn stored_bounds_are_those_of_the_definition() {
    let mut edges = 0;
    for levels in 0..=5 {
        edges += check(&grid(levels, 3), "grid") + check(&octahedron(levels), "octahedron") + check(&fan(levels), "fan");
        // Two trees back to back on the same three vertices, and a third one turned.
        let v = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [0.3, 1.0, -0.2]];
        edges += check(&surface(levels, &v, &[[0, 1, 2], [2, 1, 0], [1, 2, 0]], bumps), "back to back");
    }
    for scene in [procedural::Scene::Terrain, procedural::Scene::Cloth, procedural::Scene::Spikes, procedural::Scene::Room] {
        let options = Options { levels: Some(4), base: Some(40), ..Options::new(scene) };
        edges += check(&procedural::generate(&options).expect("options"), "procedural");
    }
    println!("{edges} edges with a bound");
    assert!(edges > 50_000);
}

#[test]
fn bounds_of_a_shared_edge_are_one_in_all_trees() {
    // Three triangles on the base edge (0, 1), one of them running along it the other way, and a back to back pair.
    let base = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [0, -4, -1]];
    let triangles = vec![[0, 1, 2], [1, 0, 3], [4, 0, 1], [0, 2, 1]];
    let mut rng = Rng(8);
    for levels in 1..=4 {
        let h = model(levels, &base, triangles.clone(), |p, level| {
            let mut own = Rng(p.iter().fold(99, |k, &v| k.wrapping_mul(1000).wrapping_add(v.cast_unsigned())));
            p.map(|v| ((v << 25) >> levels) as f64 + own.signed() * f64::from(1 << 24) / f64::from(1 << level))
        });
        let m = 1 << levels;
        for level in 0..levels {
            let step = m >> level;
            let code = |tree, corners: [(u32, u32); 2]| {
                let codes = h.codes(tree);
                codes[edge_index(levels, level, corners[0], corners[1])]
            };
            for k in (0..m).step_by(step as usize) {
                let n = k + step;
                let one = code(0, [(k, 0), (n, 0)]);
                assert_eq!(one, code(1, [(m - k, 0), (m - n, 0)]));
                assert_eq!(one, code(2, [(m - k, k), (m - n, n)]));
                assert_eq!(one, code(3, [(0, k), (0, n)]));
            }
        }
        check_bounds(&h);
        // Every tree sees the whole shared edge, whatever the cone.
        let r = ray_through([0; 3], direction(&mut rng), any_cone(&mut rng));
        assert!(!Exact::new(&h).surface(&r).is_empty());
    }
}

/// A bound covers its own displacement and, by its code, the bounds of all edges below it.
fn check_bounds(h: &Hierarchy) {
    let bounds = true_bounds(h);
    for tree in 0..h.triangles.len() {
        let per_tree = h.codes(tree).len();
        let at = |level, a, b| tree * per_tree + edge_index(h.levels, level, a, b);
        for level in 0..h.levels {
            for node in 0..1 << (2 * level) {
                let p = lattice::node(h.levels, level, node);
                let q = lattice::midpoints(p);
                for i in 0..3 {
                    let (a, b) = (p[(i + 1) % 3], p[(i + 2) % 3]);
                    let own = at(level, a, b);
                    let scale = h.bounds.scale;
                    let c = u128::from(h.bounds.codes[own]);
                    assert!((c * c * u128::from(scale.mantissa.get())) >> scale.shift.get() >= u128::from(bounds.edges[own]));
                    if level + 1 < h.levels {
                        for below in [at(level + 1, a, q[i]), at(level + 1, q[i], b), at(level + 1, q[i], q[(i + 1) % 3])] {
                            assert!(bounds.edges[below] <= bounds.edges[own] && h.bounds.codes[below] <= h.bounds.codes[own]);
                        }
                    }
                }
            }
        }
    }
}

/// The same model with bounds of this kind.
fn with(kind: BoundKind, h: &Hierarchy) -> Hierarchy {
    let mut other = h.clone();
    other.bounds.kind = kind;
    naive_bounds(&mut other);
    other
}

#[test]
fn bounds_hold_on_closed_surfaces() {
    for seed in 0..10 {
        for kind in BoundKind::ALL {
            check_bounds(&with(kind, &ball(seed as u32 % 5, 0.4, seed)));
            check_bounds(&with(kind, &terrain(2, seed as u32 % 5, 0.4, seed)));
        }
    }
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn total_bounds_are_between_the_largest_and_as_many_of_them_as_there_are_levels(levels in 0u32..5, roughness in 0.0..3.0f64, seed: u64) {
        for h in [ball(levels, roughness, seed), terrain(2, levels, roughness, seed)] {
            let [largest, total] = BoundKind::ALL.map(|kind| with(kind, &h));
            let [truths, totals] = [&largest, &total].map(|h| true_bounds(h).edges);
            let encoder = BoundEncoder::new(total.bounds.scale);
            for (at, (&least, &sum)) in truths.iter().zip(&totals).enumerate() {
                prop_assert!(least <= sum && sum <= u64::from(levels) * least, "edge {at}: {least} and {sum}");
                // At equal scale the codes are in the same order.
                prop_assert!(encoder.encode(least) <= total.bounds.codes[at]);
            }
            // Displacements of several levels lie one upon the other, so it is not the same in other words.
            prop_assert!(levels < 2 || roughness < 0.1 || truths != totals);
            check_bounds(&total);
        }
    }
}
