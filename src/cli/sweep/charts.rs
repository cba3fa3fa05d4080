//! Charts of a sweep: energy and time of a scene on a machine. Of several distances they are lines on logarithmic axes, with the gain over the full-resolution BVH
//! written at each point; of one, bars of its methods side by side; of one view with one method, bars of its machines.

use super::labels::{Setting, labels};
use crate::cli::simulate::plots::{COLOURS, FONT, LEGEND, TEXT, energy_unit, legend, svg, tick, time_unit, top, wrong};
use lodray::method::bvh;
use lodray::report::diagram::{DistanceChart, Line, Spot};
use lodray::report::plain_name;
use lodray::report::result::SimResult;
use lodray::study::Row;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Columns of a bar at least, of a character of its name, and of the gap between two groups.
const BAR: u32 = 38;
const CHARACTER: u32 = 7;
const GAP: u32 = 26;
/// Time is of no part of the machine.
const TIME: RGBColor = RGBColor(70, 76, 86);

/// A bar: its name, and its parts from the bottom up.
struct Bar {
    name: String,
    parts: Vec<f64>,
}

/// The bars of a view, and its name in lines.
struct Group {
    name: Vec<String>,
    bars: Vec<Bar>,
}

/// What a chart shows of a scene.
struct Subject<'a> {
    scene: &'a str,
    /// What is the same for all its bars, for the file's name and for the title.
    common: String,
    title: String,
    results: Vec<&'a SimResult>,
    /// What may tell its bars apart.
    settings: &'static [Setting],
}

/// A scene's results, by machine.
type ByMachine<'a> = Vec<(String, Vec<&'a SimResult>)>;

