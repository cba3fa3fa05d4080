//! `render`: one view of a scene through one method.

use super::args::CameraArgs;
use super::bars::Bars;
use super::cache::CacheArgs;
use super::comparison::Against;
use super::facts::Facts;
use super::folder::{Overrule, RunFolder, one_run};
use super::method::PictureMethod;
use super::original::original;
use super::output::{explain, open, open_any, print_json, print_table, remark};
use super::pictures::{error, levels, normals, save_shot};
use anyhow::Context;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use image::RgbImage;
use lodray::format::Scene;
use lodray::method::knob::DELTA;
use lodray::method::{Method, reference};
use lodray::picture::{FrameStats, KindCount, Shader, Shading, Sheet, save_png};
use lodray::rays::{Camera, ModelSpace, Sight};
use lodray::study::pruned::check_normals;
use lodray::study::{Chosen, Comparison, Shot, count, grouped, pruned};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// The contact sheet.
const SHEET: &str = "sheet.png";

#[derive(clap::Args)]
pub struct Args {
    /// Scene file (for --method original also a mesh file)
    scene: PathBuf,
    #[command(flatten)]
    method: PictureMethod,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// Folder for the pictures
    #[arg(short, long, default_value = "out", long_help = one_run("Folder for the pictures"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Compare with full resolution, or with the mesh in --mesh: error map and figures
    #[arg(long)]
    compare: bool,
    /// The mesh that the scene was made from, for --compare or --method original
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Normals that the picture is shaded with
    #[arg(long, value_parser = shading(), default_value = Shading::default().name())]
    shading: Shading,
    /// Samples in each pixel of the picture, on a regular grid; maps and figures are those of one ray through its centre
    #[arg(long, value_parser = samples(), default_value = "1")]
    samples: u32,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// Shadings by name.
pub fn shading() -> impl TypedValueParser<Value = Shading> {
    let named = |name: String| Shading::ALL.into_iter().find(|shading| shading.name() == name).unwrap_or_default();
    PossibleValuesParser::new(Shading::ALL.map(|shading| PossibleValue::new(shading.name()).help(shading.help()))).map(named)
}

/// Sides of the grid of samples, by how many they are.
fn samples() -> impl TypedValueParser<Value = u32> {
    PossibleValuesParser::new(["1", "4", "16", "64"]).map(|count| count.parse::<u32>().map_or(1, u32::isqrt))
}

#[derive(Serialize)]
struct Report {
    method: &'static str,
    delta: f64,
    /// What the method chose for the frame.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    choices: BTreeMap<&'static str, String>,
    shading: Shading,
    /// In each pixel of the picture; `stats` are those of one.
    samples: u32,
    size: [u32; 2],
    eye: [f64; 3],
    /// Distance from the target in bounding radii.
    distance: f64,
    /// Whether what the method needs was read from the cache.
    cached: bool,
    seconds: Seconds,
    stats: FrameStats,
    per_ray: PerRay,
    /// What it was compared with.
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<Against>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Comparison>,
}

/// Times on the host: all of the figures that are not the same in every run.
#[derive(Serialize)]
struct Seconds {
    /// Building what the method needs, or reading it from the cache.
    building: f64,
    tracing: f64,
}

/// Means over all rays of the frame.
#[derive(Serialize)]
struct PerRay {
    nodes: f64,
    lod_tests: f64,
    triangles: f64,
    lines_read: f64,
    bytes_read: f64,
    distinct_lines: f64,
    by_kind: Vec<KindPerRay>,
}

/// Means over all rays of the frame, of one kind of data.
#[derive(Serialize)]
struct KindPerRay {
    kind: &'static str,
    lines_read: f64,
    bytes_read: f64,
    distinct_lines: f64,
}

/// Geometry to trace.
struct Subject {
    scene: Scene,
    space: ModelSpace,
}

impl Subject {
    fn of(scene: Scene) -> Self {
        Self { space: ModelSpace::of(&scene), scene }
    }

