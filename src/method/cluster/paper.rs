//! The graph of Benthin and Peters (2023): clusters are subtrees of up to 128 quads of a BVH over quads, and pairs of clusters are merged bottom-up by the least area of the box around both.
//!
//! A round takes every pair of which each is the other's best (PLOC). What a pair holds is simplified to half with its border kept; it is one cluster then, or, if it is still too large, two
//! that are decided about together: they share one box. A pair that cannot be simplified stays as it is, and its clusters end the graph there.

use super::graph::{Graph, Made};
use super::packed::{MOST, pairs, unpaired};
use super::snapped::Snapped;
use crate::bvh::Box32;
use crate::bvh::build::{Binary, Prim, binary_tree};
use meshopt::{SimplifyOptions, VertexDataAdapter, simplify};
use rayon::prelude::*;
use std::collections::HashMap;

/// Most quads of a cluster.
const MOST_QUADS: usize = 128;
/// Neighbours on either side along the curve that a cluster looks at for the best to merge with.
const RADIUS: usize = 16;
/// What a merged pair may keep of its triangles, at most.
const STUCK: f64 = 0.85;
/// Triangles that two clusters are simplified to, at most: half of theirs, and so few that one cluster holds them although not all find partners.
const MOST_MERGED: usize = 2 * MOST_QUADS * 15 / 16;
/// Merges of a cluster that come to nothing until it is left as it is.
const TRIES: usize = 4;
/// Binary nodes on a path of a BVH over quads, at most twice this.
const DEPTH: u32 = 20;

/// A cluster that may still be merged.
struct Active {
    triangles: Vec<[u32; 3]>,
    /// The group that it was made of.
    refined: Option<u32>,
    bounds: Box32,
    /// Which it is.
    number: u32,
    /// Others with which a merge came to nothing.
    refused: Vec<u32>,
}

/// What a merge came to.
enum Merged {
    /// One cluster or two, and the error.
    Parts(Vec<Vec<[u32; 3]>>, f64),
    /// As it was.
    Failed,
}

/// The graph of a mesh.
pub(super) fn graph(mesh: Snapped) -> Graph {
    let mut numbers = 0..;
    let mut new = |triangles: Vec<[u32; 3]>, refined| {
        let number = numbers.next().unwrap_or(u32::MAX); // fewer than triangles
        Active { bounds: bounds(&mesh, &triangles), triangles, refined, number, refused: Vec::new() }
    };
    let mut active: Vec<Active> = first_clusters(&mesh).into_iter().map(|triangles| new(triangles, None)).collect();
    let mut made = Vec::new();
    let mut ended = Vec::new();
    while active.len() > 1 {
        active.par_sort_by_cached_key(|own| morton(&mesh, &own.bounds));
        let best = best_partners(&active);
        let chosen: Vec<[usize; 2]> = (0..active.len()).filter(|&k| k < best[k] && best[best[k]] == k).map(|k| [k, best[k]]).collect();
        if chosen.is_empty() {
            // No two that are near each other suit each other.
            break;
        }
        let merged: Vec<Merged> = chosen.par_iter().map(|&[a, b]| merge(&mesh, &active[a], &active[b])).collect();
        let mut slots: Vec<Option<Active>> = active.drain(..).map(Some).collect();
        for ([a, b], merged) in chosen.into_iter().zip(merged) {
            let both = [a, b].map(|at| slots[at].take().expect("pairs are apart"));
            match merged {
                Merged::Failed => {
                    let numbers = both.each_ref().map(|own| own.number);
                    for (mut own, other) in both.into_iter().zip([numbers[1], numbers[0]]) {
                        own.refused.push(other);
                        // Another partner may serve it.
                        if own.refused.len() < TRIES { active.push(own) } else { ended.push(own) }
                    }
                }
                Merged::Parts(parts, error) => {
                    let number = made.len() as u32; // fewer than triangles
                    let clusters = both.into_iter().map(|own| (own.triangles, own.refined)).collect();
                    made.push(Made { clusters, error, sphere: None });
                    active.extend(parts.into_iter().map(|triangles| new(triangles, Some(number))));
                }
            }
        }
        active.extend(slots.into_iter().flatten());
    }
    // What is left is never replaced.
    for own in ended.into_iter().chain(active) {
        made.push(Made { clusters: vec![(own.triangles, own.refined)], error: f64::INFINITY, sphere: None });
    }
    Graph::new(mesh, made)
}

impl Active {
    /// Whether a merge with another may come to something: not of two parts of one merge, which were simplified together as far as their border allows, nor where it was tried.
    fn suits(&self, other: &Self) -> bool {
        (self.refined.is_none() || self.refined != other.refined) && !self.refused.contains(&other.number)
    }
}

fn bounds(mesh: &Snapped, triangles: &[[u32; 3]]) -> Box32 {
    let boxes = triangles.iter().map(|t| Box32::of_triangle(t.map(|v| mesh.point(v))));
    boxes.reduce(|all, own| all.union(&own)).unwrap_or_default()
}

