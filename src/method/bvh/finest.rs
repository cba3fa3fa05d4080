//! The full-resolution triangles of a hierarchy.

use crate::bvh::build::Prim;
use crate::bvh::{Box32, BvhError, check_count};
use crate::mesh::{Hierarchy, lattice};
use crate::num::{COORD_LIMIT, MAX_LEVELS};
use rayon::prelude::*;

/// The full-resolution triangles of a hierarchy.
pub(super) struct Finest<'a> {
    pub points: &'a [[i32; 3]],
    pub trees: usize,
    pub levels: u32,
    /// Points per tree.
    pub stride: usize,
    /// Lattice indices of the corners of every triangle of one tree: the same for all.
    corners: Vec<[u32; 3]>,
}

impl<'a> Finest<'a> {
    pub fn new(hierarchy: &'a Hierarchy) -> Result<Self, BvhError> {
        let levels = hierarchy.levels;
        if levels > MAX_LEVELS {
            return Err(BvhError::Levels(levels));
        }
        let trees = hierarchy.triangles.len();
        let stride = lattice::len(levels);
        check_count((trees as u64).saturating_mul(1 << (2 * levels)))?;
        if hierarchy.points.len() != trees * stride {
            return Err(BvhError::Points { points: hierarchy.points.len(), expected: (trees * stride) as u64 });
        }
        let too_far = |p: &[i32; 3]| p.iter().any(|c| c.unsigned_abs() > COORD_LIMIT.unsigned_abs());
        if let Some(bad) = hierarchy.points.par_iter().position_first(too_far) {
            return Err(BvhError::IllegalBox(bad / stride));
        }
        let mut corners = Vec::with_capacity(1 << (2 * levels));
        list_corners(levels, levels, lattice::root(levels), &mut corners);
        Ok(Self { points: &hierarchy.points, trees, levels, stride, corners })
    }

    /// Number of triangles, at most 2^28.
    pub fn count(&self) -> usize {
        self.trees << (2 * self.levels)
    }

    /// Indices of the corners of a triangle among all points, which number fewer than 2^30.
    #[inline]
    pub fn corners(&self, id: u32) -> [u32; 3] {
        let per_tree = 2 * self.levels;
        let first = (id >> per_tree) * self.stride as u32;
        self.corners[(id & ((1 << per_tree) - 1)) as usize].map(|c| first + c)
    }

    #[inline]
    pub fn triangle(&self, id: u32) -> [[i32; 3]; 3] {
        self.corners(id).map(|c| self.points[c as usize])
    }

    pub fn primitives(&self) -> Vec<Prim> {
        (0..self.count() as u32).into_par_iter().map(|id| Prim::new(&Box32::of_triangle(self.triangle(id)), id)).collect()
    }
}

/// Appends the corners of the finest triangles below a triangle that `splits` splits remain to.
fn list_corners(levels: u32, splits: u32, p: [lattice::LatticePoint; 3], out: &mut Vec<[u32; 3]>) {
    if splits == 0 {
        return out.push(p.map(|c| lattice::index(levels, c) as u32)); // below 2^20
    }
    for k in 0..4 {
        list_corners(levels, splits - 1, lattice::child(p, k), out);
    }
}
