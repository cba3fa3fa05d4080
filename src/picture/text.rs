//! Text in pictures: Noto Sans Mono as bitmaps, so that no font of the system is needed.

use image::{Rgb, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Characters in a line across a picture.
const PER_LINE: u32 = 48;
/// Largest enlargement of the bitmaps: a wide and low picture gets no legend of its own weight.
const MAX_SCALE: u32 = 4;

/// A size of text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    raster: RasterHeight,
    /// Pixels of the picture to one of the bitmap's, each way.
    scale: u32,
}

impl Font {
    /// What suits a picture of that width; the smallest for small ones.
    pub fn of_width(width: u32) -> Self {
        let sizes = [RasterHeight::Size32, RasterHeight::Size24, RasterHeight::Size20, RasterHeight::Size16];
        let all = (2..=MAX_SCALE)
            .rev()
            .map(|scale| Self { raster: RasterHeight::Size32, scale })
            .chain(sizes.map(|raster| Self { raster, scale: 1 }));
        let fitting = all.into_iter().find(|font| font.width(PER_LINE) <= width);
        fitting.unwrap_or(Self { raster: RasterHeight::Size16, scale: 1 })
    }

    /// Width of so many characters.
    pub fn width(self, characters: u32) -> u32 {
        characters * self.scale * get_raster_width(FontWeight::Regular, self.raster) as u32 // 18 at most
    }

    /// Width of a text.
    pub fn width_of(self, text: &str) -> u32 {
        self.width(text.chars().count() as u32) // lines of a picture
    }

    /// Height of a line.
    pub fn height(self) -> u32 {
        self.scale * self.raster.val() as u32 // 32 at most
    }

    /// Draws one line with its upper left corner at (`x`, `y`); what is outside of the picture is cut off, and what the font lacks is a question mark.
    pub fn draw(self, image: &mut RgbImage, [x, y]: [u32; 2], text: &str, colour: Rgb<u8>) {
        for (c, left) in text.chars().zip((x..).step_by(self.width(1) as usize)) {
            let known = |c| get_raster(c, FontWeight::Regular, self.raster);
            let Some(glyph) = known(c).or_else(|| known('?')) else { continue };
            for (row, top) in glyph.raster().iter().zip((y..).step_by(self.scale as usize)) {
                for (&ink, left) in row.iter().zip((left..).step_by(self.scale as usize)) {
                    let block = (0..self.scale * self.scale).map(|i| (left + i % self.scale, top + i / self.scale));
                    for (x, y) in block {
                        if let Some(pixel) = image.get_pixel_mut_checked(x, y) {
                            let mix =
                                |from: u8, to: u8| (u32::from(from) * u32::from(255 - ink) + u32::from(to) * u32::from(ink) + 127) / 255;
                            pixel.0 = std::array::from_fn(|k| mix(pixel.0[k], colour.0[k]) as u8); // a mean of two bytes
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_grows_with_the_picture() {
        let heights = [1, 300, 512, 1024, 4096, 65_536].map(|width| Font::of_width(width).height());
        assert!(heights.is_sorted() && heights[0] == 16 && (24..=40).contains(&heights[3]) && heights[4] >= 96, "{heights:?}");
    }

    #[test]
    fn what_is_outside_is_cut_off() {
        let black = RgbImage::new(20, 10);
        for at in [[0, 0], [15, 0], [0, 3], [30, 30]] {
            let mut image = black.clone();
            Font::of_width(1).draw(&mut image, at, "W\u{e9}\u{4e16}", Rgb([200, 100, 0]));
            assert_eq!(image == black, at[0] == 30, "{at:?}");
            assert!(image.pixels().all(|p| p.0[0] <= 200 && p.0[2] == 0));
        }
    }
}
