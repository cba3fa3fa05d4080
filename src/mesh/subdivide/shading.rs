//! Points that several trees have, and normals across them.

use super::super::clean::unit;
use super::super::{SharedEdges, Surface, lattice};
use glam::DVec3;
use rayon::prelude::*;

/// Points that several trees have, as places among all points of a surface, one group after the other.
#[derive(Default)]
pub(in crate::mesh) struct SharedPoints {
    places: Vec<usize>,
    /// Where each group ends.
    ends: Vec<usize>,
}

impl SharedPoints {
    /// Those of base triangles that are split `levels` times: corners in the order of base vertices, then sides in that of edges.
    pub fn new(triangles: &[[u32; 3]], levels: u32) -> Self {
        let len = lattice::len(levels);
        let roots = lattice::root(levels).map(|at| lattice::index(levels, at));
        let mut corners: Vec<(u32, usize)> =
            triangles.iter().enumerate().flat_map(|(tree, t)| [0, 1, 2].map(|k| (t[k], tree * len + roots[k]))).collect();
        corners.par_sort_unstable();
        let mut shared = Self::default();
        for group in corners.chunk_by(|a, b| a.0 == b.0) {
            shared.push(group.iter().map(|&(_, at)| at));
        }
        for uses in SharedEdges::new(triangles).edges() {
            for place in 1..1 << levels {
                shared.push(uses.iter().map(|of| of.tree as usize * len + lattice::index(levels, of.point(levels, place))));
            }
        }
        shared
    }

    /// The groups.
    pub fn iter(&self) -> impl Iterator<Item = &[usize]> {
        let begins = std::iter::once(0).chain(self.ends.iter().copied());
        begins.zip(&self.ends).map(|(begin, &end)| &self.places[begin..end])
    }

    /// Of each group those together that have one normal.
    pub fn with_one_normal(&self, normals: &[[f32; 3]]) -> Self {
        let key = |&at: &usize| (normals[at].map(f32::to_bits), at);
        let mut alike = Self::default();
        for group in self.iter() {
            let mut group = group.to_vec();
            group.sort_unstable_by_key(key);
            for own in group.chunk_by(|&a, &b| normals[a] == normals[b]) {
                alike.push(own.iter().copied());
            }
        }
        alike
    }

    /// A group, if it has two or more.
    fn push(&mut self, group: impl Iterator<Item = usize>) {
        let begun = self.places.len();
        self.places.extend(group);
        if self.places.len() > begun + 1 {
            self.ends.push(self.places.len());
        } else {
            self.places.truncate(begun);
        }
    }
}

/// Gives each point the normal of the finest triangles around it, by their area; points of a group have one together. Where triangles run against each other normals stay.
pub(in crate::mesh) fn shade(surface: &mut Surface, together: &SharedPoints) {
    let (levels, len) = (surface.levels, lattice::len(surface.levels));
    let finest: Vec<[usize; 3]> =
        (0..1 << (2 * levels)).map(|node| lattice::node(levels, levels, node).map(|place| lattice::index(levels, place))).collect();
    // Areas of very small and very large meshes stay within the range of numbers.
    let scale = 1.0 / surface.positions.par_iter().flatten().map(|c| c.abs()).reduce(|| f64::MIN_POSITIVE, f64::max);
    let mut sums = vec![DVec3::ZERO; surface.positions.len()];
    sums.par_chunks_mut(len).zip(surface.positions.par_chunks(len)).for_each(|(sums, points)| {
        for places in &finest {
            let [a, b, c] = places.map(|at| DVec3::from_array(points[at]) * scale);
            let facet = (b - a).cross(c - a);
            places.iter().for_each(|&at| sums[at] += facet);
        }
    });
    for group in together.iter() {
        let sum: DVec3 = group.iter().map(|&at| sums[at]).sum();
        group.iter().for_each(|&at| sums[at] = sum);
    }
    surface.normals.par_iter_mut().zip(&sums).for_each(|(normal, sum)| {
        let new = unit(sum.to_array());
        if new != [0.0; 3] {
            *normal = new;
        }
    });
}
