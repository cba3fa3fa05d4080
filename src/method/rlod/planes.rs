//! R-LODs: a plane for all that is below a node, on every so many inner nodes of a path, bottom-up in one pass (paper section 4.4).

use super::build::{Raw, RawTree, halves};
use super::clip::Polygon;
use super::moments::{Moments, Plane};
use crate::bvh::Box32;
use glam::DVec3;

/// What stands for a node: 32 bytes in memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rlod {
    /// Normal of the plane, and its distance from the origin along that.
    pub plane: [f32; 4],
    /// The point of the plane that is nearest to the triangles' mean; in memory for no ray, but for who draws it.
    pub mean: [f32; 3],
    /// How far triangles lie from the plane: root of the mean of squares, in units.
    pub deviation: f32,
    /// Radius of the sphere that it is measured by, in units.
    pub radius: f32,
    /// Mean colour, linear.
    pub colour: [f32; 3],
}

/// How R-LODs are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// Every so many inner nodes of a path have one, the root first; none at 0.
    pub every: u32,
    /// Weight of the deviation in the measure.
    pub weight: f64,
}

impl Planes {
    /// The radius that an R-LOD is measured by: of a sphere of the volume of the sphere around its extent, of this radius, and so many times the slab through that along the plane, as
    /// thick as the deviation on both sides: 4/3 pi R^3 = 4/3 pi r^3 + weight pi r^2 2 deviation.
    pub fn radius(&self, extent: f64, deviation: f64) -> f64 {
        (extent.powi(3) + self.weight * 1.5 * extent * extent * deviation).cbrt()
    }
}

/// Bits of an error in a node.
const ERROR_BITS: u32 = 5;
/// Bits of the number of an R-LOD in a node.
pub const NUMBER_BITS: u32 = 32 - ERROR_BITS;
/// Steps of errors.
const ERRORS: usize = 1 << ERROR_BITS;

/// The errors that nodes can name: a geometric series to the largest, from one that all but a hundredth of them have. The smallest are rounded up to that: they lie in few corners, and would
/// make each step coarser.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors([f32; ERRORS]);

impl Errors {
    /// The series for these radii.
    pub fn of(mut radii: Vec<f32>) -> Self {
        radii.sort_unstable_by(f32::total_cmp);
        let [least, most] = [radii.get(radii.len() / 100), radii.last()].map(|of| of.copied().unwrap_or(1.0).max(f32::MIN_POSITIVE));
        let ratio = (f64::from(most) / f64::from(least)).powf(1.0 / (ERRORS - 1) as f64);
        let step = |k: usize| (f64::from(least) * ratio.powi(k as i32)) as f32;
        Self(std::array::from_fn(|k| if k == ERRORS - 1 { most } else { step(k) }))
    }

    /// The first that is no less than a radius of theirs.
    pub fn code(&self, radius: f32) -> u32 {
        // The last is the largest of all.
        self.0.iter().position(|&error| error >= radius).unwrap_or(ERRORS - 1) as u32
    }

    /// The error of a code.
    #[inline(always)]
    pub fn error(&self, code: u32) -> f32 {
        self.0[code as usize % ERRORS]
    }

    /// From one to the next.
    pub fn ratio(&self) -> f64 {
        (f64::from(self.0[ERRORS - 1]) / f64::from(self.0[0])).powf(1.0 / (ERRORS - 1) as f64)
    }
}

/// Nodes from which on both sides are worked out side by side.
const ALONE: usize = 1 << 14;

/// What R-LODs are made of.
struct Maker<'a> {
    tree: &'a RawTree,
    /// Of each node the first reference at or below it.
    firsts: Vec<u32>,
    triangles: &'a [[[i32; 3]; 3]],
    colours: &'a (dyn Fn(u32) -> DVec3 + Sync),
    planes: Planes,
}

/// The R-LODs of a tree over `triangles` of these linear colours in `cell`, by their nodes, in the order of nodes.
pub fn rlods(
    tree: &RawTree,
    triangles: &[[[i32; 3]; 3]],
    cell: &Box32,
    colours: &(dyn Fn(u32) -> DVec3 + Sync),
    planes: Planes,
) -> Vec<(u32, Rlod)> {
    if planes.every == 0 {
        return Vec::new();
    }
    let count = |node: &Raw| if let Raw::Leaf(count) = node { *count } else { 0 };
    let mut sum = 0;
    let before = |node: &Raw| {
        sum += count(node);
        sum - count(node)
    };
    let firsts = tree.nodes.iter().map(before).collect();
    let mut all = Vec::new();
    Maker { tree, firsts, triangles, colours, planes }.below(0, tree.nodes.len(), cell, 0, &mut all);
    all.sort_unstable_by_key(|(node, _)| *node);
    all
}

