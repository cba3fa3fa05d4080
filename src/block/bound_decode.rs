//! Displacement bound from its 10-bit code (paper section 4.3).
//!
//! h = floor(code^2 * mantissa / 2^shift) units. The square undoes the square root taken before quantising; encoding rounds up, so h is
//! never below the true bound. Monotone in the code; code 0 gives 0.
//! Legal: any code; scales made by [`crate::num::bound_scale`] (h below 2^33).

use super::parts::{Multiplier, Parts, Registers, TAG, multiplier_latency};
use super::{Block, Form, Timing};
use crate::num::{BoundCode, BoundScale, U, Wire, wire_struct};

/// Width of a decoded bound: |q - m| < 2^32.8 for coordinates in +-2^31.
pub type Bound = U<33>;

wire_struct! {
    /// Input of [`BoundDecode`].
    pub struct In {
        /// The stored code.
        code: BoundCode,
        /// The model's scale.
        scale: BoundScale,
    }
}

wire_struct! {
    /// Output of [`BoundDecode`].
    pub struct Out {
        /// Displacement bound in units.
        h: Bound,
    }
}

/// The block.
pub struct BoundDecode;

const SQUARE: u32 = 2 * BoundCode::WIDTH;
const SHIFT: u32 = 6;
const MANTISSA: u32 = BoundScale::WIDTH - SHIFT;
const PRODUCT: u32 = SQUARE + MANTISSA;

impl BoundDecode {
    /// Registers with a tag of so many bits: the square, the product with the shift beside it, the shift in two steps.
    pub(super) fn registers(tag: u32) -> Registers {
        // As signed numbers the factors have one bit more.
        let product = Multiplier { high: PRODUCT, ..Multiplier::new(SQUARE + 1, MANTISSA + 1) };
        let beside = Registers::line(SHIFT + tag, multiplier_latency(SQUARE + 1, MANTISSA + 1), 0);
        let ends = Registers::stage(PRODUCT + SHIFT / 2 + tag) + Registers::stage(Bound::WIDTH + tag);
        Registers::stage(SQUARE + BoundScale::WIDTH + tag) + product.registers() + beside + ends
    }

    /// Its products and selections.
    pub(super) fn arithmetic() -> (Vec<[u32; 3]>, u32) {
        (vec![[1, BoundCode::WIDTH, BoundCode::WIDTH], [1, SQUARE + 1, MANTISSA + 1]], PRODUCT * SHIFT)
    }
}

impl Block for BoundDecode {
    const NAME: &'static str = "bound_decode";
    const TIMING: Timing = Timing::pipelined(6);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        let (products, select_bits) = Self::arithmetic();
        Parts { products, add_bits: 0, select_bits, registers: Self::registers(TAG) }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        // 20 bits of square, 18 of mantissa: 38.
        let square = input.code.get() * input.code.get();
        Out { h: Bound::new((square * input.scale.mantissa.get()) >> input.scale.shift.get()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{bound_decode, bound_scale};

    #[test]
    fn agrees_with_the_encoder_for_every_code() {
        for largest in [0, 1, 5, 1023, 123_456, 1 << 32] {
            let scale = bound_scale(largest);
            for code in 0..1024u16 {
                let out = BoundDecode::eval(&In { code: U::new(u64::from(code)), scale });
                assert_eq!(out.h.get(), bound_decode(scale, code));
            }
        }
    }
}
