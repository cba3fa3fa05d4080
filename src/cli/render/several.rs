//! A picture of several models.

use super::files::save;
use super::report::{PerRay, Report, Seconds};
use crate::cli::aim::{AimArgs, Aimed};
use crate::cli::args::CameraArgs;
use crate::cli::bars::Bars;
use crate::cli::comparison::Against;
use crate::cli::facts::Facts;
use crate::cli::folder::RunFolder;
use crate::cli::made;
use crate::cli::pictures::{Map, levels, normals};
use anyhow::Context;
use lodray::method::knob::DELTA;
use lodray::method::lod;
use lodray::picture::Shading;
use lodray::rays::Camera;
use lodray::study::{Cache, Chosen, Comparison, WorldShot};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What is drawn, and how.
pub struct Several<'a> {
    /// The description's file.
    pub path: &'a Path,
    pub chosen: &'a Chosen,
    pub camera: &'a CameraArgs,
    pub aim: &'a AimArgs,
    pub cache: &'a Cache,
    /// Compare with full resolution.
    pub compare: bool,
    pub shading: Shading,
    /// Along a side of each pixel.
    pub samples: u32,
}

impl Several<'_> {
    /// Draws it into the folder that `open` makes, being told what is read.
    pub fn run(&self, open: impl FnOnce(&[&Path]) -> anyhow::Result<RunFolder>) -> anyhow::Result<Report> {
        let Self { path, chosen, shading, .. } = *self;
        let file = made::description(path)?;
        let models = made::model_files(path, &file)?;
        let aimed = Aimed::load(path, file, self.aim, chosen)?;
        let camera = aimed.camera(path, self.aim, self.camera)?.camera(&aimed.space, None)?;
        let samples = camera.with_samples(self.samples).context("--samples")?;
        let inputs: Vec<&Path> = std::iter::once(path).chain(models.iter().map(PathBuf::as_path)).collect();
        let folder = open(&inputs)?;
        let scene = made::facts(path, &aimed.file, &aimed.scenes)?;

        let begun = Instant::now();
        let methods = made::methods(&aimed.file, &aimed.scenes, chosen, self.cache)?;
        let world = made::seen(&aimed.file, &aimed.scenes, &methods, &[camera], chosen.delta()).remove(0);
        let building = begun.elapsed().as_secs_f64();
        let begun = Instant::now();
        let shaders = world.shaders(shading);
        let drawn = WorldShot::of(&world, &shaders, [&camera, &samples], ("tracing", &Bars)).with_context(|| path.display().to_string())?;
        let seconds = Seconds { building, tracing: begun.elapsed().as_secs_f64() };
        let truth = self.compare.then(|| self.truth(&aimed, [&camera, &samples], &drawn)).transpose()?;

        let choices = world.choices();
        let samples = self.samples * self.samples;
        let facts = Facts {
            scene: &scene.name,
            method: chosen.method.name,
            delta: chosen.method.has(DELTA.name).then(|| chosen.delta()),
            choices: &choices,
            shading: (shading, samples),
            camera: &camera,
            stats: &drawn.shot.stats,
            error: truth.as_ref().map(|(_, error)| (Against::FullResolution, error)),
        };
        let true_image = truth.as_ref().map(|(full, _)| (Against::FullResolution, &full.shot.image));
        let (levels, normals) = (|| levels(&drawn.shot, scene.levels), || normals(drawn.normals(&shaders)));
        save(&drawn.shot, true_image, [&levels as &dyn Fn() -> Map, &normals], &facts, folder.staging())?;
        folder.finish()?;

        let (against, error) = truth.map(|(_, error)| (Against::FullResolution, error)).unzip();
        let stats = drawn.shot.stats;
        Ok(Report {
            method: chosen.method.name,
            delta: chosen.delta(),
            choices: choices.into_iter().collect(),
            shading,
            samples,
            size: [camera.width, camera.height],
            eye: camera.eye.to_array(),
            distance: camera.radii,
            cached: false,
            seconds,
            per_ray: PerRay::from(&stats),
            stats,
            against,
            error,
        })
    }

    /// The same view at full resolution, and how far `drawn` is from it.
    fn truth(&self, aimed: &Aimed, cameras: [&Camera; 2], drawn: &WorldShot) -> anyhow::Result<(WorldShot, Comparison)> {
        // Its hits are exact where it tolerates nothing.
        let methods = made::methods(&aimed.file, &aimed.scenes, &Chosen::plain(&lod::METHOD), self.cache)?;
        let world = made::seen(&aimed.file, &aimed.scenes, &methods, &[*cameras[0]], f64::INFINITY).remove(0);
        let shaders = world.shaders(self.shading);
        let full = WorldShot::of(&world, &shaders, cameras, (Against::FullResolution.name(), &Bars))
            .with_context(|| self.path.display().to_string())?;
        let error = drawn.compared(&full, &shaders, cameras[0]);
        Ok((full, error))
    }
}
