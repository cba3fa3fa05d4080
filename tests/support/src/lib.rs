//! Small models, surfaces and rays for the tests and benchmarks of lodray.
#![allow(missing_docs)] // helpers, named for what they make

pub mod models;
pub mod surfaces;
