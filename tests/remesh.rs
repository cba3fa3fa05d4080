//! The remesher on small meshes made here: shared borders, folds, sharp edges, holes, distances, limits.

use lodray::mesh::{RemeshError, RemeshOptions, RemeshReport, Surface, TriangleMesh, lattice, remesh};
use lodray_test_support::thin;
use std::collections::HashMap;

fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriangleMesh {
    TriangleMesh::from_parts(positions, triangles, &[], vec![]).unwrap()
}

/// A grid of n x n squares on each of some faces, placed by `place` from (face, u, v) in 0..=1.
fn grids(faces: usize, n: u32, place: impl Fn(usize, f64, f64) -> [f64; 3]) -> TriangleMesh {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for face in 0..faces {
        let base = positions.len() as u32;
        for j in 0..=n {
            positions.extend((0..=n).map(|i| place(face, f64::from(i) / f64::from(n), f64::from(j) / f64::from(n))));
        }
        for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
            let a = base + j * (n + 1) + i;
            triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    mesh(&positions, &triangles)
}

fn cube_point(face: usize, u: f64, v: f64) -> [f64; 3] {
    let (u, v) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    [[1.0, u, v], [-1.0, v, u], [v, 1.0, u], [u, -1.0, v], [u, v, 1.0], [v, u, -1.0]][face]
}

fn cube(n: u32) -> TriangleMesh {
    grids(6, n, cube_point)
}

fn sphere(n: u32) -> TriangleMesh {
    grids(6, n, |face, u, v| {
        let p = cube_point(face, u, v);
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        // Rounded, so that the seams between faces weld.
        p.map(|x| (x / length * 1e9).round() / 1e9)
    })
}

fn wave(n: u32) -> TriangleMesh {
    grids(1, n, |_, u, v| [u, v, 0.1 * (3.0 * u).sin() * (2.0 * v).cos()])
}

fn run(mesh: &TriangleMesh, levels: u32, base: usize) -> (Surface, RemeshReport) {
    let result = remesh(mesh, &RemeshOptions { levels, base_triangles: Some(base), ..RemeshOptions::default() }, &|_, done, total| {
        assert!(done <= total)
    })
    .unwrap();
    check(&result.0);
    assert_eq!(result.1.base_triangles, result.0.triangles.len());
    assert_eq!(result.1.finest_triangles, result.0.finest_triangles());
    result
}

/// What must hold for every surface, above all that trees agree bit for bit on the edges that they share.
fn check(s: &Surface) {
    let (m, len) = (1u32 << s.levels, lattice::len(s.levels));
    assert!(!s.triangles.is_empty());
    assert_eq!((s.positions.len(), s.normals.len()), (len * s.triangles.len(), len * s.triangles.len()));
    assert!(s.positions.iter().flatten().all(|v| v.is_finite()));
    for n in &s.normals {
        let length = n.iter().map(|v| v * v).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-3, "normal {n:?}");
    }
    let mut seen: HashMap<(u32, u32, u32), [u64; 3]> = HashMap::new();
    for (t, tri) in s.triangles.iter().enumerate() {
        assert!(tri[0] != tri[1] && tri[1] != tri[2] && tri[2] != tri[0]);
        assert!(tri.iter().all(|&v| v < s.base_vertices));
        for step in 0..=m {
            for (k, p) in [(0, (m - step, step)), (1, (0, m - step)), (2, (step, 0))] {
                let (a, b) = (tri[(k + 1) % 3], tri[(k + 2) % 3]);
                let key = match step {
                    0 => (a, a, 0),
                    _ if step == m => (b, b, 0),
                    _ if a < b => (a, b, step),
                    _ => (b, a, m - step),
                };
                let bits = s.tree(t)[lattice::index(s.levels, p)].map(f64::to_bits);
                assert_eq!(*seen.entry(key).or_insert(bits), bits, "trees differ at {key:?}");
            }
        }
    }
}

