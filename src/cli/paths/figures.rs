//! What `paths` found out, as its JSON has it.

use lodray::paths::{LightCount, PathCounts};
use lodray::picture::ImageError;
use serde::Serialize;

/// What was traced, what it took, and how far it is from the truth.
#[derive(Serialize)]
pub struct Report {
    pub method: &'static str,
    pub delta: f64,
    pub starts: String,
    pub size: [u32; 2],
    pub samples: u32,
    pub depth: u32,
    pub seed: u64,
    pub diffuse_spread: f64,
    pub counts: PathCounts,
    #[serde(skip)]
    pub seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_full: Option<Against>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against_converged: Option<Against>,
}

/// How far a picture is from another.
#[derive(Serialize)]
pub struct Against {
    pub samples: u32,
    /// Mean squared relative error of the light.
    pub light: f64,
    /// Of the picture for a screen.
    pub image: ImageError,
    /// Pixels whose first hits have the wrong light; only by the same paths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pixels: Option<LightCount>,
}
