//! Plots of error growth, as SVG.

use crate::cli::simulate::plots::{COLOURS, FONT, TEXT, svg, tick, wrong};
use lodray::lab::growth::{Growth, Point};
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

/// File names.
pub const LEVELS: &str = "error-levels.svg";
pub const DISTANCE: &str = "error-distance.svg";

/// Name and values of a curve.
type Curve<'a> = (&'a str, fn(&Point) -> f64);

/// Errors by number of splits.
pub fn by_levels(growth: &Growth) -> anyhow::Result<String> {
    let Some(last) = growth.by_levels.last() else { return Ok(String::new()) };
    let axis = 0.0..f64::from(last.levels);
    panels(
        "Rounding by the number of splits N (a bumpy ball, delta 1, from 0.01 radii)",
        "N",
        &growth.by_levels,
        |p| f64::from(p.levels),
        axis,
    )
}

/// Errors by distance.
pub fn by_distance(growth: &Growth) -> anyhow::Result<String> {
    let [Some(first), Some(last)] = [growth.by_distance.first(), growth.by_distance.last()] else { return Ok(String::new()) };
    let axis = (first.distance..last.distance).log_scale();
    panels(
        "Rounding by distance (a bumpy ball, N = 4, delta 1)",
        "distance of the camera, bounding radii",
        &growth.by_distance,
        |p| p.distance,
        axis,
    )
}

/// Displacement in pixels, rounding of vertices and of barycentrics, one under the other.
fn panels<X: AsRangedCoord<Value = f64> + Clone>(
    title: &str,
    x: &str,
    points: &[Point],
    at: impl Fn(&Point) -> f64,
    axis: X,
) -> anyhow::Result<String>
where
    X::CoordDescType: ValueFormatter<f64>,
{
    let all: [(&str, [Curve<'_>; 2]); 3] = [
        ("displacement of hits, pixels", [("worst", |p| p.pixels[0]), ("mean", |p| p.pixels[1])]),
        ("vertices, units", [("worst", |p| p.vertex_loss[0]), ("mean", |p| p.vertex_loss[1])]),
        ("barycentrics, steps of 2^-31", [("full resolution, worst", |p| p.bary_ulp[1]), ("triangle met, worst", |p| p.bary_ulp[0])]),
    ];
    svg((820, 900), &[title.to_owned()], |area| {
        for (panel, (what, curves)) in area.split_evenly((all.len(), 1)).iter().zip(&all) {
            let values = || points.iter().flat_map(|p| curves.iter().map(move |curve| curve.1(p))).filter(|v| *v > 0.0);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
            // Above the curves there is room for the legend.
            let range = if low <= high { low / 2.0..high * 12.0 } else { 0.5..2.0 };
            let mut chart = ChartBuilder::on(panel)
                .margin(10)
                .margin_right(24)
                .x_label_area_size(44)
                .y_label_area_size(84)
                .build_cartesian_2d(axis.clone(), range.log_scale())
                .map_err(wrong)?;
            let mut mesh = chart.configure_mesh();
            mesh.light_line_style(TRANSPARENT).x_desc(x).y_desc(*what).label_style((FONT, TEXT));
            mesh.x_label_formatter(&power).y_label_formatter(&power).y_labels(6).draw().map_err(wrong)?;
            for ((name, value), colour) in curves.iter().zip([COLOURS[3], COLOURS[0]]) {
                let line: Vec<_> = points.iter().map(|p| (at(p), value(p))).filter(|p| p.1 > 0.0).collect();
                chart
                    .draw_series(LineSeries::new(line, colour.stroke_width(2)).point_size(3))
                    .map_err(wrong)?
                    .label(*name)
                    .legend(move |(x, y)| Rectangle::new([(x, y - 4), (x + 12, y + 4)], colour.filled()));
            }
            let mut legend = chart.configure_series_labels();
            legend
                .position(SeriesLabelPosition::UpperRight)
                .background_style(WHITE.mix(0.8))
                .label_font((FONT, TEXT))
                .draw()
                .map_err(wrong)?;
        }
        Ok(())
    })
}

/// A tick's label: plain near 1, else a power of ten.
fn power(value: &f64) -> String {
    if *value == 0.0 || (0.009..1e4).contains(value) { tick(value) } else { format!("{value:.0e}") }
}
