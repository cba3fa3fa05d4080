//! Base meshes on integer parameters, and their tessellation by a pure function of the parameters.
//!
//! A base vertex has three integer parameters; a lattice point of a tree with M steps per side has the integer combination of its
//! corners', in units of 1/M of a base parameter, exactly. A shape computes positions from these integers alone, so a point on a shared
//! base edge gets the same bits from every tree.

use crate::mesh::{Surface, lattice};
use rayon::prelude::*;
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// The machine has too little memory.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("no memory for {bytes} bytes")]
pub struct NoMemory {
    /// Size of the piece that could not be had.
    pub bytes: u64,
}

/// Integer parameters of a point.
pub(super) type Parameter = [i32; 3];

/// Where parameters lie in space.
pub(super) trait Shape: Sync {
    /// Position and normal of one point.
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]);

    /// Positions and normals of points `start + i * step`; must be what [`Shape::point`] answers, bit for bit.
    fn row(&self, start: Parameter, step: Parameter, positions: &mut [[f64; 3]], normals: &mut [[f32; 3]]) {
        let mut p = start;
        for (position, normal) in positions.iter_mut().zip(normals) {
            (*position, *normal) = self.point(p);
            p = std::array::from_fn(|k| p[k] + step[k]);
        }
    }
}

/// An indexed base mesh.
pub(super) struct Base {
    /// Parameters of the base vertices, in whole base steps.
    pub parameters: Vec<Parameter>,
    /// Base triangles.
    pub triangles: Vec<[u32; 3]>,
}

/// Adds `more` to `v`, or fails if there is no such memory.
pub(super) fn append<T: Copy>(v: &mut Vec<T>, more: &[T]) -> Result<(), NoMemory> {
    v.try_reserve_exact(more.len()).map_err(|_| NoMemory { bytes: size_of_val(more) as u64 })?;
    v.extend_from_slice(more);
    Ok(())
}

/// An empty vector with room for `len`, or an error if there is no such memory.
pub(super) fn reserved<T>(len: usize) -> Result<Vec<T>, NoMemory> {
    let mut v = Vec::new();
    v.try_reserve_exact(len).map_err(|_| NoMemory { bytes: (len as u64).saturating_mul(size_of::<T>() as u64) })?;
    Ok(v)
}

impl Base {
    /// `g` by `g` quads of parameters (x, z, 0), 0..=g each, counter-clockwise seen from +y. Diagonals alternate, so that no direction is favoured.
    pub(super) fn grid(g: u32) -> Result<Self, NoMemory> {
        let side = g as usize;
        let mut parameters = reserved((side + 1) * (side + 1))?;
        parameters.extend((0..=g as i32).flat_map(|z| (0..=g as i32).map(move |x| [x, z, 0])));
        let mut triangles = reserved(2 * side * side)?;
        for z in 0..g {
            for x in 0..g {
                let v = z * (g + 1) + x;
                let [a, b, c, d] = [v, v + 1, v + g + 1, v + g + 2];
                triangles.extend(if (x + z) % 2 == 0 { [[a, c, b], [d, b, c]] } else { [[b, a, d], [c, d, a]] });
            }
        }
        Ok(Self { parameters, triangles })
    }

