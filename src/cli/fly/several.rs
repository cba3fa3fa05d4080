//! A flight among several models, which may move themselves.

use super::{Args, Kept, Report, cameras};
use crate::cli::aim::Aimed;
use crate::cli::bars::Bars;
use crate::cli::made;
use anyhow::{Context, ensure};
use lodray::study::fly_models;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Frame k of n stands at time k / (n - 1).
pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    ensure!(!args.method.original, "--method original: is of one scene, and not of several models");
    args.aim.check_frames(args.frames)?;
    let (path, chosen) = (&args.scene, &args.method.chosen);
    let file = made::description(path)?;
    let models = made::model_files(path, &file)?;
    let aimed = Aimed::load(path, file, &args.aim, chosen)?;
    let camera = aimed.camera(path, &args.aim, &args.camera)?;
    let Aimed { file, scenes, space } = &aimed;
    let flight = cameras(args, &camera, space, None)?;
    let cameras = flight.cameras();
    let inputs: Vec<&Path> = [path].into_iter().chain(&args.path).chain(&models).map(PathBuf::as_path).collect();
    let kept = Kept::open(args, cameras.len(), &inputs)?;
    let methods = made::methods(file, scenes, chosen, &args.cache.cache(Some(&args.out))?)?;
    let world = |frame: usize| {
        let time = if cameras.len() > 1 { frame as f64 / (cameras.len() - 1) as f64 } else { file.time };
        made::seen(&file.at(time), scenes, &methods, &cameras[frame..=frame], chosen.delta()).remove(0)
    };
    let frames =
        fly_models(&world, cameras, &Bars, &mut |frame, shot| kept.save(frame, shot)).with_context(|| path.display().to_string())?;
    kept.finish(args, &Report { method: args.method.name(), delta: chosen.delta(), size: cameras[0].pixels(), frames, worst: None })
}
