//! The remesher on small meshes made here: shared borders, folds, sharp edges, holes, distances, limits.

use lodray::mesh::{RemeshError, RemeshOptions, RemeshReport, Surface, TriangleMesh, lattice, remesh};
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
    let result = remesh(mesh, &RemeshOptions { levels, base_triangles: Some(base) }, &|_, done, total| assert!(done <= total)).unwrap();
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
    assert!(d.to_original.mean < 0.005 && d.to_original.max < 0.1 && d.from_original.mean < 0.05 && d.from_original.max < 0.3, "{d:?}");
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
    assert!(d.to_original.max < 1e-9 && d.from_original.max < 1e-9, "{d:?}");
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
    assert!(report.distance.from_original.max < 1e-6, "{report:?}");
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
    assert!(report.distance.from_original.max < 1e-9);
}

#[test]
fn ten_levels_of_a_tiny_mesh() {
    let tetrahedron =
        mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    let (_, report) = run(&tetrahedron, 6, 4);
    assert_eq!(report.finest_triangles, 4 << 12);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.to_original.max < 1e-9 && report.distance.from_original.max < 1e-9);
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
        assert_eq!(scaled_report, report);
        assert!(surface.positions.iter().zip(&unit.positions).all(|(a, b)| *a == b.map(|v| v * scale)));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let original = wave(24);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (s, r) = remesh_quietly(&original, RemeshOptions { levels: 3, base_triangles: Some(50) }).unwrap();
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
    let ask = |levels, base_triangles| remesh_quietly(&original, RemeshOptions { levels, base_triangles }).map(|_| ()).unwrap_err();
    assert_eq!(ask(11, None), RemeshError::Levels { levels: 11 });
    assert_eq!(ask(1, Some(0)), RemeshError::NoBase);
    let big = remesh_quietly(&sphere(20), RemeshOptions { levels: 10, base_triangles: Some(4000) }).map(|_| ()).unwrap_err();
    assert!(matches!(big, RemeshError::TooMany { levels: 10, .. }), "{big}");
    let options = RemeshOptions::default();
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
