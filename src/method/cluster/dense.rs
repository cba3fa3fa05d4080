//! Clusters as blocks of the dense geometry format, in steps of their grid: a second form, for comparison.

use super::graph::{Cluster, Graph};
use super::packed::Size;
use super::snapped::Place;
use crate::method::bvh::{DenseBlock, DenseStrip, dense_triangles};
use rayon::prelude::*;
use std::collections::HashMap;

/// Bytes of a block.
const BYTES: usize = size_of::<DenseBlock>();

/// The order of some triangles in which each goes on over an edge of the one before, as long as one can: of those that can the one with the fewest neighbours left.
fn strip(triangles: &[[u32; 3]]) -> Vec<usize> {
    let mut over: HashMap<[u32; 2], usize> = HashMap::with_capacity(3 * triangles.len());
    for (at, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            over.insert([t[k], t[(k + 1) % 3]], at);
        }
    }
    let next: Vec<[Option<usize>; 3]> = triangles.iter().map(|t| [0, 1, 2].map(|k| over.get(&[t[(k + 1) % 3], t[k]]).copied())).collect();
    let mut is_left = vec![true; triangles.len()];
    let mut order = Vec::with_capacity(triangles.len());
    // The last two: whoever goes on does so from one of them.
    let mut tail: [Option<usize>; 2] = [None; 2];
    while order.len() < triangles.len() {
        let left = |at: usize| next[at].iter().flatten().filter(|&&other| is_left[other]).count();
        let beside = |at: Option<usize>| at.into_iter().flat_map(|at| next[at]).flatten().filter(|&other| is_left[other]);
        let near = tail.into_iter().find_map(|at| beside(at).min_by_key(|&other| (left(other), other)));
        let Some(chosen) = near.or_else(|| (0..triangles.len()).filter(|&at| is_left[at]).min_by_key(|&at| (left(at), at))) else { break };
        is_left[chosen] = false;
        order.push(chosen);
        tail = [Some(chosen), tail[0]];
    }
    order
}

/// A cluster's blocks, and how many vertices they have.
///
/// # Panics
/// Never: places have 16 bits, so each triangle fits a block.
pub fn pack_dense(graph: &Graph, cluster: &Cluster) -> (Vec<DenseBlock>, usize) {
    let own = &graph.triangles[cluster.triangles()];
    let (mut blocks, mut vertices, mut first, mut count) = (Vec::new(), 0, 0, 0);
    let mut open = DenseStrip::default();
    let mut close = |strip: &DenseStrip, first: u32| {
        let coded = strip.block(first).expect("triangles on a grid of 16 bits");
        blocks.push(coded.block);
        vertices += coded.vertices;
    };
    for at in strip(own) {
        let triangle = own[at].map(|vertex| graph.places[vertex as usize].map(i32::from));
        let mut grown = open.clone();
        grown.push(triangle);
        if !grown.fits() {
            close(&open, first);
            (first, grown) = (count, DenseStrip::of([triangle]));
        }
        (open, count) = (grown, count + 1);
    }
    if !open.is_empty() {
        close(&open, first);
    }
    (blocks, vertices)
}

/// Corners of the triangles of such blocks, as places, as the blocks have turned them.
pub fn unpack_dense(blocks: &[DenseBlock]) -> Vec<[Place; 3]> {
    let mut all = Vec::new();
    for block in blocks {
        dense_triangles(block, |triangle| all.push(triangle.map(|place| place.map(|c| c as u16)))); // as they were
    }
    all
}

/// The sizes of all clusters of a graph in this form.
pub fn dense_sizes(graph: &Graph) -> Vec<Size> {
    let of = |cluster: &Cluster| {
        let (blocks, vertices) = pack_dense(graph, cluster);
        [blocks.len() * BYTES, vertices].map(|count| count as u32) // a few thousand
    };
    Size::one_behind_the_other(graph.clusters.par_iter().map(of).collect())
}
