//! BVHs over the triangles of a hierarchy: built, with their leaves, as files, and kept.

mod cut;
mod dense;
mod file;
mod full;
mod leaves;
mod store;

pub(super) use cut::Corners;
pub use cut::{check_hierarchy, cut_id, cut_triangle, level_ids};
pub use file::TreeKey;
pub use full::{FullBuilder, FullBvh, FullNodes, FullOptions, FullTree, NodeBoxes, NodeOrder};
pub(super) use leaves::shared_vertices;
pub use leaves::{DenseBlock, DenseStrip, Leaf, LeafLayout, Leaves, dense_triangles};
pub use store::{NoStore, TreeStore};