/// Subtrees of up to 128 quads, and as many vertices as indices can number.
fn first_clusters(mesh: &Snapped) -> Vec<Vec<[u32; 3]>> {
    split(mesh, &pairs(&mesh.triangles))
}

/// Parts that fit clusters, by the tree of such quads.
fn split(mesh: &Snapped, quads: &[[u32; 4]]) -> Vec<Vec<[u32; 3]>> {
    if fits(quads) {
        return vec![unpaired(quads).collect()];
    }
    let bounds = |quad: &[u32; 4]| {
        let [a, b, c, d] = quad.map(|v| mesh.point(v));
        Box32::of_triangle([a, b, c]).union(&Box32::of_triangle([a, c, d]))
    };
    let mut prims: Vec<Prim> = (0..).zip(quads).map(|(id, quad)| Prim::new(&bounds(quad), id)).collect();
    let tree = binary_tree(&mut prims, DEPTH);
    let ordered: Vec<[u32; 4]> = prims.iter().map(|prim| quads[prim.id as usize]).collect();
    let mut out = Vec::new();
    parts(&tree, &ordered, 0, ordered.len(), tree.root, &mut out);
    out
}

fn parts(tree: &Binary, quads: &[[u32; 4]], begin: usize, end: usize, at: u32, out: &mut Vec<Vec<[u32; 3]>>) {
    let own = &quads[begin..end];
    if fits(own) {
        return out.push(unpaired(own).collect());
    }
    let node = &tree.nodes[at as usize - 1];
    parts(tree, quads, begin, at as usize, node.left, out);
    parts(tree, quads, at as usize, end, node.right, out);
}

/// Whether quads are few enough for a cluster, with few enough vertices.
fn fits(quads: &[[u32; 4]]) -> bool {
    quads.len() <= 1
        || quads.len() <= MOST_QUADS && {
            let mut vertices: Vec<u32> = quads.iter().flatten().copied().collect();
            vertices.sort_unstable();
            vertices.dedup();
            vertices.len() <= MOST
        }
}

/// Place of a box's middle along Morton's curve.
fn morton(mesh: &Snapped, bounds: &Box32) -> u64 {
    let spread = |v: u64| (0..16).fold(0u64, |all, bit| all | (v >> bit & 1) << (3 * bit));
    (0..3).fold(0, |all, k| {
        let middle = (i64::from(bounds.lo[k]) + i64::from(bounds.hi[k])) / 2 - i64::from(mesh.grid.lo[k]);
        all | spread((middle / i64::from(mesh.grid.step)) as u64) << k // 16 bits
    })
}

/// Of each the other one near it along the curve with which it has the smallest box; the first of several.
fn best_partners(active: &[Active]) -> Vec<usize> {
    let best = |k: usize| {
        let near =
            (k.saturating_sub(RADIUS)..active.len().min(k + RADIUS + 1)).filter(|&other| other != k && active[k].suits(&active[other]));
        let area = |other: usize| active[k].bounds.union(&active[other].bounds).half_area();
        near.map(|other| (area(other), other)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(k, |(_, other)| other)
    };
    (0..active.len()).into_par_iter().map(best).collect()
}

/// Simplifies what two hold, together.
fn merge(mesh: &Snapped, a: &Active, b: &Active) -> Merged {
    let all: Vec<u32> = a.triangles.iter().chain(&b.triangles).flatten().copied().collect();
    let mut numbers = HashMap::new();
    let mut own: Vec<u32> = Vec::new();
    let indices: Vec<u32> = all
        .iter()
        .map(|&vertex| {
            *numbers.entry(vertex).or_insert_with(|| {
                own.push(vertex);
                own.len() as u32 - 1 // a few hundred
            })
        })
        .collect();
    let positions: Vec<[f32; 3]> = own.iter().map(|&v| mesh.places[v as usize].map(f32::from)).collect();
    let vertices = VertexDataAdapter::new(bytemuck::cast_slice(&positions), size_of::<[f32; 3]>(), 0).expect("whole vertices");
    let target = (indices.len() / 6).min(MOST_MERGED) * 3;
    let mut error = 0.0;
    let options = SimplifyOptions::LockBorder | SimplifyOptions::ErrorAbsolute;
    let kept = simplify(&indices, &vertices, target, f32::MAX, options, Some(&mut error));
    let triangles: Vec<[u32; 3]> = kept.chunks_exact(3).map(|t| [t[0], t[1], t[2]].map(|v| own[v as usize])).collect();
    if triangles.is_empty() || triangles.len() as f64 > STUCK * (indices.len() / 3) as f64 {
        return Merged::Failed;
    }
    let parts = split(mesh, &pairs(&triangles));
    // More parts than there were: nothing is won.
    if parts.len() > 2 { Merged::Failed } else { Merged::Parts(parts, f64::from(error) * f64::from(mesh.grid.step)) }
}
