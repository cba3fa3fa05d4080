//! Views around a model: which way is up, and angles about that.

use super::View;
use glam::DVec3;

impl View {
    /// Looks at the target from `yaw` degrees around the up axis and `pitch` degrees above. Yaw 0 is the front: with +y up the eye is on the side of +z, and
    /// comes to +x at 90; other up axes turn all of that along.
    #[must_use]
    pub fn around(self, yaw: f64, pitch: f64) -> Self {
        let up = self.up.map(DVec3::from_array);
        let ((sy, cy), (sp, cp)) = (sin_cos(yaw), sin_cos(pitch));
        let direction = turned(up, DVec3::new(cp * sy, sp, cp * cy));
        // What is up in the picture, also where it looks straight down.
        let above = turned(up, DVec3::new(-sp * sy, cp, -sp * cy));
        // Adding 0 turns -0 into 0.
        let plain = |v: DVec3| Some((v + 0.0).to_array());
        Self { eye: None, direction: plain(direction), up: plain(above), ..self }
    }
}

/// Sine and cosine of an angle in degrees, exact at right angles.
fn sin_cos(degrees: f64) -> (f64, f64) {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let exact = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
    (exact(sine), exact(cosine))
}

/// `v`, given for +y up, for another up: by the shortest turn (+z up leaves +x where it is and has its front at -y); where up points down, after half a turn
/// about z.
pub(super) fn turned(up: Option<DVec3>, v: DVec3) -> DVec3 {
    let Some(up) = up.and_then(DVec3::try_normalize) else { return v };
    let (from, v) = if up.y < 0.0 { (DVec3::NEG_Y, DVec3::new(-v.x, -v.y, v.z)) } else { (DVec3::Y, v) };
    let axis = from.cross(up);
    // At most a right angle: the divisor is 1 or more. Exact for the axes.
    v + axis.cross(v) + axis.cross(axis.cross(v)) / (1.0 + from.dot(up))
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPS: [[f64; 3]; 9] = [
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 3.0, 1e-3],
        [1.0, 2.0, -3.0],
        [1e-7, -1.0, 0.0],
    ];

    #[test]
    fn turning_moves_y_to_up_and_keeps_lengths_and_handedness() {
        for up in UPS.map(DVec3::from_array) {
            let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|v| turned(Some(up), v));
            assert!((y - up.normalize()).length() < 1e-12, "{up}");
            assert!((x.cross(y) - z).length() < 1e-12 && (x.length() - 1.0).abs() < 1e-12, "{up}");
        }
    }

    #[test]
    fn zero_directions_and_signs() {
        let from = |up, yaw, pitch| View { up, ..View::default() }.around(yaw, pitch);
        assert_eq!(from(None, 0.0, 0.0).direction, Some([0.0, 0.0, 1.0]));
        assert_eq!(from(None, 90.0, 0.0).direction, Some([1.0, 0.0, 0.0]));
        assert_eq!(from(None, 0.0, 90.0).direction, Some([0.0, 1.0, 0.0]));
        let z = Some([0.0, 0.0, 1.0]);
        assert_eq!(from(z, 0.0, 0.0).direction, Some([0.0, -1.0, 0.0]));
        assert_eq!(from(z, 90.0, 0.0).direction, Some([1.0, 0.0, 0.0]));
        assert_eq!(from(Some([0.0, -2.0, 0.0]), 90.0, 0.0).direction, Some([-1.0, 0.0, 0.0]));
        assert_eq!(from(Some([5.0, 0.0, 0.0]), 0.0, 90.0).direction, Some([1.0, 0.0, 0.0]));
        // From above, the front is at the lower border.
        assert_eq!((from(z, 0.0, 90.0).direction, from(z, 0.0, 90.0).up), (z, Some([0.0, 1.0, 0.0])));
    }
}
