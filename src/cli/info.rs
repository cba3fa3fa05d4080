//! `info`: what a scene file holds.

use super::output::{open_any, plain, print_json, print_line};
use lodray::format::{FileSection, JobRegion, JobView, Meta, Scene};
use lodray::mesh::{BoundKind, Distance, TwoSidedDistance};
use lodray::num::{PADDING_BITS, VertexForm};
use lodray::rays::ModelSpace;
use lodray::scene::moved_percent;
use lodray::study::{count, grouped};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Print all: where the bytes are, how finely base vertices are rounded, and how the scene was made
    #[arg(long)]
    verbose: bool,
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
    /// Of the whole file.
    bytes: u64,
    bytes_per_finest_triangle: f64,
    /// Width, height and depth of the model's box, in the units of its coordinates.
    size: [f64; 3],
    levels: u32,
    base_triangles: u64,
    /// How many of them have how many levels stored: from none on.
    trees_by_depth: Vec<usize>,
    /// The views that it was pruned for; empty if it serves any ray.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    job: &'a [JobView],
    /// The boxes from which rays may start besides.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    regions: &'a [JobRegion],
    /// Shading normals were left out.
    without_normals: bool,
    base_vertices: u64,
    finest_triangles: u64,
    /// What displacement bounds cover.
    bounds: BoundKind,
    /// How inserted vertices are stored, and the largest distance of a stored vertex from where the surface had it.
    vertices: VertexForm,
    moved: f64,
    centre: [f64; 3],
    radius: f64,
    unit: f64,
    /// World length of the grid that base vertices are rounded to, and bits of 28 that it costs them.
    base_grid: f64,
    base_bits_lost: u32,
    parts: Vec<Part>,
    /// L0 records, splits and vertices per full-resolution triangle.
    hierarchy_bytes_per_triangle: f64,
    /// Distances to the original mesh in percent of its diagonal, where the scene was built from one.
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<TwoSidedDistance>,
    origin: &'a serde_json::Value,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let scene = open_any(&args.scene)?;
    match (args.json, args.verbose) {
        (true, _) => print_json(&Info::of(&scene))?,
        (false, true) => print_line(&verbose(&Info::of(&scene)))?,
        (false, false) => print_line(&short(&scene))?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints what `scene` holds, as JSON.
pub fn json(scene: &Scene) -> anyhow::Result<()> {
    print_json(&Info::of(scene))
}

/// What a newcomer wants to know of `scene`.
pub fn short(scene: &Scene) -> String {
    summary(&Info::of(scene))
}

/// What was lost when `scene` was made, if anything.
pub fn warnings(scene: &Scene) -> Vec<String> {
    losses(&Info::of(scene))
}

impl<'a> Info<'a> {
    fn of(scene: &'a Scene) -> Self {
        let space = ModelSpace::of(scene);
        let triangles = scene.finest_triangles();
        let per = |bytes: u64| bytes as f64 / triangles as f64;
        let part = |name, bytes: usize| Part { name, bytes: bytes as u64, per_finest_triangle: per(bytes as u64) };
        let parts = vec![
            part("quad-BVH nodes", size_of_val(scene.nodes())),
            part("L0 records", size_of_val(scene.records())),
            part("splits", size_of_val(scene.splits())),
            part(if scene.meta().vertices.is_compact() { "last splits" } else { "vertices" }, size_of_val(scene.vertices())),
            part("normals", size_of_val(scene.normals())),
            part("base indices", size_of_val(scene.triangles())),
            part("base numbers, materials", scene.section(FileSection::Sources).len()),
        ];
        let hierarchy: u64 = parts[1..4].iter().map(|p| p.bytes).sum();
        let meta = scene.meta();
        let bytes = scene.bytes().len() as u64;
        Info {
            name: &meta.name,
            bytes,
            bytes_per_finest_triangle: per(bytes),
            size: std::array::from_fn(|k| space.placement.scale * (f64::from(space.hi[k]) - f64::from(space.lo[k]))),
            levels: scene.levels(),
            base_triangles: scene.trees() as u64,
            trees_by_depth: scene.trees_by_depth(),
            job: &meta.job,
            regions: &meta.regions,
            without_normals: meta.without_normals,
            base_vertices: u64::from(meta.base_vertices),
            finest_triangles: triangles,
            bounds: meta.bounds,
            vertices: meta.vertices,
            moved: meta.moved,
            centre: space.centre(),
            radius: space.radius(),
            unit: space.placement.scale,
            base_grid: space.placement.scale * f64::from(1u32 << meta.vertices.zero_bits(scene.levels(), 0, meta.coordinate_zeros)),
            base_bits_lost: meta.vertices.zero_bits(scene.levels(), 0, meta.coordinate_zeros) - PADDING_BITS,
            hierarchy_bytes_per_triangle: per(hierarchy),
            parts,
            distance: serde_json::from_value(meta.origin["remesh"]["distance"].clone())
                .ok()
                .map(|distance| stored(distance, moved_percent(scene))),
            origin: &meta.origin,
        }
    }
}

/// Distances of the surface before it was rounded, to that which is stored: no point was moved by more than `moved` percent.
fn stored(distance: TwoSidedDistance, moved: f64) -> TwoSidedDistance {
    let further = |d: Distance| Distance { max: d.max + moved, ..d };
    TwoSidedDistance { to_original: further(distance.to_original), from_original: further(distance.from_original) }
}

/// The few figures that tell what a scene is, each in words.
fn summary(i: &Info<'_>) -> String {
    let splits = match i.levels {
        0 => "not split".to_owned(),
        1 => "each split once into 4".to_owned(),
        levels => format!("each split {levels} times into 4"),
    };
    let [width, height, depth] = i.size.map(plain);
    let mut lines = vec![("scene", i.name.to_owned())];
    if let Some(read) = i.origin["mesh"]["triangles_read"].as_u64() {
        let name = |key: &str| i.origin[key]["name"].as_str();
        let file = match (name(Meta::FILE), name(Meta::FILE_AT_REST)) {
            (Some(file), _) => format!(" of {file}"),
            (None, Some(file)) => format!(" of {file}; vertices were moved since (refit), so that nothing is known of distances to it"),
            (None, None) => String::new(),
        };
        lines.push(("mesh", format!("{}{file}", count(read as usize, "triangle"))));
    }
    lines.extend([
        (
            "triangles",
            format!("{} at full resolution: {}, {splits}", grouped(i.finest_triangles), count(i.base_triangles, "base triangle")),
        ),
        (
            "file size",
            format!(
                "{} MB, {} bytes for each triangle at full resolution",
                plain(i.bytes as f64 * 1e-6),
                plain(i.bytes_per_finest_triangle)
            ),
        ),
        ("model size", format!("{width} x {height} x {depth} (width x height x depth, in the units of its coordinates)")),
        ("bounds", format!("{}: {}", i.bounds.name(), promise(i.bounds))),
        ("vertices", format!("{}: none is further than {} from its place on the surface", i.vertices.name(), plain(i.moved))),
    ]);
    if let Some(d) = &i.distance {
        let mean = percent(d.to_original.mean.max(d.from_original.mean));
        let max = at_most(d.to_original.max.max(d.from_original.max));
        lines.push((
            "accuracy",
            format!("{mean} of the model's diagonal from the original mesh on average; no point is further than {max} (a bound: the largest distance may be less)"),
        ));
    }
    if let Some(wanted) = i.origin["remesh"]["wanted_base_triangles"].as_u64() {
        let (wanted, made) = (grouped(wanted), grouped(i.base_triangles));
        let why = "how the mesh is connected, and its borders and creases, allow no fewer triangles";
        lines.push(("note", format!("--base {wanted} was not met, the base has {made}: {why}")));
    }
    if i.trees_by_depth[..i.levels as usize].iter().any(|&trees| trees > 0) {
        lines.push(("tree depths", depths(&i.trees_by_depth)));
    }
    if i.without_normals {
        lines.push(("normals", "left out: rays can be simulated, pictures are refused".to_owned()));
    }
    for view in i.job {
        let [width, height] = view.size;
        let at = view.eye.map(plain).join(", ");
        lines.push(("pruned for", format!("{width}x{height} from ({at}) at delta {}: no other rays are served", view.delta)));
    }
    for region in i.regions {
        let [lo, hi] = [region.lo, region.hi].map(|corner| corner.map(plain).join(", "));
        let (delta, cone) = (&region.delta, plain(region.cone));
        let what =
            format!("rays that start between ({lo}) and ({hi}), at most delta {delta}, cones of at least {cone}: no others are served");
        lines.push(("pruned for", what));
    }
    lines.extend(losses(i).into_iter().map(|loss| ("warning", loss)));
    lines.iter().map(|(name, value)| format!("{name:<12}{value}")).collect::<Vec<_>>().join("\n")
}

/// Levels that are stored, and of how many trees.
fn depths(trees: &[usize]) -> String {
    let some = trees.iter().enumerate().filter(|(_, trees)| **trees > 0);
    let of = |(levels, trees): (usize, &usize)| format!("{levels} ({})", grouped(*trees as u64));
    format!("levels stored (base triangles with each depth): {}; no ray goes deeper", some.map(of).collect::<Vec<_>>().join(", "))
}

/// What displacement bounds mean for who chooses a delta.
fn promise(bounds: BoundKind) -> &'static str {
    match bounds {
        BoundKind::Largest => "delta 1 keeps each level's displacement under a pixel; levels add up",
        BoundKind::Total => "delta 1.6 keeps what is seen within a pixel of its place on the surface",
    }
}

