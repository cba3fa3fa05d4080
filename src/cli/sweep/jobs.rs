//! The list of jobs, as a file and as jobs.

use crate::cli::args::{Change, LeafArgs, LeafLayout, SimMethod, Size, delta, radii};
use crate::cli::pass::{Target, machine, machine_files};
use anyhow::Context;
use lodray::mesh::procedural;
use lodray::render::DEFAULT_VIEW_ANGLE_DEGREES;
use lodray::report::result::Compute;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::{self, Display};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct File {
    size: String,
    #[serde(default)]
    distances: Vec<f64>,
    methods: Vec<SimMethod>,
    #[serde(default = "one_pixel")]
    deltas: Vec<Value>,
    #[serde(default = "free")]
    compute: Vec<Compute>,
    #[serde(default = "line")]
    leaf_layout: LeafLayout,
    #[serde(default = "four")]
    leaf_size: u32,
    /// Measure the error of each picture against full resolution.
    #[serde(default)]
    error: bool,
    /// Keep what happened over time.
    #[serde(default)]
    intervals: bool,
    scene: Vec<SceneEntry>,
    machine: Vec<MachineEntry>,
}

fn one_pixel() -> Vec<Value> {
    vec![Value::Number(1.0)]
}

fn free() -> Vec<Compute> {
    vec![Compute::Free]
}

const fn line() -> LeafLayout {
    LeafLayout::Line
}

const fn four() -> u32 {
    4
}

/// A scene: a file, or how to generate one; and its cameras.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneEntry {
    name: Option<String>,
    file: Option<PathBuf>,
    generate: Option<procedural::Scene>,
    levels: Option<u32>,
    base: Option<u32>,
    seed: Option<u64>,
    roughness: Option<f64>,
    size: Option<String>,
    distances: Option<Vec<f64>>,
    /// From the target to the eye, for distances.
    directions: Option<Vec<[f64; 3]>>,
    /// Positions, in place of distances.
    eyes: Option<Vec<[f64; 3]>>,
    target: Option<[f64; 3]>,
    up: Option<[f64; 3]>,
    fov: Option<f64>,
}

/// A machine and its variants: each combination of the values.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MachineEntry {
    name: String,
    #[serde(default)]
    set: BTreeMap<String, Values>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Values {
    One(Value),
    Many(Vec<Value>),
}

/// A value, shown as one would write it on the command line.
#[derive(Deserialize)]
#[serde(untagged)]
enum Value {
    Integer(i64),
    Number(f64),
    Text(String),
}

impl Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(value) => value.fmt(f),
            Self::Number(value) => value.fmt(f),
            Self::Text(value) => value.fmt(f),
        }
    }
}

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

/// All jobs: each view of each scene, with each method, on each target.
pub struct Jobs {
    pub scenes: Vec<SceneJobs>,
    /// Methods with their qualities; a BVH has but one.
    pub methods: Vec<(SimMethod, f64)>,
    pub targets: Vec<Target>,
    pub leaves: LeafArgs,
    pub error: bool,
    pub intervals: bool,
    /// Files that machines were read from.
    machine_files: BTreeSet<PathBuf>,
}

impl Jobs {
    /// Reads and checks a list; every error names the file.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        // The reader's messages are several lines, with a picture of the place.
        let file: File = toml::from_str(&text).map_err(|e| {
            let at = e.span().map_or(1, |span| text[..span.start].matches('\n').count() + 1);
            anyhow::anyhow!("{}: line {at}: {}", path.display(), e.message())
        })?;
        file.jobs(path.parent().unwrap_or(Path::new(""))).with_context(|| path.display().to_string())
    }

    /// The files that the jobs read, as far as they are there: of what is missing, the job fails.
    pub fn files(&self) -> Vec<PathBuf> {
        let scenes = self.scenes.iter().filter_map(|scene| if let Origin::File(file) = &scene.origin { Some(file) } else { None });
        let all: BTreeSet<_> = scenes.filter(|file| file.is_file()).chain(&self.machine_files).cloned().collect();
        all.into_iter().collect()
    }

    /// Name of a job that changes with everything that its result depends on.
    pub fn key(&self, scene: &SceneJobs, view: &ViewJob, (method, quality): (SimMethod, f64), target: &Target) -> anyhow::Result<String> {
        let machine = &target.machine.description;
        let mut inputs = serde_json::to_vec(&(view, &scene.origin, &machine, self.error, self.intervals))?;
        let caches = format!("energy/{}.toml", machine.energy.caches);
        let blocks = machine.energy.blocks.as_ref().map(|name| format!("energy/{name}.toml"));
        for file in [&machine.dram.device, &caches].into_iter().chain(&blocks) {
            // What cannot be read fails when the job runs, and is told there.
            inputs.extend(machine.read(file).map_or_else(|_| Vec::new(), |(text, _)| text.into_bytes()));
        }
        if let Origin::File(file) = &scene.origin {
            inputs.extend(std::fs::read(file).map_or(0, |bytes| xxh3_64(&bytes)).to_le_bytes());
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
            "{}, {place}, {width}x{height}, {name}, {quality}, {}, {compute} #{:016x}",
            scene.name,
            target.machine.title(),
            xxh3_64(&inputs)
        ))
    }
}

