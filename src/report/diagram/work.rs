//! Work-precision diagrams: an error against a cost, small multiples by distance; and both by distance.

use super::canvas::{Axis, FONT, Plane, TEXT, centred, range, short, svg};
use super::distance::{DistanceChart, Line, Spot};
use super::fault::{DiagramFault, wrong};
use super::marks::{Shape, colour};
use crate::method::lod;
use crate::report::error_time::{CostMeasure, ErrorMeasure};
use crate::report::error_time::{Costs, ErrorTime, Point, ViewEntry};
use crate::report::palette;
use plotters::prelude::*;

/// What diagrams are of.
pub(super) struct Of<'a> {
    pub document: &'a ErrorTime,
    pub scene: usize,
    pub machine: usize,
    pub compute: &'a str,
}

/// A point of a diagram.
struct Dot<'a> {
    point: &'a Point,
    view: &'a ViewEntry,
    x: f64,
    y: f64,
}

/// A point with its view, and what it costs on the machine.
type Measured<'a> = (&'a Point, &'a ViewEntry, &'a Costs);

/// Size of a panel, and panels beside each other at most.
const PANEL: (u32, u32) = (320, 270);
const COLUMNS: usize = 4;
const KEYS: u32 = 30;
const MARK: i32 = 4;
/// Errors so small beside the largest are rounding, and stand with those that are none.
const ROUNDING: f64 = 1e-5;

impl<'a> Of<'a> {
    fn costs(&self, point: &'a Point) -> Option<&'a Costs> {
        point.costs.iter().find(|costs| costs.machine == self.machine && costs.compute == self.compute)
    }

    /// Points of the scene on the machine, with the fewest samples.
    fn points(&self) -> Vec<Measured<'a>> {
        let views = &self.document.views;
        let of_scene = self.document.points.iter().filter(|point| views[point.view].scene == self.scene);
        let all: Vec<_> = of_scene.filter_map(|point| Some((point, &views[point.view], self.costs(point)?))).collect();
        let fewest = all.iter().map(|(point, ..)| point.samples).min();
        all.into_iter().filter(|(point, ..)| Some(point.samples) == fewest).collect()
    }

    fn cost_name(&self, cost: &CostMeasure) -> String {
        let unit = || self.points().first().map(|(.., costs)| costs.energy.unit.clone()).unwrap_or_default();
        if cost.is_energy { format!("{}, {}", cost.name, unit()) } else { cost.name.to_owned() }
    }

    fn subtitle(&self) -> String {
        let samples = self.points().first().map_or(1, |(point, ..)| point.samples);
        let size = self.document.sizes_in_words(Some(self.scene));
        let (scene, machine) = (&self.document.scenes[self.scene].name, self.document.machines[self.machine].title());
        format!("{scene}, {size}, samples per pixel: {samples}; {machine}, compute {}", self.compute)
    }

