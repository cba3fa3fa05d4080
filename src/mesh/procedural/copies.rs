//! One model many times in one mesh: what repeated bodies cost without instances.

use super::base::{NoMemory, append, reserved};
use crate::mesh::Surface;

/// `model` once around each of `centres`, in units of the model, all of it scaled by `scale`.
pub(super) fn copies(model: &Surface, centres: &[[f64; 3]], scale: f64) -> Result<Surface, NoMemory> {
    let count = centres.len();
    let mut all = Surface {
        levels: model.levels,
        base_vertices: model.base_vertices * count as u32, // a scene's trees are numbered in 32 bits
        triangles: reserved(count * model.triangles.len())?,
        positions: reserved(count * model.positions.len())?,
        normals: reserved(count * model.normals.len())?,
        ..Surface::default()
    };
    for (number, centre) in centres.iter().enumerate() {
        let first = number as u32 * model.base_vertices;
        all.triangles.extend(model.triangles.iter().map(|triangle| triangle.map(|vertex| first + vertex)));
        all.positions.extend(model.positions.iter().map(|p| std::array::from_fn(|c| scale * (centre[c] + p[c]))));
        append(&mut all.normals, &model.normals)?;
    }
    Ok(all)
}
