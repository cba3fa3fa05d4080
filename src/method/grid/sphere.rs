//! Rays against the spheres of a node's four children (paper section 2.1, equations 1 and 2, and section 2.2).
//!
//! A sphere around (a + b + c) / 3 holds all vertices below its triangle. Its radius is stored rounded up ([`radius_up`]), and the test lets it out by [`SLACK`] units, so no
//! rounding of `f64` loses a hit. With S = a + b + c, o the ray's whole origin and d its direction, L = S - 3 o is exact: below 2^33.6 in each component. A component of L x d is two
//! products below 2^63.6 and their difference: off by at most 2^12.6, the vector by 2^13.4. The distance of the centre from the line, |L x d| / (3 |d|), is off by at most 2^-17 units,
//! as |d| > 2^29, and what follows changes it by a share below 2^-49. A hit at t on a vertex's triangle below lies in the sphere, as spheres are convex; a start on a surface
//! lies off the whole origin by less than sqrt(3) units, and so does what it meets off the point at t of the ray that is tested. So that point is within r + sqrt(3) of the centre, and
//! the computed distance is below r + 3 for every r that coordinates allow: the sphere is met. Half of the chord is then computed longer than that of the sphere of r + sqrt(3) by
//! a third of a unit at least, which is 2^-32 in t, far above what rounding does to the chord's middle: t0 is not above any t of a hit, and t1 not below it.
//!
//! This is the decision of the model. What it costs in hardware is stated in floats of 32 bits, as the paper has it ([`super::works`]).

use crate::num::{Direction, Point, RayT};

/// Units by which the test lets spheres out.
pub const SLACK: f64 = 3.0;

/// The least `f32` that is not below `v`.
pub fn radius_up(v: f64) -> f32 {
    let nearest = v as f32;
    if f64::from(nearest) < v { nearest.next_up() } else { nearest }
}

/// Radius of the least sphere around a third of `sum` that holds the points, rounded up.
pub fn radius(sum: [i64; 3], points: impl Iterator<Item = [i32; 3]>) -> f32 {
    let squared = |p: [i32; 3]| {
        // Exact: below 2^35.
        let d: [f64; 3] = std::array::from_fn(|k| (3 * i64::from(p[k]) - sum[k]) as f64);
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    };
    let most = points.map(squared).fold(0.0, f64::max);
    // Three products, two sums, a root and a quotient: a share below 2^-50.
    radius_up(most.sqrt() / 3.0 * (1.0 + 2f64.powi(-49)))
}

/// A ray as spheres are tested against it.
#[derive(Clone, Copy, Debug)]
pub struct SphereRay {
    /// Three times the whole origin.
    origin: [f64; 3],
    direction: [f64; 3],
    /// 1 / (9 |d|^2), 1 / (3 |d|^2) and 1 / |d|.
    scales: [f64; 3],
}

/// Four spheres, one a lane: a coordinate of each sum of corners, and the radii.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spheres {
    /// a + b + c, by axis.
    pub sums: [[f64; 4]; 3],
    /// Radii.
    pub radii: [f32; 4],
}

/// Which of four are met, and from where on in t.
#[derive(Clone, Copy, Debug, Default)]
pub struct Met {
    /// The ray meets it, ahead of its start and no farther than the closest hit.
    pub hit: [bool; 4],
    /// A t that no hit in it lies before.
    pub near: [f64; 4],
}

/// A t in steps of 2^-32. The last stands for all beyond it too: hits there have it.
#[inline(always)]
pub fn in_t(t: RayT) -> f64 {
    if t == RayT::MAX { f64::INFINITY } else { t.get() as f64 * 2f64.powi(-32) }
}

impl SphereRay {
    /// A ray with this whole origin and a direction of length above 2^29.
    #[inline(always)]
    pub fn new(origin: Point, direction: Direction) -> Self {
        let (origin, direction) = (origin.get().map(|c| 3.0 * c as f64), direction.get().map(|c| c as f64));
        let squared = direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
        Self { origin, direction, scales: [1.0 / (9.0 * squared), 1.0 / (3.0 * squared), 1.0 / squared.sqrt()] }
    }

    /// Tests four spheres.
    #[inline(always)]
    pub fn test(&self, t_max: RayT, spheres: &Spheres) -> Met {
        let [dx, dy, dz] = self.direction;
        let t_max = in_t(t_max);
        let mut met = Met::default();
        for k in 0..4 {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| spheres.sums[axis][k] - self.origin[axis]);
            let (cx, cy, cz) = (y * dz - z * dy, z * dx - x * dz, x * dy - y * dx);
            let apart = (cx * cx + cy * cy + cz * cz) * self.scales[0];
            let radius = f64::from(spheres.radii[k]) + SLACK;
            let chord = radius * radius - apart;
            let half = chord.max(0.0).sqrt() * self.scales[2];
            let middle = (x * dx + y * dy + z * dz) * self.scales[1];
            met.near[k] = middle - half;
            met.hit[k] = (chord >= 0.0) & (middle + half >= 0.0) & (met.near[k] <= t_max);
        }
        met
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMIT: i32 = crate::num::COORD_LIMIT;

    fn coordinates() -> impl Strategy<Value = [i32; 3]> {
        prop::array::uniform3(-LIMIT..=LIMIT)
    }

