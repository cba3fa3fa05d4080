//! The triangles of all clusters as a scene of their own: what their hits name, with normals and materials.
//!
//! Simplification keeps vertices where they were, so each has the normals that the mesh has there: of several, a triangle takes the one nearest to its own direction, so that creases
//! stay. It has the material of the mesh's triangle that gave its first corner that normal.

use super::graph::Graph;
use super::snapped::Snapped;
use crate::format::{Line, Scene, SceneError, SceneInfo, TreeBvh, build};
use crate::mesh::{Placement, Surface, lattice};
use crate::num::{Box16, VertexForm};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Corners of the mesh's triangles, by vertex.
pub(super) struct Corners {
    /// Where those of each vertex begin in `all`, and the end.
    firsts: Vec<u32>,
    /// Finest triangles of the scene that meet there, each with the corner that does in the lower two bits.
    all: Vec<u32>,
}

impl Corners {
    pub fn new(mesh: &Snapped) -> Self {
        let mut firsts = vec![0u32; mesh.places.len() + 1];
        for vertex in mesh.triangles.as_flattened() {
            firsts[*vertex as usize + 1] += 1;
        }
        for at in 1..firsts.len() {
            firsts[at] += firsts[at - 1];
        }
        let (mut next, mut all) = (firsts.clone(), vec![0; 3 * mesh.triangles.len()]);
        for (corners, source) in mesh.triangles.iter().zip(&mesh.sources) {
            for (corner, vertex) in (0..).zip(corners) {
                let at = &mut next[*vertex as usize];
                // Finest triangles are at most 2^28.
                all[*at as usize] = source << 2 | corner;
                *at += 1;
            }
        }
        Self { firsts, all }
    }

    fn at(&self, vertex: u32) -> &[u32] {
        let [first, end] = [0, 1].map(|k| self.firsts[vertex as usize + k] as usize);
        &self.all[first..end]
    }
}

/// The scene of the triangles of a graph over the finest triangles of `scene`.
///
/// # Errors
/// More triangles than a scene holds, or no memory for them.
pub(super) fn surface(graph: &Graph, corners: &Corners, scene: &Scene) -> Result<Scene, SceneError> {
    let Placement { offset, scale } = scene.meta().placement;
    let world = |point: [i32; 3]| std::array::from_fn(|k| offset[k] + scale * f64::from(point[k]));
    let levels = scene.levels();
    let places = |source: u32| lattice::node(levels, levels, source & ((1 << (2 * levels)) - 1));
    let tree = |source: u32| (source >> (2 * levels)) as usize;
    // The normal that the scene has nearest to a direction at a vertex, and the triangle that has it.
    let nearest = |vertex: u32, to: Vec3| -> (Vec3, u32) {
        let own = corners.at(vertex).iter().map(|&at| {
            let (source, corner) = (at >> 2, (at & 3) as usize);
            (Vec3::from_array(scene.normal_at(tree(source), places(source)[corner])), source)
        });
        own.max_by(|a, b| a.0.dot(to).total_cmp(&b.0.dot(to)).then(b.1.cmp(&a.1))).unwrap_or((to, 0))
    };
    let shaded = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| DVec3::from_array(graph.grid.point(graph.places[v as usize]).map(f64::from)));
        let facet = (b - a).cross(c - a).normalize_or(DVec3::Z).as_vec3();
        let chosen = triangle.map(|vertex| nearest(vertex, facet));
        let normals = chosen.map(|(normal, _)| if normal == Vec3::ZERO { facet } else { normal }.to_array());
        (normals, scene.material(tree(chosen[0].1)))
    };
    let (normals, materials): (Vec<_>, Vec<_>) = graph.triangles.par_iter().map(shaded).unzip();
    let colours = (0..).map_while(|material| scene.colour(material)).collect::<Vec<_>>();
    let surface = Surface {
        levels: 0,
        base_vertices: graph.places.len() as u32, // fewer than 2^30
        triangles: graph.triangles.clone(),
        positions: graph.triangles.iter().flatten().map(|&v| world(graph.grid.point(graph.places[v as usize]))).collect(),
        normals: normals.into_iter().flatten().collect(),
        materials: if colours.is_empty() { Vec::new() } else { materials },
        colours,
    };
    let info = SceneInfo { name: scene.meta().name.clone(), vertices: VertexForm::Exact, ..SceneInfo::default() };
    // In their order, and under a node without children: rays find them through the BVHs of frames.
    let numbered =
        |boxes: &[Box16]| Ok::<_, SceneError>(TreeBvh { nodes: vec![Line::default()], order: (0..).take(boxes.len()).collect() });
    build(&surface, info, numbered)
}