#[test]
fn a_sphere_becomes_a_finer_sphere() {
    let original = sphere(24);
    let (surface, report) = run(&original, 4, 100);
    assert!((80..=125).contains(&report.base_triangles), "{report:?}");
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert_eq!((report.on_feature_lines, report.midpoints_kept), (0, 0), "{report:?}");
    let d = report.distance;
    assert!(d.to_original.mean < 0.005 && d.to_original.found < 0.1 && d.from_original.mean < 0.05 && d.from_original.found < 0.3, "{d:?}");
    for (p, n) in surface.positions.iter().zip(&surface.normals) {
        let dot: f64 = (0..3).map(|k| p[k] * f64::from(n[k])).sum();
        assert!(dot > 0.98, "the normal {n:?} at {p:?} leans");
    }
}

#[test]
fn a_cube_keeps_its_corners_and_edges() {
    let (surface, report) = run(&cube(12), 4, 12);
    assert!(report.base_triangles <= 15, "{report:?}");
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0));
    let d = report.distance;
    assert!(d.to_original.found < 1e-9 && d.from_original.found < 1e-9 && d.to_original.max < 0.2 && d.from_original.max < 0.2, "{d:?}");
    // On every face the normals are those of the face, up to its very edge.
    for t in 0..surface.triangles.len() {
        let [a, b, c] = lattice::root(4).map(|p| surface.tree(t)[lattice::index(4, p)]);
        let axis = (0..3).find(|&k| a[k] == b[k] && b[k] == c[k] && a[k].abs() == 1.0).expect("a triangle across an edge");
        let len = lattice::len(4);
        for n in &surface.normals[t * len..][..len] {
            assert!((f64::from(n[axis]) - a[axis]).abs() < 1e-6, "{n:?} on the face {axis} at {}", a[axis]);
        }
    }
}

#[test]
fn a_border_keeps_its_outline() {
    // A square with a round hole.
    let original = grids(4, 16, |face, u, v| {
        let angle = (face as f64 + u) * std::f64::consts::FRAC_PI_2;
        let snap = |x: f64| (x * 1e9).round() / 1e9;
        let (x, y) = (snap(angle.cos()), snap(angle.sin()));
        let outer = 2.0 / x.abs().max(y.abs());
        let r = 1.0 + v * (outer - 1.0);
        [snap(x * r), snap(-y * r), 0.0]
    });
    assert_eq!(original.report.border_edges, 128);
    let (surface, report) = run(&original, 4, 60);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.on_feature_lines > 0);
    assert!(report.distance.from_original.max < 0.3, "{report:?}");
    for p in &surface.positions {
        let (r, side) = (p[0].hypot(p[1]), p[0].abs().max(p[1].abs()));
        assert!(r > 0.995 && side < 2.0 + 1e-9 && p[2] == 0.0, "{p:?} is outside the outline");
    }
}

#[test]
fn an_open_surface_is_followed_closely() {
    let (_, report) = run(&wave(32), 3, 64);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.to_original.mean < 0.01 && report.distance.from_original.mean < 0.01, "{report:?}");
}

#[test]
fn a_non_manifold_edge_has_one_vertex_for_all_its_triangles() {
    // Five pages of a book, each a grid, on one spine.
    let original = grids(5, 8, |page, u, v| {
        let angle = page as f64;
        [u * angle.cos(), u * angle.sin(), v]
    });
    assert_eq!(original.report.non_manifold_edges, 8);
    let (surface, report) = run(&original, 3, 10);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.from_original.found < 1e-6, "{report:?}");
    let mut pages = HashMap::new();
    for t in &surface.triangles {
        (0..3).for_each(|k| *pages.entry((t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3]))).or_insert(0) += 1);
    }
    assert!(pages.values().any(|&n| n == 5));
}

