//! The mesh in the making, and how far removal goes.

use super::super::source::Source;
use super::quadric::{Cost, Quadric};
use crate::mesh::distance::Vec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// How far removal goes.
#[derive(Clone, Copy, Debug)]
pub(in crate::mesh::remesh) struct Goal {
    /// It stops at this many triangles.
    pub triangles: usize,
    /// Cosine of the largest angle between a triangle and those of the original over it.
    pub facing: f64,
    /// Largest distance between them, in lengths of the triangle's longest side.
    pub distance: f64,
}

/// What the queue knows of a vertex.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Known {
    /// It is not in there.
    Nothing,
    /// Its cost.
    Cost,
    /// What was its cost before something changed around it: found out again when it is its turn.
    Stale,
}

/// The mesh in the making. A triangle keeps the number, and so the patch, of one of the original.
#[derive(Clone)]
pub(super) struct Mesh<'a> {
    pub source: &'a Source,
    pub keep: Vec<bool>,
    pub triangles: Vec<[u32; 3]>,
    pub wedges: Vec<[u32; 3]>,
    pub alive: Vec<bool>,
    pub count: usize,
    pub over: Vec<Vec<u32>>,
    /// Triangles around each vertex.
    pub around: Vec<Vec<u32>>,
    /// Neighbours of each vertex along feature lines.
    pub lines: Vec<Vec<u32>>,
    pub quadrics: Vec<Quadric>,
    /// What each vertex's quadric gives at the vertex.
    pub own_cost: Vec<f64>,
    /// Vertices by cost, each once at most.
    pub queue: BinaryHeap<Reverse<(Cost, u32)>>,
    /// What is known of each vertex's cost.
    pub known: Vec<Known>,
    pub removed: Vec<u32>,
    pub removals: u32,
    /// For each triangle of the original its middle.
    pub middles: Arc<Vec<Vec3>>,
}

/// The two corners that are not `v`.
pub(super) fn other(tri: [u32; 3], v: u32) -> [u32; 2] {
    let k = tri.iter().position(|&w| w == v).unwrap_or(0);
    [tri[(k + 1) % 3], tri[(k + 2) % 3]]
}
