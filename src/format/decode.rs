//! Memory images back to a hierarchy, and single triangles of full resolution.

use super::{Displacements, L0Record, Line, Scene, ShortLine, SplitRecord, VertexData, has_split};
use crate::mesh::compact::inserted_zero_bits;
use crate::mesh::lattice::{self, LatticePoint};
use crate::mesh::{EdgeCodes, Hierarchy, edge_index, edges_of_tree};
use crate::num::{Point, VertexForm, Wire, displaced, displacement_shift};
use rayon::prelude::*;

/// A point in units as 32-bit integers.
#[inline]
pub(super) fn units(p: Point) -> [i32; 3] {
    [p.x.narrow(), p.y.narrow(), p.z.narrow()]
}

impl Scene {
    /// Base corners p0, p1, p2 of a tree in units.
    #[inline]
    pub fn corners(&self, tree: usize) -> [[i32; 3]; 3] {
        let points = match self.meta.vertices {
            VertexForm::Exact => VertexData::from_words(&self.records()[2 * tree + 1]).points(),
            VertexForm::Compact | VertexForm::Short => self.record(tree).corners(),
        };
        points.map(units)
    }

    /// A tree's L0 record.
    #[inline]
    pub fn record(&self, tree: usize) -> L0Record {
        L0Record::from_words(self.record_line(tree))
    }

    /// Codes of edges e0, e1, e2 of node (`level`, `node`) of a tree, `level` below N or 0: 0 from the tree's depth on.
    #[inline]
    pub fn node_codes(&self, tree: usize, level: u32, node: usize) -> [u8; 3] {
        let lines = self.tree_lines(tree);
        if level >= lines.depth {
            return [0; 3];
        }
        let codes = if level == 0 {
            let L0Record { e0, e1, e2, .. } = self.record(tree);
            [e0, e1, e2]
        } else {
            SplitRecord::line_codes(&self.splits()[self.starts.split(lines, level - 1, node >> 2)], node & 3)
        };
        let [e0, e1, e2] = codes;
        [e0.get() as u8, e1.get() as u8, e2.get() as u8] // 8 bits
    }

    /// Inserted vertices q0, q1, q2 in units of node (`level`, `node`) of a tree with full-resolution corners `p`, `level` below N: from the tree's depth on the middles
    /// of the edges.
    #[inline]
    pub fn inserted(&self, tree: usize, level: u32, node: usize, p: [[i32; 3]; 3]) -> [[i32; 3]; 3] {
        let (meta, lines) = (self.meta(), self.tree_lines(tree));
        if level >= lines.depth {
            let middle = |a: [i32; 3], b: [i32; 3]| std::array::from_fn(|c| displaced(a[c], b[c], 0, 0));
            return [middle(p[1], p[2]), middle(p[2], p[0]), middle(p[0], p[1])];
        }
        if meta.vertices == VertexForm::Exact {
            let line = self.starts.vertex_line(meta.vertices, lines, level, node);
            return VertexData::from_words(&self.vertices()[line]).points().map(units);
        }
        let ([d0, d1, d2], [e0, e1, e2]) = (self.displacements(tree, level, node), self.node_codes(tree, level, node));
        let (scale, zeros) = (meta.bound_scale(), inserted_zero_bits(meta.levels, level, meta.coordinate_zeros));
        let vertex = |a: [i32; 3], b: [i32; 3], by: Point, code: u8| {
            let (by, shift) = (units(by), displacement_shift(scale, code, zeros));
            let coordinate = |c: usize| displaced(a[c], b[c], by[c], shift);
            [coordinate(0), coordinate(1), coordinate(2)]
        };
        [vertex(p[1], p[2], d0, e0), vertex(p[2], p[0], d1, e1), vertex(p[0], p[1], d2, e2)]
    }