#[test]
fn no_levels_and_all_triangles_give_the_original() {
    let original = sphere(4);
    let (surface, report) = run(&original, 0, usize::MAX);
    assert_eq!(surface.triangles.len(), original.triangles.len());
    let corners = |t: usize| original.triangles[t].map(|v| original.positions[v as usize]);
    for t in 0..surface.triangles.len() {
        assert_eq!(surface.tree(t), [corners(t)[0], corners(t)[1], corners(t)[2]]);
    }
    assert!(report.distance.from_original.found < 1e-9);
    assert_eq!(report.own_base_triangles, original.triangles.len());
}

#[test]
fn ten_levels_of_a_tiny_mesh() {
    let tetrahedron =
        mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    let (_, report) = run(&tetrahedron, 6, 4);
    assert_eq!(report.finest_triangles, 4 << 12);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.to_original.found < 1e-9 && report.distance.from_original.found < 1e-9);
    let (_, report) = run(&mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]), 10, 1);
    assert_eq!(report.finest_triangles, 1 << 20);
}

#[test]
fn size_and_place_do_not_matter() {
    let original = sphere(12);
    let (unit, report) = run(&original, 2, 100);
    for exponent in [-100, 100] {
        let scale = 2f64.powi(exponent);
        let scaled: Vec<[f64; 3]> = original.positions.iter().map(|p| p.map(|v| v * scale)).collect();
        let (surface, scaled_report) = run(&mesh(&scaled, &original.triangles), 2, 100);
        // But for the place that a warning names.
        assert_eq!(RemeshReport { warning: None, ..scaled_report }, RemeshReport { warning: None, ..report.clone() });
        assert!(surface.positions.iter().zip(&unit.positions).all(|(a, b)| *a == b.map(|v| v * scale)));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let original = wave(24);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (s, r) =
                remesh_quietly(&original, RemeshOptions { levels: 3, base_triangles: Some(50), ..RemeshOptions::default() }).unwrap();
            (s.positions, s.normals, s.triangles, r)
        })
    };
    assert!(with(1) == with(4));
}

fn remesh_quietly(mesh: &TriangleMesh, options: RemeshOptions) -> Result<(Surface, RemeshReport), RemeshError> {
    remesh(mesh, &options, &|_, _, _| {})
}

#[test]
fn materials_follow_their_triangles() {
    let plain = cube(6);
    let materials: Vec<u16> = (0..plain.triangles.len()).map(|t| (t / 72) as u16).collect();
    let colours: Vec<[f32; 3]> = (0..6).map(|k| [k as f32 / 5.0; 3]).collect();
    let original = TriangleMesh::from_parts(&plain.positions, &plain.triangles, &materials, colours.clone()).unwrap();
    let (surface, _) = run(&original, 1, 12);
    assert_eq!((surface.materials.len(), surface.colours.clone()), (surface.triangles.len(), colours));
    for (t, &material) in surface.materials.iter().enumerate() {
        let centre = lattice::root(1).map(|p| surface.tree(t)[lattice::index(1, p)]);
        let face = (0..6).find(|&f| {
            let q = cube_point(f, 0.5, 0.5);
            let axis = q.iter().position(|v| v.abs() == 1.0).unwrap();
            centre.iter().all(|p| p[axis] == q[axis])
        });
        assert_eq!(face, Some(material as usize));
    }
}

#[test]
fn wrong_requests_are_refused() {
    let original = cube(2);
    let ask = |levels, base_triangles| {
        remesh_quietly(&original, RemeshOptions { levels, base_triangles, ..RemeshOptions::default() }).map(|_| ()).unwrap_err()
    };
    assert_eq!(ask(11, None), RemeshError::Levels { levels: 11 });
    assert_eq!(ask(1, Some(0)), RemeshError::NoBase);
    let big = remesh_quietly(&sphere(20), RemeshOptions { levels: 10, base_triangles: Some(4000), ..RemeshOptions::default() })
        .map(|_| ())
        .unwrap_err();
    let RemeshError::TooMany { levels: 10, base, works, .. } = big.clone() else { panic!("{big}") };
    assert_eq!((works.levels, works.base, works.error), (Some(7), Some(64), false), "{base} base triangles");
    assert!(base << 14 <= 1 << 26 && base << 16 > 1 << 26, "{base}");
    assert!(
        big.to_string().contains("--levels 7") && big.to_string().contains("--base 64") && !big.to_string().contains("max-error"),
        "{big}"
    );
    let options = RemeshOptions { levels: 0, ..RemeshOptions::default() };
    let refuse = |mesh: &TriangleMesh| assert!(matches!(remesh_quietly(mesh, options), Err(RemeshError::BadMesh { .. })));
    refuse(&TriangleMesh::default());
    let mut bad = original.clone();
    bad.triangles[0][0] = 999;
    refuse(&bad);
    bad = original.clone();
    bad.positions[0][0] = f64::NAN;
    refuse(&bad);
    bad = original.clone();
    bad.materials = vec![0];
    refuse(&bad);
}

