//! The audit: sound scenes pass with nothing left out, and each kind of damage under right checksums is found by the check that is meant for it.

use lodray::bvh::over_trees;
use lodray::format::audit::{AuditReport, audit};
use lodray::format::{BoundData, BvhChild, Scene, SceneError, VertexData, encode, export_level, layout, tree_boxes};
use lodray::mesh::{BoundKind, Surface, edge_index, lattice, quantise};
use lodray::num::{U, Vec3, Wire, bound_decode};
use lodray_test_support::cases;
use lodray_test_support::surfaces::{fan, grid, info, octahedron, scene, scene_with, surface};
use proptest::prelude::*;

#[test]
fn sound_scenes_pass_and_nothing_is_left_out() {
    for levels in [0, 1, 2, 5] {
        let one = surface(levels, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]], lodray_test_support::surfaces::bumps);
        // Two trees with the same three vertices share all edges.
        let twice =
            surface(levels, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2], [2, 1, 0]], lodray_test_support::surfaces::bumps);
        let flat = surface(levels, &[[5.0; 3]; 3], &[[0, 1, 2]], |p| p);
        for s in [one, twice, flat, grid(levels, 3), octahedron(levels), fan(levels)] {
            let report = audit(&scene(&s));
            assert!(report.passed(), "{report}");
            let bounds = report.check("bounds cover the true displacement").unwrap();
            assert_eq!(bounds.checked == 0, levels == 0);
        }
    }
}

#[test]
fn ten_levels_and_unused_base_vertices_work() {
    let mut s = surface(10, &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]], lodray_test_support::surfaces::bumps);
    s.base_vertices = u32::MAX;
    let scene = scene(&s);
    let report = audit(&scene);
    assert!(report.passed(), "{report}");
    assert!(!report.to_string().contains("FAILED"));
    assert_eq!(scene.finest_triangles(), 1 << 20);
}

#[test]
fn bytes_per_triangle_keep_to_the_promise() {
    assert!(scene(&grid(7, 1)).bytes_per_triangle() <= 16.1);
}

/// Applies `f` to the bytes of section `kind`, reseals, opens, audits.
fn damaged(good: &Scene, kind: usize, f: impl Fn(&mut [u8])) -> AuditReport {
    audit(&reopened(good, kind, f).expect("the frame is sound"))
}

/// Applies `f` to the bytes of section `kind`, reseals, opens.
fn reopened(good: &Scene, kind: usize, f: impl Fn(&mut [u8])) -> Result<Scene, SceneError> {
    let mut bytes = good.bytes().to_vec();
    let (offset, length) = lodray_test_support::surfaces::section(&bytes, kind);
    f(&mut bytes[offset..offset + length]);
    lodray_test_support::surfaces::reseal(&mut bytes);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("damaged.lod");
    std::fs::write(&path, bytes).unwrap();
    Scene::open(&path)
}

/// The damage is found by this check.
fn found_by(report: &AuditReport, name: &str) {
    assert!(!report.passed());
    let check = report.check(name).unwrap_or_else(|| panic!("no check {name}"));
    assert!(check.breaches > 0 && check.first.is_some(), "{report}");
}

/// Changes the record of `T::WIDTH` bits at byte `at`.
fn change<T: Wire>(bytes: &mut [u8], at: usize, f: impl Fn(&mut T)) {
    let size = T::WIDTH as usize / 8;
    let mut words: Vec<u64> = bytes[at..at + size].as_chunks::<8>().0.iter().map(|b| u64::from_le_bytes(*b)).collect();
    let mut record = T::from_words(&words);
    f(&mut record);
    record.to_words(&mut words);
    for (out, word) in bytes[at..at + size].chunks_exact_mut(8).zip(words) {
        out.copy_from_slice(&word.to_le_bytes());
    }
}

const META: usize = 1;
const NODES: usize = 2;
const RECORDS: usize = 3;
const BOUNDS: usize = 4;
const VERTICES: usize = 5;
const NORMALS: usize = 6;

#[test]
fn one_lowered_code_is_found_wherever_it_stands() {
    for kind in BoundKind::ALL {
        one_lowered_code_is_found(kind);
    }
}

