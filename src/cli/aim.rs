//! A description as one thing to look at: its models, the space that they fill, and its camera where options say nothing else.

use super::args::CameraArgs;
use super::made;
use anyhow::{Context, ensure};
use clap::Args;
use lodray::format::Scene;
use lodray::method::packet;
use lodray::paths::SceneFile;
use lodray::rays::ModelSpace;
use lodray::study::Chosen;
use std::path::Path;

#[derive(Args)]
pub struct OwnCamera {
    /// Camera of a description, by its name (default: the first); what other options say overrules it
    #[arg(id = "own_camera", long = "camera", value_name = "NAME")]
    name: Option<String>,
}

impl OwnCamera {
    /// The names of all of them.
    pub fn ids() -> impl IntoIterator<Item = clap::Id> {
        [clap::Id::from("own_camera")]
    }

    /// Refuses a name where there is no description.
    pub fn check(&self) -> anyhow::Result<()> {
        ensure!(self.name.is_none(), "--camera: goes with the description of several models");
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
    pub fn load(path: &Path, file: SceneFile, chosen: &Chosen) -> anyhow::Result<Self> {
        let method = chosen.method.name;
        ensure!(!chosen.method.of_input(), "--method {method}: meshes that scenes were built from are not looked for among several models");
        ensure!(packet::chosen(&chosen.knobs) == 1, "--packet: rays through several models are traced one by one");
        let scenes = made::scenes(path, &file)?;
        let space = made::space(&file, &scenes);
        Ok(Self { file, scenes, space })
    }

    /// The camera's options, with what the description says where they say nothing.
    pub fn camera(&self, path: &Path, own: &OwnCamera, args: &CameraArgs) -> anyhow::Result<CameraArgs> {
        let table = made::camera_table(&self.file, own.name.as_deref()).with_context(|| path.display().to_string())?;
        Ok(args.or(table, [self.file.picture.width, self.file.picture.height], &self.space))
    }
}
