//! Ray cone to integers (`docs/numbers.md`, "Ray").

use crate::num::{Cone, U};

/// The cone of a ray whose radius is `radius` units at its origin and grows by `tan_theta` per unit, at quality `delta` (pixels of
/// displacement times 1; 0 the base mesh everywhere, infinite full detail).
///
/// Negative `radius` and `tan_theta` count as 0, so do NaNs; `delta` is not negative. Both parts are rounded down, towards finer.
pub fn cone(delta: f64, radius: f64, tan_theta: f64) -> Cone {
    if delta <= 0.0 {
        return Cone { offset: U::MAX, slope: U::ZERO, shift: U::ZERO };
    }
    let scale = 2.0 / delta;
    let (offset, slope) = (scale * radius.max(0.0), scale * tan_theta.max(0.0));
    let shift = 63.min(room(offset, 53)).min(room(slope, 18)).max(0);
    let power = 2f64.powi(shift);
    // f64 to u64 casts truncate and saturate; what does not fit at shift 0 saturates at its own width.
    let part = |v: f64| (v * power) as u64;
    Cone { offset: U::saturating(part(offset)), slope: U::saturating(part(slope)), shift: U::new(u64::from(shift.cast_unsigned())) }
}

/// Whether rays at quality `delta` tolerate nothing, whatever their cones: [`cone`] is then neither as wide as anything anywhere nor does it grow.
pub fn is_full_detail(delta: f64) -> bool {
    delta == f64::INFINITY
}

/// Largest s with v 2^s < 2^width; large if v is 0 or subnormal.
fn room(v: f64, width: i32) -> i32 {
    if v.is_finite() {
        let exponent = ((v.to_bits() >> 52) & 0x7ff) as i32 - 1023; // v < 2^(exponent + 1)
        width - (exponent + 1)
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(c: Cone) -> (u64, u64, u64) {
        (c.offset.get(), c.slope.get(), c.shift.get())
    }

    #[test]
    fn extremes() {
        assert_eq!(plain(cone(0.0, 1.0, 1.0)), ((1 << 53) - 1, 0, 0));
        assert_eq!(plain(cone(f64::INFINITY, 5.0, 0.1)), (0, 0, 63));
        for (radius, tan) in [(0.0, 0.0), (1e300, 1e-300), (f64::INFINITY, f64::INFINITY), (f64::NAN, 1.0)] {
            let Cone { offset, slope, .. } = cone(f64::INFINITY, radius, tan);
            assert!(is_full_detail(f64::INFINITY) && (offset, slope) == (U::ZERO, U::ZERO), "{radius} {tan}");
        }
        assert_eq!(plain(cone(1.0, 0.0, -3.0)), (0, 0, 63));
        assert_eq!(plain(cone(1.0, 0.0, 1e16)), (0, (1 << 18) - 1, 0));
        assert_eq!(plain(cone(2.0, 0.0, 0.5)), (0, 1 << 17, 18));
        assert_eq!(plain(cone(1e-300, 1e300, 1.0)), ((1 << 53) - 1, (1 << 18) - 1, 0));
    }

    #[test]
    fn parts_are_rounded_down_and_fit() {
        for delta in [0.1, 1.0, 3.7, 1e9] {
            for radius in [0.0, 1e-3, 12345.678, 1e12] {
                for tan in [1e-12, 3.3e-4, 0.7, 100.0] {
                    let (offset, slope, shift) = plain(cone(delta, radius, tan));
                    let power = 2f64.powi(shift as i32);
                    assert!(offset as f64 <= 2.0 / delta * radius * power && (offset + 1) as f64 > 2.0 / delta * radius * power);
                    assert!(slope as f64 <= 2.0 / delta * tan * power && (slope + 1) as f64 > 2.0 / delta * tan * power);
                }
            }
        }
    }
}
