//! The roundings: the only lossy operations of the project, each with a name.

use super::{BOX_SHIFT, BoundScale, COORD_LIMIT, PADDING_BITS, U};

/// Nearest coordinate to `v` units (half away from zero) that has its low `max(4, zero_bits)` bits zero, clamped to +-[`COORD_LIMIT`].
/// `zero_bits` is at most 16.
pub fn snap(v: f64, zero_bits: u32) -> i32 {
    let bits = zero_bits.max(PADDING_BITS);
    let step = f64::from(1u32 << bits);
    let limit = f64::from(COORD_LIMIT >> bits);
    // Clamped to 31 bits before the cast: it cannot overflow, and NaN becomes 0.
    let steps = (v / step).round().clamp(-limit, limit) as i32;
    steps << bits
}

/// Box code at or below coordinate `v`: floor(v / 2^16).
#[inline]
pub const fn box_code_floor(v: i32) -> i16 {
    (v >> BOX_SHIFT) as i16 // 32 - 16 bits remain
}

/// Box code at or above coordinate `v`: ceil(v / 2^16); `v` at most [`COORD_LIMIT`] in magnitude.
#[inline]
pub const fn box_code_ceil(v: i32) -> i16 {
    ((v + ((1 << BOX_SHIFT) - 1)) >> BOX_SHIFT) as i16 // v + 65535 < 2^31 because v <= COORD_LIMIT
}

/// Smallest integer not below the square root of `v`.
pub fn sqrt_ceil(v: u128) -> u64 {
    let root = v.isqrt();
    let root = if root * root == v { root } else { root + 1 };
    root as u64 // the root of a u128 has at most 64 bits, and 2^64 itself needs v > (2^64-1)^2, above any squared distance here
}

/// Displacement in units (33 bits) of a bound code: floor(code^2 mantissa / 2^shift).
pub fn bound_decode(scale: BoundScale, code: u16) -> u64 {
    let c = u64::from(code);
    (c * c * scale.mantissa.get()) >> scale.shift.get()
}

/// No displacement is longer: the diagonal of the coordinates' cube, 2 sqrt(3) [`COORD_LIMIT`], rounded up; below 2^32.8.
pub const LARGEST_BOUND: u64 = {
    let side = 2 * COORD_LIMIT as u128;
    (3 * side * side).isqrt() as u64 + 1
};

/// The scale for largest bound `largest` units, at most [`LARGEST_BOUND`]: code 1023 decodes to `largest` or a little above, below 2^33.
pub fn bound_scale(largest: u64) -> BoundScale {
    debug_assert!(largest <= LARGEST_BOUND);
    const TOP: u128 = 1023 * 1023;
    if largest == 0 {
        return BoundScale::default();
    }
    for shift in (0..64u32).rev() {
        let mantissa = (u128::from(largest) << shift).div_ceil(TOP);
        if let Some(mantissa) = u64::try_from(mantissa).ok().and_then(U::checked) {
            return BoundScale { mantissa, shift: U::new(u64::from(shift)) };
        }
    }
    unreachable!("2^33 / 1023^2 has fewer than 18 bits")
}

/// Smallest code that decodes to at least `bound` units; `bound` at most the scale's largest.
pub fn bound_encode(scale: BoundScale, bound: u64) -> u16 {
    let (mut low, mut high) = (0u16, 1023u16);
    while low < high {
        let mid = (low + high) / 2;
        if bound_decode(scale, mid) >= bound { high = mid } else { low = mid + 1 }
    }
    low
}

/// Smallest integer not below the length of `d` (each component at most 2^33 in magnitude): [`sqrt_ceil`] of the squared length, faster.
#[inline]
pub fn length_ceil(d: [i64; 3]) -> u64 {
    let squared: u128 = d.iter().map(|c| u128::from(c.unsigned_abs()) * u128::from(c.unsigned_abs())).sum();
    // The guess is off by at most 1: the root is below 2^34 and an f64 holds it to 2^-18.
    let guess = d.iter().map(|&c| c as f64 * c as f64).sum::<f64>().sqrt().ceil();
    let mut root = guess as u64;
    let square = |r: u64| u128::from(r) * u128::from(r);
    while square(root) < squared {
        root += 1;
    }
    while root > 0 && square(root - 1) >= squared {
        root -= 1;
    }
    root
}