fn one_lowered_code_is_found(kind: BoundKind) {
    let good = scene_with(&octahedron(2), kind);
    assert_eq!((audit(&good).passed(), audit(&good).bounds), (true, kind));
    let (mut lowered, one) = (0, U::<10>::new(1));
    let lower = |code: &mut U<10>| *code = U::new(code.get().saturating_sub(one.get()));
    for tree in 0..good.trees() {
        for side in 0..3 {
            let report = damaged(&good, RECORDS, |b| {
                change(b, 64 * tree + 32, |r: &mut BoundData| lower([&mut r.e0, &mut r.e1, &mut r.e2][side]));
            });
            found_by(&report, "bounds cover the true displacement");
            lowered += 1;
        }
        for child in 0..4 {
            let at = 64 * layout::child_group(2, tree, 0, 0) + 16 * child;
            let report = damaged(&good, BOUNDS, |b| change(b, at, |r: &mut BoundData| lower(&mut r.e1)));
            assert!(!report.passed());
            lowered += 1;
        }
    }
    assert_eq!(lowered, 8 * 7);
}

#[test]
fn the_papers_bounds_do_not_pass_for_total_ones() {
    for s in [octahedron(2), octahedron(5), grid(3, 3), fan(4)] {
        let mut h = quantise(&s, BoundKind::Largest).unwrap();
        h.bounds.kind = BoundKind::Total;
        let nodes = over_trees(&tree_boxes(&h)).unwrap();
        let report = audit(&encode(&h, &s, info("said to be total"), &nodes).unwrap());
        assert_eq!(report.bounds, BoundKind::Total);
        found_by(&report, "bounds cover the true displacement");
        assert!(report.checks.iter().filter(|check| !check.passed()).count() == 1, "{report}");
    }
}

#[test]
fn a_smaller_scale_is_found() {
    let good = scene(&octahedron(3));
    let report = damaged(&good, META, |b| {
        let at = b.windows(16).position(|w| w == b"\"bound_mantissa\"").unwrap() + 17;
        b[at] -= 1; // the leading digit: at least 1 because the mantissa has 17 bits or more
        if b[at] == b'0' {
            b[at] = b' ';
        }
    });
    found_by(&report, "bounds cover the true displacement");
}

#[test]
fn each_damage_is_found_by_its_check() {
    let levels = 6;
    let good = scene(&octahedron(levels));
    assert!(audit(&good).passed());
    let group = 64 * layout::child_group(levels, 3, 1, 2);
    let line = |level, node| 32 * layout::vertex_line(levels, 5, level, node);

    for axis in 0..3 {
        let shrink = |v: &mut Vec3<16>, by: i64| {
            let mut c = v.get();
            c[axis] += by;
            *v = Vec3::new(c[0], c[1], c[2]);
        };
        let boxes = "boxes contain all full-resolution vertices below";
        found_by(&damaged(&good, BOUNDS, |b| change(b, group, |r: &mut BoundData| shrink(&mut r.bounds.hi, -1))), boxes);
        found_by(&damaged(&good, BOUNDS, |b| change(b, group, |r: &mut BoundData| shrink(&mut r.bounds.lo, 1))), boxes);
        found_by(&damaged(&good, RECORDS, |b| change(b, 32, |r: &mut BoundData| shrink(&mut r.bounds.hi, -1))), boxes);
        let leaf = |b: &mut [u8]| change(b, 80, |r: &mut BvhChild| shrink(&mut r.bounds.hi, -1)); // slot 0 is empty
        found_by(&damaged(&good, NODES, leaf), "quad-BVH leaf boxes contain their trees' boxes");
        let root = |b: &mut [u8]| change(b, 0, |r: &mut BvhChild| shrink(&mut r.bounds.lo, 1));
        found_by(&damaged(&good, NODES, root), "quad-BVH inner boxes contain their children's boxes");
    }

    // Bit 4 of a coordinate, the lowest that is stored: no vertex of level 1 of 6 may have it.
    let nudge = |r: &mut VertexData| r.v1 = Vec3::new(r.v1.x.get() ^ 1, r.v1.y.get(), r.v1.z.get());
    found_by(&damaged(&good, VERTICES, |b| change(b, line(0, 0), nudge)), "low bits of the level's grid are zero");
    let across = "vertices are equal in all trees that share them";
    found_by(&damaged(&good, VERTICES, |b| change(b, line(0, 0), nudge)), across);
    found_by(&damaged(&good, RECORDS, |b| change(b, 64, |r: &mut VertexData| r.v0 = Vec3::new(r.v0.x.get() ^ 64, 0, 0))), across);
    // The centre child's vertices are all stored by its siblings too.
    let inside = "inserted vertices are equal on both sides of an edge";
    found_by(&damaged(&good, VERTICES, |b| change(b, line(1, 3), nudge)), inside);
    let outside = |r: &mut VertexData| r.v0 = Vec3::new((1 << 27) - 64, 0, 0);
    let refused = |kind, f: &dyn Fn(&mut [u8])| reopened(&good, kind, f).expect_err("refused").to_string();
    assert!(refused(VERTICES, &|b| change(b, line(1, 3), outside)).contains("coordinate beyond"));
    assert!(refused(RECORDS, &|b| change(b, 64, outside)).contains("coordinate beyond"));
    let least = |r: &mut BoundData| r.bounds.lo = Vec3::new(0, -32_768, 0);
    assert!(refused(BOUNDS, &|b| change(b, group, least)).contains("box inside out"));

    let reserved = "reserved bits and empty slots are zero";
    found_by(&damaged(&good, VERTICES, |b| change(b, line(2, 1), |r: &mut VertexData| r.reserved = U::new(1))), reserved);
    found_by(&damaged(&good, BOUNDS, |b| change(b, group, |r: &mut BoundData| r.reserved = U::new(1))), reserved);
    found_by(&damaged(&good, RECORDS, |b| b[64 + 63] = 0x80), reserved);
    found_by(&damaged(&good, RECORDS, |b| b[31] |= 0x80), reserved);

    // Raised codes still cover: only equality and order break.
    let raise = |b: &mut [u8]| change(b, 32, |r: &mut BoundData| r.e0 = U::new(1023));
    found_by(&damaged(&good, RECORDS, raise), "all trees that share an edge hold the same code");
    let centre = group + 48;
    let raise = |b: &mut [u8]| change(b, centre, |r: &mut BoundData| r.e2 = U::new(1023));
    found_by(&damaged(&good, BOUNDS, raise), "both sides of an edge hold the same code");

    found_by(&damaged(&good, NORMALS, |b| b[100..104].copy_from_slice(&[0, 0x80, 0, 0])), "normals are present");
    let report = damaged(&good, META, |b| {
        let at = b.windows(4).position(|w| w == b"\"lo\"").unwrap() + 10; // -214>7<...: less is within the limit
        b[at] -= 1;
    });
    found_by(&report, "the model's box is that of its vertices");
}

