//! Which trees share which base edge, and where a tree's border lies in its lattice and among its edges.
//!
//! A tree's side s is its base edge e_s, from corner s+1 to corner s+2 (modulo 3). Places along a shared edge are counted from its
//! smaller base vertex index to the larger, so that every tree counts alike whichever way it runs along the edge.

use super::{edges_of_tree, lattice::LatticePoint};
use rayon::prelude::*;

/// One tree's use of a base edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeUse {
    /// Base vertices of the edge, the smaller index first.
    pub ends: [u32; 2],
    /// Tree that has this edge.
    pub tree: u32,
    /// Which of the tree's edges it is, 0 to 2.
    pub side: u8,
    /// Whether the tree runs along the edge from the larger index to the smaller.
    pub reversed: bool,
}

impl EdgeUse {
    /// Side `side` of tree `tree` with base triangle `triangle`.
    pub fn new(tree: u32, side: u8, triangle: [u32; 3]) -> Self {
        let s = usize::from(side);
        let (a, b) = (triangle[(s + 1) % 3], triangle[(s + 2) % 3]);
        Self { ends: [a.min(b), a.max(b)], tree, side, reversed: a > b }
    }

    /// Border point number `place` (0 to 2^levels, from the smaller base vertex on) of a lattice of `levels` splits.
    #[inline]
    pub fn point(&self, levels: u32, place: u32) -> LatticePoint {
        let m = 1 << levels;
        let t = if self.reversed { m - place } else { place };
        match self.side {
            0 => (m - t, t),
            1 => (0, m - t),
            _ => (t, 0),
        }
    }

    /// Index within the tree's edge codes of border edge number `place` (0 to 2^level - 1) of level `level`.
    #[inline]
    pub fn edge(&self, level: u32, place: u32) -> usize {
        let k = 1usize << level;
        let place = place as usize;
        let t = if self.reversed { k - 1 - place } else { place };
        let (i, j) = match self.side {
            0 => (k - 1 - t, t),
            1 => (0, k - 1 - t),
            _ => (t, 0),
        };
        // Rows of upward triangles hold k, k-1, ... of them.
        let upward = j * k + i - j * j.saturating_sub(1) / 2;
        edges_of_tree(level) + 3 * upward + usize::from(self.side)
    }
}

/// All uses of base edges, those of one edge side by side.
#[derive(Clone, Debug)]
pub struct SharedEdges {
    uses: Vec<EdgeUse>,
}

impl SharedEdges {
    /// The base edges of these triangles.
    pub fn new(triangles: &[[u32; 3]]) -> Self {
        let each = triangles.iter().zip(0..).flat_map(|(&t, tree)| [0, 1, 2].map(|side| EdgeUse::new(tree, side, t)));
        let mut uses: Vec<_> = each.collect();
        uses.par_sort_unstable();
        Self { uses }
    }

    /// The uses of each base edge, in the order of its end points; one use on an open border, three or more on a non-manifold edge.
    pub fn edges(&self) -> impl Iterator<Item = &[EdgeUse]> {
        self.uses.chunk_by(|a, b| a.ends == b.ends)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{edge_index, lattice};
    use super::*;

    #[test]
    fn border_edges_lie_between_border_points() {
        let levels = 4;
        for triangle in [[3, 5, 7], [7, 5, 3], [5, 3, 7]] {
            for side in 0..3 {
                let u = EdgeUse::new(0, side, triangle);
                let corner = lattice::root(levels)[triangle.iter().position(|&v| v == u.ends[0]).unwrap()];
                assert_eq!(u.point(levels, 0), corner);
                for level in 0..levels {
                    for place in 0..1 << level {
                        let step = levels - level;
                        let (a, b) = (u.point(levels, place << step), u.point(levels, (place + 1) << step));
                        assert_eq!(u.edge(level, place), edge_index(levels, level, a, b));
                    }
                }
            }
        }
    }

    #[test]
    fn a_fan_shares_one_edge() {
        let shared = SharedEdges::new(&[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
        let uses: Vec<_> = shared.edges().filter(|e| e.len() > 1).collect();
        assert_eq!(uses.len(), 1);
        assert_eq!(uses[0].iter().map(|u| (u.tree, u.reversed)).collect::<Vec<_>>(), [(0, false), (1, true), (2, false)]);
    }
}
