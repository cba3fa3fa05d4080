//! Pictures: saving, and how far one is from another.

use crate::format::write_and_rename;
use image::RgbImage;
use serde::Serialize;
use std::io;
use std::path::Path;

/// How far a picture is from the true one, channels from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ImageError {
    /// Root mean square difference.
    pub rmse: f64,
    /// Peak signal to noise ratio in dB; `None` for equal pictures.
    pub psnr_db: Option<f64>,
    /// Largest difference of a channel.
    pub maximum: u8,
    /// Share of pixels that differ at all, 0 to 1.
    pub differing: f64,
}

/// Compares two pictures of the same size.
pub fn compare(a: &RgbImage, b: &RgbImage) -> ImageError {
    let (mut squares, mut maximum, mut differing) = (0u64, 0u8, 0u64);
    for (a, b) in a.pixels().zip(b.pixels()) {
        let difference: [u8; 3] = std::array::from_fn(|k| a.0[k].abs_diff(b.0[k]));
        squares += difference.iter().map(|&d| u64::from(d) * u64::from(d)).sum::<u64>();
        let largest = difference.into_iter().max().unwrap_or(0);
        maximum = maximum.max(largest);
        differing += u64::from(largest > 0);
    }
    let pixels = (u64::from(a.width()) * u64::from(a.height())).max(1) as f64;
    let rmse = (squares as f64 / (3.0 * pixels)).sqrt();
    ImageError { rmse, psnr_db: (squares > 0).then(|| 20.0 * (255.0 / rmse).log10()), maximum, differing: differing as f64 / pixels }
}

/// Writes a PNG under a temporary name and renames it.
///
/// # Errors
/// If the file cannot be written.
pub fn save_png(image: &RgbImage, path: &Path) -> io::Result<()> {
    write_and_rename(path, |out| {
        let encoder = image::codecs::png::PngEncoder::new(out);
        image.write_with_encoder(encoder).map_err(io::Error::other)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn figures_of_a_known_difference() {
        let a = RgbImage::from_pixel(2, 1, Rgb([10, 10, 10]));
        let mut b = a.clone();
        b.put_pixel(0, 0, Rgb([10, 16, 10]));
        let e = compare(&a, &b);
        assert_eq!((e.maximum, e.differing), (6, 0.5));
        assert!((e.rmse - (36.0f64 / 6.0).sqrt()).abs() < 1e-12);
        assert_eq!(compare(&a, &a).psnr_db, None);
    }
}
