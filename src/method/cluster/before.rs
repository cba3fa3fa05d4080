//! A frame's work: clusters are selected, those that were not there are unpacked and made nodes and leaves of, and a tree is built over all.
//!
//! The three follow each other on a real machine; here they run beside each other, as batches of work do: what takes time is what they read and write.

use super::frame::{FrameBvh, Owned};
use super::graph::Graph;
use super::map::{CLUSTERS, DESCRIPTOR_BYTES, DESCRIPTORS, GROUPS, NODE_LINES, ROOTS};
use super::packed::Size;
use super::works::{CHILD_ENCODE, GROUP_TEST, TRIANGLE_BIN, VERTEX_DECODE};
use crate::method::Before;
use crate::method::bvh::{LEAVES, NODES};
use crate::num::LINE_BYTES;
use crate::step::{Act, Batch, Fetch, MAX_FETCH_LINES, MemoryMap, Recorder, SectionId, Step, StepSink};
use std::ops::Range;
use std::sync::Arc;

/// Groups or clusters of a piece of work, where one alone is little; pieces of a batch.
const PIECE: usize = 16;
const PIECES: usize = 64;

/// The work before a frame.
pub struct Work<'a> {
    /// The graph.
    pub graph: &'a Graph,
    /// Where its clusters lie.
    pub sizes: &'a [Size],
    /// The memory of all frames.
    pub map: MemoryMap,
    /// What the frame's rays go through.
    pub frame: Arc<FrameBvh>,
    /// Clusters that are unpacked, by place in the cut.
    pub changed: Vec<u32>,
}

impl Work<'_> {
    /// Pieces of selection, of unpacking, and of the tree over all.
    fn pieces(&self) -> [usize; 3] {
        let fused = if self.changed.is_empty() { 0 } else { self.frame.cut.clusters.len().div_ceil(PIECE) };
        [self.frame.cut.asked.len().div_ceil(PIECE), self.changed.len(), fused]
    }

    /// The groups of a piece: a line each, and what is said of the clusters of those that do not serve.
    fn select(&self, groups: &[u32], steps: &mut Recorder) {
        for &group in groups {
            self.run(GROUPS, group..group + 1, false, steps);
            steps.step(Step::of(Act::Work { work: GROUP_TEST, count: 1 }));
            let of = self.graph.groups[group as usize];
            let line = |cluster: u32| (u64::from(cluster) * DESCRIPTOR_BYTES / LINE_BYTES) as u32; // 28 bits
            if of.count > 0 {
                self.run(DESCRIPTORS, line(of.first)..line(of.first + of.count - 1) + 1, false, steps);
            }
        }
    }

    /// A cluster: its bytes are read, its nodes, its leaves and its box are written.
    fn unpack(&self, at: u32, steps: &mut Recorder) {
        let cluster = self.frame.cut.clusters[at as usize];
        let Size { first, bytes, vertices } = self.sizes[cluster as usize];
        self.run(CLUSTERS, first..first + bytes.div_ceil(LINE_BYTES as u32), false, steps);
        let triangles = self.graph.clusters[cluster as usize].count;
        let own = &self.frame.owned[at as usize];
        // A triangle is binned once on each level of a balanced tree.
        let bins = triangles * (u32::BITS - triangles.leading_zeros());
        for (work, count) in [(VERTEX_DECODE, vertices), (TRIANGLE_BIN, bins), (CHILD_ENCODE, own.children + triangles)] {
            steps.step(Step::of(Act::Work { work, count }));
        }
        self.write(own, own.nodes.iter().copied(), steps);
        self.run(ROOTS, at..at + 1, true, steps);
    }

    /// A part of the tree over all clusters: their boxes are read, nodes are written.
    fn fuse(&self, piece: usize, pieces: usize, steps: &mut Recorder) {
        let clusters = self.frame.cut.clusters.len();
        let (first, end) = (PIECE * piece, clusters.min(PIECE * (piece + 1)));
        self.run(ROOTS, first as u32..end as u32, false, steps);
        let levels = u32::BITS - (clusters as u32).leading_zeros();
        let top = &self.frame.top;
        let share = |count: usize| count * piece / pieces..count * (piece + 1) / pieces;
        let nodes = &top.nodes[share(top.nodes.len())];
        let children = share(top.children as usize).len() as u32;
        for (work, count) in [(TRIANGLE_BIN, (end - first) as u32 * levels), (CHILD_ENCODE, children)] {
            steps.step(Step::of(Act::Work { work, count }));
        }
        let leaves = top.leaves[share(top.leaves.len())].to_vec();
        self.write(&Owned { nodes: Vec::new(), children: 0, leaves }, nodes.iter().copied(), steps);
    }

    /// Writes nodes and leaves.
    fn write(&self, own: &Owned, nodes: impl Iterator<Item = u32>, steps: &mut Recorder) {
        nodes.for_each(|node| self.run(NODES, NODE_LINES * node..NODE_LINES * (node + 1), true, steps));
        own.leaves.iter().for_each(|lines| self.run(LEAVES, lines.clone(), true, steps));
    }

    /// Lines of a section, all asked for at once.
    fn run(&self, section: SectionId, lines: Range<u32>, stores: bool, steps: &mut Recorder) {
        for first in lines.clone().step_by(MAX_FETCH_LINES as usize) {
            let count = MAX_FETCH_LINES.min(lines.end - first);
            let fetch = Fetch::new(section, self.map.line(section, first.into()), count);
            let fetch = if stores { fetch.storing() } else { fetch };
            steps.step(Step::on(if first == lines.start { fetch } else { fetch.joining() }, Act::Fetch));
        }
    }
}

impl Before for Work<'_> {
    fn batches(&self) -> usize {
        self.pieces().iter().sum::<usize>().div_ceil(PIECES)
    }

    fn batch(&self, batch: usize) -> Batch {
        let [selected, unpacked, fused] = self.pieces();
        let mut recorder = Recorder::default();
        let all = selected + unpacked + fused;
        for piece in batch * PIECES..all.min((batch + 1) * PIECES) {
            if piece < selected {
                let asked = &self.frame.cut.asked;
                self.select(&asked[PIECE * piece..asked.len().min(PIECE * (piece + 1))], &mut recorder);
            } else if piece < selected + unpacked {
                self.unpack(self.changed[piece - selected], &mut recorder);
            } else {
                self.fuse(piece - selected - unpacked, fused, &mut recorder);
            }
            recorder.step(Step::end(false, false));
        }
        recorder.work()
    }
}
