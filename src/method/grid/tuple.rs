//! Vertices that primitives share, stored once (paper section 2.1, listing 1, equation 3).
//!
//! Corners are those of the triangles of the primitives' level; boundaries the vertices between two corners. Within a tree two primitives share a boundary, or one has it
//! where the tree ends. Trees share the boundaries of a base edge, however many they are: one stores the vertices, and all point to them, forwards or backwards. So a boundary
//! that three or more primitives meet at is no other case, nor is an open one, which only one points to.

use super::pattern::{on_boundary, on_side};
use crate::mesh::lattice::{self, LatticePoint};
use crate::mesh::{Hierarchy, SharedEdges, edge_index, edges_of_level, edges_of_tree};

/// What a primitive says of its vertices: 24 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Tuple {
    /// Its corners.
    pub corners: [u32; 3],
    /// Bases of its sides.
    pub boundaries: [i32; 3],
}

impl Tuple {
    /// Final index of the vertex of a side with this preliminary index: |b + B|.
    #[inline(always)]
    pub fn boundary(&self, side: usize, preliminary: u32) -> usize {
        // Bases are below 2^28 in magnitude, preliminary indices below 153.
        (self.boundaries[side] + preliminary as i32).unsigned_abs() as usize
    }

    /// The number of the boundary of a side, of primitives of at least one split.
    pub fn edge(&self, splits: u32, side: usize) -> usize {
        let first = 3 + side * on_side(splits);
        self.boundary(side, first as u32) / on_side(splits)
    }

    /// The base of a side whose boundary has this number.
    fn base(splits: u32, side: usize, edge: u32, forward: bool) -> i32 {
        let (count, first) = (on_side(splits) as i32, 3 + (side * on_side(splits)) as i32);
        let start = edge as i32 * count; // vertices of boundaries are fewer than 2^28
        if forward { start - first } else { -(start + count - 1) - first }
    }
}

/// A vertex of a hierarchy: tree, and point of its finest lattice.
pub type Source = (u32, LatticePoint);

/// The tuples of primitives, and where the vertices come from that they share.
#[derive(Debug, Default)]
pub struct SharedVertices {
    /// Of each primitive.
    pub tuples: Vec<Tuple>,
    /// The corners, by first use.
    pub corners: Vec<Source>,
    /// The vertices of the boundaries, by first use, from the corner of smaller number to the other.
    pub boundaries: Vec<Source>,
}

/// Places of each tree that stand for one thing: that of the tree which has it first.
struct Places {
    of_tree: usize,
    same: Vec<u32>,
}

impl Places {
    fn new(trees: usize, of_tree: usize) -> Self {
        Self { of_tree, same: (0..(trees * of_tree) as u32).collect() } // fewer than the hierarchy's points
    }

    fn place(&self, tree: u32, at: usize) -> usize {
        tree as usize * self.of_tree + at
    }

    fn join(&mut self, first: (u32, usize), other: (u32, usize)) {
        let to = self.same[self.place(first.0, first.1)];
        let at = self.place(other.0, other.1);
        self.same[at] = to;
    }

    fn of(&self, tree: u32, at: usize) -> usize {
        self.same[self.place(tree, at)] as usize
    }
}

/// Numbers that things get when they are first met.
struct Numbers(Vec<u32>);

impl Numbers {
    const NONE: u32 = u32::MAX;

    /// The number of a thing, and whether it is new.
    fn of(&mut self, thing: usize, next: usize) -> (u32, bool) {
        let is_new = self.0[thing] == Self::NONE;
        if is_new {
            self.0[thing] = next as u32; // fewer than the hierarchy's points
        }
        (self.0[thing], is_new)
    }
}

