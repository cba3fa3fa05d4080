//! Error against cost: what each method's picture is off by, and what it costs.

mod check;
mod document;
mod equal;
mod join;
mod measure;
mod verdict;

pub use document::{
    Appearance, Converged, Costs, Energy, EqualCost, EqualError, ErrorTime, KIND, LeftOut, MethodEntry, Options, PictureEntry, Point,
    SceneEntry, Shift, SizeCosts, TraceGrid, TracedHit, TracedRay, VERSION, ViewEntry, WarmCosts,
};
pub use equal::{ALWAYS_BELOW, NOT_REACHED, Pair, Reached, cost_at, equal_errors, front};
pub use measure::{COSTS, CostMeasure, ERRORS, ErrorMeasure, USUAL_COSTS, USUAL_ERRORS};
pub use verdict::{Row, Verdict, Winner, verdict_text, verdicts};
