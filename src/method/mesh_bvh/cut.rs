//! Triangles of a hierarchy that cover it once: those of the finest level, of a coarser one, or each where it serves.
//!
//! A triangle's id is that of the first finest triangle below it in the lower 28 bits, and how many levels it lies above the finest in the upper four: that of a
//! finest triangle is its number.

use crate::bvh::build::Prim;
use crate::bvh::{Box32, BvhError, check_count};
use crate::mesh::{Hierarchy, lattice};
use crate::method::TriangleId;
use crate::num::{COORD_LIMIT, MAX_LEVELS};
use rayon::prelude::*;

/// Bits of the number of a finest triangle; `check_count` sees that they suffice.
const NUMBER_BITS: u32 = 28;

/// The id of a triangle of a hierarchy of `levels` splits, which has its level.
pub fn cut_id(levels: u32, of: TriangleId) -> u32 {
    let above = levels - of.level;
    above << NUMBER_BITS | of.tree << (2 * levels) | of.node << (2 * above)
}

/// The triangle of an id of [`cut_id`] with the same `levels`.
#[inline(always)]
pub fn cut_triangle(levels: u32, id: u32) -> TriangleId {
    let (above, number) = (id >> NUMBER_BITS, id & ((1 << NUMBER_BITS) - 1));
    let per_tree = 2 * levels;
    TriangleId { tree: number >> per_tree, level: levels - above, node: (number & ((1 << per_tree) - 1)) >> (2 * above) }
}

/// All triangles of a level that the hierarchy has, by their ids.
pub fn level_ids(hierarchy: &Hierarchy, level: u32) -> Vec<u32> {
    let triangles = (0..).take(hierarchy.triangles.len());
    let ids = triangles.flat_map(|tree| (0..1 << (2 * level)).map(move |node| TriangleId { tree, level, node }));
    ids.map(|id| cut_id(hierarchy.levels, id)).collect()
}

/// Whether BVHs can be built over triangles of a hierarchy.
///
/// # Errors
/// No or too many triangles, too many levels, points missing or beyond the coordinate limit.
pub fn check_hierarchy(hierarchy: &Hierarchy) -> Result<(), BvhError> {
    Corners::new(hierarchy).map(drop)
}

/// The triangles of a hierarchy, on every level.
pub(in crate::method) struct Corners<'a> {
    pub points: &'a [[i32; 3]],
    pub trees: usize,
    pub levels: u32,
    /// Points per tree.
    pub stride: usize,
    /// Of each level the lattice indices of the corners of every triangle of one tree: the same for all.
    corners: Vec<Vec<[u32; 3]>>,
}

impl<'a> Corners<'a> {
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
        let corners = (0..=levels).map(|level| {
            let mut corners = Vec::with_capacity(1 << (2 * level));
            list_corners(levels, level, lattice::root(levels), &mut corners);
            corners
        });
        Ok(Self { points: &hierarchy.points, trees, levels, stride, corners: corners.collect() })
    }

    /// Number of the finest triangles, at most 2^28.
    pub fn count(&self) -> usize {
        self.trees << (2 * self.levels)
    }

    /// Whether triangles of these ids cover as much as the finest ones.
    pub fn are_covered_by(&self, ids: &[u32]) -> bool {
        are_of_one_hierarchy(self.levels, ids) && covered(ids) == self.count()
    }

    /// Indices of the corners of a triangle among all points, which number fewer than 2^30.
    #[inline]
    pub fn of(&self, id: u32) -> [u32; 3] {
        let TriangleId { tree, level, node } = cut_triangle(self.levels, id);
        let first = tree * self.stride as u32;
        self.corners[level as usize][node as usize].map(|c| first + c)
    }

    #[inline]
    pub fn triangle(&self, id: u32) -> [[i32; 3]; 3] {
        self.of(id).map(|c| self.points[c as usize])
    }

    /// Whether triangles of these ids cover each finest triangle once.
    pub fn are_covered_once_by(&self, ids: &[u32]) -> bool {
        let number = |id: u32| id & ((1 << NUMBER_BITS) - 1);
        let mut sorted = ids.to_vec();
        sorted.par_sort_unstable_by_key(|&id| number(id));
        // Where one ends the next begins.
        let meet = sorted.windows(2).all(|two| number(two[0]) + (1 << (2 * (two[0] >> NUMBER_BITS))) == number(two[1]));
        self.are_covered_by(ids) && meet
    }

    /// What a BVH of these triangles is built of.
    pub fn primitives(&self, ids: impl IntoParallelIterator<Item = u32, Iter: IndexedParallelIterator>) -> Vec<Prim> {
        ids.into_par_iter().map(|id| Prim::new(&Box32::of_triangle(self.triangle(id)), id)).collect()
    }
}

/// How many finest triangles lie below these.
fn covered(ids: &[u32]) -> usize {
    ids.par_iter().map(|id| 1 << (2 * (id >> NUMBER_BITS))).sum()
}

/// Whether these are ids of a hierarchy of `levels` splits that has no more triangles than they cover.
pub(super) fn are_of_one_hierarchy(levels: u32, ids: &[u32]) -> bool {
    let is_legal = |&id: &u32| levels <= MAX_LEVELS && id >> NUMBER_BITS <= levels && cut_id(levels, cut_triangle(levels, id)) == id;
    ids.par_iter().all(is_legal) && {
        let count = covered(ids);
        ids.par_iter().all(|id| ((id & ((1 << NUMBER_BITS) - 1)) as usize) < count)
    }
}

/// Appends the corners of the triangles that `splits` splits make of a triangle.
fn list_corners(levels: u32, splits: u32, p: [lattice::LatticePoint; 3], out: &mut Vec<[u32; 3]>) {
    if splits == 0 {
        return out.push(p.map(|c| lattice::index(levels, c) as u32)); // below 2^20
    }
    for k in 0..4 {
        list_corners(levels, splits - 1, lattice::child(p, k), out);
    }
}
