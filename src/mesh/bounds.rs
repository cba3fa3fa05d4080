//! Displacement bounds of all edges, bottom-up and across trees (`docs/numbers.md`: "Displacement bounds").
//!
//! True bounds are integers; level n of every tree follows from level n+1 of the same tree, then the borders that trees share take the
//! largest value of all sides before level n-1 begins.

use super::borders::SharedEdges;
use super::{BoundKind, EdgeCodes, edges_of_tree, lattice};
use crate::num::{bound_encode, bound_scale, length_ceil};
use rayon::prelude::*;

/// The codes for these points (snapped, `lattice::len(levels)` per tree, equal on both sides of shared base edges).
pub fn edge_codes(kind: BoundKind, levels: u32, points: &[[i32; 3]], shared: &SharedEdges) -> EdgeCodes {
    let mut codes = EdgeCodes { kind, ..EdgeCodes::default() };
    write_codes(levels, points, shared, &mut codes, &mut Vec::new());
    codes
}

/// The same into memory that there is; `bounds` is for use on the way.
pub(super) fn write_codes(levels: u32, points: &[[i32; 3]], shared: &SharedEdges, codes: &mut EdgeCodes, bounds: &mut Vec<u64>) {
    bounds.resize(points.len() / lattice::len(levels) * edges_of_tree(levels), 0);
    true_bounds(codes.kind, levels, points, shared, bounds);
    let scale = bound_scale(bounds.par_iter().copied().max().unwrap_or(0));
    codes.scale = scale;
    codes.codes.resize(bounds.len(), 0);
    codes.codes.par_iter_mut().zip(&*bounds).with_min_len(1 << 12).for_each(|(code, &bound)| *code = bound_encode(scale, bound));
}

/// True bounds in units, stored as [`EdgeCodes`] says.
fn true_bounds(kind: BoundKind, levels: u32, points: &[[i32; 3]], shared: &SharedEdges, bounds: &mut [u64]) {
    let (per_tree, edges) = (lattice::len(levels), edges_of_tree(levels));
    for level in (0..levels).rev() {
        bounds.par_chunks_mut(edges).zip(points.par_chunks(per_tree)).for_each(|(b, p)| level_bounds(kind, levels, level, p, b));
        merge_borders(level, edges, shared, bounds);
    }
}

/// Bounds of one level of one tree from the next finer level's.
fn level_bounds(kind: BoundKind, levels: u32, level: u32, points: &[[i32; 3]], bounds: &mut [u64]) {
    let (own, finer) = bounds[edges_of_tree(level)..].split_at_mut(super::edges_of_level(level));
    let k = 1u32 << level;
    let half = 1u32 << (levels - level - 1);
    let at = |i: u32, j: u32| points[lattice::index(levels, (i * half, j * half))];
    let mut next = own.iter_mut();
    for j in 0..k {
        for i in 0..k - j {
            // In steps of the finer level.
            let (x, y) = (2 * i, 2 * j);
            let (p, right, up) = (at(x, y), at(x + 2, y), at(x, y + 2));
            let lengths =
                [displacement(at(x + 1, y + 1), right, up), displacement(at(x, y + 1), up, p), displacement(at(x + 1, y), p, right)];
            let mut around = [0; 3];
            if level + 1 < levels {
                around = largest_around(k, i, j, finer);
            }
            for (length, around) in lengths.into_iter().zip(around) {
                if let Some(bound) = next.next() {
                    *bound = kind.of(length, around);
                }
            }
        }
    }
}

/// For each of the three edges of upward triangle (i, j) of a level with `k` steps: the largest bound of the next level's edges of this tree that
/// meet at its inserted vertex.
fn largest_around(k: u32, i: u32, j: u32, finer: &[u64]) -> [u64; 3] {
    let wide = 2 * k as usize;
    let (x, y) = (2 * i as usize, 2 * j as usize);
    // Edge `side` of upward triangle (x, y) of the finer level.
    let edge = |side: usize, x: usize, y: usize| finer[3 * (y * wide + x - y * y.saturating_sub(1) / 2) + side];
    // The two halves of the edge and the two edges into this upward triangle ...
    let mut m0 = edge(0, x + 1, y).max(edge(0, x, y + 1)).max(edge(2, x, y + 1)).max(edge(1, x + 1, y));
    let mut m1 = edge(1, x, y).max(edge(1, x, y + 1)).max(edge(2, x, y + 1)).max(edge(0, x, y));
    let mut m2 = edge(2, x, y).max(edge(2, x + 1, y)).max(edge(1, x + 1, y)).max(edge(0, x, y));
    // ... and the two into the triangle on the other side, if it is of this tree.
    if i + j + 1 < k {
        m0 = m0.max(edge(2, x + 1, y + 1)).max(edge(1, x + 1, y + 1));
    }
    if i > 0 {
        m1 = m1.max(edge(2, x - 1, y + 1)).max(edge(0, x - 1, y + 1));
    }
    if j > 0 {
        m2 = m2.max(edge(1, x + 1, y - 1)).max(edge(0, x + 1, y - 1));
    }
    [m0, m1, m2]
}

/// ceil |q - (a + b) / 2|.
#[inline]
fn displacement(q: [i32; 3], a: [i32; 3], b: [i32; 3]) -> u64 {
    // a + b is even (stored coordinates have zero low bits) and the difference of two points has 33 bits.
    length_ceil(std::array::from_fn(|c| i64::from(q[c]) - (i64::from(a[c]) + i64::from(b[c])) / 2))
}

/// Gives every shared border edge of a level the largest bound of all trees that have it.
fn merge_borders(level: u32, edges: usize, shared: &SharedEdges, bounds: &mut [u64]) {
    for uses in shared.edges().filter(|uses| uses.len() > 1) {
        for place in 0..1 << level {
            let index = |u: &super::borders::EdgeUse| u.tree as usize * edges + u.edge(level, place);
            let largest = uses.iter().map(|u| bounds[index(u)]).max().unwrap_or(0);
            for u in uses {
                bounds[index(u)] = largest;
            }
        }
    }
}
