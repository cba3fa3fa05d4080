//! The surface where a ray meets it.

use super::SurfaceHit;
use crate::format::{Scene, decode_normal};
use crate::mesh::lattice;
use glam::Vec3;

impl SurfaceHit {
    /// The shading normal of a hit: full-resolution normals, interpolated; of length 1, or 0 where they cancel.
    pub fn normal(&self, scene: &Scene) -> Vec3 {
        let levels = scene.levels();
        let corners = lattice::node(levels, levels, self.full_node);
        let sum: Vec3 = (0..3).map(|k| Vec3::from_array(scene.normal_at(self.tree as usize, corners[k])) * self.full_bary[k]).sum();
        sum.normalize_or_zero()
    }

    /// The normal of the triangle that was met, of length 1; `None` if it has no area.
    pub fn plane_normal(&self) -> Option<Vec3> {
        (self.plane != Self::NO_PLANE).then(|| Vec3::from_array(decode_normal(self.plane)))
    }
}