#[test]
fn ugly_meshes_do_no_harm() {
    // Slivers, points that touch, spikes, and a triangle on both sides.
    let mut positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1e-14, 0.0], [0.5, 1.0, 0.0], [0.5, 0.5, 1e6], [0.5, 0.5, -1e-9]];
    positions.extend((0..40).map(|i| [f64::from(i * i % 17), f64::from(i * 7 % 13), f64::from(i * 5 % 11)]));
    let mut triangles = vec![[0, 1, 2], [0, 2, 3], [2, 1, 3], [0, 3, 4], [3, 1, 4], [0, 1, 5], [0, 5, 3]];
    triangles.extend((6..44u32).map(|i| [i, i + 1, i + 2]));
    triangles.extend((6..30u32).map(|i| [i, i + 7, i + 15]));
    let original = mesh(&positions, &triangles);
    for base in [1, 10, 30, 1000] {
        for levels in [0, 1, 4] {
            run(&original, levels, base);
        }
    }
}

/// The default: as few base triangles as keep the original within the limit.
fn fit(mesh: &TriangleMesh, options: RemeshOptions) -> (Surface, RemeshReport) {
    let result = remesh_quietly(mesh, options).unwrap();
    check(&result.0);
    result
}

#[test]
fn thin_parts_tips_and_creases_are_kept() {
    // The others are in the benchmark's table.
    for (name, original) in thin::shapes().into_iter().filter(|s| ["horn", "comb", "leaf", "claw", "gem"].contains(&s.0)) {
        assert_eq!(
            (original.report.border_edges, original.report.non_manifold_edges, original.report.inconsistent_edges),
            (0, 0, 0),
            "{name}"
        );
        let (_, report) = fit(&original, RemeshOptions { levels: 4, ..RemeshOptions::default() });
        let d = report.distance;
        assert!(d.to_original.max <= 0.3 && d.from_original.max <= 0.3, "{name}: {d:?}");
        assert!(d.to_original.found <= d.to_original.max && d.from_original.found <= d.from_original.max, "{name}: {d:?}");
        assert_eq!((report.flipped_triangles, report.degenerate_triangles, &report.warning), (0, 0, &None), "{name}: {report:?}");
        assert!(report.base_triangles < original.triangles.len(), "{name}: {report:?}");
    }
}

#[test]
fn a_smaller_error_takes_a_finer_base_and_is_kept() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "claw").unwrap();
    let mut before = 0;
    for max_error in [2.0, 0.5, 0.1] {
        let (_, report) = fit(&original, RemeshOptions { levels: 3, max_error, ..RemeshOptions::default() });
        let d = report.distance;
        assert!(d.to_original.max <= max_error && d.from_original.max <= max_error && report.warning.is_none(), "{max_error}: {report:?}");
        assert!(report.base_triangles >= before && (max_error > 0.1 || report.base_triangles > before), "{max_error}: {report:?}");
        before = report.base_triangles;
    }
}

