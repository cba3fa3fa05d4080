//! How far the traced surface is from the full-resolution surface, in pixels.

use super::Frame;
use crate::method::SurfaceHit;
use crate::rays::Camera;
use serde::Serialize;

/// Distance between the two hits of one ray across the line of sight's footprint: along the ray, times the cosine to the normal, in
/// diameters of the pixel's cone there. Pixels that hit in both frames only.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GeometricError {
    /// Mean.
    pub mean: f64,
    /// 99 of 100 pixels are below.
    pub percentile_99: f64,
    /// Largest.
    pub maximum: f64,
}

/// Compares hit distances of `frame` with the true ones; none where no pixel hits in both. `cosine` gives |n.d| of the true surface at a pixel.
pub fn geometric_error(
    frame: &Frame,
    truth: &Frame,
    camera: &Camera,
    cosine: impl Fn(usize, &SurfaceHit) -> f64,
) -> Option<GeometricError> {
    let both = frame.pixels.iter().zip(&truth.pixels).enumerate().filter_map(|(i, (a, b))| Some((i, (*a)?, (*b)?)));
    let mut errors: Vec<f64> = both
        .map(|(i, a, b)| (a.distance - b.distance).abs() * cosine(i, &b) / (2.0 * camera.tan_theta * b.distance))
        .filter(|e| e.is_finite())
        .collect();
    errors.sort_unstable_by(f64::total_cmp);
    let &maximum = errors.last()?;
    let percentile_99 = errors[(errors.len() * 99 / 100).min(errors.len() - 1)];
    Some(GeometricError { mean: errors.iter().sum::<f64>() / errors.len() as f64, percentile_99, maximum })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Placement;
    use crate::rays::{ModelSpace, View};

    #[test]
    fn errors_are_in_pixels() {
        let space =
            ModelSpace { placement: Placement { offset: [0.0; 3], scale: 1e-9 }, lo: [-1 << 30; 3], hi: [1 << 30; 3], zeros: [0; 2] };
        let camera = Camera::new(&View::default(), &space, 2, 2).unwrap();
        let at = |distance| Some(SurfaceHit { distance, ..SurfaceHit::default() });
        let frame = |pixels: Vec<Option<SurfaceHit>>| Frame { width: 2, height: 2, pixels };
        let pixel = 2.0 * camera.tan_theta * 10.0;
        let truth = frame(vec![at(10.0), at(10.0), None, at(5.0)]);
        let traced = frame(vec![at(10.0 + 3.0 * pixel), at(10.0 - pixel), at(1.0), None]);
        let error = geometric_error(&traced, &truth, &camera, |_, _| 0.5).unwrap();
        assert!((error.mean - 1.0).abs() < 1e-9 && (error.maximum - 1.5).abs() < 1e-9, "{error:?}");
        assert_eq!(geometric_error(&frame(vec![None, None, at(1.0), None]), &truth, &camera, |_, _| 0.5), None);
    }
}
