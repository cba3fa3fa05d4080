//! The BVH over primitives, each of which is a leaf.

use super::binary::{PairNode, pairs};
use crate::bvh::build::{Prim, binary_tree};
use crate::bvh::collapse::{self, BinaryTree};
use crate::bvh::{Box32, MAX_DEPTH, MAX_DEPTH_OF_SIX, Node6, Options, WideNode, encode_line, encode6, side_by_side};
use crate::format::Line;
use rayon::prelude::*;

/// Children of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Two, as the paper has it: 28 bytes in a line of 32, 32-bit boxes, depth first.
    Two,
    /// Four, as `bvh` has them: 32 bytes.
    Four,
    /// Six, as `bvh6` has them: 64 bytes.
    Six,
}

/// The nodes; node 0 is the root.
#[derive(Clone, Debug)]
pub enum Top {
    /// Of two children.
    Two(Vec<PairNode>),
    /// Of four.
    Four(Vec<Line>),
    /// Of six.
    Six(Vec<Node6>),
}

impl Top {
    /// Nodes over these boxes, at least one, and the boxes in leaf order.
    pub fn new(boxes: &[Box32], width: Width) -> (Self, Vec<u32>) {
        match width {
            Width::Two => {
                let (nodes, order) = pairs(boxes);
                (Self::Two(nodes), order)
            }
            Width::Four => {
                let (nodes, order) = wide::<4>(boxes, MAX_DEPTH);
                (Self::Four(nodes.par_iter().map(encode_line).collect()), order)
            }
            Width::Six => {
                let (nodes, order) = wide::<6>(boxes, MAX_DEPTH_OF_SIX);
                (Self::Six(nodes.par_iter().map(|node| encode6(node, 0)).collect()), order)
            }
        }
    }

    /// How many nodes there are.
    pub fn count(&self) -> usize {
        match self {
            Self::Two(nodes) => nodes.len(),
            Self::Four(nodes) => nodes.len(),
            Self::Six(nodes) => nodes.len(),
        }
    }

    /// Lines of a node.
    pub const fn lines(&self) -> u32 {
        match self {
            Self::Two(_) | Self::Four(_) => 1,
            Self::Six(_) => 2,
        }
    }
}

/// Nodes of `W` children with a box in each leaf, those of a node side by side.
fn wide<const W: usize>(boxes: &[Box32], depth: u32) -> (Vec<WideNode<W>>, Vec<u32>) {
    let mut prims: Vec<Prim> = (0..).zip(boxes).map(|(id, bounds)| Prim::new(bounds, id)).collect();
    let binary = binary_tree(&mut prims, depth);
    let options = Options::with_leaf(1);
    let leaf = options.leaf_cost();
    let mut nodes = collapse::nodes(&BinaryTree::new(&prims, &binary, &options, &leaf), depth, |node: &WideNode<W>| *node);
    let ids: Vec<u32> = prims.iter().map(|prim| prim.id).collect();
    let order = side_by_side(&mut nodes, &ids);
    (nodes, order)
}
