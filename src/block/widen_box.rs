//! The box of a child for this ray: its stored box and its morphed triangle (paper section 3.4).
//!
//! lo' = min(lo, floor(p / 2^16)), hi' = max(hi, ceil(p / 2^16)) over the three corners. Enough for all deeper levels: every later vertex is a
//! convex combination of the morphed corners and of stored vertices, which lie in the stored box. Without morphing it changes nothing.
//! Legal: |p| <= `COORD_LIMIT`, so that the ceiling fits 16 bits.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{BOX_SHIFT, Box16, Point, S, Vec3, wire_struct};

wire_struct! {
    /// Input of [`WidenBox`].
    pub struct In {
        /// Stored box.
        bounds: Box16,
        /// Corner of the morphed child triangle.
        p0: Point,
        /// Corner.
        p1: Point,
        /// Corner.
        p2: Point,
    }
}

wire_struct! {
    /// Output of [`WidenBox`].
    pub struct Out {
        /// The union.
        bounds: Box16,
    }
}

/// The block.
pub struct WidenBox;

#[inline(always)]
fn lower(lo: S<16>, a: S<32>, b: S<32>, c: S<32>) -> S<16> {
    // floor is monotone: one shift after the minimum. 32 - 16 bits.
    S::new(i64::from(lo.narrow().min(a.narrow().min(b.narrow()).min(c.narrow()) >> BOX_SHIFT)))
}

#[inline(always)]
fn upper(hi: S<16>, a: S<32>, b: S<32>, c: S<32>) -> S<16> {
    let round_up = (1 << BOX_SHIFT) - 1;
    // At most ceil(COORD_LIMIT / 2^16) = 32766: 16 bits.
    S::new(i64::from(hi.narrow().max((a.narrow().max(b.narrow()).max(c.narrow()) + round_up) >> BOX_SHIFT)))
}

/// Bits of a box code.
const CODE: u32 = 16;

impl WidenBox {
    /// Registers with a tag of so many bits: codes of both sides and of three corners, pairs of them, the union.
    pub(super) fn registers(tag: u32) -> Registers {
        Registers::stage(3 * 8 * CODE + tag) + Registers::stage(3 * 4 * CODE + tag) + Registers::skid(3 * 2 * CODE + tag)
    }
}

impl Block for WidenBox {
    const NAME: &'static str = "widen_box";
    const TIMING: Timing = Timing::pipelined(3);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        // Of each axis three ceilings, and six minima or maxima.
        Parts { products: vec![], add_bits: 3 * (3 + 6) * CODE, select_bits: 3 * 6 * CODE, registers: Self::registers(TAG) }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let (lo, hi, a, b, c) = (i.bounds.lo, i.bounds.hi, i.p0, i.p1, i.p2);
        Out {
            bounds: Box16 {
                lo: Vec3 { x: lower(lo.x, a.x, b.x, c.x), y: lower(lo.y, a.y, b.y, c.y), z: lower(lo.z, a.z, b.z, c.z) },
                hi: Vec3 { x: upper(hi.x, a.x, b.x, c.x), y: upper(hi.y, a.y, b.y, c.y), z: upper(hi.z, a.z, b.z, c.z) },
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMIT: i32 = crate::num::COORD_LIMIT;

    proptest! {
        #[test]
        fn the_union_is_the_smallest_box_that_holds_both(
            v in prop::array::uniform5(prop::array::uniform3(-LIMIT..=LIMIT))
        ) {
            let stored = Box16::of_points(&v[..2]);
            let p = [v[2], v[3], v[4]].map(Point::from_i32);
            let out = WidenBox::eval(&In { bounds: stored, p0: p[0], p1: p[1], p2: p[2] });
            prop_assert_eq!(out.bounds, Box16::of_points(&v));
        }
    }
}
