//! `drape`: a cloth over the upper part of the [`super::pot`], in the pot's coordinates; open border.
//!
//! A long sheet with round corners lies on knob, lid and shoulder, ends above spout and handle, and hangs down in folds on the two
//! sides between them. The sheet is laid onto an outline turned round the pot's axis, all of it outside of the pot; folds lead only
//! further out. They stand for the cloth that a sheet has too much of where the outline is narrower than the sheet is far.

use super::base::{Base, NoMemory, Parameter, Shape, cross, normal_or};
use super::cloth::thread;
use super::noise;
use super::spline::spline;
use crate::mesh::Surface;

/// Control points of the outline, distance from the axis and height, [`STEP`] along the sheet from one to the next.
const OUTLINE: [[f64; 2]; 20] = [
    [0.0, 0.586],
    [0.0348, 0.586],
    [0.0631, 0.5645],
    [0.0824, 0.5348],
    [0.1036, 0.507],
    [0.1281, 0.482],
    [0.1541, 0.4585],
    [0.1808, 0.4359],
    [0.2081, 0.414],
    [0.2358, 0.393],
    [0.2624, 0.3699],
    [0.2873, 0.3454],
    [0.3088, 0.3178],
    [0.3255, 0.287],
    [0.3352, 0.2535],
    [0.3388, 0.2187],
    [0.34, 0.1837],
    [0.34, 0.1487],
    [0.34, 0.1137],
    [0.34, 0.0787],
];
const STEP: f64 = 0.035;
/// Half sizes of the sheet, and how much of them its corners lack.
const HALF: ([f64; 2], f64) = ([0.31, 0.55], 0.1);
/// How the sheet lies: cosine and sine of the angle that it is turned by (their squares sum to 1), and its middle.
const LIES: ([f64; 2], [f64; 2]) = ([0.992, 0.126_238], [0.008, 0.015]);
/// Where folds begin along the sheet, and how far they reach out at most for each unit of cloth below.
const FOLDS: (f64, f64) = (0.1, 0.3);
/// Width of a thread and height of the weave at `detail` = 1.
const WEAVE: (f64, f64) = (0.006, 1.6e-4);

/// A sheet of `steps` finest steps across; `detail` scales the weave.
struct Drape {
    steps: i32,
    seed: u32,
    detail: f64,
}

/// A drape of `g` by `g` quads.
pub(super) fn generate(g: u32, levels: u32, seed: u64, detail: f64) -> Result<Surface, NoMemory> {
    Base::grid(g)?.tessellate(levels, &Drape { steps: (g << levels) as i32, seed: noise::stream(seed, 5), detail })
}

impl Drape {
    /// Position at sheet coordinates, -1..=1 each.
    fn at(&self, u: [f64; 2]) -> [f64; 3] {
        let corner = (u[0] * u[1]) * (u[0] * u[1]);
        let sheet: [f64; 2] = std::array::from_fn(|k| HALF.0[k] * u[k] * (1.0 - HALF.1 * corner * corner));
        let ([cos, sin], middle) = LIES;
        let place = [middle[0] + cos * sheet[0] + sin * sheet[1], middle[1] + cos * sheet[1] - sin * sheet[0]];
        let far = (place[0] * place[0] + place[1] * place[1]).sqrt();
        let way = if far > 0.0 { place.map(|c| c / far) } else { [1.0, 0.0] };
        let [[away, height], [out, up], _] = spline(&OUTLINE, far / (STEP * (OUTLINE.len() - 1) as f64));
        let along = (out * out + up * up).sqrt();

        // Folds run down from the lid and wander a little on their way.
        let wave = |cells: f64, wander: f64| noise::noise3(self.seed, [way[0] * cells + 31.4, way[1] * cells + 27.2, far * wander + 0.5]).0;
        let wave = 0.05 + 1.7 * wave(3.9, 2.0) + 0.5 * wave(7.7, 3.0);
        // Outwards, with round valleys where the cloth lies on the pot.
        let wave = 0.5 * (wave + (wave * wave + 0.02).sqrt());
        let below = (far - FOLDS.0).max(0.0);
        let fold = FOLDS.1 * below * below / (below + 0.15) * wave;
        let [s, t] = sheet.map(|c| thread(c / WEAVE.0));
        let stands = (fold + WEAVE.1 * self.detail * s * t) / along;
        let reach = away - up * stands;
        [way[0] * reach, height + out * stands, way[1] * reach]
    }
}

