//! `terrain`: a fractal heightfield over a square of width 2, or as asked for, centred at the origin, y up.
//!
//! Height is a sum of octaves of gradient noise: 2 cells across for the first, twice as many for each further one down to the finest
//! lattice spacing, amplitude times the gain from one to the next. From the fourth on they are also weaker in valleys than on peaks, by
//! a smooth factor that follows the first three. Each octave is turned against the one before (so that no axis shows) and has its own
//! offset (so that the zeros of noise do not fall on lattice points). More splits add octaves and change none of the others.

use super::base::{Base, NoMemory, Parameter, Shape};
use super::noise::{self, Cell2};
use crate::mesh::Surface;

/// World units across, where nothing else is asked for.
pub(super) const WIDTH: f64 = 2.0;
/// Height of the first octave per unit of noise, world units.
const AMPLITUDE: f64 = 0.44;
/// How much peaks are sharpened and valleys flattened: height = h + SHARPEN h^2, which is monotone for |h| < 1 / (2 SHARPEN).
const SHARPEN: f64 = 0.9;
/// The first octaves, which decide how rough the ground is.
const COARSE: usize = 3;
/// Points at a time.
const BLOCK: usize = 128;
/// Variants of each seed; the one with the lowest ground around the camera's place is taken.
const VARIANTS: u32 = 24;

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
    /// World units across for each of [`WIDTH`].
    stretch: f64,
}

/// Terrain of `g` by `g` quads, `width` across.
pub(super) fn generate(g: u32, levels: u32, seed: u64, gain: f64, width: f64) -> Result<Surface, NoMemory> {
    let terrain = Terrain { stretch: width / WIDTH, ..Terrain::new(g << levels, seed, gain) };
    Base::grid(g)?.tessellate(levels, &terrain)
}

impl Terrain {
    fn new(steps: u32, seed: u64, gain: f64) -> Self {
        // The view of the paper stands low over (0, 0.25) and looks at the origin: there should be a valley, not the inside of a mountain.
        let low = |variant: u32| {
            // Of a fixed size and roughness, so that these change the detail and not the place.
            let coarse = Self::variant(64, seed, variant, 0.55);
            let ground = |z: f64| coarse.height([0.0, z]);
            ground(0.25).max(ground(0.15)).max(ground(0.35)).max(ground(0.0) - 0.1)
        };
        let variant = (0..VARIANTS).map(|s| (low(s), s)).min_by(|a, b| a.0.total_cmp(&b.0)).map_or(0, |(_, s)| s);
        Self::variant(steps, seed, variant, gain)
    }

    fn variant(steps: u32, seed: u64, variant: u32, gain: f64) -> Self {
        // Cells across: 2, 4, ... up to the steps across, at least one octave.
        let octaves = steps.ilog2().max(1);
        // Cosine and sine of about 36.9 degrees, exact enough to keep the length.
        let (cos, sin) = (0.8, 0.6);
        let mut turn = [1.0, 0.0];
        let mut amplitude = AMPLITUDE;
        let octaves = (0..octaves)
            .map(|n| {
                let seed = noise::stream(seed, n << 8 | variant);
                // In the middle of a cell, and far enough from zero never to matter.
                let part = |axis| 0.25 + 0.5 * noise::unit(noise::hash(seed, [axis, 0, 0]));
                let octave = Octave { seed, turn, offset: [part(0), part(1)], amplitude };
                turn = [2.0 * (cos * turn[0] - sin * turn[1]), 2.0 * (sin * turn[0] + cos * turn[1])];
                amplitude *= gain;
                octave
            })
            .collect();
        Self { octaves, steps: steps as i32, stretch: 1.0 }
    }

    /// Exactly one value for each whole parameter, -1..=1.
    #[inline(always)]
    fn coordinate(&self, p: i32) -> f64 {
        f64::from(2 * p - self.steps) / f64::from(self.steps)
    }

    /// Height over a place in the unstretched square, for choosing where to be.
    fn height(&self, p: [f64; 2]) -> f64 {
        let (mut position, mut normal) = ([[0.0; 3]], [[0.0; 3]]);
        self.block(&[p], &mut position, &mut normal);
        position[0][1]
    }
}

impl Octave {
    #[inline(always)]
    fn at(&self, [x, z]: [f64; 2]) -> [f64; 2] {
        [self.turn[0] * x - self.turn[1] * z + self.offset[0], self.turn[1] * x + self.turn[0] * z + self.offset[1]]
    }

    /// Adds this octave's height and slopes at `places`.
    fn add(&self, places: &[[f64; 2]], sums: &mut [[f64; 3]]) {
        let [cos, sin] = self.turn.map(|t| t * self.amplitude);
        self.visit(places, sums, |cell, x, z, sum| {
            let [v, dx, dz] = cell.value_gradient(x, z);
            sum[0] += self.amplitude * v;
            sum[1] += cos * dx + sin * dz;
            sum[2] += cos * dz - sin * dx;
        });
    }

    /// Adds the height alone. For the finest octave: its cells are as small as triangles, and slopes within them say nothing about
    /// the surface.
    fn add_height(&self, places: &[[f64; 2]], sums: &mut [[f64; 3]]) {
        self.visit(places, sums, |cell, x, z, sum| sum[0] += self.amplitude * cell.value(x, z));
    }

