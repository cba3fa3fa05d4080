//! Where its lines lie.

use super::tree::{LEAF_LINES, NODE_LINES, TRIPLE_BYTES, Tree};
use crate::num::LINE_BYTES;
use crate::step::{MemoryMap, Section, SectionId};

/// Nodes.
pub(super) const NODES: SectionId = SectionId::new(0);
/// Index triples of leaves.
pub(super) const LEAVES: SectionId = SectionId::new(1);
/// Vertices.
pub(super) const VERTICES: SectionId = SectionId::new(2);

/// Where the lines of a tree lie.
///
/// # Panics
/// It has more than can be numbered: more than 2^28 triangles.
pub fn memory(tree: &Tree) -> MemoryMap {
    let sections = [
        Section::of_bytes("bvh_node", NODE_LINES * LINE_BYTES * tree.nodes.len() as u64),
        Section::of_bytes("leaf", LEAF_LINES * LINE_BYTES * tree.leaves() as u64),
        Section::of_bytes("vertex_data", TRIPLE_BYTES * tree.vertices.len() as u64),
    ];
    // Of each of at most 2^28 triangles at worst a leaf of six lines, two nodes and two lines of vertices.
    MemoryMap::new(&sections, Some((NODES, NODE_LINES as u32))).expect("fewer than 2^32 lines")
}
