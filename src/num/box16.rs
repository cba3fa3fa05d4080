//! Boxes of 16-bit codes.

use super::{Vec3, box_code_ceil, box_code_floor, wire::wire_struct};

wire_struct! {
    /// A box in steps of 2^16 units, rounded outwards.
    pub struct Box16 {
        /// Lower corner.
        lo: Vec3<16>,
        /// Upper corner.
        hi: Vec3<16>,
    }
}

impl Box16 {
    /// The smallest box in 2^16-unit steps that holds these points; `points` is not empty.
    pub fn of_points(points: &[[i32; 3]]) -> Self {
        let mut lo = [i32::MAX; 3];
        let mut hi = [i32::MIN; 3];
        for p in points {
            for k in 0..3 {
                lo[k] = lo[k].min(p[k]);
                hi[k] = hi[k].max(p[k]);
            }
        }
        Self::from_codes(lo.map(box_code_floor), hi.map(box_code_ceil))
    }

    /// From codes.
    #[inline]
    pub fn from_codes(lo: [i16; 3], hi: [i16; 3]) -> Self {
        let v = |c: [i16; 3]| Vec3::new(i64::from(c[0]), i64::from(c[1]), i64::from(c[2]));
        Self { lo: v(lo), hi: v(hi) }
    }
}
