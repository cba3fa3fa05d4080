//! What is not split any further.

use crate::method::Registered;
use crate::run::Compute;
use crate::scene::Target;
use crate::study::{Origin, SceneJobs};

/// Work that one shard does as a whole: the jobs that share a pass of rays.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Number of its scene.
    pub scene: usize,
    /// Names of its jobs.
    pub keys: Vec<String>,
    /// What all of them take, if nobody has measured it.
    pub estimate: u64,
}

/// What a shard takes before the first job of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Opening {
    /// The scene's name.
    pub name: String,
    /// What it takes, if nobody has measured it.
    pub estimate: u64,
}

/// All jobs of a study, to be split.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pieces {
    /// In the order of the jobs.
    pub all: Vec<Piece>,
    /// By number of the scene.
    pub openings: Vec<Opening>,
}

// Nanoseconds, about. Only their ratios matter: a shard that has cheap jobs gets more of them.
/// A ray, traced.
const RAY: u64 = 4_000;
/// A ray, replayed on a machine where compute is free, and where it takes time.
const REPLAYED: u64 = 4_000;
const COMPUTED: u64 = 8_000;
/// A triangle that is generated, or put into a BVH.
const TRIANGLE: u64 = 800;
/// Bytes of a scene's file for each of its finest triangles, about.
const BYTES: u64 = 7;

/// Rays traced `times` times, and replayed on these machines.
pub fn rays(rays: u64, times: u64, targets: &[Target]) -> u64 {
    let replay = |target: &Target| if target.compute == Compute::Free { REPLAYED } else { COMPUTED };
    let each = targets.iter().map(replay).fold(times.saturating_mul(RAY), u64::saturating_add);
    rays.saturating_mul(each)
}

/// What is generated is made, and BVHs are built where a method needs one.
pub fn opening<'a>(scene: &SceneJobs, methods: impl Iterator<Item = &'a Registered>) -> Opening {
    let (triangles, made) = match &scene.origin {
        Origin::File(file) => (file.metadata().map_or(0, |of| of.len() / BYTES), 0),
        Origin::Generate(made) => {
            let options = &made.options;
            let levels = options.levels.unwrap_or(options.scene.default_levels());
            let base = u64::from(options.base.unwrap_or(options.scene.default_base()));
            (base.checked_shl(2 * levels).unwrap_or(u64::MAX), 1)
        }
    };
    // Level of detail reads the scene as it is.
    let built = methods.filter(|method| !method.unit.is_some_and(|unit| unit.has_levels)).count() as u64;
    Opening { name: scene.name.clone(), estimate: triangles.saturating_mul(TRIANGLE).saturating_mul(made + built) }
}
