//! What a ray does, step by step, as its traversal states it: the one thing that caches, units, energies and pictures are told of a method.
//!
//! - `section`: the sections of a method's memory, and where their lines lie.
//! - `act`: a step: lines asked for, and what the hardware does with them.
//! - `shape`: the kinds of nodes, as a table.
//! - `word`: a step in 64 bits.
//! - `sink`: who is told: nobody, counters, or
//! - `lines`: which lines were touched.
//! - `batch`: whoever keeps the steps of rays for the simulator.
//!
//! Whatever time or energy depends on is stated here by the traversal itself; nothing later guesses it from the order of steps or from the kind of data.

mod act;
mod batch;
mod joined;
mod lines;
mod run;
mod section;
mod shape;
mod sink;
mod word;

pub use act::{Act, Fetch, MAX_FETCH_LINES, MAX_PLACES, Step};
pub use batch::{Batch, Link, Recorder};
pub use joined::{Moved, joined};
pub use lines::{LineCounter, LineSets};
pub use run::{MAX_RUN, TriangleRun};
pub use section::{MAX_SECTIONS, MapError, MemoryMap, Nodes, Section, SectionId};
pub use shape::{NodeShape, ShapeFacts};
pub use sink::{NoSteps, StepCounts, StepSink};
pub use word::{Asking, StepWord};
