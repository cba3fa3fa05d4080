//! Floor 5: measurements over whole scenes and frames.

pub mod crack;
mod simulate;

pub use simulate::simulate;
