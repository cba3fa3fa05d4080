//! `stability.json` as it is read: what the page's table shows of it.

use serde::{Deserialize, Serialize};

/// A report of the stability lab.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StabilityReport {
    /// Seed of all rays.
    pub seed: u64,
    /// Overflows were looked for on every ray.
    pub widths_checked: bool,
    /// By case.
    pub rows: Vec<StabilityCase>,
    /// The hunt for counterexamples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hunt: Option<Hunted>,
}

/// A case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StabilityCase {
    /// Its name.
    pub case: String,
    /// What is hard about it.
    pub about: String,
    /// Models.
    pub models: u64,
    /// What its rays have shown.
    #[serde(flatten)]
    pub tally: StabilityTally,
}

/// The hunt.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hunted {
    /// How many climbs it made.
    pub climbs: u64,
    /// What its rays have shown.
    #[serde(flatten)]
    pub tally: StabilityTally,
}

/// What rays have shown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StabilityTally {
    /// Rays.
    pub rays: u64,
    /// Of them those that went into a closed surface as often as out.
    pub balanced: u64,
    /// Of them those compared with exact arithmetic.
    pub compared: u64,
    /// Misses.
    pub misses: u64,
    /// Double hits.
    pub doubles: u64,
    /// Hits that are not those of exact arithmetic.
    pub different: u64,
    /// Values that did not fit their width.
    pub overflows: u64,
    /// Values that were cut to it.
    pub saturated: u64,
    /// Largest error of t.
    pub t_ulp: f64,
    /// Largest error of a barycentric.
    pub bary_ulp: f64,
    /// Largest displacement in pixels.
    pub pixels: f64,
}
