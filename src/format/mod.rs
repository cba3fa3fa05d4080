//! Memory images: the lines that the hardware reads, bit for bit, and the scene file that holds them.

pub mod audit;
mod coarsen;
mod colour;
mod decode;
mod encode;
mod export;
mod file;
mod job;
pub mod layout;
mod lines;
mod normal;
mod numbering;
mod prisms;
mod prune;
mod refit;
mod region;
mod replace;
mod scene;
mod sections;
mod shading;
mod staging;

pub use colour::to_srgb;
pub use decode::{child_corners, last_displacements};
pub use encode::{SceneInfo, TreeBvh, build, encode, tree_boxes};
pub use export::{ExportCounts, LevelMesh, export_level, level_mesh};
pub use job::JobView;
pub use layout::{LevelStarts, has_split};
pub use lines::{
    Box16, BvhChild, BvhNode, ChildRef, Displacements, L0Record, Line, ShortDisplacements, ShortLine, SixNode, SplitRecord, TreeLines,
    VertexData,
};
pub use normal::{decode_normal, encode_normal};
pub(crate) use prisms::node_prisms;
pub use prisms::scene_prisms;
pub use refit::{Grid, Refit, RefitError, RefitNodes, RefitOptions, Shading};
pub use region::{Beyond, Job, JobRegion};
pub use replace::{remove_abandoned, temporary_beside, write_and_rename};
pub use scene::{Meta, Scene, SceneError};
pub use sections::{FileSection, MAGIC, VERSION};
pub use staging::Staging;
