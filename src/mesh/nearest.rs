//! How far a point is from the full-resolution surface.

use super::distance::{Target, Vec3};
use super::{Hierarchy, lattice};
use rayon::prelude::*;

/// Triangles of a leaf of the tree of boxes: those of two splits, which lie together.
const GROUP: usize = 16;

/// The full-resolution triangles of a hierarchy, to ask for nearest points.
pub struct FinestSurface(Target);

impl FinestSurface {
    /// Copies the triangles, 72 bytes each, and builds a tree of boxes over them.
    pub fn new(h: &Hierarchy) -> Self {
        let per_tree = 1u32 << (2 * h.levels);
        let triangles = (0..h.triangles.len()).into_par_iter().flat_map_iter(|tree| {
            let points = h.tree(tree);
            let corner = move |at| Vec3::from(points[lattice::index(h.levels, at)].map(f64::from));
            (0..per_tree).map(move |node| lattice::node(h.levels, h.levels, node).map(corner))
        });
        Self(Target::grouped(triangles.collect(), GROUP))
    }

    /// Distance of a point in units of the model; quicker if `guess` is little above it.
    pub fn distance(&self, p: [f64; 3], guess: f64) -> f64 {
        self.0.distance(Vec3::from(p), guess)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::procedural::{Options, Scene, generate};
    use crate::mesh::quantise;

    #[test]
    fn vertices_lie_on_the_surface_and_what_is_above_them_is_as_far_as_it_is() {
        let options = Options { levels: Some(2), base: Some(32), ..Options::new(Scene::Terrain) };
        let h = quantise(&generate(&options).unwrap(), crate::mesh::BoundKind::default(), crate::num::VertexForm::default(), 0).unwrap();
        let surface = FinestSurface::new(&h);
        for &p in h.points.iter().step_by(7) {
            let p = p.map(f64::from);
            assert_eq!(surface.distance(p, 1.0), 0.0);
            // Far above, the highest vertices are nearest: by any guess the same, and by none of the vertices exceeded.
            let above = [p[0], p[1] + 1e9, p[2]];
            let far = surface.distance(above, 1.0);
            let nearest = h.points.iter().map(|q| (0..3).map(|k| (f64::from(q[k]) - above[k]).powi(2)).sum::<f64>().sqrt());
            assert!(far > 1e7 && far <= nearest.fold(f64::INFINITY, f64::min) + 1.0);
            assert_eq!(surface.distance(above, far + 1.0), far);
        }
    }
}
