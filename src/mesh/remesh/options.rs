//! What to make of a mesh.

use crate::mesh::DEFAULT_CREASE_ANGLE;

/// How far result and original may be apart if nothing is said, in percent of the diagonal.
pub const DEFAULT_MAX_ERROR: f64 = 0.3;

/// What to make of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RemeshOptions {
    /// Number of splits N, 0 to [`MAX_LEVELS`](crate::num::MAX_LEVELS); by default as many as make finest triangles about as many as the input's.
    pub levels: Option<u32>,
    /// Wanted number of base triangles (never more than the input); by default as few as keep within `max_error`.
    pub base_triangles: Option<usize>,
    /// Largest distance between original and full-resolution result, both ways, in percent of the diagonal of the original's box.
    pub max_error: f64,
    /// How much of `max_error`, in percent too, is left for what moves vertices afterwards (compact vertices).
    pub reserve: f64,
    /// Edges that bend by more than this, in degrees, are creases: they stay sharp lines, and where the mesh has no normals of its own they
    /// are shaded so.
    pub crease_angle: f64,
}

impl Default for RemeshOptions {
    fn default() -> Self {
        RemeshOptions { levels: None, base_triangles: None, max_error: DEFAULT_MAX_ERROR, reserve: 0.0, crease_angle: DEFAULT_CREASE_ANGLE }
    }
}
