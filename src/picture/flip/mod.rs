//! FLIP: how different two pictures look to someone who switches between them.
//!
//! Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020:
//! colours after the blur of the eye, and where edges or points come or go, their difference counts for more. Equal in the mean to
//! flip-evaluator 1.7 (PyPI) to 1e-4.

mod opponent;

use super::kernel::{Kernel, bell_sum};
use image::RgbImage;
use opponent::Colours;
use rayon::prelude::*;
use std::f32::consts::FRAC_1_SQRT_2;
use std::f64::consts::PI;
use std::ops::Range;

/// Pixels per degree of sight, 67.02: at 0.7 m from a monitor of 3840 columns that is 0.7 m wide, the authors' choice.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * PI / 180.0;

/// Rows that are filtered at a time: the filters' rows above and below are done again for each band, and a band's plane stays in the cache.
const BAND: usize = 64;

/// Difference of each pixel, 0 to 1, row by row from the top, of two sRGB pictures of the same size. Neither picture is the better one.
/// Beyond the border lies what is at the border. `pixels_per_degree`: 1 to 1000, what is outside counting as the nearest of the two;
/// [`PIXELS_PER_DEGREE`] by default. The same with any number of threads.
///
/// # Panics
/// If the sizes differ.
pub fn flip(a: &RgbImage, b: &RgbImage, pixels_per_degree: f64) -> Vec<f32> {
    assert_eq!(a.dimensions(), b.dimensions(), "pictures of different sizes");
    let [width, height] = [a.width(), a.height()].map(|side| side as usize);
    let eye = Eye::new(pixels_per_degree.clamp(1.0, 1000.0));
    let mut map = vec![0.0; width * height];
    map.par_chunks_mut((BAND * width).max(1)).enumerate().for_each_init(Buffers::default, |buffers, (band, map)| {
        let rows = band * BAND..height.min((band + 1) * BAND);
        for (seen, picture) in buffers.seen.iter_mut().zip([a, b]) {
            buffers.strip.load(picture, rows.clone(), &eye);
            seen.look(&buffers.strip, &mut buffers.along_rows, &eye);
        }
        let seen = &buffers.seen;
        for (pixel, value) in map.iter_mut().enumerate() {
            let [colour_a, colour_b] = seen.each_ref().map(|seen| eye.colours.seen(seen.channels(pixel)));
            let difference = eye.colours.difference(colour_a, colour_b);
            let [[edge_a, point_a], [edge_b, point_b]] = seen.each_ref().map(|seen| seen.features(pixel));
            // At most 2^(1/2) each. The square root: faint edges that come or go are seen well.
            let feature = ((edge_a - edge_b).abs().max((point_a - point_b).abs()) * FRAC_1_SQRT_2).sqrt();
            *value = (difference as f32).powf(1.0 - feature);
        }
    });
    map
}

/// Planes of values, kept from band to band: new memory for each took a seventh of the time.
#[derive(Default)]
struct Buffers {
    strip: Strip,
    along_rows: Vec<f32>,
    seen: [Seen; 2],
}

/// The filters of the eye, along rows and then along columns, and its colours.
struct Eye {
    brightness: Kernel<f32>,
    red_green: Kernel<f32>,
    /// The sum of two; each along rows, and along columns with its share.
    blue_yellow: [[Kernel<f32>; 2]; 2],
    /// Across what `edge` and `point` find along the other direction.
    blur: Kernel<f32>,
    edge: Kernel<f32>,
    point: Kernel<f32>,
    colours: Colours,
}

impl Eye {
    fn new(pixels_per_degree: f64) -> Self {
        // How contrast fades, as Gaussians: their spreads are squares of degrees times 2 pi^2. All reach three deviations of the widest.
        let deviation = |spread: f64| (spread / (2.0 * PI * PI)).sqrt() * pixels_per_degree;
        let radius = (3.0 * deviation(0.04)).ceil() as usize; // 10 by default
        let [brightness, red_green] = [0.0047, 0.0053].map(|spread| Kernel::bell(radius, deviation(spread), 1.0));
        // Each of the two has the share of its volume.
        let volume = |(height, spread): (f64, f64)| height * (PI / spread).sqrt() * bell_sum(radius, deviation(spread)).powi(2);
        let parts = [(34.1, 0.04), (13.5, 0.025)];
        let whole = volume(parts[0]) + volume(parts[1]);
        let blue_yellow = parts.map(|part| [1.0, volume(part) / whole].map(|share| Kernel::bell(radius, deviation(part.1), share)));
        // Edges and points are found at 0.082 degrees from the peak of the edge filter to its trough, which is two deviations.
        let deviation = 0.5 * 0.082 * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as usize; // 9 by default
        Self {
            brightness,
            red_green,
            blue_yellow,
            blur: Kernel::bell(radius, deviation, 1.0),
            edge: Kernel::slope(radius, deviation),
            point: Kernel::bend(radius, deviation),
            colours: Colours::new(),
        }
    }

