//! Ray against one 16-bit box: exact, division-free, closed (paper section 3.4, `docs/numbers.md` "Box test").
//!
//! With axes mirrored so that d >= 0: hit iff near_i d_j <= far_j d_i for all i != j and far_j >= 0 for all j. In box codes this is
//! lo_i d_j - hi_j d_i <= floor((x_i d_j - x_j d_i) / 2^16) and hi_j >= ceil(x_j / 2^16): exact, since the left side is an integer.
//! Zero components need no special case. `t_near` is a lower bound in steps of 2^16 units, from the reciprocals rounded down; a box is also missed
//! if t_near * 2^18 > t_max (early termination). A miss gives t_near = 0.
//! Legal: box codes in +-32767, lo <= hi; constants from [`super::ray_setup`].

use super::parts::{ENTRY_DISTANCE_LATENCY, Multiplier, Parts, Registers, TAG, multiplier_latency};
use super::ray_setup::{self, Axis, Reciprocal};
use super::{Block, Form, Timing};
use crate::num::{BOX_SHIFT, Box16, RayT, S, T_NEAR_TO_T_SHIFT, TNear, Wire, wire_struct};

wire_struct! {
    /// Input of [`BoxTest`].
    pub struct In {
        /// The ray's constants.
        ray: ray_setup::Out,
        /// t of the closest hit so far.
        t_max: RayT,
        /// The box.
        bounds: Box16,
    }
}

wire_struct! {
    /// Output of both box tests.
    pub struct Out {
        /// The ray meets the box before `t_max`.
        hit: bool,
        /// Lower bound of the entry distance.
        t_near: TNear,
    }
}

/// The block.
pub struct BoxTest;

/// Box side in mirrored axes: (lo, hi), 16 bits because codes keep to +-32767.
#[inline(always)]
fn mirrored(axis: &Axis, lo: S<16>, hi: S<16>) -> (i64, i64) {
    let (lo, hi) = (i64::from(lo.narrow()), i64::from(hi.narrow()));
    // Without a branch, so that several boxes can be tested side by side: -v = (v ^ -1) + 1.
    let flip = -i64::from(axis.mirror);
    let swap = (lo ^ hi) & flip;
    ((lo ^ swap ^ flip) - flip, (hi ^ swap ^ flip) - flip)
}

/// Product of two numbers of at most 32 bits each: one 32 x 32 -> 64-bit multiplier, which vector units have and a 64 x 64-bit one they lack.
#[inline(always)]
fn narrow_product(a: i64, b: i64) -> i64 {
    debug_assert!(i32::try_from(a).is_ok() && i32::try_from(b).is_ok());
    #[expect(clippy::as_conversions, reason = "32 bits hold them: asserted above")]
    let (a, b) = (a as i32, b as i32);
    i64::from(a) * i64::from(b)
}

/// Entry distance of one axis from `near`, 17 bits signed in steps of 2^16 units (box codes within +-32767); times an 18-bit mantissa: 35.
#[inline(always)]
pub(super) fn entry(reciprocal: Reciprocal, near: i64) -> i64 {
    let product = narrow_product(near.max(0), reciprocal.mantissa.get().cast_signed()).cast_unsigned();
    (product >> reciprocal.shift.get()).cast_signed()
}

/// `hit` and `t_near` together, with early termination. Without a branch: whether a box is hit is what no predictor knows.
#[inline(always)]
pub(super) fn finish(slabs: bool, t_near: i64, t_max: RayT) -> Out {
    let t_near = t_near.min(TNear::MAX.get().cast_signed()).cast_unsigned();
    // 17 + 18 bits against 35.
    let hit = slabs & ((t_near << T_NEAR_TO_T_SHIFT) <= t_max.get());
    Out { hit, t_near: TNear::new(if hit { t_near } else { 0 }) }
}

/// Bits of a magnitude |d|, of ceil(x / 2^16), of a distance to a near side, and of a moment.
pub(super) const MAGNITUDE: u32 = 30;
const CEIL: u32 = 17;
pub(super) const NEAR: u32 = 16;
const MOMENT: u32 = 63;
const CODE: u32 = 16;
/// Mantissa and shift of a reciprocal.
pub(super) const MANTISSA: u32 = 18;
pub(super) const RECIPROCAL: u32 = Reciprocal::WIDTH;
/// `near` times a mantissa, shifted in five steps.
pub(super) const ENTRY: u32 = NEAR + MANTISSA;
pub(super) const ENTRY_STEPS: u32 = RECIPROCAL - MANTISSA;

