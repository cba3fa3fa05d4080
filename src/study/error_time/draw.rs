//! Pictures of any number of samples, and when more would change nothing.

use crate::method::Method;
use crate::picture::{Sampled, Shader, compare, sampled};
use crate::rays::{Camera, ModelSpace};
use crate::study::{Progress, StudyError};
use image::RgbImage;

/// What is drawn.
pub struct Subject<'a> {
    pub progress: &'a dyn Progress,
    pub shader: Shader<'a>,
    pub space: &'a ModelSpace,
}

/// A picture, and how far another with other samples would be from it.
pub struct Converging {
    pub picture: Sampled,
    /// Root mean square over all channels, from 0 to 255.
    pub standard_error: f64,
}

impl Subject<'_> {
    /// The picture of a camera with samples.
    pub fn draw(&self, method: &dyn Method, camera: &Camera, delta: f64, what: &str) -> Sampled {
        let bar = self.progress.begin(what, Some(u64::from(camera.pixels()[1])));
        sampled(method, &self.shader, self.space, camera, delta, &|| bar.step(1))
    }

    /// Full resolution with an even number of samples along a side of each pixel: four pictures of a quarter of them each, which lie between one another,
    /// and whose mean it is. The standard error is that of a mean of four, as if they were drawn by chance: samples in even rows do better than that.
    pub fn converging(&self, reference: &dyn Method, camera: &Camera, side: u32) -> Result<Converging, StudyError> {
        let quarter = |of: u32| -> Result<Sampled, StudyError> {
            let shift = [of % 2, of / 2].map(|k| (f64::from(k) - 0.5) / f64::from(side));
            let camera = camera.with_samples(side / 2)?.shifted(shift);
            Ok(self.draw(reference, &camera, f64::INFINITY, "converged picture"))
        };
        let quarters = (0..4).map(quarter).collect::<Result<Vec<_>, StudyError>>()?;
        let mut picture = quarters[0].clone();
        for other in &quarters[1..] {
            picture.pixels.iter_mut().zip(&other.pixels).for_each(|(sum, light)| *sum += *light);
        }
        let all = picture.image();
        let squares: f64 = quarters.iter().map(|quarter| difference(&quarter.image(), &all).powi(2)).sum();
        Ok(Converging { picture, standard_error: (squares / 3.0 / 4.0).sqrt() })
    }
}

/// Root mean square difference of two pictures' channels.
pub fn difference(a: &RgbImage, b: &RgbImage) -> f64 {
    compare(a, b).rmse
}

/// Luminance of the pixels that are wholly surface, linear (Rec. 709); not a number elsewhere.
pub fn luminance(picture: &Sampled) -> Vec<f32> {
    let of = |light: &crate::picture::Light| {
        let mean = light.mean();
        if light.coverage() < 1.0 { f32::NAN } else { 0.2126 * mean.x + 0.7152 * mean.y + 0.0722 * mean.z }
    };
    picture.pixels.iter().map(of).collect()
}
