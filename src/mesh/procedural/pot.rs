//! `pot`: a hammered teapot of four closed bodies that reach into each other, y up, standing on y = 0 with its axis through the origin.
//!
//! Belly, lid with knob, spout (towards +x) and handle are one kind of shape each: an outline turned round a path, which is straight for
//! belly and lid. The spout's outline turns back over its lip and down into the mouth. Dimples and a finer grain go inwards only, so
//! the pot stays on its plane and within its outlines.

use super::base::{Base, NoMemory, Parameter, Shape, append, cross, direction, dot, normal_or, reserved, unit};
use super::noise;
use super::spline::spline;
use crate::mesh::Surface;

/// Cells of noise per unit of length and depth at `detail` = 1: of the dimples, and of the grain in them.
const SKIN: [(f64, f64); 2] = [(44.0, 0.005), (220.0, 0.0006)];

/// One body: what is turned round what.
pub(super) struct Part {
    /// Control points of the outline, from the lower end to the upper: distance from the path, and place on the path.
    pub(super) outline: &'static [[f64; 2]],
    /// Control points of the path, x and y; places on it are 0 at its beginning and 1 at its end.
    path: &'static [[f64; 2]],
    /// What the distance is multiplied with in the plane of the path, and across.
    section: [f64; 2],
    /// Base steps from an end to the straight part of the body's base, and half the straight part's, both of a pot of `n`.
    size: fn(u32) -> (u32, u32),
}

/// Places on the axis are heights.
const AXIS: &[[f64; 2]] = &[[0.0, 0.0], [0.0, 1.0]];

impl Part {
    /// Base triangles.
    pub(super) fn trees(&self, n: u32) -> u64 {
        let (ends, straight) = (self.size)(n);
        8 * u64::from(ends) * (u64::from(ends) + 2 * u64::from(straight))
    }
}

pub(super) const BELLY: Part = Part {
    outline: &[
        [0.0, 0.02],
        [0.09, 0.02],
        [0.14, 0.016],
        [0.16, 0.0],
        [0.175, 0.0],
        [0.19, 0.0],
        [0.186, 0.03],
        [0.225, 0.062],
        [0.28, 0.115],
        [0.317, 0.18],
        [0.322, 0.25],
        [0.29, 0.32],
        [0.23, 0.37],
        [0.185, 0.395],
        [0.18, 0.415],
        [0.165, 0.418],
        [0.13, 0.405],
        [0.07, 0.4],
        [0.0, 0.4],
    ],
    path: AXIS,
    section: [1.0, 1.0],
    size: |n| (n, 0),
};

pub(super) const LID: Part = Part {
    outline: &[
        [0.0, 0.37],
        [0.07, 0.37],
        [0.13, 0.375],
        [0.165, 0.4],
        [0.172, 0.42],
        [0.16, 0.438],
        [0.125, 0.452],
        [0.08, 0.468],
        [0.035, 0.478],
        [0.018, 0.494],
        [0.026, 0.511],
        [0.05, 0.52],
        [0.052, 0.548],
        [0.035, 0.566],
        [0.015, 0.57],
        [0.0, 0.57],
    ],
    path: AXIS,
    section: [1.0, 1.0],
    size: |n| (n.div_ceil(2), 0),
};

const SPOUT: Part = Part {
    outline: &[
        [0.0, 0.0],
        [0.06, 0.0],
        [0.09, 0.08],
        [0.085, 0.22],
        [0.068, 0.38],
        [0.052, 0.54],
        [0.043, 0.7],
        [0.038, 0.85],
        [0.042, 0.98],
        [0.038, 1.01],
        [0.03, 1.0],
        [0.026, 0.9],
        [0.023, 0.8],
        [0.012, 0.74],
        [0.0, 0.74],
    ],
    path: &[[0.2, 0.12], [0.31, 0.14], [0.385, 0.2], [0.42, 0.28], [0.45, 0.35], [0.51, 0.4]],
    section: [1.0, 1.0],
    size: |n| (n.div_ceil(4), n.div_ceil(2)),
};

const HANDLE: Part = Part {
    outline: &[
        [0.0, 0.0],
        [0.035, 0.0],
        [0.04, 0.06],
        [0.034, 0.18],
        [0.029, 0.32],
        [0.027, 0.5],
        [0.029, 0.68],
        [0.034, 0.82],
        [0.04, 0.94],
        [0.035, 1.0],
        [0.0, 1.0],
    ],
    path: &[
        [-0.24, 0.11],
        [-0.34, 0.1],
        [-0.43, 0.13],
        [-0.5, 0.2],
        [-0.515, 0.28],
        [-0.47, 0.345],
        [-0.4, 0.345],
        [-0.33, 0.32],
        [-0.24, 0.29],
    ],
    section: [0.8, 1.15],
    size: |n| (n.div_ceil(4), n),
};

