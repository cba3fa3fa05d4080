//! Where rays start, and what they can see from there.

use super::{ModelSpace, Query};
use rayon::prelude::*;

/// Where some rays start, and how their cones widen; in world units, or in those of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Lower corner of the box of their origins.
    pub lo: [f64; 3],
    /// Upper corner.
    pub hi: [f64; 3],
    /// Least radius of a cone at its origin.
    pub radius: f64,
    /// Least tangent of the angle between the axis of a cone and its side.
    pub tan_theta: f64,
    /// All that they may see, if they start from one point and do not go in all directions.
    pub view: Option<ViewCone>,
}

/// A cone around all directions of some rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewCone {
    /// Its axis, of length 1.
    pub axis: [f64; 3],
    /// Tangent of the angle between the axis and its side.
    pub tangent: f64,
}

impl ViewCone {
    /// Whether a sphere lies outside of the cone from `apex`, all of it.
    pub fn misses(&self, apex: [f64; 3], centre: [f64; 3], radius: f64) -> bool {
        let to: [f64; 3] = std::array::from_fn(|k| centre[k] - apex[k]);
        let along: f64 = (0..3).map(|k| to[k] * self.axis[k]).sum();
        let squared: f64 = to.iter().map(|c| c * c).sum();
        let beside = (squared - along * along).max(0.0).sqrt();
        // Distance from the cone's side, outwards; or from the apex, where that is nearest.
        let is_behind = along + self.tangent * beside <= 0.0;
        let distance = if is_behind { squared.sqrt() } else { (beside - self.tangent * along) / self.tangent.hypot(1.0) };
        distance > radius
    }
}

impl Eye {
    /// Rays that may start anywhere, however thin.
    pub const ANYWHERE: Self = Self { lo: [f64::NEG_INFINITY; 3], hi: [f64::INFINITY; 3], radius: 0.0, tan_theta: 0.0, view: None };

    /// No rays.
    pub const NOWHERE: Self =
        Self { lo: [f64::INFINITY; 3], hi: [f64::NEG_INFINITY; 3], radius: f64::INFINITY, tan_theta: f64::INFINITY, view: None };

    /// That of a ray.
    pub fn of(query: &Query) -> Self {
        Self { lo: query.origin, hi: query.origin, radius: query.radius, tan_theta: query.tan_theta, view: None }
    }

    /// That of a camera's rays, from one point.
    pub fn at(point: [f64; 3], tan_theta: f64) -> Self {
        Self { lo: point, hi: point, radius: 0.0, tan_theta, view: None }
    }

    /// The same of rays that all lie in this cone from that point.
    #[must_use]
    pub fn looking(self, view: ViewCone) -> Self {
        Self { view: Some(view), ..self }
    }

    /// Both as one.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let each = |of: fn(f64, f64) -> f64, a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| of(a[k], b[k]));
        Self {
            lo: each(f64::min, self.lo, other.lo),
            hi: each(f64::max, self.hi, other.hi),
            radius: self.radius.min(other.radius),
            tan_theta: self.tan_theta.min(other.tan_theta),
            view: None,
        }
    }

    /// The same in units of a model.
    #[must_use]
    pub fn in_units(self, space: &ModelSpace) -> Self {
        Self { lo: space.to_units(self.lo), hi: space.to_units(self.hi), radius: self.radius / space.placement.scale, ..self }
    }

    /// A radius that no ray's cone falls below within this box, all of it in the same units.
    pub fn least_radius(&self, lo: [f64; 3], hi: [f64; 3]) -> f64 {
        let beside: [f64; 3] = std::array::from_fn(|k| (lo[k] - self.hi[k]).max(self.lo[k] - hi[k]).max(0.0));
        self.radius + self.tan_theta * beside.iter().map(|d| d * d).sum::<f64>().sqrt()
    }
}

/// Rays of a source that meet the model's box: those that pass beside it have no say.
fn that_meet(queries: impl ParallelIterator<Item = Query>, space: &ModelSpace) -> impl ParallelIterator<Item = Query> {
    queries.filter(|query| space.enter(query, 1.0).is_some())
}

/// [`least_radius`](super::RaySource::least_radius) of rays that have nothing in common.
pub(super) fn least_radius_of_all(queries: impl ParallelIterator<Item = Query>, space: &ModelSpace) -> f64 {
    let radius = |query: Query| query.radius + query.tan_theta * space.distance_to(query.origin);
    that_meet(queries, space).map(radius).reduce(|| f64::INFINITY, f64::min)
}

/// The eye of such rays.
pub(super) fn eye_of_all(queries: impl ParallelIterator<Item = Query>, space: &ModelSpace) -> Eye {
    that_meet(queries, space).map(|query| Eye::of(&query)).reduce(|| Eye::NOWHERE, Eye::with)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;

    #[test]
    fn no_cone_of_any_eye_is_thinner_within_a_box() {
        let near = Eye::of(&Query::new([3.0, 0.0, 0.0], [1.0, 0.0, 0.0]).with_cone(0.5, 0.1));
        let far = Eye::of(&Query::new([0.0, 9.0, 0.0], [1.0, 0.0, 0.0]).with_cone(0.25, 0.2));
        let unit = ([-1.0; 3], [1.0; 3]);
        let radius = |eyes: Eye| eyes.least_radius(unit.0, unit.1);
        assert_eq!([radius(near), radius(far)], [0.5 + 0.1 * 2.0, 0.25 + 0.2 * 8.0]);
        // The box of both holds the unit box's middle: what is left is the least of each.
        let both = near.with(far);
        assert_eq!((both, radius(both)), (Eye { lo: [0.0; 3], hi: [3.0, 9.0, 0.0], radius: 0.25, tan_theta: 0.1, view: None }, 0.25));
        assert_eq!(near.with(Eye::NOWHERE), near);
        assert_eq!((radius(Eye::ANYWHERE), radius(Eye::NOWHERE)), (0.0, f64::INFINITY));
        let space = ModelSpace { placement: Placement { offset: [1.0, 0.0, 0.0], scale: 0.5 }, lo: [0; 3], hi: [1; 3], zeros: [0; 2] };
        assert_eq!(near.in_units(&space), Eye { lo: [4.0, 0.0, 0.0], hi: [4.0, 0.0, 0.0], radius: 1.0, tan_theta: 0.1, view: None });
    }
}
