//! Plots of simulations, as SVG: no fonts are needed to make them, and the same figures give the same bytes.

pub(in crate::cli) use super::units::{Unit, energy_unit, time_unit};
use anyhow::anyhow;
use lodray::report::palette::{ENERGY_PARTS, PARTS};
use lodray::report::result::{IntervalPower, IntervalResult, SimResult};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(in crate::cli) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

pub(in crate::cli) const FONT: &str = "sans-serif";
pub(in crate::cli) const TEXT: i32 = 14;
const CAPTION: i32 = 17;
/// Columns right of a plot for its legend.
pub(in crate::cli) const LEGEND: u32 = 110;

/// In the order of the energy's parts.
pub(in crate::cli) const COLOURS: [RGBColor; ENERGY_PARTS] = [L1, L2, DRAM, COMPUTE, LEAKAGE];
const L1: RGBColor = part(0);
const L2: RGBColor = part(1);
const DRAM: RGBColor = part(2);
const COMPUTE: RGBColor = part(3);
const LEAKAGE: RGBColor = part(4);

/// The palette's colour of a part on paper.
const fn part(of: usize) -> RGBColor {
    let [red, green, blue] = PARTS[of].1;
    RGBColor(red, green, blue)
}

/// Name, colour and power of a part.
type Part = (&'static str, RGBColor, fn(&IntervalPower) -> f64);
/// Name, colour and value of a plot.
type Panel = (String, RGBColor, Box<dyn Fn(&IntervalResult) -> f64>);

/// Draws a picture of `size` under a title of one or two lines.
pub(in crate::cli) fn svg(
    size: (u32, u32),
    title: &[String],
    draw: impl FnOnce(&Area<'_>) -> anyhow::Result<()>,
) -> anyhow::Result<String> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE).map_err(wrong)?;
        let lines = title.iter().zip([CAPTION, TEXT]);
        let mut below = 10;
        for (line, height) in lines {
            area.draw(&Text::new(line.clone(), (14, below), (FONT, height))).map_err(wrong)?;
            below += height + 6;
        }
        draw(&area.split_vertically(below).1)?;
        area.present().map_err(wrong)?;
    }
    Ok(text)
}

/// Errors of the plotting library borrow their picture.
pub(in crate::cli) fn wrong(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("cannot draw a plot: {error}")
}

/// What is plotted, on which machine.
fn title(what: &str, r: &SimResult, machine: &str) -> Vec<String> {
    let setup = &r.setup;
    let delta = setup.method.delta.map_or_else(String::new, |delta| format!(" at delta {delta}"));
    let machine = if machine.is_empty() { String::new() } else { format!("; {machine}") };
    vec![what.to_owned(), format!("{}, {}{delta}, {}{machine}", setup.scene.name, setup.method.name, setup.rays_in_words())]
}

/// Squares and names, from the top down.
pub(in crate::cli) fn legend(area: &Area<'_>, entries: &[(&str, RGBColor)]) -> anyhow::Result<()> {
    for (k, (name, colour)) in (0..).zip(entries) {
        let y = 24 + 24 * k;
        area.draw(&Rectangle::new([(4, y), (16, y + 12)], colour.filled())).map_err(wrong)?;
        area.draw(&Text::new((*name).to_owned(), (24, y - 1), (FONT, TEXT))).map_err(wrong)?;
    }
    Ok(())
}

/// The largest of some values, with room above; 1 if all are 0.
pub(in crate::cli) fn top(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0, f64::max);
    if largest > 0.0 { 1.06 * largest } else { 1.0 }
}

/// A tick's label without superfluous digits.
pub(in crate::cli) fn tick(value: &f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if value.abs() >= 1e5 { format!("{value:.1e}") } else { text.to_owned() }
}