/// What was lost when the scene was made.
fn losses(i: &Info<'_>) -> Vec<String> {
    let remesh = i.origin["remesh"]["warning"].as_str().map(str::to_owned);
    // Single precision, in which meshes come, has 24 bits.
    let grid = (i.levels > 8).then(|| {
        format!(
            "base vertices are rounded to steps of {}, coarser than single precision, as there are more than 8 levels",
            plain(i.base_grid)
        )
    });
    remesh.into_iter().chain(grid).collect()
}

/// All that is known.
fn verbose(i: &Info<'_>) -> String {
    let mut text = summary(i);
    text += &format!(
        "\n\n{} base vertices; centre {:?}, bounding radius {} (half the diagonal of the model's box), one step of its integer coordinates is {:e}\n",
        grouped(i.base_vertices),
        i.centre,
        i.radius,
        i.unit
    );
    text += &format!(
        "base vertices are rounded to {:e}: {} of 28 bits{}\n",
        i.base_grid,
        28 - i.base_bits_lost,
        if i.base_bits_lost > 4 { ", fewer than single precision's 24" } else { "" }
    );
    text += &format!("{:<16}{:>16}{:>22}\n", "part", "bytes", "per finest triangle");
    for p in &i.parts {
        text += &format!("{:<16}{:>16}{:>22.3}\n", p.name, grouped(p.bytes), p.per_finest_triangle);
    }
    text += &format!(
        "L0 records (those of base triangles), splits and vertices: {:.3} bytes per finest triangle\n",
        i.hierarchy_bytes_per_triangle
    );
    if let Some(d) = &i.distance {
        let there = format!("mean {}, bound {}", percent(d.to_original.mean), at_most(d.to_original.max));
        let back = format!("mean {}, bound {}", percent(d.from_original.mean), at_most(d.from_original.max));
        text +=
            &format!("distance to the original mesh: {there} of the diagonal; from it back: {back} (no point is further than the bound)\n");
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

/// A bound, rounded up.
fn at_most(value: f64) -> String {
    if value <= 0.0 {
        return percent(value);
    }
    if value < 1e-6 {
        return "0.000001 %".to_owned();
    }
    // The last of three digits.
    let last = 10f64.powf(value.log10().floor() - 2.0);
    percent((value / last).ceil() * last)
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
        assert_eq!([0.2951, 0.295, 0.0, 12.34, 1e-17].map(super::at_most), ["0.296 %", "0.295 %", "0 %", "12.4 %", "0.000001 %"]);
        assert_eq!(shown, ["0 %", "below 0.000001 %", "0.000712 %", "0.250 %", "12.3 %", "1234 %"]);
    }
}
