//! The grid of a primitive: the same for all, so that hardware holds it in constants (paper section 2.1, "Geometry").
//!
//! A primitive of K splits has M = 2^K steps per side. Its vertices have *preliminary indices*: corners 0 to 2; then side s, from corner s + 1 to corner s + 2 (modulo 3),
//! with 3 + s (M - 1) and what follows; then its insides, row by row. Nodes of its tree are numbered breadth first: the children of n are 4n + 1 to 4n + 4.

use crate::mesh::lattice::{self, LatticePoint};

/// Where a vertex is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preliminary {
    /// Corner 0 to 2.
    Corner(usize),
    /// On a side, with its preliminary index.
    Boundary(usize, u32),
    /// Inside, counted from 0.
    Inside(u32),
}

/// What is done with the nodes of the tree at which a traversal ends: their triangles after some more splits.
#[derive(Clone, Debug, Default)]
pub struct LeafPattern {
    /// Depth of these nodes.
    pub depth: u32,
    /// Splits below them.
    pub splits: u32,
    /// Vertices of each.
    count: usize,
    /// Of each node, in turn.
    vertices: Vec<Preliminary>,
    /// Triangles of each, by the places of their corners among its vertices: the same for all.
    pub triangles: Vec<[u16; 3]>,
}

impl LeafPattern {
    /// Vertices of node `node` of its depth.
    #[inline(always)]
    pub fn vertices(&self, node: usize) -> &[Preliminary] {
        &self.vertices[node * self.count..][..self.count]
    }
}

/// The grid of primitives of some splits.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Splits K, 0 to 4.
    pub splits: u32,
    /// By lattice point, in lattice order.
    vertices: Vec<Preliminary>,
    /// Corners and inserted vertices (p0, p1, p2, q0, q1, q2) of each node but the finest, breadth first.
    nodes: Vec<[Preliminary; 6]>,
}

/// Number of the first node of a depth, breadth first: (4^depth - 1) / 3.
#[inline(always)]
pub const fn first_of_depth(depth: u32) -> usize {
    ((1 << (2 * depth)) - 1) / 3
}

/// Vertices on a side of a primitive, without its corners.
pub const fn on_side(splits: u32) -> usize {
    (1 << splits) - 1
}

/// Vertices inside a primitive.
pub const fn inside(splits: u32) -> usize {
    lattice::len(splits) - 3 - 3 * on_side(splits)
}

/// Point (x, y) of the lattice of `splits` splits over a triangle with corners `p` of a finer lattice.
#[inline(always)]
pub fn within(p: [LatticePoint; 3], splits: u32, (x, y): LatticePoint) -> LatticePoint {
    let along = |a: u32, b: u32, c: u32| {
        let step = |to: u32| (i64::from(to) - i64::from(a)) >> splits;
        (i64::from(a) + step(b) * i64::from(x) + step(c) * i64::from(y)) as u32 // between the corners
    };
    (along(p[0].0, p[1].0, p[2].0), along(p[0].1, p[1].1, p[2].1))
}

/// All points of a lattice, in its order.
pub fn points(splits: u32) -> impl Iterator<Item = LatticePoint> {
    let m = 1 << splits;
    (0..=m).flat_map(move |j| (0..=m - j).map(move |i| (i, j)))
}

/// Point `place`, 1 to M - 1, of side `side` of a primitive, counted from corner `side` + 1.
pub fn on_boundary(splits: u32, side: usize, place: u32) -> LatticePoint {
    let m = 1 << splits;
    match side {
        0 => (m - place, place),
        1 => (0, m - place),
        _ => (place, 0),
    }
}

