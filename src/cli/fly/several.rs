//! A flight among several models, which may move themselves.

use super::kept::{Kept, Report};
use crate::cli::aim::{AimArgs, Aimed};
use crate::cli::args::CameraArgs;
use crate::cli::bars::Bars;
use crate::cli::made;
use anyhow::Context;
use lodray::rays::{Camera, CameraPath, ModelSpace};
use lodray::study::{Cache, Chosen, fly_models};
use std::path::{Path, PathBuf};

/// What flies where.
pub struct Several<'a> {
    /// The description's file.
    pub path: &'a Path,
    pub chosen: &'a Chosen,
    pub aim: &'a AimArgs,
    pub camera: &'a CameraArgs,
    pub cache: &'a Cache,
}

impl Several<'_> {
    /// Flies along the way that `way` makes of the camera and the space of all models; frame k of n stands at time k / (n - 1). `open` makes what frames go to, of the models' files and the
    /// cameras.
    pub fn run<'k>(
        &self,
        way: impl FnOnce(&CameraArgs, &ModelSpace) -> anyhow::Result<CameraPath>,
        open: impl FnOnce(&[PathBuf], &[Camera]) -> anyhow::Result<Kept<'k>>,
    ) -> anyhow::Result<(Kept<'k>, Report)> {
        let Self { path, chosen, .. } = *self;
        let file = made::description(path)?;
        let models = made::model_files(path, &file)?;
        let aimed = Aimed::load(path, file, self.aim, chosen)?;
        let camera = aimed.camera(path, self.aim, self.camera)?;
        let Aimed { file, scenes, space } = &aimed;
        let flight = way(&camera, space)?;
        let cameras = flight.cameras();
        let kept = open(&models, cameras)?;
        let methods = made::methods(file, scenes, chosen, self.cache)?;
        let world = |frame: usize| {
            let time = if cameras.len() > 1 { frame as f64 / (cameras.len() - 1) as f64 } else { file.time };
            made::seen(&file.at(time), scenes, &methods, &cameras[frame..=frame], chosen.delta()).remove(0)
        };
        let save = &mut |frame, shot: &_| kept.save(frame, shot);
        let frames = fly_models(&world, cameras, &Bars, save).with_context(|| path.display().to_string())?;
        let report = Report { method: chosen.method.name, delta: chosen.delta(), size: cameras[0].pixels(), frames, worst: None };
        Ok((kept, report))
    }
}
