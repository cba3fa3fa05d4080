//! The graph that ships: meshoptimizer's `clusterlod` (crate meshopt), as its authors set it for ray tracing.
//!
//! Clusters of up to 128 triangles, cut by the surface area heuristic; groups of neighbours, borders locked, simplified to half and cut anew. Neither sloppy nor permissive simplification,
//! which may tear what hangs together: a group that cannot be simplified ends its part of the graph early.

use super::graph::{Graph, Made, Sphere};
use super::packed::MOST;
use super::snapped::Snapped;
use meshopt::VertexDataAdapter;
use meshopt::clusterlod::{ClodMesh, clod_build, clod_default_config_rt};

/// Most triangles of a cluster.
const MOST_TRIANGLES: usize = 128;

/// The graph of a mesh, with groups of about so many clusters.
pub(super) fn graph(mesh: Snapped, partition: usize) -> Graph {
    let positions: Vec<[f32; 3]> = mesh.places.iter().map(|place| place.map(f32::from)).collect();
    let vertices = VertexDataAdapter::new(bytemuck::cast_slice(&positions), size_of::<[f32; 3]>(), 0).expect("whole vertices");
    let mut config = clod_default_config_rt(MOST_TRIANGLES);
    config.max_vertices = config.max_vertices.min(MOST);
    config.partition_size = partition;
    config.simplify_permissive = false;
    config.simplify_fallback_permissive = false;
    config.simplify_fallback_sloppy = false;
    let step = f64::from(mesh.grid.step);
    let units = |centre: [f32; 3]| std::array::from_fn(|k| f64::from(mesh.grid.lo[k]) + step * f64::from(centre[k]));
    let mut made = Vec::new();
    clod_build(config, &ClodMesh::new(mesh.triangles.as_flattened(), &vertices), |group, clusters| {
        let bounds = group.simplified;
        let triangles = |indices: &[u32]| indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        made.push(Made {
            clusters: clusters.iter().map(|own| (triangles(own.indices), u32::try_from(own.refined).ok())).collect(),
            error: if bounds.error == f32::MAX { f64::INFINITY } else { step * f64::from(bounds.error) },
            sphere: Some(Sphere { centre: units(bounds.center), radius: step * f64::from(bounds.radius) }),
        });
        made.len() as i32 - 1 // far fewer than triangles
    });
    Graph::new(mesh, made)
}
