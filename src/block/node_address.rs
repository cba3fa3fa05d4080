//! Address of a memory line of a record (`docs/scene-format.md`).
//!
//! Record g = start + 4^level place + index, modulo 2^28, of 2^scale lines each: base + first + 2^scale g + low. Records outside of trees have start, place and level 0.
//! Legal: level <= 8, index < 4^level or place 0, scale <= 2, low < 2^scale; below 2^36, which the size of the sections keeps. Of an image that no scene has the sums wrap there.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{LineAddress, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`NodeAddress`].
    pub struct In {
        /// First line of the section.
        base: LineAddress,
        /// Lines of it before the first record.
        first: U<28>,
        /// First record of the level; 0 outside of trees.
        start: U<28>,
        /// The tree's place among those of the level; 0 outside of trees.
        place: U<28>,
        /// Level of the node within its tree; 0 outside of trees.
        level: U<4>,
        /// Number of the record in its tree on its level.
        index: U<28>,
        /// Records have 2^scale lines.
        scale: U<2>,
        /// Which of them.
        low: U<2>,
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
        // A record's number has 28 bits; of four-line records four times that.
        const RECORD: u32 = 28;
        // Nine levels' shifts, three scales.
        const SHIFTS: u32 = 4;
        let (line, address) = (RECORD + 2, LineAddress::WIDTH);
        let registers = Registers::stage(line + address + TAG) + Registers::stage(address + TAG);
        Parts { products: vec![], add_bits: RECORD + 2 * address, select_bits: SHIFTS * RECORD + 2 * line, registers }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        const RECORDS: u64 = (1 << 28) - 1;
        // The index has no bits where the place has.
        let record = (i.start.get() + (i.place.get() << (2 * i.level.get()) | i.index.get())) & RECORDS;
        let line = record << i.scale.get() | i.low.get();
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
        let (trees, starts) = layout::places(&[3, 10, 0, 10, 1, 9, 4]);
        for (tree, level) in trees.iter().flat_map(|&tree| (0..tree.depth).map(move |level| (tree, level))) {
            for node in [0, 1, (1usize << (2 * level)) - 1].into_iter().filter(|&node| node < 1 << (2 * level)) {
                let group = |level: u32, node: usize| In {
                    base: U::new(100),
                    start: U::new(starts.level(level as usize) as u64),
                    place: U::new(tree.place as u64),
                    level: U::new(u64::from(level)),
                    index: U::new(node as u64),
                    ..In::default()
                };
                let line = |input: &In| NodeAddress::eval(input).address.get() as usize - 100;
                if level + 1 < tree.depth {
                    assert_eq!(line(&group(level, node)), starts.child_group(tree, level, node));
                }
                if level > 0 {
                    let siblings = group(level - 1, node / 4);
                    let compact = In { scale: U::new(1), low: U::new(node as u64 / 2 % 2), ..siblings };
                    assert_eq!(line(&compact), starts.vertex_line(VertexForm::Compact, tree, level, node));
                    let first = U::new(starts.roots() as u64);
                    let exact = In { first, scale: U::new(2), low: U::new(node as u64 % 4), ..siblings };
                    assert_eq!(line(&exact), starts.vertex_line(VertexForm::Exact, tree, level, node));
                } else {
                    assert_eq!(line(&group(0, 0)), starts.vertex_line(VertexForm::Exact, tree, 0, 0));
                }
            }
        }
    }
}
