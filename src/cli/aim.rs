//! A description as one thing to look at: its models, the space that they fill, and its camera where options say nothing else.

use super::args::{CameraArgs, number};
use super::made;
use anyhow::{Context, ensure};
use clap::Args;
use lodray::format::Scene;
use lodray::method::packet;
use lodray::paths::SceneFile;
use lodray::rays::ModelSpace;
use lodray::study::Chosen;
use std::path::Path;

/// When a description is looked at.
#[derive(Args, Clone, Copy)]
pub struct TimeArg {
    /// Where the models of a description stand that move: from 0, their first place, to 1, their last (default: 0)
    #[arg(long, value_name = "TIME", value_parser = time, allow_negative_numbers = true)]
    time: Option<f64>,
}

fn time(s: &str) -> Result<f64, String> {
    number(s, |v| (0.0..=1.0).contains(&v), "a time from 0 to 1")
}

impl TimeArg {
    /// The description then.
    pub fn of(self, file: SceneFile) -> SceneFile {
        file.at(self.time.unwrap_or(file.time))
    }
}

/// Which of a description's cameras looks, and when.
#[derive(Args)]
pub struct AimArgs {
    /// Camera of a description, by its name (default: the first); what other options say overrules it
    #[arg(id = "own_camera", long = "camera", value_name = "NAME")]
    name: Option<String>,
    #[command(flatten)]
    time: TimeArg,
}

impl AimArgs {
    /// The names of those that choose a camera.
    pub fn camera_ids() -> impl IntoIterator<Item = clap::Id> {
        [clap::Id::from("own_camera")]
    }

    /// Refuses what is said where there is no description.
    pub fn check(&self) -> anyhow::Result<()> {
        ensure!(self.name.is_none(), "--camera: goes with the description of several models");
        ensure!(self.time.time.is_none(), "--time: goes with the description of several models");
        Ok(())
    }

    /// Refuses a time where frames have times of their own.
    pub fn check_frames(&self, frames: u32) -> anyhow::Result<()> {
        ensure!(frames == 1 || self.time.time.is_none(), "--time: is of one frame; several lie evenly from time 0 to time 1");
        Ok(())
    }
}

/// What a description comes to.
pub struct Aimed {
    pub file: SceneFile,
    /// The models, in its order.
    pub scenes: Vec<Scene>,
    /// Of all of them, where they stand.
    pub space: ModelSpace,
}

impl Aimed {
    /// Loads the models of a description for a method.
    ///
    /// # Errors
    /// A model cannot be had, or the method is of no use for several.
    pub fn load(path: &Path, file: SceneFile, aim: &AimArgs, chosen: &Chosen) -> anyhow::Result<Self> {
        let file = aim.time.of(file);
        let method = chosen.method.name;
        ensure!(!chosen.method.of_input(), "--method {method}: meshes that scenes were built from are not looked for among several models");
        ensure!(packet::chosen(&chosen.knobs) == 1, "--packet: rays through several models are traced one by one");
        let scenes = made::scenes(path, &file)?;
        let space = made::space(&file, &scenes);
        Ok(Self { file, scenes, space })
    }

    /// The camera's options, with what the description says where they say nothing.
    pub fn camera(&self, path: &Path, aim: &AimArgs, args: &CameraArgs) -> anyhow::Result<CameraArgs> {
        let table = made::camera_table(&self.file, aim.name.as_deref()).with_context(|| path.display().to_string())?;
        Ok(args.or(table, [self.file.picture.width, self.file.picture.height], &self.space))
    }
}
