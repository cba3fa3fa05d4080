//! Pictures with several samples in each pixel.

use super::shade::encoded;
use super::shading::{Light, Shader};
use crate::method::Method;
use crate::rays::{Camera, ModelSpace, Sight};
use image::RgbImage;
use rayon::prelude::*;

/// A picture in linear light, row by row from the top.
#[derive(Clone)]
pub struct Sampled {
    /// Columns of pixels.
    pub width: u32,
    /// Rows of pixels.
    pub height: u32,
    /// Each pixel's light.
    pub pixels: Vec<Light>,
}

impl Sampled {
    /// The picture in sRGB.
    pub fn image(&self) -> RgbImage {
        let bytes: Vec<u8> = self.pixels.par_iter().flat_map_iter(|light| encoded(light.mean()).0).collect();
        RgbImage::from_raw(self.width, self.height, bytes).expect("three bytes for each pixel")
    }
}

/// Traces and shades all samples of `camera` ([`Camera::with_samples`]) at quality `delta`. Samples are done with as soon as their pixel is: no frame of
/// all is kept. The same with any number of threads. `row_done` is called once for each finished row of pixels, from any thread.
pub fn sampled(
    method: &dyn Method,
    shader: &Shader<'_>,
    space: &ModelSpace,
    camera: &Camera,
    delta: f64,
    row_done: &(dyn Fn() + Sync),
) -> Sampled {
    let sight = Sight::new(camera, space, delta);
    let [width, height] = camera.pixels();
    let [columns, rows] = camera.window(space);
    let side = camera.samples;
    let mut pixels = vec![Light::default(); width as usize * height as usize];
    pixels.par_chunks_mut(width as usize).enumerate().for_each_init(
        || method.tracer(&sight),
        |tracer, (y, pixels)| {
            for (x, light) in (0..).zip(pixels) {
                // Within the picture, which has at most 2^16 rows of samples.
                let across = (0..side).flat_map(|j| (0..side).map(move |i| [x * side + i, y as u32 * side + j]));
                for [x, y] in across {
                    let ray = camera.ray(x, y);
                    // Beside the model there is nothing to trace.
                    let hit = (columns.contains(&x) && rows.contains(&y)).then(|| tracer.hit(&ray)).flatten();
                    shader.add(light, &ray, hit.as_ref());
                }
            }
            row_done();
        },
    );
    Sampled { width, height, pixels }
}
