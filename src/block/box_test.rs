//! Ray against one 16-bit box: exact, division-free, closed (paper section 3.4, `docs/numbers.md` "Box test").
//!
//! With axes mirrored so that d >= 0: hit iff near_i d_j <= far_j d_i for all i != j and far_j >= 0 for all j. In box codes this is
//! lo_i d_j - hi_j d_i <= floor((x_i d_j - x_j d_i) / 2^16) and hi_j >= ceil(x_j / 2^16): exact, since the left side is an integer.
//! Zero components need no special case. `t_near` is a lower bound in steps of 2^16 units, from the reciprocals rounded down; a box is also missed
//! if t_near * 2^18 > t_max (early termination). A miss gives t_near = 0.
//! Legal: box codes in +-32767, lo <= hi; constants from [`super::ray_setup`].

use super::ray_setup::{self, Axis};
use super::{Block, Timing};
use crate::num::{BOX_SHIFT, Box16, RayT, S, T_NEAR_TO_T_SHIFT, TNear, wire_struct};

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
pub(super) fn entry(axis: &Axis, near: i64) -> i64 {
    let product = narrow_product(near.max(0), axis.reciprocal.mantissa.get().cast_signed()).cast_unsigned();
    (product >> axis.reciprocal.shift.get()).cast_signed()
}

/// `hit` and `t_near` together, with early termination. Without a branch: whether a box is hit is what no predictor knows.
#[inline(always)]
pub(super) fn finish(slabs: bool, t_near: i64, t_max: RayT) -> Out {
    let t_near = t_near.min(TNear::MAX.get().cast_signed()).cast_unsigned();
    // 17 + 18 bits against 35.
    let hit = slabs & ((t_near << T_NEAR_TO_T_SHIFT) <= t_max.get());
    Out { hit, t_near: TNear::new(if hit { t_near } else { 0 }) }
}

impl Block for BoxTest {
    const NAME: &'static str = "box_test";
    const TIMING: Timing = Timing::pipelined(8);
    type In = In;
    type Out = Out;
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

        let near = |axis: &Axis, lo: i64| entry(axis, lo - axis.ceil.get());
        finish(planes & ahead, near(&r.x, lo_x).max(near(&r.y, lo_y)).max(near(&r.z, lo_z)), input.t_max)
    }
}
