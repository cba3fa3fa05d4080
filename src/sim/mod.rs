//! Floor 4: the cycle level.

pub mod ports;
