//! The shapes of marks, in pixels around their middle.

use super::fault::{DiagramFault, wrong};
use crate::report::palette::{Mark, Style};
use plotters::coord::CoordTranslate;
use plotters::prelude::*;

/// What is drawn of a mark: a circle, or an outline that can be filled, or lines.
pub(super) struct Shape {
    radius: i32,
    outline: Vec<(i32, i32)>,
    strokes: Vec<Vec<(i32, i32)>>,
}

impl Shape {
    /// The shape of a mark, `r` being its size.
    pub fn of(mark: Mark, r: i32) -> Self {
        let outline = |points: &[(i32, i32)]| Self { radius: 0, outline: points.to_vec(), strokes: Vec::new() };
        let lines =
            |lines: &[[(i32, i32); 2]]| Self { radius: 0, outline: Vec::new(), strokes: lines.iter().map(|line| line.to_vec()).collect() };
        let s = r * 9 / 10;
        match mark {
            Mark::Circle => Self { radius: r, outline: Vec::new(), strokes: Vec::new() },
            Mark::Square => outline(&[(-s, -s), (s, -s), (s, s), (-s, s)]),
            Mark::Triangle => outline(&[(0, -r - 1), (r, s), (-r, s)]),
            Mark::Diamond => outline(&[(0, -r - 2), (r, 0), (0, r + 2), (-r, 0)]),
            Mark::Wye => outline(&[(0, r + 1), (r, -s), (-r, -s)]),
            Mark::Pentagram => outline(&[0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|k: i32| {
                // Ten corners, every second one nearer to the middle.
                let (angle, far) = (f64::from(k) * std::f64::consts::PI / 5.0, f64::from(r) * if k % 2 == 0 { 1.4 } else { 0.6 });
                ((far * angle.sin()).round() as i32, (-far * angle.cos()).round() as i32)
            })),
            Mark::Hourglass => outline(&[(-s, -r), (s, -r), (-s, r), (s, r)]),
            Mark::Bowtie => outline(&[(-r, -s), (r, s), (r, -s), (-r, s)]),
            Mark::Bar => outline(&[(-r - 1, -r / 2), (r + 1, -r / 2), (r + 1, r / 2), (-r - 1, r / 2)]),
            Mark::Post => outline(&[(-r / 2, -r - 1), (r / 2, -r - 1), (r / 2, r + 1), (-r / 2, r + 1)]),
            Mark::Arrow => outline(&[(-r, -r), (r + 1, 0), (-r, r), (-r / 3, 0)]),
            Mark::GreekCross => {
                let (a, b) = (r / 3, r + 1);
                outline(&[(-a, -b), (a, -b), (a, -a), (b, -a), (b, a), (a, a), (a, b), (-a, b), (-a, a), (-b, a), (-b, -a), (-a, -a)])
            }
            Mark::Hexagon => outline(&[0, 1, 2, 3, 4, 5].map(|k: i32| {
                let (angle, far) = (f64::from(k) * std::f64::consts::PI / 3.0, f64::from(r) * 1.1);
                ((far * angle.sin()).round() as i32, (-far * angle.cos()).round() as i32)
            })),
            Mark::Cross => lines(&[[(-r, 0), (r, 0)], [(0, -r), (0, r)]]),
            Mark::Times => lines(&[[(-s, -s), (s, s)], [(-s, s), (s, -s)]]),
            Mark::Star => lines(&[[(-r, 0), (r, 0)], [(-s, -s), (s, s)], [(-s, s), (s, -s)], [(0, -r), (0, r)]]),
        }
    }

    /// Draws it at a place of `area`, moved by pixels: filled, or with paper inside.
    pub fn draw<C: CoordTranslate>(
        &self,
        area: &DrawingArea<SVGBackend<'_>, C>,
        at: C::From,
        by: (i32, i32),
        colour: RGBColor,
        filled: bool,
    ) -> Result<(), DiagramFault>
    where
        C::From: Clone,
    {
        let inside = if filled { colour } else { WHITE };
        let moved = |points: &[(i32, i32)]| points.iter().map(|(x, y)| (x + by.0, y + by.1)).collect::<Vec<_>>();
        if self.radius > 0 {
            for style in [inside.filled(), colour.stroke_width(2)] {
                area.draw(&(EmptyElement::at(at.clone()) + Circle::new(by, self.radius, style))).map_err(wrong)?;
            }
        }
        let closed: Vec<_> = self.outline.iter().chain(self.outline.first()).copied().collect();
        if !closed.is_empty() {
            area.draw(&(EmptyElement::at(at.clone()) + Polygon::new(moved(&self.outline), inside.filled()))).map_err(wrong)?;
        }
        for line in self.strokes.iter().chain((!closed.is_empty()).then_some(&closed)) {
            area.draw(&(EmptyElement::at(at.clone()) + PathElement::new(moved(line), colour.stroke_width(2)))).map_err(wrong)?;
        }
        Ok(())
    }
}

/// A method's colour on paper.
pub(super) fn colour(style: &Style) -> RGBColor {
    let [r, g, b] = style.light;
    RGBColor(r, g, b)
}
