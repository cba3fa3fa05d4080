//! Numerical stability on stiff and extreme cases: named cases, judged ray by ray, and a hunt for counterexamples.

mod cases;
pub mod crack;
mod dyadic;
mod error;
mod found;
mod goal;
pub mod growth;
pub mod hunt;
mod judge;
mod measure;
mod model;
mod paths;
mod placed;
mod rays;
mod shapes;
mod stiff;
pub mod suite;

pub use cases::{CASES, Case, FILE_CASES, SAMPLE};
pub use dyadic::Dyadic;
pub use found::Found;
pub use goal::{GOALS, Goal};
pub use hunt::Hunt;
pub use judge::{Judge, Tally, WIDTHS_CHECKED};
pub use measure::{Figures, LabLine, LabPlan};
pub use model::Model;
pub use rays::{Aim, BOUNCES, Bounce, Cones, PIXEL, Shot, Views, shot};
pub use stiff::Scale;
pub use suite::{Report, Row};