/// The closest point of a triangle by trying its plane, edges and corners one after the other.
fn distance_to_triangle(p: [f64; 3], t: &[[f64; 3]; 3]) -> f64 {
    let sub = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|k| a[k] - b[k]) };
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let cross = |a: [f64; 3], b: [f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let normal = cross(sub(t[1], t[0]), sub(t[2], t[0]));
    let inside = (0..3).all(|k| dot(cross(sub(t[(k + 1) % 3], t[k]), sub(p, t[k])), normal) >= 0.0);
    if inside && dot(normal, normal) > 0.0 {
        return dot(sub(p, t[0]), normal).abs() / dot(normal, normal).sqrt();
    }
    let edge = |a: [f64; 3], b: [f64; 3]| {
        let along = sub(b, a);
        let s = (dot(sub(p, a), along) / dot(along, along)).clamp(0.0, 1.0);
        let away: [f64; 3] = std::array::from_fn(|k| a[k] + s * along[k] - p[k]);
        dot(away, away).sqrt()
    };
    (0..3).map(|k| edge(t[k], t[(k + 1) % 3])).fold(f64::INFINITY, f64::min)
}

#[test]
fn no_point_is_further_than_the_largest_distance_says() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "gem").unwrap();
    for options in [
        RemeshOptions { levels: 2, base_triangles: Some(8), ..Default::default() },
        RemeshOptions { levels: 2, max_error: 3.0, ..Default::default() },
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
fn normals_are_those_of_the_points_that_vertices_stand_for() {
    // Eight sides bend by 45 degrees: round below that angle, faceted above.
    let drum = grids(8, 4, |face, u, v| {
        let [(s0, c0), (s1, c1)] = [face, face + 1].map(|f| (std::f64::consts::FRAC_PI_4 * f as f64).sin_cos());
        let snap = |x: f64| (x * 1e9).round() / 1e9;
        [snap(c0 + (c1 - c0) * u), snap(s0 + (s1 - s0) * u), v]
    });
    let off_axis = |s: &Surface| {
        let far = s.positions.iter().zip(&s.normals).map(|(p, n)| {
            let r = p[0].hypot(p[1]);
            1.0 - (p[0] * f64::from(n[0]) + p[1] * f64::from(n[1])) / r
        });
        far.fold(0.0f64, f64::max)
    };
    let options = |crease_angle| RemeshOptions { levels: 3, crease_angle, ..RemeshOptions::default() };
    let (round, _) = fit(&drum, options(50.0));
    let (faceted, _) = fit(&drum, options(40.0));
    // The vertices of the original inside a side have that side's normal, a quarter of 45 degrees from round.
    assert!(off_axis(&round) < 0.021, "{}", off_axis(&round));
    assert!((off_axis(&faceted) - (1.0 - (std::f64::consts::PI / 8.0).cos())).abs() < 0.003, "{}", off_axis(&faceted));
    // A mesh's own normals win, whatever they say.
    let mut own = drum;
    own.normals = vec![[[0.0, 0.6, 0.8]; 3]; own.triangles.len()];
    let (surface, _) = fit(&own, options(40.0));
    assert!(surface.normals.iter().all(|n| (n[1] - 0.6).abs() < 1e-6 && (n[2] - 0.8).abs() < 1e-6));
}

#[test]
fn a_border_between_materials_stays_where_it_is() {
    // A ball of two colours, which meet in a wave.
    let plain = sphere(24);
    let upper = |t: &[u32; 3]| {
        let middle: [f64; 3] = std::array::from_fn(|k| t.iter().map(|&v| plain.positions[v as usize][k]).sum());
        middle[2] > 0.6 * (3.0 * middle[1].atan2(middle[0])).sin()
    };
    let materials: Vec<u16> = plain.triangles.iter().map(|t| upper(t).into()).collect();
    let original =
        TriangleMesh::from_parts(&plain.positions, &plain.triangles, &materials, vec![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
    let (surface, report) = fit(&original, RemeshOptions { levels: 4, ..RemeshOptions::default() });
    assert!(report.base_triangles < original.triangles.len() / 4, "{report:?}");
    // Every finest triangle lies where the original has its colour.
    let at = |t: &[u32; 3]| t.map(|v| original.positions[v as usize]);
    for t in 0..surface.triangles.len() {
        for n in (0..256).step_by(37) {
            let c = lattice::node(4, 4, n).map(|p| surface.tree(t)[lattice::index(4, p)]);
            let middle = std::array::from_fn(|k| (c[0][k] + c[1][k] + c[2][k]) / 3.0);
            let near = |m: u16| {
                let all = original.triangles.iter().zip(&original.materials).filter(|x| *x.1 == m);
                all.map(|(tri, _)| distance_to_triangle(middle, &at(tri))).fold(f64::INFINITY, f64::min)
            };
            assert!(near(surface.materials[t]) < 0.01, "tree {t}: its colour is {} away", near(surface.materials[t]));
        }
    }
}

#[test]
fn levels_that_leave_no_room_for_the_base_are_refused_with_those_that_do() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "claw").unwrap();
    let ask = |levels| remesh_quietly(&original, RemeshOptions { levels, ..RemeshOptions::default() }).map(|r| r.1);
    let Err(refusal @ RemeshError::NeedsBase { base, levels: 10, works }) = ask(10) else { panic!("no refusal") };
    let levels = works.levels.unwrap();
    assert!(
        (4u64..10).contains(&levels.into()) && base << (2 * levels) <= 1 << 26 && base << (2 * levels + 2) > 1 << 26,
        "{base} {levels}"
    );
    let message = refusal.to_string();
    assert!(message.contains(&format!("--levels {levels}")), "{message}");
}

#[test]
fn a_base_is_advised_only_where_removal_comes_that_far() {
    // Fifty tetrahedra, of which none can go: at ten levels there is room for 64 triangles.
    let corner = |k: usize, c: usize| std::array::from_fn(|a| (3 * k) as f64 + f64::from(u8::from(a + 1 == c)));
    let positions: Vec<[f64; 3]> = (0..50).flat_map(|k| (0..4).map(move |c| corner(k, c))).collect();
    let faces = |k: u32| [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(|v| 4 * k + v));
    let original = mesh(&positions, &(0..50).flat_map(faces).collect::<Vec<_>>());
    for base_triangles in [None, Some(10)] {
        let options = RemeshOptions { levels: 10, base_triangles, ..RemeshOptions::default() };
        let refusal = remesh_quietly(&original, options).map(|_| ()).unwrap_err();
        let (RemeshError::TooMany { works, .. } | RemeshError::NeedsBase { works, .. }) = &refusal else { panic!("{refusal}") };
        assert_eq!((works.levels, works.base, works.error), (Some(9), None, false), "{refusal}");
        assert!(refusal.to_string().ends_with("; what works is --levels 9 at most"), "{refusal}");
    }
}

#[test]
fn what_rounding_to_the_grid_takes_is_refused_and_no_more() {
    let original = cube(2);
    for levels in [0, 3, 8, 10] {
        let ask =
            |max_error| remesh_quietly(&original, RemeshOptions { levels, max_error, base_triangles: Some(48), ..Default::default() });
        let Err(refusal @ RemeshError::Grid { wanted, least, .. }) = ask(1e-7) else { panic!("no refusal") };
        assert!(wanted < least && least < 1e-4 && refusal.to_string().contains(&format!("--max-error of {least} or more")), "{refusal}");
        assert!(ask(0.99 * least).is_err());
        if levels < 10 {
            // All of its triangles are kept.
            assert_eq!(ask(least).unwrap().1.warning, None, "{levels} levels");
        }
    }
}

#[test]
fn a_bound_does_not_loosen_with_a_larger_error_than_the_default() {
    let original = sphere(12);
    let bounds = [0.3, 5.0, 100.0].map(|max_error| {
        let d = fit(&original, RemeshOptions { levels: 3, base_triangles: Some(200), max_error, ..Default::default() }).1.distance;
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
        let options = RemeshOptions { max_error, crease_angle, ..RemeshOptions::default() };
        assert!(matches!(remesh_quietly(&original, options), Err(RemeshError::Range { .. })), "{options:?}");
    }
}
