//! Measurements over whole scenes and frames.

pub mod error_time;
pub mod result;
mod version;

pub use version::results_version;
