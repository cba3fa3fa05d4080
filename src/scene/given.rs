//! Scenes of triangles as they were given, for exact rays.

use super::{BuildError, BuildOptions};
use crate::format::Scene;
use crate::mesh::{MeshError, Surface};
use glam::DVec3;

/// Triangles as they were given, and where they went.
#[derive(Clone, Debug)]
pub struct Given {
    /// The scene: its finest triangles are the faces that are there.
    pub scene: Scene,
    /// Of each of them, by its number among the hits ([`HitRow::triangle`](crate::run::HitRow::triangle)), the face that it is.
    pub faces: Vec<u32>,
}

impl Scene {
    /// The scene of these very triangles: none is split, and none is left out but those that have two corners at one place, which no ray meets. What is there
    /// twice is met twice. Corners at one place are one to every ray, whichever vertices they name, and vertices lie within half a step of their places, of which the
    /// largest side of the box has some 2^28. Each face has its own normal.
    ///
    /// # Errors
    /// An index out of range, a coordinate that is not finite, no triangle, or more than there can be.
    pub fn as_given(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> Result<Given, BuildError> {
        if let Some((vertex, &value)) = vertices.iter().enumerate().find_map(|(k, p)| Some((k, p.iter().find(|c| !c.is_finite())?))) {
            return Err(MeshError::Coordinate { vertex, value }.into());
        }
        if let Some((triangle, &index)) =
            faces.iter().enumerate().find_map(|(k, face)| Some((k, face.iter().find(|&&v| v as usize >= vertices.len())?)))
        {
            return Err(MeshError::Index { triangle, index, vertices: vertices.len() }.into());
        }
        let corners = |face: &[u32; 3]| face.map(|v| vertices[v as usize]);
        let has_three = |face: &&[u32; 3]| {
            let [a, b, c] = corners(face);
            a != b && b != c && c != a
        };
        let kept: Vec<(u32, [u32; 3])> = (0..).zip(faces).filter(|(_, face)| has_three(face)).map(|(k, face)| (k, *face)).collect();
        if kept.is_empty() {
            return Err(MeshError::Empty { triangles: faces.len(), degenerate: faces.len() }.into());
        }
        let surface = Surface {
            levels: 0,
            base_vertices: vertices.len() as u32, // indices are 32 bits
            triangles: kept.iter().map(|(_, face)| *face).collect(),
            positions: kept.iter().flat_map(|(_, face)| corners(face)).collect(),
            normals: kept.iter().flat_map(|(_, face)| [normal(corners(face)); 3]).collect(),
            ..Surface::default()
        };
        let scene = Self::of_surface(&surface, &BuildOptions::own_triangles())?;
        let faces = (0..scene.trees()).map(|tree| kept[scene.source(tree) as usize].0).collect();
        Ok(Given { scene, faces })
    }
}

/// Normal of a triangle, whatever its size; of one without area any.
fn normal(corners: [[f64; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(DVec3::from_array);
    // Scaled first: products of very long and very short edges stay within the range of numbers.
    let unit = |v: DVec3| v / v.abs().max_element();
    unit(b - a).cross(unit(c - a)).try_normalize().map_or([0.0, 0.0, 1.0], |n| n.as_vec3().to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::{Crossings, METHODS, Over};
    use crate::rays::{Query, RayFile};

    /// A cube of twelve triangles, counter-clockwise seen from outside.
    fn cube() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let corner = |k: u32| std::array::from_fn(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let faces = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        ((0..8).map(corner).collect(), faces.collect())
    }

    /// Rays along axes and diagonals through vertices, edges and diagonals of the cube's faces, and others.
    fn rays() -> RayFile {
        let steps = [-1.0, -0.5, 0.0, 0.3, 1.0];
        let directions = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 1.0], [0.2, 0.3, -1.0]];
        let through = steps.into_iter().flat_map(|x| steps.into_iter().flat_map(move |y| steps.into_iter().map(move |z| [x, y, z])));
        let ray = |d: [f64; 3], p: [f64; 3]| Query::new(std::array::from_fn(|k| p[k] - 8.0 * d[k]), d);
        RayFile::new(through.flat_map(|p| directions.map(|d| ray(d, p))).collect())
    }

    #[test]
    fn each_wall_is_met_once_at_edges_and_vertices_too() {
        let (vertices, faces) = cube();
        let given = Scene::as_given(&vertices, &faces).unwrap();
        let rays = rays();
        for registered in METHODS.iter().filter(|method| method.over == Over::Scene && method.name != "reference") {
            let method = given.scene.method(registered.name).unwrap();
            let (all, first, counts) = (method.cast_all(&rays).unwrap(), method.cast(&rays), method.crossings(&rays).unwrap());
            assert_eq!(method.meets(&rays), all.iter().map(|hits| !hits.is_empty()).collect::<Vec<_>>());
            for ((hits, first), Crossings { front, back }) in all.iter().zip(&first).zip(counts) {
                assert_eq!((front, back), (back, hits.len() as u32 - front), "{}: {hits:?}", registered.name);
                assert!(hits.first().is_none_or(|hit| hit == first) && (first.tree >= 0) != hits.is_empty());
                assert!(hits.is_sorted_by_key(|hit| hit.t));
            }
            assert!(all.iter().any(|hits| hits.len() == 2));
        }
        let reference = given.scene.method("reference").unwrap();
        assert_eq!(reference.cast_all(&rays).unwrap_err().to_string(), "its hits are not exact: it finds the closest of a ray alone");
    }

    #[test]
    fn from_within_one_wall_is_met_and_what_does_not_count_is_not() {
        let (vertices, faces) = cube();
        let method = Scene::as_given(&vertices, &faces).unwrap().scene.method("bvh").unwrap();
        let outwards = RayFile::new(vertices.iter().map(|&v| Query::new([0.0; 3], v)).collect());
        assert_eq!(method.crossings(&outwards).unwrap(), [Crossings { front: 0, back: 1 }; 8]);
        let through = |near, far| RayFile::new(vec![Query::new([0.25, 0.5, 5.0], [0.0, 0.0, -1.0]).between(near, far)]);
        let hits = |near, far| method.cast_all(&through(near, far)).unwrap()[0].iter().map(|hit| hit.t.round()).collect::<Vec<_>>();
        assert_eq!([hits(0.0, 9.0), hits(4.5, 9.0), hits(0.0, 4.5), hits(4.5, 5.5)], [vec![4.0, 6.0], vec![6.0], vec![4.0], vec![]]);
    }

    #[test]
    fn faces_are_those_that_were_given() {
        let (vertices, mut faces) = cube();
        faces.insert(3, [5, 5, 0]);
        faces.push(faces[0]);
        let given = Scene::as_given(&vertices, &faces).unwrap();
        let mut there = given.faces.clone();
        there.sort_unstable();
        assert_eq!(there, [0, 1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13]);
        let [a, b, c] = faces[0].map(|v| DVec3::from_array(vertices[v as usize]));
        let (middle, out) = ((a + b + c) / 3.0, (b - a).cross(c - a));
        let rays = RayFile::new(vec![Query::new((middle + out).to_array(), (-out).to_array())]);
        let met: Vec<_> =
            given.scene.method("lod").unwrap().cast_all(&rays).unwrap()[0].iter().map(|hit| given.faces[hit.triangle as usize]).collect();
        assert!(met.len() == 3 && met[..2].contains(&0) && met[..2].contains(&13), "{met:?}: it is there twice");
        assert!(Scene::as_given(&vertices, &[[0, 1, 8]]).unwrap_err().to_string().contains("index 8 is out of range"));
        assert!(Scene::as_given(&[[f64::NAN; 3]; 3], &[[0, 1, 2]]).unwrap_err().to_string().contains("vertex 0"));
        assert!(Scene::as_given(&vertices, &[[1, 1, 2]]).unwrap_err().to_string().contains("no triangle is left"));
    }
}
