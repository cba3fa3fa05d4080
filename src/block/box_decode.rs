//! The box of a child of a quad-BVH node in its node's frame: what [`super::child_boxes`] does for such a node, of one child and alone.
//!
//! Only units of the full-resolution BVHs have it. Legal: origin at least -32767.

use super::child_boxes::framed_plane;
use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{Box16, S, U, Vec3, box_steps, wire_struct};

wire_struct! {
    /// Input of [`BoxDecode`].
    pub struct In {
        /// Lower corner of the node's frame.
        origin: Vec3<16>,
        /// Steps along x, y, z are half as long again.
        halves: [bool; 3],
        /// Powers of two of these steps.
        exponents: [U<4>; 3],
        /// Steps of the lower corner.
        lo: [U<5>; 3],
        /// Steps of the upper corner.
        hi: [U<5>; 3],
    }
}

wire_struct! {
    /// Output of [`BoxDecode`].
    pub struct Out {
        /// The box.
        bounds: Box16,
    }
}

/// The block.
pub struct BoxDecode;

/// Bits of a code, and of steps in codes.
const CODE: u32 = 16;
const STEPS: u32 = 16;

impl Block for BoxDecode {
    const NAME: &'static str = "box_decode";
    const TIMING: Timing = Timing::pipelined(2);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        parts(5)
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        Out { bounds: framed_box(i.origin, i.halves, i.exponents, [i.lo, i.hi]) }
    }
}

/// What the block is made of for planes of so many bits.
pub(super) fn parts(plane: u32) -> Parts {
    let registers = Registers::stage(6 * STEPS + 3 * CODE + TAG) + Registers::stage(6 * CODE + TAG);
    Parts { products: vec![], add_bits: 6 * (plane + 2 + STEPS), select_bits: 6 * (4 * STEPS + CODE), registers }
}

/// The box with these corners in a frame.
#[inline(always)]
pub(super) fn framed_box<const PLANE: u32>(
    origin: Vec3<16>,
    halves: [bool; 3],
    exponents: [U<4>; 3],
    [lo, hi]: [[U<PLANE>; 3]; 2],
) -> Box16 {
    let exponents = exponents.map(U::narrow).map(i32::cast_unsigned);
    let plane = |axis: usize, origin: S<16>, plane: U<PLANE>| {
        // Below 2^24, of planes of up to 8 bits.
        let steps = box_steps(halves[axis], exponents[axis], plane.narrow().cast_unsigned()).cast_signed();
        S::new(i64::from(framed_plane(origin.narrow(), steps)))
    };
    let corner = |[x, y, z]: [U<PLANE>; 3]| Vec3 { x: plane(0, origin.x, x), y: plane(1, origin.y, y), z: plane(2, origin.z, z) };
    Box16 { lo: corner(lo), hi: corner(hi) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::BvhNode;
    use crate::num::{Random, Wire};

    #[test]
    fn boxes_are_those_of_the_record() {
        for number in 0..10_000 {
            let mut random = Random::of(3, number);
            let line = [(); 4].map(|()| random.next());
            let mut node = BvhNode::from_words(&line);
            node.origin = Vec3::new(random.within(32_767), random.within(32_767), random.within(32_767));
            for k in 0..4 {
                let planes = |from: usize| std::array::from_fn(|axis| node.planes[6 * k + from + axis]);
                let input = In { origin: node.origin, halves: node.halves, exponents: node.exponents, lo: planes(0), hi: planes(3) };
                assert_eq!(BoxDecode::eval(&input).bounds, node.bounds(k));
            }
        }
    }
}