#[test]
fn swapped_and_doubled_tree_references_are_found() {
    let good = scene(&octahedron(3));
    let slots = |b: &mut [u8], f: &dyn Fn(&mut [[u8; 16]])| f(b[64..128].as_chunks_mut::<16>().0);
    // Node 1 holds two leaves. Their references stand in the last four bytes.
    let swapped = damaged(&good, NODES, |b| {
        slots(b, &|s| {
            let (used, other) = (s.iter().position(|s| s[15] != 0).unwrap(), s.iter().rposition(|s| s[15] != 0).unwrap());
            assert_ne!(used, other);
            let kept: [u8; 4] = s[used][12..].try_into().unwrap();
            let moved: [u8; 4] = s[other][12..].try_into().unwrap();
            s[used][12..].copy_from_slice(&moved);
            s[other][12..].copy_from_slice(&kept);
        });
    });
    found_by(&swapped, "quad-BVH leaf boxes contain their trees' boxes");
    let doubled = damaged(&good, NODES, |b| {
        slots(b, &|s| {
            let (used, other) = (s.iter().position(|s| s[15] != 0).unwrap(), s.iter().rposition(|s| s[15] != 0).unwrap());
            s[other] = s[used];
        });
    });
    found_by(&doubled, "trees are referred to exactly once");
    let lost = damaged(&good, NODES, |b| b[..16].fill(0));
    found_by(&lost, "trees are referred to exactly once");
    found_by(&lost, "quad-BVH nodes are referred to exactly once");
}

#[test]
fn finer_codes_above_coarser_are_found() {
    // Both sides of an inner edge of level 1 raised: equal and covering, but above the codes of the base edges.
    let levels = 3;
    let v = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    // Two trees, a bump in the second alone: the first's codes are small.
    let s = surface(levels, &v, &[[0, 1, 2], [3, 2, 1]], |p| [p[0], p[1], if p[0] + p[1] > 1.6 { 0.1 } else { 0.0 }]);
    let good = scene(&s);
    assert!(audit(&good).passed());
    // e_k of the centre child is e_k of corner child k.
    let group = 64 * layout::child_group(levels, 0, 0, 0);
    let report = damaged(&good, BOUNDS, |b| {
        change(b, group, |r: &mut BoundData| r.e0 = U::new(1023));
        change(b, group + 48, |r: &mut BoundData| r.e0 = U::new(1023));
    });
    found_by(&report, "codes do not grow towards finer levels");
    assert_eq!(report.check("both sides of an edge hold the same code").unwrap().breaches, 0);
    assert_eq!(report.check("bounds cover the true displacement").unwrap().breaches, 0);
}

