//! The jobs of a list.

use super::error::{StudyError, ViewError};
use crate::format::{JobRegion, Scene};
use crate::mesh::{BoundKind, procedural};
use crate::method::bvh::{LEAF_LAYOUT, LEAF_SIZE};
use crate::method::knob::DELTA;
use crate::method::lod;
use crate::method::{Knob, Over};
use crate::num::VertexForm;
use crate::rays::{Camera, DEFAULT_DIRECTION, DEFAULT_VIEW_ANGLE_DEGREES, ModelSpace, View};
use crate::report::results_version;
use crate::scene::{BuildError, BuildOptions, Target};
use crate::sim::energy;
use crate::study::Chosen;
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::PathBuf;
use xxhash_rust::xxh3::xxh3_64;

/// Where a scene comes from.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Origin {
    /// A scene file.
    File(PathBuf),
    /// It is generated.
    Generate(Generated),
}

/// What is generated, and in which form.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Generated {
    /// Which scene.
    #[serde(flatten)]
    pub options: procedural::Options,
    /// What displacement bounds cover.
    // A job of the paper's bounds is the same as when there were no others.
    #[serde(skip_serializing_if = "BoundKind::is_unnamed")]
    pub bounds: BoundKind,
    /// How inserted vertices are stored.
    pub vertices: VertexForm,
}

/// A scene and what to see of it.
pub struct SceneJobs {
    /// Its name among the jobs.
    pub name: String,
    /// Where it comes from.
    pub origin: Origin,
    /// Checksum of its file.
    pub content: u64,
    /// The mesh that it was built from is at hand: methods that take either are over it.
    pub has_mesh: bool,
    /// Cameras.
    pub views: Vec<ViewJob>,
    /// Boxes that cameras stay in; a plan alone has some.
    pub regions: Vec<RegionJob>,
}

/// A box in the world that cameras stay in, and their cones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionJob {
    /// Lower corner.
    pub lo: [f64; 3],
    /// Upper corner.
    pub hi: [f64; 3],
    /// Tangent of the half angle.
    pub cone: f64,
}

impl RegionJob {
    /// Its rays at a quality.
    pub fn at(self, delta: f64) -> JobRegion {
        let Self { lo, hi, cone } = self;
        JobRegion { delta: delta.to_string(), lo, hi, cone }
    }
}

/// A camera, before the scene is there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ViewJob {
    /// Columns and rows of pixels.
    pub size: [u32; 2],
    /// In bounding radii from the target; the eye is then only a direction.
    pub distance: Option<f64>,
    /// From the target toward the eye.
    pub direction: Option<[f64; 3]>,
    /// The eye.
    pub eye: Option<[f64; 3]>,
    /// Where it looks; by default the middle of the model's box.
    pub target: Option<[f64; 3]>,
    /// What is up; by default +y.
    pub up: Option<[f64; 3]>,
    /// Vertical view angle in degrees.
    pub fov: f64,
    /// Tiles whose rays machines are handed in turn ([`Camera::in_turn`]).
    // A job of tile after tile is the same as when there was nothing else.
    #[serde(skip_serializing_if = "is_one")]
    pub tiles_in_turn: u32,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn is_one(tiles: &u32) -> bool {
    *tiles == 1
}

impl SceneJobs {
    /// A scene of which nothing is to be seen yet; a file that is to be known again by its bytes needs their checksum besides.
    pub fn new(name: &str, origin: Origin) -> Self {
        Self { name: name.to_owned(), origin, content: 0, has_mesh: false, views: Vec::new(), regions: Vec::new() }
    }

    /// Opens or generates it.
    ///
    /// # Errors
    /// There is no such scene.
    pub fn open(&self) -> Result<Scene, BuildError> {
        match &self.origin {
            Origin::File(file) => Ok(Scene::open(file)?),
            Origin::Generate(made) => {
                let Generated { options, bounds, vertices } = *made;
                let form = BuildOptions { name: options.scene.name().to_owned(), bounds, vertices, ..BuildOptions::own_triangles() };
                Ok(Scene::of_surface(&procedural::generate(&options)?, &form.with_origin("generate", serde_json::json!(options)))?)
            }
        }
    }

    /// Its file, as it was named from where the program runs; nothing if it is generated.
    pub fn path(&self) -> String {
        match &self.origin {
            Origin::File(file) => file.display().to_string(),
            Origin::Generate(_) => String::new(),
        }
    }

    /// That file's name, without folders.
    pub fn file_name(&self) -> String {
        match &self.origin {
            Origin::File(file) => file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            Origin::Generate(_) => String::new(),
        }
    }
}

impl ViewJob {
    /// From this distance in bounding radii; the camera looks as in render.
    pub fn at(size: [u32; 2], distance: f64) -> Self {
        Self {
            size,
            distance: Some(distance),
            direction: None,
            eye: None,
            target: None,
            up: None,
            fov: DEFAULT_VIEW_ANGLE_DEGREES,
            tiles_in_turn: 1,
        }
    }

