//! Closed meshes with thin parts, tips and sharp edges: what a coarse base mesh loses first.

use lodray::mesh::TriangleMesh;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// All of them by name, each closed and manifold.
pub fn shapes() -> Vec<(&'static str, TriangleMesh)> {
    vec![
        ("knot", knot(2, 3, 0.12, 400, 14)),
        ("tight knot", knot(3, 7, 0.07, 900, 10)),
        ("horn", horn()),
        ("comb", comb()),
        ("fan", fan()),
        ("urchin", urchin()),
        ("spring", spring()),
        ("leaf", leaf()),
        ("claw", claw()),
        ("gem", gem()),
    ]
}

/// A clean mesh of quads, each two triangles; equal positions become one vertex.
fn of_quads(positions: &[[f64; 3]], quads: impl IntoIterator<Item = [u32; 4]>) -> TriangleMesh {
    let triangles: Vec<[u32; 3]> = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::from_parts(positions, &triangles, &[], vec![]).expect("a mesh")
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|v| v * v).sum::<f64>().sqrt();
    a.map(|v| v / length)
}

/// A tube of `around` sides and a radius for each place along a path of `steps`; closed to a ring, or with a tip at both ends.
fn tube(steps: u32, around: u32, is_ring: bool, path: impl Fn(f64) -> [f64; 3], radius: impl Fn(f64) -> f64) -> TriangleMesh {
    let mut positions = Vec::new();
    let count = if is_ring { steps } else { steps + 1 };
    for i in 0..count {
        let t = f64::from(i) / f64::from(steps);
        let (p, q) = (path(t), path(t + 1e-4));
        let along = unit(std::array::from_fn(|k| q[k] - p[k]));
        // Away from the axis that the path never runs along for long.
        let side = unit(cross(along, if along[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] }));
        let up = cross(side, along);
        for j in 0..around {
            let (s, c) = (TAU * f64::from(j) / f64::from(around)).sin_cos();
            positions.push(std::array::from_fn(|k| p[k] + radius(t) * (c * side[k] + s * up[k])));
        }
    }
    let at = |i: u32, j: u32| (i % count) * around + j % around;
    let sides = (0..steps).flat_map(|i| (0..around).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let mut triangles: Vec<[u32; 3]> = sides.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    if !is_ring {
        let tip = positions.len() as u32;
        positions.extend([path(0.0), path(1.0)]);
        for j in 0..around {
            triangles.push([tip, at(0, j), at(0, j + 1)]);
            triangles.push([tip + 1, at(steps, j + 1), at(steps, j)]);
        }
    }
    TriangleMesh::from_parts(&positions, &triangles, &[], vec![]).expect("a tube")
}

/// A torus knot's tube.
fn knot(p: u32, q: u32, radius: f64, steps: u32, around: u32) -> TriangleMesh {
    let path = move |t: f64| {
        let (a, b) = (TAU * f64::from(p) * t, TAU * f64::from(q) * t);
        let r = 1.0 + 0.4 * b.cos();
        [r * a.cos(), r * a.sin(), 0.4 * b.sin()]
    };
    tube(steps, around, true, path, |_| radius)
}

/// A spiral that runs out to a point.
fn horn() -> TriangleMesh {
    tube(
        260,
        20,
        false,
        |t| [(1.0 - 0.6 * t) * (7.0 * t).cos(), (1.0 - 0.6 * t) * (7.0 * t).sin(), 1.8 * t],
        |t| 0.32 * (1.0 - t).powf(1.3) + 0.002,
    )
}

fn spring() -> TriangleMesh {
    tube(700, 8, false, |t| [(60.0 * t).cos(), (60.0 * t).sin(), 2.5 * t], |_| 0.06)
}

