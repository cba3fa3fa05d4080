//! Error against cost: what each method's picture is off by, and what it costs.

mod document;

pub use document::{
    Converged, Costs, Energy, EqualCost, EqualError, ErrorTime, KIND, MethodEntry, Options, PictureEntry, PictureError, Point, SceneEntry,
    Shift, TraceGrid, TracedHit, TracedRay, VERSION, ViewEntry,
};
