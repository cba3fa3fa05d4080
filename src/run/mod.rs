//! A frame on machines: its rays traced once, their steps replayed on each.

mod frame;
mod simulate;

pub use frame::FrameRays;
pub use simulate::{Compute, Job, check, simulate};
