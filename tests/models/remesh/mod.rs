//! The remesher on small meshes made here.

mod errors;
mod levels;
mod refusals;
mod shapes;

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

fn remesh_quietly(mesh: &TriangleMesh, options: RemeshOptions) -> Result<(Surface, RemeshReport), RemeshError> {
    remesh(mesh, &options, &|_, _, _| {})
}

fn run(mesh: &TriangleMesh, levels: u32, base: usize) -> (Surface, RemeshReport) {
    let result =
        remesh(mesh, &RemeshOptions { levels: Some(levels), base_triangles: Some(base), ..RemeshOptions::default() }, &|_, done, total| {
            assert!(done <= total)
        })
        .unwrap();
    check(&result.0);
    assert_eq!(result.1.base_triangles, result.0.triangles.len());
    assert_eq!(result.1.finest_triangles, result.0.finest_triangles());
    result
}

/// The default: as few base triangles as keep the original within the limit.
fn fit(mesh: &TriangleMesh, options: RemeshOptions) -> (Surface, RemeshReport) {
    let result = remesh_quietly(mesh, options).unwrap();
    check(&result.0);
    result
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
