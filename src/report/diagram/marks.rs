//! The shapes of marks, in pixels around their middle.

use crate::report::palette::{Mark, Style};
use plotters::style::RGBColor;

/// What is drawn of a mark: an outline that can be filled, and lines.
pub(super) struct Shape {
    pub outline: Vec<(i32, i32)>,
    pub strokes: Vec<Vec<(i32, i32)>>,
}

/// Steps around a circle.
const AROUND: u32 = 20;

impl Shape {
    /// The shape of a mark, `r` being its size.
    pub fn of(mark: Mark, r: i32) -> Self {
        let outline = |points: &[(i32, i32)]| Self { outline: points.to_vec(), strokes: Vec::new() };
        let lines = |lines: &[[(i32, i32); 2]]| Self { outline: Vec::new(), strokes: lines.iter().map(|line| line.to_vec()).collect() };
        let s = r * 9 / 10;
        let turn = |k: u32| f64::from(k) * std::f64::consts::TAU / f64::from(AROUND);
        let at = |angle: f64| ((f64::from(r) * angle.cos()).round() as i32, (f64::from(r) * angle.sin()).round() as i32);
        match mark {
            Mark::Circle => outline(&(0..AROUND).map(|k| at(turn(k))).collect::<Vec<_>>()),
            Mark::Square => outline(&[(-s, -s), (s, -s), (s, s), (-s, s)]),
            Mark::Triangle => outline(&[(0, -r - 1), (r, s), (-r, s)]),
            Mark::Diamond => outline(&[(0, -r - 2), (r, 0), (0, r + 2), (-r, 0)]),
            Mark::Wye => outline(&[(0, r + 1), (r, -s), (-r, -s)]),
            Mark::Cross => lines(&[[(-r, 0), (r, 0)], [(0, -r), (0, r)]]),
            Mark::Times => lines(&[[(-s, -s), (s, s)], [(-s, s), (s, -s)]]),
            Mark::Star => lines(&[[(-r, 0), (r, 0)], [(-s, -s), (s, s)], [(-s, s), (s, -s)], [(0, -r), (0, r)]]),
        }
    }
}

/// A method's colour on paper.
pub(super) fn colour(style: &Style) -> RGBColor {
    let [r, g, b] = style.light;
    RGBColor(r, g, b)
}
