//! Memory of BVHs.

use crate::method::mesh_bvh::{FullBvh, FullNodes};
use crate::step::{MemoryMap, Section, SectionId};

/// Nodes.
pub const NODES: SectionId = SectionId::new(0);

/// Triangles: index triples and vertices, packed triangles, triangle lines or leaf blocks.
pub const LEAVES: SectionId = SectionId::new(1);

/// The memory of some BVHs with boxes of one kind: the nodes of all, then the leaves of all.
///
/// # Panics
/// They have more lines than can be numbered: more than 2^28 triangles.
pub fn bvh_map(bvhs: &[&FullBvh]) -> MemoryMap {
    let sum = |bytes: fn(&FullBvh) -> u64| bvhs.iter().map(|bvh| bytes(bvh).next_multiple_of(crate::num::LINE_BYTES)).sum();
    let sections = [Section::of_bytes("bvh_node", sum(|bvh| bvh.nodes.bytes())), Section::of_bytes("leaf", sum(|bvh| bvh.leaves.bytes()))];
    let lines = bvhs.first().map_or(1, |bvh| node_lines(&bvh.nodes));
    MemoryMap::new(&sections, Some((NODES, lines))).expect("at most 2^28 triangles, of at most eight lines each with their nodes")
}

/// Lines of a node.
pub(super) fn node_lines(nodes: &FullNodes) -> u32 {
    match nodes {
        FullNodes::Local(_) => 1,
        FullNodes::Boxes16(_) | FullNodes::Six(_) => 2,
        FullNodes::Boxes32(_) => 4,
    }
}
