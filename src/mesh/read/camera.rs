//! Cameras that a file has beside its meshes.

/// A camera.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshCamera {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub eye: [f64; 3],
    /// A point that it looks at.
    pub target: [f64; 3],
    /// What is up.
    pub up: [f64; 3],
    /// Degrees from bottom to top.
    pub fov: f64,
}
