//! Pictures: saving, and how far one is from another.

use crate::format::write_and_rename;
use image::RgbImage;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;

/// How far a picture is from the true one, channels from 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

/// Writes a PNG that says `notes` (keyword and text) of itself, under a temporary name, and renames it.
///
/// # Errors
/// If the file cannot be written, or a keyword is not one of PNG: 1 to 79 Latin letters.
pub fn save_png(image: &RgbImage, notes: &[(String, String)], path: &Path) -> io::Result<()> {
    write_and_rename(path, |out| {
        let mut encoder = png::Encoder::new(out, image.width(), image.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        for (keyword, text) in notes {
            // Neither kind of text may hold a zero byte; the plain kind is read by more programs.
            let text = text.replace(char::is_control, " ");
            if text.is_ascii() {
                encoder.add_text_chunk(keyword.clone(), text)?;
            } else {
                encoder.add_itxt_chunk(keyword.clone(), text)?;
            }
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(image)?;
        Ok(writer.finish()?)
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

    #[test]
    fn a_picture_says_what_it_is_and_keeps_its_pixels() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let picture = RgbImage::from_fn(7, 5, |x, y| Rgb([x as u8, 200, y as u8]));
        let notes = [("Scene", "cow"), ("Method", "gr\u{f6}\u{df}er \u{4e16}\0")].map(|(k, v)| (k.to_owned(), v.to_owned()));
        save_png(&picture, &notes, &path).unwrap();
        assert_eq!(image::open(&path).unwrap().to_rgb8(), picture);
        let reader = png::Decoder::new(io::BufReader::new(std::fs::File::open(&path).unwrap())).read_info().unwrap();
        let info = reader.info();
        assert_eq!((info.uncompressed_latin1_text[0].keyword.as_str(), info.uncompressed_latin1_text[0].text.as_str()), ("Scene", "cow"));
        assert_eq!(info.utf8_text[0].get_text().unwrap(), "gr\u{f6}\u{df}er \u{4e16} ");
    }
}
