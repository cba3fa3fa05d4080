//! Measurements over whole scenes and frames, and the page that shows them.

#[cfg(feature = "diagrams")]
pub mod diagram;
pub mod error_time;
mod file_names;
pub mod inspect;
pub mod page;
pub mod palette;
pub mod result;
mod version;

pub use file_names::{is_file_name, plain_name, plain_names};
pub use page::page;
pub use version::results_version;
