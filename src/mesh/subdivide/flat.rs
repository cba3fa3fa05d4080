//! Triangles split where they lie: a surface for displacement, whose levels all have the shape of the mesh.

use super::super::clean::unit;
use super::super::{Surface, TriangleMesh, corner_normals};
use super::{SubdivideError, check_subdivision};
use rayon::prelude::*;

/// The triangles of a clean mesh, each split `levels` times (0 to [`MAX_LEVELS`](crate::num::MAX_LEVELS)) into equal ones, with normals between those of its corners
/// ([`corner_normals`], with that crease angle in degrees).
///
/// # Errors
/// Too many splits, or more than [`MAX_SUBDIVIDED`](super::MAX_SUBDIVIDED) finest triangles.
pub fn flat_surface(mesh: &TriangleMesh, levels: u32, crease_angle: f64) -> Result<Surface, SubdivideError> {
    check_subdivision(mesh.triangles.len() as u64, levels)?;
    let corner_normals = corner_normals(mesh, crease_angle);
    let weights = weights(levels);
    let len = weights.len();
    let mut surface = Surface {
        levels,
        base_vertices: mesh.positions.len() as u32, // triangles index them in 32 bits
        triangles: mesh.triangles.clone(),
        positions: vec![[0.0; 3]; len * mesh.triangles.len()],
        normals: vec![[0.0; 3]; len * mesh.triangles.len()],
        materials: mesh.materials.clone(),
        colours: mesh.colours.clone(),
    };
    let trees = surface.positions.par_chunks_mut(len).zip(surface.normals.par_chunks_mut(len));
    trees.zip(mesh.triangles.par_iter().zip(&corner_normals)).for_each(|((points, shades), (triangle, normals))| {
        let corners = triangle.map(|v| mesh.positions[v as usize]);
        let normals = normals.map(|n| n.map(f64::from));
        for ((point, shade), &weights) in points.iter_mut().zip(shades).zip(&weights) {
            *point = between(corners, weights);
            *shade = unit(between(normals, weights));
            // Normals that run against each other leave nothing.
            if *shade == [0.0; 3] {
                *shade = unit(normals[0]);
            }
        }
    });
    Ok(surface)
}

/// Barycentrics of the points of a lattice, each an exact number.
pub(in crate::mesh) fn weights(levels: u32) -> Vec<[f64; 3]> {
    let m = 1_u32 << levels;
    let size = f64::from(m);
    let row = |j| (0..=m - j).map(move |i| [m - i - j, i, j].map(|w| f64::from(w) / size));
    (0..=m).flat_map(row).collect()
}

/// The point between three with these weights. On a side one weight is zero: then it does not depend on which of the three are its ends.
pub(in crate::mesh) fn between<const N: usize>(corners: [[f64; N]; 3], weights: [f64; 3]) -> [f64; N] {
    std::array::from_fn(|k| (weights[0] * corners[0][k] + weights[1] * corners[1][k]) + weights[2] * corners[2][k] + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::lattice;
    use crate::mesh::{BoundKind, SharedEdges, quantise};
    use crate::num::VertexForm;

    #[test]
    fn splits_lie_on_the_triangles_and_sides_are_alike_in_all_trees() {
        let positions = [[0.1, 0.2, 0.3], [1.7, -0.4, 0.0], [0.3, 1.1, -0.7], [1.9, 1.3, 0.6], [-0.9, 0.7, 1e-3]];
        let mesh = TriangleMesh::from_parts(&positions, &[[0, 1, 2], [3, 2, 1], [2, 4, 0]], &[], vec![]).unwrap();
        let surface = flat_surface(&mesh, 3, 180.0).unwrap();
        for edge in SharedEdges::new(&mesh.triangles).edges().filter(|uses| uses.len() == 2) {
            for place in 0..=8 {
                let [a, b] = [0, 1].map(|k| edge[k].tree as usize * lattice::len(3) + lattice::index(3, edge[k].point(3, place)));
                assert_eq!(surface.positions[a].map(f64::to_bits), surface.positions[b].map(f64::to_bits));
                assert_eq!(surface.normals[a], surface.normals[b]);
            }
        }
        for (tree, &triangle) in mesh.triangles.iter().enumerate() {
            let points = surface.tree(tree);
            for (at, v) in lattice::root(3).into_iter().zip(triangle) {
                assert_eq!(points[lattice::index(3, at)], positions[v as usize]);
            }
            for [own, a, b] in lattice::inserted(3, 2) {
                let [own, a, b] = [own, a, b].map(|at| points[lattice::index(3, at)]);
                (0..3).for_each(|k| assert!((own[k] - (a[k] + b[k]) / 2.0).abs() < 1e-15));
            }
        }
        assert!(quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).is_ok());
        assert_eq!(flat_surface(&mesh, 11, 50.0).unwrap_err(), SubdivideError::Levels(11));
    }
}
