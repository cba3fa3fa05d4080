//! What the colours of a map mean: a strip below it.

use super::shade::{HOTTEST, heat, level_colour, normal_colour};
use super::text::Font;
use glam::Vec3;
use image::{GenericImage, Rgb, RgbImage};

/// Behind text.
pub(super) const PAPER: Rgb<u8> = Rgb([18, 20, 25]);
/// Text.
pub(super) const INK: Rgb<u8> = Rgb([226, 228, 232]);

/// Marks along the bar of differences.
const MARKS: u32 = 4;

/// Which map it explains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Legend {
    /// A level map of a scene with so many splits.
    Levels(u32),
    /// An error map.
    Error,
    /// A normal map.
    Normals,
}

impl Legend {
    /// The picture with the legend below; a picture that is too narrow for it gets room on the right.
    pub fn below(self, picture: &RgbImage) -> RgbImage {
        let strip = self.strip(picture.width());
        let mut all = RgbImage::from_pixel(strip.width(), picture.height() + strip.height(), PAPER);
        // Both lie within, by construction.
        let _ = all.copy_from(picture, 0, 0).and_then(|()| all.copy_from(&strip, 0, picture.height()));
        all
    }

    /// The legend alone, at least so wide.
    pub fn strip(self, width: u32) -> RgbImage {
        let font = Font::of_width(width);
        let (pad, line) = (font.height() / 2, font.height());
        let (title, names) = (self.title(), self.names());
        let cell = font.width(names.iter().map(|n| n.chars().count() as u32 + 2).max().unwrap_or(0)); // a few characters
        let width = width.max(2 * pad + font.width_of(&title).max(cell * names.len() as u32)); // at most 11 names
        let bar = width - 2 * pad;
        let marks_below = self == Self::Error;
        let height = pad / 2 + line + pad / 2 + line + if marks_below { line } else { 0 } + pad;

        let mut strip = RgbImage::from_pixel(width, height, PAPER);
        font.draw(&mut strip, [pad, pad / 2], &title, INK);
        let top = pad + line;
        for x in 0..bar {
            let colour = self.colour(x, bar);
            (top..top + line).for_each(|y| strip.put_pixel(pad + x, y, colour));
        }
        let count = names.len() as u32;
        for (name, k) in names.iter().zip(0..) {
            let wide = font.width_of(name);
            if marks_below {
                // Each at its place, and within the bar.
                let place = (k * (bar - 1) / MARKS).saturating_sub(wide / 2).min(bar - wide);
                font.draw(&mut strip, [pad + place, top + line], name, INK);
            } else {
                let middle = (2 * k + 1) * bar / (2 * count);
                let light = self.colour(middle, bar).0.iter().map(|&c| u32::from(c)).sum::<u32>() > 3 * 110;
                let ink = if light { Rgb([0; 3]) } else { Rgb([255; 3]) };
                font.draw(&mut strip, [pad + middle - wide / 2, top], name, ink);
            }
        }
        strip
    }

    fn title(self) -> String {
        match self {
            Self::Levels(0) => "triangles, all on level 0".to_owned(),
            Self::Levels(n) => format!("triangle's level: 0 base, {n} finest"),
            Self::Error => "largest channel difference, of 255".to_owned(),
            Self::Normals => "normal: red x, green y, blue z".to_owned(),
        }
    }

    /// What stands in the bar or, at equal distances, below it.
    fn names(self) -> Vec<String> {
        match self {
            Self::Levels(n) => (0..=n).map(|level| level.to_string()).collect(),
            Self::Error => (0..MARKS).map(|k| (k * HOTTEST / MARKS).to_string()).chain([format!("{HOTTEST}+")]).collect(),
            Self::Normals => ["+x", "-x", "+y", "-y", "+z", "-z"].map(str::to_owned).to_vec(),
        }
    }

    /// Colour of column `x` of the bar.
    fn colour(self, x: u32, bar: u32) -> Rgb<u8> {
        // The cell of `x` and how far it is in there, for `cells` of them.
        let within = |cells: u32| {
            let place = x as f32 * cells as f32 / bar as f32;
            (place.floor().min(cells as f32 - 1.0), place.fract())
        };
        match self {
            Self::Levels(n) => {
                let (level, shade) = within(n + 1);
                level_colour(level as u32, shade) // at most n
            }
            Self::Error => heat(x as f32 * HOTTEST as f32 / (bar - 1).max(1) as f32),
            Self::Normals => {
                let axes = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
                normal_colour(axes[within(6).0 as usize]) // at most 5
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_keeps_its_pixels() {
        for (width, height) in [(1, 1), (37, 3), (300, 200), (1024, 2), (65_536, 1)] {
            let picture = RgbImage::from_fn(width, height, |x, y| Rgb([x as u8, y as u8, 77]));
            for legend in [Legend::Levels(0), Legend::Levels(10), Legend::Error, Legend::Normals] {
                let all = legend.below(&picture);
                assert!(all.width() >= width && all.height() > height + 30 && all.height() < height + 600);
                assert!(picture.enumerate_pixels().all(|(x, y, p)| all.get_pixel(x, y) == p), "{width}x{height} {legend:?}");
                assert!(width < 1024 || all.width() == width, "{legend:?}");
            }
        }
    }

    #[test]
    fn bars_show_the_colours_of_the_maps() {
        let seen = |legend: Legend, colour: Rgb<u8>| legend.strip(1024).pixels().any(|&p| p == colour);
        for level in 0..=7 {
            assert!(seen(Legend::Levels(7), level_colour(level, 0.0)), "{level}");
        }
        assert!(!seen(Legend::Levels(6), level_colour(7, 0.0)));
        for v in [Vec3::X, Vec3::NEG_Y, Vec3::Z] {
            assert!(seen(Legend::Normals, normal_colour(v)), "{v}");
        }
        assert!(seen(Legend::Error, heat(0.0)) && seen(Legend::Error, heat(64.0)));
    }
}
