//! Small base meshes and their displacement: what the lab's models are made of.

use crate::mesh::{Surface, lattice};
use crate::num::Random;

/// An indexed base mesh.
pub type Base = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Where a lattice point lies: its place on the flat base triangle, and a number that is the same in all trees that share the point.
#[derive(Clone, Copy)]
pub struct Place {
    /// The weighted mean of the base vertices.
    pub flat: [f64; 3],
    /// Level on which the point enters; 0 for base vertices.
    pub level: u32,
    key: u64,
}

impl Place {
    /// Three numbers in -1..1 that belong to the point.
    pub fn noise(&self, seed: u64) -> [f64; 3] {
        let mut random = Random::of(seed, self.key);
        std::array::from_fn(|_| random.signed())
    }
}

/// The surface of `levels` splits over a base mesh whose lattice points `displace` places.
pub fn surface(levels: u32, (vertices, triangles): &Base, displace: impl Fn(Place) -> [f64; 3]) -> Surface {
    let m = 1u32 << levels;
    let mut positions = Vec::with_capacity(triangles.len() * lattice::len(levels));
    for t in triangles {
        for j in 0..=m {
            for i in 0..=m - j {
                // In the order of their indices, so that trees agree bit for bit on what they share; weights of 0 do not name the point.
                let mut parts = [(t[0], m - i - j), (t[1], i), (t[2], j)];
                parts.sort_unstable();
                let (mut flat, mut key) = ([0.0; 3], 0u64);
                for (v, weight) in parts.into_iter().filter(|part| part.1 > 0) {
                    let part = f64::from(weight) / f64::from(m);
                    flat = std::array::from_fn(|k| flat[k] + vertices[v as usize][k] * part);
                    key = Random::of(key, u64::from(v) << 32 | u64::from(weight)).next();
                }
                positions.push(displace(Place { flat, level: lattice::level_of(levels, (i, j)), key }));
            }
        }
    }
    Surface {
        levels,
        base_vertices: vertices.len() as u32, // a few
        triangles: triangles.clone(),
        normals: vec![[0.0, 0.0, 1.0]; positions.len()],
        positions,
        ..Surface::default()
    }
}

/// No displacement.
pub fn flat(place: Place) -> [f64; 3] {
    place.flat
}

/// On the unit sphere, then off it by noise of `roughness` at level 0, half of it at level 1, and so on.
pub fn bumpy(roughness: f64, seed: u64) -> impl Fn(Place) -> [f64; 3] {
    move |place| {
        let length = place.flat.iter().map(|v| v * v).sum::<f64>().sqrt().max(1e-9);
        let (noise, bump) = (place.noise(seed), roughness / f64::from(1u32 << place.level));
        std::array::from_fn(|k| place.flat[k] / length + bump * noise[k])
    }
}

/// A shape seen through a stretch and an offset.
pub fn stretched(by: [f64; 3], offset: [f64; 3], shape: impl Fn(Place) -> [f64; 3]) -> impl Fn(Place) -> [f64; 3] {
    move |place| {
        let p = shape(place);
        std::array::from_fn(|k| p[k] * by[k] + offset[k])
    }
}

/// An octahedron: 8 triangles, closed.
pub fn octahedron() -> Base {
    let v = vec![[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    (v, vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
}

/// A tetrahedron: 4 triangles, closed.
pub fn tetrahedron() -> Base {
    let v = vec![[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    (v, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
}

/// A cube: 12 triangles, closed; opposite faces are split along different diagonals.
pub fn cube() -> Base {
    let corner = |i: u32| [0, 1, 2].map(|k| if i >> k & 1 == 0 { -1.0 } else { 1.0 });
    let quads = [[0, 2, 3, 1], [5, 7, 6, 4], [0, 1, 5, 4], [3, 2, 6, 7], [0, 4, 6, 2], [3, 7, 5, 1]];
    let split = |q: [u32; 4]| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]];
    ((0..8).map(corner).collect(), quads.into_iter().flat_map(split).collect())
}

/// Two poles and a rim of `count` vertices between them: 2 `count` triangles, closed. Slivers where there are many.
pub fn bipyramid(count: u32) -> Base {
    let mut v = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    v.extend((0..count).map(|k| {
        let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
        [angle.cos(), angle.sin(), 0.0]
    }));
    let rim = |k: u32| 2 + k % count;
    (v, (0..count).flat_map(|k| [[0, rim(k), rim(k + 1)], [1, rim(k + 1), rim(k)]]).collect())
}

/// A square of 2 `side`^2 triangles in the plane z = 0, open.
pub fn sheet(side: u32) -> Base {
    let n = side + 1;
    let at = |v: u32| 2.0 * f64::from(v) / f64::from(side) - 1.0;
    let triangles = (0..side * side).flat_map(|q| {
        let a = q / side * n + q % side;
        [[a, a + 1, a + n], [a + 1, a + n + 1, a + n]]
    });
    ((0..n * n).map(|v| [at(v % n), at(v / n), 0.0]).collect(), triangles.collect())
}

/// Five triangles around one edge, one of them turned, and a loose one.
pub fn fan() -> Base {
    let v = vec![
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.2],
        [-1.0, 0.0, -0.2],
        [0.0, -1.0, 0.0],
        [0.8, 0.8, 0.8],
        [0.0; 3],
    ];
    (v, vec![[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 1, 5], [0, 1, 7], [2, 3, 6]])
}

/// Several base meshes as one, each stretched and moved.
pub fn together(parts: impl IntoIterator<Item = (Base, f64, [f64; 3])>) -> Base {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for ((v, t), scale, offset) in parts {
        let first = vertices.len() as u32; // a few
        vertices.extend(v.iter().map(|p| -> [f64; 3] { std::array::from_fn(|k| p[k] * scale + offset[k]) }));
        triangles.extend(t.iter().map(|t| t.map(|i| i + first)));
    }
    (vertices, triangles)
}
