//! `render`: one view of a scene through one method.

use super::args::{CameraArgs, LeafArgs, delta};
use super::cache::{Cache, CacheArgs};
use super::output::{busy, folder, grouped, open, print_json, print_line};
use super::pictures::{Shot, shoot};
use clap::ValueEnum;
use lodray::bvh::{BvhError, FullBuilder, FullBvh, FullOptions};
use lodray::format::Scene;
use lodray::golden::reference::Reference;
use lodray::render::{Camera, FrameStats, GeometricError, ImageError, KindCount, Method, Pixel, compare, geometric_error, view_cosine};
use lodray::traverse::{Kind, LodImage, ModelSpace};
use serde::Serialize;
use std::fmt::{self, Display};
use std::path::PathBuf;
use std::process::ExitCode;

/// How rays find their hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MethodName {
    /// Locally adaptive level of detail
    Lod,
    /// Quad-BVH of the full-resolution mesh, 16-bit boxes
    Bvh,
    /// The same with 32-bit boxes
    Bvh32,
    /// f64, full resolution: the truth
    Reference,
}

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// How rays find their hits
    #[arg(long, value_enum, default_value_t = MethodName::Lod)]
    method: MethodName,
    /// Quality: 1 keeps a level's displacement under a pixel, 0 is the base mesh, inf full detail
    #[arg(long, default_value = "1", value_parser = delta, allow_hyphen_values = true)]
    delta: f64,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    leaves: LeafArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// Folder for the pictures
    #[arg(short, long, default_value = "out")]
    out: PathBuf,
    /// Compare with full resolution: error map and figures
    #[arg(long)]
    compare: bool,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    method: MethodName,
    delta: f64,
    size: [u32; 2],
    eye: [f64; 3],
    /// Not in the JSON, which is the same for every run; nor is the next.
    #[serde(skip)]
    seconds: f64,
    #[serde(skip)]
    making: Option<Making>,
    stats: FrameStats,
    per_ray: PerRay,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Comparison>,
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
    kind: Kind,
    lines_read: f64,
    bytes_read: f64,
    distinct_lines: f64,
}

#[derive(Clone, Serialize)]
pub struct Comparison {
    #[serde(flatten)]
    pub image: ImageError,
    /// Pixels that hit in one picture only.
    pub coverage_differs: u64,
    /// Distance between the surfaces in pixels.
    pub geometry_pixels: GeometricError,
}

/// What a method needs besides the scene.
pub enum Built {
    Lod,
    Bvh { bvh: FullBvh, making: Making },
    Reference(Reference),
}

/// How a BVH was come by.
#[derive(Clone, Copy, Debug)]
pub struct Making {
    /// From the cache instead of built.
    pub read: bool,
    pub seconds: f64,
}

impl Display for Making {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let how = if self.read { "BVH read from the cache" } else { "building the BVH" };
        write!(f, "{how} {:.2} s", self.seconds)
    }
}

impl Built {
    /// How the BVH was come by, if it is one.
    pub fn making(&self) -> Option<Making> {
        match self {
            Self::Bvh { making, .. } => Some(*making),
            _ => None,
        }
    }

    /// Builds what `name` needs, or takes it from the cache.
    pub fn new(name: MethodName, scene: &Scene, leaves: LeafArgs, cache: &Cache) -> anyhow::Result<Self> {
        Ok(match name {
            MethodName::Lod => Self::Lod,
            MethodName::Bvh => full_bvh(scene, leaves, false, cache)?,
            MethodName::Bvh32 => full_bvh(scene, leaves, true, cache)?,
            MethodName::Reference => Self::Reference(busy("building the reference", || Reference::new(&scene.decode()))),
        })
    }

    /// Renders with it.
    pub fn shoot(&self, scene: &Scene, space: &ModelSpace, camera: &Camera, delta: f64, what: &str) -> Shot {
        shoot(&self.method(scene), scene, space, camera, delta, what)
    }

    /// The method, on the scene that it was built for.
    pub fn method<'a>(&'a self, scene: &'a Scene) -> Method<'a> {
        match self {
            Self::Lod => Method::Lod(LodImage::of(scene)),
            Self::Bvh { bvh, .. } => Method::Bvh(bvh),
            Self::Reference(reference) => Method::Reference(reference),
        }
    }
}

