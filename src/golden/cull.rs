//! Boxes that spare the exact traverser work and provably cannot change a result.
//!
//! A hit lies on the ray's line and in the triangle, so in every closed box around the triangle. A box is passed over only if a plane parallel to
//! the ray and to a coordinate axis has it strictly on one side, or if it lies wholly behind the origin along an axis; then it
//! holds no point of the ray. All products are exact.

use super::predicates::Vector;
use crate::mesh::{Hierarchy, lattice};

/// A closed box in units.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Bounds {
    lo: [i32; 3],
    hi: [i32; 3],
}

impl Bounds {
    pub const EMPTY: Self = Self { lo: [i32::MAX; 3], hi: [i32::MIN; 3] };

    fn around(points: impl IntoIterator<Item = [i32; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(Self { lo: p, hi: p }))
    }

    fn union(self, other: Self) -> Self {
        Self { lo: std::array::from_fn(|k| self.lo[k].min(other.lo[k])), hi: std::array::from_fn(|k| self.hi[k].max(other.hi[k])) }
    }

    /// The ray from `x`, or from a point less than `slack` beyond it in each coordinate, along `d` certainly has no point in the box around this one and `corners`.
    pub fn missed_by(&self, x: Vector, slack: i64, d: Vector, corners: &[Vector]) -> bool {
        let with = |start: i32, pick: fn(i64, i64) -> i64, k: usize| corners.iter().fold(i64::from(start), |v, p| pick(v, p[k])) - x[k];
        let lo: Vector = std::array::from_fn(|k| with(self.lo[k], i64::min, k) - slack);
        let hi: Vector = std::array::from_fn(|k| with(self.hi[k], i64::max, k));
        // Behind along axis k, or beside a ray that does not move along it.
        let behind = (0..3).any(|k| (d[k] >= 0 && hi[k] < 0) || (d[k] <= 0 && lo[k] > 0));
        behind || (0..3).any(|k| separated(d, lo, hi, (k + 1) % 3, (k + 2) % 3))
    }
}

/// Seen along the third axis, all four corners of the rectangle lie strictly on one side of the ray's line.
fn separated(d: Vector, lo: Vector, hi: Vector, i: usize, j: usize) -> bool {
    let side = |ci: i64, cj: i64| i128::from(d[i]) * i128::from(cj) - i128::from(d[j]) * i128::from(ci);
    let sides = [side(lo[i], lo[j]), side(hi[i], lo[j]), side(lo[i], hi[j]), side(hi[i], hi[j])];
    sides.iter().all(|&s| s > 0) || sides.iter().all(|&s| s < 0)
}

/// Boxes of all stored vertices below each node of levels 0 to N-1, and a binary tree over the trees.
pub(super) struct Boxes {
    per_tree: usize,
    nodes: Vec<Bounds>,
    top: Vec<Top>,
}

/// A node of the binary tree: its box, then either one tree or the index of the second half (the first half follows directly).
struct Top {
    bounds: Bounds,
    second: u32,
    tree: Option<u32>,
}

/// Breadth-first number of a node.
fn number(level: u32, node: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3 + node as usize
}

impl Boxes {
    pub fn new(h: &Hierarchy) -> Self {
        let deepest = h.levels.saturating_sub(1);
        let per_tree = number(deepest + 1, 0);
        let mut nodes = vec![Bounds::EMPTY; per_tree * h.triangles.len()];
        for (tree, boxes) in nodes.chunks_exact_mut(per_tree).enumerate() {
            let points = h.tree(tree);
            for node in 0..1u32 << (2 * deepest) {
                let corners = lattice::node(h.levels, deepest, node);
                let at = |p| points[lattice::index(h.levels, p)];
                let mut bounds = Bounds::around(corners.map(at));
                if h.levels > 0 {
                    bounds = bounds.union(Bounds::around(lattice::midpoints(corners).map(at)));
                }
                boxes[number(deepest, node)] = bounds;
            }
            for level in (0..deepest).rev() {
                for node in 0..1u32 << (2 * level) {
                    let children = (0..4).map(|k| boxes[number(level + 1, 4 * node + k)]);
                    boxes[number(level, node)] = children.fold(Bounds::EMPTY, Bounds::union);
                }
            }
        }
        let mut trees: Vec<u32> = (0..h.triangles.len() as u32).collect(); // base triangles are counted in 32 bits
        let mut boxes = Self { per_tree, nodes, top: Vec::with_capacity(2 * trees.len()) };
        boxes.split(&mut trees);
        boxes
    }

