//! SSIM: how much of a picture's structure another one keeps.
//!
//! Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on
//! Image Processing 13(4), 2004, with their Gaussian window. Equal to 1e-6 to scikit-image 0.26 (PyPI), `structural_similarity` with
//! `gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255, channel_axis=-1`.

use super::kernel::Kernel;
use image::RgbImage;
use rayon::prelude::*;

/// Deviation of the window in pixels.
const DEVIATION: f64 = 1.5;
/// Pixels from its middle to its border: 3.5 deviations, rounded.
const RADIUS: usize = 5;
/// Pixels from border to border.
const WINDOW: usize = 2 * RADIUS + 1;

/// They keep the quotients from 0 / 0 where it is dark, and where it is flat: the squares of 1 % and 3 % of 255.
const DARK: f64 = 2.55 * 2.55;
const FLAT: f64 = 7.65 * 7.65;

/// Rows of windows that are done at a time: the rows that a window reaches beyond are filtered again for each band.
const BAND: usize = 64;

/// Mean similarity over the channels of two sRGB pictures of the same size, -1 to 1, and 1 only for equal ones. Windows lie within the
/// picture: none if a side is below 11. The same with any number of threads.
///
/// # Panics
/// If the sizes differ.
pub fn structural_similarity(a: &RgbImage, b: &RgbImage) -> Option<f64> {
    assert_eq!(a.dimensions(), b.dimensions(), "pictures of different sizes");
    let [columns, rows] = [a.width(), a.height()].map(|side| (side as usize).checked_sub(WINDOW - 1).filter(|&windows| windows > 0));
    let (columns, rows) = (columns?, rows?);
    let window = Kernel::bell(RADIUS, DEVIATION, 1.0);
    let sums: Vec<f64> = (0..rows.div_ceil(BAND))
        .into_par_iter()
        .map(|band| {
            let first = band * BAND;
            let count = BAND.min(rows - first);
            (0..3).map(|channel| similarity(channel, [a, b].map(|p| codes(p, first, count)), columns, &window)).sum::<f64>()
        })
        .collect();
    // Added in the order of the bands, whoever did them.
    Some(sums.iter().sum::<f64>() / (3 * columns * rows) as f64)
}

/// The rows that `count` rows of windows from `first` on reach.
fn codes(picture: &RgbImage, first: usize, count: usize) -> &[u8] {
    let row = 3 * picture.width() as usize;
    &picture.as_raw()[first * row..(first + count + WINDOW - 1) * row]
}

/// Sum of the similarities of all windows in rows of two pictures, `columns` of them in each row.
fn similarity(channel: usize, pictures: [&[u8]; 2], columns: usize, window: &Kernel<f64>) -> f64 {
    let width = columns + WINDOW - 1;
    let rows = pictures[0].len() / (3 * width);
    // Of each row: a, b, their squares and their product, averaged along the row.
    let mut averages = [(); 5].map(|()| vec![0.0; columns * rows]);
    for row in 0..rows {
        let [a, b] =
            pictures.map(|p| p[3 * width * row..3 * width * (row + 1)].iter().skip(channel).step_by(3).map(|&code| f64::from(code)));
        let [a, b] = [a.collect::<Vec<_>>(), b.collect()];
        let times = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>();
        let values = [times(&a, &a), times(&b, &b), times(&a, &b)];
        for (averages, values) in averages.iter_mut().zip([&a, &b].into_iter().chain(&values)) {
            window.weigh(&mut averages[columns * row..columns * (row + 1)], |k| &values[k..k + columns]);
        }
    }
    let mut whole = [(); 5].map(|()| vec![0.0; columns]);
    let mut sum = 0.0;
    for row in 0..=rows - WINDOW {
        for (sums, averages) in whole.iter_mut().zip(&averages) {
            window.weigh(sums, |k| &averages[columns * (row + k)..columns * (row + k + 1)]);
        }
        let [a, b, aa, bb, ab] = &whole;
        sum += (0..columns).map(|k| of_window(a[k], b[k], aa[k], bb[k], ab[k])).sum::<f64>();
    }
    sum
}

/// Similarity of one window from its averages of a, b, their squares and their product.
fn of_window(a: f64, b: f64, aa: f64, bb: f64, ab: f64) -> f64 {
    let brightness = (2.0 * a * b + DARK) / (a * a + b * b + DARK);
    let [variance_a, variance_b, covariance] = [aa - a * a, bb - b * b, ab - a * b];
    brightness * (2.0 * covariance + FLAT) / (variance_a + variance_b + FLAT)
}
