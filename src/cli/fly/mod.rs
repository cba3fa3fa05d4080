//! `fly`: a camera that moves, frame by frame, and what pops between them.

mod several;

use super::aim::AimArgs;
use super::args::{CameraArgs, radii, whole};
use super::bars::Bars;
use super::cache::CacheArgs;
use super::folder::{Overrule, RunFolder, one_run};
use super::frames::{along, between};
use super::made::is_description;
use super::method::PictureMethod;
use super::output::{open_any, print_json, print_table, remark};
use anyhow::{Context, ensure};
use lodray::picture::{Pops, save_png};
use lodray::rays::{CameraPath, ModelSpace};
use lodray::study::pruned::{self, check_normals};
use lodray::study::{Flown, Fly, Shot, count, fly};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Figures of every frame.
const FIGURES: &str = "flight.json";
/// Most frames of a flight.
const MOST_FRAMES: u64 = 100_000;

#[derive(clap::Args)]
#[command(mut_arg("size", |size| size.help("Picture size in pixels").default_value("512x512")), mut_arg("distance", |distance| distance.conflicts_with("path")))]
pub struct Args {
    /// Scene file, or the description of several models (TOML; `paths --help` has the keys): its models move from their first places to their last, the camera only if --to, --path or --distance moves it, and nothing is said of pops
    scene: PathBuf,
    #[command(flatten)]
    method: PictureMethod,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    aim: AimArgs,
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
    /// The worst of all frames; none among several models.
    #[serde(skip_serializing_if = "Option::is_none")]
    worst: Option<Pops>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if is_description(&args.scene) {
        return several::run(args);
    }
    args.aim.check()?;
    let scene = open_any(&args.scene)?;
    ensure!(!args.method.original, "--method original: fly a scene of its own of the mesh");
    let space = ModelSpace::of(&scene);
    let (chosen, delta) = (&args.method.chosen, args.method.chosen.delta());
    let path = cameras(args, &args.camera, &space, Some(0.25))?;
    let cameras = path.cameras();
    for camera in cameras {
        pruned::check(&scene, camera, delta)?;
    }
    check_normals(&scene, "a picture")?;
    chosen.check(&scene)?;
    let inputs: Vec<_> = std::iter::once(&args.scene).chain(&args.path).map(PathBuf::as_path).collect();
    let kept = Kept::open(args, cameras.len(), &inputs)?;
    let cache = args.cache.cache(Some(&args.out))?;
    let (method, _) = chosen.make(&scene, &cache, &Bars)?;
    let what = Fly { scene: &scene, method: &*method, delta, cameras };
    let frames = fly(&what, &Bars, &mut |frame, shot| kept.save(frame, shot))?;
    let worst = Some(worst(&frames));
    kept.finish(args, &Report { method: args.method.name(), delta, size: cameras[0].pixels(), frames, worst })
}

/// Where frames and their figures go.
struct Kept {
    folder: RunFolder,
    /// Names of the frames' pictures, if they are kept.
    pictures: Vec<String>,
}

impl Kept {
    /// The folder for so many frames, made from these files.
    fn open(args: &Args, frames: usize, inputs: &[&Path]) -> anyhow::Result<Self> {
        let pictures: Vec<_> = if args.no_pictures { Vec::new() } else { (0..frames).map(picture).collect() };
        let names = pictures.iter().map(String::as_str).chain([FIGURES]);
        Ok(Self { folder: RunFolder::open(&args.out, names, inputs, &args.overrule)?, pictures })
    }

    /// Keeps the picture of a frame.
    fn save(&self, frame: usize, shot: &Shot) -> anyhow::Result<()> {
        let Some(name) = self.pictures.get(frame) else { return Ok(()) };
        let path = self.folder.staging().join(name);
        save_png(&shot.image, &[], &path).with_context(|| format!("cannot write {}", path.display()))
    }

    /// Keeps the figures, and says what they are.
    fn finish(self, args: &Args, report: &Report) -> anyhow::Result<ExitCode> {
        let path = self.folder.staging().join(FIGURES);
        std::fs::write(&path, serde_json::to_string_pretty(report)?).with_context(|| format!("cannot write {}", path.display()))?;
        self.folder.finish()?;
        if args.json {
            print_json(report)?;
        } else {
            print_table(&table(report))?;
            remark(&format!("{} and {FIGURES} in {}", count(self.pictures.len() as u64, "frame"), args.out.display()))?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

fn picture(frame: usize) -> String {
    format!("frame-{frame:05}.png")
}

/// The cameras of all frames, which fly to `part` of their distance if nothing else is said; by default they stand still.
fn cameras(args: &Args, camera: &CameraArgs, space: &ModelSpace, part: Option<f64>) -> anyhow::Result<CameraPath> {
    if let Some(path) = &args.path {
        return along(path, args.frames, camera, space);
    }
    let from = camera.camera(space, None)?;
    let to = match args.to.or(part.map(|part| part * from.radii)) {
        Some(radii) => camera.camera(space, Some(radii))?,
        None => from,
    };
    between(&[[from.eye, from.target], [to.eye, to.target]], args.frames, camera, space)
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
    if report.worst.is_none() {
        return plain_table(report);
    }
    let mut text = format!("{:>6} {:>8} {:>26} {:>26}\n", "", "", "surface pops, pixel widths", "colour pops, 0 to 255");
    text += &format!("{:>6} {:>8} {:>12} {:>13} {:>12} {:>13}  {}\n", "frame", "level", "99.9 %", "largest", "99.9 %", "largest", "chosen");
    for Flown { frame, mean_level, choices, pops, .. } in &report.frames {
        let Pops { surface, colour, .. } = pops.unwrap_or_default();
        let line = format!(
            "{frame:>6} {mean_level:>8.3} {:>12.4} {:>13.4} {:>12.1} {:>13.1}  {}",
            surface.percentile_999,
            surface.largest,
            colour.percentile_999,
            colour.largest,
            chosen(choices)
        );
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// The same of several models.
fn plain_table(report: &Report) -> String {
    let mut text = format!("{:>6} {:>8}  {}\n", "frame", "level", "chosen");
    for Flown { frame, mean_level, choices, .. } in &report.frames {
        text += format!("{frame:>6} {mean_level:>8.3}  {}", chosen(choices)).trim_end();
        text.push('\n');
    }
    text
}

/// What a method chose, in a line.
fn chosen(choices: &[(&str, String)]) -> String {
    choices.iter().map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", ")
}
