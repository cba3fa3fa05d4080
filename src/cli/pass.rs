//! One functional pass over a frame, replayed on machines: what `simulate` and `sweep` share.

use super::args::Change;
use super::method::Chosen;
use super::output::{progress, toml_in_one_line};
use lodray::format::Scene;
use lodray::machine::{Machine, MachineError};
use lodray::method::Method;
use lodray::rays::{Camera, CameraPath, ModelSpace, RayFile, RaySource, Sight};
use lodray::report::result::{MachineFacts, MethodFacts, RayFileFacts, SceneFacts, Setup, SimResult, ViewFacts};
use lodray::run::{Compute, FrameRays, Job, Traced, simulate};
use lodray::sim::energy;
use lodray::sim::replay::{ReplayError, Run, Window};
use std::path::{Path, PathBuf};

/// A frame to run.
pub struct Pass<'a> {
    pub scene: &'a Scene,
    pub space: &'a ModelSpace,
    pub chosen: &'a Chosen,
    /// The method as it was made for the scene.
    pub method: &'a dyn Method,
    pub rays: PassRays,
}

/// The rays.
pub enum PassRays {
    /// A camera's.
    Camera(Camera),
    /// Those of a camera that moves, frame after frame.
    Path(CameraPath),
    /// A file's, and its path.
    File(RayFile, PathBuf),
}

impl PassRays {
    /// Where they come from.
    pub fn source(&self) -> &dyn RaySource {
        match self {
            Self::Camera(camera) => camera,
            Self::Path(path) => path,
            Self::File(rays, _) => rays,
        }
    }
}

/// A machine, and how compute is simulated on it.
#[derive(Clone)]
pub struct Target {
    pub machine: MachineFacts,
    pub compute: Compute,
    /// The cycles of which a waveform is wanted.
    pub window: Option<Window>,
}

/// The figures of a run, and its waveform if one was wanted.
pub type Outcome = anyhow::Result<(SimResult, Option<Vec<u8>>)>;

/// The machine of a shipped name or a description's path, changed by what errors call `set`.
pub fn machine(name: &str, changes: &[Change], set: &str) -> anyhow::Result<MachineFacts> {
    let (path, is_path) = (Path::new(name), is_path(name));
    let mut description = if is_path { Machine::load(path) } else { Machine::shipped(name) }.map_err(in_one_line)?;
    let pairs: Vec<_> = changes.iter().map(|change| (change.key.as_str(), change.value.as_str())).collect();
    description.set_all(&pairs).map_err(|error| anyhow::anyhow!("{set} {error}"))?;
    let label = if is_path { path.file_stem().unwrap_or_default().to_string_lossy().into_owned() } else { name.to_owned() };
    Ok(MachineFacts { label, set: changes.iter().map(ToString::to_string).collect(), description })
}

/// The files that a machine of this name was read from; none if it comes with the program.
pub fn machine_files(name: &str, machine: &MachineFacts) -> Result<Vec<PathBuf>, MachineError> {
    if !is_path(name) {
        return Ok(Vec::new());
    }
    let file = Path::new(name);
    let description = &machine.description;
    let tables = energy::files(description)?.into_iter();
    let beside = |path: String| file.parent().unwrap_or(Path::new("")).join(path);
    // Those that are not there come with the program.
    let named = tables.chain([description.dram.device.clone()]).map(beside).filter(|path| path.exists());
    Ok(std::iter::once(file.to_owned()).chain(named).collect())
}

/// Whether a machine's name is that of a file.
pub fn is_path(name: &str) -> bool {
    let path = Path::new(name);
    path.components().count() > 1 || path.extension().is_some_and(|e| e == "toml")
}

/// What is wrong with a machine, in one line.
fn in_one_line(error: MachineError) -> anyhow::Error {
    match error {
        MachineError::Toml { file, source } => toml_in_one_line(&file, &source),
        MachineError::NotShipped { name, .. } if !name.contains('/') => {
            let name = name.trim_end_matches(".toml");
            anyhow::anyhow!("there is no machine {name}; there are: {}; a file's name ends in .toml", Machine::all_shipped().join(", "))
        }
        other => other.into(),
    }
}

impl Pass<'_> {
    /// Traces the rays once and replays them on every target; a bar shows how far it is.
    pub fn run(&self, targets: &[Target]) -> anyhow::Result<Vec<Outcome>> {
        let bar = progress(self.rays.source().batches() as u64, "simulating");
        let outcomes = self.watched(targets, &mut |traced| bar.inc(traced.batches.len() as u64));
        bar.finish_and_clear();
        outcomes
    }

    /// The same without a bar; `look` sees the rays, in order.
    pub fn watched(&self, targets: &[Target], look: &mut dyn FnMut(&Traced)) -> anyhow::Result<Vec<Outcome>> {
        let rays = self.rays.source();
        let sight = Sight::new(rays, self.space, self.chosen.delta());
        let map = self.method.map(&sight);
        let frame = FrameRays { method: self.method, rays, sight: &sight };
        let job = |target: &Target| Job { machine: target.machine.description.clone(), compute: target.compute, window: target.window };
        let jobs: Vec<_> = targets.iter().map(job).collect();
        let runs = simulate(&frame, &jobs, look);
        let result = |(target, run): (&Target, Result<Run, ReplayError>)| {
            let run = run?;
            Ok((SimResult::new(self.setup(target, &sight, map.bytes()), self.chosen.method, &map, &run)?, run.wave))
        };
        Ok(targets.iter().zip(runs).map(result).collect())
    }

    fn setup(&self, target: &Target, sight: &Sight, bytes: u64) -> Setup {
        let Chosen { method, knobs } = self.chosen;
        let method = MethodFacts::new(method, knobs, &self.method.choices(sight), bytes);
        let (view, rays) = match &self.rays {
            PassRays::Camera(camera) => (Some(ViewFacts::new(camera)), None),
            PassRays::Path(path) => (path.cameras().first().map(ViewFacts::new), None),
            PassRays::File(rays, path) => {
                let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                (None, Some(RayFileFacts { file, count: rays.rays() }))
            }
        };
        let frames = match &self.rays {
            PassRays::Path(path) => Some(path.cameras().len() as u32), // few: an option's
            _ => None,
        };
        Setup { scene: SceneFacts::from(self.scene), method, view, frames, rays, compute: target.compute, machine: target.machine.clone() }
    }
}
