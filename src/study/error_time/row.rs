//! A view's line: all that was measured of it.

use crate::report::error_time::{LeftOut, PictureEntry, Point, SceneEntry, SizeCosts, TraceGrid, ViewEntry};
use crate::study::JobLine;
use serde::{Deserialize, Serialize};

/// A view. Numbers of scene, view and machine are those of this line alone: 0, 0, and the place among the machines.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewRow {
    /// Which job.
    pub key: String,
    /// What was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// Why it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// What was measured of a view.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// The scene.
    pub scene: SceneEntry,
    /// The view.
    pub view: ViewEntry,
    /// Settings of methods, with errors and costs.
    pub points: Vec<Point>,
    /// Pictures that were saved.
    pub pictures: Vec<PictureEntry>,
    /// Steps of some rays of each method.
    pub traces: Vec<TraceGrid>,
    /// Times on the host, which differ from run to run.
    #[serde(default)]
    pub host: Vec<HostTime>,
    /// The same of what methods build.
    #[serde(default)]
    pub builds: Vec<BuildTime>,
    /// What it costs with less in the scene, if that was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// What frames of other sizes cost, of one view of each scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<SizeCosts>,
}

/// Time to build what a method needs beyond the scene's file, on all threads.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BuildTime {
    /// Name of the method.
    pub method: String,
    /// How long it took.
    pub seconds: f64,
    /// It was read from the cache.
    pub from_cache: bool,
}

/// Time of a setting's rays on the host: one thread, no simulation.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HostTime {
    /// Name of the method.
    pub method: String,
    /// Its setting in words.
    pub setting: String,
    /// Rays of each turn.
    pub rays: u64,
    /// Nanoseconds of a ray in each turn, methods and settings taking turns.
    pub nanoseconds: Vec<f64>,
    /// Their median.
    pub median: f64,
    /// Half the distance between the first and the third quarter of them.
    pub spread: f64,
}

impl JobLine for ViewRow {
    fn key(&self) -> &str {
        &self.key
    }

    fn has_result(&self) -> bool {
        self.measured.is_some()
    }
}
