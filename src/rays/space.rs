//! From world to the model's integers, once per ray (paper section 4.1).

use super::{Query, cone};
use crate::format::Scene;
use crate::mesh::Placement;
use crate::num::{BOX_MARGIN, DIRECTION_SCALE, Direction, Point, Ray, RayT, START_BITS, Start, U, Vec3};

/// Where a model lies, and the box of all its vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelSpace {
    /// Model space to world.
    pub placement: Placement,
    /// Lower corner of all full-resolution vertices, in units.
    pub lo: [i32; 3],
    /// Upper corner.
    pub hi: [i32; 3],
    /// Zero bits at the bottom of the coordinates of origins, and of components of directions.
    pub zeros: [u32; 2],
}

/// A ray as the hardware takes it, and how to get back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelRay {
    /// The integer ray.
    pub ray: Ray,
    /// Distance in world units from the world ray's origin to the integer ray's.
    pub start: f64,
    /// World length of one step of t.
    pub step: f64,
    /// First and last step of t that count.
    pub range: [RayT; 2],
}

impl ModelRay {
    /// World distance of a hit at `t`.
    pub fn distance(&self, t: u64) -> f64 {
        self.start + self.step * t as f64
    }
}

impl ModelSpace {
    /// The space of a scene.
    pub fn of(scene: &Scene) -> Self {
        let meta = scene.meta();
        Self { placement: meta.placement, lo: meta.lo, hi: meta.hi, zeros: [meta.coordinate_zeros, meta.direction_zeros] }
    }

    /// Centre of the box in world space.
    pub fn centre(&self) -> [f64; 3] {
        std::array::from_fn(|k| self.placement.offset[k] + self.placement.scale * 0.5 * (f64::from(self.lo[k]) + f64::from(self.hi[k])))
    }

    /// Half the diagonal of the box in world space.
    pub fn radius(&self) -> f64 {
        let sides: [f64; 3] = std::array::from_fn(|k| f64::from(self.hi[k]) - f64::from(self.lo[k]));
        0.5 * self.placement.scale * sides.iter().map(|s| s * s).sum::<f64>().sqrt()
    }

    /// Units by which the model's box is enlarged: a step of origins at least.
    fn margin(&self) -> f64 {
        f64::from(BOX_MARGIN.max(1 << self.zeros[0]))
    }

    /// Corners, in units, of the box outside which [`Self::enter`] finds nothing.
    pub fn enlarged(&self) -> [[f64; 3]; 8] {
        let margin = self.margin();
        let side = |k: usize, upper| if upper { f64::from(self.hi[k]) + margin } else { f64::from(self.lo[k]) - margin };
        std::array::from_fn(|corner| std::array::from_fn(|k| side(k, corner >> k & 1 == 1)))
    }

    /// Where a ray starts, in world space.
    pub fn start(&self, start: &Start) -> [f64; 3] {
        let (whole, step) = (start.point.get(), 2f64.powi(-(START_BITS as i32)));
        std::array::from_fn(|k| {
            let units = whole[k] as f64 + start.fraction[k].get() as f64 * step;
            self.placement.offset[k] + self.placement.scale * units
        })
    }

    /// The coarser of the steps of origins and of directions over the model, in world units.
    pub fn step(&self) -> f64 {
        self.placement.scale * f64::from(1u32 << self.zeros[0].max(self.zeros[1]))
    }

