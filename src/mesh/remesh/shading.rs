//! Normals of the finest level: smooth, but not across creases, borders and non-manifold edges.

use super::super::distance::Vec3;
use super::super::lattice;
use super::split::{Forest, side_point, triangles};
use super::topology::Topology;
use rayon::prelude::*;

/// One unit normal for each lattice point, and the number of triangles that face away from the original at their corners.
pub(super) fn shade(topology: &Topology, forest: &Forest) -> (Vec<[f32; 3]>, u64) {
    let (m, levels, len) = (1u32 << forest.levels, forest.levels, lattice::len(forest.levels));
    let index = |p| lattice::index(levels, p);
    let mut normals = vec![Vec3::ZERO; forest.positions.len()];
    let flipped = normals
        .par_chunks_exact_mut(len)
        .enumerate()
        .map(|(t, normals)| {
            let tree = &forest.positions[t * len..][..len];
            let mut flipped = 0u64;
            for corners in triangles(m, 1) {
                let [a, b, c] = corners.map(index);
                // Its length weighs by area.
                let normal = (tree[b] - tree[a]).cross(tree[c] - tree[a]);
                let surface: Vec3 = [a, b, c].into_iter().map(|i| forest.surface_normal(t * len + i)).sum();
                flipped += u64::from(normal.dot(surface) < 0.0);
                [a, b, c].into_iter().for_each(|i| normals[i] += normal);
            }
            flipped
        })
        .sum();

    for edge in topology.edges.iter().filter(|e| e.smooth) {
        for s in 1..m {
            let places: Vec<usize> =
                (edge.uses.iter()).map(|&(t, k)| t as usize * len + index(side_point(m, k, topology.sides[t as usize][k].1, s))).collect();
            let sum = places.iter().map(|&i| normals[i]).sum();
            places.iter().for_each(|&i| normals[i] = sum);
        }
    }
    let (sets, count) = topology.smooth_corners();
    let mut sums = vec![Vec3::ZERO; count];
    let place = |c: usize| (c / 3) * len + index(lattice::root(levels)[c % 3]);
    sets.iter().enumerate().for_each(|(c, &set)| sums[set as usize] += normals[place(c)]);
    sets.iter().enumerate().for_each(|(c, &set)| normals[place(c)] = sums[set as usize]);

    let unit = |(i, n): (usize, &Vec3)| {
        // Triangles that cancel out or have no area leave the original's normal, or any.
        let n = n.try_normalize().or_else(|| forest.surface_normal(i).try_normalize()).unwrap_or(Vec3::Z);
        n.to_array().map(|v| v as f32)
    };
    (normals.par_iter().enumerate().map(unit).collect(), flipped)
}

/// Corners of all triangles of the finest level, in the order of their nodes, so that neighbours stand together.
pub(super) fn finest_corners(forest: &Forest) -> Vec<[Vec3; 3]> {
    let levels = forest.levels;
    let corners = |tree: &[Vec3], node| lattice::node(levels, levels, node).map(|p| tree[lattice::index(levels, p)]);
    forest
        .positions
        .par_chunks_exact(lattice::len(levels))
        .flat_map_iter(|tree| (0..1u32 << (2 * levels)).map(move |node| corners(tree, node)))
        .collect()
}
