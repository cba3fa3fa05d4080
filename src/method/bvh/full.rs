//! The baseline: a quad-BVH over the full-resolution triangles of a hierarchy.
//!
//! Trees of different options over one hierarchy differ in how the same binary tree is collapsed: [`FullBuilder`] makes that once. Their leaves hold
//! the triangles in the same order, so that BVHs may share them.

use super::finest::Finest;
use super::leaves::{BlockSize, MOST_LINES, MOST_TRIANGLES, block_lines};
use super::{LeafLayout, Leaves};
use crate::bvh::build::{Binary, Prim, binary_tree};
use crate::bvh::order::by_treelets;
use crate::bvh::plan::LeafCost;
use crate::bvh::{
    BvhError, Child, Costs, MAX_DEPTH, Node16, Node32, Options, QuadNode, check_count, check_options, collapse, encode_line, encode16,
    encode32, side_by_side,
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
    /// Bytes of a node.
    pub const fn node_bytes(self) -> usize {
        match self {
            Self::Local => 32,
            Self::Codes => 64,
            Self::Wide => 128,
        }
    }

    /// Those of 16 bits or fewer, of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "local" => Some(Self::Local),
            "codes" => Some(Self::Codes),
            _ => None,
        }
    }
}

/// Where nodes lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum NodeOrder {
    /// Depth first, siblings together.
    #[default]
    Depth,
    /// By treelets that fill a row of DRAM: 2 KB.
    Treelets,
}

impl NodeOrder {
    /// The order of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "depth" => Some(Self::Depth),
            "treelets" => Some(Self::Treelets),
            _ => None,
        }
    }
}

/// Bytes of a treelet.
const TREELET_BYTES: usize = 2048;

/// How a [`FullBvh`] is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullOptions {
    /// The tree.
    pub tree: Options,
    /// The boxes.
    pub boxes: NodeBoxes,
    /// The leaves.
    pub layout: LeafLayout,
    /// Where its nodes lie.
    pub order: NodeOrder,
}

impl FullOptions {
    /// Leaves of at most `max_leaf` triangles, or as many as the layout allows, with costs that suit the layout: measured on the terrain, cheap triangles
    /// save an indexed layout 9 % of the lines near by, because neighbours share their vertices, and cost the others 3 % far away. A block's lines lie side
    /// by side, which costs less than as many nodes.
    pub fn new(max_leaf: u32, boxes: NodeBoxes, layout: LeafLayout) -> Self {
        let (primitive, line) = match layout {
            LeafLayout::Indexed => (0.25, 0.0),
            LeafLayout::Packed | LeafLayout::Line => (0.5, 0.0),
            LeafLayout::Block => (0.03, 0.35),
        };
        let costs = Costs { primitive, line, ..Costs::default() };
        let max_leaf = max_leaf.min(layout.most_triangles());
        Self { tree: Options { costs, ..Options::with_leaf(max_leaf) }, boxes, layout, order: NodeOrder::default() }
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
    pub(super) nodes: Arc<FullNodes>,
    /// Full-resolution triangle ids in leaf order, each once.
    pub(super) ids: Vec<u32>,
    /// Sizes of its leaf blocks in that order, if its leaves are blocks.
    pub(super) blocks: Vec<BlockSize>,
}

impl FullTree {
    /// The nodes.
    pub fn nodes(&self) -> Arc<FullNodes> {
        Arc::clone(&self.nodes)
    }

    /// Whether leaves of another tree over the same hierarchy may stand below this one's nodes.
    pub fn has_leaves_of(&self, other: &Self) -> bool {
        self.ids == other.ids && self.blocks == other.blocks
    }

    /// Leaves over the hierarchy that the tree was built over.
    ///
    /// # Errors
    /// A hierarchy that does not add up, or of other triangles; blocks where the tree has none.
    pub fn leaves(&self, hierarchy: &Hierarchy, layout: LeafLayout) -> Result<Leaves, BvhError> {
        Leaves::new(hierarchy, self.ids.clone(), layout, &self.blocks)
    }

    /// The BVH, over the hierarchy that the tree was built over.
    ///
    /// # Errors
    /// Those of [`FullTree::leaves`].
    pub fn with_leaves(self, hierarchy: &Hierarchy, layout: LeafLayout) -> Result<FullBvh, BvhError> {
        let leaves = Arc::new(Leaves::new(hierarchy, self.ids, layout, &self.blocks)?);
        Ok(FullBvh { levels: self.levels, nodes: self.nodes, leaves })
    }
}

/// Builds trees over a hierarchy, with whatever options.
pub struct FullBuilder<'a> {
    mesh: Finest<'a>,
    /// In leaf order.
    prims: Vec<Prim>,
    binary: Binary,
}

