//! The C interface of lodray: `include/lodray.h` is printed from this crate's declarations, and `docs/c-interface.md` shows how to use it.
//!
//! Nothing is computed here: each function checks what it was given and calls the library. A function that fails returns null or -1 and leaves a sentence
//! for [`lodray_last_error`](error::lodray_last_error). No panic leaves the crate.

pub mod bits;
pub mod cast;
pub mod config;
pub mod error;
pub mod golden;
mod pointers;
pub mod ports;
pub mod rays;
pub mod scene;
pub mod unit;
mod widths;
