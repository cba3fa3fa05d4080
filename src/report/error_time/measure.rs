//! The errors and the costs that diagrams and tables know, by name.

use super::document::{Costs, Point, ViewEntry};
use crate::picture::{ErrorSpread, PictureError};

/// An error.
#[derive(Clone, Copy)]
pub struct ErrorMeasure {
    /// Its name in files.
    pub id: &'static str,
    /// Its name on axes.
    pub name: &'static str,
    /// Its value, if it was measured.
    pub of: fn(&Point) -> Option<f64>,
    /// The same of the picture of a camera shifted by half a pixel, for errors that such a shift makes, too.
    pub shift: Option<fn(&PictureError) -> Option<f64>>,
}

/// A cost.
#[derive(Clone, Copy)]
pub struct CostMeasure {
    /// Its name in files.
    pub id: &'static str,
    /// Its name on axes; energies have their unit from the figures.
    pub name: &'static str,
    /// Its value, if there is one.
    pub of: fn(&Point, &Costs) -> Option<f64>,
    /// It is an energy.
    pub is_energy: bool,
}

type Spread = fn(&Point) -> Option<ErrorSpread>;

macro_rules! spread {
    ($id:literal, $name:literal, $of:expr) => {
        [
            error(concat!($id, "-p99"), concat!($name, ", 99th percentile"), |p| ($of as Spread)(p).map(|e| e.percentile_99)),
            error(concat!($id, "-mean"), concat!($name, ", mean"), |p| ($of as Spread)(p).map(|e| e.mean)),
            error(concat!($id, "-median"), concat!($name, ", median"), |p| ($of as Spread)(p).map(|e| e.median)),
            error(concat!($id, "-maximum"), concat!($name, ", maximum"), |p| ($of as Spread)(p).map(|e| e.maximum)),
        ]
    };
}

const fn error(id: &'static str, name: &'static str, of: fn(&Point) -> Option<f64>) -> ErrorMeasure {
    ErrorMeasure { id, name, of, shift: None }
}

const SURFACE: [ErrorMeasure; 4] = spread!("surface", "distance to the surface, pixels", |p| p.geometry.surface);
const HIT: [ErrorMeasure; 4] = spread!("hit", "distance to the full-resolution hit, pixels", |p| p.geometry.hit);
const NORMAL: [ErrorMeasure; 4] = spread!("normal", "angle between normals, degrees", |p| p.geometry.normal_degrees);
const SILHOUETTE: ErrorMeasure = error("silhouette", "pixels that one of the two hits, share", |p| Some(p.geometry.silhouette.share));
const RMSE: ErrorMeasure =
    ErrorMeasure { id: "rmse", name: "RMSE, of 255", of: |p| Some(p.picture.rmse), shift: Some(|picture| Some(picture.rmse)) };
const SSIM: ErrorMeasure = ErrorMeasure {
    id: "dssim",
    name: "1 - SSIM",
    of: |p| p.picture.ssim.map(|ssim| 1.0 - ssim),
    shift: Some(|picture| picture.ssim.map(|ssim| 1.0 - ssim)),
};
const FLIP: ErrorMeasure =
    ErrorMeasure { id: "flip-mean", name: "FLIP, mean", of: |p| Some(p.picture.flip.mean), shift: Some(|picture| Some(picture.flip.mean)) };
const FLIP_99: ErrorMeasure = ErrorMeasure {
    id: "flip-p99",
    name: "FLIP, 99th percentile",
    of: |p| Some(p.picture.flip.percentile_99),
    shift: Some(|picture| Some(picture.flip.percentile_99)),
};
const OFF: ErrorMeasure =
    ErrorMeasure { id: "off", name: "pixels off, share", of: |p| Some(p.picture.off), shift: Some(|picture| Some(picture.off)) };
const VIEWED_RMSE: ErrorMeasure = error("viewed-rmse", "RMSE against the converged picture, of 255", |p| p.viewed.map(|v| v.rmse));
const LUMINANCE: ErrorMeasure =
    error("luminance", "RMSE of the luminance against the converged picture, wholly surface", |p| p.appearance.map(|a| a.rmse));
const VIEWED_FLIP: ErrorMeasure = error("viewed-flip-mean", "FLIP against the converged picture, mean", |p| p.viewed.map(|v| v.flip.mean));

/// All errors.
pub const ERRORS: [ErrorMeasure; 21] = [
    SURFACE[0],
    SURFACE[1],
    SURFACE[2],
    SURFACE[3],
    HIT[0],
    HIT[1],
    HIT[2],
    HIT[3],
    NORMAL[0],
    NORMAL[1],
    NORMAL[2],
    NORMAL[3],
    SILHOUETTE,
    RMSE,
    SSIM,
    FLIP,
    FLIP_99,
    OFF,
    VIEWED_RMSE,
    VIEWED_FLIP,
    LUMINANCE,
];

/// One of each kind.
pub const USUAL_ERRORS: [ErrorMeasure; 6] = [SURFACE[0], SURFACE[1], NORMAL[1], RMSE, FLIP, VIEWED_FLIP];

const fn cost(id: &'static str, name: &'static str, of: fn(&Point, &Costs) -> Option<f64>) -> CostMeasure {
    CostMeasure { id, name, of, is_energy: false }
}

const TIME: CostMeasure = cost("time", "time, ms", |_, c| Some(c.milliseconds));
const ENERGY: CostMeasure = CostMeasure { id: "energy", name: "energy", of: |_, c| Some(c.energy.total), is_energy: true };
const LINES: CostMeasure = cost("dram-lines", "DRAM lines", |_, c| Some(c.dram_lines as f64));

/// All costs.
pub const COSTS: [CostMeasure; 10] = [
    TIME,
    ENERGY,
    LINES,
    cost("cycles", "cycles", |_, c| Some(c.cycles as f64)),
    cost("l1-requests", "L1 requests for each ray", |_, c| Some(c.l1_requests_per_ray)),
    cost("bytes-per-triangle", "bytes for each finest triangle", |p, _| Some(p.bytes_per_triangle)),
    cost("warm-time", "time of a warm frame, ms", |_, c| c.warm.map(|warm| warm.milliseconds)),
    CostMeasure { id: "warm-energy", name: "energy of a warm frame", of: |_, c| c.warm.map(|warm| warm.energy), is_energy: true },
    cost("warm-dram-lines", "DRAM lines of a warm frame", |_, c| c.warm.map(|warm| warm.dram_lines)),
    cost("unit-gates", "area of a traversal unit, gate equivalents", |_, c| c.unit_gates),
];

/// Those that one asks for first.
pub const USUAL_COSTS: [CostMeasure; 3] = [TIME, ENERGY, LINES];

impl ErrorMeasure {
    /// Its value for a camera shifted by half a pixel, in a view with so many samples.
    pub fn of_shift(&self, view: &ViewEntry, samples: u32) -> Option<f64> {
        let shift = view.shift.iter().find(|shift| shift.samples == samples)?;
        self.shift.and_then(|of| of(&shift.picture))
    }
}