    /// A world position in units, not rounded.
    pub fn to_units(&self, p: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|k| (p[k] - self.placement.offset[k]) / self.placement.scale)
    }

    /// Distance from a world position to the model's box, in world units; 0 inside.
    pub fn distance_to(&self, p: [f64; 3]) -> f64 {
        self.distance_between(p, p)
    }

    /// Distance from the box of these corners to the model's; 0 if they meet.
    pub fn distance_between(&self, lo: [f64; 3], hi: [f64; 3]) -> f64 {
        let (lo, hi) = (self.to_units(lo), self.to_units(hi));
        let beside: [f64; 3] = std::array::from_fn(|k| (f64::from(self.lo[k]) - hi[k]).max(lo[k] - f64::from(self.hi[k])).max(0.0));
        self.placement.scale * beside.iter().map(|d| d * d).sum::<f64>().sqrt()
    }

    /// Moves `world` to the model's enlarged box and rounds it; `None` if it misses that box, ends before it, has no direction or is not finite.
    pub fn enter(&self, world: &Query, delta: f64) -> Option<ModelRay> {
        let direction = unit(world.direction)?;
        let origin = self.to_units(world.origin);
        if !origin.iter().all(|c| c.is_finite()) {
            return None;
        }
        let margin = self.margin();
        let lo = self.lo.map(|v| f64::from(v) - margin);
        let hi = self.hi.map(|v| f64::from(v) + margin);

        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for k in 0..3 {
            if direction[k] == 0.0 {
                if origin[k] < lo[k] || origin[k] > hi[k] {
                    return None;
                }
            } else {
                let (a, b) = ((lo[k] - origin[k]) / direction[k], (hi[k] - origin[k]) / direction[k]);
                near = near.max(a.min(b));
                far = far.min(a.max(b));
            }
        }
        if near > far {
            return None;
        }

        let (d, length) = self.rounded(direction);
        // Clamping keeps the point in the enlarged box, hence in 32 bits.
        let x: [i64; 3] =
            std::array::from_fn(|k| to_step((origin[k] + near * direction[k]).clamp(lo[k], hi[k]), self.zeros[0], f64::from(i32::MAX)));
        let radius = world.radius / self.placement.scale + near * world.tan_theta;
        let ray = Ray { origin: Point::new(x[0], x[1], x[2]), direction: d, cone: cone(delta, radius, world.tan_theta) };
        self.ranged(world, ray, near * self.placement.scale, length)
    }

    /// The same for a ray that leaves the model's surface at `start`, if there is one: it starts there, whatever the query's origin; `None` if it ends before, or has no direction.
    pub fn enter_from(&self, world: &Query, start: Option<&Start>, delta: f64) -> Option<ModelRay> {
        let Some(start) = start else { return self.enter(world, delta) };
        let (direction, length) = self.rounded(unit(world.direction)?);
        let cone = cone(delta, world.radius / self.placement.scale, world.tan_theta);
        self.ranged(world, Ray { origin: start.point, direction, cone }, 0.0, length)
    }

    /// A direction of length 1 as rays have it, and its length then.
    fn rounded(&self, direction: [f64; 3]) -> (Direction, f64) {
        let d = direction.map(|c| to_step(c * f64::from(DIRECTION_SCALE), self.zeros[1], f64::from(DIRECTION_SCALE)));
        (Vec3::new(d[0], d[1], d[2]), d.iter().map(|&c| (c as f64) * (c as f64)).sum::<f64>().sqrt())
    }

    /// With the steps of t that count; the ray starts `start` from the query's origin, its direction has this length.
    fn ranged(&self, world: &Query, ray: Ray, start: f64, length: f64) -> Option<ModelRay> {
        let step = length * self.placement.scale / 2f64.powi(32);
        let range = [steps_from(world.t_min, start, step), steps_to(world.t_max, start, step)?];
        Some(ModelRay { ray, start, step, range })
    }

    /// A direction in the world as rays have it; `None` for zero and for anything not finite.
    pub fn direction(&self, world: [f64; 3]) -> Option<Direction> {
        Some(self.rounded(unit(world)?).0)
    }
}

/// The nearest multiple of 2^`zeros` that is at most `most` in magnitude.
fn to_step(v: f64, zeros: u32, most: f64) -> i64 {
    let step = f64::from(1u32 << zeros);
    let last = (most / step).floor();
    ((v / step).round().clamp(-last, last) as i64) << zeros // at most 31 bits
}

/// The first step of t that is not nearer than `t`: rounded up; 0 for what lies before the ray's start, and for what is no number.
fn steps_from(t: f64, start: f64, step: f64) -> RayT {
    // f64 to u64 casts truncate and saturate, as does the width of t.
    U::saturating(((t - start) / step).ceil().max(0.0) as u64)
}

/// The last step of t that is not farther than `t`: rounded down; `None` before the ray's start, the last of all for what is no number.
fn steps_to(t: f64, start: f64, step: f64) -> Option<RayT> {
    let steps = ((t - start) / step).floor();
    if steps.is_nan() {
        return Some(RayT::MAX);
    }
    (steps >= 0.0).then(|| U::saturating(steps as u64))
}

