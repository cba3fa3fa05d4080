//! Normals of the finest level: those of the points of the original that its vertices stand for.

use super::super::distance::Vec3;
use super::super::lattice;
use super::source::Source;
use super::split::{Forest, triangles};
use super::topology::Topology;
use rayon::prelude::*;

/// Cosine of the angle between a vertex's normal and its faces from which the original has a bump there: 60 degrees.
const BUMP: f64 = 0.5;

/// The normal across the original's edges is the better one if its cosine is greater by this.
const BETTER: f64 = 0.03;

/// One unit normal for each lattice point, interpolated from `corner_normals` of the original's triangles.
///
/// A point on a crease has one normal in each tree, that of the tree's side.
///
/// Where the mesh has no normals of its own (`own_normals`), a triangle of the original that turns away from the faces of the result is a bump
/// smaller than these: a sliver of a scan, for instance, whose normal would darken all triangles around the vertex that lies on it. There the
/// normal is that of the surface around, bounded by feature lines alone, or the faces'.
pub(super) fn shade(
    source: &Source,
    topology: &Topology,
    forest: &Forest,
    corner_normals: &[[[f32; 3]; 3]],
    own_normals: bool,
) -> Vec<[f32; 3]> {
    let (levels, len) = (forest.levels, lattice::len(forest.levels));
    let mut normals = vec![[0.0; 3]; forest.positions.len()];
    normals.par_chunks_exact_mut(len).enumerate().for_each(|(t, normals)| {
        let faces = faces(&forest.positions[t * len..][..len], levels);
        for (i, normal) in normals.iter_mut().enumerate() {
            let found = match topology.own[t] {
                Some(own) => source.target.closest_on(own, forest.positions[t * len + i]),
                None => {
                    forest.origin(t * len + i).or_else(|| one_side(source, topology.patches[t], forest.positions[t * len + i], faces[i]))
                }
            };
            let smooth = found.and_then(|(triangle, w)| {
                let corners = corner_normals[triangle as usize];
                (0..3).map(|k| Vec3::from(corners[k].map(f64::from)) * w[k]).sum::<Vec3>().try_normalize()
            });
            let face = faces[i].try_normalize();
            let around = found.map(|(triangle, barycentrics)| source.normal_at(triangle, barycentrics));
            // Normals that cancel out leave the face's, or any.
            let unit = match (smooth, around, face) {
                (Some(smooth), Some(around), Some(face)) if !own_normals => {
                    let best = if around.dot(face) > smooth.dot(face) + BETTER { around } else { smooth };
                    if best.dot(face) < BUMP { face } else { best }
                }
                _ => smooth.or(face).unwrap_or(Vec3::Z),
            };
            *normal = unit.to_array().map(|v| v as f32);
        }
    });
    normals
}

/// For each point of a tree the sum of the normals of its finest triangles there, weighed by area.
fn faces(tree: &[Vec3], levels: u32) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; tree.len()];
    for corners in triangles(1 << levels, 1) {
        let [a, b, c] = corners.map(|p| lattice::index(levels, p));
        let normal = (tree[b] - tree[a]).cross(tree[c] - tree[a]);
        [a, b, c].into_iter().for_each(|i| sums[i] += normal);
    }
    sums
}

/// The closest triangle of the patch that faces the same way, and where on it: on a feature line, that on the patch's side.
fn one_side(source: &Source, patch: u32, p: Vec3, face: Vec3) -> Option<(u32, [f64; 3])> {
    let ours = |t: u32| source.patch[t as usize] == patch;
    let faces = |t: u32| ours(t) && source.face_normal[t as usize].dot(face) > 0.0;
    // Far more than a vertex on a line is away, and little enough to be quick.
    let near = 0.02 * source.diagonal;
    let hit = source
        .target
        .closest(p, near, faces)
        .or_else(|| source.target.closest(p, near, ours))
        .or_else(|| source.target.closest(p, 1e9, ours))?;
    Some((hit.triangle, hit.barycentrics))
}

/// For each triangle of the finest level one of the original near it, in the order of [`finest_corners`]; `u32::MAX` where none is known.
pub(super) fn finest_origins(topology: &Topology, forest: &Forest) -> Vec<u32> {
    let (levels, len) = (forest.levels, lattice::len(forest.levels));
    let origin = |t: usize, node| {
        if let Some(own) = topology.own[t] {
            return own;
        }
        let corners = lattice::node(levels, levels, node);
        corners.into_iter().find_map(|p| forest.origin(t * len + lattice::index(levels, p))).map_or(u32::MAX, |o| o.0)
    };
    let trees = forest.positions.len() / len;
    (0..trees).into_par_iter().flat_map_iter(|t| (0..1u32 << (2 * levels)).map(move |node| origin(t, node))).collect()
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