fn full_bvh(scene: &Scene, leaves: LeafArgs, wide_boxes: bool, cache: &Cache) -> anyhow::Result<Built> {
    let options = FullOptions::new(leaves.leaf_size, wide_boxes, leaves.leaf_layout.into());
    let begun = std::time::Instant::now();
    let made = busy("building the BVH", || {
        let hierarchy = scene.decode();
        let found = cache.tree(scene, &options.tree, wide_boxes, || FullBuilder::new(&hierarchy)?.tree(&options.tree, wide_boxes))?;
        Ok::<_, BvhError>((found.tree.with_leaves(&hierarchy, options.layout)?, found.read))
    });
    let (bvh, read) = made?;
    Ok(Built::Bvh { bvh, making: Making { read, seconds: begun.elapsed().as_secs_f64() } })
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let scene = open(&args.scene)?;
    let space = ModelSpace::of(&scene);
    let camera = args.camera.camera(&space, None)?;
    let pictures = ["image.png", "levels.png", "normals.png", "error.png"];
    folder(&args.out, pictures.into_iter().take(3 + usize::from(args.compare)), Some(&args.scene))?;

    let cache = Cache::new(&args.cache)?;
    let built = Built::new(args.method, &scene, args.leaves, &cache)?;
    let begun = std::time::Instant::now();
    let shot = built.shoot(&scene, &space, &camera, args.delta, "tracing");
    let seconds = begun.elapsed().as_secs_f64();
    let making = built.making();
    drop(built);

    let error = if args.compare {
        let truth =
            Built::new(MethodName::Reference, &scene, args.leaves, &cache)?.shoot(&scene, &space, &camera, args.delta, "full resolution");
        shot.save_error(&truth, &args.out, "")?;
        Some(compare_shots(&shot, &truth, &scene, &camera))
    } else {
        None
    };
    shot.save(&scene, &args.out, "", true)?;

    let stats = shot.frame.stats;
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
        method: args.method,
        delta: args.delta,
        size: [camera.width, camera.height],
        eye: camera.eye.to_array(),
        seconds,
        making,
        stats,
        per_ray,
        error,
    };
    if args.json {
        print_json(&report)?
    } else {
        print_line(&table(&report, &args.out))?
    }
    Ok(ExitCode::SUCCESS)
}

fn kind_per_ray(k: &KindCount, rays: u64) -> KindPerRay {
    let mean = |n: u64| n as f64 / rays as f64;
    KindPerRay { kind: k.kind, lines_read: mean(k.read), bytes_read: 32.0 * mean(k.read), distinct_lines: mean(k.distinct) }
}

/// Compares a picture with the true one.
pub fn compare_shots(shot: &Shot, truth: &Shot, scene: &Scene, camera: &Camera) -> Comparison {
    let differs = shot.frame.pixels.iter().zip(&truth.frame.pixels).filter(|(a, b)| a.is_some() != b.is_some()).count();
    let cosine = |index, pixel: &Pixel| f64::from(view_cosine(scene, camera, index, pixel));
    Comparison {
        image: compare(&shot.image, &truth.image),
        coverage_differs: differs as u64,
        geometry_pixels: geometric_error(&shot.frame, &truth.frame, camera, cosine),
    }
}

fn table(r: &Report, out: &std::path::Path) -> String {
    let making = r.making.map_or_else(String::new, |making| format!("{making}, tracing "));
    let mut text = format!(
        "{} rays, {} hit, {making}{:.2} s\nper ray: {:.2} nodes, {:.2} LOD tests, {:.2} triangles, {:.2} lines read ({:.0} bytes)\nmean level {:.3}\n",
        grouped(r.stats.rays),
        grouped(r.stats.hits),
        r.seconds,
        r.per_ray.nodes,
        r.per_ray.lod_tests,
        r.per_ray.triangles,
        r.per_ray.lines_read,
        r.per_ray.bytes_read,
        r.stats.mean_level,
    );
    if !r.stats.lines.is_empty() {
        let mut line = |cells: [&str; 6]| {
            let [kind, cells @ ..] = cells;
            let cells: String = cells.iter().map(|c| format!("{c:>16}")).collect();
            text += &format!("{kind:<14}{cells}\n");
        };
        line(["lines of", "read", "distinct", "read/ray", "bytes/ray", "distinct/ray"]);
        for (k, per) in r.stats.lines.iter().zip(&r.per_ray.by_kind) {
            let means = [per.lines_read, per.bytes_read, per.distinct_lines].map(|v| format!("{v:.3}"));
            line([k.kind.name(), &grouped(k.read), &grouped(k.distinct), &means[0], &means[1], &means[2]]);
        }
        let means = [r.per_ray.lines_read, r.per_ray.bytes_read, r.per_ray.distinct_lines].map(|v| format!("{v:.3}"));
        line(["all", &grouped(r.stats.lines_read()), &grouped(r.stats.distinct_lines()), &means[0], &means[1], &means[2]]);
    }
    if let Some(e) = &r.error {
        let psnr = e.image.psnr_db.map_or("infinite".to_owned(), |p| format!("{p:.2} dB"));
        text += &format!(
            "against full resolution: RMSE {:.3}, PSNR {psnr}, maximum {}, {:.2} % of pixels differ, {} differ in coverage\nsurface off by {:.3} pixels in the mean, 99 of 100 below {:.3}\n",
            e.image.rmse,
            e.image.maximum,
            100.0 * e.image.differing,
            grouped(e.coverage_differs),
            e.geometry_pixels.mean,
            e.geometry_pixels.percentile_99
        );
    }
    text + &format!("pictures in {}", out.display())
}