/// Shares the vertices of primitives of `splits` splits, which are triangles (tree, node) of the level so far above the finest, in this order.
pub fn share(hierarchy: &Hierarchy, splits: u32, primitives: &[(u32, u32)]) -> SharedVertices {
    let level = hierarchy.levels - splits;
    let (trees, before) = (hierarchy.triangles.len(), edges_of_tree(level));
    let (corners, edges) = places(hierarchy, level);
    let mut corner_numbers = Numbers(vec![Numbers::NONE; corners.same.len()]);
    let mut edge_numbers = Numbers(vec![Numbers::NONE; edges.same.len()]);
    debug_assert_eq!(edges.same.len(), trees * edges_of_level(level));
    let mut shared = SharedVertices::default();
    shared.tuples.reserve(primitives.len());
    let mut edge_count = 0;
    for &(tree, node) in primitives {
        let of_level = lattice::node(level, level, node);
        let finest = of_level.map(|(i, j)| (i << splits, j << splits));
        let corners = std::array::from_fn(|k| {
            let place = corners.of(tree, lattice::index(level, of_level[k]));
            let (number, is_new) = corner_numbers.of(place, shared.corners.len());
            if is_new {
                shared.corners.push((tree, finest[k]));
            }
            number
        });
        let boundaries = std::array::from_fn(|side| {
            let [from, to] = [(side + 1) % 3, (side + 2) % 3];
            let place = edges.of(tree, edge_index(level, level, of_level[from], of_level[to]) - before);
            let (number, is_new) = edge_numbers.of(place, edge_count);
            let forward = corners[from] < corners[to];
            if is_new {
                edge_count += 1;
                let m = 1u32 << splits;
                let vertex = |place: u32| {
                    let place = if forward { place } else { m - place };
                    (tree, super::pattern::within(finest, splits, on_boundary(splits, side, place)))
                };
                shared.boundaries.extend((1..m).map(vertex));
            }
            Tuple::base(splits, side, number, forward)
        });
        shared.tuples.push(Tuple { corners, boundaries });
    }
    shared
}

/// Corners and edges of a level, by tree: those that trees share are one.
fn places(hierarchy: &Hierarchy, level: u32) -> (Places, Places) {
    let trees = hierarchy.triangles.len();
    let mut corners = Places::new(trees, lattice::len(level));
    let mut edges = Places::new(trees, edges_of_level(level));
    let mut first_uses = vec![None; hierarchy.base_vertices as usize];
    for (tree, triangle) in (0..).zip(&hierarchy.triangles) {
        for (&vertex, corner) in triangle.iter().zip(lattice::root(level)) {
            let own = (tree, lattice::index(level, corner));
            let first = *first_uses[vertex as usize].get_or_insert(own);
            corners.join(first, own);
        }
    }
    let before = edges_of_tree(level);
    for uses in SharedEdges::new(&hierarchy.triangles).edges() {
        let first = uses[0];
        for own in &uses[1..] {
            for place in 0..1u32 << level {
                edges.join((first.tree, first.edge(level, place) - before), (own.tree, own.edge(level, place) - before));
            }
            for place in 1..1u32 << level {
                let at = |of: &crate::mesh::EdgeUse| (of.tree, lattice::index(level, of.point(level, place)));
                corners.join(at(&first), at(own));
            }
        }
    }
    (corners, edges)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_walk_a_boundary_forwards_and_backwards() {
        for splits in 1..=4u32 {
            for side in 0..3 {
                for edge in [0, 1, 7, 100_000] {
                    let (count, first) = (on_side(splits), 3 + side * on_side(splits));
                    for forward in [true, false] {
                        let mut boundaries = [0; 3];
                        boundaries[side] = Tuple::base(splits, side, edge, forward);
                        let tuple = Tuple { corners: [0; 3], boundaries };
                        let found: Vec<_> = (0..count).map(|k| tuple.boundary(side, (first + k) as u32)).collect();
                        let mut wanted: Vec<_> = (0..count).map(|k| edge as usize * count + k).collect();
                        if !forward {
                            wanted.reverse();
                        }
                        assert_eq!(found, wanted, "{splits} {side} {edge} {forward}");
                        assert_eq!(tuple.edge(splits, side), edge as usize);
                    }
                }
            }
        }
    }
}