    /// Displacements of the inserted vertices of node (`level`, `node`) of a tree with compact vertices, `level` below its depth.
    #[inline]
    pub fn displacements(&self, tree: usize, level: u32, node: usize) -> [Point; 3] {
        let lines = self.tree_lines(tree);
        match has_split(lines.depth, level) {
            true => SplitRecord::line_displacements(&self.splits()[self.starts.split(lines, level, node)]),
            false => {
                let form = self.meta.vertices;
                last_displacements(form, &self.vertices()[self.starts.vertex_line(form, lines, level, node)], node)
            }
        }
    }

    /// Corners in units of node (`level`, `node`) of a tree, `level` at most N: reads the inserted vertices of each level above it.
    pub fn triangle(&self, tree: usize, level: u32, node: usize) -> [[i32; 3]; 3] {
        (0..level).fold(self.corners(tree), |p, n| {
            let below = node >> (2 * (level - n));
            let q = self.inserted(tree, n, below, p);
            child_corners(p, q, (node >> (2 * (level - n - 1))) & 3)
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
            vertices: self.meta.vertices,
            zeros: self.meta.coordinate_zeros,
        }
    }

    /// Writes a tree's points of levels 0 to `finest` into its full lattice.
    pub(super) fn decode_points(&self, tree: usize, finest: u32, points: &mut [[i32; 3]]) {
        let levels = self.levels();
        let corners = self.corners(tree);
        for (corner, at) in corners.into_iter().zip(lattice::root(levels)) {
            points[lattice::index(levels, at)] = corner;
        }
        self.each_node(tree, finest, &mut |_, places, q| {
            for (q, at) in q.into_iter().zip(lattice::midpoints(places)) {
                points[lattice::index(levels, at)] = q;
            }
        });
    }

    fn decode_codes(&self, tree: usize, codes: &mut [u8]) {
        let levels = self.levels();
        for level in 0..levels {
            for node in 0..1 << (2 * level) {
                let p = lattice::node(levels, level, node);
                let own = self.node_codes(tree, level, node as usize); // below 4^10
                for (code, [a, b]) in own.into_iter().zip([[p[1], p[2]], [p[2], p[0]], [p[0], p[1]]]) {
                    codes[edge_index(levels, level, a, b)] = code;
                }
            }
        }
    }

    /// Calls `f` with level and number, corners' places and inserted vertices of every node of levels 0 to `finest` - 1 of a tree, depth first.
    pub(crate) fn each_node(&self, tree: usize, finest: u32, f: &mut impl FnMut((u32, usize), [LatticePoint; 3], [[i32; 3]; 3])) {
        self.below(tree, finest, (0, 0), lattice::root(self.levels()), self.corners(tree), f);
    }

    fn below(
        &self,
        tree: usize,
        finest: u32,
        (level, node): (u32, usize),
        places: [LatticePoint; 3],
        p: [[i32; 3]; 3],
        f: &mut impl FnMut((u32, usize), [LatticePoint; 3], [[i32; 3]; 3]),
    ) {
        if level < finest {
            let q = self.inserted(tree, level, node, p);
            f((level, node), places, q);
            for k in 0..4 {
                self.below(tree, finest, (level + 1, 4 * node + k), lattice::child(places, k as u32), child_corners(p, q, k), f); // k < 4
            }
        }
    }
}

/// Steps of the inserted vertices of node `node` of a last level, of this compact form, from the line that has them.
#[inline(always)]
pub fn last_displacements(form: VertexForm, line: &Line, node: usize) -> [Point; 3] {
    if form == VertexForm::Short { ShortLine::line_steps(line, node) } else { Displacements::line_half(line, node) }
}

/// The corners of child `k` of a triangle `p` with inserted vertices `q`.
#[inline]
pub fn child_corners(p: [[i32; 3]; 3], q: [[i32; 3]; 3], k: usize) -> [[i32; 3]; 3] {
    match k {
        0 => [p[0], q[2], q[1]],
        1 => [q[2], p[1], q[0]],
        2 => [q[1], q[0], p[2]],
        _ => q,
    }
}
