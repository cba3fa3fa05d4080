//! The surface where a ray meets it.

use super::SurfaceHit;
use crate::format::Scene;
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
}
