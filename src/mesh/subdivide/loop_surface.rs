//! Loop subdivision of a mesh as a source of hierarchies: every vertex is a point of the limit surface.
//!
//! The mesh is the control net. A vertex of level n goes where Loop's rules take it in the limit, so levels are samples of one smooth surface: each holds the points of those above it, as
//! a hierarchy wants, and all further splits would only add to them. Borders are cubic B-splines of border vertices alone; so is each curve of edges of three triangles or more.
//! Where more or fewer than two such edges meet, and where closed fans touch in one vertex, that stays where it is.

use super::super::clean::unit;
use super::super::{Surface, TriangleMesh, lattice};
use super::loop_net::Net;
use super::{SubdivideError, add, check_subdivision};
use rayon::prelude::*;

/// The Loop surface of a clean mesh, split `levels` times (0 to [`MAX_LEVELS`](crate::num::MAX_LEVELS)).
///
/// Shading normals are the sums of the normals of the finest triangles around a vertex, by their area; at an edge of three triangles or more those of the own tree alone.
///
/// # Errors
/// Too many splits, or more than [`MAX_SUBDIVIDED`](super::MAX_SUBDIVIDED) finest triangles.
pub fn loop_surface(mesh: &TriangleMesh, levels: u32) -> Result<Surface, SubdivideError> {
    check_subdivision(mesh.triangles.len() as u64, levels)?;
    let mut net = Net::new(&mesh.positions, &mesh.triangles);
    for _ in 0..levels {
        net = net.split();
    }
    let positions = net.limit();
    let on_fork = net.is_on_fork();
    let finest = net.triangles;
    let normals = Normals::new(&positions, &finest);
    // Where each corner of each finest triangle of a tree lies in its lattice.
    let places: Vec<[usize; 3]> =
        (0..1 << (2 * levels)).map(|node| lattice::node(levels, levels, node).map(|place| lattice::index(levels, place))).collect();
    let len = lattice::len(levels);
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
    trees.zip(finest.par_chunks(places.len())).for_each(|((points, shades), triangles)| {
        let mut own = vec![[0.0; 3]; len];
        for (triangle, places) in triangles.iter().zip(&places) {
            let facet = normals.facet(triangle);
            places.iter().for_each(|&place| add(&mut own[place], facet));
        }
        for (triangle, places) in triangles.iter().zip(&places) {
            for (&v, &place) in triangle.iter().zip(places) {
                points[place] = positions[v as usize];
                let all = if on_fork[v as usize] { own[place] } else { normals.sums[v as usize] };
                // Facets that run against each other leave nothing; a tree may be a point.
                let found = [all, own[place]].map(unit).into_iter().find(|&normal| normal != [0.0; 3]);
                shades[place] = found.unwrap_or([0.0, 0.0, 1.0]);
            }
        }
    });
    Ok(surface)
}

/// Normals of triangles, as long as twice their area, and their sums around vertices.
struct Normals<'a> {
    positions: &'a [[f64; 3]],
    /// Areas of very small and very large meshes stay within the range of numbers.
    scale: f64,
    sums: Vec<[f64; 3]>,
}

impl<'a> Normals<'a> {
    fn new(positions: &'a [[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let size = positions.par_iter().flatten().map(|c| c.abs()).reduce(|| f64::MIN_POSITIVE, f64::max);
        let mut normals = Self { positions, scale: 1.0 / size, sums: vec![[0.0; 3]; positions.len()] };
        for triangle in triangles {
            let facet = normals.facet(triangle);
            triangle.iter().for_each(|&v| add(&mut normals.sums[v as usize], facet));
        }
        normals
    }

    fn facet(&self, triangle: &[u32; 3]) -> [f64; 3] {
        let [p0, p1, p2] = triangle.map(|v| glam::DVec3::from_array(self.positions[v as usize]) * self.scale);
        (p1 - p0).cross(p2 - p0).to_array()
    }
}

#[cfg(test)]
#[path = "loop_tests.rs"]
mod tests;
