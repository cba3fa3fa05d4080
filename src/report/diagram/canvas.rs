//! Logarithmic axes on a drawing area, and what all diagrams share.

use super::fault::{DiagramFault, wrong};
use super::marks::Shape;
use plotters::coord::Shift;
use plotters::coord::combinators::LogCoord;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

pub(super) type Drawing = Result<(), DiagramFault>;
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Logarithmic = Cartesian2d<LogCoord<f64>, LogCoord<f64>>;

pub(super) const FONT: &str = "sans-serif";
pub(super) const TEXT: i32 = 13;
const CAPTION: i32 = 17;
const GRID: RGBColor = RGBColor(226, 229, 234);
const AXIS: RGBColor = RGBColor(70, 76, 86);

/// A picture of `size` under a title and a second, smaller line.
pub(super) fn svg(size: (u32, u32), title: [&str; 2], draw: impl FnOnce(&Area<'_>) -> Drawing) -> Result<String, DiagramFault> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE).map_err(wrong)?;
        area.draw(&Text::new(title[0].to_owned(), (14, 10), (FONT, CAPTION))).map_err(wrong)?;
        area.draw(&Text::new(title[1].to_owned(), (14, 33), (FONT, TEXT).into_font().color(&AXIS))).map_err(wrong)?;
        draw(&area.split_vertically(54).1)?;
        area.present().map_err(wrong)?;
    }
    Ok(text)
}

/// Where values lie, with `room` as a factor at both ends; around 1 if there are none.
pub(super) fn range(values: impl Iterator<Item = f64>, room: f64) -> Range<f64> {
    let (low, high) = values.filter(|v| *v > 0.0).fold((f64::INFINITY, 0.0f64), |(low, high), v| (low.min(v), high.max(v)));
    match low <= high {
        false => 0.1..10.0,
        true if low == high => low / 3.0..high * 3.0,
        true => low / room..high * room,
    }
}

/// Values at which an axis has ticks: powers of ten, more between where few are in sight, at most `most`.
pub(super) fn ticks(range: &Range<f64>, most: usize) -> Vec<f64> {
    let (from, to) = (range.start.log10().floor() as i32, range.end.log10().ceil() as i32);
    let of = |factors: &[f64], step: i32| -> Vec<f64> {
        let powers = (from..=to).filter(|power| power % step == 0);
        let all = powers.flat_map(|power| factors.iter().map(move |factor| factor * 10f64.powi(power)));
        all.filter(|v| *v >= range.start * 0.999 && *v <= range.end * 1.001).collect()
    };
    let choices = [of(&[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0], 1), of(&[1.0, 2.0, 3.0, 5.0], 1), of(&[1.0, 2.0, 5.0], 1), of(&[1.0, 3.0], 1)];
    let coarse = [1, 2, 3, 4, 6].map(|step| of(&[1.0], step));
    choices.into_iter().chain(coarse).find(|ticks| ticks.len() <= most).unwrap_or_default()
}

/// A tick's label.
pub(super) fn label(value: f64) -> String {
    if !(1e-3..1e5).contains(&value) {
        return format!("{value:.1e}").replace(".0e", "e");
    }
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Three significant digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 12) as usize; // 0 to 12
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// What an axis shows.
pub(super) struct Axis<'a> {
    pub range: Range<f64>,
    pub name: &'a str,
    /// Its ticks, if they are not chosen by their distance.
    pub ticks: Option<Vec<f64>>,
}

/// A plane of two logarithmic axes.
pub(super) struct Plane<'a> {
    area: DrawingArea<SVGBackend<'a>, Logarithmic>,
}

/// Left, right, top and bottom of a plane, in pixels.
const MARGINS: [u32; 4] = [58, 14, 8, 44];

