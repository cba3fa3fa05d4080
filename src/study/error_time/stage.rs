//! What is traced, and from where.

use crate::format::Scene;
use crate::method::Method;
use crate::rays::{Camera, ModelSpace};
use crate::scene::Target;
use crate::study::Chosen;

/// What is traced, and on which machines.
pub(super) struct Stage<'a> {
    pub scene: &'a Scene,
    /// The same with all its levels: facets are shaded, and normals found, at full resolution.
    pub all: &'a Scene,
    pub space: &'a ModelSpace,
    pub chosen: &'a Chosen,
    pub method: &'a dyn Method,
    pub targets: &'a [Target],
}

/// The camera of the whole frame, and that of the columns and rows of it whose errors are measured.
pub(super) struct Cameras {
    pub frame: Camera,
    pub few: Camera,
}