    /// An octahedron each of whose edges has `k` steps: 8 k^2 triangles, closed, counter-clockwise from outside.
    /// Parameters are the points with |x| + |y| + |z| = k.
    pub(super) fn octahedron(k: u32) -> Result<Self, NoMemory> {
        let (n, steps) = (k as i32, k as usize);
        let mut parameters = reserved(4 * steps * steps + 2)?;
        // Ring after ring from +z to -z, each counter-clockwise from +x: the order that `index` computes.
        for z in (-n..=n).rev() {
            let r = n - z.abs();
            if r == 0 {
                parameters.push([0, 0, z]);
                continue;
            }
            parameters.extend((0..r).map(|t| [r - t, t, z]));
            parameters.extend((0..r).map(|t| [-t, r - t, z]));
            parameters.extend((0..r).map(|t| [t - r, -t, z]));
            parameters.extend((0..r).map(|t| [t, t - r, z]));
        }
        let index = |[x, y, z]: Parameter| {
            let r = n - z.abs();
            let start = if z >= 0 { (r > 0) as i32 * (1 + 2 * r * (r - 1)) } else { 4 * n * n + 1 - 2 * r * (r + 1) };
            let along = match (x > 0, y > 0) {
                _ if r == 0 => 0,
                (true, _) if y >= 0 => y,
                (false, true) => r - x,
                (false, false) if x < 0 => 2 * r - y,
                _ => 3 * r + x,
            };
            (start + along) as u32
        };
        let mut triangles = reserved(8 * steps * steps)?;
        for octant in 0..8 {
            let s = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1 } else { -1 });
            let mirrored = s[0] * s[1] * s[2] < 0;
            let at = |a: i32, b: i32| index([s[0] * (n - a - b), s[1] * a, s[2] * b]);
            let mut push = |[p, q, r]: [u32; 3]| triangles.push(if mirrored { [p, r, q] } else { [p, q, r] });
            for b in 0..n {
                for a in 0..n - b {
                    push([at(a, b), at(a + 1, b), at(a, b + 1)]);
                    if a + b + 2 <= n {
                        push([at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)]);
                    }
                }
            }
        }
        Ok(Self { parameters, triangles })
    }

    /// An octahedron cut through its middle and pulled apart along y by `straight` steps each way, with walls of quads between: closed,
    /// 8 k^2 + 16 k `straight` triangles, counter-clockwise from outside. |x| + |z| is `k` on the walls and falls to 0 towards both ends.
    pub(super) fn capsule(k: u32, straight: u32) -> Result<Self, NoMemory> {
        let mut body = Self::octahedron(k)?;
        if straight == 0 {
            return Ok(body);
        }
        let l = straight as i32;
        let (rings, rim) = (2 * straight as usize + 1, 4 * k as usize);
        let corners = std::mem::take(&mut body.parameters);
        body.parameters = reserved(corners.len() + rim * (rings - 1))?;
        let mut indices = HashMap::new();
        let mut index = |p: Parameter| {
            *indices.entry(p).or_insert_with(|| {
                body.parameters.push(p);
                body.parameters.len() as u32 - 1
            })
        };
        let mut triangles = reserved(body.triangles.len() + 2 * rim * (rings - 1))?;
        for t in body.triangles {
            let t = t.map(|v| corners[v as usize]);
            let upper = t.iter().any(|p| p[1] > 0);
            triangles.push(t.map(|[x, y, z]| index([x, if upper { y + l } else { y - l }, z])));
            // Below an edge of the upper half's rim there hangs a strip of quads; triangles of the rim have one edge on it.
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                if upper && a[1] == 0 && b[1] == 0 {
                    for y in (-l..l).rev() {
                        let [p, q] = [a, b].map(|c| [index([c[0], y + 1, c[2]]), index([c[0], y, c[2]])]);
                        // Diagonals alternate, so that no direction is favoured.
                        let even = (a[0] + y) % 2 == 0;
                        triangles.extend(if even {
                            [[q[0], p[0], p[1]], [q[0], p[1], q[1]]]
                        } else {
                            [[q[0], p[0], q[1]], [p[0], p[1], q[1]]]
                        });
                    }
                }
            }
        }
        Ok(Self { parameters: body.parameters, triangles })
    }

    /// Evaluates `shape` at the lattice points of all trees. The caller has checked the number of triangles.
    pub(super) fn tessellate(self, levels: u32, shape: &impl Shape) -> Result<Surface, NoMemory> {
        let len = lattice::len(levels);
        let points = len * self.triangles.len();
        // Asked for together first, so that a size that cannot be had is an error and not an abort; fresh zeros are then free until touched.
        let probe = (reserved::<[f64; 3]>(points)?, reserved::<[f32; 3]>(points)?);
        drop(probe);
        let (mut positions, mut normals) = (vec![[0.0f64; 3]; points], vec![[0.0f32; 3]; points]);
        let m = 1 << levels;
        positions.par_chunks_mut(len).zip_eq(normals.par_chunks_mut(len)).zip_eq(&self.triangles).for_each(|((positions, normals), t)| {
            let [p0, p1, p2] = t.map(|v| self.parameters[v as usize]);
            let step = std::array::from_fn(|k| p1[k] - p0[k]);
            let mut first = 0;
            for j in 0..=m {
                let row = first..first + (m - j + 1) as usize;
                // Products stay below 2^20: at most 2^32 triangles means at most 2^16 finest steps across a grid.
                let start = std::array::from_fn(|k| p0[k] * (m - j) + p2[k] * j);
                shape.row(start, step, &mut positions[row.clone()], &mut normals[row.clone()]);
                first = row.end;
            }
        });
        Ok(Surface {
            levels,
            base_vertices: self.parameters.len() as u32,
            triangles: self.triangles,
            positions,
            normals,
            materials: Vec::new(),
            colours: Vec::new(),
        })
    }
}

/// Unit direction of a point of an octahedron with `k` (finest) steps per edge.
///
/// A sine of each coordinate evens out the triangles: along the octahedron's edges the points become equidistant.
pub(super) fn direction(p: Parameter, k: i32) -> [f64; 3] {
    // sin(pi/2 t) to 2e-4 by its series; the length is set to one afterwards.
    let w = p.map(|c| {
        let t = f64::from(c) / f64::from(k);
        let tt = t * t;
        t * (FRAC_PI_2 + tt * (-0.645_964_1 + tt * (0.079_692_6 - tt * 0.004_681_8)))
    });
    unit(w)
}

/// `v` at length one; `v` must not be zero.
pub(super) fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    v.map(|c| c / length)
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `v` at length one in `f32`, or `fallback` if `v` is zero.
pub(super) fn normal_or(v: [f64; 3], fallback: [f64; 3]) -> [f32; 3] {
    let v = if dot(v, v) > 0.0 { unit(v) } else { fallback };
    v.map(|c| c as f32)
}
