//! `street`: the displaced [`super::sphere`] 64 times, in two rows along z; 2 long. Seen from the middle of an end, (0, 0, 1), it has bodies at every distance: the nearest fill the picture's height,
//! the farthest some pixels.

use super::base::NoMemory;
use super::copies::copies;
use super::sphere;
use crate::mesh::Surface;

/// Bodies along a side.
const LENGTH: u32 = 32;
/// Models in all.
pub(super) const MODELS: u32 = 2 * LENGTH;
/// From centre to centre along the street, and from its middle to the centres of a side, in units of a sphere's radius: none reaches into the next.
const APART: f64 = 2.6;
const ASIDE: f64 = 1.8;
/// Half the length of the street becomes 1.
const SCALE: f64 = 2.0 / (APART * LENGTH as f64);

/// A street of spheres with `k` base steps along an edge of the octahedron.
pub(super) fn generate(k: u32, levels: u32, seed: u64, gain: f64) -> Result<Surface, NoMemory> {
    let along = |at: u32| APART * (f64::from(at) - f64::from(LENGTH - 1) / 2.0);
    let centres: Vec<_> = (0..LENGTH).flat_map(|at| [-ASIDE, ASIDE].map(|x| [x, 0.0, along(at)])).collect();
    copies(&sphere::generate(k, levels, seed, gain)?, &centres, SCALE)
}
