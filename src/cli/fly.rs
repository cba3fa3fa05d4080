//! `fly`: a camera that moves, frame by frame, and what pops between them.

use super::args::{CameraArgs, radii, whole};
use super::bars::Bars;
use super::cache::CacheArgs;
use super::folder::{Overrule, RunFolder, one_run};
use super::frames::{along, between};
use super::method::PictureMethod;
use super::output::{open_any, print_json, print_table, remark};
use anyhow::{Context, ensure};
use lodray::picture::{Pops, save_png};
use lodray::rays::{CameraPath, ModelSpace};
use lodray::study::pruned::{self, check_normals};
use lodray::study::{Flown, Fly, count, fly};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Figures of every frame.
const FIGURES: &str = "flight.json";
/// Most frames of a flight.
const MOST_FRAMES: u64 = 100_000;

#[derive(clap::Args)]
#[command(mut_arg("size", |size| size.help("Picture size in pixels").default_value("512x512")), mut_arg("distance", |distance| distance.conflicts_with("path")))]
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
    /// Way of the camera: a TOML file of [[key]] tables, each with an eye and, where it is not the camera's, a target. Frames are spread evenly over it
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
    let path = cameras(args, &space)?;
    let cameras = path.cameras();
    for camera in cameras {
        pruned::check(&scene, camera, delta)?;
    }
    check_normals(&scene, "a picture")?;
    chosen.check(&scene)?;
    let pictures: Vec<_> = if args.no_pictures { Vec::new() } else { (0..cameras.len()).map(picture).collect() };
    let names = pictures.iter().map(String::as_str).chain([FIGURES]);
    let inputs: Vec<_> = std::iter::once(&args.scene).chain(&args.path).map(PathBuf::as_path).collect();
    let folder = RunFolder::open(&args.out, names, &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;
    let (method, _) = chosen.make(&scene, &cache, &Bars)?;
    let what = Fly { scene: &scene, method: &*method, delta, cameras };
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
fn cameras(args: &Args, space: &ModelSpace) -> anyhow::Result<CameraPath> {
    if let Some(path) = &args.path {
        return along(path, args.frames, &args.camera, space);
    }
    let from = args.camera.camera(space, None)?;
    let to = args.camera.camera(space, Some(args.to.unwrap_or(0.25 * from.radii)))?;
    between(&[[from.eye, from.target], [to.eye, to.target]], args.frames, &args.camera, space)
}

/// The most of all frames.
fn worst(frames: &[Flown]) -> Pops {
    frames.iter().filter_map(|frame| frame.pops).fold(Pops::default(), |mut most, pops| {
        for (most, own) in [(&mut most.surface, pops.surface), (&mut most.colour, pops.colour)] {
            most.mean = most.mean.max(own.mean);
            most.percentile_999 = most.percentile_999.max(own.percentile_999);
            most.largest = most.largest.max(own.largest);
        }
        (most.pixels, most.left_out) = (most.pixels.max(pops.pixels), most.left_out.max(pops.left_out));
        most
    })
}

fn table(report: &Report) -> String {
    let mut text = format!("{:>6} {:>8} {:>26} {:>26}\n", "", "", "surface pops, pixel widths", "colour pops, 0 to 255");
    text += &format!("{:>6} {:>8} {:>12} {:>13} {:>12} {:>13}  {}\n", "frame", "level", "99.9 %", "largest", "99.9 %", "largest", "chosen");
    for Flown { frame, mean_level, choices, pops, .. } in &report.frames {
        let chosen: Vec<_> = choices.iter().map(|(name, value)| format!("{name} {value}")).collect();
        let Pops { surface, colour, .. } = pops.unwrap_or_default();
        let line = format!(
            "{frame:>6} {mean_level:>8.3} {:>12.4} {:>13.4} {:>12.1} {:>13.1}  {}",
            surface.percentile_999,
            surface.largest,
            colour.percentile_999,
            colour.largest,
            chosen.join(", ")
        );
        text += line.trim_end();
        text.push('\n');
    }
    text
}
