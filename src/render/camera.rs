//! The pinhole camera.

use crate::traverse::{ModelSpace, WorldRay};
use glam::DVec3;
use thiserror::Error;

/// The paper's camera: focal length 35 on a sensor of height 24.
pub const DEFAULT_VIEW_ANGLE_DEGREES: f64 = 37.849_288_832_102_47;

/// Where the eye is if nothing says so, in bounding radii from the target.
pub const DEFAULT_DISTANCE: f64 = 2.0;

/// Most columns and rows of a picture.
const MAX_SIDE: u32 = 1 << 16;
/// Most pixels of a picture: what is kept of each takes about 50 bytes.
const MAX_PIXELS: u64 = 1 << 26;

/// Where to look from; what is `None` is chosen to suit the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Eye; by default in the direction (0.35, 0.5, 1) from the target.
    pub eye: Option<[f64; 3]>,
    /// Target; by default the centre of the model's box.
    pub target: Option<[f64; 3]>,
    /// Up; (0, 1, 0) by default.
    pub up: Option<[f64; 3]>,
    /// Distance from target to eye in bounding radii, where `eye` is `None` or only gives the direction.
    pub distance: Option<f64>,
    /// Vertical view angle in degrees.
    pub fov: f64,
}

impl Default for View {
    fn default() -> Self {
        Self { eye: None, target: None, up: None, distance: None, fov: DEFAULT_VIEW_ANGLE_DEGREES }
    }
}

/// A view that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CameraError {
    /// Not a number a camera can use.
    #[error("{0} must be {1}")]
    Field(&'static str, &'static str),
}

/// A camera with its image size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Eye in world space.
    pub eye: DVec3,
    forward: DVec3,
    /// To the next pixel on the right, and up, for a picture plane at distance 1.
    right: DVec3,
    above: DVec3,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Tangent of the half angle of every pixel's cone: half a pixel at the picture's centre.
    pub tan_theta: f64,
}

impl Camera {
    /// The camera of `view` on a model, for a picture of `width` x `height` pixels.
    ///
    /// # Errors
    /// Names the field that is not finite, not positive, or leaves no direction.
    pub fn new(view: &View, space: &ModelSpace, width: u32, height: u32) -> Result<Self, CameraError> {
        let finite = |v: Option<[f64; 3]>, name| match v {
            Some(v) if !v.iter().all(|c| c.is_finite()) => Err(CameraError::Field(name, "three finite numbers")),
            v => Ok(v.map(DVec3::from_array)),
        };
        let (eye, target, up) = (finite(view.eye, "--eye")?, finite(view.target, "--target")?, finite(view.up, "--up")?);
        if !(view.fov > 0.0 && view.fov < 180.0) {
            return Err(CameraError::Field("--fov", "between 0 and 180 degrees"));
        }
        if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE || u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(CameraError::Field("--size", "at most 65536 pixels wide and high, and 67108864 in all"));
        }
        let target = target.unwrap_or_else(|| DVec3::from_array(space.centre()));
        let eye = match (eye, view.distance) {
            (Some(eye), None) => eye,
            (eye, distance) => {
                let distance = distance.unwrap_or(DEFAULT_DISTANCE);
                if !(distance > 0.0 && distance.is_finite()) {
                    return Err(CameraError::Field("--distance", "a positive number of bounding radii"));
                }
                let direction = eye.map_or(DVec3::new(0.35, 0.5, 1.0), |e| e - target);
                let direction = direction.try_normalize().ok_or(CameraError::Field("--eye", "different from --target"))?;
                target + direction * (distance * space.radius())
            }
        };
        let forward = (target - eye).try_normalize().ok_or(CameraError::Field("--eye", "different from --target"))?;
        let up = up.unwrap_or(DVec3::Y);
        // Looking straight up or down: any other axis serves.
        let side = forward.cross(up).try_normalize();
        let side = match side {
            Some(side) => side,
            None if view.up.is_none() => forward.cross(DVec3::NEG_Z).normalize(),
            None => return Err(CameraError::Field("--up", "not along the view direction")),
        };
        let pixel = 2.0 * (0.5 * view.fov.to_radians()).tan() / f64::from(height);
        let above = side.cross(forward) * pixel;
        Ok(Self { eye, forward, right: side * pixel, above, width, height, tan_theta: 0.5 * pixel })
    }

    /// The ray through the centre of pixel (`x`, `y`), row 0 at the top.
    pub fn ray(&self, x: u32, y: u32) -> WorldRay {
        self.ray_at(f64::from(x) + 0.5, f64::from(y) + 0.5)
    }

    /// The ray through picture position (`x`, `y`) in pixels.
    pub fn ray_at(&self, x: f64, y: f64) -> WorldRay {
        let direction = self.forward + self.right * (x - 0.5 * f64::from(self.width)) - self.above * (y - 0.5 * f64::from(self.height));
        WorldRay { origin: self.eye.to_array(), direction: direction.normalize().to_array(), radius: 0.0, tan_theta: self.tan_theta }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;

    fn space() -> ModelSpace {
        let side = 1 << 20;
        ModelSpace { placement: Placement { offset: [0.0; 3], scale: 1.0 / f64::from(side) }, lo: [-side; 3], hi: [side; 3] }
    }

    #[test]
    fn the_default_angle_is_that_of_a_35_mm_lens() {
        assert!((DEFAULT_VIEW_ANGLE_DEGREES - 2.0 * (12.0f64 / 35.0).atan().to_degrees()).abs() < 1e-9);
    }

    #[test]
    fn distance_is_in_bounding_radii_and_the_cone_is_half_a_pixel() {
        let camera = Camera::new(&View { distance: Some(4.0), ..View::default() }, &space(), 64, 32).unwrap();
        assert!((camera.eye.length() - 4.0 * 3f64.sqrt()).abs() < 1e-9);
        assert!((camera.tan_theta - 12.0 / 35.0 / 32.0).abs() < 1e-12);
        let middle = camera.ray_at(32.0, 16.0);
        assert!((DVec3::from_array(middle.direction) - camera.forward).length() < 1e-12);
    }

    #[test]
    fn views_that_cannot_be_name_their_field() {
        let refuse = |view: View| Camera::new(&view, &space(), 8, 8).unwrap_err().to_string();
        assert!(refuse(View { fov: 180.0, ..View::default() }).contains("--fov"));
        assert!(refuse(View { distance: Some(-1.0), ..View::default() }).contains("--distance"));
        assert!(refuse(View { eye: Some([0.0; 3]), target: Some([0.0; 3]), ..View::default() }).contains("--eye"));
        assert!(refuse(View { eye: Some([f64::NAN; 3]), ..View::default() }).contains("--eye"));
    }
}
