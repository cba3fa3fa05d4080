//! What bounds the nodes of primitives' trees, four siblings together: spheres, as the paper has them, or what could stand in their place.

use super::pattern::{first_of_depth, points, within};
use super::sphere::radius;
use crate::bvh::{Box32, Child, QuadNode, encode_line};
use crate::format::{Line, node_prisms};
use crate::mesh::lattice::{self, LatticePoint};
use crate::num::prism::Prisms;
use rayon::prelude::*;

/// The kind of bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Bounding {
    /// Around a third of the sum of a triangle's corners, a radius of 32 bits each.
    #[default]
    Spheres,
    /// Boxes in the frame of the siblings, as nodes of `bvh` have them: 32 bytes for four. They need no vertices.
    Boxes,
    /// Prisms over the triangles, as trees of `lod` may have them: 67 bits for four, in 9 bytes.
    Prisms,
}

impl Bounding {
    /// Bytes of four siblings.
    pub const fn bytes(self) -> u64 {
        match self {
            Self::Spheres => 16,
            Self::Boxes => 32,
            Self::Prisms => 9,
        }
    }

    /// Name of their section.
    pub const fn section(self) -> &'static str {
        match self {
            Self::Spheres => "radius",
            Self::Boxes => "box",
            Self::Prisms => "prism",
        }
    }
}

/// Bounds of the children of each node that has some, primitive by primitive, breadth first.
#[derive(Clone, Debug, PartialEq)]
pub enum Bounds {
    /// Radii.
    Spheres(Vec<[f32; 4]>),
    /// Lines of nodes, whose references mean nothing.
    Boxes(Vec<Line>),
    /// Prisms.
    Prisms(Vec<Prisms>),
}

/// Nodes of a primitive whose children have bounds: those above depth `bounded`.
#[inline(always)]
pub const fn groups(bounded: u32) -> usize {
    first_of_depth(bounded)
}

/// A node whose children have bounds.
struct Group {
    corners: [LatticePoint; 3],
    /// Levels below its children.
    below: u32,
    /// Of each child, the corners and all vertices of its triangle, by place in the lattice's order.
    children: [([usize; 3], Vec<usize>); 4],
}

impl Group {
    fn new(splits: u32, depth: u32, node: u32) -> Self {
        let (corners, below) = (lattice::node(splits, depth, node), splits - depth - 1);
        let place = |at| lattice::index(splits, at);
        let child = |k: usize| {
            let p = lattice::child(corners, k as u32); // below 4
            (p.map(place), points(below).map(|at| place(within(p, below, at))).collect())
        };
        Self { corners, below, children: std::array::from_fn(child) }
    }

    /// Equations 1 and 2.
    fn spheres(&self, vertices: &[[i32; 3]]) -> [f32; 4] {
        self.children.each_ref().map(|(corners, below)| {
            let sum = std::array::from_fn(|k| corners.iter().map(|&at| i64::from(vertices[at][k])).sum());
            radius(sum, below.iter().map(|&at| vertices[at]))
        })
    }

    fn boxes(&self, vertices: &[[i32; 3]]) -> Line {
        let bounds = |(_, below): &([usize; 3], Vec<usize>)| {
            let point = |at: usize| Box32 { lo: vertices[at], hi: vertices[at] };
            below.iter().fold(point(below[0]), |bounds, &at| bounds.union(&point(at)))
        };
        encode_line(&QuadNode { boxes: self.children.each_ref().map(bounds), children: [0, 1, 2, 3].map(Child::Inner) })
    }

    fn prisms(&self, splits: u32, vertices: &[[i32; 3]]) -> Prisms {
        node_prisms(self.corners, self.below, &|at| vertices[lattice::index(splits, at)])
    }
}

/// Primitives worked on by a thread at a time.
const CHUNK: usize = 64;

impl Bounds {
    /// Those of `count` primitives of `splits` splits, of which the upper `bounded` levels have bounds; `vertices` puts a primitive's vertices in the lattice's order.
    pub fn new(kind: Bounding, splits: u32, bounded: u32, count: usize, vertices: impl Fn(usize, &mut Vec<[i32; 3]>) + Sync) -> Self {
        let nodes = (0..bounded).flat_map(|depth| (0..1u32 << (2 * depth)).map(move |node| (depth, node)));
        let own: Vec<Group> = nodes.map(|(depth, node)| Group::new(splits, depth, node)).collect();
        match kind {
            Bounding::Spheres => Self::Spheres(filled(&own, count, vertices, Group::spheres)),
            Bounding::Boxes => Self::Boxes(filled(&own, count, vertices, Group::boxes)),
            Bounding::Prisms => Self::Prisms(filled(&own, count, vertices, |group, vertices| group.prisms(splits, vertices))),
        }
    }

    /// Bytes of all.
    pub fn bytes(&self) -> u64 {
        let (kind, count) = match self {
            Self::Spheres(all) => (Bounding::Spheres, all.len()),
            Self::Boxes(all) => (Bounding::Boxes, all.len()),
            Self::Prisms(all) => (Bounding::Prisms, all.len()),
        };
        kind.bytes() * count as u64
    }

    /// The kind.
    pub fn kind(&self) -> Bounding {
        match self {
            Self::Spheres(_) => Bounding::Spheres,
            Self::Boxes(_) => Bounding::Boxes,
            Self::Prisms(_) => Bounding::Prisms,
        }
    }
}

/// What `of` makes of each group of each primitive.
fn filled<T: Copy + Default + Send>(
    own: &[Group],
    count: usize,
    vertices: impl Fn(usize, &mut Vec<[i32; 3]>) + Sync,
    of: impl Fn(&Group, &[[i32; 3]]) -> T + Sync,
) -> Vec<T> {
    let mut all = vec![T::default(); count * own.len()];
    if own.is_empty() {
        return all;
    }
    all.par_chunks_mut(own.len() * CHUNK).enumerate().for_each(|(chunk, all)| {
        let mut held = Vec::new();
        for (primitive, to) in (chunk * CHUNK..).zip(all.chunks_mut(own.len())) {
            held.clear();
            vertices(primitive, &mut held);
            to.iter_mut().zip(own).for_each(|(to, group)| *to = of(group, &held));
        }
    });
    all
}
