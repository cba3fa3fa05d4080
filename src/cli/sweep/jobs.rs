//! The jobs of a list.

use super::check;
use super::list::Source;
use crate::cli::args::{LeafArgs, SimMethod};
use crate::cli::pass::Target;
use anyhow::Context;
use lodray::mesh::procedural;
use lodray::render::{Camera, DEFAULT_DIRECTION, View};
use lodray::report::results_version;
use lodray::sim::energy;
use lodray::traverse::ModelSpace;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// Where a scene comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    File(PathBuf),
    Generate(procedural::Options),
}

/// A scene and what to see of it.
pub struct SceneJobs {
    pub name: String,
    pub origin: Origin,
    /// Checksum of its file.
    pub content: u64,
    pub views: Vec<ViewJob>,
}

/// A camera, before the scene is there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViewJob {
    pub size: [u32; 2],
    /// In bounding radii from the target; the eye is then only a direction.
    pub distance: Option<f64>,
    pub direction: Option<[f64; 3]>,
    pub eye: Option<[f64; 3]>,
    pub target: Option<[f64; 3]>,
    pub up: Option<[f64; 3]>,
    pub fov: f64,
}

impl ViewJob {
    /// The camera on a model.
    pub fn camera(&self, space: &ModelSpace) -> anyhow::Result<Camera> {
        let target = self.target.unwrap_or_else(|| space.centre());
        let toward = self.direction.map(|d| std::array::from_fn(|k| target[k] + d[k]));
        // Whatever is up: a job's view is that of its keys alone.
        let direction = Some(DEFAULT_DIRECTION);
        let view = View { eye: self.eye.or(toward), direction, target: self.target, up: self.up, distance: self.distance, fov: self.fov };
        // A list has keys where the command line has options.
        Camera::new(&view, space, self.size[0], self.size[1]).map_err(|why| anyhow::anyhow!(why.to_string().replace("--", "")))
    }
}

/// All jobs: each view of each scene, with each method, on each target.
pub struct Jobs {
    pub scenes: Vec<SceneJobs>,
    /// Methods with their qualities; a BVH has but one.
    pub methods: Vec<(SimMethod, f64)>,
    pub targets: Vec<Target>,
    pub leaves: LeafArgs,
    pub error: bool,
    pub intervals: bool,
    /// Files of scenes and machines.
    pub files: BTreeSet<PathBuf>,
}

impl Jobs {
    /// Reads and checks a list; every error names the file.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        check::jobs(&Source { path, text: &text })
    }

    /// The names of all jobs, in order.
    pub fn keys(&self) -> anyhow::Result<Vec<String>> {
        let mut keys = Vec::new();
        for scene in &self.scenes {
            for view in &scene.views {
                for &method in &self.methods {
                    for target in &self.targets {
                        keys.push(self.key(scene, view, method, target)?);
                    }
                }
            }
        }
        Ok(keys)
    }

    /// Name of a job that changes with everything that its result depends on, the program's own version at its end.
    pub fn key(&self, scene: &SceneJobs, view: &ViewJob, (method, quality): (SimMethod, f64), target: &Target) -> anyhow::Result<String> {
        let machine = &target.machine.description;
        let mut inputs = serde_json::to_vec(&(view, &scene.origin, &machine, self.error, self.intervals))?;
        let tables = energy::files(machine)?;
        for file in std::iter::once(&machine.dram.device).chain(&tables) {
            inputs.extend(machine.read(file)?.0.into_bytes());
        }
        if let Origin::File(_) = &scene.origin {
            inputs.extend(scene.content.to_le_bytes());
        }
        let place = match (view.distance, view.eye) {
            (Some(distance), _) => format!("{distance} radii"),
            (None, eye) => format!("{:?}", eye.unwrap_or_default()),
        };
        let quality = if method == SimMethod::Lod {
            format!("delta {quality}")
        } else {
            format!("{} {}", self.leaves.leaf_layout.name(), self.leaves.leaf_size)
        };
        let [width, height] = view.size;
        let (name, compute) = (method.name(), target.compute.name());
        Ok(format!(
            "{}, {place}, {width}x{height}, {name}, {quality}, {}, {compute} #{:016x} {}",
            scene.name,
            target.machine.title(),
            xxh3_64(&inputs),
            results_version()
        ))
    }
}

/// Whether a job's result, by the job's name, is this version's of the program.
pub fn is_of_this_version(key: &str) -> bool {
    key.rsplit_once(' ').is_some_and(|(_, version)| version == results_version())
}
