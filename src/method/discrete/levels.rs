//! A hierarchy's levels, each as a mesh of its own.

use crate::mesh::{EdgeCodes, Hierarchy, edges_of_tree, lattice};
use crate::num::bound_decode;

/// The triangles of one level, as a hierarchy that ends there; it has no bounds.
pub(super) fn at_level(hierarchy: &Hierarchy, level: u32) -> Hierarchy {
    let (levels, shift) = (hierarchy.levels, hierarchy.levels - level);
    let side = 1u32 << level;
    let places: Vec<usize> =
        (0..=side).flat_map(|j| (0..=side - j).map(move |i| lattice::index(levels, (i << shift, j << shift)))).collect();
    Hierarchy {
        levels: level,
        placement: hierarchy.placement,
        base_vertices: hierarchy.base_vertices,
        triangles: hierarchy.triangles.clone(),
        points: (0..hierarchy.triangles.len()).flat_map(|tree| places.iter().map(move |&at| hierarchy.tree(tree)[at])).collect(),
        bounds: EdgeCodes::default(),
        vertices: hierarchy.vertices,
        zeros: hierarchy.zeros,
    }
}

/// Largest displacement bound of the edges of each level, in units; 0 for the finest.
pub(super) fn largest_bounds(hierarchy: &Hierarchy) -> Vec<u64> {
    let mut codes = vec![0; hierarchy.levels as usize + 1];
    for tree in 0..hierarchy.triangles.len() {
        for (level, most) in (0..hierarchy.levels).zip(&mut codes) {
            let own = &hierarchy.codes(tree)[edges_of_tree(level)..edges_of_tree(level + 1)];
            *most = own.iter().copied().fold(*most, u8::max);
        }
    }
    codes.into_iter().map(|code| bound_decode(hierarchy.bounds.scale, code)).collect()
}
