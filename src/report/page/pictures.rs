//! Pictures small enough to stand in a page: JPEG, scaled so that all of them together keep within a budget.

use crate::report::error_time::PictureEntry;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::thumbnail;
use image::{ImageError, RgbImage};
use rayon::prelude::*;
use serde::Serialize;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Bytes of all pictures of a page: in base64 they take a third more, and the page of one run stays below 10 MB.
pub const PICTURE_BYTES: usize = 6_000_000;

/// Longest sides, the largest first.
const SIDES: [u32; 10] = [1024, 768, 640, 512, 384, 320, 256, 192, 128, 96];
/// Of JPEG, of 100.
const QUALITY: u8 = 84;
/// Pictures from which the size of all is told beforehand.
const SAMPLE: usize = 8;

/// A picture in a page.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Embedded {
    /// What it is.
    #[serde(flatten)]
    pub entry: PictureEntry,
    /// Its block in the page.
    pub id: String,
    /// Columns, scaled.
    pub width: u32,
    /// Rows, scaled.
    pub height: u32,
    /// The file.
    #[serde(skip)]
    pub jpeg: Vec<u8>,
}

/// A picture that is not there, or is none.
#[derive(Debug, Error)]
#[error("cannot read the picture {}", file.display())]
pub struct PictureFault {
    /// Its file.
    pub file: PathBuf,
    /// Why.
    pub source: ImageError,
}

/// The pictures, each with its file, in as large a size as `budget` bytes allow for all together; none is enlarged.
///
/// # Errors
/// The first picture that cannot be read.
pub fn embed(pictures: &[(PictureEntry, PathBuf)], budget: usize) -> Result<Vec<Embedded>, PictureFault> {
    let step = pictures.len().div_ceil(SAMPLE).max(1);
    let sample = pictures.iter().step_by(step).map(|(_, file)| Ok((read(file)?, file))).collect::<Result<Vec<_>, _>>()?;
    let room = budget / pictures.len().max(1);
    let mean = |side: u32| -> Result<usize, PictureFault> {
        let sizes = sample.par_iter().map(|(picture, file)| Ok(encoded(picture, side, file)?.2.len()));
        Ok(sizes.collect::<Result<Vec<_>, _>>()?.into_iter().sum::<usize>() / sample.len().max(1))
    };
    let mut first = 0;
    while first + 1 < SIDES.len() && mean(SIDES[first])? > room {
        first += 1;
    }
    // The sample may have been of the smaller ones.
    for (k, &side) in SIDES.iter().enumerate().skip(first) {
        let all = at_side(pictures, side)?;
        if k + 1 == SIDES.len() || all.iter().map(|picture| picture.jpeg.len()).sum::<usize>() <= budget {
            return Ok(all);
        }
    }
    Ok(Vec::new())
}

fn at_side(pictures: &[(PictureEntry, PathBuf)], side: u32) -> Result<Vec<Embedded>, PictureFault> {
    let one = |(k, (entry, file)): (usize, &(PictureEntry, PathBuf))| {
        let (width, height, jpeg) = encoded(&read(file)?, side, file)?;
        Ok(Embedded { entry: entry.clone(), id: format!("picture-{k}"), width, height, jpeg })
    };
    pictures.par_iter().enumerate().map(one).collect()
}

fn read(path: &Path) -> Result<RgbImage, PictureFault> {
    let picture = image::open(path).map_err(|source| PictureFault { file: path.to_owned(), source })?;
    Ok(picture.to_rgb8())
}

/// Columns, rows and file.
fn encoded(picture: &RgbImage, side: u32, file: &Path) -> Result<(u32, u32, Vec<u8>), PictureFault> {
    let (width, height) = picture.dimensions();
    let longest = width.max(height).max(1);
    let scaled = |length: u32| (u64::from(length) * u64::from(side) / u64::from(longest)).max(1) as u32; // at most `side`
    let small = (longest > side).then(|| thumbnail(picture, scaled(width), scaled(height)));
    let picture = small.as_ref().unwrap_or(picture);
    let mut jpeg = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut jpeg, QUALITY);
    picture.write_with_encoder(encoder).map_err(|source| PictureFault { file: file.to_owned(), source })?;
    Ok((picture.width(), picture.height(), jpeg))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    #[test]
    fn pictures_keep_within_their_budget_and_are_not_enlarged() {
        let folder = tempfile::tempdir().unwrap();
        let noise = |x: u32, y: u32, k: u32| (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503).wrapping_add(k * 977)) as u8;
        let entries: Vec<_> = (0..10)
            .map(|k| {
                let side = if k == 0 { 40 } else { 600 };
                let picture = RgbImage::from_fn(side, side / 2, |x, y| Rgb([noise(x, y, k), noise(y, x, k), 99]));
                let file = format!("{k}.png");
                picture.save(folder.path().join(&file)).unwrap();
                let path = folder.path().join(&file);
                (PictureEntry { view: 0, method: "lod".into(), setting: "delta 1".into(), samples: 1, kind: "image".into(), file }, path)
            })
            .collect();
        let pictures = embed(&entries, 500_000).unwrap();
        assert_eq!((pictures[0].width, pictures[0].height), (40, 20));
        assert!(pictures.iter().map(|p| p.jpeg.len()).sum::<usize>() <= 500_000 && pictures[1].width < 600);
        assert_eq!(pictures[1].width, 2 * pictures[1].height);
        assert_eq!(image::load_from_memory(&pictures[3].jpeg).unwrap().width(), pictures[3].width);
        let gone = [(entries[0].0.clone(), folder.path().join("none.png"))];
        assert!(embed(&gone, 1).unwrap_err().to_string().contains("none.png"));
        assert!(embed(&[], 1).unwrap().is_empty());
    }
}
