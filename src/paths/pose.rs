//! Where a model stands in a scene: any affine map that has an inverse.

use crate::rays::Query;
use glam::{DMat3, DVec3, EulerRot};

/// Where a model is put: turned, stretched, mirrored, moved. Written as `scale * turn`, the scale being the largest stretch of any direction, so that `turn` stretches none.
///
/// A cone's radius is divided by that largest stretch: what a model tolerates is then no more in the scene than the cone there, whatever direction it lies in. Where the stretch
/// is the same in all directions nothing is lost; else a model is finer than it need be by as much as stretches differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    turn: DMat3,
    /// Of `turn`; its transpose if that only turns.
    inverse: DMat3,
    scale: f64,
    translate: DVec3,
    /// The most by which `inverse` stretches a direction: 1 if the model is only turned, scaled and moved.
    squeezed: f64,
}

/// How much more a pose may stretch one direction than another.
pub const MOST_STRETCH: f64 = 1e6;

/// A matrix that is no pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("must have an inverse, and stretch no direction more than a million times as much as another")]
pub struct NoPose;

impl Pose {
    /// Turned by so many degrees about x, then y, then z; scaled, above 0; moved.
    pub fn new(degrees: [f64; 3], scale: f64, translate: [f64; 3]) -> Self {
        let [x, y, z] = degrees.map(f64::to_radians);
        let turn = DMat3::from_euler(EulerRot::ZYX, z, y, x);
        Self { turn, inverse: turn.transpose(), scale, translate: DVec3::from_array(translate), squeezed: 1.0 }
    }

    /// By three rows of a matrix, the last column being where the origin goes.
    ///
    /// # Errors
    /// It has no inverse, or one too large.
    pub fn affine(rows: [[f64; 4]; 3]) -> Result<Self, NoPose> {
        let linear = DMat3::from_cols_array_2d(&[0, 1, 2].map(|column: usize| [0, 1, 2].map(|row: usize| rows[row][column])));
        let translate = DVec3::from_array(rows.map(|row| row[3]));
        let scale = stretch(linear);
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(NoPose);
        }
        let turn = linear * scale.recip();
        let inverse = turn.inverse();
        let squeezed = stretch(inverse);
        // Not a number where there is no inverse.
        if squeezed <= MOST_STRETCH { Ok(Self { turn, inverse, scale, translate, squeezed }) } else { Err(NoPose) }
    }

    /// Turned by a rotation, scaled, moved.
    pub(super) fn turned(turn: DMat3, scale: f64, translate: [f64; 3]) -> Self {
        Self { turn, inverse: turn.transpose(), scale, translate: DVec3::from_array(translate), squeezed: 1.0 }
    }

    /// Where the model's origin stands.
    pub(super) fn origin(&self) -> DVec3 {
        self.translate
    }

    /// The same, behind this turned and scaled about `at` and moved as `copy` says, which only turns, scales and moves.
    #[must_use]
    pub(super) fn about(&self, at: DVec3, copy: &Self) -> Self {
        let (turn, inverse) = (copy.turn * self.turn, self.inverse * copy.inverse);
        let translate = copy.turn * (self.translate - at) * copy.scale + at + copy.translate;
        Self { turn, inverse, scale: self.scale * copy.scale, translate, squeezed: self.squeezed }
    }

    /// The model is only turned, scaled and moved.
    fn is_rigid(&self) -> bool {
        self.squeezed == 1.0
    }

    /// The largest stretch of any direction.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The most by which a direction of length 1 grows on its way to the model, apart from the scale; at least 1.
    pub(super) fn squeezed(&self) -> f64 {
        self.squeezed
    }

    /// A place of the scene in the model's own world.
    pub(super) fn place(&self, p: DVec3) -> DVec3 {
        self.inverse * ((p - self.translate) / self.scale)
    }

    /// A direction, but for the scale.
    pub(super) fn direction(&self, d: DVec3) -> DVec3 {
        self.inverse * d
    }

    /// Length in the model of a step of length 1 in the scene along `direction`, which [`Self::direction`] gave, times the scale.
    pub(super) fn pace(&self, direction: DVec3) -> f64 {
        if self.is_rigid() { 1.0 } else { direction.length() }
    }

    /// A ray of the scene, its direction of length 1, as the model has it; and how long in the scene a step of its t is.
    pub fn enter(&self, ray: &Query) -> (Query, f64) {
        let direction = self.direction(DVec3::from_array(ray.direction));
        // Of the scene's lengths along the ray and across, how long they are in the model.
        let pace = self.pace(direction);
        let scale = self.scale / pace;
        let own = Query::new(self.place(DVec3::from_array(ray.origin)).to_array(), direction.to_array())
            .with_cone(ray.radius / self.scale, ray.tan_theta / pace)
            .between(ray.t_min / scale, ray.t_max / scale);
        (Query { any: ray.any, ..own }, scale)
    }

    /// A place of the model in the scene.
    pub fn out(&self, p: DVec3) -> DVec3 {
        self.turn * p * self.scale + self.translate
    }

    /// A way of the model in the scene, but for the scale.
    pub fn way(&self, d: DVec3) -> DVec3 {
        self.turn * d
    }

    /// Turns areas along normals, of the model's own world, into those of the scene; as they point out of it, also where it is mirrored. None if it is not turned, scaled or stretched.
    pub(super) fn outward(&self) -> Option<DMat3> {
        let is_plain = self.scale == 1.0 && self.turn == DMat3::IDENTITY;
        // The matrix of cofactors but for the sign of the determinant.
        (!is_plain).then(|| self.inverse.transpose() * (self.turn.determinant().abs() * self.scale * self.scale))
    }

    /// A normal of the model in the scene.
    pub(super) fn normal(&self, n: DVec3) -> DVec3 {
        if self.is_rigid() { self.turn * n } else { (self.inverse.transpose() * n).normalize_or_zero() }
    }
}