/// Bars of the energies of runs on machines.
pub fn energy(results: &[SimResult]) -> anyhow::Result<String> {
    let Some(first) = results.first() else { return Ok(String::new()) };
    let units: Vec<_> = results.iter().map(|r| r.energy.unit.as_str()).collect();
    // Joules and relative energies have no axis in common: then each bar is its own whole.
    let shares = units.iter().any(|unit| *unit != first.energy.unit);
    let machine = if results.len() == 1 { first.setup.machine.title() } else { first.setup.machine.set.join(" ") };
    let what = if shares { "Energy of a frame, parts of all".to_owned() } else { "Energy of a frame".to_owned() };
    let scale = |r: &SimResult| if shares && r.energy.total > 0.0 { 100.0 / r.energy.total } else { 1.0 };
    let most = top(results.iter().map(|r| r.energy.total * scale(r)));
    let unit = energy_unit(&first.energy.unit, most);
    let unit = if shares { Unit { size: 1.0, ..unit } } else { unit };
    let most = most / unit.size;
    let name = if shares { "% of the frame's energy".to_owned() } else { format!("energy, {}", unit.name) };
    let bars = results.len() as u32;
    svg((LEGEND + 140 + (170 * bars).max(320), 460), title(&what, first, &machine).as_slice(), |area| {
        let (plot, names) = area.split_horizontally(area.dim_in_pixel().0 - LEGEND);
        let mut chart = ChartBuilder::on(&plot)
            .margin(10)
            .x_label_area_size(34)
            .y_label_area_size(84)
            .build_cartesian_2d(0.0..f64::from(bars), 0.0..most)
            .map_err(wrong)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .x_labels(0)
            .y_label_formatter(&tick)
            .y_desc(name.as_str())
            .label_style((FONT, TEXT))
            .draw()
            .map_err(wrong)?;
        let below = (FONT, TEXT).into_text_style(&plot).pos(Pos::new(HPos::Center, VPos::Top));
        for (k, result) in (0..bars).map(f64::from).zip(results) {
            let mut base = 0.0;
            for ((_, part), colour) in result.energy.split().into_iter().zip(COLOURS) {
                let part = part * scale(result) / unit.size;
                let bar = Rectangle::new([(k + 0.2, base), (k + 0.8, base + part)], colour.filled());
                chart.plotting_area().draw(&bar).map_err(wrong)?;
                base += part;
            }
            let name = Text::new(result.setup.machine.label.clone(), (0, 8), below.clone());
            chart.plotting_area().draw(&(EmptyElement::at((k + 0.5, 0.0)) + name)).map_err(wrong)?;
        }
        let entries: Vec<_> = first.energy.split().into_iter().zip(COLOURS).rev().map(|((name, _), colour)| (name, colour)).collect();
        legend(&names, &entries)
    })
}

/// Time as plots show it: how much of its unit is a cycle, and the axis's name.
fn time_axis(r: &SimResult) -> (f64, String) {
    let ms = if r.cycles == 0 { 1.0 } else { r.milliseconds / r.cycles as f64 };
    let unit = time_unit(r.milliseconds);
    (ms / unit.size, format!("time, {}", unit.name))
}

/// A value that stays the same within each stretch, as points.
fn steps(r: &SimResult, value: impl Fn(&IntervalResult) -> f64) -> Vec<(f64, f64)> {
    let unit = time_axis(r).0;
    let points = |i: &IntervalResult| [i.end - i.cycles, i.end].map(|cycle| (cycle as f64 * unit, value(i)));
    r.intervals.iter().flat_map(points).collect()
}

/// Where the time axis ends.
fn last(r: &SimResult) -> f64 {
    if r.cycles == 0 { 1.0 } else { r.cycles as f64 * time_axis(r).0 }
}

