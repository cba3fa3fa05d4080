//! `wall`: the displaced [`super::sphere`] 182 times, in 14 columns and 13 rows that face +z; 2 wide. What a repeated model costs without instances.

use super::base::NoMemory;
use super::copies::copies;
use super::sphere;
use crate::mesh::Surface;

/// Columns and rows.
const COLUMNS: u32 = 14;
const ROWS: u32 = 13;
/// Models in all.
pub(super) const MODELS: u32 = COLUMNS * ROWS;
/// From centre to centre, in units of a sphere's radius: none reaches into the next.
const APART: f64 = 2.6;
/// Half the width of the wall becomes 1.
const SCALE: f64 = 2.0 / (APART * COLUMNS as f64);

/// A wall of spheres with `k` base steps along an edge of the octahedron.
pub(super) fn generate(k: u32, levels: u32, seed: u64, gain: f64) -> Result<Surface, NoMemory> {
    let middle = |at: u32, of: u32| APART * (f64::from(at) - f64::from(of - 1) / 2.0);
    let centres: Vec<_> = (0..MODELS).map(|number| [middle(number % COLUMNS, COLUMNS), middle(number / COLUMNS, ROWS), 0.0]).collect();
    copies(&sphere::generate(k, levels, seed, gain)?, &centres, SCALE)
}