/// [`bound_encode`] for many bounds of one scale: a guess and its correction in place of a search.
#[derive(Clone, Copy, Debug)]
pub struct BoundEncoder {
    scale: BoundScale,
    /// Codes per square root of a unit.
    factor: f64,
}

impl BoundEncoder {
    /// An encoder for this scale.
    pub fn new(scale: BoundScale) -> Self {
        let factor = match scale.mantissa.get() {
            0 => 0.0,                                                                   // every code decodes to 0, so code 0 serves
            mantissa => (2f64.powi(scale.shift.get() as i32) / mantissa as f64).sqrt(), // shift has 6 bits
        };
        Self { scale, factor }
    }

    /// Smallest code that decodes to at least `bound` units; `bound` at most the scale's largest.
    #[inline]
    pub fn encode(&self, bound: u64) -> u16 {
        let mut code = ((bound as f64).sqrt() * self.factor).min(1023.0) as u16;
        while code > 0 && bound_decode(self.scale, code - 1) >= bound {
            code -= 1;
        }
        while code < 1023 && bound_decode(self.scale, code) < bound {
            code += 1;
        }
        code
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn snap_keeps_to_grid_and_limit() {
        assert_eq!(snap(24.0, 0), 32); // half a step goes away from zero
        assert_eq!(snap(-24.0, 0), -32);
        assert_eq!(snap(23.9, 0), 16);
        assert_eq!(snap(1e12, 10), COORD_LIMIT);
        assert_eq!(snap(-1e12, 10), -COORD_LIMIT);
        assert_eq!(snap(1600.0, 10), 2048);
    }

    #[test]
    fn box_codes_round_outwards_and_never_wrap() {
        for v in [0, 1, -1, 65_535, 65_536, 65_537, -65_536, COORD_LIMIT, -COORD_LIMIT, COORD_LIMIT - 1] {
            let (lo, hi) = (i64::from(box_code_floor(v)) << 16, i64::from(box_code_ceil(v)) << 16);
            assert!(lo <= i64::from(v) && i64::from(v) <= hi && hi - lo <= 65_536, "{v}");
        }
        assert_eq!(box_code_ceil(COORD_LIMIT), 32_766);
    }

    #[test]
    fn scale_covers_the_largest_bound() {
        for h in [1, 2, 3, 1000, 1 << 20, 1 << 32, LARGEST_BOUND] {
            let s = bound_scale(h);
            assert!(bound_decode(s, 1023) >= h);
            assert!(bound_decode(s, 1023) < 1 << 33);
            assert!(bound_decode(s, 1023) as f64 <= h as f64 * 1.0001 + 1.0, "{h}");
        }
        assert_eq!(bound_decode(bound_scale(0), 1023), 0);
    }

    proptest! {
        #[test]
        fn sqrt_ceil_is_tight(v in 0u128..1 << 68) {
            let r = u128::from(sqrt_ceil(v));
            prop_assert!(r * r >= v && (r == 0 || (r - 1) * (r - 1) < v));
        }

        #[test]
        fn length_ceil_is_the_root_of_the_squared_length(d in prop::array::uniform3(-(1i64 << 33)..=1 << 33), bits in 0u32..34) {
            let d = d.map(|c| c >> bits);
            let squared: u128 = d.iter().map(|&c| u128::from(c.unsigned_abs()).pow(2)).sum();
            prop_assert_eq!(length_ceil(d), sqrt_ceil(squared));
        }

        #[test]
        fn codes_round_up_and_are_tight(largest in 1..=LARGEST_BOUND, part in 0.0f64..=1.0) {
            let scale = bound_scale(largest);
            let bound = ((largest as f64 * part) as u64).min(largest);
            let code = bound_encode(scale, bound);
            prop_assert!(bound_decode(scale, code) >= bound);
            prop_assert!(code == 0 || bound_decode(scale, code - 1) < bound);
            prop_assert_eq!(BoundEncoder::new(scale).encode(bound), code);
        }
    }
}
