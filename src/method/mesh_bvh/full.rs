//! The baseline: a BVH over the full-resolution triangles of a hierarchy; or over others that cover it.
//!
//! Trees of different options over one hierarchy differ in how the same binary tree is collapsed: [`FullBuilder`] makes that once. Their leaves hold
//! the triangles in the same order, so that BVHs may share them.

use super::cut::Corners;
use super::dense;
use super::leaves::{BlockSize, DENSE_PLACES, MOST_LINES, MOST_TRIANGLES, block_lines, in_dense_range};
use super::{LeafLayout, Leaves};
use crate::bvh::build::{Binary, Prim, binary_tree};
use crate::bvh::collapse::{self, BinaryTree};
use crate::bvh::foreign::adopt;
use crate::bvh::order::{by_halves, by_levels, by_treelets};
use crate::bvh::orient::{Leaves as Below, orient};
use crate::bvh::plan::LeafCost;
use crate::bvh::{
    BinaryNode, BvhError, Child, Costs, MAX_DEPTH, MAX_DEPTH_OF_SIX, MAX_LEAF, Node6, Node16, Node32, Options, WideNode, check_count,
    check_options, encode_line, encode6, encode16, encode32, side_by_side,
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
    /// Of six children, not four: steps of 8 bits in a frame of the node's own, 64 bytes.
    Six,
    /// The same, but the frame is turned by whichever of a few rotations suits the node.
    Oriented,
}

impl NodeBoxes {
    /// Bytes of a node.
    pub const fn node_bytes(self) -> usize {
        match self {
            Self::Local => 32,
            Self::Codes | Self::Six | Self::Oriented => 64,
            Self::Wide => 128,
        }
    }

