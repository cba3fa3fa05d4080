//! The division of hits: q = floor(numerator 2^32 / denominator), saturating at 35 bits.
//!
//! With numerator t_num and denominator det it gives t; with v or w it gives a barycentric coordinate in steps of 2^-32, of which the
//! last bit is dropped (floor of a floor). Legal: denominator > 0.
//!
//! The RTL finds [`Form::divide_bits`] bits of q in a step, against all multiples of the denominator that so many bits can stand for.

use super::parts::{DivisorMultiples, Parts, Registers, TAG};
use super::tri_test::{EdgeFunction, TNumerator};
use super::{Block, Form, Timing};
use crate::num::{RayT, START_BITS, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`HitDivide`].
    pub struct In {
        /// Numerator.
        numerator: TNumerator,
        /// Denominator, not 0.
        denominator: EdgeFunction,
    }
}

wire_struct! {
    /// Output of [`HitDivide`].
    pub struct Out {
        /// The quotient.
        quotient: RayT,
    }
}

/// The block.
pub struct HitDivide;

/// Steps of a division.
const fn steps(form: &Form) -> u32 {
    RayT::WIDTH.div_ceil(form.divide_bits)
}

/// One item: a cycle to take it, and the steps.
const fn timing(form: &Form) -> Timing {
    let cycles = 1 + steps(form);
    Timing { latency: cycles, interval: cycles }
}

impl Block for HitDivide {
    const NAME: &'static str = "hit_divide";
    const TIMING: Timing = timing(&Form::FULL);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let (bits, steps) = (form.divide_bits, steps(form));
        // The divisor is 2^zeros times the denominator: what the quotient has above 2^32, and what the steps give beyond it.
        let zeros = RayT::WIDTH - 32 + steps * bits - RayT::WIDTH;
        let (remainder, denominator) = (EdgeFunction::WIDTH + zeros, EdgeFunction::WIDTH);
        let multiples = DivisorMultiples { width: denominator, bits };
        // Busy, saturated, the count of steps.
        let registers =
            Registers::bits(2 + (steps + 1).next_power_of_two().ilog2() + remainder + RayT::WIDTH + TAG) + multiples.registers();
        let candidates = multiples.compared();
        Parts {
            products: vec![],
            add_bits: steps * candidates * (remainder + bits) + multiples.add_bits() + denominator,
            select_bits: steps * candidates * remainder,
            registers: registers.in_turns(timing(form).interval),
        }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        Self::with(input, U::ZERO)
    }
}

impl HitDivide {
    /// The division for a numerator with `low` steps of 2^-31 below whole numbers: floor((n + low / 2^31) 2^32 / d). Where the block's steps take a zero they would
    /// take the next bit of `low`.
    #[inline(always)]
    pub fn with(input: &In, low: U<START_BITS>) -> Out {
        let (n, d) = (input.numerator.get(), input.denominator.get());
        let whole = n / d;
        if whole >= 1 << 3 {
            return Out { quotient: RayT::MAX }; // 8 * 2^32 does not fit 35 bits
        }
        // The remainder r is at most d - 1 and 2 low below 2^32: r 2^32 + 2 low < d 2^32, 128 bits.
        let fraction = (((n - whole * d) << 32) + (u128::from(low.get()) << 1)) / d;
        #[expect(clippy::as_conversions, reason = "below 2^3 and below 2^32")]
        let [whole, fraction] = [whole as u64, fraction as u64];
        Out { quotient: RayT::new(whole << 32 | fraction) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::WU;
    use num_bigint::BigUint;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn agrees_with_big_integers(n in 0u128..1 << 99, d in 1u128..1 << 96, sn in 0u32..99, sd in 0u32..96) {
            let (n, d) = (n >> sn, (d >> sd).max(1));
            let exact = (BigUint::from(n) << 32u32) / BigUint::from(d);
            let wanted = exact.min(BigUint::from(RayT::MAX.get()));
            let out = HitDivide::eval(&In { numerator: WU::new(n), denominator: WU::new(d) });
            prop_assert_eq!(BigUint::from(out.quotient.get()), wanted);
        }
    }
}
