//! The cycle level: what happens in which cycle, with the functions of the floors below and none of its own.

pub mod dram;
pub mod energy;
pub mod replay;
pub mod timing;
pub mod unit;
