//! Rays run: their hits as they are, or a frame on machines: traced once, its steps replayed on each.

mod cast;
mod follow;
mod frame;
mod held;
mod simulate;

pub use cast::{ClosestOnly, HitRow, cast, cast_all, cast_any, cast_counting, write_hits};
pub use follow::{FollowError, Followed, cast_following};
pub use frame::{Frame, FrameRays, RayHit, Traced, Worker};
pub use held::HeldFrame;
pub use simulate::{Compute, Job, check, simulate};