    /// The camera on a model.
    ///
    /// # Errors
    /// There is no such camera.
    pub fn camera(&self, space: &ModelSpace) -> Result<Camera, ViewError> {
        let target = self.target.unwrap_or_else(|| space.centre());
        let toward = self.direction.map(|d| std::array::from_fn(|k| target[k] + d[k]));
        // Whatever is up: a job's view is that of its keys alone.
        let direction = Some(DEFAULT_DIRECTION);
        let view = View { eye: self.eye.or(toward), direction, target: self.target, up: self.up, distance: self.distance, fov: self.fov };
        Ok(Camera::new(&view, space, self.size[0], self.size[1])?)
    }

    /// The same, of which machines are handed the rays in the order that it names.
    ///
    /// # Errors
    /// As [`Self::camera`].
    pub fn frame(&self, space: &ModelSpace) -> Result<Camera, ViewError> {
        Ok(self.camera(space)?.in_turn(self.tiles_in_turn))
    }
}

/// All jobs: each view of each scene, with each method, on each target.
pub struct Jobs {
    /// Scenes with their views.
    pub scenes: Vec<SceneJobs>,
    /// Methods, with each of their qualities; a BVH has but one.
    pub methods: Vec<Chosen>,
    /// Machines, each with a way to compute.
    pub targets: Vec<Target>,
    /// The qualities of the list, if it has some.
    pub deltas: Vec<String>,
    /// Pictures are compared with full resolution.
    pub error: bool,
    /// Results keep their figures over time.
    pub intervals: bool,
    /// Files of scenes and machines.
    pub files: BTreeSet<PathBuf>,
}

impl Jobs {
    /// Each view of these scenes, with each method, on each target: without errors of pictures, and without figures over time.
    pub fn new(scenes: Vec<SceneJobs>, methods: Vec<Chosen>, targets: Vec<Target>) -> Self {
        Self { scenes, methods, targets, deltas: Vec::new(), error: false, intervals: false, files: BTreeSet::new() }
    }

    /// Leaves one of each method's qualities.
    pub fn each_method_once(&mut self) {
        let mut seen = BTreeSet::new();
        self.methods.retain(|chosen| seen.insert(chosen.method.name));
    }

    /// Those of the traversal unit's method: each of its qualities.
    pub fn lod(&self) -> Vec<&Chosen> {
        self.methods.iter().filter(|chosen| chosen.method.name == lod::METHOD.name).collect()
    }

    /// The names of all jobs, in order.
    ///
    /// # Errors
    /// As [`Self::key`].
    pub fn keys(&self) -> Result<Vec<String>, StudyError> {
        let mut keys = Vec::new();
        for scene in &self.scenes {
            for view in &scene.views {
                for method in &self.methods {
                    for target in &self.targets {
                        keys.push(self.key(scene, view, method, target)?);
                    }
                }
            }
        }
        Ok(keys)
    }

    /// Name of a job that changes with everything that its result depends on, the program's own version at its end.
    ///
    /// # Errors
    /// A file of the machine cannot be read.
    pub fn key(&self, scene: &SceneJobs, view: &ViewJob, chosen: &Chosen, target: &Target) -> Result<String, StudyError> {
        let machine = &target.machine.description;
        let mut inputs = serde_json::to_vec(&(view, &scene.origin, &machine, self.error, self.intervals))?;
        let tables = energy::files(machine)?;
        for file in std::iter::once(&machine.dram.device).chain(&tables) {
            inputs.extend(machine.read(file)?.0.into_bytes());
        }
        if let Origin::File(_) = &scene.origin {
            inputs.extend(scene.content.to_le_bytes());
        }
        // The same method over another surface is another job.
        if scene.has_mesh && chosen.method.over == Over::Either {
            inputs.extend(b"over the mesh");
        }
        let place = match (view.distance, view.eye) {
            (Some(distance), _) => format!("{distance} radii"),
            (None, eye) => format!("{:?}", eye.unwrap_or_default()),
        };
        let [width, height] = view.size;
        let (name, quality, compute) = (chosen.method.name, quality(chosen), target.compute.name());
        Ok(format!(
            "{}, {place}, {width}x{height}, {name}, {quality}, {}, {compute} #{:016x} {}",
            scene.name,
            target.machine.title(),
            xxh3_64(&inputs),
            results_version()
        ))
    }
}

/// A method's knobs, as a job's name says them.
fn quality(chosen: &Chosen) -> String {
    let said = |knob: &&'static Knob| {
        let value = chosen.knobs.get(knob)?;
        // Leaves need no name: `line 4`.
        let is_leaf = [LEAF_LAYOUT.name, LEAF_SIZE.name].contains(&knob.name);
        let value = if knob.name == DELTA.name { chosen.delta().to_string() } else { value.to_owned() };
        Some(if is_leaf { value } else { format!("{} {value}", knob.name) })
    };
    chosen.method.knobs.iter().filter_map(said).collect::<Vec<_>>().join(" ")
}