impl File {
    fn jobs(self, folder: &Path) -> anyhow::Result<Jobs> {
        for (key, is_empty) in
            [("methods", self.methods.is_empty()), ("deltas", self.deltas.is_empty()), ("compute", self.compute.is_empty())]
        {
            anyhow::ensure!(!is_empty, "{key} must not be empty");
        }
        anyhow::ensure!([1, 2, 4].contains(&self.leaf_size), "leaf_size must be 1, 2 or 4, but is {}", self.leaf_size);
        let deltas = self.deltas.iter().map(|v| delta(&v.to_string()).map_err(anyhow::Error::msg).context("deltas"));
        let deltas = deltas.collect::<anyhow::Result<Vec<_>>>()?;
        let of_method = |&method: &SimMethod| {
            let count = if method == SimMethod::Lod { deltas.len() } else { 1 };
            deltas[..count].iter().map(move |&delta| (method, delta)).collect::<Vec<_>>()
        };
        let methods = self.methods.iter().flat_map(of_method).collect();
        let (mut targets, mut files) = (Vec::new(), BTreeSet::new());
        for entry in &self.machine {
            for variant in entry.variants() {
                // A file is relative to the list.
                let is_path = entry.name.ends_with(".toml");
                let name = if is_path { folder.join(&entry.name).display().to_string() } else { entry.name.clone() };
                let machine = machine(&name, &variant, "set").with_context(|| format!("machine {}", entry.name))?;
                files.extend(machine_files(&name, &machine));
                targets.extend(self.compute.iter().map(|&compute| Target { machine: machine.clone(), compute, window: None }));
            }
        }
        let scenes =
            self.scene.iter().enumerate().map(|(k, entry)| self.scene_jobs(entry, folder).with_context(|| format!("scene {}", k + 1)));
        Ok(Jobs {
            scenes: scenes.collect::<anyhow::Result<_>>()?,
            methods,
            targets,
            leaves: LeafArgs { leaf_layout: self.leaf_layout, leaf_size: self.leaf_size },
            error: self.error,
            intervals: self.intervals,
            machine_files: files,
        })
    }

    fn scene_jobs(&self, entry: &SceneEntry, folder: &Path) -> anyhow::Result<SceneJobs> {
        let (origin, name) = match (&entry.file, entry.generate) {
            (Some(file), None) => {
                let own = [
                    ("levels", entry.levels.is_some()),
                    ("base", entry.base.is_some()),
                    ("seed", entry.seed.is_some()),
                    ("roughness", entry.roughness.is_some()),
                ];
                if let Some((key, _)) = own.iter().find(|own| own.1) {
                    anyhow::bail!("{key} goes with generate, not with file");
                }
                (Origin::File(folder.join(file)), file.file_stem().unwrap_or_default().to_string_lossy().into_owned())
            }
            (None, Some(scene)) => {
                let (levels, base, roughness) = (entry.levels, entry.base, entry.roughness);
                let options = procedural::Options { scene, levels, base, seed: entry.seed.unwrap_or(0), roughness };
                (Origin::Generate(options), format!("{scene:?}").to_lowercase())
            }
            _ => anyhow::bail!("needs either file or generate"),
        };
        Ok(SceneJobs { name: entry.name.clone().unwrap_or(name), origin, views: self.views(entry)? })
    }

    fn views(&self, entry: &SceneEntry) -> anyhow::Result<Vec<ViewJob>> {
        let Size(width, height) = entry.size.as_ref().unwrap_or(&self.size).parse().map_err(anyhow::Error::msg).context("size")?;
        let (target, up, fov) = (entry.target, entry.up, entry.fov.unwrap_or(DEFAULT_VIEW_ANGLE_DEGREES));
        let base = ViewJob { size: [width, height], distance: None, direction: None, eye: None, target, up, fov };
        if let Some(eyes) = &entry.eyes {
            anyhow::ensure!(entry.distances.is_none() && entry.directions.is_none(), "eyes are in place of distances and directions");
            return Ok(eyes.iter().map(|&eye| ViewJob { eye: Some(eye), ..base.clone() }).collect());
        }
        let distances = entry.distances.as_ref().unwrap_or(&self.distances);
        anyhow::ensure!(!distances.is_empty(), "needs distances or eyes");
        for distance in distances {
            radii(&distance.to_string()).map_err(anyhow::Error::msg).context("distances")?;
        }
        let directions = entry.directions.as_ref().map_or_else(|| vec![None], |all| all.iter().copied().map(Some).collect());
        let view = |direction, &distance: &f64| ViewJob { distance: Some(distance), direction, ..base.clone() };
        Ok(directions.iter().flat_map(|&direction| distances.iter().map(move |d| view(direction, d)).collect::<Vec<_>>()).collect())
    }
}

impl MachineEntry {
    /// Every combination of the values, the last key's changing fastest.
    fn variants(&self) -> Vec<Vec<Change>> {
        self.set.iter().fold(vec![Vec::new()], |variants, (key, values)| {
            let values = match values {
                Values::One(value) => std::slice::from_ref(value),
                Values::Many(values) => values,
            };
            let with = |variant: &Vec<Change>, value: &Value| {
                let change = Change { key: key.clone(), value: value.to_string() };
                variant.iter().cloned().chain([change]).collect::<Vec<_>>()
            };
            variants.iter().flat_map(|variant| values.iter().map(|value| with(variant, value)).collect::<Vec<_>>()).collect()
        })
    }
}
