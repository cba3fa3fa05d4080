//! Pictures of heights.

#[cfg(feature = "exr")]
use super::open_exr::open_exr;
use image::{DynamicImage, ImageReader, Limits};
use std::io::Cursor;
use std::path::Path;

/// Most texels that are read.
const MOST_TEXELS: u64 = 1 << 30;

/// Most texels for each byte of a file, and bytes of what is decoded: more than compression gives. So few bytes cannot ask for much memory.
const MOST_PER_BYTE: u64 = 2048;

/// Why a picture is no map of heights.
#[derive(Debug, thiserror::Error)]
pub enum MapFault {
    /// It could not be read.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// It is no picture of a kind that is read.
    #[error("{0}")]
    Picture(#[from] image::ImageError),
    /// It has not one height for each texel, or is no OpenEXR that can be read.
    #[error("{0}")]
    Content(String),
}

/// Heights on a grid of texels, repeated without end; between texels' centres they are interpolated bilinearly.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    width: usize,
    height: usize,
    /// Row by row from the top.
    texels: Vec<f32>,
}

impl HeightMap {
    /// A map of `width` texels a row, rows from the top.
    ///
    /// # Errors
    /// There is no texel, there are other than whole rows, or a height is not finite.
    pub fn new(width: usize, texels: Vec<f32>) -> Result<Self, MapFault> {
        if width == 0 || texels.is_empty() || !texels.len().is_multiple_of(width) {
            return Err(MapFault::Content(format!("{} texels are not whole rows of {width}", texels.len())));
        }
        if let Some(at) = texels.iter().position(|v| !v.is_finite()) {
            return Err(MapFault::Content(format!("its texel ({}, {}) is {}, not a finite number", at % width, at / width, texels[at])));
        }
        Ok(Self { width, height: texels.len() / width, texels })
    }

    /// The map in a file: PNG or JPEG, whose grey from black to white is a height from 0 to 1 (of colours their luminance; what is transparent counts as if it were not), or OpenEXR, whose
    /// channel Y, else R, else the first, has the heights themselves.
    ///
    /// # Errors
    /// It cannot be read, or a height is not finite.
    pub fn read(path: &Path) -> Result<Self, MapFault> {
        Self::of_bytes(&std::fs::read(path)?)
    }

    /// The same of a file's bytes.
    ///
    /// # Errors
    /// As there.
    pub fn of_bytes(bytes: &[u8]) -> Result<Self, MapFault> {
        const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
        if bytes.starts_with(&EXR) {
            let most = MOST_TEXELS.min(MOST_PER_BYTE * bytes.len() as u64);
            let (width, texels) = open_exr(bytes, most).map_err(MapFault::Content)?;
            return Self::new(width, texels);
        }
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some((8 * MOST_TEXELS).min(MOST_PER_BYTE * bytes.len() as u64 + (1 << 16)));
        reader.limits(limits);
        let picture = reader.decode()?;
        let (width, texels) = (picture.width() as usize, grey(picture));
        Self::new(width, texels)
    }

    /// How many texels it has.
    pub fn texels(&self) -> usize {
        self.texels.len()
    }

    /// Texels across and down.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// From the least height to the greatest.
    pub fn range(&self) -> f64 {
        let (least, most) = self.texels.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, m), &v| (l.min(v), m.max(v)));
        f64::from(most) - f64::from(least)
    }

    /// The height at (u, v): (0, 0) is the lower left corner of the picture, (1, 1) the upper right one.
    pub fn at(&self, [u, v]: [f64; 2]) -> f64 {
        let (x, right) = place(u, self.width);
        let (y, down) = place(1.0 - v, self.height);
        let row = |y: usize| {
            let row = &self.texels[y * self.width..][..self.width];
            let [a, b] = [row[x], row[(x + 1) % self.width]].map(f64::from);
            a + (b - a) * right
        };
        let [a, b] = [row(y), row((y + 1) % self.height)];
        a + (b - a) * down
    }
}

/// The texel whose centre is before `at` (a repeat is 1 long), and how far behind it `at` is, 0 to 1.
fn place(at: f64, count: usize) -> (usize, f64) {
    let at = at.rem_euclid(1.0) * count as f64 - 0.5;
    let whole = at.floor();
    // From -1 to count: what is a hair below 1 may be rounded to it.
    let texel = (whole as i64).rem_euclid(count as i64);
    (texel as usize, at - whole)
}

fn grey(picture: DynamicImage) -> Vec<f32> {
    match picture {
        DynamicImage::ImageLuma8(own) => own.into_raw().into_iter().map(|v| f32::from(v) / 255.0).collect(),
        other => other.into_luma16().into_raw().into_iter().map(|v| f32::from(v) / 65535.0).collect(),
    }
}

#[cfg(not(feature = "exr"))]
fn open_exr(_: &[u8], _: u64) -> Result<(usize, Vec<f32>), String> {
    Err("it is OpenEXR, which is read only with the feature exr".to_owned())
}
