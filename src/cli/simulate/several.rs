//! A frame of several models.

use crate::cli::aim::{AimArgs, Aimed};
use crate::cli::args::CameraArgs;
use crate::cli::bars::Bars;
use crate::cli::frames::FrameArgs;
use crate::cli::made;
use anyhow::Context;
use lodray::paths::SceneFile;
use lodray::rays::RayFile;
use lodray::scene::{Outcome, PassRays, Target, WorldPass};
use lodray::study::{Cache, Chosen, simulate_models};
use std::path::{Path, PathBuf};

/// What is simulated.
pub struct Several<'a> {
    /// The description's file.
    pub path: &'a Path,
    pub chosen: &'a Chosen,
    /// A file of rays, in place of a camera's.
    pub rays: Option<&'a PathBuf>,
    pub camera: &'a CameraArgs,
    pub aim: &'a AimArgs,
    pub frames: &'a FrameArgs,
    /// Tiles whose rays are handed out in turn.
    pub tiles_in_turn: u32,
    pub cache: &'a Cache,
}

impl Several<'_> {
    /// Simulates the rays of the description's camera, or of a file, through its models. Once the rays are known `open` makes what results go to, which comes back with them.
    pub fn run<T>(
        &self,
        file: SceneFile,
        targets: &[Target],
        open: impl FnOnce() -> anyhow::Result<T>,
    ) -> anyhow::Result<(T, Vec<Outcome>)> {
        let Self { path, chosen, .. } = *self;
        let aimed = Aimed::load(path, file, self.aim, chosen)?;
        self.aim.check_frames(self.frames.count())?;
        let rays = match self.rays {
            Some(rays) => PassRays::File(RayFile::read(rays)?, rays.clone()),
            None => self.frames.rays(&aimed.camera(path, self.aim, self.camera)?, &aimed.space)?.in_turn(self.tiles_in_turn),
        };
        let opened = open()?;
        let scene = made::facts(path, &aimed.file, &aimed.scenes)?;
        let methods = made::methods(&aimed.file, &aimed.scenes, chosen, self.cache)?;
        let worlds = made::seen(&aimed.file, &aimed.scenes, &methods, rays.cameras(), chosen.delta());
        let pass = WorldPass { worlds: &worlds, scene, registered: chosen.method, knobs: &chosen.knobs, rays };
        let outcomes = simulate_models(&pass, targets, &Bars).with_context(|| path.display().to_string())?;
        Ok((opened, outcomes))
    }
}
