//! What studies work with.

use super::cache::Cache;
use super::jobs::SceneJobs;
use super::progress::Progress;
use crate::format::Scene;
use std::error::Error;

/// Opens a scene, with the mesh that it was built from where methods are over that.
pub type Open<'a> = &'a dyn Fn(&SceneJobs) -> Result<Scene, Box<dyn Error + Send + Sync>>;

/// What studies work with.
pub struct Means<'a> {
    /// Where BVHs are kept.
    pub cache: &'a Cache,
    /// How scenes are opened: by [`SceneJobs::open`], if nothing else is to be done.
    pub open: Open<'a>,
    /// Who is told how far it is.
    pub progress: &'a dyn Progress,
}
