//! Where a tree's vertex lines and sibling groups begin (`docs/scene-format.md`).
//!
//! V = (4^N - 1) / 3 vertex lines and G = (4^(N-1) - 1) / 3 sibling groups (0 if N < 2) of two lines a tree:
//! vertices + tree V and bounds + 2 tree G.
//! Legal: levels <= 10; both results below 2^36, which the size of the sections keeps.

use super::{Block, Timing};
use crate::num::{LineAddress, U, wire_struct};

wire_struct! {
    /// Input of [`TreeBase`].
    pub struct In {
        /// Number of splits N.
        levels: U<4>,
        /// The tree.
        tree: U<28>,
        /// First line of the vertex data.
        vertices: LineAddress,
        /// First line of the bound data.
        bounds: LineAddress,
    }
}

wire_struct! {
    /// Output of [`TreeBase`].
    pub struct Out {
        /// First line of the tree's vertex data.
        vertices: LineAddress,
        /// First line of its bound data.
        bounds: LineAddress,
    }
}

/// The block.
pub struct TreeBase;

impl Block for TreeBase {
    const NAME: &'static str = "tree_base";
    const TIMING: Timing = Timing::pipelined(5);
    type In = In;
    type Out = Out;
    #[inline(always)]
    fn eval(i: &In) -> Out {
        // (4^N - 1) / 3 = binary 0101..01 with N ones; 4^(N-1) - 1 over 3 is the same number without its lowest one, over 4.
        let ones = 0x5_5555 & ((1 << (2 * i.levels.get())) - 1);
        let groups = ones >> 2;
        Out { vertices: U::new(i.vertices.get() + i.tree.get() * ones), bounds: U::new(i.bounds.get() + 2 * (i.tree.get() * groups)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::layout;

    #[test]
    fn agrees_with_the_layout() {
        for levels in 0..=10u32 {
            for tree in [0, 1, 77, 1 << 15] {
                let (levels_in, tree_in) = (U::new(u64::from(levels)), U::new(tree as u64));
                let out = TreeBase::eval(&In { levels: levels_in, tree: tree_in, vertices: U::new(1000), bounds: U::new(5) });
                assert_eq!(out.vertices.get() as usize, 1000 + tree * layout::vertex_lines(levels));
                assert_eq!(out.bounds.get() as usize, 5 + 2 * tree * layout::sibling_groups(levels));
            }
        }
    }
}
