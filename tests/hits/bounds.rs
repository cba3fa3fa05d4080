//! The displacement bounds that scenes store equal those of the plain definition, code by code, and so do compact vertices, point by point; bounds cover what they
//! must, and are one on both sides of an edge.

use lodray::golden::{Exact, naive_bounds, naive_compact, true_bounds};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, Hierarchy, Surface, edge_index, lattice, quantise};
use lodray::num::{BoundScale, VertexForm, bound_encode, snap};
use lodray_test_support::cases;
use lodray_test_support::models::{Rng, any_cone, ball, direction, model, ray_through, terrain, with_vertices};
use lodray_test_support::surfaces::{bumps, fan, grid, octahedron, surface};
use proptest::prelude::*;

/// Edges with a bound, of both kinds and both forms together.
fn check(surface: &Surface, name: &str) -> usize {
    let all = BoundKind::ALL.iter().flat_map(|&kind| VertexForm::ALL.map(|form| (kind, form)));
    all.map(|(kind, form)| check_kind(surface, kind, form, &format!("{name}, {}, {}", kind.name(), form.name()))).sum()
}

fn check_kind(surface: &Surface, kind: BoundKind, form: VertexForm, name: &str) -> usize {
    let built = quantise(surface, kind, form, 0).expect("a valid surface");
    assert_eq!((built.bounds.kind, built.vertices), (kind, form));
    // From points on their grids, with nothing else done to them.
    let m = 1 << surface.levels;
    let places = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j)));
    let bits: Vec<u32> = places.map(|place| form.zero_bits(surface.levels, lattice::level_of(surface.levels, place), 0)).collect();
    let on_grid = |(p, &bits): (&[f64; 3], &u32)| -> [i32; 3] {
        std::array::from_fn(|k| snap((p[k] - built.placement.offset[k]) / built.placement.scale, bits))
    };
    let mut points: Vec<[i32; 3]> = surface.positions.iter().zip(bits.iter().cycle()).map(on_grid).collect();
    flatten(surface, &built, &bits, &mut points);
    let mut plain = Hierarchy { points, ..built.clone() };
    naive_bounds(&mut plain);
    if form.is_compact() {
        naive_compact(form, &mut plain);
    }
    assert_eq!(built.bounds.scale, plain.bounds.scale, "{name}");
    let differing = built.bounds.codes.iter().zip(&plain.bounds.codes).position(|(a, b)| a != b);
    assert_eq!(differing, None, "{name}: first differing edge");
    assert_eq!(built.bounds.codes.len(), plain.bounds.codes.len(), "{name}");
    let differing = built.points.iter().zip(&plain.points).position(|(a, b)| a != b);
    assert_eq!((differing, built.points.len()), (None, plain.points.len()), "{name}: first differing point");
    // The codes of compact vertices cover what is left of their displacements, and that needs no more of them.
    let mut left = built.clone();
    naive_bounds(&mut left);
    assert!(left.bounds.scale.offset <= built.bounds.scale.offset, "{name}");
    let decoded = |h: &Hierarchy| h.bounds.codes.iter().map(|&code| decode(h.bounds.scale, code)).collect::<Vec<_>>();
    assert!(decoded(&left).iter().zip(decoded(&built)).all(|(&left, own)| left <= own), "{name}");
    built.bounds.codes.iter().filter(|&&c| c > 0).count()
}

/// Points within a 16th of a unit of the middle of their edge become the middle of its ends as they were rounded, where that is on their grid (docs/numbers.md, "Flat parts").
fn flatten(surface: &Surface, built: &Hierarchy, bits: &[u32], points: &mut [[i32; 3]]) {
    let levels = surface.levels;
    let units = |p: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| (p[k] - built.placement.offset[k]) / built.placement.scale) };
    for tree in 0..surface.triangles.len() {
        let (first, exact) = (tree * lattice::len(levels), surface.tree(tree));
        for (level, node) in (0..levels).flat_map(|level| (0..1u32 << (2 * level)).map(move |node| (level, node))) {
            let p = lattice::node(levels, level, node);
            for edge in 0..3 {
                let ends = [p[(edge + 1) % 3], p[(edge + 2) % 3]].map(|place| lattice::index(levels, place));
                let own = lattice::index(levels, lattice::midpoints(p)[edge]);
                let [a, b, q] = [ends[0], ends[1], own].map(|at| units(exact[at]));
                let sum: [i64; 3] = std::array::from_fn(|k| ends.iter().map(|end| i64::from(points[first + end][k])).sum());
                let is_flat = (0..3).all(|k| (2.0 * q[k] - a[k] - b[k]).abs() <= 0.125);
                if is_flat && sum.iter().all(|s| s % (2 << bits[own]) == 0) {
                    points[first + own] = sum.map(|s| i32::try_from(s / 2).expect("a coordinate"));
                }
            }
        }
    }
}

/// What a code stands for, by docs/numbers.md: 2^(k / 16) for k = code + offset, with a mantissa of 9 bits rounded up and the whole rounded down.
fn decode(scale: BoundScale, code: u8) -> u64 {
    let k = u64::from(code) + scale.offset.get();
    let mantissa = (256.0 * ((k % 16) as f64 / 16.0).exp2()).ceil() as u64;
    if code == 0 { 0 } else { (mantissa << (k / 16)) / 256 }
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
                    assert!(decode(h.bounds.scale, h.bounds.codes[own]) >= bounds.edges[own]);
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
            for form in VertexForm::ALL {
                check_bounds(&with_vertices(form, with(kind, &ball(seed as u32 % 5, 0.4, seed))));
                check_bounds(&with_vertices(form, with(kind, &terrain(2, seed as u32 % 5, 0.4, seed))));
            }
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
            for (at, (&least, &sum)) in truths.iter().zip(&totals).enumerate() {
                prop_assert!(least <= sum && sum <= u64::from(levels) * least, "edge {at}: {least} and {sum}");
                // At equal scale the codes are in the same order.
                prop_assert!(bound_encode(total.bounds.scale, least) <= total.bounds.codes[at]);
            }
            // Displacements of several levels lie one upon the other, so it is not the same in other words.
            prop_assert!(levels < 2 || roughness < 0.1 || truths != totals);
            check_bounds(&total);
        }
    }
}
