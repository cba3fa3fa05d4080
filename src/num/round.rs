//! The roundings: the only lossy operations of the project, each with a name.

use super::{BOX_SHIFT, BoundScale, COORD_LIMIT, MAX_BOUND_OFFSET, PADDING_BITS, U};

/// Nearest coordinate to `v` units (half away from zero) that has its low `max(4, zero_bits)` bits zero, clamped to +-[`COORD_LIMIT`].
/// `zero_bits` is at most 16.
pub fn snap(v: f64, zero_bits: u32) -> i32 {
    let bits = zero_bits.max(PADDING_BITS);
    let limit = f64::from(COORD_LIMIT >> bits);
    // A power of two: exact. Clamped to 31 bits before the cast: it cannot overflow, and NaN becomes 0.
    let steps = (v * (1.0 / f64::from(1u32 << bits))).clamp(-limit, limit);
    nearest(steps) << bits
}

/// The nearest integer, half away from zero: [`f64::round`] for magnitudes below 2^31, which on processors without an instruction for it is a call.
#[inline]
fn nearest(v: f64) -> i32 {
    // The largest number below a half: with a half, what is just below one would round up.
    const BELOW_HALF: f64 = 0.5 - f64::EPSILON / 4.0;
    (v + BELOW_HALF.copysign(v)) as i32 // towards zero
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

/// 2^(i / 16) in steps of 1/256, rounded up, for i = 0 to 15: what bound codes have below their octave.
pub const BOUND_MANTISSAS: [u16; 16] = [256, 268, 280, 292, 305, 318, 332, 347, 363, 379, 395, 413, 431, 450, 470, 491];

/// Displacement in units (33 bits) of a bound code: 0 for code 0, else floor(M 2^(k / 16) / 256) with k = code + offset, k / 16 rounded down and
/// M the [`BOUND_MANTISSAS`] of the rest.
#[inline(always)]
pub fn bound_decode(scale: BoundScale, code: u8) -> u64 {
    if code == 0 {
        return 0;
    }
    let k = u64::from(code) + scale.offset.get();
    (u64::from(BOUND_MANTISSAS[(k & 15) as usize]) << (k >> 4)) >> 8 // four bits
}

/// No displacement is longer: the diagonal of the coordinates' cube, 2 sqrt(3) [`COORD_LIMIT`], rounded up; below 2^32.8.
pub const LARGEST_BOUND: u64 = {
    let side = 2 * COORD_LIMIT as u128;
    (3 * side * side).isqrt() as u64 + 1
};

/// The scale for largest bound `largest` units, at most [`LARGEST_BOUND`]: the least offset with which code 255 decodes to `largest` or more, below 2^33.
pub fn bound_scale(largest: u64) -> BoundScale {
    debug_assert!(largest <= LARGEST_BOUND);
    let offset = (0..MAX_BOUND_OFFSET).find(|&offset| bound_decode(BoundScale { offset: U::new(offset) }, u8::MAX) >= largest);
    BoundScale { offset: U::new(offset.unwrap_or(MAX_BOUND_OFFSET)) }
}

/// Smallest code that decodes to at least `bound` units; `bound` at most the scale's largest.
#[inline]
pub fn bound_encode(scale: BoundScale, bound: u64) -> u8 {
    if bound == 0 {
        return 0;
    }
    // The octave below, and the bound in 256ths of it, rounded up: 256 to 512.
    let octave = u64::BITS - 1 - bound.leading_zeros();
    let parts = ((bound << 8) + ((1 << octave) - 1)) >> octave;
    let k = 16 * u64::from(octave) + u64::from(FIRST_MANTISSAS[(parts - 256) as usize]);
    k.saturating_sub(scale.offset.get()).clamp(1, 255) as u8 // clamped
}

/// For 256 to 512: the place of the first of the [`BOUND_MANTISSAS`] that is no less, or 16, which is that of the next octave's first.
const FIRST_MANTISSAS: [u8; 257] = {
    let (mut places, mut parts, mut place) = ([0; 257], 256, 0);
    while parts <= 512 {
        while place < 16 && (BOUND_MANTISSAS[place] as usize) < parts {
            place += 1;
        }
        places[parts - 256] = place as u8; // at most 16
        parts += 1;
    }
    places
};

/// Smallest integer not below the length of `d` (each component at most 2^33 in magnitude): [`sqrt_ceil`] of the squared length, faster.
#[inline]
pub fn length_ceil(d: [i64; 3]) -> u64 {
    if d.iter().all(|c| c.unsigned_abs() < 1 << 31) {
        // As below, where three squares have 64 bits; the root is below 2^32.
        let squared: u64 = d.iter().map(|c| c.unsigned_abs() * c.unsigned_abs()).sum();
        let mut root = (squared as f64).sqrt() as u64;
        while root * root < squared {
            root += 1;
        }
        while root > 0 && (root - 1) * (root - 1) >= squared {
            root -= 1;
        }
        return root;
    }
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
    fn mantissas_are_the_roots_of_two_rounded_up() {
        for (i, &mantissa) in BOUND_MANTISSAS.iter().enumerate() {
            // m^16 against (256 2^(i / 16))^16 = 2^(128 + i), in halves: the sixteenth power of a number of 9 bits has 144.
            let above = |m: u64| m.pow(4) as f64 * m.pow(4) as f64 >= 2f64.powi(64) * 2f64.powf(i as f64 / 2.0) * (1.0 - 1e-12);
            let m = u64::from(mantissa);
            assert!(above(m) && !above(m - 1), "{i}");
        }
    }

    #[test]
    fn scale_covers_the_largest_bound() {
        for h in [0, 1, 2, 3, 255, 1000, 1 << 16, (1 << 16) + 1, 1 << 20, 1 << 32, LARGEST_BOUND] {
            let s = bound_scale(h);
            assert!(bound_decode(s, 255) >= h);
            assert!(bound_decode(s, 255) < 1 << 33);
            assert!(s.offset == U::ZERO || bound_decode(BoundScale { offset: U::new(s.offset.get() - 1) }, 255) < h, "{h}");
        }
        assert!(bound_decode(BoundScale { offset: U::new(MAX_BOUND_OFFSET) }, 255) < 1 << 33);
        assert_eq!(bound_decode(bound_scale(0), 0), 0);
    }

    #[test]
    fn codes_do_not_fall() {
        for offset in [0, 1, 15, 16, 100, MAX_BOUND_OFFSET] {
            let scale = BoundScale { offset: U::new(offset) };
            assert!((1..=255).all(|code| bound_decode(scale, code) >= bound_decode(scale, code - 1)), "{offset}");
        }
    }

    #[test]
    fn nearest_is_round_at_halves_and_beside_them() {
        for whole in [0, 1, 2, 3, 1000, (1 << 27) - 1] {
            for v in [f64::from(whole), f64::from(whole) + 0.5] {
                for v in [v, v.next_up(), v.next_down(), -v, -v.next_up(), -v.next_down()] {
                    assert_eq!(f64::from(nearest(v)), v.round(), "{v}");
                }
            }
        }
        assert_eq!(snap(f64::NAN, 4), 0);
    }

    #[test]
    fn codes_are_the_least_that_reach() {
        for offset in [0, 1, 15, 16, 100, MAX_BOUND_OFFSET] {
            let scale = BoundScale { offset: U::new(offset) };
            let steps = (0..=255).flat_map(|code| [-1, 0, 1].map(|by| (bound_decode(scale, code) as i64 + by).max(0) as u64));
            for bound in steps.filter(|&bound| bound <= bound_decode(scale, 255)) {
                let searched = (0..=255).find(|&code| bound_decode(scale, code) >= bound).unwrap();
                assert_eq!(bound_encode(scale, bound), searched, "{bound} at offset {offset}");
            }
        }
    }

    proptest! {
        #[test]
        fn nearest_is_round(v in -134_217_728.0f64..134_217_728.0, bits in 0u32..60) {
            let v = v / (1u64 << bits) as f64;
            prop_assert_eq!(f64::from(nearest(v)), v.round());
        }

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
            // A sixteenth of an octave, the mantissa's own rounding, and that of small numbers.
            prop_assert!(code < 2 || bound_decode(scale, code) as f64 <= bound as f64 * 1.05 + 1.0);
        }
    }
}
