//! What remeshing made, and how well it fits.

use crate::mesh::distance::TwoSidedDistance;
use serde::{Deserialize, Serialize};

/// What remeshing made, and how well it fits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RemeshReport {
    /// Base triangles reached.
    pub base_triangles: usize,
    /// Base triangles wanted, if the surface's connections and feature lines did not allow so few.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wanted_base_triangles: Option<usize>,
    /// Base triangles that are triangles of the original: they split flat.
    pub own_base_triangles: usize,
    /// Triangles of the finest level.
    pub finest_triangles: u64,
    /// Inserted vertices put where a line along the interpolated normal meets the original surface.
    pub projected_by_ray: u64,
    /// Inserted vertices put at the closest point of the original surface.
    pub by_closest_point: u64,
    /// Inserted vertices of base triangles that are triangles of the original.
    pub on_own_triangles: u64,
    /// Inserted vertices put on a border or crease of the original, by arc length.
    pub on_feature_lines: u64,
    /// Inserted vertices kept at the middle of their edge, or between that and the surface, because anything else folds the surface.
    pub midpoints_kept: u64,
    /// Finest triangles that face away from what is nearest to their middle on the original.
    pub flipped_triangles: u64,
    /// Edges that fold by more than 150 degrees, in the finest level and in the original.
    #[serde(default)]
    pub folds: Folds,
    /// Finest triangles without area.
    pub degenerate_triangles: u64,
    /// Distances between the finest level and the original.
    pub distance: TwoSidedDistance,
    /// What rounding to the format's grid has of the largest distances, in percent.
    #[serde(skip)]
    pub rounding: f64,
    /// What was lost, in one line, if the result is further from the original than `max_error` or has flipped triangles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warning: Option<String>,
}

/// Edges that fold, in the result and in the original. One of the original stands for many of a result that splits it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Folds {
    /// Edges of the finest level that fold by more than 150 degrees.
    pub edges: u64,
    /// Those of them where the original, within the largest error, does not face both ways.
    pub new: u64,
    /// Edges of the original that fold by more than 150 degrees.
    pub original: u64,
}