impl<'a> FullBuilder<'a> {
    /// Builds the binary tree.
    ///
    /// # Errors
    /// No or too many triangles, too many levels, points missing or beyond the coordinate limit.
    pub fn new(hierarchy: &'a Hierarchy) -> Result<Self, BvhError> {
        let mesh = Finest::new(hierarchy)?;
        let mut prims = mesh.primitives();
        let binary = binary_tree(&mut prims, MAX_DEPTH);
        Ok(Self { mesh, prims, binary })
    }

    /// Collapses it.
    ///
    /// # Errors
    /// Illegal options, or leaf blocks of more lines than references can name.
    pub fn tree(&self, options: &FullOptions) -> Result<FullTree, BvhError> {
        let FullOptions { tree: options, boxes, layout, order } = options;
        check_options(options, layout.most_triangles())?;
        let (of_block, of_triangles) = (self.block_cost(options), options.leaf_cost());
        let is_block = *layout == LeafLayout::Block;
        let leaf: &LeafCost<'_> = if is_block { &of_block } else { &of_triangles };
        let source = collapse::BinaryTree::new(&self.prims, &self.binary, options, leaf);
        let mut ids: Vec<u32> = self.prims.par_iter().map(|p| p.id).collect();
        let mut blocks = Vec::new();
        let nodes = if *boxes == NodeBoxes::Local || is_block || *order != NodeOrder::Depth {
            let mut nodes: Vec<QuadNode> = collapse::nodes(&source, MAX_DEPTH, |n| *n);
            if *order == NodeOrder::Treelets {
                nodes = by_treelets(&nodes, TREELET_BYTES / boxes.node_bytes());
            }
            ids = side_by_side(&mut nodes, &ids);
            if is_block {
                blocks = self.to_blocks(&mut nodes, &ids)?;
            }
            match boxes {
                NodeBoxes::Local => FullNodes::Local(nodes.par_iter().map(encode_line).collect()),
                NodeBoxes::Codes => FullNodes::Boxes16(nodes.par_iter().map(encode16).collect()),
                NodeBoxes::Wide => FullNodes::Boxes32(nodes.par_iter().map(encode32).collect()),
            }
        } else if *boxes == NodeBoxes::Codes {
            FullNodes::Boxes16(collapse::nodes(&source, MAX_DEPTH, encode16))
        } else {
            FullNodes::Boxes32(collapse::nodes(&source, MAX_DEPTH, encode32))
        };
        Ok(FullTree { levels: self.mesh.levels, nodes: Arc::new(nodes), ids, blocks })
    }

    /// Lines of the block of some triangles.
    fn lines(&self, ids: impl Iterator<Item = u32>) -> Option<u32> {
        let mut triangles = [[[0; 3]; 3]; MOST_TRIANGLES];
        let mut count = 0;
        for id in ids {
            *triangles.get_mut(count)? = self.mesh.triangle(id);
            count += 1;
        }
        block_lines(&triangles[..count])
    }

    /// What a leaf block costs for each unit of its area, if it fits.
    fn block_cost(&self, options: &Options) -> impl Fn(&[Prim]) -> Option<f64> + Sync {
        let Options { max_leaf, costs, .. } = *options;
        move |prims| {
            let fits = prims.len() <= max_leaf as usize;
            let lines = if fits { self.lines(prims.iter().map(|p| p.id)) } else { None };
            Some(costs.primitive * prims.len() as f64 + costs.line * f64::from(lines?))
        }
    }

    /// Gives leaves, which stand side by side, the lines of their blocks in place of their triangles.
    fn to_blocks(&self, nodes: &mut [QuadNode], ids: &[u32]) -> Result<Vec<BlockSize>, BvhError> {
        let size = |first: u32, count: u8| {
            let own = &ids[first as usize..][..usize::from(count)];
            // Every leaf was planned to fit.
            BlockSize::new(own.len(), self.lines(own.iter().copied()).unwrap_or(MOST_LINES as u32))
        };
        let of_node = |node: &QuadNode| {
            node.children.map(|child| if let Child::Leaf { first, count } = child { Some(size(first, count)) } else { None })
        };
        let sizes: Vec<[Option<BlockSize>; 4]> = nodes.par_iter().map(of_node).collect();
        let mut next = 0;
        for (node, sizes) in nodes.iter_mut().zip(&sizes) {
            for (child, size) in node.children.iter_mut().zip(sizes) {
                if let Some(size) = size {
                    *child = Child::Leaf { first: next, count: size.lines() as u8 }; // 1 to 4
                    next += size.lines(); // at most two for each triangle
                }
            }
        }
        check_count(u64::from(next))?;
        Ok(sizes.into_iter().flatten().flatten().collect())
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
        check_options(&options.tree, options.layout.most_triangles())?;
        let tree = FullBuilder::new(hierarchy)?.tree(options)?;
        tree.with_leaves(hierarchy, options.layout)
    }
}
