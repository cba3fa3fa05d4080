//! `sphere`: a closed surface around the origin, radius about 1, displaced outwards and inwards by a few per cent to a quarter by fractal noise.

use super::base::{Base, NoMemory, Parameter, Shape, direction, dot, normal_or};
use super::noise;
use crate::mesh::Surface;

/// Noise cells per unit of length and radius per unit of noise of the first octave.
const FIRST: (f64, f64) = (1.6, 0.30);

struct Sphere {
    /// Seed and offset of each octave: the offset keeps the zeros of noise off the axes.
    octaves: Vec<(u32, [f64; 3])>,
    gain: f64,
    /// Finest steps along an edge of the octahedron.
    steps: i32,
}

/// A displaced octahedron sphere with `k` base steps along an edge.
pub(super) fn generate(k: u32, levels: u32, seed: u64, gain: f64) -> Result<Surface, NoMemory> {
    let steps = k << levels;
    // Cells not much smaller than triangles: `steps` of these span a quarter circle, about 1.6.
    let octaves = steps.ilog2().max(1);
    let octaves = (0..octaves)
        .map(|n| {
            let seed = noise::stream(seed, n << 8 | 2);
            (seed, [0, 1, 2].map(|axis| 8.0 * noise::unit(noise::hash(seed, [axis, 0, 0]))))
        })
        .collect();
    Base::octahedron(k)?.tessellate(levels, &Sphere { octaves, gain, steps: steps as i32 })
}

impl Shape for Sphere {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let d = direction(p, self.steps);
        let (mut frequency, mut amplitude) = FIRST;
        let (mut radius, mut slope) = (1.0, [0.0; 3]);
        for &(seed, offset) in &self.octaves {
            let (value, gradient) = noise::noise3(seed, std::array::from_fn(|k| d[k] * frequency + offset[k]));
            radius += amplitude * value;
            slope = std::array::from_fn(|k| slope[k] + amplitude * frequency * gradient[k]);
            frequency *= 2.0;
            amplitude *= self.gain;
        }
        // A sphere can be dented, not turned inside out.
        let radius = radius.max(0.2);
        // Normal of the surface |x| = radius(x / |x|): radial minus the tangential part of the slope.
        let radial = dot(slope, d);
        let normal = std::array::from_fn(|k| radius * d[k] - (slope[k] - radial * d[k]));
        (d.map(|c| c * radius), normal_or(normal, d))
    }
}
