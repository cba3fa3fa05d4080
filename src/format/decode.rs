//! Memory images back to a hierarchy, and single triangles of full resolution.

use super::{BoundData, L0Record, Scene, VertexData, layout};
use crate::mesh::lattice::{self, LatticePoint};
use crate::mesh::{EdgeCodes, Hierarchy, edge_index, edges_of_tree};
use crate::num::{Point, Wire};
use rayon::prelude::*;

/// A point in units as 32-bit integers.
#[inline]
pub(super) fn units(p: Point) -> [i32; 3] {
    p.get().map(|c| c as i32) // 32 bits by its type
}

impl Scene {
    /// Base corners p0, p1, p2 of a tree in units.
    #[inline]
    pub fn corners(&self, tree: usize) -> [[i32; 3]; 3] {
        VertexData::from_words(&self.records()[tree][..4]).points().map(units)
    }

    /// Second line of a tree's L0 record: material and root bound data.
    #[inline]
    pub fn record(&self, tree: usize) -> L0Record {
        L0Record::from_words(&self.records()[tree][4..])
    }

    /// Bound data of node (`level`, `node`) of a tree; `level` below N, or 0.
    #[inline]
    pub fn bound_data(&self, tree: usize, level: u32, node: usize) -> BoundData {
        if level == 0 {
            return self.record(tree).root;
        }
        let group = layout::child_group(self.levels(), tree, level - 1, node >> 2);
        BoundData::from_words(&self.bounds()[group][2 * (node & 3)..])
    }

    /// Inserted vertices q0, q1, q2 of node (`level`, `node`) of a tree in units; `level` below N.
    #[inline]
    pub fn inserted(&self, tree: usize, level: u32, node: usize) -> [[i32; 3]; 3] {
        VertexData::from_words(&self.vertices()[layout::vertex_line(self.levels(), tree, level, node)]).points().map(units)
    }

    /// Corners in units of node (`level`, `node`) of a tree, `level` at most N: reads one vertex line per level above it.
    pub fn triangle(&self, tree: usize, level: u32, node: usize) -> [[i32; 3]; 3] {
        (0..level).fold(self.corners(tree), |p, n| {
            let below = node >> (2 * (level - n));
            let q = self.inserted(tree, n, below);
            match (node >> (2 * (level - n - 1))) & 3 {
                0 => [p[0], q[2], q[1]],
                1 => [q[2], p[1], q[0]],
                2 => [q[1], q[0], p[2]],
                _ => q,
            }
        })
    }

    /// Corners in units of full-resolution triangle `i` (below 4^N) of a tree.
    pub fn full_resolution_triangle(&self, tree: usize, i: usize) -> [[i32; 3]; 3] {
        self.triangle(tree, self.levels(), i)
    }

    /// All points and codes back from the images.
    pub fn decode(&self) -> Hierarchy {
        let levels = self.levels();
        let (len, edges) = (lattice::len(levels), edges_of_tree(levels));
        let mut points = vec![[0; 3]; self.trees() * len];
        points.par_chunks_mut(len).enumerate().for_each(|(tree, points)| self.decode_points(tree, levels, points));
        let mut codes = vec![0; self.trees() * edges];
        if edges > 0 {
            codes.par_chunks_mut(edges).enumerate().for_each(|(tree, codes)| self.decode_codes(tree, codes));
        }
        Hierarchy {
            levels,
            placement: self.meta.placement,
            base_vertices: self.meta.base_vertices,
            triangles: self.triangles().to_vec(),
            points,
            bounds: EdgeCodes { kind: self.meta.bounds, scale: self.meta.bound_scale(), codes },
        }
    }

    /// Writes a tree's points of levels 0 to `finest` into its full lattice.
    pub(super) fn decode_points(&self, tree: usize, finest: u32, points: &mut [[i32; 3]]) {
        let levels = self.levels();
        for (corner, at) in self.corners(tree).into_iter().zip(lattice::root(levels)) {
            points[lattice::index(levels, at)] = corner;
        }
        self.each_node(finest, &mut |level, node, p| {
            for (q, at) in self.inserted(tree, level, node).into_iter().zip(lattice::midpoints(p)) {
                points[lattice::index(levels, at)] = q;
            }
        });
    }

    fn decode_codes(&self, tree: usize, codes: &mut [u16]) {
        let levels = self.levels();
        self.each_node(levels, &mut |level, node, p| {
            let data = self.bound_data(tree, level, node);
            for (code, [a, b]) in [data.e0, data.e1, data.e2].into_iter().zip([[p[1], p[2]], [p[2], p[0]], [p[0], p[1]]]) {
                codes[edge_index(levels, level, a, b)] = code.get() as u16; // 10 bits
            }
        });
    }

    /// Calls `f` with level, node and corners of every node of levels 0 to `finest` - 1 of a tree, depth first.
    fn each_node(&self, finest: u32, f: &mut impl FnMut(u32, usize, [LatticePoint; 3])) {
        fn below(finest: u32, level: u32, node: usize, p: [LatticePoint; 3], f: &mut impl FnMut(u32, usize, [LatticePoint; 3])) {
            if level < finest {
                f(level, node, p);
                for k in 0..4 {
                    below(finest, level + 1, 4 * node + k as usize, lattice::child(p, k), f);
                }
            }
        }
        below(finest, 0, 0, lattice::root(self.levels()), f);
    }
}