    /// A direction of length close to 2^30, and some that are axes.
    fn direction(d: [f64; 3], axis: usize) -> Direction {
        let mut d = if axis < 3 { [0.0; 3] } else { d };
        if let Some(c) = d.get_mut(axis) {
            *c = 1.0;
        }
        let length = d.iter().map(|c| c * c).sum::<f64>().sqrt().max(1e-3);
        let [x, y, z] = d.map(|c| (c / length * f64::from((1 << 30) - 1)) as i64);
        Direction::new(x, y, z)
    }

    #[test]
    fn radius_up_is_never_below_and_next_to() {
        for v in [0.0, 1.0, 16_777_217.0, 0.1, 3e9, 1e-40] {
            let r = radius_up(v);
            assert!(f64::from(r) >= v && (r == 0.0 || f64::from(r.next_down()) < v), "{v}");
        }
    }

    #[test]
    fn spheres_beyond_the_last_t_are_met() {
        let ray = SphereRay::new(Point::new(-(1 << 31) + 1, 0, 0), Direction::new((1 << 29) + 1, 0, 0));
        let spheres = |x: i64| Spheres { sums: [[3.0 * x as f64; 4], [0.0; 4], [0.0; 4]], radii: [8.0; 4] };
        let found = |x, t_max| ray.test(t_max, &spheres(x)).hit[0];
        // t is 7.999 and 8.001.
        let [near, far] = [7.999, 8.001].map(|t| (t * f64::from(1 << 29)) as i64 - (1 << 31));
        assert!(found(near, RayT::MAX) && found(far, RayT::MAX));
        assert!(found(near, RayT::new(RayT::MAX.get() - 1)) && !found(far, RayT::new(RayT::MAX.get() - 1)));
    }

    proptest! {
        // Origins that no ray has are left out: a quarter of those drawn.
        #![proptest_config(ProptestConfig { max_global_rejects: 65_536, ..ProptestConfig::with_cases(4096) })]

        /// Against whole numbers: 3 r is not below the length of 3 p - S.
        #[test]
        fn radii_hold_all_points(a in coordinates(), b in coordinates(), c in coordinates(), bits in 0u32..31) {
            let p = [a, b, c].map(|p| p.map(|v| v >> bits));
            let sum = std::array::from_fn(|k| p.iter().map(|p| i64::from(p[k])).sum());
            let r = radius(sum, p.into_iter());
            let most = p.iter().map(|p| (0..3).map(|k| (3 * i128::from(p[k]) - i128::from(sum[k])).pow(2)).sum::<i128>()).max().unwrap();
            // r is an f32: 3 r and its square in whole numbers, where it is one of at least 2^23.
            if r >= 16_777_216.0 {
                prop_assert!((3 * r as i128).pow(2) >= most);
            } else {
                prop_assert!((3.0 * f64::from(r)).powi(2) * (1.0 + 1e-15) >= most as f64);
            }
            prop_assert!(9.0 * f64::from(r).powi(2) <= (most as f64) * 1.000_001 + 1e-6);
        }

        /// A ray that passes within what a start's fraction moves it of a point of the sphere meets the sphere, around the t of that point.
        #[test]
        fn no_rounding_loses_a_hit(
            a in coordinates(), b in coordinates(), c in coordinates(), bits in 0u32..31, d in prop::array::uniform3(-1.0f64..=1.0), axis in 0usize..5,
            t in 0.0f64..1.9, corner in 0usize..3, mix in 0.0f64..=1.0,
        ) {
            let middle = a;
            let p = [a, b, c].map(|p| std::array::from_fn::<i32, 3, _>(|k| {
                let from = i64::from(p[k]) - i64::from(middle[k]);
                (i64::from(middle[k]) + (from >> bits)) as i32
            }));
            let sum: [i64; 3] = std::array::from_fn(|k| p.iter().map(|p| i64::from(p[k])).sum());
            let r = radius(sum, p.into_iter());
            let direction = direction(d, axis);
            // On an edge of the triangle, or a corner of it.
            let mix = if mix < 0.5 { 0.0 } else { mix };
            let (from, to) = (p[corner], p[(corner + 1) % 3]);
            let met: [f64; 3] = std::array::from_fn(|k| f64::from(from[k]) * (1.0 - mix) + f64::from(to[k]) * mix);
            // The whole origin, so that the exact ray meets the point at t.
            let exact: [f64; 3] = std::array::from_fn(|k| met[k] - t * direction.get()[k] as f64);
            let origin = exact.map(f64::floor);
            prop_assume!(origin.iter().all(|c| c.abs() < 2f64.powi(31)));
            let origin = origin.map(|c| c as i64);
            let ray = SphereRay::new(Point::new(origin[0], origin[1], origin[2]), direction);
            let spheres = Spheres { sums: sum.map(|c| [c as f64; 4]), radii: [r; 4] };
            let steps = (t * 2f64.powi(32)).floor();
            for t_max in [RayT::MAX, RayT::new(steps as u64)] {
                let found = ray.test(t_max, &spheres);
                prop_assert!(found.hit == [true; 4] && found.near.iter().all(|&near| near <= t), "{found:?} {t} {r}");
            }
        }
    }
}