#[test]
fn a_deep_displacement_lifts_its_ancestors_across_the_border() {
    // Flat but for one vertex of level 3 inside tree 0. It splits (0,6)-(2,6); (2,6) splits (4,4)-(0,8) on the shared edge, whose own middle is (4,4);
    // (0,6) splits (0,4)-(0,8) on e1, whose middle is (0,4).
    let levels = 3;
    let v = [[0.0; 3], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0], [8.0, 8.0, 0.0]];
    let lifted = |p: [f64; 3]| if p == [1.0, 6.0, 0.0] { [1.0, 6.0, 0.5] } else { p };
    for (second, shared, half) in [([3, 2, 1], 0, [(8, 0), (4, 4)]), ([1, 2, 3], 2, [(4, 0), (8, 0)]), ([2, 1, 3], 2, [(0, 0), (4, 0)])] {
        let s = surface(levels, &v, &[[0, 1, 2], second], lifted);
        let h = quantise(&s, BoundKind::Largest).unwrap();
        let top = |tree: usize, mut edges: Vec<usize>| {
            edges.sort_unstable();
            let lifted: Vec<_> = (0..h.codes(tree).len()).filter(|&e| h.codes(tree)[e] != 0).collect();
            assert_eq!(lifted, edges, "tree {tree} of {second:?}");
            assert!(lifted.iter().all(|&e| h.codes(tree)[e] == 1023));
        };
        let edge = |level, a, b| edge_index(levels, level, a, b);
        let (e0, e1) = (edge(0, (8, 0), (0, 8)), edge(0, (0, 8), (0, 0)));
        let path = [edge(2, (0, 6), (2, 6)), edge(1, (4, 4), (0, 8)), edge(1, (0, 4), (0, 8))];
        top(0, [&path[..], &[e0, e1]].concat());
        // The other tree has no displaced vertex: only the shared edge and its half towards vertex 2.
        let corners = lattice::root(levels);
        top(1, vec![edge(0, corners[(shared + 1) % 3], corners[(shared + 2) % 3]), edge(1, half[0], half[1])]);
        let truth = h.points.iter().map(|p| i64::from(p[2])).max().unwrap() - h.points.iter().map(|p| i64::from(p[2])).min().unwrap();
        let decoded = bound_decode(h.bounds.scale, 1023);
        assert!(decoded >= truth as u64 && decoded as f64 <= truth as f64 * 1.0001);
        assert!(audit(&scene(&s)).passed());
    }
}

/// A value in -1..1 that depends on every bit of `p`, `seed` and `axis`.
fn noise(p: [f64; 3], seed: u64, axis: u64) -> f64 {
    let mixed = p.iter().fold(seed ^ axis << 60, |h, c| (h ^ c.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29));
    (mixed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Any triangles over six vertices: edges with one, two and many trees, both ways round, all sides against all sides.
fn any_surface() -> impl Strategy<Value = Surface> {
    let triangle = prop::array::uniform3(0u32..6).prop_filter("three vertices", |[a, b, c]| a != b && b != c && c != a);
    (0u32..5, prop::collection::vec(triangle, 1..12), any::<u64>(), -8i32..1).prop_map(|(levels, triangles, seed, exponent)| {
        let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.3], [-1.0, 0.4, 0.2]];
        let height = 10f64.powi(exponent);
        surface(levels, &vertices, &triangles, |p| std::array::from_fn(|k| p[k] + height * noise(p, seed, k as u64)))
    })
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn any_surface_passes(s in any_surface()) {
        for kind in BoundKind::ALL {
            let report = audit(&scene_with(&s, kind));
            prop_assert!(report.passed(), "{}", report);
        }
    }

    #[test]
    fn no_damage_makes_anything_panic(kind in 2usize..9, places in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..20)) {
        let good = scene(&octahedron(3));
        let mut bytes = good.bytes().to_vec();
        let (offset, length) = lodray_test_support::surfaces::section(&bytes, kind);
        for (place, value) in places {
            bytes[offset + place.index(length)] = value;
        }
        lodray_test_support::surfaces::reseal(&mut bytes);
        let changed = bytes != good.bytes();
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("damaged.lod");
        std::fs::write(&path, bytes).unwrap();
        if let Ok(scene) = Scene::open(&path) {
            let report = audit(&scene);
            // Normals and colours have no wrong values but one; connectivity may be renamed.
            prop_assert!(!changed || !report.passed() || kind != 5, "{}", report);
            let _ = (scene.decode(), scene.full_resolution_triangle(7, 63), export_level(&scene, 3, std::io::sink()));
        }
    }
}
