//! What of a scene's data no ray of a job reads.

use super::scene::Met;
use crate::format::{Scene, has_split};
use crate::num::{LINE_BYTES, VertexForm};
use serde::Serialize;

/// Bytes of a scene's trees: as they are stored, and those that a ray can read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Data {
    /// Full-resolution triangles.
    pub triangles: u64,
    /// L0 records, splits and inserted vertices as they are stored.
    pub stored: u64,
    /// Of them what a ray of some quality can read: what lies below a node with three codes of 0, in a tree that is deeper elsewhere, is read by none.
    pub above_flat: u64,
    /// What is stored if each tree has no more levels than a ray of the job can go down to.
    pub reached: u64,
}

impl Data {
    pub(super) fn of(scene: &Scene, met: &Met, depths: &[u32]) -> Self {
        let (levels, form) = (scene.levels(), scene.meta().vertices);
        let records = size_of_val(scene.records()) as u64;
        // Of a node that splits: its split, which has compact vertices, and vertices elsewhere.
        let of = |level: u32| match (form, has_split(levels, level)) {
            (VertexForm::Exact, true) => 2 * LINE_BYTES,
            (VertexForm::Exact, false) | (VertexForm::Compact | VertexForm::Short, true) => LINE_BYTES,
            (VertexForm::Compact, false) => LINE_BYTES / 2,
            (VertexForm::Short, false) => LINE_BYTES / 4,
        };
        let above_flat = records + (0..levels).map(|level| met.splits[level as usize] * of(level)).sum::<u64>();
        Self { triangles: scene.finest_triangles(), stored: scene.bytes_of(&scene.depths()), above_flat, reached: scene.bytes_of(depths) }
    }

    /// Bytes for each full-resolution triangle.
    pub fn per_triangle(&self, bytes: u64) -> f64 {
        bytes as f64 / self.triangles as f64
    }

    /// Of both scenes.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self {
            triangles: self.triangles + other.triangles,
            stored: self.stored + other.stored,
            above_flat: self.above_flat + other.above_flat,
            reached: self.reached + other.reached,
        }
    }
}