impl Shape for Drape {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let steps = f64::from(self.steps);
        let u = [p[0], p[1]].map(|c| f64::from(2 * c - self.steps) / steps);
        // A slope over the width of a finest triangle, never over more than a fold.
        let e = (1.0 / steps).min(1e-2);
        let [x0, x1] = [-e, e].map(|d| self.at([u[0] + d, u[1]]));
        let [z0, z1] = [-e, e].map(|d| self.at([u[0], u[1] + d]));
        let along = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| b[k] - a[k]);
        (self.at(u), normal_or(cross(along(z0, z1), along(x0, x1)), [0.0, 1.0, 0.0]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::base::dot;
    use super::super::pot;
    use super::*;

    /// Least gap that is asked for: two threads.
    const GAP: f64 = 2.0 * WEAVE.0;

    fn drape(levels: u32, seed: u64) -> Surface {
        generate(32, levels, seed, 2.0).expect("a drape")
    }

    fn distance(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    /// Signed distance of a point (distance from the axis, height) from the outline of a body about the axis, positive outside.
    fn outside(outline: &[[f64; 2]], p: [f64; 2]) -> f64 {
        let (mut inside, mut near) = (false, f64::MAX);
        for (a, b) in outline.iter().zip(&outline[1..]) {
            let way = [b[0] - a[0], b[1] - a[1]];
            let along = (((p[0] - a[0]) * way[0] + (p[1] - a[1]) * way[1]) / (way[0] * way[0] + way[1] * way[1])).clamp(0.0, 1.0);
            near = near.min(distance(&p, &[a[0] + along * way[0], a[1] + along * way[1]]));
            // A line outwards from the point crosses the outline an odd number of times if the point is within.
            if (a[1] > p[1]) != (b[1] > p[1]) {
                inside ^= a[0] + (p[1] - a[1]) / way[1] * way[0] > p[0];
            }
        }
        if inside { -near } else { near }
    }

    #[test]
    fn it_stays_off_belly_lid_and_knob() {
        // Dimples go inwards, so the outlines are the most that the pot reaches.
        let outlines =
            [pot::BELLY, pot::LID].map(|part| (0..=600).map(|i| spline(part.outline, f64::from(i) / 600.0)[0]).collect::<Vec<_>>());
        let mut least = f64::MAX;
        for seed in 0..10 {
            for p in drape(if seed == 0 { 4 } else { 1 }, seed).positions {
                let place = [(p[0] * p[0] + p[2] * p[2]).sqrt(), p[1]];
                least = outlines.iter().map(|outline| outside(outline, place)).fold(least, f64::min);
            }
        }
        assert!((0.75 * GAP..2.0 * GAP).contains(&least), "{least}");
        // The measure itself knows in from out.
        assert!(outside(&outlines[0], [0.2, 0.2]) < -0.05 && outside(&outlines[0], [0.4, 0.2]) > 0.05);
    }

    #[test]
    fn it_stays_off_spout_and_handle() {
        let whole = pot::generate(8, 2, 0, 1.0).expect("a pot");
        // Belly and lid come first; the rest of the points are spout and handle.
        let first = (8 * 8 * 8 + 8 * 4 * 4) * 15;
        for seed in 0..10 {
            for p in drape(1, seed).positions {
                let (mut near, mut nearest) = (f64::MAX, first);
                for (i, q) in whole.positions.iter().enumerate().skip(first) {
                    let far = distance(&p, q);
                    if far < near {
                        (near, nearest) = (far, i);
                    }
                }
                let way = std::array::from_fn(|k| p[k] - whole.positions[nearest][k]);
                assert!(near > 0.5 * GAP && dot(way, whole.normals[nearest].map(f64::from)) > 0.0, "{seed}: {near} at {p:?}");
            }
        }
    }

    #[test]
    fn folds_grow_towards_the_hem() {
        let drape = Drape { steps: 1, seed: noise::stream(0, 5), detail: 1.0 };
        let outline: Vec<_> = (0..=600).map(|i| spline(&OUTLINE, f64::from(i) / 600.0)[0]).collect();
        // How far the cloth is from the outline along a line across the sheet: least and most.
        let range = |across: f64| {
            (0..=200).fold((f64::MAX, f64::MIN), |(least, most), i| {
                let p = drape.at([f64::from(i) / 100.0 - 1.0, across]);
                let out = outside(&outline, [(p[0] * p[0] + p[2] * p[2]).sqrt(), p[1]]);
                (least.min(out), most.max(out))
            })
        };
        let [middle, hem] = [0.4, 1.0].map(range);
        assert!(hem.0 < 0.02 && hem.1 > 0.04 && hem.1 > 1.5 * middle.1, "{middle:?} {hem:?}");
    }
}
