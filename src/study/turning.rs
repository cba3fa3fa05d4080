//! Frames after one another.

use crate::rays::{Camera, CameraPath};

/// A camera that turns from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Frames, 2 or more.
    pub frames: u32,
    /// Degrees between them.
    pub degrees: f64,
}

impl Turning {
    /// The frames that begin with `camera`.
    pub fn path(self, camera: &Camera) -> CameraPath {
        CameraPath::turning(camera, self.frames, self.degrees)
    }
}
