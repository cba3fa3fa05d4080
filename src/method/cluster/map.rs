//! Memory of clusters: a frame's BVH, and all that it is made from.

use super::frame::FrameBvh;
use super::graph::Graph;
use super::packed::Size;
use crate::method::bvh::{NODES, bvh_map};
use crate::num::LINE_BYTES;
use crate::step::{MemoryMap, Section, SectionId};

/// Groups, a line each: sphere, error, box, clusters.
pub const GROUPS: SectionId = SectionId::new(2);
/// What is said of clusters.
pub const DESCRIPTORS: SectionId = SectionId::new(3);
/// Packed clusters.
pub const CLUSTERS: SectionId = SectionId::new(4);
/// Boxes of the clusters of a frame, a line each: what the tree over all is built of.
pub const ROOTS: SectionId = SectionId::new(5);

/// Bytes of what is said of a cluster: its group, its first line, its vertices and triangles.
pub const DESCRIPTOR_BYTES: u64 = 16;
/// Lines of a node of six.
pub const NODE_LINES: u32 = 2;

/// The memory of frames after one another: each one's BVH lies where the others' did.
///
/// # Panics
/// It has more lines than can be numbered.
pub fn map(graph: &Graph, sizes: &[Size], frames: impl Iterator<Item: AsRef<FrameBvh>>) -> MemoryMap {
    let lines = frames.map(|frame| {
        let frame = frame.as_ref();
        let own = bvh_map(&[&frame.bvh]);
        let [nodes, leaves] = [0, 1].map(|section| own.sections().nth(section).map_or(0, |(_, section)| section.lines));
        [nodes, leaves, frame.cut.clusters.len() as u64]
    });
    let [nodes, leaves, boxes] = lines.reduce(|a, b| std::array::from_fn(|k| a[k].max(b[k]))).unwrap_or_default();
    let section = |name, lines| Section { name, lines, base: false };
    let sections = [
        section("bvh_node", nodes),
        section("leaf", leaves),
        section("group", graph.groups.len() as u64),
        Section::of_bytes("descriptor", DESCRIPTOR_BYTES * graph.clusters.len() as u64),
        section("cluster", sizes.iter().map(|size| u64::from(size.bytes).div_ceil(LINE_BYTES)).sum()),
        section("cluster_box", boxes),
    ];
    MemoryMap::new(&sections, Some((NODES, NODE_LINES))).expect("at most 2^28 triangles, of a few lines each")
}
