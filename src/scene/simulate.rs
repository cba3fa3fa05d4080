//! A frame on machines: traced once, replayed on each.

use super::SceneMethod;
use crate::format::Scene;
use crate::machine::Machine;
use crate::method::{Knobs, Method, Registered};
use crate::rays::{Camera, CameraPath, ModelSpace, RayFile, RaySource, Sight};
use crate::report::result::{MachineFacts, MethodFacts, RayFileFacts, ResultError, SceneFacts, Setup, SimResult, ViewFacts};
use crate::run::{Compute, Frame, FrameRays, Job, Traced, check, simulate};
use crate::sim::replay::{ReplayError, Run, Window};
use crate::step::MemoryMap;
use std::path::PathBuf;
use thiserror::Error;

/// A frame to run.
pub struct Pass<'a> {
    /// Of what.
    pub scene: &'a Scene,
    /// Its space.
    pub space: &'a ModelSpace,
    /// How rays find their hits.
    pub registered: &'static Registered,
    /// The method's knobs.
    pub knobs: &'a Knobs,
    /// The method as it was made for the scene.
    pub method: &'a dyn Method,
    /// The rays.
    pub rays: PassRays,
}

/// The rays of a frame.
pub enum PassRays {
    /// A camera's.
    Camera(Camera),
    /// Those of a camera that moves, frame after frame.
    Path(CameraPath),
    /// A file's, and its path.
    File(RayFile, PathBuf),
}

/// A machine, and how compute is simulated on it.
#[derive(Clone)]
pub struct Target {
    /// The machine.
    pub machine: MachineFacts,
    /// How compute is simulated.
    pub compute: Compute,
    /// The cycles of which a waveform is wanted.
    pub window: Option<Window>,
}

/// A machine on which a frame cannot run.
#[derive(Debug, Error)]
pub enum SimulateError {
    /// It cannot be built, or the frame does not end on it.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// Its figures cannot be had.
    #[error(transparent)]
    Result(#[from] Box<ResultError>),
}

/// The figures of a run, and its waveform (VCD) if one was wanted.
pub type Outcome = Result<(SimResult, Option<Vec<u8>>), SimulateError>;

impl PassRays {
    /// The same, those of cameras with rays of so many tiles in turn ([`Camera::in_turn`]).
    #[must_use]
    pub fn in_turn(self, tiles: u32) -> Self {
        match self {
            Self::Camera(camera) => Self::Camera(camera.in_turn(tiles)),
            Self::Path(path) => Self::Path(CameraPath::new(path.cameras().iter().map(|camera| camera.in_turn(tiles)).collect())),
            Self::File(..) => self,
        }
    }

    /// The cameras, one for each frame; none of rays of a file.
    pub fn cameras(&self) -> &[Camera] {
        match self {
            Self::Camera(camera) => std::slice::from_ref(camera),
            Self::Path(path) => path.cameras(),
            Self::File(..) => &[],
        }
    }

    /// Where they come from.
    pub fn source(&self) -> &dyn RaySource {
        match self {
            Self::Camera(camera) => camera,
            Self::Path(path) => path,
            Self::File(rays, _) => rays,
        }
    }
}

impl Pass<'_> {
    /// Traces the rays once and replays them on every target; `look` sees them, in order, as they are traced.
    pub fn run(&self, targets: &[Target], look: &mut dyn FnMut(&Traced)) -> Vec<Outcome> {
        let rays = self.rays.source();
        let sight = Sight::new(rays, self.space, self.knobs.delta());
        let map = self.method.map(&sight);
        let of_frame = Described {
            frame: &FrameRays { method: self.method, rays, sight: &sight },
            map: &map,
            scene: SceneFacts::from(self.scene),
            registered: self.registered,
            method: MethodFacts::new(self.registered, self.knobs, &self.method.choices(&sight), map.bytes()),
            rays: &self.rays,
        };
        of_frame.run(targets, look)
    }
}

/// A frame, and what its results say of it.
pub(super) struct Described<'a> {
    pub frame: &'a dyn Frame,
    pub map: &'a MemoryMap,
    pub scene: SceneFacts,
    pub registered: &'static Registered,
    pub method: MethodFacts,
    pub rays: &'a PassRays,
}

impl Described<'_> {
    /// Traces the rays once and replays them on every target.
    pub fn run(&self, targets: &[Target], look: &mut dyn FnMut(&Traced)) -> Vec<Outcome> {
        let job = |target: &Target| Job { machine: target.machine.description.clone(), compute: target.compute, window: target.window };
        let jobs: Vec<_> = targets.iter().map(job).collect();
        let runs = simulate(self.frame, &jobs, look);
        let result = |(target, run): (&Target, Result<Run, ReplayError>)| {
            let run = run?;
            let result = SimResult::new(self.setup(target), self.registered, self.map, &run).map_err(Box::new)?;
            Ok((result, run.wave))
        };
        targets.iter().zip(runs).map(result).collect()
    }

    fn setup(&self, target: &Target) -> Setup {
        let (view, rays) = match self.rays {
            PassRays::Camera(camera) => (Some(ViewFacts::new(camera)), None),
            PassRays::Path(path) => (path.cameras().first().map(ViewFacts::new), None),
            PassRays::File(rays, path) => {
                let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                (None, Some(RayFileFacts { file, count: rays.rays() }))
            }
        };
        let frames = match self.rays {
            PassRays::Path(path) => Some(path.cameras().len() as u32), // few: an option's
            _ => None,
        };
        let (scene, method, machine) = (self.scene.clone(), self.method.clone(), target.machine.clone());
        Setup { scene, method, view, frames, rays, compute: target.compute, machine }
    }
}

impl SceneMethod {
    /// What a frame costs on a machine: time, energy, traffic, and what limits it. `label` names the machine in the results.
    ///
    /// # Errors
    /// The frame cannot run on that machine.
    pub fn simulate(&self, rays: PassRays, machine: &Machine, label: &str, compute: Compute) -> Result<SimResult, SimulateError> {
        check(machine, compute)?;
        let space = ModelSpace::of(self.scene());
        let pass =
            Pass { scene: self.scene(), space: &space, registered: self.registered(), knobs: self.knobs(), method: self.method(), rays };
        let machine = MachineFacts { label: label.to_owned(), set: Vec::new(), description: machine.clone() };
        let mut outcomes = pass.run(&[Target { machine, compute, window: None }], &mut |_| ());
        outcomes.swap_remove(0).map(|(result, _)| result)
    }
}
