//! Displacement bounds by their definition: over all trees together, with hash maps, one level after the other.
//!
//! A vertex that a split inserts stands for the edge it splits. Vertices on a base edge belong to all trees with that edge, in whatever
//! direction and however many; all others belong to one tree.

use super::lod::displacement;
use crate::{
    mesh::{
        BoundKind, EdgeCodes, Hierarchy, edge_index, edges_of_tree,
        lattice::{self, LatticePoint},
    },
    num::{BoundScale, COORD_LIMIT, MAX_BOUND_OFFSET, U},
};
use std::collections::HashMap;

/// No bound is larger: the diagonal of the cube of all coordinates, rounded up.
const MOST: u64 = {
    let side = 2 * COORD_LIMIT as u128;
    // (side sqrt 3)^2 is no square.
    (3 * side * side).isqrt() as u64 + 1
};

/// An inserted vertex, the same for all trees that share it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Inserted {
    /// On the base edge of these two base vertices, so many steps of 2^-N from the smaller one.
    OnBaseEdge(u32, u32, u32),
    /// In the interior of this tree.
    Inside(u32, LatticePoint),
}

/// The true bounds of a model: units, rounded up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrueBounds {
    /// One per edge, in the order of [`EdgeCodes::codes`].
    pub edges: Vec<u64>,
    /// The largest of them, 0 if there are none.
    pub largest: u64,
}

/// Computes and stores the bound codes of all edges of the model.
pub fn naive_bounds(h: &mut Hierarchy) {
    let bounds = true_bounds(h);
    let scale = scale_for(bounds.largest);
    let table: Vec<i128> = (0..=u8::MAX).map(|c| displacement(scale, c)).collect();
    // The smallest code that decodes to the bound or more; decode does not decrease.
    let encode = |&b: &u64| table.partition_point(|&h| h < i128::from(b)).min(255) as u8; // 8 bits
    h.bounds = EdgeCodes { kind: h.bounds.kind, scale, codes: bounds.edges.iter().map(encode).collect() };
}

/// The true bounds by definition.
pub fn true_bounds(h: &Hierarchy) -> TrueBounds {
    let mut bounds: HashMap<Inserted, u64> = HashMap::new();
    for level in (0..h.levels).rev() {
        // The bounds of all edges that meet at an inserted vertex on the next level ...
        let mut below: HashMap<Inserted, u64> = HashMap::new();
        if level + 1 < h.levels {
            for_each_edge(h, level + 1, |tree, a, b, q| {
                let finer = bounds[&identify(h, tree, q)];
                for end in [a, b] {
                    if lattice::level_of(h.levels, end) == level + 1 {
                        let largest = below.entry(identify(h, tree, end)).or_default();
                        *largest = (*largest).max(finer);
                    }
                }
            });
        }
        // ... and its distance from the midpoint of its edge.
        for_each_edge(h, level, |tree, a, b, q| {
            let at = |p| h.tree(tree as usize)[lattice::index(h.levels, p)];
            let vertex = identify(h, tree, q);
            let (own, finer) = (distance_to_midpoint(at(a), at(b), at(q)), below.get(&vertex).copied().unwrap_or(0));
            let covered = match h.bounds.kind {
                BoundKind::Largest => own.max(finer),
                BoundKind::Total => (own + finer).min(MOST),
            };
            let bound = bounds.entry(vertex).or_default();
            *bound = (*bound).max(covered);
        });
    }
    let per_tree = edges_of_tree(h.levels);
    let mut edges = vec![0; per_tree * h.triangles.len()];
    for level in 0..h.levels {
        for_each_edge(h, level, |tree, a, b, q| {
            edges[tree as usize * per_tree + edge_index(h.levels, level, a, b)] = bounds[&identify(h, tree, q)];
        });
    }
    let largest = edges.iter().copied().max().unwrap_or(0);
    TrueBounds { edges, largest }
}

/// Calls `visit(tree, a, b, q)` for each edge (a, b) of each node of a level below N; q is inserted on it. Inner edges come twice.
pub(super) fn for_each_edge(h: &Hierarchy, level: u32, mut visit: impl FnMut(u32, LatticePoint, LatticePoint, LatticePoint)) {
    for tree in 0..h.triangles.len() as u32 {
        for node in 0..1u32 << (2 * level) {
            let p = lattice::node(h.levels, level, node);
            let q = lattice::midpoints(p);
            for i in 0..3 {
                visit(tree, p[(i + 1) % 3], p[(i + 2) % 3], q[i]);
            }
        }
    }
}

/// The identity of an inserted vertex; never called for a base vertex.
pub(super) fn identify(h: &Hierarchy, tree: u32, (i, j): LatticePoint) -> Inserted {
    let m = 1u32 << h.levels;
    let weights = [m - i - j, i, j];
    match weights.iter().position(|&w| w == 0) {
        None => Inserted::Inside(tree, (i, j)),
        Some(opposite) => {
            let [from, to] = [(opposite + 1) % 3, (opposite + 2) % 3];
            let [u, v] = [from, to].map(|k| h.triangles[tree as usize][k]);
            if u < v { Inserted::OnBaseEdge(u, v, weights[to]) } else { Inserted::OnBaseEdge(v, u, weights[from]) }
        }
    }
}

/// ceil |q - (a + b) / 2|: the smallest k with (2k)^2 >= |2q - a - b|^2.
fn distance_to_midpoint(a: [i32; 3], b: [i32; 3], q: [i32; 3]) -> u64 {
    let squared: i128 = (0..3).map(|k| (2 * i128::from(q[k]) - i128::from(a[k]) - i128::from(b[k])).pow(2)).sum();
    let mut k = squared.isqrt() / 2;
    while 4 * k * k < squared {
        k += 1;
    }
    k as u64 // |2q - a - b| < 2^35
}

/// The least offset with which the last code covers `largest`.
fn scale_for(largest: u64) -> BoundScale {
    let scale = |offset| BoundScale { offset: U::saturating(offset) };
    let covers = |&offset: &u64| displacement(scale(offset), u8::MAX) >= i128::from(largest);
    scale((0..MAX_BOUND_OFFSET).find(covers).unwrap_or(MAX_BOUND_OFFSET))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num;
    use proptest::prelude::*;

    #[test]
    fn distances_are_rounded_up_from_exact_midpoints() {
        assert_eq!(distance_to_midpoint([0; 3], [1, 0, 0], [0; 3]), 1);
        assert_eq!(distance_to_midpoint([0; 3], [2, 0, 0], [1, 0, 0]), 0);
        assert_eq!(distance_to_midpoint([-8, 0, 0], [8, 0, 0], [0, 3, 4]), 5);
        assert_eq!(distance_to_midpoint([-8, 0, 0], [8, 0, 0], [1, 3, 4]), 6);
        let m = i32::MAX;
        assert_eq!(distance_to_midpoint([-m; 3], [-m; 3], [m; 3]), 7_439_101_571);
    }

    proptest! {
        #[test]
        fn scales_are_those_of_the_plain_definition(largest in 0..=num::LARGEST_BOUND, bits in 0u32..33) {
            let largest = largest >> bits;
            // The production rounding must say the same; here only as a second opinion.
            prop_assert_eq!(scale_for(largest), num::bound_scale(largest));
        }
    }
}
