//! The division of hits of rays from exact starts: q = floor((numerator + low / 2^31) 2^32 / denominator), saturating at 35 bits.
//!
//! As [`HitDivide`], whose steps shift zeros in where these shift in what the numerator has below whole numbers. Legal: denominator > 0.

use super::hit_divide::{self, HitDivide};
use super::parts::{Parts, Registers};
use super::tri_test::{EdgeFunction, TNumerator};
use super::{Block, Form, Timing};
use crate::num::{START_BITS, U, wire_struct};

wire_struct! {
    /// Input of [`StartDivide`].
    pub struct In {
        /// Numerator, rounded down.
        numerator: TNumerator,
        /// What is left of it, in steps of 2^-31.
        low: U<START_BITS>,
        /// Denominator, not 0.
        denominator: EdgeFunction,
    }
}

/// The block.
pub struct StartDivide;

impl Block for StartDivide {
    const NAME: &'static str = "start_divide";
    const TIMING: Timing = HitDivide::TIMING;
    type In = In;
    type Out = hit_divide::Out;
    fn timing(form: &Form) -> Timing {
        HitDivide::timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let of_whole = HitDivide::parts(form);
        // What is left moves up with each step.
        let low = Registers::bits(START_BITS).in_turns(HitDivide::timing(form).interval);
        Parts { registers: of_whole.registers + low, ..of_whole }
    }
    #[inline]
    fn eval(input: &In) -> hit_divide::Out {
        let In { numerator, low, denominator } = *input;
        HitDivide::with(&hit_divide::In { numerator, denominator }, low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{RayT, WU};
    use num_bigint::BigUint;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_below_whole_numbers_counts(n in 0u128..1 << 99, low in 0u64..1 << 31, d in 1u128..1 << 96, sn in 0u32..99, sd in 0u32..96) {
            let (n, d) = (n >> sn, (d >> sd).max(1));
            let exact = ((BigUint::from(n) << START_BITS) + low) * 2u32 / BigUint::from(d);
            let wanted = exact.min(BigUint::from(RayT::MAX.get()));
            let out = StartDivide::eval(&In { numerator: WU::new(n), low: U::new(low), denominator: WU::new(d) });
            prop_assert_eq!(BigUint::from(out.quotient.get()), wanted);
        }
    }
}
