//! Floor 3: methods built from blocks. A method takes an integer ray, walks its memory images and gives a hit; every step is told to a
//! [`StepSink`](crate::step::StepSink), and nothing above needs to know which method ran.

mod children;
mod cone;
mod hit;
pub mod lod;
mod model_space;
pub mod quad_bvh;
mod stack;

pub(crate) use children::Split;
pub use cone::cone;
pub use hit::{ClosestHit, Crossings, Hit, HitSink, TriangleId};
pub use lod::{LodImage, LodTraverser};
pub(crate) use lod::{is_beyond, quarter};
pub use model_space::{ModelRay, ModelSpace, WorldRay};
pub use quad_bvh::{BvhTraverser, bvh_map};
pub use stack::{Entry, Op, STACK_ENTRIES, TraversalStack};
