//! The cycle model of `rtl/traversal_unit.sv`, equal to it on every port in every cycle. `docs/traversal-unit.md` is the contract of the two.
//!
//! All ports are Moore: [`TraversalUnit::outputs`] comes from registers, and [`TraversalUnit::tick`] is the end of a cycle with the given inputs.
//! Blocks run the functions of [`crate::block`], each behind as many elastic registers as it has cycles of latency. [`environment`] drives the
//! model or the RTL with rays and a memory; [`wave`] writes what happens as a waveform, [`ray_trace`] as text.

mod arbiter;
mod checks;
mod closest;
mod context;
mod counts;
pub mod environment;
mod error;
mod fitted;
mod memory;
mod operands;
pub mod ray_trace;
mod records;
mod register;
mod traffic;
mod traversal_unit;
pub mod wave;
mod wires;

pub use crate::hardware::{Fetch, RayError, State};
pub(super) use arbiter::Arbiter;
pub use counts::UnitCounts;
pub use error::UnitError;
pub use memory::{SceneMemory, file_config};
pub use register::BlockCounts;
pub use traffic::{Latency, Stall, Traffic};
pub use traversal_unit::{Inputs, Outputs, TraversalUnit};
