//! Frames after one another: `--frames` with `--turn` or `--path`.

use super::args::{CameraArgs, degrees, whole};
use super::output::toml_in_one_line;
use anyhow::Context;
use clap::Args;
use glam::DVec3;
use lodray::rays::{CameraPath, ModelSpace};
use lodray::scene::PassRays;
use lodray::study::Turning;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Frames, at most.
const MOST: u64 = 10_000;

#[derive(Args, Clone, Copy)]
pub struct TurnArgs {
    /// Frames after one another; each finds the caches as the one before left them. Their second half gives the cost of a warm frame
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole::<u32>(1..=MOST), allow_negative_numbers = true)]
    frames: u32,
    /// Degrees that the camera turns about its target from frame to frame, counter-clockwise from above
    #[arg(long, value_name = "DEGREES", default_value_t = 3.0, value_parser = degrees, allow_hyphen_values = true)]
    turn: f64,
}

impl TurnArgs {
    /// The turn, if there are several frames.
    pub fn turning(self) -> Option<Turning> {
        (self.frames > 1).then_some(Turning { frames: self.frames, degrees: self.turn })
    }
}

#[derive(Args)]
pub struct FrameArgs {
    #[command(flatten)]
    turn: TurnArgs,
    /// Way of the camera in place of a turn: a TOML file of [[key]] tables, each with an eye and, where it is not the camera's, a target. Frames are spread evenly over it
    #[arg(long, value_name = "FILE", conflicts_with = "turn", requires = "frames")]
    path: Option<PathBuf>,
}

/// The file of a path.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PathFile {
    key: Vec<Key>,
}

/// Where the camera is on its way.
#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct Key {
    eye: [f64; 3],
    target: Option<[f64; 3]>,
}

impl FrameArgs {
    /// The names of all of them.
    pub fn ids() -> impl IntoIterator<Item = clap::Id> {
        <Self as Args>::augment_args(clap::Command::new("any")).get_arguments().map(|arg| arg.get_id().clone()).collect::<Vec<_>>()
    }

    /// How many frames there are.
    pub fn count(&self) -> u32 {
        self.turn.frames
    }

    /// The file that is read, if one is.
    pub fn input(&self) -> Option<&PathBuf> {
        self.path.as_ref()
    }

    /// The rays of the camera, in one frame or more.
    pub fn rays(&self, camera: &CameraArgs, space: &ModelSpace) -> anyhow::Result<PassRays> {
        if let Some(file) = &self.path {
            return Ok(PassRays::Path(along(file, self.turn.frames, camera, space)?));
        }
        let camera = camera.camera(space, None)?;
        Ok(self.turn.turning().map_or(PassRays::Camera(camera), |turning| PassRays::Path(turning.path(&camera))))
    }
}

/// Reads the keys of a file, and spreads `frames` cameras over the way through them.
pub fn along(file: &Path, frames: u32, camera: &CameraArgs, space: &ModelSpace) -> anyhow::Result<CameraPath> {
    let named = || file.display().to_string();
    let text = std::fs::read_to_string(file).with_context(named)?;
    let keys = toml::from_str::<PathFile>(&text).map_err(|error| toml_in_one_line(&named(), &error))?.key;
    anyhow::ensure!(keys.len() > 1, "{}: key: a path has two [[key]] tables or more", named());
    anyhow::ensure!(frames > 1, "--path: needs --frames of 2 or more");
    let target = camera.camera(space, None)?.target.to_array();
    let points: Vec<_> = keys.iter().map(|key| [key.eye, key.target.unwrap_or(target)].map(DVec3::from_array)).collect();
    between(&points, frames, camera, space).with_context(named)
}

/// Spreads `frames` cameras evenly over the way through two or more `points`, each an eye and a target.
pub fn between(points: &[[DVec3; 2]], frames: u32, camera: &CameraArgs, space: &ModelSpace) -> anyhow::Result<CameraPath> {
    let frame = |frame: u32| {
        let way = f64::from(frame) / f64::from(frames.max(2) - 1) * (points.len() - 1) as f64;
        let from = (way as usize).min(points.len() - 2);
        let [eye, target] = std::array::from_fn(|k| points[from][k].lerp(points[from + 1][k], way - from as f64).to_array());
        camera.at(space, eye, target).with_context(|| format!("frame {}", frame + 1))
    };
    Ok(CameraPath::new((0..frames).map(frame).collect::<anyhow::Result<_>>()?))
}
