//! Which ray decides about the edges of a node of a tree, by who decides in the tree: which of the node's edges lie on base edges.
//!
//! Edge k of a child lies on edge k of its parent in the children at its ends: all but child k itself and the middle one, 3. So it lies on base edge k if no digit of the node is k or 3.
//! Legal: level at most 10, node below 4^level.

use super::bary_map::NodeIndex;
use super::parts::{Parts, Registers, TAG};
use super::tree_deciders::{self, Decider};
use super::{Block, Form, Timing};
use crate::num::{U, Wire, wire_struct};

wire_struct! {
    /// Input of [`NodeDeciders`].
    pub struct In {
        /// Who decides in its tree.
        tree: tree_deciders::Out,
        /// Its level.
        level: U<4>,
        /// Its number on that level.
        node: NodeIndex,
    }
}

wire_struct! {
    /// Output of [`NodeDeciders`].
    pub struct Out {
        /// Who decides about edge (p1, p2), (p2, p0), (p0, p1).
        by: [Decider; 3],
    }
}

/// The block.
pub struct NodeDeciders;

impl Block for NodeDeciders {
    const NAME: &'static str = "node_deciders";
    const TIMING: Timing = Timing::pipelined(1);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        // Of each edge each digit is compared, if it is one of the node's.
        let digits = NodeIndex::WIDTH / 2;
        Parts { products: vec![], add_bits: 3 * digits * (2 + 4), select_bits: Out::WIDTH, registers: Registers::stage(Out::WIDTH + TAG) }
    }
    #[inline]
    fn eval(input: &In) -> Out {
        let mut on_base = [true; 3];
        for n in 0..input.level.get() {
            let child = input.node.get() >> (2 * n) & 3;
            for (k, on) in (0..).zip(&mut on_base) {
                *on &= child != k && child != 3;
            }
        }
        let tree_deciders::Out { inner, edges } = input.tree;
        Out { by: std::array::from_fn(|k| if on_base[k] { edges[k] } else { inner }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::lattice;

    #[test]
    fn nodes_know_which_of_their_edges_lie_on_base_edges() {
        let tree = tree_deciders::Out { inner: U::new(3), edges: [0, 1, 2].map(U::new) };
        for level in 0..=5u32 {
            for node in 0..1 << (2 * level) {
                let places = lattice::node(5, level, node);
                let wanted = std::array::from_fn(|k| {
                    // On base edge k nothing of corner k is left.
                    let weight = |(i, j): lattice::LatticePoint| [32 - i - j, i, j][k];
                    let is_on = weight(places[(k + 1) % 3]) == 0 && weight(places[(k + 2) % 3]) == 0;
                    if is_on { tree.edges[k] } else { tree.inner }
                });
                let input = In { tree, level: U::new(level.into()), node: U::new(node.into()) };
                assert_eq!(NodeDeciders::eval(&input).by, wanted, "{level} {node}");
            }
        }
    }
}
