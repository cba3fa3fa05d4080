//! What every ray tolerates that starts in a box, wherever it goes: `docs/leaving-out.md`, "Cameras anywhere in a box".

use crate::format::JobRegion;
use crate::num::DIRECTION_SCALE;
use crate::rays::ModelSpace;

/// A box in units.
pub(super) type UnitBox = [[f64; 3]; 2];

/// The slope above which a cone's own 18 bits saturate, whatever its shift: what is claimed of wider ones is no more than this.
const STEEPEST: f64 = (1u32 << 17) as f64;
/// What slope and offset can lose by rounding, as a part of the tolerance: a slope has at least 17 bits, or what it loses is as small beside the offset.
const ROUNDED: f64 = 1.0 / 65536.0;
/// Largest distance in the model's box, in units: its diagonal is below 2^32 sqrt 3.
const FARTHEST: f64 = 7.5e9;

/// The rays of a region in units.
pub(super) struct Tolerance {
    /// Where they start.
    from: UnitBox,
    /// Units tolerated for each unit of distance from there: 2 tan(theta) / delta.
    slope: f64,
    /// By how much the integer ray can be beside the one that was asked for, and its lengths short, in units.
    slack: f64,
}

impl Tolerance {
    /// Of the rays of a region, none if it is none ([`JobRegion::wrong`]).
    pub(super) fn of(space: &ModelSpace, region: &JobRegion) -> Option<Self> {
        let delta = region.quality().filter(|_| region.wrong().is_none())?;
        let corners = [space.to_units(region.lo), space.to_units(region.hi)];
        let (coordinate, direction) = (f64::from(1u32 << space.zeros[0]), f64::from(1u32 << space.zeros[1]));
        // An origin is off by sqrt(3)/2 steps; a direction of 2^30 by less than 1.25 steps, at most FARTHEST away; a length is rounded down, and taken as if
        // directions were 2^30 long; and positions far away have few bits behind the point.
        let largest = corners.into_iter().flatten().fold(FARTHEST, |most, c| most.max(c.abs()));
        let turned = FARTHEST * 1.25 * direction / f64::from(DIRECTION_SCALE);
        let slack = coordinate + turned + 2.0 + FARTHEST / f64::from(DIRECTION_SCALE) + 64.0 * f64::EPSILON * largest;
        // A quality of 0 tolerates anything: infinitely much.
        Some(Self { from: corners, slope: if delta > 0.0 { (2.0 * region.cone / delta).min(STEEPEST) } else { f64::INFINITY }, slack })
    }

    /// Units that every one of the rays tolerates at the corners of triangles that lie in the box `own`, if it meets the box `around`, in which they lie too.
    ///
    /// A corner v is at least `dist(from, own)` from the ray's start, and at most the diagonal of `around` from a place on the ray: so it lies so far along the ray as
    /// the two make a right triangle.
    pub(super) fn at(&self, own: UnitBox, around: UnitBox) -> f64 {
        if self.slope == f64::INFINITY {
            return f64::INFINITY;
        }
        let length = |of: [f64; 3]| of.iter().map(|c| c * c).sum::<f64>().sqrt();
        let apart = |k: usize| (own[0][k] - self.from[1][k]).max(self.from[0][k] - own[1][k]).max(0.0);
        // In 2^-40 parts, more than what is rounded here.
        let away = length(std::array::from_fn(apart)) * (1.0 - 1e-12) - self.slack;
        let beside = length(std::array::from_fn(|k| around[1][k] - around[0][k])) * (1.0 + 1e-12) + self.slack;
        if away <= beside {
            return 0.0;
        }
        let along = ((away - beside) * (away + beside)).sqrt() - self.slack;
        // Offset and tolerance are rounded down.
        (self.slope * along.max(0.0) * (1.0 - ROUNDED) - 3.0).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;

    #[test]
    fn by_hand() {
        let zeros = [0; 2];
        let placement = Placement { offset: [1.0, 0.0, 0.0], scale: 0.5 };
        let space = ModelSpace { placement, lo: [-1 << 30; 3], hi: [1 << 30; 3], zeros };
        let region = JobRegion { delta: "2".into(), lo: [1.0, 0.0, 0.0], hi: [1.0, 0.0, 0.0], cone: 0.01 };
        let tolerance = Tolerance::of(&space, &region).expect("a region");
        // 5e8 units away, a diagonal of 3e8 beside: 4e8 along, a hundredth of it.
        let (own, around) = ([[5e8, 0.0, 0.0], [5.1e8, 0.0, 0.0]], [[4e8, 0.0, 0.0], [7e8, 0.0, 0.0]]);
        let at = tolerance.at(own, around);
        assert!(at < 4e6 && at > 4e6 * (1.0 - 2.0 * ROUNDED), "{at}");
        // Too near for what lies around, or within.
        assert_eq!(tolerance.at(own, [[4e8, 0.0, 0.0], [9.1e8, 0.0, 0.0]]), 0.0);
        assert_eq!(tolerance.at([[-1.0; 3], [1.0; 3]], [[-1.0; 3], [1.0; 3]]), 0.0);
        let of = |delta: &str, cone| {
            Tolerance::of(&space, &JobRegion { delta: delta.into(), cone, ..region.clone() }).map(|t| t.at(own, around))
        };
        assert_eq!((of("0", 0.01), of("inf", 0.01), of("1", 0.0), of("-1", 0.1)), (Some(f64::INFINITY), Some(0.0), Some(0.0), None));
    }
}
