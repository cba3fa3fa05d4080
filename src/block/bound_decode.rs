//! Displacement bound from its 10-bit code (paper section 4.3).
//!
//! h = floor(code^2 * mantissa / 2^shift) units. The square undoes the square root taken before quantising; encoding rounds up, so h is
//! never below the true bound. Monotone in the code; code 0 gives 0.
//! Legal: any code; scales made by [`crate::num::bound_scale`] (h below 2^33).

use super::{Block, Timing};
use crate::num::{BoundCode, BoundScale, U, wire_struct};

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

impl Block for BoundDecode {
    const NAME: &'static str = "bound_decode";
    const TIMING: Timing = Timing::pipelined(6);
    type In = In;
    type Out = Out;
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
