//! The full-resolution mesh in `f64`: the truth for image and geometric error.
//!
//! Candidates come from an `f32` hierarchy over patches of up to 16 triangles; what decides is a watertight test in `f64`
//! (Woop, Benthin, Wald 2013): neighbours compute the same edge functions, and an edge belongs to both.
//!
//! Why no candidate is lost: the origin is first moved to the model's box in `f64`, and lengths are taken in half widths (2^31 units), so that
//! all coordinates are below 2 and all distances below 8. Then `f32` errs by less than 2^-19 in position: 2^-24 relative in
//! coordinates, directions, differences and products each, and 2^-23 of direction where the crate bounds reciprocals. Patches are enlarged by `PAD` = 2^-16.

use crate::mesh::{Hierarchy, lattice};
use glam::Vec3A;
use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, builder::build_bvh2},
    ploc::{PlocSearchDistance, SortPrecision},
    ray::{Ray, RayHit},
};
use std::time::Duration;

/// Splits below a patch's own triangle, at most.
const PATCH_SPLITS: u32 = 2;
/// Enlargement of patches, in half widths.
const PAD: f32 = 1.0 / 65_536.0;
/// Units per half width.
const HALF_WIDTH: f64 = 2_147_483_648.0;
/// Enlargement of the model's box before the origin is moved to it, in units.
const MARGIN: f64 = 4096.0;

/// The closest hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceHit {
    /// Distance from the origin along the unit direction, in units.
    pub t: f64,
    /// Base triangle.
    pub tree: u32,
    /// Full-resolution triangle within the tree.
    pub full_node: u32,
    /// Barycentrics on it.
    pub bary: [f64; 3],
    /// The ray runs against the normal (p1 - p0) x (p2 - p0), as in [`super::ExactHit::front`].
    pub front: bool,
}

impl ReferenceHit {
    /// Closer; or as close and in front, where the other is a back face; or of the same side too and of smaller id.
    fn before(&self, other: &Self) -> bool {
        (self.t, !self.front, self.tree, self.full_node) < (other.t, !other.front, other.tree, other.full_node)
    }
}

/// The full-resolution mesh of a model.
pub struct Reference {
    levels: u32,
    trees: u32,
    points: Vec<[i32; 3]>,
    lo: [f64; 3],
    hi: [f64; 3],
    bvh: Bvh2,
}

/// A ray moved to the model's box, prepared for the triangle test.
struct Moved {
    origin: [f64; 3],
    direction: [f64; 3],
    /// How far it was moved.
    advance: f64,
    /// The axis of the direction's largest component, then the two after it.
    axes: [usize; 3],
    /// Shear that makes the direction parallel to the first of these axes.
    shear: [f64; 2],
}

impl Reference {
    /// Number of splits N of the hierarchy.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Copies the full-resolution vertices and builds the hierarchy over them; deterministic.
    pub fn new(h: &Hierarchy) -> Self {
        let limits = |start: f64, pick: fn(f64, f64) -> f64| -> [f64; 3] {
            std::array::from_fn(|k| h.points.iter().fold(start, |v, p| pick(v, f64::from(p[k]))))
        };
        let (lo, hi) = (limits(f64::INFINITY, f64::min), limits(f64::NEG_INFINITY, f64::max));
        let mut reference = Self {
            levels: h.levels,
            trees: h.triangles.len() as u32, // base triangles are counted in 32 bits
            points: h.points.clone(),
            lo,
            hi,
            bvh: Bvh2::default(),
        };
        let patches = (h.triangles.len() as u32) << (2 * reference.patch_level());
        let boxes: Vec<Aabb> = (0..patches).map(|patch| reference.patch_box(patch)).collect();
        let quick = BvhBuildParams {
            pre_split: false,
            ploc_search_distance: PlocSearchDistance::Low,
            search_depth_threshold: 2,
            reinsertion_batch_ratio: 0.0,
            post_collapse_reinsertion_batch_ratio_multiplier: 0.0,
            sort_precision: SortPrecision::U64,
            max_prims_per_leaf: 1,
            collapse_traversal_cost: 1.0,
        };
        if !boxes.is_empty() {
            reference.bvh = build_bvh2(&boxes, quick, &mut Duration::default());
        }
        reference
    }