    /// An error against a cost, a panel for each distance; none where it was not measured.
    pub fn work(&self, error: &ErrorMeasure, cost: &CostMeasure) -> Result<Option<String>, DiagramFault> {
        let dot = |(point, view, costs): (&'a Point, &'a ViewEntry, &'a Costs)| {
            Some(Dot { point, view, x: (cost.of)(point, costs)?, y: (error.of)(point)? }).filter(|dot| dot.x > 0.0)
        };
        let dots: Vec<_> = self.points().into_iter().filter_map(dot).collect();
        let mut distances: Vec<f64> = dots.iter().map(|dot| dot.view.distance).collect();
        distances.sort_by(f64::total_cmp);
        distances.dedup();
        if dots.is_empty() {
            return Ok(None);
        }
        let columns = distances.len().min(COLUMNS);
        let rows = distances.len().div_ceil(columns);
        let mut methods: Vec<&str> = Vec::new();
        for dot in &dots {
            if !methods.contains(&dot.point.method.as_str()) {
                methods.push(&dot.point.method);
            }
        }
        let width = PANEL.0 * columns.max(2) as u32; // a few panels
        let keys_at = Keys::new(width as i32, &methods);
        let key_rows = KEYS * keys_at.rows();
        let size = (width, 54 + key_rows + PANEL.1 * rows as u32);
        let title = format!("{}, against {}", capital(error.name), without_unit(cost.name));
        let shifts = dots.iter().filter_map(|dot| error.of_shift(dot.view, dot.point.samples));
        let least = ROUNDING * dots.iter().map(|dot| dot.y).fold(0.0, f64::max);
        // The same for all panels: they are compared.
        let shared = range(dots.iter().map(|dot| dot.y).filter(|y| *y > least).chain(shifts), 1.6);
        let drawing = svg(size, [&title, &self.subtitle()], |area| {
            let (keys, panels) = area.split_vertically(key_rows);
            for (method, &(left, top)) in methods.iter().zip(&keys_at.places) {
                let style = palette::of(method);
                let (colour, shape) = (colour(&style), Shape::of(style.mark, MARK));
                shape.draw(&keys, (left + 6, top + 12), (0, 0), colour, true)?;
                keys.draw(&Text::new((*method).to_owned(), (left + 18, top + 5), (FONT, TEXT))).map_err(wrong)?;
            }
            let (left, top) = keys_at.more;
            keys.draw(&Text::new(MORE.to_owned(), (left, top + 6), (FONT, TEXT - 2))).map_err(wrong)?;
            for (panel, &distance) in panels.split_evenly((rows, columns)).iter().zip(&distances) {
                let here: Vec<_> = dots.iter().filter(|dot| dot.view.distance == distance).collect();
                let x = Axis { range: range(here.iter().map(|dot| dot.x), 1.5), name: &self.cost_name(cost), ticks: None };
                let floor = shared.start / 1.5;
                let has_exact = dots.iter().any(|dot| dot.y <= least);
                let y = Axis { range: if has_exact { floor / 1.4..shared.end } else { shared.clone() }, name: error.name, ticks: None };
                let (caption, plot) = panel.split_vertically(20);
                caption.draw(&Text::new(format!("from {} radii", short(distance)), (58, 2), (FONT, TEXT))).map_err(wrong)?;
                let plane = Plane::new(&plot, &x, &y)?;
                let shift = here.iter().find_map(|dot| error.of_shift(dot.view, dot.point.samples)).filter(|shift| *shift > 0.0);
                self.panel(&plane, &here, &methods, &x, [least, floor], shift)?;
            }
            Ok(())
        })?;
        Ok(Some(drawing))
    }