impl Maker<'_> {
    /// Sums over what is below the node `at`, whose subtree ends before `end`.
    fn below(&self, at: usize, end: usize, cell: &Box32, depth: u32, all: &mut Vec<(u32, Rlod)>) -> Moments {
        let Raw::Inner { axis, at: split, skip } = self.tree.nodes[at] else {
            return self.leaf(at, cell);
        };
        let cells = halves(cell, axis.into(), split);
        let right = at + skip as usize;
        let both = if end - at > ALONE {
            let mut others = Vec::new();
            let both = rayon::join(
                || self.below(at + 1, right, &cells[0], depth + 1, all),
                || self.below(right, end, &cells[1], depth + 1, &mut others),
            );
            all.append(&mut others);
            both
        } else {
            (self.below(at + 1, right, &cells[0], depth + 1, all), self.below(right, end, &cells[1], depth + 1, all))
        };
        let own = both.0.with(&both.1);
        if depth.is_multiple_of(self.planes.every)
            && let Some(plane) = own.plane()
        {
            all.push((at as u32, self.rlod(&own, plane, cell))); // at most 2^30 nodes
        }
        own
    }

    fn leaf(&self, at: usize, cell: &Box32) -> Moments {
        let Raw::Leaf(count) = self.tree.nodes[at] else { return Moments::default() };
        let first = self.firsts[at] as usize;
        let each = self.tree.references[first..first + count as usize].iter().map(|&id| {
            let polygon = Polygon::within(&self.triangles[id as usize], cell);
            Moments::of(&polygon, (self.colours)(id))
        });
        each.fold(Moments::default(), |sum, own| sum.with(&own))
    }

    fn rlod(&self, of: &Moments, plane: Plane, cell: &Box32) -> Rlod {
        let side: [f64; 3] = std::array::from_fn(|k| f64::from(cell.hi[k]) - f64::from(cell.lo[k]));
        let extent = DVec3::from_array(side).length() / 2.0;
        let [x, y, z] = plane.normal.as_vec3().to_array();
        // As rays have the normal, so that the mean lies in the plane.
        let distance = DVec3::new(x.into(), y.into(), z.into()).dot(of.mean);
        Rlod {
            plane: [x, y, z, distance as f32],
            mean: of.mean.as_vec3().to_array(),
            deviation: plane.deviation as f32,
            radius: up(self.planes.radius(extent, plane.deviation)),
            colour: (of.colour / of.weight).as_vec3().to_array(),
        }
    }
}

/// The first number of single precision that is no less.
fn up(v: f64) -> f32 {
    let near = v as f32;
    if f64::from(near) < v { near.next_up() } else { near }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_rounded_up_in_a_geometric_series() {
        let radii = [3.0f32, 40.0, 41.0, 1e6, 7e8];
        let errors = Errors::of(radii.to_vec());
        let ratio = errors.ratio();
        for radius in (0..600).map(|k| 3.0f32 * 1.03f32.powi(k)).filter(|&radius| radius <= 7e8).chain(radii) {
            let error = errors.error(errors.code(radius));
            assert!(error >= radius && f64::from(error) <= f64::from(radius) * ratio * 1.0001, "{radius} {error}");
        }
        assert!((f64::from(errors.error(8)) / f64::from(errors.error(7)) - ratio).abs() < 1e-5);
        assert_eq!(Errors::of(vec![5.0]).error(0), 5.0);
        assert_eq!((up(1.0), up(16_777_217.0)), (1.0, 16_777_218.0));
    }

    #[test]
    fn deviation_adds_the_volume_of_a_slab() {
        let planes = Planes { every: 3, weight: 2.0 };
        let (r, deviation) = (10.0f64, 0.5f64);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * r.powi(3) + 2.0 * std::f64::consts::PI * r * r * 2.0 * deviation;
        let own = planes.radius(r, deviation);
        assert!((4.0 / 3.0 * std::f64::consts::PI * own.powi(3) - volume).abs() < 1e-9 * volume);
        assert_eq!(planes.radius(8.0, 0.0), 8.0);
    }
}
