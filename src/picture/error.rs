//! Everything that says how far a picture is from another one.

use super::{ErrorSpread, compare, flip, structural_similarity};
use image::RgbImage;
use serde::{Deserialize, Serialize};

/// How far a picture is from another one of its size: by numbers, and as it looks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureError {
    /// Root mean square difference of the channels, 0 to 255.
    pub rmse: f64,
    /// Peak signal to noise ratio in dB; `None` for equal pictures.
    pub psnr_db: Option<f64>,
    /// Mean structural similarity, -1 to 1 (equal); `None` if a side is below 11.
    pub ssim: Option<f64>,
    /// FLIP of the pixels, 0 to 1; 0 if there are none.
    pub flip: ErrorSpread,
    /// Share of pixels that differ at all, 0 to 1.
    pub off: f64,
}

impl PictureError {
    /// Of two sRGB pictures; `pixels_per_degree` of sight as [`flip()`] takes it. The same with any number of threads.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn of(a: &RgbImage, b: &RgbImage, pixels_per_degree: f64) -> Self {
        let by_numbers = compare(a, b);
        Self {
            rmse: by_numbers.rmse,
            psnr_db: by_numbers.psnr_db,
            ssim: structural_similarity(a, b),
            flip: ErrorSpread::of(flip(a, b, pixels_per_degree).into_iter().map(f64::from)).unwrap_or_default(),
            off: by_numbers.differing,
        }
    }
}
