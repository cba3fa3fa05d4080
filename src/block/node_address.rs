//! Address of a memory line of a record (`docs/scene-format.md`).
//!
//! With i = (4^level - 1) / 3 + index: base + first + i for one-line records, base + first + 2i + half for two-line ones, base + first + (i - 1) / 2, rounded down, for records of half a
//! line, of which the first level has none. Records outside of trees have first and level 0.
//! Legal: level <= 9, above 0 for records of half a line; below 2^36, which the size of the sections keeps. Of an image that no scene has the sum wraps there.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{LineAddress, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`NodeAddress`].
    pub struct In {
        /// First line of the section.
        base: LineAddress,
        /// The tree's first line in it; 0 outside of trees.
        first: U<28>,
        /// Level of the node within its tree; 0 outside of trees.
        level: U<4>,
        /// Number of the record on its level.
        index: U<28>,
        /// Records have two lines.
        pair: bool,
        /// Records have half a line.
        halves: bool,
        /// The second line of a pair; else 0.
        half: bool,
    }
}

wire_struct! {
    /// Output of [`NodeAddress`].
    pub struct Out {
        /// The line.
        address: LineAddress,
    }
}

/// The block.
pub struct NodeAddress;

impl Block for NodeAddress {
    const NAME: &'static str = "node_address";
    const TIMING: Timing = Timing::pipelined(2);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        // A record's number: a level's start below 2^18 and 28 bits of index; of two-line records twice that.
        const RECORD: u32 = 29;
        let (line, address) = (RECORD + 1, LineAddress::WIDTH);
        let registers = Registers::stage(line + address + TAG) + Registers::stage(address + TAG);
        Parts { products: vec![], add_bits: RECORD + 2 * address, select_bits: 2 * line, registers }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        // (4^n - 1) / 3 = binary 0101..01 with n ones: below 2^17 for n <= 9.
        let start = 0x5_5555 & ((1 << (2 * i.level.get())) - 1);
        let record = start + i.index.get();
        let line = if i.pair {
            2 * record + u64::from(i.half)
        } else if i.halves {
            (record - 1) >> 1
        } else {
            record
        };
        Out { address: LineAddress::wrapping(i.base.get() + i.first.get() + line) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::layout;
    use crate::num::VertexForm;

    #[test]
    fn agrees_with_the_layout() {
        for level in 0..=9u32 {
            for node in [0, 1, (1usize << (2 * level)) - 1].into_iter().filter(|&node| node < 1 << (2 * level)) {
                let (level_in, index) = (U::new(u64::from(level)), U::new(node as u64));
                let input = In { base: U::new(60), first: U::new(40), level: level_in, index, pair: false, halves: false, half: false };
                let line = |input: &In| NodeAddress::eval(input).address.get() as usize;
                assert_eq!(line(&input), 100 + layout::vertex_line(VertexForm::Exact, 0, level, node));
                assert_eq!(line(&input), 100 + layout::child_group(0, level, node));
                assert_eq!(line(&In { pair: true, half: true, ..input }), 101 + 2 * layout::child_group(0, level, node));
                if level > 0 {
                    assert_eq!(line(&In { halves: true, ..input }), 100 + layout::vertex_line(VertexForm::Compact, 0, level, node));
                }
            }
        }
    }
}
