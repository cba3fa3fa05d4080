//! What hits name, as a scene: the finest triangles of the mesh, and behind them a triangle in the plane of each R-LOD, of its mean colour.

use super::tree::Tree;
use crate::format::{Line, Scene, SceneError, SceneInfo, TreeBvh, build};
use crate::mesh::{Placement, Surface, lattice};
use crate::num::{Box16, VertexForm};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// The scene of the finest triangles of `scene` and of the R-LODs of its tree.
///
/// # Errors
/// More triangles than a scene holds, or no memory for them.
pub(super) fn surface(tree: &Tree, scene: &Scene) -> Result<Scene, SceneError> {
    let Placement { offset, scale } = scene.meta().placement;
    let world = |point: DVec3| (DVec3::from_array(offset) + scale * point).to_array();
    let levels = scene.levels();
    let hierarchy = scene.decode();
    let per_tree = 1u32 << (2 * levels);
    let colours: Vec<[f32; 3]> = (0..).map_while(|material| scene.colour(material)).collect();
    let normals = (0..scene.finest_triangles() as u32).into_par_iter().flat_map_iter(|id| {
        let (own, places) = ((id / per_tree) as usize, lattice::node(levels, levels, id % per_tree));
        places.map(|place| scene.normal_at(own, place))
    });
    let len = lattice::len(levels);
    let points = (0..scene.finest_triangles() as u32).into_par_iter().flat_map_iter(|id| {
        let first = (id / per_tree) as usize * len;
        let places = lattice::node(levels, levels, id % per_tree).map(|place| first + lattice::index(levels, place));
        places.map(|at| world(DVec3::from_array(hierarchy.points[at].map(f64::from))))
    });
    let mut positions: Vec<[f64; 3]> = points.collect();
    let mut normals: Vec<[f32; 3]> = normals.collect();
    let mut materials: Vec<u16> = Vec::new();
    if !colours.is_empty() {
        materials.extend((0..scene.finest_triangles() as u32).map(|id| scene.material((id / per_tree) as usize)));
        // Colours of scenes are a list: the nearest of them stands for the mean.
        let nearest = |mean: [f32; 3]| {
            let far = |of: &[f32; 3]| Vec3::from_array(*of).distance_squared(Vec3::from_array(mean));
            (0..).zip(&colours).min_by(|a, b| far(a.1).total_cmp(&far(b.1))).map_or(0, |(material, _)| material)
        };
        materials.extend(tree.rlods.iter().map(|rlod| nearest(rlod.colour)));
    }
    for rlod in &tree.rlods {
        let [x, y, z, _] = rlod.plane;
        let normal = Vec3::new(x, y, z);
        let (u, v) = normal.normalize().as_dvec3().any_orthonormal_pair();
        // Inside the model's box, or near it: who draws it needs a place and no size.
        let size = f64::from(rlod.radius).max(64.0) / 4.0;
        let mean = Vec3::from_array(rlod.mean).as_dvec3();
        positions.extend([mean - (u + v) * size, mean + (2.0 * u - v) * size, mean + (2.0 * v - u) * size].map(world));
        normals.extend([normal.to_array(); 3]);
    }
    let surface = Surface {
        levels: 0,
        base_vertices: positions.len() as u32, // at most 3 (2^28 + 2^27)
        triangles: (0..positions.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        positions,
        normals,
        materials,
        colours,
    };
    let info = SceneInfo { name: scene.meta().name.clone(), vertices: VertexForm::Exact, ..SceneInfo::default() };
    // In their order, and under a node without children: rays find them through the kd-tree.
    let numbered =
        |boxes: &[Box16]| Ok::<_, SceneError>(TreeBvh { nodes: vec![Line::default()], order: (0..).take(boxes.len()).collect() });
    build(&surface, info, numbered)
}