    /// The closest hit of the ray from `origin` along `direction` (any length but 0), in units.
    pub fn trace(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<ReferenceHit> {
        self.trace_between(origin, direction, [0.0, f64::INFINITY])
    }

    /// The same among hits at distances from the first to the second of `range`.
    pub fn trace_between(&self, origin: [f64; 3], direction: [f64; 3], range: [f64; 2]) -> Option<ReferenceHit> {
        let ray = self.moved(origin, direction)?;
        let single = |v: [f64; 3], scale: f64| Vec3A::from_array(v.map(|x| (x / scale) as f32)); // rounding covered by PAD
        let search = Ray::new(single(ray.origin, HALF_WIDTH), single(ray.direction, 1.0), 0.0, f32::MAX);
        let mut best = None;
        self.bvh.ray_traverse(search, &mut RayHit::none(), |_, at| {
            self.test_patch(self.bvh.primitive_indices[at], &ray, range, &mut best);
            // How far to search on: a little beyond the best hit, so that rounding cannot hide an equal one.
            best.map_or(f32::INFINITY, |b: ReferenceHit| ((b.t - ray.advance) / HALF_WIDTH) as f32 + PAD)
        });
        best
    }

    /// Corners of a full-resolution triangle in units.
    pub fn corners(&self, tree: u32, full_node: u32) -> [[i32; 3]; 3] {
        let first = tree as usize * lattice::len(self.levels);
        lattice::node(self.levels, self.levels, full_node).map(|p| self.points[first + lattice::index(self.levels, p)])
    }

    /// The same, testing every triangle.
    pub fn trace_brute_force(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<ReferenceHit> {
        let ray = self.moved(origin, direction)?;
        let mut best = None;
        for patch in 0..self.trees << (2 * self.patch_level()) {
            self.test_patch(patch, &ray, [0.0, f64::INFINITY], &mut best);
        }
        best
    }

    fn patch_level(&self) -> u32 {
        self.levels.saturating_sub(PATCH_SPLITS)
    }

    /// The tree and node of a patch, and its lattice: a corner and the two steps along its sides.
    fn patch(&self, patch: u32) -> (u32, u32, impl Fn((u32, u32)) -> [i32; 3]) {
        let level = self.patch_level();
        let (tree, node) = (patch >> (2 * level), patch & ((1 << (2 * level)) - 1));
        let [p0, p1, p2] = lattice::node(self.levels, level, node).map(|(i, j)| (i as i32, j as i32)); // at most 2^10
        let shift = self.levels - level;
        let step = |p: (i32, i32)| ((p.0 - p0.0) >> shift, (p.1 - p0.1) >> shift);
        let (e1, e2) = (step(p1), step(p2));
        let points = &self.points[tree as usize * lattice::len(self.levels)..][..lattice::len(self.levels)];
        let at = move |(i, j): (u32, u32)| {
            let (i, j) = (i as i32, j as i32); // at most 4
            let (x, y) = (p0.0 + i * e1.0 + j * e2.0, p0.1 + i * e1.1 + j * e2.1);
            points[lattice::index(self.levels, (x as u32, y as u32))] // inside the lattice: not negative
        };
        (tree, node, at)
    }

    fn patch_box(&self, patch: u32) -> Aabb {
        let splits = self.levels.min(PATCH_SPLITS);
        let (_, _, at) = self.patch(patch);
        let m = 1 << splits;
        let mut bounds = Aabb::empty();
        for j in 0..=m {
            for i in 0..=m - j {
                bounds.extend(Vec3A::from_array(at((i, j)).map(|v| (f64::from(v) / HALF_WIDTH) as f32)));
            }
        }
        Aabb::new(bounds.min - PAD, bounds.max + PAD)
    }

    /// The ray with a unit direction, moved to where it enters the enlarged box; `None` if it misses that, or makes no sense.
    fn moved(&self, origin: [f64; 3], direction: [f64; 3]) -> Option<Moved> {
        let largest = direction.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        // Scaled first: the square of a tiny or huge direction must not leave the range of f64.
        let scaled = direction.map(|v| v / largest);
        let length = scaled.iter().map(|v| v * v).sum::<f64>().sqrt();
        let direction = scaled.map(|v| v / length);
        if !direction.iter().chain(&origin).all(|v| v.is_finite()) {
            return None;
        }
        // Rounding grows with the way to the model.
        let far = origin.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let margin = MARGIN + far * 1e-12;
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for k in 0..3 {
            let (lo, hi) = (self.lo[k] - margin - origin[k], self.hi[k] + margin - origin[k]);
            if direction[k] == 0.0 {
                if lo > 0.0 || hi < 0.0 {
                    return None;
                }
            } else {
                let (a, b) = (lo / direction[k], hi / direction[k]);
                (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
            }
        }
        // Also false if the model is empty and its box inverted.
        if enter.partial_cmp(&leave).is_none_or(|o| o.is_gt()) {
            return None;
        }
        let origin = std::array::from_fn(|k| origin[k] + enter * direction[k]);
        let z = (0..3).fold(0, |z, k| if direction[k].abs() > direction[z].abs() { k } else { z });
        let axes = [z, (z + 1) % 3, (z + 2) % 3];
        let shear = [direction[axes[1]] / direction[z], direction[axes[2]] / direction[z]];
        Some(Moved { origin, direction, advance: enter, axes, shear })
    }

    fn test_patch(&self, patch: u32, ray: &Moved, [near, far]: [f64; 2], best: &mut Option<ReferenceHit>) {
        let (tree, node, at) = self.patch(patch);
        let splits = self.levels.min(PATCH_SPLITS);
        let m = 1 << splits;
        let mut sheared = [[0.0; 3]; lattice::len(PATCH_SPLITS)];
        let places = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j)));
        for (slot, place) in sheared.iter_mut().zip(places) {
            *slot = ray.sheared(at(place));
        }
        for below in 0..1u32 << (2 * splits) {
            let corners = lattice::node(splits, splits, below).map(|p| sheared[lattice::index(splits, p)]);
            if let Some((t, bary, front)) = ray.meet(corners) {
                let hit = ReferenceHit { t: ray.advance + t, tree, full_node: (node << (2 * splits)) + below, bary, front };
                if near <= hit.t && hit.t <= far && best.is_none_or(|b| hit.before(&b)) {
                    *best = Some(hit);
                }
            }
        }
    }
}

impl Moved {
    /// A point in the space in which the ray runs along the last coordinate from the origin.
    fn sheared(&self, p: [i32; 3]) -> [f64; 3] {
        let [z, x, y] = self.axes.map(|k| f64::from(p[k]) - self.origin[k]);
        [x - self.shear[0] * z, y - self.shear[1] * z, z]
    }

    /// Distance, barycentrics and side of the hit on a sheared triangle.
    fn meet(&self, [a, b, c]: [[f64; 3]; 3]) -> Option<(f64, [f64; 3], bool)> {
        // Each is minus the neighbour's for the same edge, to the last bit.
        let edge = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
        let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let det = u + v + w;
        if det == 0.0 {
            return None;
        }
        let bary = [u / det, v / det, w / det];
        let along = self.direction[self.axes[0]];
        let t = (bary[0] * a[2] + bary[1] * b[2] + bary[2] * c[2]) / along;
        // The axes are turned, not mirrored; a direction against the last one turns the sign of the determinant.
        (t >= 0.0).then_some((t, bary, (det > 0.0) != (along > 0.0)))
    }
}
