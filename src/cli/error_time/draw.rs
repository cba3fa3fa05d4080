//! Pictures of any number of samples, and when more would change nothing.

use crate::cli::pictures::shoot;
use image::RgbImage;
use lodray::format::{Scene, to_srgb};
use lodray::method::Method;
use lodray::picture::compare;
use lodray::rays::{Camera, ModelSpace};

/// What is drawn.
pub struct Subject<'a> {
    pub scene: &'a Scene,
    pub space: &'a ModelSpace,
}

/// A picture, and how far another with other samples would be from it.
pub struct Converging {
    pub picture: RgbImage,
    /// Root mean square over all channels, from 0 to 255.
    pub standard_error: f64,
}

impl Subject<'_> {
    /// The picture of a camera with samples: their mean in linear light.
    pub fn draw(&self, method: &dyn Method, camera: &Camera, delta: f64, what: &str) -> RgbImage {
        let shot = shoot(method, self.scene, self.space, camera, delta, what).image;
        mean(&shot, camera, |_, _| true)
    }

    /// Full resolution, and its standard error by four pictures of a quarter of the samples each, which lie between one another.
    pub fn converging(&self, reference: &dyn Method, camera: &Camera) -> Converging {
        let shot = shoot(reference, self.scene, self.space, camera, 1.0, "converged picture").image;
        let picture = mean(&shot, camera, |_, _| true);
        let quarters = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|of| mean(&shot, camera, move |x, y| (x % 2, y % 2) == of));
        let mean_square = quarters.iter().map(|quarter| difference(quarter, &picture).powi(2)).sum::<f64>() / 3.0;
        Converging { picture, standard_error: (mean_square / 4.0).sqrt() }
    }
}

/// Root mean square difference of two pictures' channels.
pub fn difference(a: &RgbImage, b: &RgbImage) -> f64 {
    compare(a, b).rmse
}

fn mean(shot: &RgbImage, camera: &Camera, counts: impl Fn(u32, u32) -> bool) -> RgbImage {
    let side = camera.samples;
    if side == 1 {
        return shot.clone();
    }
    let [width, height] = camera.pixels();
    let table: Vec<f32> = (0..=255u8).map(linear).collect();
    RgbImage::from_fn(width, height, |x, y| {
        let (mut sum, mut count) = ([0.0f32; 3], 0.0f32);
        for (i, j) in (0..side).flat_map(|j| (0..side).map(move |i| (i, j))).filter(|&(i, j)| counts(i, j)) {
            let colour = shot.get_pixel(x * side + i, y * side + j).0;
            (0..3).for_each(|k| sum[k] += table[usize::from(colour[k])]);
            count += 1.0;
        }
        image::Rgb(sum.map(|s| to_srgb(s / count)))
    })
}

fn linear(byte: u8) -> f32 {
    let v = f32::from(byte) / 255.0;
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}
