//! Apart from the floors: the plain exact traverser and the `f64` reference that everything is checked against.
//!
//! [`exact`] is the method as a definition: every rounding of `docs/numbers.md`, all else exact, one recursion. [`mod@reference`] is the
//! full-resolution mesh in `f64`, the truth for image and geometric error. [`naive_bounds()`] computes displacement bounds by
//! their definition, [`naive_compact()`] compact vertices. Nothing here uses a hardware block, a memory image, or a rounding of [`crate::num`]; only the plain types of `num` and `mesh`.

mod cull;
pub mod exact;
mod fine;
mod hit_map;
mod lod;
mod naive_bounds;
mod naive_compact;
pub mod paths;
mod predicates;
pub mod reference;
mod ties;

pub use exact::{Crossings, Exact, ExactHit, Served};
pub use naive_bounds::{TrueBounds, naive_bounds, true_bounds};
pub use naive_compact::naive_compact;
pub use paths::Leg;
pub use predicates::Fractions;
pub use reference::{Reference, ReferenceHit};
pub use ties::Ties;
