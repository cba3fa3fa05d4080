//! A scene on coarser grids.

use super::encode::{SceneInfo, TreeBvh, encode, tree_boxes};
use super::normal::decode_normal;
use super::{Box16, Scene, SceneError};
use crate::mesh::{Hierarchy, Surface, coarsen, edges_of_tree, lattice};

impl Scene {
    /// The same scene with as many zero bits at the bottom of all coordinates, and of the directions of its rays; it has no fewer than before. `build_l0` makes the quad-BVH over
    /// the trees' boxes, and with it their order; base triangles keep their numbers.
    ///
    /// # Errors
    /// There is no room for so many, `build_l0` failed, the scene has no normals, or memory cannot be had.
    pub fn coarsened<E: std::fmt::Display>(
        &self,
        [zeros, direction_zeros]: [u32; 2],
        build_l0: impl FnOnce(&[Box16]) -> Result<TreeBvh, E>,
    ) -> Result<Self, SceneError> {
        let meta = self.meta();
        if meta.without_normals {
            return Err(SceneError::Build("normals: the scene was pruned without them".into()));
        }
        let fine = self.by_source(&self.decode());
        let coarse = coarsen(&fine, zeros)?;
        let order = self.trees_by_source();
        let len = lattice::len(meta.levels);
        let normals = |tree: u32| self.normals()[tree as usize * len..][..len].iter().map(|&code| decode_normal(code));
        let surface = Surface {
            levels: meta.levels,
            base_vertices: meta.base_vertices,
            triangles: fine.triangles.clone(),
            positions: fine.points.iter().map(|&p| fine.to_world(p)).collect(),
            normals: order.iter().flat_map(|&tree| normals(tree)).collect(),
            materials: order.iter().map(|&tree| self.material(tree as usize)).collect(),
            colours: (0..self.colours().len()).filter_map(|k| self.colour(k as u16)).collect(), // 16 bits name them
        };
        let info = SceneInfo {
            name: meta.name.clone(),
            origin: meta.origin.clone(),
            bounds: meta.bounds,
            vertices: meta.vertices,
            coordinate_zeros: zeros,
            direction_zeros: direction_zeros.max(meta.direction_zeros),
            moved: meta.moved,
        };
        let bvh = build_l0(&tree_boxes(&coarse)).map_err(|e| SceneError::Build(format!("quad-BVH: {e}")))?;
        encode(&coarse, &surface, info, &bvh)
    }

    /// The tree of each base triangle of the mesh.
    fn trees_by_source(&self) -> Vec<u32> {
        let mut trees = vec![0; self.trees()];
        (0..).zip(0..self.trees()).for_each(|(number, tree)| trees[self.source(tree) as usize] = number);
        trees
    }

    /// A hierarchy of this scene's trees in the order of the mesh.
    fn by_source(&self, h: &Hierarchy) -> Hierarchy {
        let (len, edges) = (lattice::len(h.levels), edges_of_tree(h.levels));
        let (mut points, mut codes) = (Vec::with_capacity(h.points.len()), Vec::with_capacity(h.bounds.codes.len()));
        let order = self.trees_by_source();
        for &tree in &order {
            let tree = tree as usize;
            points.extend_from_slice(&h.points[tree * len..][..len]);
            codes.extend_from_slice(&h.bounds.codes[tree * edges..][..edges]);
        }
        let mut sorted = Hierarchy { points, triangles: order.iter().map(|&tree| h.triangles[tree as usize]).collect(), ..h.clone() };
        sorted.bounds.codes = codes;
        sorted
    }
}
