//! What paths bring to a picture.

use super::integrate::{PathCounts, Paths};
use crate::format::to_srgb;
use glam::{DVec3, Vec3};
use image::{Rgb, RgbImage};
use rayon::prelude::*;
use serde::Serialize;

/// A picture of paths, linear.
pub struct Film {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Mean light of each pixel, row by row from the top.
    pub light: Vec<Vec3>,
    /// Of the shadow rays of each pixel's first hits those that reached their light, and all.
    pub lit: Vec<[u32; 2]>,
    /// What was traced.
    pub counts: PathCounts,
}

impl Film {
    /// Traces all paths; `row_done` is called after each row. The same at any number of threads.
    pub fn of(paths: &Paths<'_>, row_done: &(dyn Fn() + Sync)) -> Self {
        let [width, height] = [paths.camera.width, paths.camera.height];
        let row = |y: u32| {
            let mut tracer = paths.tracer();
            let pixels: Vec<(Vec3, [u32; 2])> = (0..width)
                .map(|x| {
                    let (mut light, mut lit) = (DVec3::ZERO, [0; 2]);
                    for sample in 0..paths.samples {
                        let (own, own_lit) = tracer.sample(x, y, sample);
                        light += own;
                        lit = [lit[0] + own_lit[0], lit[1] + own_lit[1]];
                    }
                    ((light / f64::from(paths.samples)).as_vec3(), lit)
                })
                .collect();
            row_done();
            (pixels, tracer.counts)
        };
        let rows: Vec<_> = (0..height).into_par_iter().map(row).collect();
        let mut film = Self { width, height, light: Vec::new(), lit: Vec::new(), counts: paths.no_counts() };
        for (pixels, counts) in rows {
            film.counts += &counts;
            for (light, lit) in pixels {
                film.light.push(light);
                film.lit.push(lit);
            }
        }
        film
    }

    /// As a screen shows it: 2^`exposure` times as bright, bent like film (Narkowicz's fit of ACES), in sRGB.
    pub fn image(&self, exposure: f64) -> RgbImage {
        // In 64 bits, in which the square of anything is a number.
        let bent = |c: f64| (c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14);
        RgbImage::from_fn(self.width, self.height, |x, y| {
            let light = self.light[(y * self.width + x) as usize].as_dvec3() * exposure.exp2();
            Rgb(light.to_array().map(|c| to_srgb(bent(c.max(0.0)) as f32)))
        })
    }
}

/// Pixels whose first hits get light that they should not, or do not get what they should.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LightCount {
    /// Pixels that both pictures have lights asked for.
    pub pixels: u64,
    /// In shadow (at most a quarter of their shadow rays get through), where at least three quarters should.
    pub shadowed: u64,
    /// The reverse.
    pub leaking: u64,
}

/// Compares with the truth.
pub fn light_count(film: &Film, truth: &Film) -> LightCount {
    let mut count = LightCount::default();
    for (own, truth) in film.lit.iter().zip(&truth.lit) {
        if own[1] == 0 || truth[1] == 0 {
            continue;
        }
        count.pixels += 1;
        let (is_dark, is_lit) = (|[lit, all]: [u32; 2]| 4 * lit <= all, |[lit, all]: [u32; 2]| 4 * lit >= 3 * all);
        count.shadowed += u64::from(is_dark(*own) && is_lit(*truth));
        count.leaking += u64::from(is_lit(*own) && is_dark(*truth));
    }
    count
}

/// Mean squared difference of linear pictures, relative to the truth's square and a hundredth: what is dark counts as what is bright.
pub fn picture_error(film: &Film, truth: &Film) -> f64 {
    let pixels = film.light.iter().zip(&truth.light).map(|(a, b)| (a.as_dvec3(), b.as_dvec3()));
    let sum: f64 = pixels.map(|(a, b)| (a - b).length_squared() / (b.length_squared() + 1e-2)).sum();
    sum / film.light.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(light: &[f32], lit: &[[u32; 2]]) -> Film {
        let counts = PathCounts::default();
        Film { width: light.len() as u32, height: 1, light: light.iter().map(|&c| Vec3::splat(c)).collect(), lit: lit.to_vec(), counts }
    }

    #[test]
    fn light_is_wrong_where_it_is_on_the_other_side() {
        let truth = film(&[0.0; 5], &[[4, 4], [3, 4], [0, 4], [1, 4], [4, 4]]);
        let own = film(&[0.0; 5], &[[1, 4], [2, 4], [3, 4], [4, 4], [0, 0]]);
        assert_eq!(light_count(&own, &truth), LightCount { pixels: 4, shadowed: 1, leaking: 2 });
        assert_eq!(light_count(&truth, &truth), LightCount { pixels: 5, shadowed: 0, leaking: 0 });
    }

    #[test]
    fn errors_are_relative_and_screens_get_all_from_black_to_white() {
        let (a, b) = (film(&[1.0, 100.0], &[]), film(&[1.1, 110.0], &[]));
        assert_eq!(picture_error(&a, &a), 0.0);
        let error = picture_error(&a, &b);
        assert!((error - (0.1f64 / 1.1).powi(2)).abs() < 2e-4, "{error}");
        let ramp = film(&[0.0, 0.1, 0.3, 0.5, 1.0, 4.0, 1e6], &[]).image(0.0);
        let codes: Vec<u8> = ramp.pixels().map(|pixel| pixel.0[0]).collect();
        assert!(codes[0] == 0 && codes.is_sorted() && codes[6] == 255, "{codes:?}");
        assert_eq!(film(&[0.25], &[]).image(1.0), film(&[0.5], &[]).image(0.0));
    }
}
