//! Pictures of a view by a method.

use super::progress::Progress;
use crate::format::Scene;
use crate::method::{Method, SurfaceHit};
use crate::picture::{
    Frame, FrameStats, GeometricError, ImageError, Shader, Shading, compare, geometric_error, render, sampled, shaded, view_cosine,
};
use crate::rays::{Camera, ModelSpace};
use image::RgbImage;
use serde::Serialize;

/// A frame, what it took, and its shaded picture.
pub struct Shot {
    /// What its rays met.
    pub frame: Frame,
    /// What they read.
    pub stats: FrameStats,
    /// The picture.
    pub image: RgbImage,
}

/// Differences of two pictures of one view.
#[derive(Clone, Serialize)]
pub struct Comparison {
    /// Of the pictures.
    #[serde(flatten)]
    pub image: ImageError,
    /// Pixels that hit in one picture only.
    pub coverage_differs: u64,
    /// Distance between the surfaces in pixels; null in JSON if no pixel hits in both pictures.
    pub geometry_pixels: Option<GeometricError>,
}

impl Shot {
    /// Traces and shades one view with one sample in each pixel, by full-resolution normals: pictures of all methods, and of all reports, compare. `told` says what
    /// is done, and whom.
    pub fn plain(method: &dyn Method, scene: &Scene, space: &ModelSpace, camera: &Camera, delta: f64, told: (&str, &dyn Progress)) -> Self {
        Self::of(method, &Shader::new(method.surface(scene), space, Shading::Full), space, [camera; 2], delta, told)
    }

    /// Traces one view: the frame with one ray in each pixel of the first camera, and the picture with the samples of the other.
    pub fn of(
        method: &dyn Method,
        shader: &Shader<'_>,
        space: &ModelSpace,
        [camera, samples]: [&Camera; 2],
        delta: f64,
        (what, progress): (&str, &dyn Progress),
    ) -> Self {
        let is_one = samples.samples == camera.samples;
        let bar = progress.begin(what, Some(u64::from(camera.height) * (1 + u64::from(!is_one))));
        let (frame, stats) = render(method, space, camera, delta, &|| bar.step(1));
        let image =
            if is_one { shaded(&frame, shader, camera) } else { sampled(method, shader, space, samples, delta, &|| bar.step(1)).image() };
        Self { frame, stats, image }
    }

    /// How far its picture is from the true one of the same camera.
    pub fn compared(&self, truth: &Self, scene: &Scene, camera: &Camera) -> Comparison {
        self.compared_by(truth, camera, |index, pixel| f64::from(view_cosine(scene, camera, index, pixel)))
    }

    /// The same where `cosine` is that of the true surface to the view, by the pixel's number and its hit.
    pub(super) fn compared_by(&self, truth: &Self, camera: &Camera, cosine: impl Fn(usize, &SurfaceHit) -> f64) -> Comparison {
        let differs = self.frame.pixels.iter().zip(&truth.frame.pixels).filter(|(a, b)| a.is_some() != b.is_some()).count();
        Comparison {
            image: compare(&self.image, &truth.image),
            coverage_differs: differs as u64,
            geometry_pixels: geometric_error(&self.frame, &truth.frame, camera, cosine),
        }
    }
}
