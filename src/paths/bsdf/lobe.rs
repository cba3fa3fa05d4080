//! Which way light is scattered.

use glam::DVec3;

/// Which way light is scattered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::paths) enum Lobe {
    /// Evenly.
    Diffuse,
    /// About the mirror's direction.
    Glossy,
    /// In the mirror's direction alone.
    Mirror,
    /// Through the surface, behind which the index of refraction is `eta` times as large.
    Through {
        /// Above 0.
        eta: f64,
    },
}

/// A scattered ray where the normal is (0, 0, 1).
pub(in crate::paths) struct Local {
    pub light: DVec3,
    pub weight: DVec3,
    pub pdf: Option<f64>,
    pub lobe: Lobe,
}
