//! Error against cost: what each method's picture is off by, and what it costs.

mod check;
mod document;

pub use document::{
    Converged, Costs, Energy, EqualCost, EqualError, ErrorSpread, ErrorTime, GeometryErrors, KIND, MethodEntry, Options, PictureEntry,
    PictureError, Point, SceneEntry, Shift, Silhouette, TraceGrid, TracedHit, TracedRay, VERSION, ViewEntry,
};
