//! Clusters as they lie in memory: vertices of 16 bits a coordinate, triangles in pairs of four 8-bit indices.
//!
//! | bytes | what |
//! |---|---|
//! | 1 | vertices less one |
//! | 1 | pairs less one |
//! | 2 | nothing |
//! | 6 each | vertices: x, y, z, little-endian |
//! | 4 each | pairs: triangles (a, b, c) and (a, c, d); a triangle alone has d = a |
//!
//! Each begins with a line.

use super::graph::{Cluster, Graph};
use super::snapped::Place;
use rayon::prelude::*;
use std::collections::HashMap;

/// Most vertices of a cluster.
pub const MOST: usize = 256;
const HEADER: usize = 4;

/// The pairs of some triangles: neighbours over an edge, each triangle once, one alone where no neighbour is left. Whoever has the fewest free neighbours chooses first, and
/// chooses the one that has the fewest, so that few are left alone.
pub fn pairs(triangles: &[[u32; 3]]) -> Vec<[u32; 4]> {
    let mut over: HashMap<[u32; 2], usize> = HashMap::with_capacity(3 * triangles.len());
    for (at, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            over.insert([t[k], t[(k + 1) % 3]], at);
        }
    }
    // Of each its neighbours over its edges, itself where there is none.
    let next = |(at, t): (usize, &[u32; 3])| [0, 1, 2].map(|k| over.get(&[t[(k + 1) % 3], t[k]]).copied().unwrap_or(at));
    let neighbours: Vec<[usize; 3]> = triangles.par_iter().enumerate().map(next).collect();
    let across = |at: usize, k: usize| Some(neighbours[at][k]).filter(|&other| other != at);
    let mut is_paired = vec![false; triangles.len()];
    let mut free: Vec<usize> = (0..triangles.len()).map(|at| (0..3).filter(|&k| across(at, k).is_some()).count()).collect();
    let mut waiting: [Vec<usize>; 4] = Default::default();
    (0..triangles.len()).rev().for_each(|at| waiting[free[at]].push(at));
    let mut out = Vec::with_capacity(triangles.len() / 2 + 1);
    while let Some(at) = (0..4).find_map(|count| waiting[count].pop()) {
        if std::mem::replace(&mut is_paired[at], true) {
            continue;
        }
        let t = triangles[at];
        let neighbour = |k: usize| across(at, k).filter(|&other| !is_paired[other]).map(|other| (free[other], k, other));
        let chosen = (0..3).filter_map(neighbour).min();
        if let Some((_, k, other)) = chosen {
            is_paired[other] = true;
            // The shared edge is from c to a.
            let [c, a, b] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
            let far = triangles[other].into_iter().find(|&v| v != a && v != c).unwrap_or(a);
            out.push([a, b, c, far]);
        } else {
            out.push([t[0], t[1], t[2], t[0]]);
        }
        for gone in [Some(at), chosen.map(|(.., other)| other)].into_iter().flatten() {
            for other in (0..3).filter_map(|k| across(gone, k)).filter(|&other| !is_paired[other]) {
                free[other] = free[other].saturating_sub(1);
                waiting[free[other]].push(other);
            }
        }
    }
    out
}

/// The triangles of pairs.
pub fn unpaired(pairs: &[[u32; 4]]) -> impl Iterator<Item = [u32; 3]> {
    pairs.iter().flat_map(|&[a, b, c, d]| [Some([a, b, c]), (d != a).then_some([a, c, d])]).flatten()
}

/// A cluster's bytes.
///
/// # Panics
/// It has more vertices or pairs than a cluster can have.
pub fn pack(graph: &Graph, cluster: &Cluster) -> Vec<u8> {
    let pairs = pairs(&graph.triangles[cluster.triangles()]);
    let mut numbers: HashMap<u32, u8> = HashMap::new();
    let mut vertices: Vec<Place> = Vec::new();
    let mut indices = Vec::with_capacity(4 * pairs.len());
    for vertex in pairs.iter().flatten() {
        let number = numbers.entry(*vertex).or_insert_with(|| {
            vertices.push(graph.places[*vertex as usize]);
            u8::try_from(vertices.len() - 1).expect("at most 256 vertices")
        });
        indices.push(*number);
    }
    let mut bytes = Vec::with_capacity(HEADER + 6 * vertices.len() + indices.len());
    bytes.extend([vertices.len() - 1, pairs.len() - 1].map(|count| u8::try_from(count).expect("at most 256")));
    bytes.extend([0; 2]);
    bytes.extend(vertices.iter().flatten().flat_map(|c| c.to_le_bytes()));
    bytes.extend(indices);
    bytes
}

/// Corners of the triangles of a packed cluster, as places.
pub fn unpack(bytes: &[u8]) -> Vec<[Place; 3]> {
    let [vertices, pairs] = [0, 1].map(|k| usize::from(bytes[k]) + 1);
    let coordinate = |vertex: u32, k: usize| {
        let at = HEADER + 6 * vertex as usize + 2 * k;
        u16::from_le_bytes([bytes[at], bytes[at + 1]])
    };
    let indices = &bytes[HEADER + 6 * vertices..][..4 * pairs];
    let pairs: Vec<[u32; 4]> = indices.chunks_exact(4).map(|pair| std::array::from_fn(|k| u32::from(pair[k]))).collect();
    unpaired(&pairs).map(|t| t.map(|vertex| std::array::from_fn(|k| coordinate(vertex, k)))).collect()
}

/// Bytes of a cluster, its vertices, and where its first line lies among those of all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Its first line.
    pub first: u32,
    /// Its bytes.
    pub bytes: u32,
    /// Its vertices.
    pub vertices: u32,
}

impl Size {
    /// Of clusters of these bytes and vertices, each of which begins with a line.
    pub fn one_behind_the_other(own: Vec<[u32; 2]>) -> Vec<Self> {
        let mut first = 0;
        own.into_iter()
            .map(|[bytes, vertices]| {
                let size = Self { first, bytes, vertices };
                first += bytes.div_ceil(crate::num::LINE_BYTES as u32);
                size
            })
            .collect()
    }
}

/// The sizes of all clusters of a graph.
pub fn sizes(graph: &Graph) -> Vec<Size> {
    let of = |cluster: &Cluster| {
        let bytes = pack(graph, cluster);
        [bytes.len() as u32, u32::from(bytes[0]) + 1] // a few thousand
    };
    Size::one_behind_the_other(graph.clusters.par_iter().map(of).collect())
}
