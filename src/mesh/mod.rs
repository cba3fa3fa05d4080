//! Triangle meshes in, hierarchies of 1-to-4 splits out.

mod binding;
mod borders;
mod bounds;
mod clean;
mod coarsen;
pub(crate) mod compact;
mod displace;
mod distance;
mod farthest;
mod hierarchy;
pub mod lattice;
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
mod subdivide;
mod surface;
mod weld;

pub use binding::{Binding, BindingError};
pub use borders::{EdgeUse, SharedEdges};
pub use clean::{Attributes, CleanReport, MeshError, TriangleMesh};
pub use coarsen::{coarsen, farthest as coarsened_by};
pub use displace::{DisplaceError, Displaced, Displacement, HeightMap, MapFault, displace, levels_for as levels_for_map};
pub use distance::{Distance, TwoSidedDistance};
pub use hierarchy::{BoundKind, EdgeCodes, Hierarchy, Placement, edge_index, edges_of_level, edges_of_tree};
pub use motion::Motion;
pub use nearest::FinestSurface;
pub use normals::{DEFAULT_CREASE_ANGLE, corner_normals};
pub use parts::parts;
pub use quantise::{SurfaceError, first_not_finite, grid_holds, most_zeros, move_vertices, quantise};
pub use read::{
    ArrayError, MESH_ENDINGS, MeshCamera, MeshFormat, MeshPlace, MovingMesh, PlacedMeshes, PositionFrames, ReadError, floats, named_files,
    open_array, read, read_as, read_bytes, read_placed, read_placed_bytes, read_positions, shape_and_type,
};
pub use remesh::{DEFAULT_MAX_ERROR, Folds, RemeshError, RemeshOptions, RemeshReport, Works, remesh};
pub use subdivide::{CornerTexture, MAX_SUBDIVIDED, SubdivideError, catmull_clark_surface, check_subdivision, flat_surface, loop_surface};
pub use surface::Surface;
pub use weld::Seams;
