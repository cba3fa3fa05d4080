//! What a file's parser hands to cleaning.

use super::polygon;

/// What a file's parser hands to cleaning.
#[derive(Default)]
pub(super) struct Parts {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle; empty if there are none.
    pub normals: Vec<[[f32; 3]; 3]>,
    /// Texture coordinates for each triangle, v upwards, no numbers where a corner has none; empty if there are none.
    pub texture: Vec<[[f32; 2]; 3]>,
    /// Polygon of each triangle; empty if all are triangles.
    pub polygons: Vec<u32>,
    pub materials: Vec<u16>,
    pub colours: Vec<[f32; 3]>,
    /// What of the file is not kept, a line each.
    pub warnings: Vec<String>,
}

impl Parts {
    /// Cuts the polygon with these vertices into triangles, each told to `each` by places among the corners. Files of triangles alone have no polygons.
    ///
    /// # Errors
    /// It cannot be cut.
    pub fn polygon(&mut self, corners: &[u32], mut each: impl FnMut(&mut Self, [usize; 3])) -> Result<(), String> {
        let first = self.triangles.len();
        if corners.len() > 3 && self.polygons.is_empty() {
            self.polygons = (0..first as u32).collect(); // indices are 32 bits
        }
        let mut cut = Vec::with_capacity(corners.len());
        polygon::triangulate(&self.positions, corners, |tri| cut.push(tri))?;
        let number = self.polygons.last().map(|last| last + 1);
        for tri in cut {
            self.triangles.push(tri.map(|k| corners[k]));
            self.polygons.extend(number.or((corners.len() > 3).then_some(0)));
            each(self, tri);
        }
        Ok(())
    }
}
