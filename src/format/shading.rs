//! Smooth shading normals of a hierarchy: those of the finest facets around a vertex, by their area.

use super::{Scene, normal};
use crate::mesh::{Hierarchy, lattice};
use rayon::prelude::*;

/// Which points on borders of trees have one normal, and where each lattice point's facets lie.
pub(super) struct SmoothShading {
    /// Storage indices of the points on a tree's border.
    border: Vec<u32>,
    /// Those of points with one normal side by side, each as a place among the border points of all trees; where each group begins, and where the last ends.
    points: Vec<u32>,
    starts: Vec<usize>,
}

impl SmoothShading {
    /// Of a scene: points of one vertex at which trees have the same normal keep one in common. `numbers` are those of the vertices of all points.
    pub fn of(scene: &Scene, numbers: &[u32]) -> Self {
        let (levels, len) = (scene.levels(), lattice::len(scene.levels()));
        let m = 1u32 << levels;
        let mut border: Vec<u32> =
            (0..m).flat_map(|k| [(k, 0), (0, m - k), (m - k, k)]).map(|p| lattice::index(levels, p) as u32).collect();
        border.sort_unstable();
        let normals = scene.normals();
        let at = |place: u32| place as usize / border.len() * len + border[place as usize % border.len()] as usize;
        // Fewer than points, which are numbered in 32 bits.
        let mut keys: Vec<(u32, u32, u32)> = (0..(scene.trees() * border.len()) as u32)
            .into_par_iter()
            .map(|place| (numbers[at(place)], normals[at(place)], place))
            .collect();
        keys.par_sort_unstable();
        let mut starts = vec![0];
        starts.extend(keys.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).scan(0, |end, group| {
            *end += group.len();
            Some(*end)
        }));
        Self { border, points: keys.into_iter().map(|key| key.2).collect(), starts }
    }

    /// Writes the normals of all points.
    pub fn write(&self, h: &Hierarchy, out: &mut [u32]) {
        let len = lattice::len(h.levels);
        let mut at_border = vec![[0.0; 3]; h.triangles.len() * self.border.len()];
        let trees = h.points.par_chunks(len).zip(out.par_chunks_mut(len)).zip(at_border.par_chunks_mut(self.border.len()));
        trees.for_each_init(Vec::new, |sums, ((points, out), at_border)| {
            facets(h.levels, points, sums);
            for (out, sum) in out.iter_mut().zip(&*sums) {
                *out = code(*sum, [0.0; 3]);
            }
            for (to, &at) in at_border.iter_mut().zip(&self.border) {
                *to = sums[at as usize];
            }
        });
        let all: Vec<[f64; 3]> = self
            .starts
            .windows(2)
            .map(|ends| {
                let group = self.points[ends[0]..ends[1]].iter().map(|&place| at_border[place as usize]);
                group.fold([0.0; 3], |sum, own| std::array::from_fn(|k| sum[k] + own[k]))
            })
            .collect();
        for (ends, all) in self.starts.windows(2).zip(all) {
            for &place in &self.points[ends[0]..ends[1]] {
                let (tree, own) = (place as usize / self.border.len(), place as usize % self.border.len());
                out[tree * len + self.border[own] as usize] = code(all, at_border[place as usize]);
            }
        }
    }
}

/// The code of the first of these that has a direction: facets that run against each other leave nothing, and a tree may be a point.
fn code(all: [f64; 3], own: [f64; 3]) -> u32 {
    // As fractions of the largest component, whatever its size: f32 holds those.
    let part = |v: [f64; 3]| {
        let most = v.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        if most > 0.0 { v.map(|c| (c / most) as f32) } else { [0.0; 3] }
    };
    let found = [part(all), part(own), [0.0, 0.0, 1.0]].into_iter().find_map(normal::encode_normal);
    found.unwrap_or_default()
}

/// For each point of a tree the sum of the normals of its finest triangles around it, as long as twice their area.
fn facets(levels: u32, points: &[[i32; 3]], sums: &mut Vec<[f64; 3]>) {
    sums.clear();
    sums.resize(points.len(), [0.0; 3]);
    let m = 1usize << levels;
    let mut row = 0;
    for j in 0..m {
        let above = row + m + 1 - j;
        for i in 0..m - j {
            let (a, right, up) = (row + i, row + i + 1, above + i);
            facet(points, sums, [a, right, up]);
            if i + 1 < m - j {
                facet(points, sums, [right, up + 1, up]);
            }
        }
        row = above;
    }
}

fn facet(points: &[[i32; 3]], sums: &mut [[f64; 3]], corners: [usize; 3]) {
    let [a, b, c] = corners.map(|k| points[k].map(f64::from));
    let (e, f): ([f64; 3], [f64; 3]) = (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
    let normal = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    for corner in corners {
        (0..3).for_each(|k| sums[corner][k] += normal[k]);
    }
}