impl Pattern {
    /// The grid of `splits` splits.
    pub fn new(splits: u32) -> Self {
        let (m, side) = (1u32 << splits, on_side(splits) as u32);
        let boundary = |of: usize, place: u32| Preliminary::Boundary(of, 3 + of as u32 * side + place - 1);
        let mut insides = 0..;
        let vertices = points(splits).map(|(i, j)| match (i, j) {
            (0, 0) => Preliminary::Corner(0),
            (i, 0) if i == m => Preliminary::Corner(1),
            (0, j) if j == m => Preliminary::Corner(2),
            (i, j) if i + j == m => boundary(0, j),
            (0, j) => boundary(1, m - j),
            (i, 0) => boundary(2, i),
            _ => Preliminary::Inside(insides.next().unwrap_or_default()),
        });
        let vertices: Vec<_> = vertices.collect();
        let at = |p| vertices[lattice::index(splits, p)];
        let nodes = (0..splits).flat_map(|depth| (0..1 << (2 * depth)).map(move |node| lattice::node(splits, depth, node)));
        let nodes = nodes.map(|p| {
            let q = lattice::midpoints(p);
            [p[0], p[1], p[2], q[0], q[1], q[2]].map(at)
        });
        let nodes = nodes.collect();
        Self { splits, nodes, vertices }
    }

    /// Corners and inserted vertices of node `node`, breadth first, above the finest.
    #[inline(always)]
    pub fn node(&self, node: usize) -> &[Preliminary; 6] {
        &self.nodes[node]
    }

    /// The vertex at a point of the lattice.
    pub fn at(&self, point: LatticePoint) -> Preliminary {
        self.vertices[lattice::index(self.splits, point)]
    }

    /// Nodes of `depth` as leaves, whose triangles are those of depth `cap`.
    pub fn leaves(&self, depth: u32, cap: u32) -> LeafPattern {
        let below = cap - depth;
        let place = |p| lattice::index(below, p) as u16; // below 153
        let of_node = |node| {
            let p = lattice::node(self.splits, depth, node);
            points(below).map(move |point| within(p, below, point))
        };
        LeafPattern {
            depth,
            splits: below,
            count: lattice::len(below),
            vertices: (0..1 << (2 * depth)).flat_map(of_node).map(|point| self.at(point)).collect(),
            triangles: (0..1 << (2 * below)).map(|node| lattice::node(below, below, node).map(place)).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preliminary_indices_are_those_of_the_paper() {
        for splits in 0..=4 {
            let pattern = Pattern::new(splits);
            let (side, m) = (on_side(splits) as u32, 1u32 << splits);
            let mut boundary = Vec::new();
            for of in 0..3 {
                for place in 1..m {
                    let Preliminary::Boundary(at, index) = pattern.at(on_boundary(splits, of, place)) else { panic!("{of} {place}") };
                    assert_eq!(at, of);
                    boundary.push(index);
                }
            }
            assert_eq!(boundary, (3..3 + 3 * side).collect::<Vec<_>>());
            let insides: Vec<u32> =
                pattern.vertices.iter().filter_map(|v| if let Preliminary::Inside(k) = v { Some(*k) } else { None }).collect();
            assert_eq!(insides, (0..inside(splits) as u32).collect::<Vec<_>>());
            assert_eq!((0..3).map(|k| pattern.at(lattice::root(splits)[k])).collect::<Vec<_>>(), [0, 1, 2].map(Preliminary::Corner));
        }
        // Its figure 2: two splits have three vertices on a side, at 3, 6 and 9.
        assert_eq!((on_side(2), inside(2), inside(4)), (3, 3, 105));
    }

    #[test]
    fn leaves_have_the_triangles_of_the_lattice() {
        for splits in 0..=4 {
            let pattern = Pattern::new(splits);
            for cap in 0..=splits {
                for depth in 0..=cap {
                    let leaves = pattern.leaves(depth, cap);
                    for node in 0..1u32 << (2 * depth) {
                        for (k, triangle) in (0..).zip(&leaves.triangles) {
                            let own = triangle.map(|v| leaves.vertices(node as usize)[usize::from(v)]);
                            let wanted = lattice::node(splits, cap, node << (2 * (cap - depth)) | k).map(|p| pattern.at(p));
                            assert_eq!(own, wanted);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn nodes_are_numbered_breadth_first() {
        let pattern = Pattern::new(3);
        for depth in 0..3 {
            for node in 0..1u32 << (2 * depth) {
                let n = first_of_depth(depth) + node as usize;
                let p = lattice::node(3, depth, node);
                assert_eq!(pattern.node(n)[..3], p.map(|p| pattern.at(p)));
                for k in 0..4 {
                    assert_eq!(4 * n + 1 + k as usize, first_of_depth(depth + 1) + (4 * node + k) as usize);
                }
            }
        }
    }
}
