//! The quad-BVH over any boxes: those of base triangles, or of the triangles of a level.
//!
//! A binary tree by the surface area heuristic (binned, exact for small ranges) down to single primitives; collapsed to four children per
//! node by dynamic programming, which also chooses the leaves; written as nodes of 32 bytes (boxes in the node's frame), 64 (16-bit boxes) or 128 (32-bit boxes); or to six
//! children, in 64 bytes.
//! The result depends on the input alone: not on the number of threads, nor on the machine.

pub(crate) mod build;
pub(crate) mod check;
pub(crate) mod collapse;
mod encode;
pub(crate) mod foreign;
mod node;
mod options;
pub(crate) mod order;
pub(crate) mod orient;
pub(crate) mod plan;
mod refit;

pub use check::{Defect, check, sah_cost};
pub use encode::{BvhChild32, Node6, Node16, Node32, encode_line, encode6, encode16, encode32};
pub use foreign::BinaryNode;
pub use node::{Box32, Child, QuadNode, WideNode};
pub use options::{Collapse, Costs, Options};
pub use refit::{refit, refit_over_trees};

use crate::format::{Box16, TreeBvh};
use rayon::prelude::*;
use thiserror::Error;

/// Largest number of nodes on a path from the root to a leaf, whatever the input.
pub const MAX_DEPTH: u32 = crate::num::MAX_BVH_DEPTH;
/// The same of a tree of six children a node, five of which may wait at each: what fits a traversal stack made for quad-BVHs and trees below.
pub const MAX_DEPTH_OF_SIX: u32 = 20;
const _: () = assert!(5 * MAX_DEPTH_OF_SIX <= 3 * (crate::num::MAX_BVH_DEPTH + crate::num::MAX_LEVELS));
/// Largest number of primitives of a leaf that is no block: references hold 2 bits of it.
pub const MAX_LEAF: u32 = 4;
/// Largest number of primitives: references hold 28 bits.
pub const MAX_PRIMITIVES: usize = 1 << 28;

/// Why a quad-BVH could not be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BvhError {
    /// A tree over the input mesh of a scene, which is not at hand.
    #[error("the mesh that the scene was made from is not at hand")]
    NoInput,
    /// No primitives.
    #[error("a quad-BVH needs at least one primitive")]
    Empty,
    /// More primitives, or lines of leaf blocks, than references can name.
    #[error("{0} primitives or lines of leaf blocks: a quad-BVH holds at most 2^28")]
    TooMany(u64),
    /// A leaf size outside 1 to 4, or to 16 of leaf blocks.
    #[error("leaves hold 1 to 4 primitives, blocks up to 16, not {0}")]
    LeafSize(u32),
    /// Costs that are not positive and finite.
    #[error("the costs of the surface area heuristic must be positive and finite")]
    Costs,
    /// A box whose corners are exchanged or beyond the coordinate limit.
    #[error("box {0} is inside out or exceeds the coordinate limit")]
    IllegalBox(usize),
    /// A hierarchy whose number of points does not fit its number of trees.
    #[error("the hierarchy has {points} points where {expected} are needed")]
    Points {
        /// Number of points there are.
        points: usize,
        /// Number of points there should be.
        expected: u64,
    },
    /// A binary tree that is none over the hierarchy's triangles, or too deep.
    #[error("no binary tree over the hierarchy's triangles, or one of paths of more than 40 nodes")]
    ForeignTree,
    /// A tree over other triangles than those of the hierarchy.
    #[error("the tree was built over another hierarchy")]
    OtherHierarchy,
    /// Boxes that nodes of such a number of children do not have.
    #[error("boxes are local or codes in nodes of four children, and local or oriented in nodes of six")]
    NodeBoxes,
    /// A triangle that no block of the dense geometry format holds.
    #[error(
        "a triangle does not fit a block of the dense geometry format, which has coordinates of 24 bits and triangles of 16: a coarser grid may help (--coordinate-zeros of build and generate)"
    )]
    Dense,
    /// A hierarchy with more splits than the format allows.
    #[error("{0} levels: a hierarchy has at most 10")]
    Levels(u32),
}

/// A BVH of `W` children a node; node 0 is the root.
///
/// The inner children of a node stand side by side, followed by everything below the first, then everything below the second, and so on
/// (depth first with siblings kept together). A leaf's primitives stand in `order` in the order of the tree, left to right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WideTree<const W: usize> {
    /// The nodes.
    pub nodes: Vec<WideNode<W>>,
    /// Primitive indices in leaf order; every index occurs once.
    pub order: Vec<u32>,
}

