//! Error against cost: what each method's picture is off by, and what it costs.

mod document;
mod equal;
mod figure;
mod table;

pub use document::{
    Appearance, Converged, Costs, Energy, EqualCost, EqualError, ErrorTime, KIND, MethodEntry, Options, PictureEntry, Point, SceneEntry,
    Shift, TraceGrid, TracedHit, TracedRay, VERSION, ViewEntry,
};
pub use equal::{ALWAYS_BELOW, NOT_REACHED, Pair, cost_at, equal_errors, front};
pub use figure::{COSTS, CostFigure, ERRORS, ErrorFigure};
pub use table::csv;