impl<'a> Plane<'a> {
    /// Draws the axes on `area`.
    pub fn new(area: &Area<'a>, x: &Axis<'_>, y: &Axis<'_>) -> Result<Self, DiagramFault> {
        let (width, height) = area.dim_in_pixel();
        let [left, right, top, bottom] = MARGINS;
        let (columns, rows) = (width.saturating_sub(left + right).max(1), height.saturating_sub(top + bottom).max(1));
        let ends = (left as i32..(left + columns) as i32, top as i32..(top + rows) as i32);
        let spec = Cartesian2d::<LogCoord<f64>, LogCoord<f64>>::new(x.range.clone().log_scale(), y.range.clone().log_scale(), {
            let (origin, _) = area.get_pixel_range();
            (
                origin.start + ends.0.start..origin.start + ends.0.end,
                area.get_pixel_range().1.start + ends.1.end..area.get_pixel_range().1.start + ends.1.start,
            )
        });
        let plane = Self { area: area.apply_coord_spec(spec) };
        let small = (FONT, TEXT - 2).into_font().color(&AXIS);
        for v in x.ticks.clone().unwrap_or_else(|| ticks(&x.range, (columns / 46) as usize)) {
            plane.path(&[(v, y.range.start), (v, y.range.end)], GRID.stroke_width(1))?;
            plane.words(&label(v), (v, y.range.start), (0, 6), small.clone().pos(Pos::new(HPos::Center, VPos::Top)))?;
        }
        for v in y.ticks.clone().unwrap_or_else(|| ticks(&y.range, (rows / 26) as usize)) {
            plane.path(&[(x.range.start, v), (x.range.end, v)], GRID.stroke_width(1))?;
            plane.words(&label(v), (x.range.start, v), (-6, 0), small.clone().pos(Pos::new(HPos::Right, VPos::Center)))?;
        }
        let frame =
            [(x.range.start, y.range.start), (x.range.start, y.range.end), (x.range.end, y.range.end), (x.range.end, y.range.start)];
        plane.path(&[frame[0], frame[1], frame[2], frame[3], frame[0]], AXIS.mix(0.5).stroke_width(1))?;
        let middle = (left as i32 + columns as i32 / 2, height as i32 - 18);
        let named = |text: &str, at: (i32, i32), style: TextStyle<'_>| area.draw(&Text::new(text.to_owned(), at, style)).map_err(wrong);
        named(x.name, middle, small.clone().pos(Pos::new(HPos::Center, VPos::Top)))?;
        let turned = (FONT, TEXT - 2).into_font().transform(FontTransform::Rotate270).color(&AXIS);
        named(y.name, (6, top as i32 + rows as i32 / 2), turned.pos(Pos::new(HPos::Center, VPos::Top)))?;
        Ok(plane)
    }

    /// Where a value is, in pixels.
    pub fn pixel(&self, at: (f64, f64)) -> (i32, i32) {
        self.area.map_coordinate(&at)
    }

    /// A line through points.
    pub fn path(&self, points: &[(f64, f64)], style: impl Into<ShapeStyle>) -> Drawing {
        self.area.draw(&PathElement::new(points.to_vec(), style)).map_err(wrong)
    }

    /// A line of dashes from left to right.
    pub fn dashes(&self, x: &Range<f64>, y: f64, style: ShapeStyle) -> Drawing {
        const DASHES: i32 = 24;
        let at = |k: f64| x.start * (x.end / x.start).powf(k / f64::from(DASHES));
        (0..DASHES).try_for_each(|k| self.path(&[(at(f64::from(k)), y), (at(f64::from(k) + 0.6), y)], style))
    }

    /// A mark: filled, or with paper inside.
    pub fn mark(&self, at: (f64, f64), shape: &Shape, colour: RGBColor, filled: bool) -> Drawing {
        shape.draw(&self.area, at, (0, 0), colour, filled)
    }

    /// Text beside a value.
    pub fn words(&self, text: &str, at: (f64, f64), beside: (i32, i32), style: TextStyle<'_>) -> Drawing {
        self.area.draw(&(EmptyElement::at(at) + Text::new(text.to_owned(), beside, style))).map_err(wrong)
    }
}

/// Text in this colour with its middle where it is drawn.
pub(super) fn centred<'a>(size: i32, colour: &RGBColor) -> TextStyle<'a> {
    (FONT, size).into_font().color(colour).pos(Pos::new(HPos::Center, VPos::Center))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_a_few_ticks_in_any_range() {
        for range in [0.9..1.1, 0.5..64.0, 1e-9..1e12, 3.0..3.1, 1e-3..1.0] {
            let ticks = ticks(&range, 8);
            assert!(ticks.len() <= 8 && ticks.windows(2).all(|pair| pair[0] < pair[1]), "{range:?}: {ticks:?}");
        }
        assert_eq!(ticks(&(0.5..64.0), 8), [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]);
        assert_eq!([1.0, 0.25, 1e-4, 1.5e5, 12.5].map(label), ["1", "0.25", "1e-4", "1.5e5", "12.5"]);
        assert_eq!([0.0, 1234.5, 0.012_345, 9.99].map(short), ["0", "1234", "0.0123", "9.99"]);
        assert_eq!(range([0.0, 2.0].into_iter(), 2.0), 2.0 / 3.0..6.0);
    }
}
