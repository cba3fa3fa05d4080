//! Random numbers and directions of paths.

use crate::num::Random;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// From 0 to 1, which it never is.
pub(super) fn share(random: &mut Random) -> f64 {
    (random.next() >> 11) as f64 / (1u64 << 53) as f64
}

/// Two vectors that stand upright on a unit vector and on each other (Duff et al. 2017).
pub(super) fn basis(n: DVec3) -> [DVec3; 2] {
    let sign = 1f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    [DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), DVec3::new(b, sign + n.y * n.y * a, -n.y)]
}

/// A direction to the side of `n`, as likely as its cosine.
pub(super) fn cosine_direction(n: DVec3, random: &mut Random) -> DVec3 {
    let (r, angle) = (share(random).sqrt(), TAU * share(random));
    let [x, y] = basis(n);
    (x * (r * angle.cos()) + y * (r * angle.sin()) + n * (1.0 - r * r).max(0.0).sqrt()).normalize()
}

/// How likely, per solid angle, such a direction is.
pub(super) fn cosine_pdf(cosine: f64) -> f64 {
    cosine.max(0.0) / PI
}

/// A direction within a cone about `axis` whose half angle has this cosine, all as likely.
pub(super) fn cone_direction(axis: DVec3, least: f64, random: &mut Random) -> DVec3 {
    let cosine = 1.0 - share(random) * (1.0 - least);
    let (sine, angle) = ((1.0 - cosine * cosine).max(0.0).sqrt(), TAU * share(random));
    let [x, y] = basis(axis);
    (x * (sine * angle.cos()) + y * (sine * angle.sin()) + axis * cosine).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_of_length_one_and_where_they_should_be() {
        let mut random = Random::new(7);
        for _ in 0..2_000 {
            let n = DVec3::new(random.signed(), random.signed(), random.signed()).normalize();
            let [x, y] = basis(n);
            assert!(x.dot(y).abs() < 1e-12 && x.dot(n).abs() < 1e-12 && y.dot(n).abs() < 1e-12 && x.cross(y).dot(n) > 0.999);
            let d = cosine_direction(n, &mut random);
            assert!((d.length() - 1.0).abs() < 1e-12 && d.dot(n) > -1e-12);
            let c = cone_direction(n, 0.9, &mut random);
            assert!(c.dot(n) >= 0.9 - 1e-12 && (c.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_mean_cosine_is_two_thirds() {
        let mut random = Random::new(8);
        let n = DVec3::new(0.6, 0.0, -0.8);
        let mean = (0..100_000).map(|_| cosine_direction(n, &mut random).dot(n)).sum::<f64>() / 100_000.0;
        assert!((mean - 2.0 / 3.0).abs() < 3e-3, "{mean}");
    }
}
