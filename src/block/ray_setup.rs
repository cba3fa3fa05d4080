//! Per-ray constants of the box tests.
//!
//! Axes are mirrored so that d >= 0 (x and boxes change sign with them). `moment` holds c_ij = x_i d_j - x_j d_i for yz, zx, xy;
//! `ceil_i` = ceil(x_i / 2^16); mantissa_i / 2^shift_i = 2^30 / d_i rounded down, shift_i the largest k <= 17 with floor(2^(30+k) / d_i) < 2^18, or 0 with the
//! mantissa held at 2^18 - 1; both 0 for d_i = 0.
//! Legal: |x_i| < 2^31, |d_i| < 2^30.

use super::parts::{DivisorMultiples, Multiplier, Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{BOX_SHIFT, Direction, Point, S, U, Vec3, Wire, wire_struct};

wire_struct! {
    /// Reciprocal of one direction component, rounded down.
    pub struct Reciprocal {
        /// Mantissa.
        mantissa: U<MANTISSA>,
        /// Right shift.
        shift: U<5>,
    }
}

wire_struct! {
    /// Constants of one axis.
    pub struct Axis {
        /// The direction component is negative: mirror.
        mirror: bool,
        /// Its magnitude.
        d: U<30>,
        /// Mirrored origin in units.
        origin: S<32>,
        /// ceil(x / 2^16).
        ceil: S<17>,
        /// 2^30 / d, rounded down.
        reciprocal: Reciprocal,
    }
}

wire_struct! {
    /// Input of [`RaySetup`].
    pub struct In {
        /// Origin in units.
        origin: Point,
        /// Direction.
        direction: Direction,
    }
}

wire_struct! {
    /// Output of [`RaySetup`].
    pub struct Out {
        /// First axis.
        x: Axis,
        /// Second axis.
        y: Axis,
        /// Third axis.
        z: Axis,
        /// c_yz, c_zx, c_xy (the moment x cross d, mirrored).
        moment: Vec3<63>,
    }
}

/// The block.
pub struct RaySetup;

/// Bits of a mantissa.
const MANTISSA: u32 = 18;

/// Steps of a division.
const fn steps(form: &Form) -> u32 {
    MANTISSA.div_ceil(form.setup_bits)
}

/// One item: a cycle to take it, the highest bit's place, normalising, multiples where a step takes more than the divisor, the steps, the choice.
const fn timing(form: &Form) -> Timing {
    let multiples = if form.setup_bits > 1 { 1 } else { 0 };
    let cycles = 1 + 2 + multiples + steps(form) + 1;
    Timing { latency: cycles, interval: cycles }
}

#[inline(always)]
fn reciprocal(d: U<30>) -> Reciprocal {
    const LARGEST: u64 = (1 << 18) - 1;
    let d = d.get();
    if d == 0 {
        return Reciprocal::default();
    }
    // d in [2^e, 2^(e+1)): floor(2^(30+k) / d) < 2^18 holds for k = e - 13 and for k = e - 12 iff d > 2^e (or the quotient rounds below).
    let e = d.ilog2();
    let upper = e.saturating_sub(12).min(17);
    let k = if (1u64 << (30 + upper)) / d <= LARGEST { upper } else { upper.saturating_sub(1) };
    let mantissa = ((1u64 << (30 + k)) / d).min(LARGEST);
    Reciprocal { mantissa: U::new(mantissa), shift: U::new(u64::from(k)) }
}

#[inline(always)]
fn axis(x: S<32>, d: S<31>) -> Axis {
    let mirror = d.get() < 0;
    // |d| < 2^30 and |x| < 2^31, so both magnitudes keep their width.
    let d = U::new(d.get().unsigned_abs());
    let x = S::<32>::new(if mirror { -x.get() } else { x.get() });
    // ceil of 32 bits over 2^16: at most 2^15, 17 bits.
    let ceil = S::new((x.get() + ((1 << BOX_SHIFT) - 1)) >> BOX_SHIFT);
    Axis { mirror, d, origin: x, ceil, reciprocal: reciprocal(d) }
}

#[inline(always)]
fn moment(i: &Axis, j: &Axis) -> S<63> {
    // Each product below 2^61, the difference below 2^62.
    S::new(i.origin.get() * j.d.get().cast_signed() - j.origin.get() * i.d.get().cast_signed())
}

impl Block for RaySetup {
    const NAME: &'static str = "ray_setup";
    const TIMING: Timing = timing(&Form::FULL);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let (x, component, moment) = (Point::WIDTH / 3, Direction::WIDTH / 3, Vec3::<63>::WIDTH / 3);
        let d = component - 1;
        let (ceil, mantissa, shift) = (17, MANTISSA, 5);
        let (bits, steps) = (form.setup_bits, steps(form));
        let multiples = DivisorMultiples { width: d, bits };
        // Mirror, d, x; the highest bit's place, divisor and remainder, quotient; mantissa and shift, ceil.
        let axis = Registers::bits(1 + d + x + shift + 2 * d + mantissa + mantissa + shift + ceil) + multiples.registers_besides();
        let product = Multiplier { unsigned: 1, ..Multiplier::new(x, component).near() };
        // Busy, the count of cycles, the tag; the first of two products, that it is there, and the moment.
        let count = timing(form).latency.next_power_of_two().ilog2();
        let around = Registers::bits(1 + count + TAG + x + component + 1 + 3 * moment);
        Parts {
            // One multiplier for all.
            products: vec![[6, x, component]],
            // Divisions, moment, ceil, mirror.
            add_bits: 3 * (steps * multiples.compared() * (d + bits) + multiples.add_bits() + moment + ceil + x + component),
            // Divisions, normalising in as many steps as the place has bits, mirror.
            select_bits: 3 * (steps * multiples.compared() * d + d * shift + x + component),
            registers: (3 * axis + product.registers() + around).in_turns(timing(form).interval),
        }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        let (o, d) = (input.origin, input.direction);
        let (x, y, z) = (axis(o.x, d.x), axis(o.y, d.y), axis(o.z, d.z));
        Out { x, y, z, moment: Vec3 { x: moment(&y, &z), y: moment(&z, &x), z: moment(&x, &y) } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(d: u64) {
        let r = reciprocal(U::new(d));
        let (m, k) = (r.mantissa.get(), r.shift.get());
        // By the definition: the largest k <= 17 that fits, or 0.
        let wanted = (0..=17u64).rev().find(|k| (1u64 << (30 + k)) / d < 1 << 18).unwrap_or(0);
        assert_eq!(k, wanted, "d = {d}");
        assert_eq!(m, ((1u64 << (30 + k)) / d).min((1 << 18) - 1), "d = {d}");
        assert!(m >= 1 << 17);
    }

    #[test]
    fn reciprocals_follow_the_definition_at_powers_of_two() {
        for e in 0..30 {
            for d in [(1u64 << e) - 1, 1 << e, (1 << e) + 1] {
                if d > 0 && d < 1 << 30 {
                    check(d);
                }
            }
        }
        assert_eq!(reciprocal(U::ZERO), Reciprocal::default());
    }

    proptest! {
        #[test]
        fn reciprocals_follow_the_definition(d in 1u64..1 << 30, shift in 0u32..30) {
            check((d >> shift).max(1));
        }
    }
}
