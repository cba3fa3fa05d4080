//! A hierarchy in integers: what the memory images are encoded from and what the golden traverser reads.

use super::lattice::{self, LatticePoint};
use crate::num::{BoundScale, LARGEST_BOUND, VertexForm};
use serde::{Deserialize, Serialize};

/// Where the model's integer space lies: `world = offset + scale * units`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Placement {
    /// World position of units (0, 0, 0).
    pub offset: [f64; 3],
    /// World length of one unit, positive and finite.
    pub scale: f64,
}

impl Placement {
    /// World position of a point in units.
    pub fn to_world(&self, p: [i32; 3]) -> [f64; 3] {
        std::array::from_fn(|k| self.offset[k] + self.scale * f64::from(p[k]))
    }
}

/// What a displacement bound covers. The default is what scenes are made with where nobody asks; what rests on the paper's bounds asks for `Largest`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BoundKind {
    /// The largest displacement of one split, at the edge or below it (paper section 3.3).
    Largest,
    /// The displacements of all splits at and below the edge, one upon the other: what is seen is within 1.5 tolerances of the surface (docs/error-bound.md).
    #[default]
    Total,
}

impl BoundKind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Largest, Self::Total];

    /// What files mean that name none: those from before there was a choice, whatever the default is.
    pub const fn unnamed() -> Self {
        Self::Largest
    }

    /// Whether files need not name it.
    pub fn is_unnamed(&self) -> bool {
        *self == Self::unnamed()
    }

    /// Its name in options and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Largest => "largest",
            Self::Total => "total",
        }
    }

    /// The bound of an edge whose own displacement is `own` and below which the largest bound is `below`, in units. (Displacements that go to and fro could add
    /// up to more than can be stored; the model is smaller than that.)
    pub fn of(self, own: u64, below: u64) -> u64 {
        match self {
            Self::Largest => own.max(below),
            Self::Total => (own + below).min(LARGEST_BOUND),
        }
    }
}

/// Displacement bound codes of all edges of levels 0..N-1 of all trees.
///
/// Edges of level n of a tree: each upward triangle (i, j), i + j < 2^n, of the level's own lattice owns three: 0 = (i+1, j)-(i, j+1), 1 = (i, j+1)-(i, j),
/// 2 = (i, j)-(i+1, j); stored row by row like lattice points, level after level, tree after tree.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct EdgeCodes {
    /// What they cover.
    pub kind: BoundKind,
    /// Scale of the model.
    pub scale: BoundScale,
    /// One code per edge.
    pub codes: Vec<u8>,
}

/// A hierarchy of `levels` splits over an indexed base mesh.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    /// Number of splits N.
    pub levels: u32,
    /// Model space to world.
    pub placement: Placement,
    /// Number of base vertices.
    pub base_vertices: u32,
    /// Base triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Positions in units, `lattice::len(levels)` for each tree.
    pub points: Vec<[i32; 3]>,
    /// Displacement bounds.
    pub bounds: EdgeCodes,
    /// How inserted vertices are stored; the points are what that leaves of them.
    pub vertices: VertexForm,
    /// Zero bits at the bottom of every coordinate, of morphed triangles too.
    pub zeros: u32,
}

/// Number of edges of level `level` of one tree.
#[inline]
pub const fn edges_of_level(level: u32) -> usize {
    let k = 1usize << level;
    3 * k * (k + 1) / 2
}

/// Number of edges of levels 0..`levels` of one tree.
#[inline]
pub const fn edges_of_tree(levels: u32) -> usize {
    // The sum of 3 k (k + 1) / 2 over k = 1, 2, 4, ...: that of 4^n is (4^levels - 1) / 3, that of 2^n is 2^levels - 1.
    ((1 << (2 * levels)) - 1 + 3 * ((1 << levels) - 1)) / 2
}

/// Index within a tree's codes of the edge of level `level` between two points of the full lattice of `levels` splits.
#[inline]
pub fn edge_index(levels: u32, level: u32, a: LatticePoint, b: LatticePoint) -> usize {
    let step = levels - level;
    let (i, j) = (a.0.min(b.0) >> step, a.1.min(b.1) >> step);
    let side = match (a.0 == b.0, a.1 == b.1) {
        (false, false) => 0,
        (true, _) => 1,
        (_, true) => 2,
    };
    let (k, i, j) = (1usize << level, i as usize, j as usize);
    // Rows of upward triangles hold k, k-1, ... of them.
    let upward = j * k + i - (j * j.saturating_sub(1)) / 2;
    edges_of_tree(level) + 3 * upward + side
}

/// The depth of a tree with these codes ([`Hierarchy::depth`]).
pub(super) fn depth(levels: u32, codes: &[u8]) -> u32 {
    let last = codes.iter().rposition(|&code| code != 0);
    last.map_or(0, |last| (1..=levels).find(|&level| last < edges_of_tree(level)).unwrap_or(levels))
}

impl Hierarchy {
    /// Points of one tree, in lattice order.
    #[inline]
    pub fn tree(&self, tree: usize) -> &[[i32; 3]] {
        let len = lattice::len(self.levels);
        &self.points[tree * len..][..len]
    }

    /// Bound codes of one tree.
    #[inline]
    pub fn codes(&self, tree: usize) -> &[u8] {
        let len = edges_of_tree(self.levels);
        &self.bounds.codes[tree * len..][..len]
    }

    /// Codes of the edges (e0, e1, e2) of a node of `level` with these corners; `level` below N.
    #[inline]
    pub fn node_codes(&self, tree: usize, level: u32, p: [LatticePoint; 3]) -> [u8; 3] {
        let codes = self.codes(tree);
        [[p[1], p[2]], [p[2], p[0]], [p[0], p[1]]].map(|[a, b]| codes[edge_index(self.levels, level, a, b)])
    }

    /// How many levels of a tree any ray could want: the least level from which on all codes are 0, as every triangle there serves. What is inserted below lies exactly
    /// on the middles of its edges: a bound of 0 is that of no displacement at all.
    pub fn depth(&self, tree: usize) -> u32 {
        depth(self.levels, self.codes(tree))
    }

    /// World position of a point in units.
    pub fn to_world(&self, p: [i32; 3]) -> [f64; 3] {
        self.placement.to_world(p)
    }

    /// Number of full-resolution triangles.
    pub fn finest_triangles(&self) -> u64 {
        (self.triangles.len() as u64) << (2 * self.levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_a_tree_are_those_of_its_levels() {
        assert!((0..=10).all(|levels| edges_of_tree(levels) == (0..levels).map(edges_of_level).sum::<usize>()));
    }

    #[test]
    fn every_edge_has_one_index() {
        let levels = 4;
        let mut seen = vec![0u32; edges_of_tree(levels)];
        for level in 0..levels {
            for n in 0..1u32 << (2 * level) {
                let p = lattice::node(levels, level, n);
                for [a, b] in [[p[1], p[2]], [p[2], p[0]], [p[0], p[1]]] {
                    assert_eq!(edge_index(levels, level, a, b), edge_index(levels, level, b, a));
                    seen[edge_index(levels, level, a, b)] += 1;
                }
            }
        }
        assert!(seen.iter().all(|&s| s == 1 || s == 2));
    }
}
