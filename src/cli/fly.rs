//! `fly`: a camera that moves, frame by frame, and what pops between them.

use super::args::{CameraArgs, radii, whole};
use super::bars::Bars;
use super::cache::CacheArgs;
use super::folder::{Overrule, RunFolder, one_run};
use super::method::PictureMethod;
use super::output::{open_any, print_json, print_table, remark, toml_in_one_line};
use anyhow::{Context, ensure};
use glam::DVec3;
use lodray::method::lod;
use lodray::picture::{Pops, save_png};
use lodray::rays::{Camera, ModelSpace, flight};
use lodray::study::pruned::{self, check_normals};
use lodray::study::{Chosen, Flown, Fly, count, fly};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Figures of every frame.
const FIGURES: &str = "flight.json";
/// Most frames of a flight.
const MOST_FRAMES: u64 = 100_000;

#[derive(clap::Args)]
#[command(mut_arg("size", |size| size.default_value("512x512")), mut_arg("distance", |distance| distance.conflicts_with("path")))]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    #[command(flatten)]
    method: PictureMethod,
    #[command(flatten)]
    camera: CameraArgs,
    /// Fly straight to this distance from the target, in bounding radii, from --distance (default: a quarter of where the flight begins)
    #[arg(long, value_name = "RADII", value_parser = radii, allow_hyphen_values = true, conflicts_with = "path")]
    to: Option<f64>,
    /// Fly through the keys of a file (TOML): each a [[key]] with eye and target, three numbers each
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Frames
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=MOST_FRAMES), default_value = "60", allow_negative_numbers = true)]
    frames: u32,
    #[command(flatten)]
    cache: CacheArgs,
    /// Folder for the frames (frame-00000.png and so on) and their figures
    #[arg(short, long, default_value = "out/flight", long_help = one_run("Folder for the frames (frame-00000.png and so on) and their figures"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Keep no pictures, only figures
    #[arg(long)]
    no_pictures: bool,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// A file of keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    key: Vec<Key>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Key {
    eye: [f64; 3],
    target: [f64; 3],
}

/// What a flight gave.
#[derive(Serialize)]
struct Report {
    method: &'static str,
    delta: f64,
    size: [u32; 2],
    frames: Vec<Flown>,
    /// The worst of all frames.
    worst: Pops,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let scene = open_any(&args.scene)?;
    ensure!(!args.method.original, "--method original: fly a scene of its own of the mesh");
    let space = ModelSpace::of(&scene);
    let (chosen, delta) = (&args.method.chosen, args.method.chosen.delta());
    let cameras = cameras(args, &space)?;
    for camera in &cameras {
        pruned::check(&scene, camera, delta)?;
        pruned::check(&scene, camera, f64::INFINITY).context("what pops is found beside full resolution")?;
    }
    check_normals(&scene, "a picture")?;
    chosen.check(&scene)?;
    let pictures: Vec<_> = if args.no_pictures { Vec::new() } else { (0..cameras.len()).map(picture).collect() };
    let names = pictures.iter().map(String::as_str).chain([FIGURES]);
    let inputs: Vec<_> = std::iter::once(&args.scene).chain(&args.path).map(PathBuf::as_path).collect();
    let folder = RunFolder::open(&args.out, names, &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;
    let (method, _) = chosen.make(&scene, &cache, &Bars)?;
    let (full, _) = Chosen::plain(&lod::METHOD).make(&scene, &cache, &Bars)?;
    let what = Fly { scene: &scene, method: &*method, full: &*full, delta, cameras: &cameras };
    let frames = fly(&what, &Bars, &mut |frame, shot| {
        let Some(name) = pictures.get(frame) else { return Ok(()) };
        let path = folder.staging().join(name);
        save_png(&shot.image, &[], &path).with_context(|| format!("cannot write {}", path.display()))
    })?;
    let worst = worst(&frames);
    let report = Report { method: args.method.name(), delta, size: [cameras[0].width, cameras[0].height], frames, worst };
    let path = folder.staging().join(FIGURES);
    std::fs::write(&path, serde_json::to_string_pretty(&report)?).with_context(|| format!("cannot write {}", path.display()))?;
    folder.finish()?;
    if args.json {
        print_json(&report)?;
    } else {
        print_table(&table(&report))?;
        remark(&format!("{} and {FIGURES} in {}", count(pictures.len() as u64, "frame"), args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn picture(frame: usize) -> String {
    format!("frame-{frame:05}.png")
}

/// The cameras of all frames.
fn cameras(args: &Args, space: &ModelSpace) -> anyhow::Result<Vec<Camera>> {
    let keys: Vec<[DVec3; 2]> = match &args.path {
        Some(path) => keys(path)?,
        None => {
            let from = args.camera.camera(space, None)?;
            let to = args.camera.camera(space, Some(args.to.unwrap_or(0.25 * from.radii)))?;
            vec![[from.eye, from.target], [to.eye, to.target]]
        }
    };
    let first = args.camera.camera(space, None)?;
    let camera = |(frame, [eye, target]): (usize, [DVec3; 2])| {
        let view = lodray::rays::View {
            eye: Some(eye.to_array()),
            target: Some(target.to_array()),
            up: Some(first.up.to_array()),
            fov: first.fov,
            ..lodray::rays::View::default()
        };
        Camera::new(&view, space, first.width, first.height).with_context(|| format!("frame {frame}"))
    };
    flight(&keys, args.frames).into_iter().enumerate().map(camera).collect()
}

/// The keys of a file.
fn keys(path: &Path) -> anyhow::Result<Vec<[DVec3; 2]>> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| file.clone())?;
    let Keys { key } = toml::from_str(&text).map_err(|error| toml_in_one_line(&file, &error))?;
    ensure!(!key.is_empty(), "{file}: key must have at least one");
    Ok(key.into_iter().map(|key| [key.eye, key.target].map(DVec3::from_array)).collect())
}

/// The most of all frames.
fn worst(frames: &[Flown]) -> Pops {
    frames.iter().filter_map(|frame| frame.pops).fold(Pops::default(), |mut most, pops| {
        for (most, own) in [(&mut most.depth, pops.depth), (&mut most.colour, pops.colour)] {
            most.mean = most.mean.max(own.mean);
            most.percentile_999 = most.percentile_999.max(own.percentile_999);
            most.largest = most.largest.max(own.largest);
        }
        (most.pixels, most.outlines) = (most.pixels.max(pops.pixels), most.outlines.max(pops.outlines));
        most
    })
}

fn table(report: &Report) -> String {
    let mut text = format!("{:>6} {:>8} {:>26} {:>26}\n", "", "", "depth pops, pixel widths", "colour pops, of 255");
    text += &format!("{:>6} {:>8} {:>12} {:>13} {:>12} {:>13}  {}\n", "frame", "level", "99.9 %", "largest", "99.9 %", "largest", "chosen");
    for Flown { frame, mean_level, choices, pops, .. } in &report.frames {
        let chosen: Vec<_> = choices.iter().map(|(name, value)| format!("{name} {value}")).collect();
        let Pops { depth, colour, .. } = pops.unwrap_or_default();
        let line = format!(
            "{frame:>6} {mean_level:>8.3} {:>12.4} {:>13.4} {:>12.1} {:>13.1}  {}",
            depth.percentile_999,
            depth.largest,
            colour.percentile_999,
            colour.largest,
            chosen.join(", ")
        );
        text += line.trim_end();
        text.push('\n');
    }
    text
}
