//! Floor 5: measurements over whole scenes and frames.

pub mod crack;
pub mod result;
mod simulate;
mod version;

pub use simulate::{Job, check, simulate};
pub use version::results_version;
