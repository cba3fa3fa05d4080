//! Exact arithmetic on `f64`: sums and products of numbers m 2^e, never rounded.

use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive};
use std::ops::{Add, Mul, Sub};

/// m 2^e.
#[derive(Clone, Debug)]
pub struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

impl Dyadic {
    /// An integer times 2^`exponent`.
    pub fn new(mantissa: impl Into<BigInt>, exponent: i64) -> Self {
        Self { mantissa: mantissa.into(), exponent }
    }

    /// A finite number as it is.
    pub fn of(v: f64) -> Self {
        let bits = v.to_bits();
        let (fraction, biased) = ((bits & ((1 << 52) - 1)).cast_signed(), (bits >> 52 & 0x7ff).cast_signed());
        let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
        Self::new(if v < 0.0 { -mantissa } else { mantissa }, exponent)
    }

    /// The nearest `f64` or one beside it; 0 or infinite where the range of `f64` ends.
    pub fn to_f64(&self) -> f64 {
        // 64 bits keep more than an f64 does.
        let drop = self.mantissa.abs().bits().saturating_sub(64);
        let top = (self.mantissa.clone() >> drop).to_f64().unwrap_or(0.0);
        let exponent = (self.exponent + drop.cast_signed()).clamp(-2200, 2200) as i32; // within 12 bits
        // In two halves: a single power may leave the range where the product does not.
        top * 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2)
    }

    fn aligned(&self, to: i64) -> BigInt {
        self.mantissa.clone() << (self.exponent - to)
    }
}

impl Add for &Dyadic {
    type Output = Dyadic;
    fn add(self, other: &Dyadic) -> Dyadic {
        let exponent = self.exponent.min(other.exponent);
        Dyadic::new(self.aligned(exponent) + other.aligned(exponent), exponent)
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;
    fn sub(self, other: &Dyadic) -> Dyadic {
        let exponent = self.exponent.min(other.exponent);
        Dyadic::new(self.aligned(exponent) - other.aligned(exponent), exponent)
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;
    fn mul(self, other: &Dyadic) -> Dyadic {
        Dyadic::new(&self.mantissa * &other.mantissa, self.exponent + other.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn what_f64_loses_is_kept() {
        let (big, small) = (Dyadic::of(1e30), Dyadic::of(1e-30));
        assert_eq!((&(&big + &small) - &big).to_f64(), 1e-30);
        assert_eq!((&big * &small).to_f64(), 1e30 * 1e-30);
        assert_eq!(
            [0.0, -0.0, f64::MIN_POSITIVE / 4.0, -f64::MAX].map(|v| Dyadic::of(v).to_f64()),
            [0.0, 0.0, f64::MIN_POSITIVE / 4.0, -f64::MAX]
        );
    }

    proptest! {
        #[test]
        fn products_and_sums_agree_with_f64_to_its_rounding(a in -1e20f64..1e20, b in -1e20f64..1e20) {
            let close = |x: f64, y: f64| (x - y).abs() <= x.abs() * 1e-15;
            prop_assert_eq!(Dyadic::of(a).to_f64(), a);
            prop_assert!(close((&Dyadic::of(a) * &Dyadic::of(b)).to_f64(), a * b));
            prop_assert!(close((&Dyadic::of(a) - &Dyadic::of(b)).to_f64(), a - b));
        }
    }
}
