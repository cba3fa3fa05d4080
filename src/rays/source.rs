//! Where rays come from.

use super::{Camera, ModelSpace, Query};
use rayon::prelude::*;

/// Columns and rows of a camera's tile.
const TILE: u32 = 8;

/// Rays in batches; a group of cores takes a batch at a time.
pub trait RaySource: Sync {
    /// Rays in all.
    fn rays(&self) -> u64;

    /// How many batches there are.
    fn batches(&self) -> usize;

    /// Tells `each` the number and the query of every ray of a batch, in their order.
    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query));

    /// Some ray starts behind the end of another.
    fn is_ordered(&self) -> bool {
        false
    }

    /// The first batches of the frames behind the first, in order: rays of a frame come when all of the frames before have ended.
    fn frame_starts(&self) -> Vec<usize> {
        Vec::new()
    }

    /// A radius, in world units, that no ray's cone falls below within the model's box: the cone's at the box's distance from the ray's origin.
    fn least_radius(&self, space: &ModelSpace) -> f64;

    /// Where its rays start that meet the model's box, in world units: one for each camera.
    fn eyes(&self, space: &ModelSpace) -> Vec<Eye>;
}

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

/// [`RaySource::least_radius`] of rays that have nothing in common.
pub(super) fn least_radius_of_all(queries: impl ParallelIterator<Item = Query>, space: &ModelSpace) -> f64 {
    let radius = |query: Query| query.radius + query.tan_theta * space.distance_to(query.origin);
    that_meet(queries, space).map(radius).reduce(|| f64::INFINITY, f64::min)
}

/// The eye of such rays.
pub(super) fn eye_of_all(queries: impl ParallelIterator<Item = Query>, space: &ModelSpace) -> Eye {
    that_meet(queries, space).map(|query| Eye::of(&query)).reduce(|| Eye::NOWHERE, Eye::with)
}

/// What a method may choose by once for all rays of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// Quality of the level of detail: 0 the base mesh, infinite full detail; what it promises: `docs/error-bound.md`.
    pub delta: f64,
    /// A radius that no ray's cone falls below within the model's box, in units of the model.
    pub least_radius: f64,
    /// Where rays start, in units of the model: for what chooses by parts of the model. Of frames after one another, one for each.
    pub eyes: Vec<Eye>,
    /// The frame whose rays are traced, where it is one of several, the first being 0: for what chooses anew for each.
    pub frame: Option<usize>,
}

impl Sight {
    /// What the rays of `source` see of a model at this quality.
    pub fn new(source: &dyn RaySource, space: &ModelSpace, delta: f64) -> Self {
        let eyes = source.eyes(space).into_iter().map(|eye| eye.in_units(space)).collect();
        Self { delta, least_radius: source.least_radius(space) / space.placement.scale, eyes, frame: None }
    }

    /// The same for the rays of one frame of several.
    #[must_use]
    pub fn of_frame(&self, frame: usize) -> Self {
        Self { frame: Some(frame), ..self.clone() }
    }

    /// The same for all frames.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self { frame: None, ..self.clone() }
    }

    /// A radius that no ray's cone falls below within this part of the model, in its units.
    pub fn least_radius_in(&self, lo: [f64; 3], hi: [f64; 3]) -> f64 {
        self.eyes.iter().map(|eye| eye.least_radius(lo, hi)).fold(f64::INFINITY, f64::min)
    }
}

impl RaySource for Camera {
    fn rays(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Tiles of 8 x 8 pixels, row by row from the top left.
    fn batches(&self) -> usize {
        self.width.div_ceil(TILE) as usize * self.height.div_ceil(TILE) as usize
    }

    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query)) {
        let columns = self.width.div_ceil(TILE) as usize;
        // Tiles of a picture of at most 2^16 columns and rows.
        let [left, top] = [batch % columns, batch / columns].map(|at| at as u32 * TILE);
        for y in top..self.height.min(top + TILE) {
            for x in left..self.width.min(left + TILE) {
                each(u64::from(y) * u64::from(self.width) + u64::from(x), &self.ray(x, y));
            }
        }
    }

    fn least_radius(&self, space: &ModelSpace) -> f64 {
        self.tan_theta * space.distance_to(self.eye.to_array())
    }

    fn eyes(&self, _: &ModelSpace) -> Vec<Eye> {
        vec![Eye::at(self.eye.to_array(), self.tan_theta).looking(self.view_cone())]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;
    use crate::rays::View;

    #[test]
    fn a_camera_gives_each_pixel_once_and_knows_how_near_the_model_is() {
        let space = ModelSpace {
            placement: Placement { offset: [1.0, 0.0, 0.0], scale: 0.5 },
            lo: [-10, -20, -30],
            hi: [10, 20, 30],
            zeros: [0; 2],
        };
        let view = View { eye: Some([1.0, 0.0, 115.0]), target: Some([1.0, 0.0, 0.0]), ..View::default() };
        let camera = Camera::new(&view, &space, 19, 13).unwrap();
        let mut seen = vec![0; 19 * 13];
        for batch in 0..camera.batches() {
            let mut rays = 0;
            camera.batch(batch, &mut |number, query| {
                seen[number as usize] += 1;
                assert_eq!(*query, camera.ray(number as u32 % 19, number as u32 / 19));
                rays += 1;
            });
            assert!((1..=64).contains(&rays));
        }
        assert_eq!((seen, camera.rays()), (vec![1; 19 * 13], 19 * 13));
        let sight = Sight::new(&camera, &space, 2.0);
        assert!((sight.least_radius - camera.tan_theta * 200.0).abs() < 1e-9, "{sight:?}");
        let inside = Camera::new(&View { eye: Some([2.0, 1.0, 3.0]), ..view }, &space, 4, 4).unwrap();
        assert_eq!(Sight::new(&inside, &space, 2.0).least_radius, 0.0);
    }

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

    #[test]
    fn a_camera_sees_nothing_outside_of_its_cone() {
        let space = ModelSpace { placement: Placement { offset: [0.0; 3], scale: 1.0 }, lo: [-10; 3], hi: [10; 3], zeros: [0; 2] };
        let view = View { eye: Some([0.0, 0.0, 50.0]), target: Some([0.0; 3]), ..View::default() };
        for camera in [Camera::new(&view, &space, 31, 9).unwrap(), Camera::new(&view, &space, 9, 31).unwrap()] {
            let cone = camera.view_cone();
            let apex = camera.eye.to_array();
            for pixel in 0..31 * 9 {
                let direction = camera.ray(pixel % camera.width, pixel / camera.width).direction;
                let point = std::array::from_fn(|k| apex[k] + 7.0 * direction[k]);
                assert!(!cone.misses(apex, point, 1e-9));
            }
            // A pixel at a corner lies on its side but for half a pixel.
            let corner = camera.ray(0, 0).direction;
            let along: f64 = (0..3).map(|k| corner[k] * cone.axis[k]).sum();
            assert!((along.powi(-2) - 1.0).sqrt() > 0.85 * cone.tangent);
            assert!(cone.misses(apex, [0.0, 0.0, 60.0], 9.9) && !cone.misses(apex, [0.0, 0.0, 60.0], 10.1));
            assert!(cone.misses(apex, [1000.0, 0.0, 49.0], 10.0));
        }
    }
}
