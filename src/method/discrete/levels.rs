//! What a hierarchy's levels are off.

use crate::mesh::{Hierarchy, edges_of_tree};
use crate::num::bound_decode;

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
