//! A frame's BVH over its clusters: one of each cluster, and one over all of them, as nodes of six.

use super::cut::Cut;
use super::graph::Graph;
use crate::bvh::build::{Binary, Prim, binary_tree};
use crate::bvh::{BinaryNode, Box32, BvhError};
use crate::format::ChildRef;
use crate::mesh::{EdgeCodes, Hierarchy, Placement};
use crate::method::bvh::{FullBuilder, FullBvh, FullOptions};
use crate::num::{LINE_BYTES, VertexForm};
use rayon::prelude::*;
use std::ops::Range;

/// Binary nodes on a path within a cluster, at most twice this; and of the tree over clusters: together those of a tree of six.
const OF_CLUSTER: u32 = 8;
const OF_ALL: u32 = crate::bvh::MAX_DEPTH_OF_SIX - OF_CLUSTER;

/// What a frame's rays go through.
pub struct FrameBvh {
    /// The clusters.
    pub cut: Cut,
    /// The BVH. Its triangles are numbered by their places in the cut.
    pub bvh: FullBvh,
    /// Of each triangle of the cut its number among those of all clusters.
    pub triangles: Vec<u32>,
    /// What is written for each cluster of the cut.
    pub owned: Vec<Owned>,
    /// What is written for all: the nodes above them.
    pub top: Owned,
}

/// Lines of nodes and of leaves.
#[derive(Clone, Debug, Default)]
pub struct Owned {
    /// Nodes, by number.
    pub nodes: Vec<u32>,
    /// Children that nodes have.
    pub children: u32,
    /// Lines of leaves.
    pub leaves: Vec<Range<u32>>,
}

impl FrameBvh {
    /// The BVH over a cut.
    ///
    /// # Errors
    /// There is nothing in it, or more triangles than a BVH holds.
    pub fn new(graph: &Graph, cut: Cut, options: &FullOptions) -> Result<Self, BvhError> {
        let mut firsts = Vec::with_capacity(cut.clusters.len() + 1);
        let mut triangles = Vec::new();
        for &cluster in &cut.clusters {
            firsts.push(triangles.len() as u32);
            triangles.extend(graph.clusters[cluster as usize].triangles().map(|triangle| triangle as u32));
        }
        firsts.push(triangles.len() as u32);
        let hierarchy = graph.hierarchy(&triangles);
        let tree = binary(graph, &cut, &firsts);
        let bvh = FullBuilder::with_binary(&hierarchy, &tree)?.tree(options)?.with_leaves(&hierarchy, options.layout)?;
        let (owned, top) = owned(&bvh, &firsts);
        Ok(Self { cut, bvh, triangles, owned, top })
    }
}

impl Graph {
    /// Some of its triangles as a hierarchy of no splits, in units.
    pub fn hierarchy(&self, triangles: &[u32]) -> Hierarchy {
        Hierarchy {
            levels: 0,
            placement: Placement { offset: [0.0; 3], scale: 1.0 },
            base_vertices: self.places.len() as u32, // fewer than 2^30
            triangles: triangles.iter().map(|&own| self.triangles[own as usize]).collect(),
            points: triangles.iter().flat_map(|&own| self.corners(own as usize)).collect(),
            bounds: EdgeCodes::default(),
            vertices: VertexForm::Exact,
            zeros: 0,
        }
    }
}

/// The tree over the clusters, whose leaves are those of each cluster's triangles.
fn binary(graph: &Graph, cut: &Cut, firsts: &[u32]) -> Vec<BinaryNode> {
    let of_cluster = |at: usize| {
        let own = graph.clusters[cut.clusters[at] as usize].triangles();
        let mut prims: Vec<Prim> =
            (firsts[at]..).zip(own).map(|(id, triangle)| Prim::new(&Box32::of_triangle(graph.corners(triangle)), id)).collect();
        let tree = binary_tree(&mut prims, OF_CLUSTER);
        (tree, prims)
    };
    let clusters: Vec<(Binary, Vec<Prim>)> = (0..cut.clusters.len()).into_par_iter().map(of_cluster).collect();
    let mut prims: Vec<Prim> = (0..).zip(&cut.clusters).map(|(id, &own)| Prim::new(&graph.clusters[own as usize].bounds, id)).collect();
    if prims.is_empty() {
        return Vec::new();
    }
    let tree = binary_tree(&mut prims, OF_ALL);
    let mut out = Vec::with_capacity(2 * firsts.last().map_or(0, |&count| count as usize));
    append(&tree, &prims, 0..prims.len(), tree.root, &mut out, &|cluster, out| {
        let (tree, prims) = &clusters[cluster as usize];
        append(tree, prims, 0..prims.len(), tree.root, out, &|triangle, out| {
            out.push(BinaryNode::Leaf(triangle));
            out.len() as u32 - 1 // at most 2^29
        })
    });
    out
}

