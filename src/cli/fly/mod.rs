//! `fly`: a camera that moves, frame by frame, and what pops between them.

mod kept;
mod several;

use super::aim::AimArgs;
use super::args::{CameraArgs, radii, whole};
use super::bars::Bars;
use super::cache::CacheArgs;
use super::folder::{Overrule, one_run};
use super::frames::{along, between};
use super::made::is_description;
use super::method::PictureMethod;
use super::output::open_any;
use anyhow::ensure;
use kept::{Kept, Report, worst};
use lodray::rays::{Camera, CameraPath, ModelSpace};
use lodray::study::pruned::{self, check_normals};
use lodray::study::{Fly, fly};
use several::Several;
use std::path::PathBuf;
use std::process::ExitCode;

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

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if is_description(&args.scene) {
        return several(args);
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
    let kept = Kept::open(&args.out, pictures(args, cameras), &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;
    let (method, _) = chosen.make(&scene, &cache, &Bars)?;
    let what = Fly { scene: &scene, method: &*method, delta, cameras };
    let frames = fly(&what, &Bars, &mut |frame, shot| kept.save(frame, shot))?;
    let worst = Some(worst(&frames));
    kept.finish(args.json, &Report { method: args.method.name(), delta, size: cameras[0].pixels(), frames, worst })
}

/// A flight among several models.
fn several(args: &Args) -> anyhow::Result<ExitCode> {
    ensure!(!args.method.original, "--method original: is of one scene, and not of several models");
    args.aim.check_frames(args.frames)?;
    let Args { scene, method, camera, aim, cache, out, overrule, .. } = args;
    let all = Several { path: scene, chosen: &method.chosen, aim, camera, cache: &cache.cache(Some(out))? };
    let open = |models: &[PathBuf], cameras: &[Camera]| {
        let inputs: Vec<_> = std::iter::once(scene).chain(&args.path).chain(models).map(PathBuf::as_path).collect();
        Kept::open(out, pictures(args, cameras), &inputs, overrule)
    };
    let (kept, report) = all.run(|camera, space| cameras(args, camera, space, None), open)?;
    kept.finish(args.json, &report)
}

/// How many pictures are kept.
fn pictures(args: &Args, cameras: &[Camera]) -> usize {
    if args.no_pictures { 0 } else { cameras.len() }
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
