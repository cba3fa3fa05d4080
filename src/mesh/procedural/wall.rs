//! `wall`: the displaced [`super::sphere`] 182 times, in 14 columns and 13 rows that face +z; 2 wide. What a repeated model costs without instances.

use super::GenerateError;
use super::base::{append, reserved};
use super::sphere;
use crate::mesh::Surface;

/// Columns and rows.
const COLUMNS: u32 = 14;
const ROWS: u32 = 13;
/// Models in all.
pub(super) const MODELS: u32 = COLUMNS * ROWS;
/// From centre to centre, in units of a sphere's radius: none reaches into the next.
const APART: f64 = 2.6;
/// Half the width of the wall becomes 1.
const SCALE: f64 = 2.0 / (APART * COLUMNS as f64);

/// A wall of spheres with `k` base steps along an edge of the octahedron.
pub(super) fn generate(k: u32, levels: u32, seed: u64, gain: f64) -> Result<Surface, GenerateError> {
    let model = sphere::generate(k, levels, seed, gain)?;
    let models = MODELS as usize;
    let mut wall = Surface {
        levels,
        base_vertices: model.base_vertices * MODELS,
        triangles: reserved(models * model.triangles.len())?,
        positions: reserved(models * model.positions.len())?,
        normals: reserved(models * model.normals.len())?,
        ..Surface::default()
    };
    for number in 0..MODELS {
        let middle = |at: u32, of: u32| APART * (f64::from(at) - f64::from(of - 1) / 2.0);
        let centre = [middle(number % COLUMNS, COLUMNS), middle(number / COLUMNS, ROWS), 0.0];
        let first = number * model.base_vertices;
        wall.triangles.extend(model.triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
        wall.positions.extend(model.positions.iter().map(|p| std::array::from_fn(|c| SCALE * (centre[c] + p[c]))));
        append(&mut wall.normals, &model.normals)?;
    }
    Ok(wall)
}
