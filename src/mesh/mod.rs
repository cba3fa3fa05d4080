//! Floor 2: triangle meshes in, hierarchies of 1-to-4 splits out.

mod borders;
mod bounds;
mod hierarchy;
pub mod lattice;
pub mod procedural;
mod quantise;
mod surface;

pub use borders::{EdgeUse, SharedEdges};
pub use hierarchy::{EdgeCodes, Hierarchy, Placement, edge_index, edges_of_level, edges_of_tree};
pub use quantise::{SurfaceError, quantise};
pub use surface::Surface;