/// Appends a tree over `prims` of this range, which is split at `at`; a single one is what `leaf` appends of it. Where its root is.
fn append(
    tree: &Binary,
    prims: &[Prim],
    range: Range<usize>,
    at: u32,
    out: &mut Vec<BinaryNode>,
    leaf: &dyn Fn(u32, &mut Vec<BinaryNode>) -> u32,
) -> u32 {
    if range.len() == 1 {
        return leaf(prims[range.start].id, out);
    }
    let own = out.len();
    out.push(BinaryNode::Inner([0; 2]));
    let node = &tree.nodes[at as usize - 1];
    let lower = append(tree, prims, range.start..at as usize, node.left, out, leaf);
    let upper = append(tree, prims, at as usize..range.end, node.right, out, leaf);
    out[own] = BinaryNode::Inner([lower, upper]);
    own as u32 // at most 2^29
}

/// What of a BVH is each cluster's, and what is above them. A node is a cluster's if all below it is.
fn owned(bvh: &FullBvh, firsts: &[u32]) -> (Vec<Owned>, Owned) {
    let is_written = vec![false; bvh.leaves.bytes().div_ceil(LINE_BYTES) as usize]; // 32 bits: the map says so
    let mut owners = Owners { bvh, firsts, owned: vec![Owned::default(); firsts.len() - 1], top: Owned::default(), is_written };
    owners.node(0);
    (owners.owned, owners.top)
}

struct Owners<'a> {
    bvh: &'a FullBvh,
    firsts: &'a [u32],
    owned: Vec<Owned>,
    top: Owned,
    /// Of each line of leaves, so that one that several leaves share is written once, with the first.
    is_written: Vec<bool>,
}

impl Owners<'_> {
    /// The cluster whose triangle this is.
    fn cluster(&self, triangle: u32) -> usize {
        self.firsts.partition_point(|&first| first <= triangle) - 1
    }

    fn of(&mut self, owner: Option<usize>) -> &mut Owned {
        match owner {
            Some(cluster) => &mut self.owned[cluster],
            None => &mut self.top,
        }
    }

    /// Who owns a node, if one cluster does.
    fn node(&mut self, at: usize) -> Option<usize> {
        let mut all: Option<Option<usize>> = None;
        let mut children = 0;
        for child in self.bvh.nodes.children(at) {
            let index = child.index.get() as usize;
            let owner = match child.kind.get() {
                ChildRef::INNER => self.node(index),
                ChildRef::LEAF => self.leaf(index, child.count.get() as usize + 1),
                _ => continue,
            };
            children += 1;
            all = Some(match all {
                None => owner,
                Some(before) if before == owner => owner,
                Some(_) => None,
            });
        }
        let owner = all.flatten();
        let own = self.of(owner);
        own.nodes.push(at as u32); // 28 bits
        own.children += children;
        owner
    }

    fn leaf(&mut self, index: usize, count: usize) -> Option<usize> {
        let leaf = self.bvh.leaves.leaf(index, count);
        let (mut least, mut most) = (u32::MAX, 0);
        self.bvh.leaves.triangles(&leaf, |_, id| (least, most) = (least.min(id), most.max(id)));
        let [first, last] = [self.cluster(least), self.cluster(most)];
        let owner = (first == last).then_some(first);
        let mut lines: Vec<Range<u32>> = Vec::new();
        self.bvh.leaves.lines(&leaf, |address| {
            let line = (address / LINE_BYTES) as u32; // 32 bits: the map says so
            if std::mem::replace(&mut self.is_written[line as usize], true) {
                return;
            }
            match lines.last_mut() {
                Some(last) if last.end == line => last.end += 1,
                _ => lines.push(line..line + 1),
            }
        });
        self.of(owner).leaves.extend(lines);
        owner
    }
}