pub(super) const PARTS: [&Part; 4] = [&BELLY, &LID, &SPOUT, &HANDLE];

/// Base triangles of a pot of `n`.
pub(super) fn trees(n: u32) -> u64 {
    PARTS.iter().map(|part| part.trees(n)).sum()
}

/// A pot with `n` base steps from the belly's ends to its middle; `detail` scales dimples and grain.
pub(super) fn generate(n: u32, levels: u32, seed: u64, detail: f64) -> Result<Surface, NoMemory> {
    let mut pot = Surface { levels, triangles: reserved(trees(n) as usize)?, ..Surface::default() };
    for part in PARTS {
        let (ends, straight) = (part.size)(n);
        let body = Body { part, half: ((ends + straight) << levels) as i32, skin: Skin::new(seed, detail) };
        let more = Base::capsule(ends, straight)?.tessellate(levels, &body)?;
        let first = pot.base_vertices;
        pot.base_vertices += more.base_vertices;
        pot.triangles.extend(more.triangles.iter().map(|t| t.map(|v| first + v)));
        append(&mut pot.positions, &more.positions)?;
        append(&mut pot.normals, &more.normals)?;
    }
    Ok(pot)
}

/// Depth everywhere in space, so that it needs no parameters on the bodies and has no seams.
struct Skin {
    /// Seed, offset (it keeps the zeros of noise off the axes), cells per unit and depth of each kind of dimple.
    kinds: [(u32, [f64; 3], f64, f64); 2],
}

impl Skin {
    fn new(seed: u64, detail: f64) -> Self {
        let kinds = [0, 1].map(|kind| {
            let seed = noise::stream(seed, kind << 8 | 4);
            let offset = [0, 1, 2].map(|axis| 8.0 * noise::unit(noise::hash(seed, [axis, 0, 0])));
            (seed, offset, SKIN[kind as usize].0, detail * SKIN[kind as usize].1)
        });
        Self { kinds }
    }

    /// Depth and its gradient. The square of noise has wide valleys and narrow ridges between, as hammers leave them.
    fn depth(&self, p: [f64; 3]) -> (f64, [f64; 3]) {
        let (mut depth, mut slope) = (0.0, [0.0; 3]);
        for &(seed, offset, cells, deep) in &self.kinds {
            let (value, gradient) = noise::noise3(seed, std::array::from_fn(|k| p[k] * cells + offset[k]));
            depth += deep * value * value;
            slope = std::array::from_fn(|k| slope[k] + 2.0 * deep * value * cells * gradient[k]);
        }
        (depth, slope)
    }
}

struct Body {
    part: &'static Part,
    /// Finest steps from the middle of the base to an end.
    half: i32,
    skin: Skin,
}

impl Shape for Body {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let Part { outline, path, section, .. } = self.part;
        let [[away, place], [away_slope, place_slope], _] = spline(outline, 0.5 + 0.5 * f64::from(p[1]) / f64::from(self.half));
        let [centre, along, bend] = spline(path, place);
        // Round the path, evenly; at an end any way will do.
        let round = p[0].abs() + p[2].abs();
        let [cos, _, sin] = if round == 0 { [1.0, 0.0, 0.0] } else { direction([p[0], 0, p[2]], round) };
        let (in_plane, across) = (section[0] * cos, section[1] * sin);

        // A frame of the path: `side` x `ahead` is z.
        let speed = (along[0] * along[0] + along[1] * along[1]).sqrt();
        let ahead = [along[0] / speed, along[1] / speed, 0.0];
        let side = [ahead[1], -ahead[0], 0.0];
        let position = [centre[0] + away * in_plane * side[0], centre[1] + away * in_plane * side[1], away * across];

        // Tangents along the outline and round the path. Where the path turns towards `side`, that side is shorter.
        let turn = (along[1] * bend[0] - along[0] * bend[1]) / (speed * speed);
        let forth = place_slope * (speed - turn * away * in_plane);
        let outwards = [away_slope * in_plane, away_slope * across];
        let up = [forth * ahead[0] + outwards[0] * side[0], forth * ahead[1] + outwards[0] * side[1], outwards[1]];
        let on = [-section[0] * sin * side[0], -section[0] * sin * side[1], section[1] * cos];
        let smooth = unit(cross(up, on));

        let (depth, slope) = self.skin.depth(position);
        let out = dot(slope, smooth);
        let normal = std::array::from_fn(|k| smooth[k] + (slope[k] - out * smooth[k]));
        (std::array::from_fn(|k| position[k] - depth * smooth[k]), normal_or(normal, smooth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_base_triangles_as_said() {
        for n in 1..20 {
            assert_eq!(generate(n, 0, 0, 1.0).expect("a pot").triangles.len() as u64, trees(n));
        }
    }
}
