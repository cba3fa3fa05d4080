//! Floor 5: measurements over whole scenes and frames.

pub mod crack;
pub mod result;