/// A quad-BVH.
pub type QuadTree = WideTree<4>;

/// Builds the quad-BVH of these boxes; primitive k is `boxes[k]`.
///
/// # Errors
/// No boxes, too many, a box that is inside out or too large, or illegal options.
pub fn build(boxes: &[Box32], options: &Options) -> Result<QuadTree, BvhError> {
    check_count(boxes.len() as u64)?;
    if let Some(bad) = boxes.par_iter().position_first(|b| !b.is_legal()) {
        return Err(BvhError::IllegalBox(bad));
    }
    // Indices fit: at most 2^28.
    let prims = boxes.par_iter().enumerate().map(|(k, b)| build::Prim::new(b, k as u32)).collect();
    let (nodes, order) = build_nodes(prims, options, MAX_DEPTH, |n: &QuadNode| *n)?;
    Ok(QuadTree { nodes, order })
}

impl<const W: usize> WideTree<W> {
    /// The same with the leaves of each node side by side: their primitives follow each other in the order of its slots, nodes in their own order.
    #[must_use]
    pub fn side_by_side(mut self) -> Self {
        let order = side_by_side(&mut self.nodes, &self.order);
        Self { order, ..self }
    }
}

/// Moves the leaves of each of `nodes` side by side in the order that is returned.
pub(crate) fn side_by_side<const W: usize>(nodes: &mut [WideNode<W>], order: &[u32]) -> Vec<u32> {
    let mut out = Vec::with_capacity(order.len());
    for child in nodes.iter_mut().flat_map(|node| &mut node.children) {
        if let Child::Leaf { first, count } = child {
            let own = *first as usize..*first as usize + usize::from(*count);
            *first = out.len() as u32; // at most 2^28
            out.extend_from_slice(&order[own]);
        }
    }
    out
}

/// Nodes over the trees of a scene, one tree per leaf, boxes as given, and the order of the trees in which leaves of a node stand side by side.
///
/// # Errors
/// No trees, too many, or a box that is inside out or uses the codes beyond +-32766.
pub fn over_trees(boxes: &[Box16]) -> Result<TreeBvh, BvhError> {
    let boxes: Vec<Box32> = boxes.par_iter().map(wide).collect();
    let tree = build(&boxes, &Options::with_leaf(1))?.side_by_side();
    Ok(TreeBvh { nodes: tree.nodes.par_iter().map(encode_line).collect(), order: tree.order })
}

/// Planes in units.
fn wide(b: &Box16) -> Box32 {
    // Codes have 16 bits, so code << 16 fits 32.
    Box32 { lo: b.lo.get().map(|c| (c << 16) as i32), hi: b.hi.get().map(|c| (c << 16) as i32) }
}

pub(crate) fn check_count(count: u64) -> Result<(), BvhError> {
    match count {
        0 => Err(BvhError::Empty),
        n if n > MAX_PRIMITIVES as u64 => Err(BvhError::TooMany(n)),
        _ => Ok(()),
    }
}

/// Refuses options that no tree with leaves of at most `most` primitives can be built with.
pub(crate) fn check_options(options: &Options, most: u32) -> Result<(), BvhError> {
    if !(1..=most).contains(&options.max_leaf) {
        return Err(BvhError::LeafSize(options.max_leaf));
    }
    let Costs { node, primitive, line } = options.costs;
    if !(node > 0.0 && node.is_finite() && primitive > 0.0 && primitive.is_finite() && line >= 0.0 && line.is_finite()) {
        return Err(BvhError::Costs);
    }
    Ok(())
}

/// Builds over legal primitives (1 to [`MAX_PRIMITIVES`]) and turns each node into what `encode` makes of it, so that no second copy of the
/// nodes is held. `depth` is the bound on the nodes of a path; at least half the logarithm of the count.
fn build_nodes<T, F, const W: usize>(
    mut prims: Vec<build::Prim>,
    options: &Options,
    depth: u32,
    encode: F,
) -> Result<(Vec<T>, Vec<u32>), BvhError>
where
    T: Copy + Default + Send,
    F: Fn(&WideNode<W>) -> T + Sync,
{
    check_options(options, MAX_LEAF)?;
    let binary = build::binary_tree(&mut prims, depth);
    let leaf = options.leaf_cost();
    let nodes = collapse::nodes(&collapse::BinaryTree::new(&prims, &binary, options, &leaf), depth, encode);
    drop(binary);
    Ok((nodes, prims.par_iter().map(|p| p.id).collect()))
}
