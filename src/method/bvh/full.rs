//! The baseline: a quad-BVH over the full-resolution triangles of a hierarchy.
//!
//! Trees of different options over one hierarchy differ in how the same binary tree is collapsed: [`FullBuilder`] makes that once. Their leaves hold
//! the triangles in the same order, so that BVHs may share them.

use super::finest::Finest;
use super::{LeafLayout, Leaves};
use crate::bvh::build::{Binary, Prim, binary_tree};
use crate::bvh::{
    BvhError, Costs, MAX_DEPTH, Node16, Node32, Options, QuadNode, check_options, collapse, encode_line, encode16, encode32, side_by_side,
};
use crate::format::Line;
use crate::mesh::Hierarchy;
use rayon::prelude::*;
use std::sync::Arc;

/// How nodes hold their children's boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NodeBoxes {
    /// Steps of 5 bits in a frame of the node's own: 32 bytes a node.
    Local,
    /// Codes of 16 bits: 64 bytes.
    Codes,
    /// Coordinates of 32 bits: 128 bytes.
    Wide,
}

impl NodeBoxes {
    /// Those of 16 bits or fewer, of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "local" => Some(Self::Local),
            "codes" => Some(Self::Codes),
            _ => None,
        }
    }
}

/// How a [`FullBvh`] is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullOptions {
    /// The tree.
    pub tree: Options,
    /// The boxes.
    pub boxes: NodeBoxes,
    /// The leaves.
    pub layout: LeafLayout,
}

impl FullOptions {
    /// Leaves of at most `max_leaf` triangles, with costs that suit the layout: measured on the terrain, cheap triangles save an indexed layout
    /// 9 % of the lines near by, because neighbours share their vertices, and cost the others 3 % far away.
    pub fn new(max_leaf: u32, boxes: NodeBoxes, layout: LeafLayout) -> Self {
        let primitive = if layout == LeafLayout::Indexed { 0.25 } else { 0.5 };
        let costs = Costs { primitive, ..Costs::default() };
        Self { tree: Options { costs, ..Options::with_leaf(max_leaf) }, boxes, layout }
    }
}

/// Nodes in one of the encodings; node 0 is the root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FullNodes {
    /// 32 bytes each.
    Local(Vec<Line>),
    /// 64 bytes each.
    Boxes16(Vec<Node16>),
    /// 128 bytes each.
    Boxes32(Vec<Node32>),
}

impl FullNodes {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        match self {
            Self::Local(n) => n.len(),
            Self::Boxes16(n) => n.len(),
            Self::Boxes32(n) => n.len(),
        }
    }

    /// Never: there is a root.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Local(n) => size_of_val(n.as_slice()) as u64,
            Self::Boxes16(n) => size_of_val(n.as_slice()) as u64,
            Self::Boxes32(n) => size_of_val(n.as_slice()) as u64,
        }
    }
}

/// A quad-BVH's tree, before its triangles lie in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FullTree {
    /// Number of splits N of the hierarchy.
    pub(super) levels: u32,
    pub(super) nodes: FullNodes,
    /// Full-resolution triangle ids in leaf order, each once.
    pub(super) ids: Vec<u32>,
}

impl FullTree {
    /// The nodes, and full-resolution triangle ids in leaf order: those of a leaf stand where its reference says.
    pub fn into_parts(self) -> (FullNodes, Vec<u32>) {
        (self.nodes, self.ids)
    }

    /// The BVH, over the hierarchy that the tree was built over.
    ///
    /// # Errors
    /// A hierarchy that does not add up, or of other triangles.
    pub fn with_leaves(self, hierarchy: &Hierarchy, layout: LeafLayout) -> Result<FullBvh, BvhError> {
        let leaves = Arc::new(Leaves::new(hierarchy, self.ids, layout)?);
        Ok(FullBvh { levels: self.levels, nodes: Arc::new(self.nodes), leaves })
    }
}

/// Builds trees over a hierarchy, with whatever options.
pub struct FullBuilder {
    levels: u32,
    /// In leaf order.
    prims: Vec<Prim>,
    binary: Binary,
}

impl FullBuilder {
    /// Builds the binary tree.
    ///
    /// # Errors
    /// No or too many triangles, too many levels, points missing or beyond the coordinate limit.
    pub fn new(hierarchy: &Hierarchy) -> Result<Self, BvhError> {
        let mut prims = Finest::new(hierarchy)?.primitives();
        let binary = binary_tree(&mut prims, MAX_DEPTH);
        Ok(Self { levels: hierarchy.levels, prims, binary })
    }

    /// Collapses it.
    ///
    /// # Errors
    /// Illegal options.
    pub fn tree(&self, options: &Options, boxes: NodeBoxes) -> Result<FullTree, BvhError> {
        check_options(options)?;
        let source = collapse::BinaryTree::new(&self.prims, &self.binary, options);
        let mut ids: Vec<u32> = self.prims.par_iter().map(|p| p.id).collect();
        let nodes = match boxes {
            NodeBoxes::Local => {
                let mut nodes: Vec<QuadNode> = collapse::nodes(&source, MAX_DEPTH, |n| *n);
                ids = side_by_side(&mut nodes, &ids);
                FullNodes::Local(nodes.par_iter().map(encode_line).collect())
            }
            NodeBoxes::Codes => FullNodes::Boxes16(collapse::nodes(&source, MAX_DEPTH, encode16)),
            NodeBoxes::Wide => FullNodes::Boxes32(collapse::nodes(&source, MAX_DEPTH, encode32)),
        };
        Ok(FullTree { levels: self.levels, nodes, ids })
    }
}

/// Quad-BVH over the full-resolution triangles of a hierarchy; leaf references count slots of `leaves`. BVHs may share both parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FullBvh {
    /// Number of splits N of the hierarchy.
    pub levels: u32,
    /// The nodes.
    pub nodes: Arc<FullNodes>,
    /// The triangles.
    pub leaves: Arc<Leaves>,
}

impl FullBvh {
    /// Builds over `hierarchy`.
    ///
    /// # Errors
    /// No or too many triangles, too many levels, points missing or beyond the coordinate limit, or illegal options.
    pub fn build(hierarchy: &Hierarchy, options: &FullOptions) -> Result<Self, BvhError> {
        check_options(&options.tree)?;
        let tree = FullBuilder::new(hierarchy)?.tree(&options.tree, options.boxes)?;
        tree.with_leaves(hierarchy, options.layout)
    }
}
