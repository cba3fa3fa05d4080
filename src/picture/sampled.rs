//! Pictures with several samples in each pixel.

use super::frame::packets;
use super::shade::encoded;
use super::shading::{Light, Shader};
use crate::method::Method;
use crate::rays::{Camera, ModelSpace, Sight, TILE};
use crate::run::RayHit;
use crate::step::NoSteps;
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
    /// Before any sample of `camera`.
    pub fn new(camera: &Camera) -> Self {
        let [width, height] = camera.pixels();
        Self { width, height, pixels: vec![Light::default(); width as usize * height as usize] }
    }

    /// Shades samples of `camera` and adds them to their pixels. As [`sampled`], if every sample is added once, and those of each pixel row by row.
    pub fn add(&mut self, shader: &Shader<'_>, camera: &Camera, hits: &[RayHit]) {
        let lights: Vec<Light> = hits
            .par_iter()
            .map(|of| {
                let [x, y] = at(camera, of.ray);
                let mut light = Light::default();
                shader.add(&mut light, &camera.ray(x, y), of.hit.as_ref());
                light
            })
            .collect();
        for (of, light) in hits.iter().zip(lights) {
            let [x, y] = at(camera, of.ray).map(|n| (n / camera.samples) as usize);
            self.pixels[y * self.width as usize + x] += light;
        }
    }

    /// The picture in sRGB.
    pub fn image(&self) -> RgbImage {
        let bytes: Vec<u8> = self.pixels.par_iter().flat_map_iter(|light| encoded(light.mean()).0).collect();
        RgbImage::from_raw(self.width, self.height, bytes).expect("three bytes for each pixel")
    }
}

/// Column and row of a camera's ray.
fn at(camera: &Camera, ray: u64) -> [u32; 2] {
    let width = u64::from(camera.width);
    // Below 2^16 each.
    [ray % width, ray / width].map(|n| n as u32)
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
    let [columns, rows] = camera.window(space);
    let side = camera.samples;
    let mut picture = Sampled::new(camera);
    if method.tracer(&sight).lanes() > 1 {
        sampled_in_packets(method, shader, camera, &sight, &mut picture, row_done);
        return picture;
    }
    picture.pixels.par_chunks_mut(picture.width as usize).enumerate().for_each_init(
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
    picture
}

/// The same with rays in packets, which are of the tiles of a band of samples.
fn sampled_in_packets(
    method: &dyn Method,
    shader: &Shader<'_>,
    camera: &Camera,
    sight: &Sight,
    picture: &mut Sampled,
    row_done: &(dyn Fn() + Sync),
) {
    let (width, side) = (camera.width as usize, camera.samples as usize);
    // The fewest rows of pixels whose samples fill whole bands.
    let rows = (1..=TILE as usize).find(|rows| (rows * side).is_multiple_of(TILE as usize)).unwrap_or(TILE as usize);
    let bands = rows * side / TILE as usize;
    picture.pixels.par_chunks_mut(rows * picture.width as usize).enumerate().for_each_init(
        || method.tracer(sight),
        |tracer, (chunk, pixels)| {
            let mut hits = Vec::new();
            for band in chunk * bands..((chunk + 1) * bands).min(camera.height.div_ceil(TILE) as usize) {
                let first = hits.len();
                let left = (camera.height as usize - band * TILE as usize).min(TILE as usize);
                hits.resize(first + left * width, None);
                packets(&mut **tracer, camera, band, &mut NoSteps, &mut |at, query, hit| hits[first + at] = Some((*query, hit)));
            }
            // Samples of a pixel in their order, as without packets.
            let columns = width / side;
            for (at, light) in pixels.iter_mut().enumerate() {
                let (x, y) = (at % columns, at / columns);
                for sample in (0..side * side).map(|k| (y * side + k / side) * width + x * side + k % side) {
                    if let Some((query, hit)) = &hits[sample] {
                        shader.add(light, query, hit.as_ref());
                    }
                }
            }
            (0..pixels.len() / columns).for_each(|_| row_done());
        },
    );
}