impl BoxTest {
    /// Registers with a tag of so many bits.
    pub(super) fn registers(form: &Form, tag: u32) -> Registers {
        let (limit, magnitude) = (limit(form), magnitude(form));
        let mirrored = Registers::stage(3 * (2 * CODE + magnitude + CEIL + RECIPROCAL + limit + 1));
        let near = Registers::stage(3 * (NEAR + RECIPROCAL + 2 * limit) + 1);
        // Products take as long as the entry distance leaves them.
        let product_latency = ENTRY_DISTANCE_LATENCY - 2;
        let product_stages = product_latency - multiplier_latency(CODE, magnitude + 1);
        let pair = Multiplier { unsigned: 1, product_stages, ..Multiplier::new(CODE, magnitude + 1).near() };
        let differences = Registers::stage(6 * (CODE + magnitude + 1));
        let limits = Registers::line(6 * limit + 1, product_latency, 0);
        let ends = verdict() + last(Self::TIMING, tag);
        mirrored + near + entry_distance() + 12 * pair.registers() + differences + limits + ends
    }
}

/// A magnitude |d| without the bits that are always 0.
const fn magnitude(form: &Form) -> u32 {
    MAGNITUDE - form.direction_zeros
}

/// floor(c / 2^16) of a moment, likewise.
const fn limit(form: &Form) -> u32 {
    MOMENT - BOX_SHIFT - form.direction_zeros
}

/// `entry_distance`: factors, products, shifted, the larger of two, of three.
pub(super) fn entry_distance() -> Registers {
    let factors = Registers::stage(3 * (NEAR + RECIPROCAL)) + Registers::stage(3 * (ENTRY + ENTRY_STEPS));
    factors + Registers::stage(3 * TNear::WIDTH) + Registers::skid(2 * TNear::WIDTH) + Registers::stage(TNear::WIDTH)
}

/// The six planes and what lies ahead, then all of them.
pub(super) fn verdict() -> Registers {
    Registers::skid(6 + 1) + Registers::stage(1)
}

/// `t_max` in steps of `t_near`, and the tag, beside all stages but the last; and the last.
pub(super) fn last(timing: Timing, tag: u32) -> Registers {
    Registers::line(TNear::WIDTH + tag, timing.latency - 1, 1) + Registers::stage(Out::WIDTH + tag)
}

impl Block for BoxTest {
    const NAME: &'static str = "box_test";
    const TIMING: Timing = Timing::pipelined(2 + ENTRY_DISTANCE_LATENCY + 1);
    type In = In;
    type Out = Out;
    fn parts(form: &Form) -> Parts {
        let (limit, magnitude) = (limit(form), magnitude(form));
        let (mirror, ends) = (6 * CODE, TNear::WIDTH);
        let entry = 3 * ENTRY * ENTRY_STEPS + 5 * TNear::WIDTH;
        Parts {
            // Planes, entry distances.
            products: vec![[12, CODE, magnitude + 1], [3, NEAR, MANTISSA]],
            // Mirror, near and far sides, limits turned, planes, the largest of three, the end.
            add_bits: mirror + 3 * (CEIL + 1) + 3 * CEIL + 3 * limit + 6 * 2 * (CODE + magnitude + 1) + 2 * TNear::WIDTH + ends,
            select_bits: mirror + 3 * NEAR + 3 * limit + entry + ends,
            registers: Self::registers(form, TAG),
        }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        let (r, b) = (&input.ray, &input.bounds);
        let (lo_x, hi_x) = mirrored(&r.x, b.lo.x, b.hi.x);
        let (lo_y, hi_y) = mirrored(&r.y, b.lo.y, b.hi.y);
        let (lo_z, hi_z) = mirrored(&r.z, b.lo.z, b.hi.z);
        let (dx, dy, dz) = (r.x.d.get().cast_signed(), r.y.d.get().cast_signed(), r.z.d.get().cast_signed());
        let [c_yz, c_zx, c_xy] = r.moment.get();

        // 16 x 30 bits twice: 47 signed against 63 - 16.
        let pair =
            |lo_i: i64, d_j: i64, hi_j: i64, d_i: i64, c: i64| narrow_product(lo_i, d_j) - narrow_product(hi_j, d_i) <= c >> BOX_SHIFT;
        let planes = pair(lo_x, dy, hi_y, dx, c_xy)
            & pair(lo_y, dx, hi_x, dy, -c_xy)
            & pair(lo_y, dz, hi_z, dy, c_yz)
            & pair(lo_z, dy, hi_y, dz, -c_yz)
            & pair(lo_z, dx, hi_x, dz, c_zx)
            & pair(lo_x, dz, hi_z, dx, -c_zx);
        let ahead = (hi_x >= r.x.ceil.get()) & (hi_y >= r.y.ceil.get()) & (hi_z >= r.z.ceil.get());

        let near = |axis: &Axis, lo: i64| entry(axis.reciprocal, lo - axis.ceil.get());
        finish(planes & ahead, near(&r.x, lo_x).max(near(&r.y, lo_y)).max(near(&r.z, lo_z)), input.t_max)
    }
}
