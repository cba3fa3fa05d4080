//! `cloth`: a square sheet over a table with rounded corners (which is not there), y up, open border.
//!
//! The top is flat, the sides hang down almost flat, and the spare cloth at the corners flares out in folds. Everything carries a
//! plain weave far finer than the folds, so that flat parts need detail only from very near.

use super::base::{Base, NoMemory, Parameter, Shape, cross, normal_or};
use super::noise;
use crate::mesh::Surface;

/// Half width of the table's straight part and radius of its corners, in half widths of the sheet.
const TABLE: (f64, f64) = (0.38, 0.14);
/// Radius of the bend at the table's edge.
const BEND: f64 = 0.06;
/// Threads across the sheet and height of their weave at `detail` = 1.
const WEAVE: (f64, f64) = (180.0, 3e-4);
/// Height of the table, so that the sheet is centred about the origin.
const HEIGHT: f64 = 0.3;

/// A sheet of `steps` finest steps across; `detail` scales the weave.
pub(super) struct Cloth {
    steps: i32,
    seed: u32,
    detail: f64,
    centre: [f64; 3],
    scale: f64,
}

/// Cloth of `g` by `g` quads in its own place.
pub(super) fn generate(g: u32, levels: u32, seed: u64, detail: f64) -> Result<Surface, NoMemory> {
    placed(g, levels, seed, detail, [0.0; 3], 1.0)
}

/// Cloth of `g` by `g` quads scaled and then moved.
pub(super) fn placed(g: u32, levels: u32, seed: u64, detail: f64, centre: [f64; 3], scale: f64) -> Result<Surface, NoMemory> {
    let cloth = Cloth { steps: (g << levels) as i32, seed: noise::stream(seed, 1), detail, centre, scale };
    Base::grid(g)?.tessellate(levels, &cloth)
}

/// One thread seen from the side: a smooth wave of period 2 and height -1..=1.
pub(super) fn thread(t: f64) -> f64 {
    let (n, f) = noise::cell(t);
    let bump = 4.0 * f * (1.0 - f);
    if n & 1 == 0 { bump } else { -bump }
}

impl Cloth {
    /// Position at sheet coordinates, -1..=1 each.
    fn at(&self, u: [f64; 2]) -> [f64; 3] {
        let (straight, corner) = TABLE;
        // The nearest point of the table's straight part, and the way from there out.
        let core = u.map(|c| c.clamp(-straight, straight));
        let q = [u[0] - core[0], u[1] - core[1]];
        let r = (q[0] * q[0] + q[1] * q[1]).sqrt();
        let over = r - corner;
        let weave = WEAVE.1 * self.detail * thread(u[0] * (WEAVE.0 * 0.5)) * thread(u[1] * (WEAVE.0 * 0.5));
        if over <= 0.0 {
            return [u[0], HEIGHT + weave, u[1]];
        }
        let way = q.map(|c| c / r);
        // Along the sheet: first outwards, then down, at about unit speed.
        let bend = (1.0 + (over / BEND) * (over / BEND)).sqrt();
        let (out, down) = (over / bend, BEND * (bend - 1.0));
        // Spare cloth: 1 in the middle of a corner, 0 along the sides.
        let spare = 4.0 * way[0] * way[0] * way[1] * way[1];
        // Folds run down from the rim: the same along a line that hangs.
        let rim = [0, 1].map(|k| core[k] + (corner + 0.12) * way[k]);
        let wave =
            noise::noise2(self.seed, rim.map(|c| c * 9.3 + 37.4)) + 0.5 * noise::noise2(self.seed ^ 0x55, rim.map(|c| c * 21.7 + 11.3));
        let hang = over * over / (over + 0.2);
        let fold = hang * (0.5 * spare + wave * (0.16 + 0.7 * spare));
        // The weave stands on the sheet: up on top, outwards where it hangs.
        let turned = over / (over + BEND);
        let reach = corner + out + fold + weave * turned;
        // What goes sideways does not go down.
        let y = HEIGHT - down * (1.0 - 0.3 * spare * hang) + weave * (1.0 - turned);
        [core[0] + way[0] * reach, y, core[1] + way[1] * reach]
    }
}

impl Shape for Cloth {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let steps = f64::from(self.steps);
        let u = [p[0], p[1]].map(|c| f64::from(2 * c - self.steps) / steps);
        // A slope over the width of a finest triangle, never over more than a fold.
        let e = (1.0 / steps).min(1e-2);
        let [x0, x1] = [-e, e].map(|d| self.at([u[0] + d, u[1]]));
        let [z0, z1] = [-e, e].map(|d| self.at([u[0], u[1] + d]));
        let along = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| b[k] - a[k]);
        let normal = normal_or(cross(along(z0, z1), along(x0, x1)), [0.0, 1.0, 0.0]);
        let position = self.at(u);
        (std::array::from_fn(|k| self.centre[k] + self.scale * position[k]), normal)
    }
}
