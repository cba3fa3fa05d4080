//! The figures of a point: what may stand on the axes of a diagram.

use super::{Costs, Point};

/// An error of a point.
#[derive(Clone, Copy, Debug)]
pub struct ErrorFigure {
    /// Its name in documents.
    pub name: &'static str,
    /// What an axis says.
    pub title: &'static str,
    /// Levels at which methods are compared.
    pub levels: &'static [f64],
    /// Its value; none where nothing was to be compared.
    pub of: fn(&Point) -> Option<f64>,
}

const PIXELS: &[f64] = &[0.25, 0.5, 1.0, 2.0];
const FLIP: &[f64] = &[0.01, 0.02, 0.05, 0.1];

/// The errors.
pub const ERRORS: &[ErrorFigure] = &[
    ErrorFigure {
        name: "surface_percentile_99",
        title: "distance from the surface, 99th percentile, pixels",
        levels: PIXELS,
        of: |p| p.geometry.surface.map(|e| e.percentile_99),
    },
    ErrorFigure {
        name: "surface_mean",
        title: "distance from the surface, mean, pixels",
        levels: PIXELS,
        of: |p| p.geometry.surface.map(|e| e.mean),
    },
    ErrorFigure {
        name: "hit_percentile_99",
        title: "distance from the same ray's hit, 99th percentile, pixels",
        levels: PIXELS,
        of: |p| p.geometry.hit.map(|e| e.percentile_99),
    },
    ErrorFigure {
        name: "normal_mean",
        title: "angle between normals, mean, degrees",
        levels: &[],
        of: |p| p.geometry.normal_degrees.map(|e| e.mean),
    },
    ErrorFigure {
        name: "silhouette_share",
        title: "pixels hit by one only, share",
        levels: &[],
        of: |p| Some(p.geometry.silhouette.share),
    },
    ErrorFigure { name: "picture_rmse", title: "RMSE of the picture, of 255, same samples", levels: &[], of: |p| Some(p.picture.rmse) },
    ErrorFigure { name: "picture_flip", title: "mean FLIP of the picture, same samples", levels: FLIP, of: |p| Some(p.picture.flip.mean) },
    ErrorFigure {
        name: "picture_dissimilarity",
        title: "1 - SSIM of the picture, same samples",
        levels: &[],
        of: |p| p.picture.ssim.map(|s| 1.0 - s),
    },
    ErrorFigure { name: "viewed_rmse", title: "RMSE against the converged picture, of 255", levels: &[], of: |p| Some(p.viewed?.rmse) },
    ErrorFigure { name: "viewed_flip", title: "mean FLIP against the converged picture", levels: FLIP, of: |p| Some(p.viewed?.flip.mean) },
];

/// A cost of a frame.
#[derive(Clone, Copy, Debug)]
pub struct CostFigure {
    /// Its name in documents.
    pub name: &'static str,
    /// What an axis says; `{}` stands for the unit of energies.
    pub title: &'static str,
    /// Methods are compared by it at equal error.
    pub is_compared: bool,
    /// Its value.
    pub of: fn(&Costs) -> f64,
}

/// The costs.
pub const COSTS: &[CostFigure] = &[
    CostFigure { name: "milliseconds", title: "time, ms", is_compared: true, of: |c| c.milliseconds },
    CostFigure { name: "energy", title: "energy, {}", is_compared: true, of: |c| c.energy.total },
    CostFigure { name: "dram_bytes", title: "DRAM traffic, bytes", is_compared: true, of: |c| c.dram_bytes as f64 },
    CostFigure { name: "l1_requests_per_ray", title: "L1 requests of a ray", is_compared: true, of: |c| c.l1_requests_per_ray },
];
