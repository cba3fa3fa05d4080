//! How far result and original are apart: kept within what was asked for, measured, and said.

use super::{distance_to_triangle, fit, remesh_quietly, run, sphere};
use lodray::mesh::{RemeshError, RemeshOptions, lattice};
use lodray_test_support::thin;

#[test]
fn thin_parts_tips_and_creases_are_kept() {
    // The others are in the benchmark's table.
    for (name, original) in thin::shapes().into_iter().filter(|s| ["horn", "comb", "leaf", "claw", "gem"].contains(&s.0)) {
        assert_eq!(
            (original.report.border_edges, original.report.non_manifold_edges, original.report.inconsistent_edges),
            (0, 0, 0),
            "{name}"
        );
        let (_, report) = fit(&original, RemeshOptions { levels: Some(4), ..RemeshOptions::default() });
        let d = report.distance;
        assert!(d.to_original.max <= 0.3 && d.from_original.max <= 0.3, "{name}: {d:?}");
        assert!(d.to_original.found <= d.to_original.max && d.from_original.found <= d.from_original.max, "{name}: {d:?}");
        assert_eq!((report.flipped_triangles, report.degenerate_triangles, &report.warning), (0, 0, &None), "{name}: {report:?}");
        assert_eq!(report.folds.new, 0, "{name}: {report:?}");
        assert!(report.base_triangles < original.triangles.len(), "{name}: {report:?}");
    }
}

#[test]
fn a_smaller_error_takes_a_finer_base_and_is_kept() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "claw").unwrap();
    let mut before = 0;
    for max_error in [2.0, 0.5, 0.1] {
        let (_, report) = fit(&original, RemeshOptions { levels: Some(3), max_error, ..RemeshOptions::default() });
        let d = report.distance;
        assert!(d.to_original.max <= max_error && d.from_original.max <= max_error && report.warning.is_none(), "{max_error}: {report:?}");
        assert!(report.base_triangles >= before && (max_error > 0.1 || report.base_triangles > before), "{max_error}: {report:?}");
        before = report.base_triangles;
    }
}

#[test]
fn no_point_is_further_than_the_largest_distance_says() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "gem").unwrap();
    for options in [
        RemeshOptions { levels: Some(2), base_triangles: Some(8), ..Default::default() },
        RemeshOptions { levels: Some(2), max_error: 3.0, ..Default::default() },
    ] {
        let (surface, report) = fit(&original, options);
        let old: Vec<[[f64; 3]; 3]> = original.triangles.iter().map(|t| t.map(|v| original.positions[v as usize])).collect();
        let corners = |t: usize, n: u32| lattice::node(2, 2, n).map(|p| surface.tree(t)[lattice::index(2, p)]);
        let new: Vec<[[f64; 3]; 3]> = (0..surface.triangles.len()).flat_map(|t| (0..16).map(move |n| corners(t, n))).collect();
        let bounds = (0..3).map(|k| {
            let values = || original.positions.iter().map(|p| p[k]);
            values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
        });
        let diagonal = bounds.map(|v| v * v).sum::<f64>().sqrt();
        for (from, to, d) in [(&new, &old, report.distance.to_original), (&old, &new, report.distance.from_original)] {
            let mut worst = 0.0f64;
            for [a, b, c] in from {
                for (i, j) in (0..=6).flat_map(|i| (0..=6 - i).map(move |j| (f64::from(i) / 6.0, f64::from(j) / 6.0))) {
                    let p = std::array::from_fn(|k| a[k] * (1.0 - i - j) + b[k] * i + c[k] * j);
                    worst = worst.max(to.iter().map(|t| distance_to_triangle(p, t)).fold(f64::INFINITY, f64::min));
                }
            }
            let worst = 100.0 * worst / diagonal;
            assert!(worst <= d.max && worst >= 0.7 * d.found && d.found > 0.0, "{worst} found here, {d:?}");
        }
    }
}

#[test]
fn a_bound_does_not_loosen_with_a_larger_error_than_the_default() {
    let original = sphere(12);
    let bounds = [0.3, 5.0, 100.0].map(|max_error| {
        let d = fit(&original, RemeshOptions { levels: Some(3), base_triangles: Some(200), max_error, ..Default::default() }).1.distance;
        assert!(d.to_original.found <= d.to_original.max && d.from_original.found <= d.from_original.max, "{d:?}");
        [d.to_original.max, d.from_original.max]
    });
    assert!(bounds[0] == bounds[1] && bounds[1] == bounds[2], "{bounds:?}");
}