    /// Those of 16 bits or fewer in nodes of four, of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "local" => Some(Self::Local),
            "codes" => Some(Self::Codes),
            _ => None,
        }
    }

    /// Those in nodes of six, of this name.
    pub fn named_of_six(name: &str) -> Option<Self> {
        match name {
            "local" => Some(Self::Six),
            "oriented" => Some(Self::Oriented),
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
    /// Level by level.
    Levels,
    /// Van Emde Boas': the upper levels, then what is below each of their nodes, each again so.
    VanEmdeBoas,
}

impl NodeOrder {
    /// The order of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "depth" => Some(Self::Depth),
            "treelets" => Some(Self::Treelets),
            "levels" => Some(Self::Levels),
            "veb" => Some(Self::VanEmdeBoas),
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
    /// by side, which costs less than as many nodes. Dense blocks are the fuller the larger leaves are: swept on two meshes and a terrain.
    pub fn new(max_leaf: u32, boxes: NodeBoxes, layout: LeafLayout) -> Self {
        let (primitive, line) = match layout {
            LeafLayout::Indexed => (0.25, 0.0),
            LeafLayout::Packed | LeafLayout::Line => (0.5, 0.0),
            LeafLayout::Block => (0.03, 0.35),
            LeafLayout::Dgf => (0.03, 0.0),
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
    /// 64 bytes each, of six children.
    Six(Vec<Node6>),
}

impl FullNodes {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        match self {
            Self::Local(n) => n.len(),
            Self::Boxes16(n) => n.len(),
            Self::Boxes32(n) => n.len(),
            Self::Six(n) => n.len(),
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
            Self::Six(n) => size_of_val(n.as_slice()) as u64,
        }
    }
}

/// A BVH's tree, before its triangles lie in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FullTree {
    /// Number of splits N of the hierarchy.
    pub(super) levels: u32,
    pub(super) nodes: Arc<FullNodes>,
    /// Ids of its triangles ([`cut_id`](super::cut_id)) in leaf order, each once.
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

/// Builds trees over triangles of a hierarchy, with whatever options.
pub struct FullBuilder<'a> {
    mesh: Corners<'a>,
    /// In leaf order.
    prims: Vec<Prim>,
    binary: Binary,
}

impl<'a> FullBuilder<'a> {
    /// Builds the binary tree over the finest triangles.
    ///
    /// # Errors
    /// No or too many triangles, too many levels, points missing or beyond the coordinate limit.
    pub fn new(hierarchy: &'a Hierarchy) -> Result<Self, BvhError> {
        let mesh = Corners::new(hierarchy)?;
        let prims = mesh.primitives(0..mesh.count() as u32); // at most 2^28
        Ok(Self::of(mesh, prims))
    }

    /// Builds it over the triangles of a cut, by the ids of [`cut_id`](super::cut_id).
    ///
    /// # Errors
    /// Those of [`FullBuilder::new`], and triangles that do not cover the hierarchy, each part once.
    pub fn of_cut(hierarchy: &'a Hierarchy, ids: Vec<u32>) -> Result<Self, BvhError> {
        let mesh = Corners::new(hierarchy)?;
        if !mesh.are_covered_once_by(&ids) {
            return Err(BvhError::OtherHierarchy);
        }
        let prims = mesh.primitives(ids);
        Ok(Self::of(mesh, prims))
    }

    fn of(mesh: Corners<'a>, mut prims: Vec<Prim>) -> Self {
        // For nodes of four children and of six alike.
        let binary = binary_tree(&mut prims, MAX_DEPTH_OF_SIX);
        Self { mesh, prims, binary }
    }

    /// Takes a binary tree over the finest triangles, by their ids, that something else built.
    ///
    /// # Errors
    /// Those of [`FullBuilder::new`], and a tree that is none over all of them or has a path of more than 40 nodes.
    pub fn with_binary(hierarchy: &'a Hierarchy, tree: &[BinaryNode]) -> Result<Self, BvhError> {
        let mesh = Corners::new(hierarchy)?;
        let (prims, binary) = adopt(&mesh.primitives(0..mesh.count() as u32), tree, MAX_DEPTH_OF_SIX).ok_or(BvhError::ForeignTree)?;
        Ok(Self { mesh, prims, binary })
    }

    /// Expected cost, by the surface area heuristic, of a ray that meets the root's box of the tree of these options.
    ///
    /// # Errors
    /// Illegal options.
    pub fn sah_cost(&self, options: &FullOptions) -> Result<f64, BvhError> {
        match options.boxes {
            NodeBoxes::Six | NodeBoxes::Oriented => self.collapsed(options, |source: &BinaryTree<'_, 6>| source.cost()),
            NodeBoxes::Local | NodeBoxes::Codes | NodeBoxes::Wide => self.collapsed(options, |source: &BinaryTree<'_, 4>| source.cost()),
        }
    }

    /// Collapses it.
    ///
    /// # Errors
    /// Illegal options, or leaf blocks of more lines than references can name.
    pub fn tree(&self, options: &FullOptions) -> Result<FullTree, BvhError> {
        let ids = || self.prims.par_iter().map(|p| p.id).collect();
        let all = |nodes, (ids, blocks)| FullTree { levels: self.mesh.levels, nodes: Arc::new(nodes), ids, blocks };
        let has_blocks = matches!(options.layout, LeafLayout::Block | LeafLayout::Dgf);
        let as_collapsed = !has_blocks && options.order == NodeOrder::Depth;
        Ok(match options.boxes {
            // Nodes of such boxes can be encoded one by one.
            NodeBoxes::Codes if as_collapsed => all(FullNodes::Boxes16(self.nodes(options, MAX_DEPTH, encode16)?), (ids(), Vec::new())),
            NodeBoxes::Wide if as_collapsed => all(FullNodes::Boxes32(self.nodes(options, MAX_DEPTH, encode32)?), (ids(), Vec::new())),
            NodeBoxes::Six => {
                let (nodes, rest) = self.laid_out::<6>(options, MAX_DEPTH_OF_SIX)?;
                all(FullNodes::Six(nodes.par_iter().map(|node| encode6(node, 0)).collect()), rest)
            }
            NodeBoxes::Oriented => {
                let (mut nodes, mut ids) = self.in_order::<6>(options, MAX_DEPTH_OF_SIX)?;
                let rotations = self.orient(options, &mut nodes, &ids);
                let blocks = self.blocks(options, &mut nodes, &mut ids)?;
                let nodes = nodes.par_iter().zip(rotations).map(|(node, rotation)| encode6(node, rotation));
                all(FullNodes::Six(nodes.collect()), (ids, blocks))
            }
            NodeBoxes::Local | NodeBoxes::Codes | NodeBoxes::Wide => {
                let (nodes, rest) = self.laid_out(options, MAX_DEPTH)?;
                let nodes = match options.boxes {
                    NodeBoxes::Codes => FullNodes::Boxes16(nodes.par_iter().map(encode16).collect()),
                    NodeBoxes::Wide => FullNodes::Boxes32(nodes.par_iter().map(encode32).collect()),
                    _ => FullNodes::Local(nodes.par_iter().map(encode_line).collect()),
                };
                all(nodes, rest)
            }
        })
    }

    /// What `of` makes of the plan of a collapse.
    fn collapsed<R, const W: usize>(&self, options: &FullOptions, of: impl FnOnce(&BinaryTree<'_, W>) -> R) -> Result<R, BvhError> {
        let FullOptions { tree: options, layout, .. } = options;
        check_options(options, layout.most_triangles())?;
        let (of_block, of_dense, of_triangles) = (self.block_cost(options), self.dense_cost(options), options.leaf_cost());
        let leaf: &LeafCost<'_> = match layout {
            LeafLayout::Block => &of_block,
            LeafLayout::Dgf => {
                if !self.prims.par_iter().all(|p| in_dense_range(&[self.mesh.triangle(p.id)])) {
                    return Err(BvhError::Dense);
                }
                &of_dense
            }
            LeafLayout::Indexed | LeafLayout::Packed | LeafLayout::Line => &of_triangles,
        };
        Ok(of(&BinaryTree::new(&self.prims, &self.binary, options, leaf)))
    }

    /// The nodes, depth first, each as what `encode` makes of it.
    fn nodes<T, F, const W: usize>(&self, options: &FullOptions, depth: u32, encode: F) -> Result<Vec<T>, BvhError>
    where
        T: Copy + Default + Send,
        F: Fn(&WideNode<W>) -> T + Sync,
    {
        self.collapsed(options, |source| collapse::nodes(source, depth, encode))
    }

    /// The nodes in their order, the triangles of those of each side by side, and the sizes of their blocks, if they are any.
    #[expect(clippy::type_complexity, reason = "the nodes, and the rest of a tree")]
    fn laid_out<const W: usize>(
        &self,
        options: &FullOptions,
        depth: u32,
    ) -> Result<(Vec<WideNode<W>>, (Vec<u32>, Vec<BlockSize>)), BvhError> {
        let (mut nodes, mut ids) = self.in_order(options, depth)?;
        let blocks = self.blocks(options, &mut nodes, &mut ids)?;
        Ok((nodes, (ids, blocks)))
    }

    /// The nodes in their order, and the triangles of those of each side by side.
    fn in_order<const W: usize>(&self, options: &FullOptions, depth: u32) -> Result<(Vec<WideNode<W>>, Vec<u32>), BvhError> {
        let ids: Vec<u32> = self.prims.par_iter().map(|p| p.id).collect();
        let is_dense = options.layout == LeafLayout::Dgf;
        // Leaves that need blocks of their own go a node lower.
        let mut nodes = self.nodes(options, depth - u32::from(is_dense), |n: &WideNode<W>| *n)?;
        if is_dense {
            nodes = dense::apart(&self.mesh, &nodes, &ids);
        }
        match options.order {
            NodeOrder::Depth => {}
            NodeOrder::Treelets => nodes = by_treelets(&nodes, TREELET_BYTES / options.boxes.node_bytes()),
            NodeOrder::Levels => nodes = by_levels(&nodes),
            NodeOrder::VanEmdeBoas => nodes = by_halves(&nodes),
        }
        let ids = side_by_side(&mut nodes, &ids);
        Ok((nodes, ids))
    }

    /// The sizes of the blocks of the leaves of such nodes, if they are any; the leaves then have the lines of their blocks in place of their triangles.
    ///
    /// In blocks of the dense geometry format the triangles of a leaf are put in another order.
    fn blocks<const W: usize>(
        &self,
        options: &FullOptions,
        nodes: &mut [WideNode<W>],
        ids: &mut Vec<u32>,
    ) -> Result<Vec<BlockSize>, BvhError> {
        match options.layout {
            LeafLayout::Block => self.to_blocks(nodes, ids),
            LeafLayout::Dgf => {
                let sizes = dense::in_blocks(&self.mesh, nodes, ids);
                check_count((DENSE_PLACES * sizes.len()) as u64)?;
                Ok(sizes)
            }
            LeafLayout::Indexed | LeafLayout::Packed | LeafLayout::Line => Ok(Vec::new()),
        }
    }

    /// Turns the boxes of such nodes, each node's into a frame of its own, and says which.
    fn orient(&self, options: &FullOptions, nodes: &mut [WideNode<6>], ids: &[u32]) -> Vec<u32> {
        let Costs { node: node_cost, primitive, line } = options.tree.costs;
        let own = |first: u32, count: u8| &ids[first as usize..][..usize::from(count)];
        let is_block = options.layout == LeafLayout::Block;
        let lines = |ids: &[u32]| if is_block { self.lines(ids.iter().copied()).unwrap_or(0) } else { 0 };
        let leaves = Below {
            corners: &|first, count, corners| corners.extend(own(first, count).iter().flat_map(|&id| self.mesh.triangle(id))),
            cost: &|first, count| primitive * f64::from(count) + line * f64::from(lines(own(first, count))),
            node_cost,
        };
        orient(nodes, &leaves)
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

    /// What a leaf in a block of the dense geometry format costs for each unit of its area, if its numbers are wide enough.
    fn dense_cost(&self, options: &Options) -> impl Fn(&[Prim]) -> Option<f64> + Sync {
        let (of_triangles, max_leaf) = (options.leaf_cost(), options.max_leaf);
        move |prims| {
            let mut triangles = [[[0; 3]; 3]; MAX_LEAF as usize];
            let own = triangles.get_mut(..prims.len()).filter(|own| own.len() <= max_leaf as usize)?;
            own.iter_mut().zip(prims).for_each(|(own, p)| *own = self.mesh.triangle(p.id));
            if in_dense_range(own) { of_triangles(prims) } else { None }
        }
    }

    /// Gives leaves, which stand side by side, the lines of their blocks in place of their triangles.
    fn to_blocks<const W: usize>(&self, nodes: &mut [WideNode<W>], ids: &[u32]) -> Result<Vec<BlockSize>, BvhError> {
        let size = |first: u32, count: u8| {
            let own = &ids[first as usize..][..usize::from(count)];
            // Every leaf was planned to fit.
            BlockSize::new(own.len(), self.lines(own.iter().copied()).unwrap_or(MOST_LINES as u32))
        };
        let of_node = |node: &WideNode<W>| {
            node.children.map(|child| if let Child::Leaf { first, count } = child { Some(size(first, count)) } else { None })
        };
        let sizes: Vec<[Option<BlockSize>; W]> = nodes.par_iter().map(of_node).collect();
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

/// BVH over triangles of a hierarchy; leaf references count slots of `leaves`. BVHs may share both parts.
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
