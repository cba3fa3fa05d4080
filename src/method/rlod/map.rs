//! Memory of a kd-tree with R-LODs.

use super::tree::Tree;
use crate::step::{MemoryMap, Section, SectionId};

/// Nodes.
pub const NODES: SectionId = SectionId::new(0);
/// References, four bytes each.
pub const REFERENCES: SectionId = SectionId::new(1);
/// Triangles, a line each.
pub const TRIANGLES: SectionId = SectionId::new(2);
/// R-LODs, a line each.
pub const RLODS: SectionId = SectionId::new(3);

/// The memory of a tree.
///
/// # Panics
/// It has more lines than can be numbered.
pub fn map(tree: &Tree) -> MemoryMap {
    let [nodes, references, triangles, rlods] = tree.bytes();
    let sections = [
        Section::of_bytes("kd_node", nodes),
        Section::of_bytes("reference", references),
        Section::of_bytes("triangle", triangles),
        Section::of_bytes("rlod", rlods),
    ];
    MemoryMap::new(&sections, Some((NODES, 1))).expect("at most 2^30 nodes, references and triangles")
}
