//! `spikes`: a closed unit sphere with needles, one lattice vertex each: displacements far larger than the edges they displace.
//!
//! A case for bounds and boxes rather than for the eye. The needles of fine levels are as long as those of coarse ones, so the finer the
//! level, the more edge lengths an inserted vertex jumps. The surface is closed and consistently wound; needles may cross each other.

use super::base::{Base, NoMemory, Parameter, Shape, direction, dot, normal_or};
use super::noise;
use crate::mesh::Surface;

/// One vertex in so many is a needle.
const ONE_IN: u32 = 14;
/// Least and largest length of a needle at `detail` = 1, in radii.
const LENGTH: (f64, f64) = (0.3, 1.2);

struct Spikes {
    seed: u32,
    detail: f64,
    /// Finest steps along an edge of the octahedron.
    steps: i32,
}

/// A sphere with needles with `k` base steps along an edge of its octahedron.
pub(super) fn generate(k: u32, levels: u32, seed: u64, detail: f64) -> Result<Surface, NoMemory> {
    Base::octahedron(k)?.tessellate(levels, &Spikes { seed: noise::stream(seed, 3), detail, steps: (k << levels) as i32 })
}

impl Spikes {
    fn radius(&self, p: Parameter) -> f64 {
        let h = noise::hash(self.seed, p);
        if !h.is_multiple_of(ONE_IN) {
            return 1.0;
        }
        // Squared: many short needles, few long ones.
        let t = noise::unit(noise::mix(h));
        1.0 + self.detail * (LENGTH.0 + (LENGTH.1 - LENGTH.0) * t * t)
    }
}

impl Shape for Spikes {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let d = direction(p, self.steps);
        let radius = self.radius(p);
        // The neighbours on the octahedron are the points one step off along two axes; radii there give the slope by least squares.
        let mut normal = d;
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            for (da, db) in [(-1, -1), (-1, 1), (1, -1), (1, 1)] {
                let mut q = p;
                q[a] += da;
                q[b] += db;
                if q.iter().map(|c| c.abs()).sum::<i32>() == self.steps {
                    let e = direction(q, self.steps);
                    let away: [f64; 3] = std::array::from_fn(|k| e[k] - d[k]);
                    let slope = (self.radius(q) - radius) / dot(away, away) / 3.0;
                    normal = std::array::from_fn(|k| normal[k] - slope * away[k]);
                }
            }
        }
        (d.map(|c| c * radius), normal_or(normal, d))
    }
}