/// The surface of cells of a grid, `size` apart; cells that touch do so by whole faces.
fn cells(filled: impl Fn(i32, i32, i32) -> bool, extent: [i32; 3], size: [f64; 3]) -> TriangleMesh {
    let mut positions = Vec::new();
    let mut number = HashMap::new();
    let mut quads = Vec::new();
    let mut vertex = |p: [i32; 3]| {
        *number.entry(p).or_insert_with(|| {
            positions.push(std::array::from_fn(|k| f64::from(p[k]) * size[k]));
            positions.len() as u32 - 1
        })
    };
    for (x, y, z) in (0..extent[0]).flat_map(|x| (0..extent[1]).flat_map(move |y| (0..extent[2]).map(move |z| (x, y, z)))) {
        if !filled(x, y, z) {
            continue;
        }
        for axis in 0..3 {
            for (side, step) in [(0, -1), (1, 1)] {
                let mut next = [x, y, z];
                next[axis] += step;
                if filled(next[0], next[1], next[2]) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |du: i32, dv: i32| {
                    let mut p = [x, y, z];
                    (p[axis], p[u], p[v]) = (p[axis] + side, p[u] + du, p[v] + dv);
                    p
                };
                let ring = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                let ring = if side == 1 { ring } else { [ring[0], ring[3], ring[2], ring[1]] };
                quads.push(ring.map(&mut vertex));
            }
        }
    }
    of_quads(&positions, quads)
}

/// A bar with thirteen long thin teeth.
fn comb() -> TriangleMesh {
    cells(
        |x, y, z| (0..50).contains(&x) && (0..24).contains(&y) && (0..2).contains(&z) && (y < 4 || x % 4 < 2),
        [50, 24, 2],
        [0.1, 0.12, 0.05],
    )
}

/// A closed surface given by its distance from the origin.
fn star(n: u32, place: impl Fn([f64; 3]) -> [f64; 3]) -> TriangleMesh {
    let mut positions = Vec::new();
    let mut number = HashMap::new();
    let mut quads = Vec::new();
    for face in 0..6 {
        let mut vertex = |i: u32, j: u32| {
            let grid = |i: u32| 2 * i as i32 - n as i32;
            let (m, u, v) = (n as i32, grid(i), grid(j));
            let key = [[m, u, v], [-m, v, u], [v, m, u], [u, -m, v], [u, v, m], [v, u, -m]][face];
            *number.entry(key).or_insert_with(|| {
                // Evenly spread over the sphere.
                positions.push(place(unit(key.map(|c| (f64::from(c) / f64::from(n) * PI / 4.0).tan()))));
                positions.len() as u32 - 1
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            quads.push([vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
        }
    }
    of_quads(&positions, quads)
}

/// Nine thin twisted blades around an axis.
fn fan() -> TriangleMesh {
    star(90, |d| {
        let blade = (4.5 * (d[1].atan2(d[0]) + 0.9 * d[2])).cos().powi(2).powi(12);
        let flat = (1.0 - d[2] * d[2]).powi(3);
        d.map(|c| c * (0.25 + 0.9 * blade * flat))
    })
}

/// A ball with twenty long spikes.
fn urchin() -> TriangleMesh {
    let spikes: Vec<[f64; 3]> = (0..20)
        .map(|k| {
            let (z, a) = (1.0 - (2.0 * f64::from(k) + 1.0) / 20.0, f64::from(k) * PI * (3.0 - 5f64.sqrt()));
            let r = (1.0 - z * z).sqrt();
            [r * a.cos(), r * a.sin(), z]
        })
        .collect();
    star(80, |d| {
        let near = spikes.iter().map(|s| (0..3).map(|k| s[k] * d[k]).sum::<f64>()).fold(-1.0, f64::max);
        d.map(|c| c * (0.4 + 0.9 * (40.0 * (near - 1.0)).exp()))
    })
}

/// A bent sheet with two sides, a two-hundredth of its length apart.
fn leaf() -> TriangleMesh {
    star(48, |d| {
        let (x, y) = (2.0 * d[0], d[1]);
        [x, y, 0.35 * (1.5 * x).sin() * (1.0 - 0.5 * y * y) + 0.01 * d[2]]
    })
}

/// A palm with five thin bent fingers.
fn claw() -> TriangleMesh {
    star(90, |d| {
        let angle = d[1].atan2(d[0]);
        let finger = if d[0] > -0.6 { (5.0 * angle / 1.6).cos().powi(2).powi(8) * (1.0 - d[2] * d[2]).powi(6) } else { 0.0 };
        let r = 0.35 + finger;
        [r * d[0], r * d[1], (0.5 * r).min(0.2) * d[2] + 0.5 * finger * finger]
    })
}

/// A cut stone: few faces and sharp edges.
fn gem() -> TriangleMesh {
    star(2, |d| d.map(|c| c * 1.5 / (d[0].abs().powi(3) + d[1].abs().powi(3) + d[2].abs().powi(3)).cbrt()))
}
