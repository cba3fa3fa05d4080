//! A cost or an error by distance: lines on logarithmic axes, one colour and mark a method, and the gain over the full-resolution BVH at each point.

use super::canvas::{Axis, FONT, Plane, TEXT, centred, range, svg};
use super::fault::{DiagramFault, wrong};
use super::marks::{Shape, colour};
use crate::report::palette;
use plotters::prelude::*;

/// A value at a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The distance.
    pub x: f64,
    /// The value; what is 0 is not drawn.
    pub y: f64,
    /// How much less it is than the full-resolution BVH's, if that is to be said.
    pub gain: Option<f64>,
}

/// The values of a method with one setting.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Name of the method: its colour and mark.
    pub method: String,
    /// What the legend says.
    pub name: String,
    /// In order of distance.
    pub spots: Vec<Spot>,
}

/// What a chart shows.
#[derive(Clone, Debug, PartialEq)]
pub struct DistanceChart {
    /// Its title.
    pub title: String,
    /// A second line: of what.
    pub subtitle: String,
    /// Name of the distance.
    pub x: String,
    /// Name of the value.
    pub y: String,
    /// By method.
    pub lines: Vec<Line>,
}

/// A gain, as it is written at a point.
pub fn gain(value: f64) -> String {
    match value {
        v if v >= 9.95 => format!("{v:.0}\u{d7}"),
        v if v >= 0.995 => format!("{v:.1}\u{d7}"),
        v => format!("{v:.2}\u{d7}"),
    }
}

const SIZE: (u32, u32) = (860, 520);
const LEGEND: u32 = 190;
const MARK: i32 = 5;
/// Dashes of lines of one method with other settings, the first being whole.
const FAINTER: f64 = 0.72;

/// A rectangle: left, top, right, bottom.
type Rect = [i32; 4];

fn meet(a: &Rect, b: &Rect) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

impl DistanceChart {
    /// As SVG; none if nothing is above 0.
    ///
    /// # Errors
    /// What the plotting library says.
    pub fn svg(&self) -> Result<Option<String>, DiagramFault> {
        let spots = || self.lines.iter().flat_map(|line| &line.spots).filter(|spot| spot.y > 0.0 && spot.x > 0.0);
        if spots().next().is_none() {
            return Ok(None);
        }
        let mut at: Vec<f64> = spots().map(|spot| spot.x).collect();
        at.sort_by(f64::total_cmp);
        // The labels of places that are nearer than that would lie upon each other.
        at.dedup_by(|a, b| (*a / *b - 1.0).abs() < 0.05);
        let ticks = (at.len() <= 12).then(|| at.iter().map(|v| (v * 100.0).round() / 100.0).collect());
        let x = Axis { range: range(spots().map(|spot| spot.x), 1.3), name: &self.x, ticks };
        let y = Axis { range: range(spots().map(|spot| spot.y), 2.2), name: &self.y, ticks: None };
        let height = SIZE.1.max(90 + 22 * self.lines.len() as u32); // a line of the legend each
        svg((SIZE.0, height), [&self.title, &self.subtitle], |area| {
            let (plot, legend) = area.split_horizontally(SIZE.0 - LEGEND);
            let plane = Plane::new(&plot, &x, &y)?;
            let mut taken: Vec<Rect> = Vec::new();
            for (k, line) in self.lines.iter().enumerate() {
                let style = palette::of(&line.method);
                let (colour, shape) = (colour(&style), Shape::of(style.mark, MARK));
                let again = self.lines[..k].iter().filter(|before| before.method == line.method).count() as i32;
                let points: Vec<_> = line.spots.iter().filter(|spot| spot.y > 0.0).map(|spot| (spot.x, spot.y)).collect();
                plane.path(&points, colour.mix(FAINTER.powi(again)).stroke_width(2))?;
                for &point in &points {
                    plane.mark(point, &shape, colour, again == 0)?;
                    let (px, py) = plane.pixel(point);
                    taken.push([px - MARK, py - MARK, px + MARK, py + MARK]);
                }
                let row = 22 * k as i32; // a few lines
                let middle = (12, 14 + row);
                legend.draw(&PathElement::new(vec![(2, middle.1), (22, middle.1)], colour.stroke_width(2))).map_err(wrong)?;
                shape.draw(&legend, middle, (0, 0), colour, again == 0)?;
                let name = Text::new(line.name.clone(), (28, middle.1 - 7), (FONT, TEXT));
                legend.draw(&name).map_err(wrong)?;
            }
            // Behind all marks; where there is no room above a point or below it, its gain is left out. In the order of the lines.
            for line in &self.lines {
                let style = palette::of(&line.method);
                let text = centred(TEXT - 1, &colour(&style)).clone();
                for spot in line.spots.iter().filter(|spot| spot.y > 0.0) {
                    let Some(words) = spot.gain.map(gain) else { continue };
                    let (px, py) = plane.pixel((spot.x, spot.y));
                    let half = 4 * words.chars().count() as i32; // a few characters
                    let own = [px - MARK, py - MARK, px + MARK, py + MARK];
                    let place = [-14, 15].into_iter().map(|dy| (dy, [px - half, py + dy - 7, px + half, py + dy + 7]));
                    let free = place.into_iter().find(|(_, rect)| !taken.iter().any(|other| *other != own && meet(other, rect)));
                    if let Some((dy, rect)) = free {
                        taken.push(rect);
                        plane.words(&words, (spot.x, spot.y), (0, dy), text.clone())?;
                    }
                }
            }
            Ok(())
        })
        .map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_have_marks_and_gains_and_nothing_is_no_chart() {
        let spot = |x, y, gain| Spot { x, y, gain };
        let line = |method: &str, spots| Line { method: method.to_owned(), name: method.to_owned(), spots };
        let chart = DistanceChart {
            title: "Time".to_owned(),
            subtitle: "of a frame".to_owned(),
            x: "distance".to_owned(),
            y: "time, ms".to_owned(),
            lines: vec![
                line("lod", vec![spot(1.0, 2.0, Some(4.0)), spot(2.0, 1.0, Some(0.5))]),
                line("bvh", vec![spot(1.0, 8.0, None), spot(2.0, 0.5, None)]),
            ],
        };
        let svg = chart.svg().unwrap().unwrap();
        for words in ["4.0\u{d7}", "0.50\u{d7}", "lod", "bvh", "distance", "time, ms"] {
            assert!(svg.lines().any(|line| line == words), "{words}: {svg}");
        }
        assert_eq!(DistanceChart { lines: vec![line("lod", vec![spot(1.0, 0.0, None)])], ..chart }.svg().unwrap(), None);
        assert_eq!([12.34, 1.0, 0.994].map(gain), ["12\u{d7}", "1.0\u{d7}", "0.99\u{d7}"]);
    }
}
