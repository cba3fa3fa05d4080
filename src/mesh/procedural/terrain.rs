//! `terrain`: a fractal heightfield over a square of width 2 centred at the origin, y up.
//!
//! Height is a sum of octaves of gradient noise: 2 cells across for the first, twice as many for each further one down to the finest
//! lattice spacing, amplitude times the gain from one to the next. Each octave is turned against the one before (so that no axis shows)
//! and has its own offset (so that the zeros of noise do not fall on lattice points). The finest octaves depend on the number of
//! splits; all others do not, so that fewer splits show the same mountains.

use super::GenerateError;
use super::base::{Base, Parameter, Shape};
use super::noise::{self, Cell2};
use crate::mesh::Surface;

/// Height of the first octave per unit of noise, world units.
const AMPLITUDE: f64 = 0.42;
/// How much peaks are sharpened and valleys flattened: height = h + SHARPEN h^2, which is monotone for |h| < 1 / (2 SHARPEN).
const SHARPEN: f64 = 0.9;
/// Lattice corners of noise the scene may be slid to; the one with the lowest ground around the camera's place is taken.
const SLIDES: u32 = 24;

/// One octave: noise coordinates are `turn * (x, z) + offset`.
#[derive(Clone, Copy)]
struct Octave {
    seed: u32,
    /// Frequency times cosine and sine.
    turn: [f64; 2],
    offset: [f64; 2],
    amplitude: f64,
}

struct Terrain {
    octaves: Vec<Octave>,
    /// Finest steps across.
    steps: i32,
}

/// Terrain of `g` by `g` quads.
pub(super) fn generate(g: u32, levels: u32, seed: u64, gain: f64) -> Result<Surface, GenerateError> {
    Base::grid(g)?.tessellate(levels, &Terrain::new(g << levels, seed, gain))
}

impl Terrain {
    fn new(steps: u32, seed: u64, gain: f64) -> Self {
        // The view of the paper stands low over (0, 0.25) and looks at the origin: there should be a valley, not the inside of a mountain.
        let low = |slide: u32| {
            let coarse = Self::slid(64, seed, slide, gain);
            let ground = |z: f64| coarse.height([0.0, z]);
            ground(0.25).max(ground(0.15)).max(ground(0.35)).max(ground(0.0) - 0.1)
        };
        let slide = (0..SLIDES).map(|s| (low(s), s)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, s)| s);
        Self::slid(steps, seed, slide, gain)
    }

    fn slid(steps: u32, seed: u64, slide: u32, gain: f64) -> Self {
        // Cells across: 2, 4, ... up to the steps across, at least one octave.
        let octaves = steps.ilog2().max(1);
        // Cosine and sine of about 36.9 degrees, exact enough to keep the length.
        let (cos, sin) = (0.8, 0.6);
        let mut turn = [1.0, 0.0];
        let mut amplitude = AMPLITUDE;
        let octaves = (0..octaves)
            .map(|n| {
                let seed = noise::stream(seed, n << 8 | slide);
                // In the middle of a cell, and far enough from zero never to matter.
                let part = |axis| 0.25 + 0.5 * noise::unit(noise::hash(seed, [axis, 0, 0]));
                let octave = Octave { seed, turn, offset: [part(0), part(1)], amplitude };
                turn = [2.0 * (cos * turn[0] - sin * turn[1]), 2.0 * (sin * turn[0] + cos * turn[1])];
                amplitude *= gain;
                octave
            })
            .collect();
        Self { octaves, steps: steps as i32 }
    }

    /// Exactly one value for each whole parameter, -1..=1.
    #[inline(always)]
    fn coordinate(&self, p: i32) -> f64 {
        f64::from(2 * p - self.steps) / f64::from(self.steps)
    }

    /// Height over a place in the square, for choosing where to be.
    fn height(&self, p: [f64; 2]) -> f64 {
        let sum = self.octaves.iter().map(|o| o.amplitude * noise::noise2(o.seed, o.at(p)));
        let h: f64 = sum.sum();
        h + SHARPEN * h * h
    }
}

impl Octave {
    #[inline(always)]
    fn at(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        [self.turn[0] * x - self.turn[1] * z + self.offset[0], self.turn[1] * x + self.turn[0] * z + self.offset[1]]
    }
}

impl Shape for Terrain {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let (mut position, mut normal) = ([[0.0; 3]], [[0.0; 3]]);
        self.row(p, [0; 3], &mut position, &mut normal);
        (position[0], normal[0])
    }

    fn row(&self, start: Parameter, step: Parameter, positions: &mut [[f64; 3]], normals: &mut [[f32; 3]]) {
        let place = |i: usize| [0, 1].map(|k| self.coordinate(start[k] + step[k] * i as i32));
        // Octave by octave along the row, so that the cell of the point before mostly serves again. Until the last loop positions hold
        // (slope along x, height, slope along z).
        let finest = self.octaves.len() - 1;
        for (n, octave) in self.octaves.iter().enumerate() {
            let mut last = (i32::MIN, i32::MIN);
            let mut cell = Cell2::default();
            for (i, sum) in positions.iter_mut().enumerate() {
                let [(cx, x), (cz, z)] = octave.at(place(i)).map(noise::cell);
                if (cx, cz) != last {
                    last = (cx, cz);
                    cell = Cell2::new(octave.seed, cx, cz);
                }
                if n < finest {
                    let [v, dx, dz] = cell.value_gradient(x, z).map(|v| v * octave.amplitude);
                    sum[0] += octave.turn[0] * dx + octave.turn[1] * dz;
                    sum[1] += v;
                    sum[2] += octave.turn[0] * dz - octave.turn[1] * dx;
                } else {
                    // Its cells are as small as triangles: slopes within them say nothing about the surface.
                    sum[1] += octave.amplitude * cell.value(x, z);
                }
            }
        }
        for (i, (position, normal)) in positions.iter_mut().zip(normals).enumerate() {
            let [dx, h, dz] = *position;
            let [x, z] = place(i);
            *position = [x, h + SHARPEN * h * h, z];
            let steeper = 1.0 + 2.0 * SHARPEN * h;
            let (dx, dz) = (steeper * dx, steeper * dz);
            let scale = 1.0 / (1.0 + dx * dx + dz * dz).sqrt();
            *normal = [-dx * scale, scale, -dz * scale].map(|c| c as f32);
        }
    }
}
