//! Triangle meshes in, hierarchies of 1-to-4 splits out.

mod borders;
mod bounds;
mod clean;
mod coarsen;
pub(crate) mod compact;
mod distance;
mod farthest;
mod hierarchy;
pub mod lattice;
mod loop_surface;
mod motion;
mod nearest;
mod normals;
mod orient;
mod parts;
pub mod procedural;
mod quantise;
mod read;
mod remesh;
mod sets;
mod surface;
mod weld;

pub use borders::{EdgeUse, SharedEdges};
pub use clean::{CleanReport, MeshError, TriangleMesh};
pub use coarsen::{coarsen, farthest as coarsened_by};
pub use distance::{Distance, TwoSidedDistance};
pub use hierarchy::{BoundKind, EdgeCodes, Hierarchy, Placement, edge_index, edges_of_level, edges_of_tree};
pub use loop_surface::{LoopError, MAX_LOOP_TRIANGLES, check as check_loop, loop_surface};
pub use motion::Motion;
pub use nearest::FinestSurface;
pub use normals::{DEFAULT_CREASE_ANGLE, corner_normals};
pub use parts::parts;
pub use quantise::{SurfaceError, first_not_finite, grid_holds, most_zeros, move_vertices, quantise};
pub use read::{
    ArrayError, MESH_ENDINGS, MeshFormat, PositionFrames, ReadError, named_files, open_array, read, read_as, read_bytes, read_positions,
    shape_and_type,
};
pub use remesh::{DEFAULT_MAX_ERROR, Folds, RemeshError, RemeshOptions, RemeshReport, Works, remesh};
pub use surface::Surface;
pub use weld::Seams;