/// `v` at length 1; `None` for zero and for anything not finite.
fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let largest = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if !(largest > 0.0 && largest.is_finite() && v.iter().all(|c| c.is_finite())) {
        return None;
    }
    // Scaled first, so that squares neither overflow nor vanish.
    let v = v.map(|c| c / largest);
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    Some(v.map(|c| c / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn space() -> ModelSpace {
        ModelSpace {
            placement: Placement { offset: [10.0, 0.0, 0.0], scale: 0.5 },
            lo: [-1600, -1600, -1600],
            hi: [1600, 1600, 1600],
            zeros: [0; 2],
        }
    }

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Query {
        Query::new(origin, direction).with_cone(1.0, 0.25)
    }

    #[test]
    fn a_ray_from_outside_starts_on_the_enlarged_box() {
        let m = space().enter(&ray([10.0, 0.0, 5000.0], [0.0, 0.0, -3.0]), 2.0).unwrap();
        assert_eq!(m.ray.origin.get(), [0, 0, 1664]);
        assert_eq!(m.ray.direction.get(), [0, 0, -((1 << 30) - 1)]);
        assert_eq!(m.start, (10000.0 - 1664.0) * 0.5);
        // Radius 2 units at the origin, plus a quarter of the way.
        let wanted = 2.0 + (10000.0 - 1664.0) * 0.25;
        assert_eq!(m.ray.cone.offset.get() as f64 / 2f64.powi(m.ray.cone.shift.get() as i32), wanted);
        // One step of t is 2^-32 of the direction's length.
        assert!((m.distance(1 << 34) - (m.start + 4.0 * ((1 << 30) - 1) as f64 * 0.5)).abs() < 1e-3);
    }

    #[test]
    fn a_ray_from_inside_stays_and_others_miss() {
        let inside = space().enter(&ray([10.0, 1.0, 1.4], [1.0, 1.0, 0.0]), 1.0).unwrap();
        assert_eq!((inside.ray.origin.get(), inside.start), ([0, 2, 3], 0.0));
        assert!(space().enter(&ray([10.0, 0.0, 5000.0], [0.0, 0.0, 1.0]), 1.0).is_none());
        assert!(space().enter(&ray([5000.0, 0.0, 5000.0], [0.0, 0.0, -1.0]), 1.0).is_none());
        assert!(space().enter(&ray([10.0, 0.0, 5000.0], [0.0; 3]), 1.0).is_none());
        assert!(space().enter(&ray([f64::NAN, 0.0, 5000.0], [0.0, 0.0, -1.0]), 1.0).is_none());
    }

    #[test]
    fn what_counts_is_rounded_inwards() {
        let query = |t_min, t_max| ray([10.0, 0.0, 5000.0], [0.0, 0.0, -3.0]).between(t_min, t_max);
        let enter = |t_min, t_max| space().enter(&query(t_min, t_max), 1.0).map(|m| (m.range.map(U::get), m));
        let ([first, last], m) = enter(0.0, f64::INFINITY).unwrap();
        assert_eq!([first, last], [0, RayT::MAX.get()]);
        // A step and a half beyond the start.
        let t = m.start + 1.5 * m.step;
        assert!(m.distance(2) >= t && m.distance(1) <= t);
        assert_eq!(enter(t, f64::INFINITY).unwrap().0, [2, RayT::MAX.get()]);
        assert_eq!(enter(-1.0, m.start + 1000.5 * m.step).unwrap().0, [0, 1000]);
        assert_eq!(enter(f64::NAN, f64::NAN).unwrap().0, [0, RayT::MAX.get()]);
        assert!(enter(0.0, m.start - 1.0).is_none(), "it ends before the model");
        assert_eq!(enter(1e300, f64::INFINITY).unwrap().0[0], RayT::MAX.get());
    }

    #[test]
    fn starts_are_where_they_are_in_the_world() {
        let start = Start { point: Point::new(4, -3, 0), fraction: [U::new(1 << 30), U::ZERO, U::new(1)] };
        assert_eq!(space().start(&start), [12.25, -1.5, 0.5f64.powi(32)]);
        assert_eq!((space().step(), ModelSpace { zeros: [3, 1], ..space() }.step()), (0.5, 4.0));
    }

    #[test]
    fn distances_are_those_to_the_box() {
        assert_eq!(space().distance_to([10.0, 0.0, 5000.0]), 5000.0 - 800.0);
        assert_eq!(space().distance_to([10.0 - 803.0, 0.0, 804.0]), 5.0);
        assert_eq!(space().distance_to([11.0, 5.0, -700.0]), 0.0);
    }
}