    #[inline(always)]
    fn visit(&self, places: &[[f64; 2]], sums: &mut [[f64; 3]], add: impl Fn(&Cell2, f64, f64, &mut [f64; 3])) {
        let mut last = (i32::MIN, i32::MIN);
        let mut cell = Cell2::default();
        for (&place, sum) in places.iter().zip(sums) {
            let [(cx, x), (cz, z)] = self.at(place).map(noise::cell);
            if (cx, cz) != last {
                last = (cx, cz);
                cell = Cell2::new(self.seed, cx, cz);
            }
            add(&cell, x, z, sum);
        }
    }
}

impl Shape for Terrain {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let (mut position, mut normal) = ([[0.0; 3]], [[0.0; 3]]);
        self.row(p, [0; 3], &mut position, &mut normal);
        (position[0], normal[0])
    }

    fn row(&self, start: Parameter, step: Parameter, positions: &mut [[f64; 3]], normals: &mut [[f32; 3]]) {
        let mut p = start;
        for (positions, normals) in positions.chunks_mut(BLOCK).zip(normals.chunks_mut(BLOCK)) {
            let mut places = [[0.0; 2]; BLOCK];
            for place in &mut places[..positions.len()] {
                *place = [self.coordinate(p[0]), self.coordinate(p[1])];
                p = [p[0] + step[0], p[1] + step[1], 0];
            }
            self.block(&places[..positions.len()], positions, normals);
        }
    }
}

impl Terrain {
    /// Positions and normals of at most [`BLOCK`] places, octave by octave: the cell of the place before mostly serves again.
    fn block(&self, places: &[[f64; 2]], positions: &mut [[f64; 3]], normals: &mut [[f32; 3]]) {
        // Height, slope along x, slope along z.
        let (mut coarse, mut fine) = ([[0.0; 3]; BLOCK], [[0.0; 3]; BLOCK]);
        let (coarse, fine) = (&mut coarse[..places.len()], &mut fine[..places.len()]);
        let (first, rest) = self.octaves.split_at(COARSE.min(self.octaves.len()));
        first.iter().for_each(|octave| octave.add(places, coarse));
        if let Some((finest, rest)) = rest.split_last() {
            rest.iter().for_each(|octave| octave.add(places, fine));
            finest.add_height(places, fine);
        }
        for (k, (position, normal)) in positions.iter_mut().zip(normals).enumerate() {
            let ([c, cx, cz], [f, fx, fz]) = (coarse[k], fine[k]);
            let (w, dw) = weight(c);
            let (h, factor) = (c + w * f, 1.0 + dw * f);
            *position = [self.stretch * places[k][0], h + SHARPEN * h * h, self.stretch * places[k][1]];
            let steeper = (1.0 + 2.0 * SHARPEN * h) / self.stretch;
            let (dx, dz) = (steeper * (cx * factor + w * fx), steeper * (cz * factor + w * fz));
            let scale = 1.0 / (1.0 + dx * dx + dz * dz).sqrt();
            *normal = [-dx * scale, scale, -dz * scale].map(|c| c as f32);
        }
    }
}

/// How rough the ground is at coarse height `c`, and the derivative: valleys are smoother than peaks.
fn weight(c: f64) -> (f64, f64) {
    let t = ((c + 0.22) * 2.0).clamp(0.0, 1.0);
    // A clamped t has slope 0 on both sides.
    (0.3 + 0.8 * t * t * (3.0 - 2.0 * t), 9.6 * t * (1.0 - t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_the_derivatives() {
        for stretch in [1.0, 32.0] {
            check_normals(Terrain { stretch, ..Terrain::new(128, 4, 0.55) });
        }
    }

    fn check_normals(mut terrain: Terrain) {
        // The finest octave does not count towards normals.
        terrain.octaves.last_mut().expect("octaves").amplitude = 0.0;
        let e = 1e-6;
        for n in 0..500 {
            let [x, z] = [0, 1].map(|axis| 2.0 * noise::unit(noise::hash(9, [n, axis, 0])) - 1.0);
            let (mut position, mut normal) = ([[0.0; 3]], [[0.0; 3]]);
            terrain.block(&[[x, z]], &mut position, &mut normal);
            let dx = (terrain.height([x + e, z]) - terrain.height([x - e, z])) / (2.0 * e * terrain.stretch);
            let dz = (terrain.height([x, z + e]) - terrain.height([x, z - e])) / (2.0 * e * terrain.stretch);
            let [a, b, c] = normal[0].map(f64::from);
            assert!((a / b + dx).abs() < 1e-3 && (c / b + dz).abs() < 1e-3, "{a} {b} {c} {dx} {dz}");
        }
    }

    #[test]
    fn splits_and_gain_change_the_detail_and_not_the_mountains() {
        let base = |levels, gain| {
            let s = generate(16, levels, 1, gain, WIDTH).expect("a small terrain");
            (0..s.triangles.len()).map(|t| s.tree(t)[0][1]).collect::<Vec<_>>()
        };
        let reference = base(5, 0.55);
        for (other, most) in [(base(3, 0.55), 0.02), (base(5, 0.45), 0.12)] {
            assert!(reference.iter().zip(&other).all(|(a, b)| (a - b).abs() < most));
        }
    }

    #[test]
    fn a_point_alone_is_the_point_of_its_row() {
        let terrain = Terrain::new(512, 2, 0.6);
        let (mut positions, mut normals) = ([[0.0; 3]; 300], [[0.0; 3]; 300]);
        terrain.row([310, 7, 0], [-1, 1, 0], &mut positions, &mut normals);
        for k in 0..300 {
            assert_eq!(terrain.point([310 - k, 7 + k, 0]), (positions[k as usize], normals[k as usize]));
        }
    }
}