    /// Box of a node of level 0 to N-1 (0 if N = 0).
    pub fn node(&self, tree: u32, level: u32, node: u32) -> &Bounds {
        &self.nodes[tree as usize * self.per_tree + number(level, node)]
    }

    /// Adds the binary tree over `trees`: halves by the centres along the longest side.
    fn split(&mut self, trees: &mut [u32]) {
        let bounds = trees.iter().map(|&t| *self.node(t, 0, 0)).fold(Bounds::EMPTY, Bounds::union);
        let at = self.top.len();
        match trees {
            [] => {}
            [tree] => self.top.push(Top { bounds, second: 0, tree: Some(*tree) }),
            _ => {
                let side = |k: usize| i64::from(bounds.hi[k]) - i64::from(bounds.lo[k]);
                let axis = (0..3).max_by_key(|&k| side(k)).unwrap_or(0);
                trees.sort_by_cached_key(|&t| {
                    let b = self.node(t, 0, 0);
                    i64::from(b.lo[axis]) + i64::from(b.hi[axis])
                });
                self.top.push(Top { bounds, second: 0, tree: None });
                let (first, second) = trees.split_at_mut(trees.len() / 2);
                self.split(first);
                self.top[at].second = self.top.len() as u32; // fewer than twice the trees
                self.split(second);
            }
        }
    }

    /// Calls `visit` for each tree whose box the ray may meet.
    pub fn trees(&self, x: Vector, slack: i64, d: Vector, visit: &mut impl FnMut(u32)) {
        let mut open = vec![0u32];
        while let Some(at) = open.pop() {
            let Some(top) = self.top.get(at as usize) else { return }; // a model without triangles
            if top.bounds.missed_by(x, slack, d, &[]) {
                continue;
            }
            match top.tree {
                Some(tree) => visit(tree),
                None => open.extend([top.second, at + 1]),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const UNIT: Bounds = Bounds { lo: [-10; 3], hi: [10; 3] };

    #[test]
    fn faces_edges_and_corners_count_as_met() {
        for (x, d) in [
            ([10, 10, -50], [0, 0, 7]),
            ([10, 0, 10], [5, 5, 5]),
            ([-20, 0, 0], [10, 10, 10]),
            ([0, 0, 0], [1, 2, 3]),
            ([-30, 30, 10], [1, -1, 0]),
        ] {
            assert!(!UNIT.missed_by(x, 0, d, &[]), "{x:?} {d:?}");
        }
        for (x, d) in [
            ([11, 10, -50], [0, 0, 7]),
            ([10, 0, 11], [5, 5, 5]),
            ([-21, 0, 0], [10, 10, 10]),
            ([-30, 51, 10], [1, -1, 0]),
            ([0, 0, 11], [0, 0, 1]),
        ] {
            assert!(UNIT.missed_by(x, 0, d, &[]), "{x:?} {d:?}");
        }
        assert!(!UNIT.missed_by([11, 10, -50], 0, [0, 0, 7], &[[11, 0, 0]]));
    }

    proptest! {
        #[test]
        fn a_ray_to_a_point_of_the_box_is_never_culled(lo in prop::array::uniform3(-100i32..100), size in prop::array::uniform3(0i32..50), part in prop::array::uniform3(0i32..=50),
                                                       d in prop::array::uniform3(-9i64..=9), k in 0i64..40) {
            let b = Bounds { lo, hi: std::array::from_fn(|i| lo[i] + size[i]) };
            let x: Vector = std::array::from_fn(|i| i64::from(lo[i] + part[i].min(size[i])) - d[i] * k);
            prop_assert!(!b.missed_by(x, 0, d, &[]));
        }
    }
}