    fn panel(
        &self,
        plane: &Plane<'_>,
        here: &[&Dot<'_>],
        methods: &[&str],
        x: &Axis<'_>,
        [least, floor]: [f64; 2],
        shift: Option<f64>,
    ) -> Result<(), DiagramFault> {
        let at = |dot: &Dot<'_>| (dot.x, if dot.y > least { dot.y } else { floor });
        let front = front(here);
        let mut steps: Vec<(f64, f64)> = Vec::new();
        for &k in &front {
            let to = at(here[k]);
            steps.extend(steps.last().map(|before| (to.0, before.1)));
            steps.push(to);
        }
        plane.path(&steps, RGBColor(120, 126, 136).mix(0.28).stroke_width(7))?;
        if let Some(shift) = shift {
            plane.dashes(&x.range, shift, BLACK.mix(0.6).stroke_width(1))?;
        }
        if here.iter().any(|dot| dot.y <= least) {
            plane.words("no error", (x.range.start, floor), (26, -9), centred(TEXT - 3, &RGBColor(90, 96, 106)))?;
        }
        for method in methods {
            let style = palette::of(method);
            let (colour, shape) = (colour(&style), Shape::of(style.mark, MARK));
            let mut own: Vec<_> = here.iter().enumerate().filter(|(_, dot)| dot.point.method == *method).collect();
            own.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
            plane.path(&own.iter().map(|(_, dot)| at(dot)).collect::<Vec<_>>(), colour.mix(0.7).stroke_width(1))?;
            for (k, dot) in own {
                plane.mark(at(dot), &shape, colour, front.contains(&k))?;
                if let Some(delta) = dot.point.knobs.get("delta").filter(|_| *method == lod::METHOD.name) {
                    plane.words(&knob(delta), at(dot), (0, -11), centred(TEXT - 4, &RGBColor(60, 66, 76)))?;
                }
            }
        }
        Ok(())
    }

    /// A cost by distance, with the gain over the full-resolution BVH.
    pub fn costs_by_distance(&self, cost: &CostMeasure) -> Result<Option<String>, DiagramFault> {
        let value = |point: &Point, costs: &Costs| (cost.of)(point, costs);
        self.by_distance(&self.cost_name(cost), &value, true)
    }

    /// An error by distance.
    pub fn errors_by_distance(&self, error: &ErrorMeasure) -> Result<Option<String>, DiagramFault> {
        self.by_distance(error.name, &|point, _| (error.of)(point), false)
    }

    fn by_distance(&self, name: &str, value: &dyn Fn(&Point, &Costs) -> Option<f64>, gains: bool) -> Result<Option<String>, DiagramFault> {
        let mut lines: Vec<Line> = Vec::new();
        for (point, view, costs) in one_of_each(self.points()) {
            let Some(y) = value(point, costs) else { continue };
            let at = lines.iter().position(|line| line.method == point.method).unwrap_or_else(|| {
                lines.push(Line { method: point.method.clone(), name: point.method.clone(), spots: Vec::new() });
                lines.len() - 1
            });
            lines[at].spots.push(Spot { x: view.distance, y, gain: None });
        }
        for line in &mut lines {
            line.spots.sort_by(|a, b| a.x.total_cmp(&b.x));
            if line.method == lod::METHOD.name {
                line.name += ", delta 1";
            } else if self.document.methods.iter().any(|method| method.name == line.method && method.knob.is_some()) {
                line.name += ", as far off";
            }
        }
        let lines = if gains { with_gains(lines) } else { lines };
        let x = "distance of the eye, bounding radii".to_owned();
        DistanceChart {
            title: format!("{}, by distance", capital(if gains { without_unit(name) } else { name })),
            subtitle: self.subtitle(),
            x,
            y: name.to_owned(),
            lines,
        }
        .svg()
    }
}

/// Of each view one setting of each method: ours at quality 1, and the one of any other whose surface is as far off as that, as nearly as it can be.
fn one_of_each(points: Vec<Measured<'_>>) -> Vec<Measured<'_>> {
    let off = |point: &Point| point.geometry.surface.map_or(0.0, |surface| surface.percentile_99);
    let is_ours = |point: &Point| point.method == lod::METHOD.name;
    let ours = |view: usize| points.iter().find(|(p, ..)| p.view == view && is_ours(p) && p.setting == "delta 1").map(|(p, ..)| off(p));
    let apart = |point: &Point| match ours(point.view) {
        Some(_) if is_ours(point) => f64::from(u8::from(point.setting != "delta 1")),
        // Full resolution has no error.
        Some(own) => (off(point).max(1e-6) / own.max(1e-6)).ln().abs(),
        None => 0.0,
    };
    let mut chosen: Vec<Measured<'_>> = Vec::new();
    for &measured in &points {
        let (point, ..) = measured;
        match chosen.iter_mut().find(|(before, ..)| before.view == point.view && before.method == point.method) {
            None => chosen.push(measured),
            Some(before) if apart(point) < apart(before.0) => *before = measured,
            Some(_) => {}
        }
    }
    chosen
}

/// With how much less each is than the full-resolution BVH.
fn with_gains(mut lines: Vec<Line>) -> Vec<Line> {
    let base = lines.iter().find(|line| line.method == crate::method::bvh::METHOD.name).map(|line| line.spots.clone()).unwrap_or_default();
    for line in lines.iter_mut().filter(|line| line.method != crate::method::bvh::METHOD.name) {
        for spot in &mut line.spots {
            spot.gain = base.iter().find(|other| other.x == spot.x && spot.y > 0.0).map(|other| other.y / spot.y);
        }
    }
    lines
}

/// What the legend says beside its marks.
const MORE: &str = "filled: on the front (grey); number: delta; dashed: camera shifted by half a pixel";

/// Where the keys of a legend lie, in rows that are no wider than the picture.
struct Keys {
    places: Vec<(i32, i32)>,
    /// Where the words lie.
    more: (i32, i32),
}

impl Keys {
    fn new(width: i32, methods: &[&str]) -> Self {
        let (mut left, mut top) = (14, 0);
        let mut next = |own: i32| {
            if left > 14 && left + own > width {
                (left, top) = (14, top + KEYS as i32);
            }
            let at = (left, top);
            left += own;
            at
        };
        // A short name, and words in small letters.
        let places = methods.iter().map(|method| next(46 + 8 * method.chars().count() as i32)).collect();
        Self { places, more: next(5 * MORE.chars().count() as i32) }
    }

    fn rows(&self) -> u32 {
        self.more.1 as u32 / KEYS + 1
    }
}

/// Those that no other beats, by cost.
fn front(dots: &[&Dot<'_>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..dots.len()).collect();
    order.sort_by(|&a, &b| dots[a].x.total_cmp(&dots[b].x).then(dots[a].y.total_cmp(&dots[b].y)));
    let mut best = f64::INFINITY;
    order.retain(|&k| {
        let better = dots[k].y < best;
        best = best.min(dots[k].y);
        better
    });
    order
}

/// A quality in few characters.
fn knob(delta: &str) -> String {
    match delta.parse::<f64>() {
        Ok(v) if v > 0.0 && v < 1.0 && (1.0 / v).fract() == 0.0 => format!("1/{}", 1.0 / v),
        _ => delta.to_owned(),
    }
}

/// A cost's name without what it is in.
fn without_unit(name: &str) -> &str {
    name.split(", ").next().unwrap_or(name)
}

fn capital(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}
