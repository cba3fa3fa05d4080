//! Where a tree's vertex lines and sibling groups begin (`docs/scene-format.md`).
//!
//! G = (4^(N-1) - 1) / 3 sibling groups (0 if N < 2) of a line a tree, and V = (4^N - 1) / 3 lines of exact vertices or 2 G of compact ones:
//! bounds + tree G and vertices + tree V or vertices + 2 tree G.
//! Legal: levels <= 10; both results below 2^36, which the size of the sections keeps.

use super::parts::{Multiplier, Parts, Registers, TAG, multiplier_latency};
use super::{Block, Form, Timing};
use crate::num::{LineAddress, MAX_LEVELS, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`TreeBase`].
    pub struct In {
        /// Vertices are compact.
        compact: bool,
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

/// Bits of a tree's number.
const TREE: u32 = 28;

impl TreeBase {
    /// Bits of (4^N - 1) / 3.
    const fn lines(levels: u32) -> u32 {
        2 * levels - 1
    }

    /// Cycles of the product of tree and lines, both one bit wider as signed numbers.
    const fn product_latency(levels: u32) -> u32 {
        multiplier_latency(TREE + 1, Self::lines(levels) + 1)
    }

    /// The product, the difference and the sums.
    const fn of(levels: u32) -> Timing {
        Timing::pipelined(Self::product_latency(levels) + 2)
    }
}

impl Block for TreeBase {
    const NAME: &'static str = "tree_base";
    const TIMING: Timing = Self::of(MAX_LEVELS);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        Self::of(form.levels)
    }
    fn parts(form: &Form) -> Parts {
        let (lines, address) = (Self::lines(form.levels), LineAddress::WIDTH);
        let product = TREE + lines;
        let offset = product.min(address);
        // A quarter of the difference is read as far as the product itself.
        let multiplier = Multiplier { high: product.min(address + 2), ..Multiplier::new(TREE + 1, lines + 1) };
        let beside = Registers::line(2 + TREE + 2 * address + TAG, Self::product_latency(form.levels), 0);
        let ends = Registers::stage(2 * offset + 2 * address + TAG) + Registers::stage(2 * address + TAG);
        let registers = multiplier.registers() + beside + ends;
        Parts { products: vec![[1, TREE + 1, lines + 1]], add_bits: product + 2 * address, select_bits: 2 * product, registers }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        // (4^N - 1) / 3 = binary 0101..01 with N ones; 4^(N-1) - 1 over 3 is the same number without its lowest one, over 4.
        let ones = 0x5_5555 & ((1 << (2 * i.levels.get())) - 1);
        let groups = ones >> 2;
        let lines = if i.compact { 2 * groups } else { ones };
        Out { vertices: U::new(i.vertices.get() + i.tree.get() * lines), bounds: U::new(i.bounds.get() + i.tree.get() * groups) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::layout;
    use crate::num::VertexForm;

    #[test]
    fn agrees_with_the_layout() {
        for (levels, form) in (0..=10u32).flat_map(|levels| VertexForm::ALL.map(|form| (levels, form))) {
            for tree in [0, 1, 77, 1 << 15] {
                let (levels_in, tree_in) = (U::new(u64::from(levels)), U::new(tree as u64));
                let compact = form.is_compact();
                let out = TreeBase::eval(&In { compact, levels: levels_in, tree: tree_in, vertices: U::new(1000), bounds: U::new(5) });
                assert_eq!(out.vertices.get() as usize, 1000 + tree * layout::vertex_lines(form, levels));
                assert_eq!(out.bounds.get() as usize, 5 + tree * layout::sibling_groups(levels));
            }
        }
    }
}
