//! A contact sheet: the pictures of a frame side by side, with titles, legends and figures.

use super::Legend;
use super::legend::{INK, PAPER};
use super::text::Font;
use image::imageops::{FilterType, resize, thumbnail};
use image::{GenericImage, Rgb, RgbImage};

/// Longest side of a picture on the sheet; larger ones are made smaller.
const LARGEST: u32 = 1024;
/// Tiny pictures are enlarged, by whole factors, to as much as this.
const SMALL: u32 = 256;
/// Characters that a line of figures may have.
const COLUMNS: u32 = 40;
/// Characters before a figure's value.
const LABEL: u32 = 17;
/// Width to height that the sheet comes near to.
const SHAPE: f64 = 1.4;
/// Labels of figures.
const FAINT: Rgb<u8> = Rgb([150, 154, 162]);

/// A picture, ready for the sheet.
struct Panel {
    title: String,
    picture: RgbImage,
    legend: Option<RgbImage>,
}

/// Pictures of the same size, to be put side by side.
#[derive(Default)]
pub struct Sheet {
    panels: Vec<Panel>,
}

impl Sheet {
    /// Adds a picture; of a large one a smaller copy is kept.
    pub fn add(&mut self, title: &str, picture: &RgbImage, legend: Option<Legend>) {
        let (width, height) = picture.dimensions();
        let longest = width.max(height);
        let picture = if longest > LARGEST {
            let smaller = |side: u32| (u64::from(side) * u64::from(LARGEST) / u64::from(longest)).max(1) as u32; // at most LARGEST
            thumbnail(picture, smaller(width), smaller(height))
        } else {
            let factor = (SMALL / longest).max(1);
            resize(picture, width * factor, height * factor, FilterType::Nearest)
        };
        let legend = legend.map(|legend| legend.strip(cell_width(&picture)));
        self.panels.push(Panel { title: title.to_owned(), picture, legend });
    }

    /// The sheet: a heading, all pictures, and the figures (label and value), if there are any, in the last place.
    pub fn draw(&self, heading: &str, figures: &[(String, String)]) -> RgbImage {
        let wide = self.panels.iter().map(|p| cell_width(&p.picture)).max().unwrap_or(SMALL);
        let font = Font::of_width(wide);
        let (line, gap) = (font.height() + font.height() / 4, font.height());
        let wide = self.panels.iter().filter_map(|p| p.legend.as_ref()).map(RgbImage::width).chain([wide]).max().unwrap_or(wide);
        let across = wide + gap;
        let talls: Vec<u32> =
            self.panels.iter().map(|p| line + p.picture.height() + p.legend.as_ref().map_or(0, RgbImage::height)).collect();
        // The figures come last, below a line without a title: a few dozen lines.
        let of_figures = (!figures.is_empty()).then_some(line * (figures.len() as u32 + 1));
        let talls: Vec<u32> = talls.into_iter().chain(of_figures).collect();
        let rows = |columns: u32| talls.chunks(columns as usize).map(|row| row.iter().max().unwrap_or(&0) + gap);

        let cells = talls.len() as u32; // a handful
        let off = |columns: &u32| (f64::from(across * columns) / f64::from(rows(*columns).sum::<u32>()) / SHAPE).ln().abs();
        let columns = (1..=cells).filter(|columns| cells.is_multiple_of(*columns)).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(1);
        // Where each row begins, and where the last ends.
        let tops: Vec<u32> = std::iter::once(gap + line)
            .chain(rows(columns).scan(gap + line, |y, row| {
                *y += row;
                Some(*y)
            }))
            .collect();
        let place = |k: u32| [gap + k % columns * across, tops[(k / columns) as usize]];

        let mut sheet = RgbImage::from_pixel(columns * across + gap, tops[(cells / columns) as usize], PAPER);
        font.draw(&mut sheet, [gap, gap / 2], &cut(heading, (columns * across) / font.width(1)), INK);
        for (k, panel) in (0..).zip(&self.panels) {
            let [x, y] = place(k);
            font.draw(&mut sheet, [x, y], &cut(&panel.title, wide / font.width(1)), INK);
            // All parts lie within, by construction.
            let _ = sheet.copy_from(&panel.picture, x, y + line);
            if let Some(legend) = &panel.legend {
                let _ = sheet.copy_from(legend, x, y + line + panel.picture.height());
            }
        }
        let [x, y] = place(cells.saturating_sub(1));
        for ((label, value), y) in figures.iter().zip((y + line..).step_by(line as usize)) {
            font.draw(&mut sheet, [x, y], label, FAINT);
            font.draw(&mut sheet, [x + font.width(LABEL), y], &cut(value, wide / font.width(1) - LABEL), INK);
        }
        sheet
    }
}

/// Width of a picture's place: room for a line of figures at least.
fn cell_width(picture: &RgbImage) -> u32 {
    picture.width().max(Font::of_width(picture.width()).width(COLUMNS))
}

/// The beginning of a text that is too long.
fn cut(text: &str, characters: u32) -> String {
    let characters = characters as usize;
    if text.chars().count() <= characters {
        return text.to_owned();
    }
    text.chars().take(characters.saturating_sub(2)).chain("..".chars()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_size_of_picture_fits() {
        let figures = [("rays".to_owned(), "12".to_owned()), ("a long label".to_owned(), "x".repeat(500))];
        for (width, height) in [(1, 1), (300, 200), (1, 65_536), (65_536, 1), (1024, 1024), (1500, 900)] {
            let picture = RgbImage::from_pixel(width, height, Rgb([255, 0, 255]));
            let mut sheet = Sheet::default();
            for legend in [None, Some(Legend::Levels(10)), Some(Legend::Normals), Some(Legend::Error), None] {
                sheet.add("a picture", &picture, legend);
            }
            let drawn = sheet.draw(&"heading ".repeat(40), &figures);
            let pink = drawn.pixels().filter(|p| p.0 == [255, 0, 255]).count();
            let shown = &sheet.panels[0].picture;
            assert!(pink >= 5 * (shown.width() * shown.height()) as usize, "{width}x{height}");
            assert!(shown.width().max(shown.height()) >= SMALL / 2, "{width}x{height}");
            assert!(drawn.width() < 12_000 && drawn.height() < 12_000, "{width}x{height}: {:?}", drawn.dimensions());
        }
    }
}
