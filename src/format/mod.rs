//! Floor 2: memory images: the lines that the hardware reads, bit for bit, and the scene file that holds them.

mod lines;

pub use lines::{BoundData, Box16, BvhChild, ChildRef, L0Record, VertexData};