    /// Farthest pixel that any filter reaches.
    fn radius(&self) -> usize {
        self.brightness.radius().max(self.blur.radius())
    }
}

/// A band of a picture after each filter.
#[derive(Default)]
struct Seen {
    brightness: Vec<f32>,
    red_green: Vec<f32>,
    /// To be added.
    blue_yellow: [Vec<f32>; 2],
    /// To the right, and downwards.
    edge: [Vec<f32>; 2],
    point: [Vec<f32>; 2],
}

impl Seen {
    /// Filters a strip; `plane` holds what is filtered along rows only.
    fn look(&mut self, strip: &Strip, plane: &mut Vec<f32>, eye: &Eye) {
        let mut filtered = |channel, along_rows, along_columns, to| {
            strip.along_rows(channel, along_rows, plane);
            strip.along_columns(plane, along_columns, to);
        };
        filtered(0, &eye.brightness, &eye.brightness, &mut self.brightness);
        filtered(1, &eye.red_green, &eye.red_green, &mut self.red_green);
        for ([along_rows, along_columns], to) in eye.blue_yellow.iter().zip(&mut self.blue_yellow) {
            filtered(2, along_rows, along_columns, to);
        }
        filtered(0, &eye.edge, &eye.blur, &mut self.edge[0]);
        filtered(0, &eye.point, &eye.blur, &mut self.point[0]);
        strip.along_rows(0, &eye.blur, plane);
        strip.along_columns(plane, &eye.edge, &mut self.edge[1]);
        strip.along_columns(plane, &eye.point, &mut self.point[1]);
    }

    fn channels(&self, pixel: usize) -> [f64; 3] {
        [self.brightness[pixel], self.red_green[pixel], self.blue_yellow[0][pixel] + self.blue_yellow[1][pixel]].map(f64::from)
    }

    /// How much of an edge and of a point is there, in any direction.
    fn features(&self, pixel: usize) -> [f32; 2] {
        [&self.edge, &self.point].map(|[x, y]| (x[pixel] * x[pixel] + y[pixel] * y[pixel]).sqrt())
    }
}

/// The rows of a picture that the filters of a band reach, as channels, with a margin on the left and right.
#[derive(Default)]
struct Strip {
    channels: [Vec<f32>; 3],
    width: usize,
    margin: usize,
    band: Range<usize>,
    rows: Range<usize>,
    /// Rows of the picture.
    height: usize,
}

impl Strip {
    /// Takes what `band` needs of a picture.
    fn load(&mut self, picture: &RgbImage, band: Range<usize>, eye: &Eye) {
        [self.width, self.height] = [picture.width(), picture.height()].map(|side| side as usize);
        self.margin = eye.radius();
        self.rows = band.start.saturating_sub(self.margin)..self.height.min(band.end + self.margin);
        self.band = band;
        self.channels.iter_mut().for_each(Vec::clear);
        for row in self.rows.clone() {
            for column in (0..self.width + 2 * self.margin).map(|x| x.saturating_sub(self.margin).min(self.width - 1)) {
                let pixel = *picture.get_pixel(column as u32, row as u32); // within the picture
                for (channel, value) in self.channels.iter_mut().zip(eye.colours.channels(pixel)) {
                    channel.push(value as f32);
                }
            }
        }
    }

    /// Filters all rows of a channel along themselves.
    fn along_rows(&self, channel: usize, kernel: &Kernel<f32>, to: &mut Vec<f32>) {
        to.resize(self.width * self.rows.len(), 0.0);
        let rows = self.channels[channel].chunks_exact(self.width + 2 * self.margin);
        for (sums, row) in to.chunks_exact_mut(self.width).zip(rows) {
            let reached = &row[self.margin - kernel.radius()..];
            kernel.weigh(sums, |k| &reached[k..k + self.width]);
        }
    }

    /// Filters what `along_rows` gave along its columns, for the rows of the band.
    fn along_columns(&self, plane: &[f32], kernel: &Kernel<f32>, to: &mut Vec<f32>) {
        to.resize(self.width * self.band.len(), 0.0);
        for (sums, row) in to.chunks_exact_mut(self.width).zip(self.band.clone()) {
            kernel.weigh(sums, |k| {
                let reached = (row + k).saturating_sub(kernel.radius()).min(self.height - 1) - self.rows.start;
                &plane[reached * self.width..(reached + 1) * self.width]
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn black_against_white_is_nearly_1() {
        let of = |codes: [[u8; 3]; 2]| {
            let [a, b] = codes.map(|code| RgbImage::from_pixel(80, 70, Rgb(code)));
            flip(&a, &b, PIXELS_PER_DEGREE)
        };
        assert!(of([[0; 3], [255; 3]]).iter().all(|v| (0.967..0.968).contains(v)));
        assert!(of([[0, 255, 0], [0, 0, 255]]).iter().all(|v| (v - 1.0).abs() < 1e-6));
    }
}
