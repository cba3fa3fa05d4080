//! The traversal unit's time without its data: which cycle a ray is taken in, its lines are asked for in, and its hit leaves in.
//!
//! [`UnitTiming`] does in every cycle what the cycle model [`unit`](super::unit) does, and so the RTL, but is told by a ray's
//! [`Step`](crate::step::Step)s what the blocks would find. Blocks always have takers, so once one takes an input, the cycle of its result is known, and so are the
//! states that follow of themselves: a context sleeps until the cycle in which it next asks for something. Cycles in which nobody asks and no port moves need no work.
//!
//! What the RTL does not have, the full-resolution BVH of the baseline, runs through the same unit:
//!
//! - A node with 32-bit boxes has four lines, and its test takes the cycles of `box_test32` and `child_sort`.
//! - A leaf is visited as a node is. All its lines are asked for one after the other (also those of vertices, which hardware would find only behind its indices: the
//!   baseline gets that for nothing); when all are there, its triangles are tested.
//! - A hit is divided as in a tree, but is one of the full resolution already: behind `SUM` comes `DONE`.
//! - Hits wait for their division in any number.

mod advance;
mod context;
mod counts;
mod describe;
mod grant;
mod hits;
mod phases;
mod ports;
mod station;
mod unit;
mod wheel;

pub use phases::{PartPhases, Phases, STEPS, STRETCH};
pub use ports::{LineRequest, Ports, RayCursor, Steps, tag};
pub use unit::UnitTiming;
