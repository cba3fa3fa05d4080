//! Charts of a sweep: energy and time of a scene's views on a machine, its methods side by side.

use super::rows::Row;
use crate::cli::simulate::plots::{COLOURS, FONT, LEGEND, TEXT, legend, svg, tick, top, wrong};
use lodray::report::result::SimResult;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::collections::BTreeMap;

/// Columns of a bar and of the gap between two views.
const BAR: u32 = 38;
const GAP: u32 = 26;
const TIME: RGBColor = RGBColor(68, 119, 170);

/// A bar: its name, and its parts from the bottom up.
struct Bar {
    name: String,
    parts: Vec<f64>,
}

/// The bars of a view.
struct Group {
    name: String,
    bars: Vec<Bar>,
}

/// File name and contents of every chart; a scene and machine with one view only have none.
pub fn charts<'a>(rows: impl Iterator<Item = &'a Row>) -> anyhow::Result<Vec<(String, String)>> {
    // Rows come scene by scene, view by view.
    let mut sets: BTreeMap<(String, String), Vec<&SimResult>> = BTreeMap::new();
    for (row, result) in rows.filter_map(|row| Some((row, row.result.as_ref()?))) {
        let machine = format!("{}, compute {}", result.setup.machine.title(), result.setup.compute.name());
        sets.entry((row.scene.clone(), machine)).or_default().push(result);
    }
    let mut files = Vec::new();
    for ((scene, machine), results) in sets {
        let mut names: Vec<(&SimResult, Vec<&SimResult>)> = Vec::new();
        for result in results {
            match names.last_mut().filter(|(first, _)| first.setup.view == result.setup.view) {
                Some((_, others)) => others.push(result),
                None => names.push((result, vec![result])),
            }
        }
        if names.len() < 2 {
            continue;
        }
        let unit = names[0].0.energy.unit.replace("uJ", "µJ");
        let groups = |parts: &dyn Fn(&SimResult) -> Vec<f64>| -> Vec<Group> {
            let bar = |r: &&SimResult| Bar { name: r.setup.method.name.clone(), parts: parts(r) };
            names.iter().map(|(first, all)| Group { name: place(first), bars: all.iter().map(bar).collect() }).collect()
        };
        let energies = groups(&|r| r.energy.split().map(|part| part.1).to_vec());
        let times = groups(&|r| vec![r.milliseconds]);
        let parts: Vec<_> = names[0].0.energy.split().into_iter().zip(COLOURS).map(|((name, _), colour)| (name, colour)).collect();
        let file = |what: &str| {
            let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' };
            let name: String = format!("{what}-{scene}-{machine}").chars().map(plain).collect();
            name.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-") + ".svg"
        };
        let title = |what: &str| vec![format!("{what} of a frame: {scene}"), machine.clone()];
        files.push((file("energy"), chart(&title("Energy"), &energies, &parts, &format!("energy, {unit}"))?));
        files.push((file("time"), chart(&title("Time"), &times, &[("time", TIME)], "time, ms")?));
    }
    Ok(files)
}

/// Where a view is from.
fn place(r: &SimResult) -> String {
    let view = &r.setup.view;
    let to_origin = || view.eye.iter().map(|v| v * v).sum::<f64>().sqrt();
    view.distance.map_or_else(|| format!("{:.2}", to_origin()), |distance| format!("{distance} radii"))
}

fn chart(title: &[String], groups: &[Group], parts: &[(&str, RGBColor)], unit: &str) -> anyhow::Result<String> {
    let bars: usize = groups.iter().map(|group| group.bars.len()).sum();
    // Few: a sweep's views and methods.
    let width = BAR * bars as u32 + GAP * groups.len() as u32;
    let most = top(groups.iter().flat_map(|group| &group.bars).map(|bar| bar.parts.iter().sum()));
    svg((LEGEND + 110 + width.max(320), 480), title, |area| {
        let (plot, names) = area.split_horizontally(area.dim_in_pixel().0 - LEGEND);
        let mut chart = ChartBuilder::on(&plot)
            .margin(10)
            .x_label_area_size(70)
            .y_label_area_size(84)
            .build_cartesian_2d(0.0..f64::from(width), 0.0..most)
            .map_err(wrong)?;
        let mut mesh = chart.configure_mesh();
        mesh.disable_x_mesh().light_line_style(TRANSPARENT).x_labels(0).y_label_formatter(&tick);
        mesh.y_desc(unit).x_desc("distance of the eye").label_style((FONT, TEXT)).draw().map_err(wrong)?;
        let small = (FONT, TEXT - 3).into_text_style(&plot).pos(Pos::new(HPos::Center, VPos::Top));
        let large = (FONT, TEXT).into_text_style(&plot).pos(Pos::new(HPos::Center, VPos::Top));
        let mut left = f64::from(GAP) / 2.0;
        for group in groups {
            let begin = left;
            for bar in &group.bars {
                let mut base = 0.0;
                for (part, (_, colour)) in bar.parts.iter().zip(parts) {
                    let corners = [(left + 3.0, base), (left + f64::from(BAR) - 3.0, base + part)];
                    chart.plotting_area().draw(&Rectangle::new(corners, colour.filled())).map_err(wrong)?;
                    base += part;
                }
                let name = Text::new(bar.name.clone(), (0, 6), small.clone());
                chart.plotting_area().draw(&(EmptyElement::at((left + f64::from(BAR) / 2.0, 0.0)) + name)).map_err(wrong)?;
                left += f64::from(BAR);
            }
            let name = Text::new(group.name.clone(), (0, 22), large.clone());
            chart.plotting_area().draw(&(EmptyElement::at(((begin + left) / 2.0, 0.0)) + name)).map_err(wrong)?;
            left += f64::from(GAP);
        }
        if parts.len() > 1 {
            legend(&names, &parts.iter().rev().copied().collect::<Vec<_>>())?;
        }
        Ok(())
    })
}
