//! What a traversal tells about itself while it runs.

use serde::Serialize;
use std::ops::Range;

/// What a memory line holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Quad-BVH node over base triangles or over the full-resolution mesh.
    BvhNode,
    /// L0 record: base triangle and root bound data.
    L0Record,
    /// Sibling group of bound data.
    BoundData,
    /// Inserted vertices.
    VertexData,
    /// Triangles of the full-resolution BVH: index triples and vertices, packed triangles or triangle lines.
    Leaf,
}

impl Kind {
    /// All kinds, in order of declaration.
    pub const ALL: [Self; 5] = [Self::BvhNode, Self::L0Record, Self::BoundData, Self::VertexData, Self::Leaf];

    /// Name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BvhNode => "bvh_node",
            Self::L0Record => "l0_record",
            Self::BoundData => "bound_data",
            Self::VertexData => "vertex_data",
            Self::Leaf => "leaf",
        }
    }
}

/// One section of a method's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Section {
    /// What it holds.
    pub kind: Kind,
    /// Its size in 32-byte lines.
    pub lines: u64,
}

/// Hears what a traversal does.
pub trait Probe {
    /// Line `line` of the section of `kind` is read.
    fn line(&mut self, kind: Kind, line: u64);
    /// A leaf of the full-resolution BVH is read, with the triangles in these slots.
    fn leaf(&mut self, slots: Range<usize>) {
        _ = slots;
    }
    /// A box test of four children ran, and `met` of them are met.
    fn node(&mut self, met: u32) {
        _ = met;
    }
    /// An LOD test ran, and decided to `refine` or not.
    fn lod_test(&mut self, refine: bool) {
        _ = refine;
    }
    /// A triangle test ran; `hit` if the ray meets it, closest or not.
    fn triangle(&mut self, hit: bool) {
        _ = hit;
    }
    /// A waiting node was taken from the stack, and `dropped` if it lies behind the closest hit.
    fn pop(&mut self, dropped: bool) {
        _ = dropped;
    }
}

/// Hears nothing.
pub struct NoProbe;

impl Probe for NoProbe {
    #[inline(always)]
    fn line(&mut self, _: Kind, _: u64) {}
}

/// Counts what rays do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Groups of four boxes tested.
    pub nodes: u64,
    /// LOD tests.
    pub lod_tests: u64,
    /// Triangle tests.
    pub triangles: u64,
    /// Lines read, by [`Kind`].
    pub lines: [u64; Kind::ALL.len()],
}

impl RayCounts {
    /// Adds the counts of `other`.
    pub fn add(&mut self, other: &Self) {
        self.nodes += other.nodes;
        self.lod_tests += other.lod_tests;
        self.triangles += other.triangles;
        for (a, b) in self.lines.iter_mut().zip(other.lines) {
            *a += b;
        }
    }
}

impl Probe for RayCounts {
    #[inline(always)]
    fn line(&mut self, kind: Kind, _: u64) {
        self.lines[kind as usize] += 1;
    }
    #[inline(always)]
    fn node(&mut self, _: u32) {
        self.nodes += 1;
    }
    #[inline(always)]
    fn lod_test(&mut self, _: bool) {
        self.lod_tests += 1;
    }
    #[inline(always)]
    fn triangle(&mut self, _: bool) {
        self.triangles += 1;
    }
}
