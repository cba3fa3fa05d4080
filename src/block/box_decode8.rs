//! [`super::box_decode`] with planes of 8 bits: the box of a child of a node of six.
//!
//! Only units of BVHs of six children a node have it. Legal: origin at least -32767.

use super::box_decode::{framed_box, parts};
use super::parts::Parts;
use super::{Block, Form, Timing};
use crate::num::{Box16, U, Vec3, wire_struct};

wire_struct! {
    /// Input of [`BoxDecode8`].
    pub struct In {
        /// Lower corner of the node's frame.
        origin: Vec3<16>,
        /// Steps along x, y, z are half as long again.
        halves: [bool; 3],
        /// Powers of two of these steps.
        exponents: [U<4>; 3],
        /// Steps of the lower corner.
        lo: [U<8>; 3],
        /// Steps of the upper corner.
        hi: [U<8>; 3],
    }
}

wire_struct! {
    /// Output of [`BoxDecode8`].
    pub struct Out {
        /// The box.
        bounds: Box16,
    }
}

/// The block.
pub struct BoxDecode8;

impl Block for BoxDecode8 {
    const NAME: &'static str = "box_decode8";
    const TIMING: Timing = Timing::pipelined(2);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        parts(8)
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        Out { bounds: framed_box(i.origin, i.halves, i.exponents, [i.lo, i.hi]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::SixNode;
    use crate::num::{Random, Wire};

    #[test]
    fn boxes_are_those_of_the_record() {
        for number in 0..10_000 {
            let mut random = Random::of(4, number);
            let words = [(); 8].map(|()| random.next());
            let mut node = SixNode::from_words(&words);
            node.origin = Vec3::new(random.within(32_767), random.within(32_767), random.within(32_767));
            for k in 0..6 {
                let planes = |from: usize| std::array::from_fn(|axis| node.planes[k][from + axis]);
                let input = In { origin: node.origin, halves: node.halves, exponents: node.exponents, lo: planes(0), hi: planes(3) };
                assert_eq!(BoxDecode8::eval(&input).bounds, node.bounds(k));
            }
        }
    }
}
