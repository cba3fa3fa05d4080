//! A surface as a base mesh and one lattice of positions per base triangle, in the user's own (world) units.

use super::{TriangleMesh, lattice};

/// A hierarchy before it is rounded: what the remesher and the procedural scenes make.
///
/// Positions on the border of a tree must be bit-identical in every tree that shares the base edge.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Number of splits N, 0 to [`crate::num::MAX_LEVELS`].
    pub levels: u32,
    /// Number of base vertices that `triangles` index.
    pub base_vertices: u32,
    /// Base triangles, counter-clockwise seen from outside; each three distinct indices.
    pub triangles: Vec<[u32; 3]>,
    /// Finite positions, `lattice::len(levels)` for each base triangle in order.
    pub positions: Vec<[f64; 3]>,
    /// Shading normals beside `positions`, any non-zero length; may differ between trees (creases).
    pub normals: Vec<[f32; 3]>,
    /// Index into `colours` for each base triangle; empty if there are no materials.
    pub materials: Vec<u16>,
    /// Material colours, linear RGB in 0..=1.
    pub colours: Vec<[f32; 3]>,
}

impl Surface {
    /// A mesh as it is: each triangle a base triangle without splits, whose lattice is its three corners, shaded with `normals` (see [`super::corner_normals`]).
    pub fn of_mesh(mesh: &TriangleMesh, normals: &[[[f32; 3]; 3]]) -> Self {
        Self {
            levels: 0,
            base_vertices: mesh.positions.len() as u32, // triangles index them in 32 bits
            triangles: mesh.triangles.clone(),
            positions: mesh.triangles.iter().flatten().map(|&v| mesh.positions[v as usize]).collect(),
            normals: normals.iter().flatten().copied().collect(),
            materials: mesh.materials.clone(),
            colours: mesh.colours.clone(),
        }
    }

    /// Positions of one tree.
    pub fn tree(&self, tree: usize) -> &[[f64; 3]] {
        let len = lattice::len(self.levels);
        &self.positions[tree * len..][..len]
    }

    /// Number of full-resolution triangles.
    pub fn finest_triangles(&self) -> u64 {
        (self.triangles.len() as u64) << (2 * self.levels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{BoundKind, corner_normals, quantise};

    #[test]
    fn a_mesh_as_it_is() {
        let positions = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]];
        let triangles = [[0, 2, 1], [0, 1, 3]];
        let mesh = TriangleMesh::from_parts(&positions, &triangles, &[1, 0], vec![[1.0; 3], [0.5; 3]]).unwrap();
        let surface = Surface::of_mesh(&mesh, &corner_normals(&mesh, 30.0));
        assert_eq!(surface.tree(0), [positions[0], positions[2], positions[1]]);
        assert_eq!((&surface.normals[..3], surface.normals[3]), (&[[0.0, 0.0, -1.0]; 3][..], [0.0, -1.0, 0.0]));
        assert_eq!((surface.finest_triangles(), &surface.materials, surface.colours.len()), (2, &vec![1, 0], 2));
        // The corners are where a lattice has them.
        let corners = lattice::root(0).map(|p| lattice::index(0, p));
        assert_eq!(corners, [0, 1, 2]);
        assert!(quantise(&surface, BoundKind::Largest, crate::num::VertexForm::Exact, 0).is_ok());
    }
}
