//! `info`: what a scene file holds.

use super::output::{grouped, open, print_json, print_line};
use lodray::format::Scene;
use lodray::mesh::TwoSidedDistance;
use lodray::num::PADDING_BITS;
use lodray::traverse::ModelSpace;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Part {
    name: &'static str,
    bytes: u64,
    per_finest_triangle: f64,
}

#[derive(Serialize)]
struct Info<'a> {
    name: &'a str,
    levels: u32,
    base_triangles: u64,
    base_vertices: u64,
    finest_triangles: u64,
    centre: [f64; 3],
    radius: f64,
    unit: f64,
    /// World length of the grid that base vertices are rounded to, and bits of 28 that it costs them.
    base_grid: f64,
    base_bits_lost: u32,
    parts: Vec<Part>,
    /// Bound and vertex data, L0 records included, per full-resolution triangle.
    hierarchy_bytes_per_triangle: f64,
    /// Distances to the original mesh in percent of its diagonal, where the scene was built from one.
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<TwoSidedDistance>,
    origin: &'a serde_json::Value,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    print(&open(&args.scene)?, args.json)?;
    Ok(ExitCode::SUCCESS)
}

/// Prints what `scene` holds.
pub fn print(scene: &Scene, json: bool) -> anyhow::Result<()> {
    let space = ModelSpace::of(scene);
    let triangles = scene.finest_triangles();
    let per = |bytes: u64| bytes as f64 / triangles as f64;
    let part = |name, bytes: usize| Part { name, bytes: bytes as u64, per_finest_triangle: per(bytes as u64) };
    let parts = vec![
        part("quad-BVH nodes", size_of_val(scene.nodes())),
        part("L0 records", size_of_val(scene.records())),
        part("bound data", size_of_val(scene.bounds())),
        part("vertex data", size_of_val(scene.vertices())),
        part("normals", size_of_val(scene.normals())),
        part("base indices", size_of_val(scene.triangles())),
    ];
    let hierarchy: u64 = parts[1..4].iter().map(|p| p.bytes).sum();
    let meta = scene.meta();
    let info = Info {
        name: &meta.name,
        levels: scene.levels(),
        base_triangles: scene.trees() as u64,
        base_vertices: u64::from(meta.base_vertices),
        finest_triangles: triangles,
        centre: space.centre(),
        radius: space.radius(),
        unit: space.placement.scale,
        base_grid: space.placement.scale * f64::from(1u32 << scene.levels().max(PADDING_BITS)),
        base_bits_lost: scene.levels().saturating_sub(PADDING_BITS),
        hierarchy_bytes_per_triangle: per(hierarchy),
        parts,
        distance: serde_json::from_value(meta.origin["remesh"]["distance"].clone()).ok(),
        origin: &meta.origin,
    };
    if json { print_json(&info) } else { print_line(&text(&info)) }
}

fn text(i: &Info<'_>) -> String {
    let mut text = format!(
        "{}: {} base triangles ({} vertices), {} levels below them, {} triangles at full resolution\ncentre {:?}, bounding radius {}, one unit {:e}\n",
        i.name,
        grouped(i.base_triangles),
        grouped(i.base_vertices),
        i.levels,
        grouped(i.finest_triangles),
        i.centre,
        i.radius,
        i.unit
    );
    text += &format!(
        "base vertices are rounded to {:e}: {} of 28 bits{}\n",
        i.base_grid,
        28 - i.base_bits_lost,
        if i.levels > 8 { ", fewer than single precision's 24 (N above 8)" } else { "" }
    );
    text += &format!("{:<16}{:>16}{:>22}\n", "part", "bytes", "per finest triangle");
    for p in &i.parts {
        text += &format!("{:<16}{:>16}{:>22.3}\n", p.name, grouped(p.bytes), p.per_finest_triangle);
    }
    text += &format!("bound and vertex data with L0 records: {:.3} bytes per finest triangle\n", i.hierarchy_bytes_per_triangle);
    if let Some(d) = &i.distance {
        let there = format!("mean {}, maximum {}", percent(d.to_original.mean), percent(d.to_original.max));
        let back = format!("mean {}, maximum {}", percent(d.from_original.mean), percent(d.from_original.max));
        text += &format!("distance to the original: {there} of the diagonal; back: {back}\n");
    }
    text += &origin(i.origin, "");
    text.trim_end().to_owned()
}

/// Three digits that count; what is left of rounding on an exact fit is not worth its zeros.
fn percent(value: f64) -> String {
    if value > 0.0 && value < 1e-6 {
        return "below 0.000001 %".to_owned();
    }
    let decimals = if value > 0.0 { (2.0 - value.log10().floor()).clamp(0.0, 8.0) as usize } else { 0 };
    format!("{value:.decimals$} %")
}

/// How the scene was made, one line for each leaf of the report.
fn origin(value: &serde_json::Value, path: &str) -> String {
    match value {
        serde_json::Value::Null => String::new(),
        serde_json::Value::Object(map) => {
            let join = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            map.iter().map(|(key, value)| origin(value, &join(key))).collect()
        }
        other => format!("{path}: {other}\n"),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn percentages_have_three_digits() {
        let shown = [0.0, 1e-17, 0.000_712, 0.25, 12.345, 1234.5].map(super::percent);
        assert_eq!(shown, ["0 %", "below 0.000001 %", "0.000712 %", "0.250 %", "12.3 %", "1234 %"]);
    }
}
