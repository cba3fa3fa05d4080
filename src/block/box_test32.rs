//! Ray against one box of 32-bit coordinates: the full-precision variant of [`super::box_test`] (paper section 6.1).
//!
//! The same conditions in units: lo_i d_j - hi_j d_i <= x_i d_j - x_j d_i and hi_j >= x_j. `t_near` from floor((lo_i - x_i) / 2^16).
//! Legal: |v| < 2^31, lo <= hi; constants from [`super::ray_setup`].

use super::box_test::{self, ENTRY, ENTRY_STEPS, MAGNITUDE, MANTISSA, NEAR, RECIPROCAL, entry, entry_distance, finish, last, verdict};
use super::parts::{ENTRY_DISTANCE_LATENCY, Multiplier, Parts, Registers, TAG, multiplier_latency};
use super::ray_setup::{self, Axis};
use super::{Block, Form, Timing};
use crate::num::{BOX_SHIFT, Point, RayT, S, TNear, Wire, wire_struct};

wire_struct! {
    /// Input of [`BoxTest32`].
    pub struct In {
        /// The ray's constants.
        ray: ray_setup::Out,
        /// t of the closest hit so far.
        t_max: RayT,
        /// Lower corner in units.
        lo: Point,
        /// Upper corner in units.
        hi: Point,
    }
}

/// The block.
pub struct BoxTest32;

/// (near, far) in mirrored axes: 33 bits signed.
#[inline(always)]
fn slab(axis: &Axis, lo: S<32>, hi: S<32>) -> (i64, i64) {
    let (lo, hi) = if axis.mirror { (-hi.get(), -lo.get()) } else { (lo.get(), hi.get()) };
    (lo - axis.origin.get(), hi - axis.origin.get())
}

impl Block for BoxTest32 {
    const NAME: &'static str = "box_test32";
    const TIMING: Timing = Timing::pipelined(3 + ENTRY_DISTANCE_LATENCY + 1);
    type In = In;
    type Out = box_test::Out;
    fn parts(_: &Form) -> Parts {
        let coordinate = Point::WIDTH / 3;
        let difference = coordinate + 1;
        let (mirror, sides, ends) = (6 * coordinate, 6 * difference, TNear::WIDTH);
        let pair = Multiplier { unsigned: 1, ..Multiplier::new(difference, MAGNITUDE + 1).near() };
        let mirrored = Registers::stage(3 * (3 * coordinate + MAGNITUDE + RECIPROCAL));
        let sides_there = Registers::stage(3 * (2 * difference + MAGNITUDE + RECIPROCAL));
        let ahead = Registers::line(1, 1 + multiplier_latency(difference, MAGNITUDE + 1), 0);
        let near = Registers::stage(3 * (NEAR + RECIPROCAL));
        let registers =
            mirrored + sides_there + near + entry_distance() + 12 * pair.registers() + ahead + verdict() + last(Self::TIMING, TAG);
        Parts {
            // Planes, entry distances.
            products: vec![[12, difference, MAGNITUDE + 1], [3, NEAR, MANTISSA]],
            // Sides, mirror, planes, the largest of three, the end.
            add_bits: sides + mirror + 6 * (difference + MAGNITUDE + 1) + 2 * TNear::WIDTH + ends,
            select_bits: mirror + 3 * NEAR + 3 * ENTRY * ENTRY_STEPS + 5 * TNear::WIDTH + ends,
            registers,
        }
    }
    #[inline(always)]
    fn eval(input: &In) -> box_test::Out {
        let r = &input.ray;
        let (near_x, far_x) = slab(&r.x, input.lo.x, input.hi.x);
        let (near_y, far_y) = slab(&r.y, input.lo.y, input.hi.y);
        let (near_z, far_z) = slab(&r.z, input.lo.z, input.hi.z);
        let (dx, dy, dz) = (r.x.d.get().cast_signed(), r.y.d.get().cast_signed(), r.z.d.get().cast_signed());

        // 33 x 30 bits: 63 signed.
        let pair = |near_i: i64, d_j: i64, far_j: i64, d_i: i64| near_i * d_j <= far_j * d_i;
        let planes = pair(near_x, dy, far_y, dx)
            & pair(near_y, dx, far_x, dy)
            & pair(near_y, dz, far_z, dy)
            & pair(near_z, dy, far_y, dz)
            & pair(near_z, dx, far_x, dz)
            & pair(near_x, dz, far_z, dx);
        let ahead = (far_x >= 0) & (far_y >= 0) & (far_z >= 0);

        let near = |axis: &Axis, near: i64| entry(axis.reciprocal, near >> BOX_SHIFT);
        finish(planes & ahead, near(&r.x, near_x).max(near(&r.y, near_y)).max(near(&r.z, near_z)), input.t_max)
    }
}