    /// The frame of the first camera, the picture of the other.
    fn shoot(&self, method: &dyn Method, shading: Shading, cameras: [&Camera; 2], delta: f64, what: &str) -> Shot {
        Shot::of(method, &Shader::new(method.surface(&self.scene), &self.space, shading), &self.space, cameras, delta, (what, &Bars))
    }
}

/// What the camera stands around, and the original if it is something else.
fn subjects(args: &Args) -> anyhow::Result<(Subject, Option<Subject>)> {
    let is_original = args.method.original;
    anyhow::ensure!(!(is_original && args.compare), "--compare: the original is what the other methods are compared with");
    match &args.mesh {
        Some(_) if !is_original && !args.compare => anyhow::bail!("--mesh: goes with --compare or with --method original only"),
        Some(mesh) => Ok((Subject::of(open(&args.scene)?), Some(Subject::of(original(mesh)?)))),
        None if is_original => Ok((Subject::of(original(&args.scene)?), None)),
        None => Ok((Subject::of(open_any(&args.scene)?), None)),
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let (seen, mesh) = subjects(args)?;
    let camera = args.camera.camera(&seen.space, None)?;
    let samples = camera.with_samples(args.samples).context("--samples")?;
    let cameras = [&camera, &samples];
    cameras.into_iter().try_for_each(|rays| pruned::check(&seen.scene, rays, args.method.chosen.delta()))?;
    check_normals(&seen.scene, "a picture")?;
    pruned::check_shading(&seen.scene, args.shading)?;
    args.method.chosen.check(&seen.scene)?;
    if args.compare && mesh.is_none() {
        Chosen::plain(&reference::METHOD).check(&seen.scene)?;
    }
    let pictures = ["image.png", "levels.png", "normals.png", SHEET, "error.png"];
    let names = pictures.into_iter().take(4 + usize::from(args.compare));
    let inputs: Vec<_> = std::iter::once(&args.scene).chain(&args.mesh).map(PathBuf::as_path).collect();
    let folder = RunFolder::open(&args.out, names, &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;

    let shown = mesh.as_ref().filter(|_| args.method.original).unwrap_or(&seen);
    let begun = Instant::now();
    let (chosen, delta) = (&args.method.chosen, args.method.chosen.delta());
    let (method, cached) = chosen.make(&shown.scene, &cache, &Bars)?;
    let building = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    let shot = shown.shoot(&*method, args.shading, cameras, delta, "tracing");
    let seconds = Seconds { building, tracing: begun.elapsed().as_secs_f64() };
    let choices = method.choices(&Sight::new(&camera, &shown.space, delta));
    let surface = method.surface(&shown.scene).clone();
    drop(method);

    let truth = if args.compare {
        let (against, of) = mesh.as_ref().map_or((Against::FullResolution, &seen), |mesh| (Against::Original, mesh));
        let (reference, _) = Chosen::plain(&reference::METHOD).make(&of.scene, &cache, &Bars)?;
        let truth = of.shoot(&*reference, args.shading, cameras, delta, against.name());
        let error = shot.compared(&truth, &of.scene, &camera);
        Some((against, truth.image, error))
    } else {
        None
    };
    let facts = Facts {
        scene: &shown.scene.meta().name,
        method: args.method.name(),
        delta: chosen.method.has(DELTA.name).then_some(delta),
        choices: &choices,
        shading: (args.shading, args.samples * args.samples),
        camera: &camera,
        stats: &shot.stats,
        error: truth.as_ref().map(|(against, _, error)| (*against, error)),
    };
    let true_image = truth.as_ref().map(|(against, image, _)| (*against, image));
    save(&shot, true_image, &surface, &facts, folder.staging())?;
    folder.finish()?;

    let (against, error) = truth.map(|(against, _, error)| (against, error)).unzip();
    let stats = shot.stats;
    let mean = |n: u64| n as f64 / stats.rays as f64;
    let per_ray = PerRay {
        nodes: mean(stats.nodes),
        lod_tests: mean(stats.lod_tests),
        triangles: mean(stats.triangles),
        lines_read: mean(stats.lines_read()),
        bytes_read: 32.0 * mean(stats.lines_read()),
        distinct_lines: mean(stats.distinct_lines()),
        by_kind: stats.lines.iter().map(|k| kind_per_ray(k, stats.rays)).collect(),
    };
    let report = Report {
        method: args.method.name(),
        delta,
        choices: choices.into_iter().collect(),
        shading: args.shading,
        samples: args.samples * args.samples,
        size: [camera.width, camera.height],
        eye: camera.eye.to_array(),
        distance: camera.radii,
        cached,
        seconds,
        stats,
        per_ray,
        against,
        error,
    };
    if args.json {
        print_json(&report)?
    } else {
        print_table(&table(&report))?;
        explain("render")?;
        remark(&format!("pictures in {}", args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Saves all pictures and the contact sheet, one after the other: large ones take much memory.
fn save(shot: &Shot, truth: Option<(Against, &RgbImage)>, scene: &Scene, facts: &Facts<'_>, out: &Path) -> anyhow::Result<()> {
    let mut sheet = Sheet::default();
    save_shot(shot, out, "", facts)?;
    sheet.add(facts.method, &shot.image, None);
    if let Some((against, truth)) = truth {
        sheet.add(against.name(), truth, None);
        let error = error(shot, truth);
        error.save(out, "", facts)?;
        sheet.add(&format!("difference to {}", against.name()), &error.image, Some(error.legend));
    }
    for map in [levels, normals] {
        let map = map(shot, scene);
        map.save(out, "", facts)?;
        sheet.add(map.name, &map.image, Some(map.legend));
    }
    let path = out.join(SHEET);
    let sheet = sheet.draw(&facts.heading(), &facts.lines());
    save_png(&sheet, &facts.notes("contact sheet"), &path).with_context(|| format!("cannot write {}", path.display()))
}

fn kind_per_ray(k: &KindCount, rays: u64) -> KindPerRay {
    let mean = |n: u64| n as f64 / rays as f64;
    KindPerRay { kind: k.kind, lines_read: mean(k.read), bytes_read: 32.0 * mean(k.read), distinct_lines: mean(k.distinct) }
}

fn table(r: &Report) -> String {
    let making = if r.cached { "BVH read from the cache" } else { "building" };
    let (rays, hits, Seconds { building, tracing }) = (count(r.stats.rays, "ray"), grouped(r.stats.hits), &r.seconds);
    let mut text = format!("{rays}, {hits} hit; {making} {building:.2} s, tracing {tracing:.2} s\n");
    // The reference is no hardware, and reads none.
    if !r.stats.lines.is_empty() {
        text += &format!(
            "per ray: {:.2} nodes, {:.2} LOD tests, {:.2} triangles, {:.2} lines read ({:.0} bytes)\nmean level {:.3}\n",
            r.per_ray.nodes, r.per_ray.lod_tests, r.per_ray.triangles, r.per_ray.lines_read, r.per_ray.bytes_read, r.stats.mean_level,
        );
        let mut line = |cells: [&str; 6]| {
            let [kind, cells @ ..] = cells;
            let cells: String = cells.iter().map(|c| format!("{c:>16}")).collect();
            text += &format!("{kind:<14}{cells}\n");
        };
        line(["lines of", "read", "distinct", "read/ray", "bytes/ray", "distinct/ray"]);
        for (k, per) in r.stats.lines.iter().zip(&r.per_ray.by_kind) {
            let means = [per.lines_read, per.bytes_read, per.distinct_lines].map(|v| format!("{v:.3}"));
            line([k.kind, &grouped(k.read), &grouped(k.distinct), &means[0], &means[1], &means[2]]);
        }
        let means = [r.per_ray.lines_read, r.per_ray.bytes_read, r.per_ray.distinct_lines].map(|v| format!("{v:.3}"));
        line(["all", &grouped(r.stats.lines_read()), &grouped(r.stats.distinct_lines()), &means[0], &means[1], &means[2]]);
    }
    if let (Some(against), Some(e)) = (r.against, &r.error) {
        let psnr = e.image.psnr_db.map_or("infinite".to_owned(), |p| format!("{p:.2} dB"));
        let off = e.geometry_pixels.map_or("no pixel sees the surface in both: nothing overlaps".to_owned(), |g| {
            format!("surface off by {:.3} pixels in the mean, 99 of 100 below {:.3}", g.mean, g.percentile_99)
        });
        text += &format!(
            "against {}: RMSE {:.3}, PSNR {psnr}, maximum {}, {:.2} % of pixels differ, {} differ in coverage\n{off}\n",
            against.name(),
            e.image.rmse,
            e.image.maximum,
            100.0 * e.image.differing,
            grouped(e.coverage_differs)
        );
    }
    text.trim_end().to_owned()
}