#[test]
fn what_was_lost_is_said_in_one_line() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "urchin").unwrap();
    let (_, report) = run(&original, 2, 100);
    let warning = report.warning.unwrap();
    assert!(
        warning.contains("% of the diagonal") && warning.contains("at (") && warning.contains("--base") && !warning.contains('\n'),
        "{warning}"
    );
    for (max_error, crease_angle) in
        [(0.0, 50.0), (-1.0, 50.0), (f64::NAN, 50.0), (101.0, 50.0), (0.3, -1.0), (0.3, 181.0), (0.3, f64::NAN)]
    {
        let options = RemeshOptions { levels: Some(0), max_error, crease_angle, ..RemeshOptions::default() };
        assert!(matches!(remesh_quietly(&original, options), Err(RemeshError::Range { .. })), "{options:?}");
    }
}

type Corners = [[f64; 3]; 3];

fn normal([a, b, c]: Corners) -> [f64; 3] {
    let [u, v]: [[f64; 3]; 2] = [b, c].map(|p| std::array::from_fn(|k| p[k] - a[k]));
    std::array::from_fn(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// Triangles that face away from what is nearest to their middle, counted by looking at all triangles of the original for each.
#[test]
fn flips_are_those_that_somebody_else_counts() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "horn").unwrap();
    let (surface, report) = run(&original, 2, 60);
    let old: Vec<Corners> = original.triangles.iter().map(|t| t.map(|v| original.positions[v as usize])).collect();
    // A sphere around each: what lies further than the nearest so far is not looked at.
    let middle = |t: &Corners| -> [f64; 3] { std::array::from_fn(|k| t.iter().map(|p| p[k]).sum::<f64>() / 3.0) };
    let apart = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| (p[k] - q[k]).powi(2)).sum::<f64>().sqrt();
    let sphere = |t: &Corners| (middle(t), t.iter().map(|&p| apart(p, middle(t))).fold(0.0, f64::max) * (1.0 + 1e-9));
    let spheres: Vec<([f64; 3], f64)> = old.iter().map(sphere).collect();
    let corners = |t: usize, n: u32| lattice::node(2, 2, n).map(|p| surface.tree(t)[lattice::index(2, p)]);
    let mut flips = 0;
    for triangle in (0..surface.triangles.len()).flat_map(|t| (0..16).map(move |n| corners(t, n))) {
        let (here, mut least, mut near) = (middle(&triangle), f64::INFINITY, Vec::new());
        for (t, &(centre, radius)) in old.iter().zip(&spheres) {
            if apart(here, centre) - radius <= least * (1.0 + 1e-6) {
                let far = distance_to_triangle(here, t);
                least = least.min(far);
                near.push((*t, far));
            }
        }
        let faces = near.iter().any(|&(t, far)| far <= least * (1.0 + 1e-6) && dot(normal(t), normal(triangle)) >= 0.0);
        flips += u64::from(!faces);
    }
    assert_eq!(report.flipped_triangles, flips);
    let said = report.warning.as_deref().is_some_and(|warning| warning.contains("away from the original, such as"));
    assert!(flips > 0 && said, "{report:?}");
}

/// A sphere whose triangles have slivers that lie back on their neighbours, as scans do.
#[test]
fn slivers_of_a_scan_shade_no_more_than_themselves() {
    let mut scan = sphere(16);
    for t in (0..scan.triangles.len()).step_by(9) {
        let [a, b, c] = scan.triangles[t];
        let [p, q, r] = [a, b, c].map(|v| scan.positions[v as usize]);
        // A little beyond the edge from a to b.
        scan.positions.push(std::array::from_fn(|k| 0.52 * (p[k] + q[k]) - 0.04 * r[k]));
        let inner = scan.positions.len() as u32 - 1;
        scan.triangles[t] = [a, b, inner];
        scan.triangles.extend([[b, c, inner], [c, a, inner]]);
    }
    let (surface, _) = fit(&scan, RemeshOptions { levels: Some(3), max_error: 1.0, ..RemeshOptions::default() });
    let normals = |t: usize| &surface.normals[t * lattice::len(3)..][..lattice::len(3)];
    for t in 0..surface.triangles.len() {
        for node in 0..64 {
            let at = lattice::node(3, 3, node).map(|p| lattice::index(3, p));
            let face = normal(at.map(|i| surface.tree(t)[i]));
            let length = dot(face, face).sqrt();
            for i in at {
                let cosine = dot(face, normals(t)[i].map(f64::from)) / length;
                assert!(cosine > 0.3, "tree {t} node {node}: {cosine}");
            }
        }
    }
}