/// Power over time, the parts on top of each other.
pub fn power(r: &SimResult) -> anyhow::Result<String> {
    let parts: [Part; 5] = [
        ("leakage", LEAKAGE, |w| w.leakage),
        ("compute", COMPUTE, |w| w.compute),
        ("L1", L1, |w| w.l1),
        ("L2", L2, |w| w.l2),
        ("DRAM", DRAM, |w| w.dram),
    ];
    let sum = |i: &IntervalResult, count: usize| i.watts.map_or(0.0, |w| parts[..count].iter().map(|part| part.2(&w)).sum());
    let most = r.intervals.iter().map(|i| sum(i, parts.len())).fold(0.0, f64::max);
    let unit = Unit::of(most, "W");
    let sum = |i: &IntervalResult, count: usize| sum(i, count) / unit.size;
    let most = top(std::iter::once(most / unit.size));
    svg((900, 460), &title("Power over time", r, &r.setup.machine.title()), |area| {
        let (plot, names) = area.split_horizontally(area.dim_in_pixel().0 - LEGEND);
        let mut chart = ChartBuilder::on(&plot)
            .margin(10)
            .x_label_area_size(44)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..last(r), 0.0..most)
            .map_err(wrong)?;
        let mut mesh = chart.configure_mesh();
        mesh.light_line_style(TRANSPARENT).x_label_formatter(&tick).y_label_formatter(&tick);
        mesh.x_desc(time_axis(r).1).y_desc(format!("power, {}", unit.name)).label_style((FONT, TEXT)).draw().map_err(wrong)?;
        // The whole first, then what is below its topmost part, and so on.
        for count in (1..=parts.len()).rev() {
            let colour = parts[count - 1].1;
            chart.draw_series(AreaSeries::new(steps(r, |i| sum(i, count)), 0.0, colour.filled())).map_err(wrong)?;
        }
        let entries: Vec<_> = parts.iter().rev().map(|part| (part.0, part.1)).collect();
        legend(&names, &entries)
    })
}

/// What goes through L1s, L2 and memory over time, each on its own scale.
pub fn traffic(r: &SimResult) -> anyhow::Result<String> {
    let seconds = if r.cycles == 0 { 1.0 } else { r.milliseconds * 1e-3 / r.cycles as f64 };
    let rate = move |bytes: u64, cycles: u64| bytes as f64 / (cycles as f64 * seconds);
    let line = lodray::num::LINE_BYTES;
    let values: [Panel; 3] = [
        ("L1s, asked of".to_owned(), L1, Box::new(move |i| rate(i.l1_requests * line, i.cycles))),
        ("L2, asked of".to_owned(), L2, Box::new(move |i| rate(i.l2_requests * line, i.cycles))),
        (format!("DRAM, at most {:.0} GB/s", r.dram.peak_bytes_per_second * 1e-9), DRAM, Box::new(move |i| rate(i.dram_bytes, i.cycles))),
    ];
    let largest = |value: &dyn Fn(&IntervalResult) -> f64| r.intervals.iter().map(value).fold(0.0, f64::max);
    svg((900, 760), &title("Traffic over time", r, &r.setup.machine.title()), |area| {
        let panels = area.split_evenly((values.len(), 1));
        for (panel, (name, colour, value)) in panels.iter().zip(&values) {
            let unit = Unit::of(largest(value), "B/s");
            let value = |i: &IntervalResult| value(i) / unit.size;
            let is_last = *name == values[values.len() - 1].0;
            let mut chart = ChartBuilder::on(panel)
                .margin(10)
                .margin_right(24)
                .caption(name, (FONT, TEXT))
                .x_label_area_size(if is_last { 44 } else { 24 })
                .y_label_area_size(70)
                .build_cartesian_2d(0.0..last(r), 0.0..top(r.intervals.iter().map(&value)))
                .map_err(wrong)?;
            let mut mesh = chart.configure_mesh();
            mesh.light_line_style(TRANSPARENT).x_label_formatter(&tick).y_label_formatter(&tick).y_labels(6);
            if is_last {
                mesh.x_desc(time_axis(r).1);
            }
            mesh.y_desc(unit.name.as_str()).label_style((FONT, TEXT)).draw().map_err(wrong)?;
            chart.draw_series(AreaSeries::new(steps(r, value), 0.0, colour.mix(0.4)).border_style(*colour)).map_err(wrong)?;
        }
        Ok(())
    })
}
