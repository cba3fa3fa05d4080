//! Measuring: what an error costs, sweeps over scenes, views, methods and machines, and what both go on with.
//!
//! A [`Progress`] is told how far it is; [`Silent`] tells nobody.

mod cache;
mod chosen;
mod fault;
mod job_lines;
mod pass;
mod progress;
mod results;
mod rows;
mod words;
mod workers;

pub use cache::{Cache, LEAST_TRIANGLES, Lookup};
pub use chosen::{Chosen, ChosenError};
pub use fault::{fault, fault_at};
pub use job_lines::{JobLine, JobLines, LinesError, aside};
pub use pass::simulate;
pub use progress::{Progress, Silent, Work, busy};
pub use results::{NoResult, results};
pub use rows::{Row, csv};
pub use words::{count, grouped};
pub use workers::{at_once, in_order};
