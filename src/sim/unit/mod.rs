//! The cycle model of `rtl/traversal_unit.sv`, equal to it on every port in every cycle. `docs/traversal-unit.md` is the contract of the two.
//!
//! All ports are Moore: [`TraversalUnit::outputs`] comes from registers, and [`TraversalUnit::tick`] is the end of a cycle with the given inputs.
//! Blocks run the functions of [`crate::block`], each behind as many elastic registers as it has cycles of latency. [`environment`] drives the
//! model or the RTL with rays and a memory; [`wave`] writes what happens as a waveform, [`steps`] as text.

mod arbiter;
mod closest;
mod context;
mod counts;
pub mod environment;
mod error;
mod memory;
mod operands;
mod records;
mod register;
mod state;
pub mod steps;
mod traffic;
mod traversal_unit;
pub mod wave;
mod wires;

pub(super) use arbiter::Arbiter;
pub use counts::UnitCounts;
pub use error::UnitError;
pub use memory::SceneMemory;
pub(super) use operands::Resource;
pub use register::BlockCounts;
pub use state::{Fetch, State};
pub use traffic::{Latency, Stall, Traffic};
pub use traversal_unit::{Inputs, Outputs, TraversalUnit};

use crate::block::tri_test::TriTest;
use crate::block::{Block, Timing};

/// Edge functions that the triangle test evaluates in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EdgesPerCycle {
    /// All three of a triangle.
    #[default]
    Three,
    /// One.
    One,
}

impl EdgesPerCycle {
    /// Timing of `tri_test`.
    pub fn timing(self) -> Timing {
        match self {
            Self::Three => TriTest::TIMING,
            Self::One => TriTest::ONE_EDGE,
        }
    }
}

/// The most contexts that a unit can have: six bits.
pub const MAX_CONTEXTS: usize = 64;

/// Parameters of a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnitConfig {
    /// Ray contexts, 1 to [`MAX_CONTEXTS`].
    pub contexts: usize,
    /// Edge functions per cycle.
    pub edges_per_cycle: EdgesPerCycle,
}

impl UnitConfig {
    /// A unit for one ray at a time.
    pub const fn one_context() -> Self {
        Self { contexts: 1, edges_per_cycle: EdgesPerCycle::Three }
    }
}

impl Default for UnitConfig {
    fn default() -> Self {
        Self { contexts: 4, edges_per_cycle: EdgesPerCycle::Three }
    }
}