/// File name and contents of every chart. What has one bar only has no chart, and neither has what is 0 everywhere.
pub fn charts<'a>(rows: impl Iterator<Item = &'a Row>) -> anyhow::Result<Vec<(String, String)>> {
    // By scene, then by machine, in the order of the list.
    let mut scenes: Vec<(&str, ByMachine<'_>)> = Vec::new();
    for (row, result) in rows.filter_map(|row| Some((row, row.result.as_ref()?))) {
        let machine = format!("{}, compute {}", result.setup.machine.title(), result.setup.compute.name());
        entry(entry(&mut scenes, row.scene.as_str()), machine).push(result);
    }
    let mut files: Vec<(String, String)> = Vec::new();
    for (scene, machines) in scenes {
        let subjects: Vec<_> = if machines.iter().all(|(_, results)| results.len() == 1) {
            // Energies in different units have no axis in common.
            let mut by_unit: Vec<(&str, Vec<&SimResult>)> = Vec::new();
            machines.iter().flat_map(|(_, results)| results).for_each(|r| entry(&mut by_unit, r.energy.unit.as_str()).push(r));
            by_unit.into_iter().map(|(_, results)| Subject::machines(scene, results)).collect()
        } else {
            let of =
                |(common, results): (String, _)| Subject { scene, title: common.clone(), common, results, settings: Setting::OF_METHODS };
            machines.into_iter().map(of).collect()
        };
        for subject in subjects.iter().filter(|subject| subject.results.len() > 1) {
            for (what, chart) in subject.charts()? {
                files.push((unused(&files, &format!("{what}-{scene}-{}", subject.common)), chart));
            }
        }
    }
    Ok(files)
}

/// What stands under `key`, at the end if it is new.
fn entry<K: PartialEq, V: Default>(entries: &mut Vec<(K, V)>, key: K) -> &mut V {
    let at = entries.iter().position(|entry| entry.0 == key).unwrap_or_else(|| {
        entries.push((key, V::default()));
        entries.len() - 1
    });
    &mut entries[at].1
}

/// A file name that is not among `files`, from any text.
fn unused(files: &[(String, String)], text: &str) -> String {
    let plain = plain_name(text);
    let names = std::iter::once(format!("{plain}.svg")).chain((2..).map(|k| format!("{plain}-{k}.svg")));
    names.into_iter().find(|name| files.iter().all(|file| file.0 != *name)).unwrap_or_default()
}

impl<'a> Subject<'a> {
    /// Of one view with one method on several machines.
    fn machines(scene: &'a str, results: Vec<&'a SimResult>) -> Self {
        let same = |of: &dyn Fn(&SimResult) -> String| {
            let first = of(results[0]);
            results.iter().all(|r| of(r) == first).then_some(first)
        };
        let common = same(&|r| r.setup.machine.title()).or_else(|| same(&|r| r.setup.machine.label.clone()));
        let common = common.unwrap_or_else(|| "machines".to_owned());
        let method = labels(&results[..1], Setting::OF_METHODS).concat();
        let quality = results[0].setup.method.delta.map_or_else(String::new, |delta| format!(" at delta {delta}"));
        Self { scene, title: format!("{common}, {method}{quality}"), common, results, settings: Setting::OF_MACHINES }
    }

    /// What is drawn, and the drawing.
    fn charts(&self) -> anyhow::Result<Vec<(&'static str, String)>> {
        let first = self.results[0];
        let (energy, time) = (|r: &SimResult| r.energy.total, |r: &SimResult| r.milliseconds);
        let most = |of: fn(&SimResult) -> f64| self.results.iter().map(|r| of(r)).fold(0.0, f64::max);
        let mut charts = Vec::new();
        if most(energy) > 0.0 {
            let unit = energy_unit(&first.energy.unit, most(energy));
            if let Some(lines) = self.lines("Energy", &format!("energy, {}", unit.name), &|r| energy(r) / unit.size)? {
                charts.push(("energy", lines));
            } else {
                let parts: Vec<_> = first.energy.split().into_iter().zip(COLOURS).map(|((name, _), colour)| (name, colour)).collect();
                let groups = self.groups(|r| r.energy.split().map(|part| part.1 / unit.size).to_vec());
                charts.push(("energy", self.chart("Energy", &groups, &parts, &format!("energy, {}", unit.name))?));
            }
        }
        if most(time) > 0.0 {
            let unit = time_unit(most(time));
            if let Some(lines) = self.lines("Time", &format!("time, {}", unit.name), &|r| time(r) / unit.size)? {
                charts.push(("time", lines));
            } else {
                let groups = self.groups(|r| vec![r.milliseconds / unit.size]);
                charts.push(("time", self.chart("Time", &groups, &[("time", TIME)], &format!("time, {}", unit.name))?));
            }
        }
        Ok(charts)
    }

    /// Lines by distance, if there are several distances, and one result of each method and setting at each.
    fn lines(&self, what: &str, value_name: &str, value: &dyn Fn(&SimResult) -> f64) -> anyhow::Result<Option<String>> {
        let mut lines: Vec<Line> = Vec::new();
        for (result, name) in self.results.iter().zip(labels(&self.results, Setting::OF_LINES)) {
            let at = lines.iter().position(|line| line.name == name).unwrap_or_else(|| {
                lines.push(Line { method: result.setup.method.name.clone(), name, spots: Vec::new() });
                lines.len() - 1
            });
            let spots = &mut lines[at].spots;
            let x = distance(result);
            if spots.iter().any(|spot| spot.x == x) || x <= 0.0 {
                return Ok(None);
            }
            spots.push(Spot { x, y: value(result), gain: None });
        }
        if lines.iter().all(|line| line.spots.len() < 2) {
            return Ok(None);
        }
        lines.iter_mut().for_each(|line| line.spots.sort_by(|a, b| a.x.total_cmp(&b.x)));
        let is_base = |line: &Line| line.method == bvh::METHOD.name;
        let base = lines.iter().find(|line| is_base(line)).map(|line| line.spots.clone()).unwrap_or_default();
        for spot in lines.iter_mut().filter(|line| !is_base(line)).flat_map(|line| &mut line.spots) {
            spot.gain = base.iter().find(|other| other.x == spot.x && spot.y > 0.0).map(|other| other.y / spot.y);
        }
        let in_radii = self.results.iter().all(|r| r.setup.view.as_ref().is_some_and(|view| view.distance.is_some()));
        let x = if in_radii { "distance of the eye, bounding radii" } else { "distance of the eye" };
        let title = format!("{what} of a frame: {}", self.scene);
        let subtitle = if base.is_empty() { self.title.clone() } else { format!("{}; at each point the gain over bvh", self.title) };
        Ok(DistanceChart { title, subtitle, x: x.to_owned(), y: value_name.to_owned(), lines }.svg()?)
    }

    fn groups(&self, parts: impl Fn(&SimResult) -> Vec<f64>) -> Vec<Group> {
        let mut groups: Vec<(&SimResult, Vec<Bar>)> = Vec::new();
        for (result, name) in self.results.iter().zip(labels(&self.results, self.settings)) {
            let bar = Bar { name, parts: parts(result) };
            match groups.last_mut().filter(|(first, _)| first.setup.view == result.setup.view) {
                Some((_, others)) => others.push(bar),
                None => groups.push((result, vec![bar])),
            }
        }
        let places: Vec<_> = groups.iter().map(|(first, _)| place(first)).collect();
        let name = |(k, (first, bars)): (usize, (&SimResult, Vec<Bar>))| {
            let eye = eye(first).map(short).join(", ");
            let is_alone = places.iter().filter(|place| **place == places[k]).count() == 1;
            Group { name: std::iter::once(places[k].clone()).chain((!is_alone).then(|| format!("eye {eye}"))).collect(), bars }
        };
        groups.into_iter().enumerate().map(name).collect()
    }

    fn chart(&self, what: &str, groups: &[Group], parts: &[(&str, RGBColor)], unit: &str) -> anyhow::Result<String> {
        let title = [format!("{what} of a frame: {}", self.scene), self.title.clone()];
        let characters = |text: &str| text.chars().count() as u32; // short
        let bar = groups.iter().flat_map(|group| &group.bars).map(|bar| CHARACTER * characters(&bar.name)).max().unwrap_or(0).max(BAR);
        // A group is as wide as its bars or its name.
        let widths = groups.iter().map(|group| {
            let name = group.name.iter().map(|line| characters(line)).max().unwrap_or(0);
            (bar * group.bars.len() as u32).max((CHARACTER + 1) * name)
        });
        let widths: Vec<u32> = widths.collect();
        let width = widths.iter().sum::<u32>() + GAP * groups.len() as u32;
        let lines = groups.iter().map(|group| group.name.len()).max().unwrap_or(1) as u32;
        let most = top(groups.iter().flat_map(|group| &group.bars).map(|bar| bar.parts.iter().sum()));
        svg((LEGEND + 110 + width.max(320), 460 + 18 * lines), &title, |area| {
            let (plot, names) = area.split_horizontally(area.dim_in_pixel().0 - LEGEND);
            let mut chart = ChartBuilder::on(&plot)
                .margin(10)
                .x_label_area_size(52 + 18 * lines)
                .y_label_area_size(84)
                .build_cartesian_2d(0.0..f64::from(width), 0.0..most)
                .map_err(wrong)?;
            let mut mesh = chart.configure_mesh();
            mesh.disable_x_mesh().light_line_style(TRANSPARENT).x_labels(0).y_label_formatter(&tick);
            mesh.y_desc(unit).x_desc("distance of the eye").label_style((FONT, TEXT)).draw().map_err(wrong)?;
            let small = (FONT, TEXT - 3).into_text_style(&plot).pos(Pos::new(HPos::Center, VPos::Top));
            let large = (FONT, TEXT).into_text_style(&plot).pos(Pos::new(HPos::Center, VPos::Top));
            let mut begin = f64::from(GAP) / 2.0;
            for (group, width) in groups.iter().zip(&widths) {
                let middle = begin + f64::from(*width) / 2.0;
                let mut left = middle - f64::from(bar * group.bars.len() as u32) / 2.0;
                for Bar { name, parts: values } in &group.bars {
                    let mut base = 0.0;
                    for (part, (_, colour)) in values.iter().zip(parts) {
                        let corners = [(left + 3.0, base), (left + f64::from(bar) - 3.0, base + part)];
                        chart.plotting_area().draw(&Rectangle::new(corners, colour.filled())).map_err(wrong)?;
                        base += part;
                    }
                    let name = Text::new(name.clone(), (0, 6), small.clone());
                    chart.plotting_area().draw(&(EmptyElement::at((left + f64::from(bar) / 2.0, 0.0)) + name)).map_err(wrong)?;
                    left += f64::from(bar);
                }
                for (line, below) in group.name.iter().zip((22..).step_by(18)) {
                    let name = Text::new(line.clone(), (0, below), large.clone());
                    chart.plotting_area().draw(&(EmptyElement::at((middle, 0.0)) + name)).map_err(wrong)?;
                }
                begin += f64::from(*width + GAP);
            }
            if parts.len() > 1 {
                legend(&names, &parts.iter().rev().copied().collect::<Vec<_>>())?;
            }
            Ok(())
        })
    }
}

/// The eye; a sweep's rays are cameras'.
fn eye(r: &SimResult) -> [f64; 3] {
    r.setup.view.as_ref().map_or([0.0; 3], |view| view.eye)
}

/// How far the eye is: in bounding radii from the target, if it was placed so, or from the origin.
fn distance(r: &SimResult) -> f64 {
    let to_origin = || eye(r).iter().map(|v| v * v).sum::<f64>().sqrt();
    r.setup.view.as_ref().and_then(|view| view.distance).unwrap_or_else(to_origin)
}

/// Where a view is from.
fn place(r: &SimResult) -> String {
    let in_radii = r.setup.view.as_ref().and_then(|view| view.distance);
    in_radii.map_or_else(|| short(distance(r)), |distance| format!("{distance} radii"))
}

/// Two decimals at most.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}
