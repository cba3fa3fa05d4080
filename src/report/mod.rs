//! Measurements over whole scenes and frames.

pub mod result;
mod version;

pub use version::results_version;