/// The largest stretch of any direction: the root of the largest eigenvalue of M^T M, with a little more for its rounding.
fn stretch(m: DMat3) -> f64 {
    // Scaled first, so that squares neither overflow nor vanish.
    let largest = m.to_cols_array().into_iter().fold(0.0f64, |most, v| most.max(v.abs()));
    if !(largest > 0.0 && largest.is_finite()) {
        return f64::NAN;
    }
    let m = m * largest.recip();
    // Jacobi's rotations: exact up to rounding for three by three after few sweeps.
    let mut s = (m.transpose() * m).to_cols_array_2d();
    for _ in 0..32 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if s[p][q] == 0.0 {
                continue;
            }
            let theta = (s[q][q] - s[p][p]) / (2.0 * s[p][q]);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = t.hypot(1.0).recip();
            let sine = t * c;
            for row in &mut s {
                (row[p], row[q]) = (c * row[p] - sine * row[q], sine * row[p] + c * row[q]);
            }
            let (of_p, of_q) = (s[p], s[q]);
            for k in 0..3 {
                (s[p][k], s[q][k]) = (c * of_p[k] - sine * of_q[k], sine * of_p[k] + c * of_q[k]);
            }
        }
    }
    let most = s[0][0].max(s[1][1]).max(s[2][2]).max(0.0).sqrt() * largest;
    if m.is_finite() { most * (1.0 + 1e-14) } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    fn vector(random: &mut Random) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| random.within(1 << 20) as f64 / f64::from(1 << 20)))
    }

    fn rows(random: &mut Random) -> [[f64; 4]; 3] {
        [(); 3].map(|()| [(); 4].map(|()| random.within(1 << 20) as f64 / f64::from(1 << 18)))
    }

    #[test]
    fn poses_take_places_there_and_back_and_no_direction_is_stretched_more_than_they_say() {
        let (mut poses, mut worst) = (0, 1.0f64);
        for number in 0..2000 {
            let mut random = Random::of(4, number);
            let Ok(pose) = Pose::affine(rows(&mut random)) else { continue };
            poses += 1;
            for _ in 0..20 {
                let (p, d) = (vector(&mut random) * 10.0, vector(&mut random).normalize_or(DVec3::X));
                let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-9 * pose.squeezed() * (1.0 + p.length());
                assert!(near(pose.out(pose.place(p)), p), "{pose:?}");
                let own = pose.direction(d);
                assert!(near(pose.way(own), d));
                let (pace, along) = (pose.pace(own), pose.way(d).length());
                assert!(pace <= pose.squeezed() * (1.0 + 1e-9) && pace >= 1.0 - 1e-9 && along <= 1.0 + 1e-9, "{pose:?}: {pace}, {along}");
                worst = worst.min(pose.squeezed() / pace);
                // A plane's normal stays its normal.
                let n = vector(&mut random).normalize_or(DVec3::Y);
                let tangent = n.any_orthonormal_vector();
                assert!(pose.normal(n).dot(pose.way(tangent)).abs() < 1e-9 * pose.squeezed());
            }
        }
        assert!(poses > 1900 && worst < 1.2, "{poses}, {worst}");
    }

    #[test]
    fn matrices_that_only_turn_are_the_poses_of_their_angles() {
        let pose = Pose::new([10.0, 20.0, 30.0], 0.7, [1.0, 2.0, 3.0]);
        let p = DVec3::new(0.3, -2.0, 5.0);
        let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| pose.out(axis) - pose.out(DVec3::ZERO));
        let origin = pose.out(DVec3::ZERO);
        let same = Pose::affine([0, 1, 2].map(|k: usize| [columns[0][k], columns[1][k], columns[2][k], origin[k]])).unwrap();
        assert!((same.scale() - 0.7).abs() < 1e-12 && same.squeezed() < 1.0 + 1e-12);
        assert!((same.place(p) - pose.place(p)).length() < 1e-12 && (same.normal(p) - pose.normal(p).normalize()).length() < 1e-12);
        let at = DVec3::new(2.0, 0.0, -1.0);
        let copy = Pose::turned(DMat3::from_rotation_z(1.5), 2.0, [0.0, 0.0, 1.0]);
        let twice = pose.about(at, &copy);
        let wanted = DMat3::from_rotation_z(1.5) * (pose.out(p) - at) * 2.0 + at + DVec3::Z;
        assert!((twice.out(p) - wanted).length() < 1e-12 && (twice.place(wanted) - p).length() < 1e-12 && twice.is_rigid());
    }

    #[test]
    fn what_has_no_inverse_is_refused() {
        let row = |k: usize, v: f64| {
            let mut row = [0.0; 4];
            row[k] = v;
            row
        };
        for (bad, is_bad) in [
            ([row(0, 1.0), row(1, 1.0), row(2, 0.0)], true),
            ([row(0, 1.0), row(0, 1.0), row(2, 1.0)], true),
            ([row(0, 1.0), row(1, 1.0), row(2, 1e-7)], true),
            ([row(0, f64::NAN), row(1, 1.0), row(2, 1.0)], true),
            ([row(0, 1e300), row(1, 1e300), row(2, 1e300)], false),
            ([row(0, 1.0), row(1, -1.0), row(2, 1e-5)], false),
        ] {
            assert_eq!(Pose::affine(bad).is_err(), is_bad, "{bad:?}");
        }
    }
}
