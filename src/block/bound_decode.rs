//! Displacement bound from its 8-bit code (paper section 4.3 has the square of a 10-bit one).
//!
//! h = 0 for code 0, else floor(M[k mod 16] 2^(k / 16) / 256) units with k = code + offset, k / 16 rounded down: 16 steps an octave, no multiplier.
//! Encoding rounds up, so h is never below the true bound. Monotone in the code.
//! Legal: any code; offset at most [`MAX_BOUND_OFFSET`](crate::num::MAX_BOUND_OFFSET) (h below 2^33).

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{BOUND_MANTISSAS, BoundCode, BoundScale, U, Wire, wire_struct};

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

/// Bits of code + offset, of them those of the octave, and of a mantissa.
const SUM: u32 = BoundScale::WIDTH + 1;
const OCTAVE: u32 = SUM - 4;
const MANTISSA: u32 = 9;
/// Of a mantissa shifted by up to 7.
const FINE: u32 = MANTISSA + 7;

impl BoundDecode {
    /// Registers with a tag of so many bits: the sum with whether the code is 0, the mantissa shifted by up to 7 with the bytes to come, h.
    pub(super) fn registers(tag: u32) -> Registers {
        Registers::stage(SUM + 1 + tag) + Registers::stage(FINE + OCTAVE - 3 + tag) + Registers::stage(Bound::WIDTH + tag)
    }

    /// Its sums and selections: the table of sixteen, nothing for code 0, the shift in three steps of bits and three of bytes.
    pub(super) fn arithmetic() -> (u32, u32) {
        (SUM, 15 * MANTISSA + FINE + 3 * FINE + (OCTAVE - 3) * (Bound::WIDTH + 8))
    }
}

impl Block for BoundDecode {
    const NAME: &'static str = "bound_decode";
    const TIMING: Timing = Timing::pipelined(3);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        let (add_bits, select_bits) = Self::arithmetic();
        Parts { products: vec![], add_bits, select_bits, registers: Self::registers(TAG) }
    }
    #[inline(always)]
    #[expect(clippy::as_conversions, reason = "four bits as an index")]
    fn eval(input: &In) -> Out {
        // 8 and 9 bits: 10.
        let k = input.code.get() + input.scale.offset.get();
        // Nine bits and up to 32 more, of which eight are dropped.
        let h = (u64::from(BOUND_MANTISSAS[(k & 15) as usize]) << (k >> 4)) >> 8;
        Out { h: if input.code == BoundCode::ZERO { Bound::ZERO } else { Bound::new(h) } }
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
            for code in 0..=255u8 {
                let out = BoundDecode::eval(&In { code: U::new(u64::from(code)), scale });
                assert_eq!(out.h.get(), bound_decode(scale, code));
            }
        }
    }
}
