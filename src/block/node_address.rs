//! Address of a memory line of a record (`docs/scene-format.md`).
//!
//! Record g = start + 4^level place + index, modulo 2^28, of 2^scale lines each: base + 2^scale g + low. Records outside of trees have start, place and level 0.
//! Legal: level <= 9, index < 4^level or place 0, low < 2^scale; below 2^36, which the size of the sections keeps. Of an image that no scene has the sums wrap there.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{LineAddress, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`NodeAddress`].
    pub struct In {
        /// First line of the section.
        base: LineAddress,
        /// First record of the level, or where the tree at place 0 would have it; 0 outside of trees.
        start: U<28>,
        /// The tree's place among those of the level; 0 outside of trees.
        place: U<28>,
        /// Level of the node within its tree; 0 outside of trees.
        level: U<4>,
        /// Number of the record in its tree on its level.
        index: U<28>,
        /// Records have 2^scale lines.
        scale: U<1>,
        /// Which of them.
        low: U<1>,
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
        // A record's number has 28 bits; of two-line records twice that.
        const RECORD: u32 = 28;
        // Ten levels' shifts, two scales.
        const SHIFTS: u32 = 4;
        let (line, address) = (RECORD + 1, LineAddress::WIDTH);
        let registers = Registers::stage(line + address + TAG) + Registers::stage(address + TAG);
        Parts { products: vec![], add_bits: RECORD + address, select_bits: SHIFTS * RECORD + line, registers }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        const RECORDS: u64 = (1 << 28) - 1;
        // The index has no bits where the place has.
        let record = (i.start.get() + (i.place.get() << (2 * i.level.get()) | i.index.get())) & RECORDS;
        let line = record << i.scale.get() | i.low.get();
        Out { address: LineAddress::wrapping(i.base.get() + line) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::layout;
    use crate::num::VertexForm;

    #[test]
    fn agrees_with_the_layout() {
        for form in VertexForm::ALL {
            let (trees, starts) = layout::places(form, &[3, 10, 0, 10, 1, 9, 4]);
            for (tree, level) in trees.iter().flat_map(|&tree| (0..tree.depth).map(move |level| (tree, level))) {
                for node in [0, 1, (1usize << (2 * level)) - 1].into_iter().filter(|&node| node < 1 << (2 * level)) {
                    let record = |start: usize, level: u32, node: usize| In {
                        base: U::new(100),
                        start: U::wrapping(start as u64),
                        place: U::new(tree.place as u64),
                        level: U::new(u64::from(level)),
                        index: U::new(node as u64),
                        ..In::default()
                    };
                    let line = |input: &In| NodeAddress::eval(input).address.get() as usize - 100;
                    if layout::has_split(tree.depth, level) {
                        assert_eq!(line(&record(starts.split_level(level as usize), level, node)), starts.split(tree, level, node));
                    }
                    if layout::has_vertices(form, tree.depth, level) {
                        let start = starts.vertex_level(level as usize);
                        let wanted = match form {
                            VertexForm::Exact => record(start, level, node),
                            // One line for four siblings, or two.
                            VertexForm::Short => record(start, level - 1, node / 4),
                            VertexForm::Compact => {
                                In { scale: U::new(1), low: U::new(node as u64 / 2 % 2), ..record(start, level - 1, node / 4) }
                            }
                        };
                        assert_eq!(line(&wanted), starts.vertex_line(form, tree, level, node), "{form:?} {tree:?} {level} {node}");
                    }
                }
            }
        }
    }
}
