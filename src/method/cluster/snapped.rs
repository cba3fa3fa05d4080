//! The mesh that clusters are made of: vertices on one grid of 16 bits a coordinate in the model's box, so that clusters of any level that share one agree about it.

use crate::bvh::{Box32, BvhError};
use crate::format::Scene;
use crate::mesh::{Hierarchy, lattice};
use crate::method::bvh::check_hierarchy;
use crate::num::{COORD_LIMIT, PADDING_BITS};
use crate::rays::ModelSpace;
use rayon::prelude::*;
use std::collections::HashMap;

/// A grid over the model's box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Where its first place lies, in units.
    pub lo: [i32; 3],
    /// Units from a place to the next, the same along all axes: a multiple of what coordinates are multiples of.
    pub step: i32,
}

/// A place of a [`Grid`], in steps.
pub type Place = [u16; 3];

impl Grid {
    /// The grid of a box of coordinates that end in so many zero bits: as fine as 16 bits allow.
    fn new(bounds: &Box32, zeros: u32) -> Self {
        let side = (0..3).map(|k| i64::from(bounds.hi[k]) - i64::from(bounds.lo[k])).max().unwrap_or(0);
        let unit = 1i64 << zeros;
        // At most 2^32 / 65535, rounded up.
        let step = side.div_euclid(i64::from(u16::MAX)) / unit * unit + unit;
        Self { lo: bounds.lo, step: step as i32 }
    }

    /// The nearest place, and no place beyond the coordinate limit.
    fn nearest(&self, point: [i32; 3]) -> Place {
        std::array::from_fn(|k| {
            let (from, step) = (i64::from(self.lo[k]), i64::from(self.step));
            let nearest = (i64::from(point[k]) - from + step / 2) / step;
            nearest.min((i64::from(COORD_LIMIT) - from) / step) as u16 // the box has at most 2^16 - 1 steps
        })
    }

    /// Where a place lies, in units.
    #[inline]
    pub fn point(&self, place: Place) -> [i32; 3] {
        // Within the coordinate limit, as is where it came from.
        std::array::from_fn(|k| (i64::from(self.lo[k]) + i64::from(place[k]) * i64::from(self.step)) as i32)
    }
}

/// A mesh on a grid.
pub struct Snapped {
    /// The grid.
    pub grid: Grid,
    /// Vertices; no two at one place.
    pub places: Vec<Place>,
    /// Triangles of three distinct vertices.
    pub triangles: Vec<[u32; 3]>,
    /// The finest triangle of the scene that each was.
    pub sources: Vec<u32>,
    /// Finest triangles that became none on the grid.
    pub collapsed: usize,
}

impl Snapped {
    /// The finest triangles of a scene.
    ///
    /// # Errors
    /// No or too many triangles.
    pub fn new(scene: &Scene) -> Result<Self, BvhError> {
        let hierarchy = scene.decode();
        check_hierarchy(&hierarchy)?;
        let space = ModelSpace::of(scene);
        let grid = Grid::new(&Box32 { lo: space.lo, hi: space.hi }, PADDING_BITS.max(hierarchy.zeros));
        let mut known = HashMap::new();
        let mut places = Vec::new();
        let mut number = |place: Place| {
            *known.entry(place).or_insert_with(|| {
                places.push(place);
                places.len() as u32 - 1 // below 2^30 points
            })
        };
        let snapped: Vec<Place> = hierarchy.points.par_iter().map(|&point| grid.nearest(point)).collect();
        let vertices: Vec<u32> = snapped.into_iter().map(&mut number).collect();
        let all = corners(&hierarchy, &vertices);
        let kept = |&(_, [a, b, c]): &(u32, [u32; 3])| a != b && b != c && c != a;
        let (sources, triangles): (Vec<_>, Vec<_>) = (0..).zip(all).filter(kept).unzip();
        let collapsed = scene.finest_triangles() as usize - triangles.len();
        if triangles.is_empty() {
            return Err(BvhError::Empty);
        }
        Ok(Self { grid, places, triangles, sources, collapsed })
    }

    /// A vertex, in units.
    pub fn point(&self, vertex: u32) -> [i32; 3] {
        self.grid.point(self.places[vertex as usize])
    }
}

/// The corners of all finest triangles, by number.
fn corners(hierarchy: &Hierarchy, vertices: &[u32]) -> Vec<[u32; 3]> {
    let (levels, len) = (hierarchy.levels, lattice::len(hierarchy.levels));
    let nodes: Vec<[usize; 3]> =
        (0..1u32 << (2 * levels)).map(|node| lattice::node(levels, levels, node).map(|place| lattice::index(levels, place))).collect();
    vertices.chunks_exact(len).flat_map(|tree| nodes.iter().map(|node| node.map(|at| tree[at]))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_the_nearest_and_stay_inside() {
        let limit = COORD_LIMIT;
        for (lo, hi) in [([-limit; 3], [limit; 3]), ([0, -160, 16], [1600, 160, 16]), ([limit - 32, 0, 0], [limit, 16, 32])] {
            let grid = Grid::new(&Box32 { lo, hi }, 4);
            assert!(grid.step % 16 == 0 && i64::from(grid.step) * 65_535 >= i64::from(hi[0]) - i64::from(lo[0]));
            for t in 0..=100i64 {
                let point: [i32; 3] =
                    std::array::from_fn(|k| (i64::from(lo[k]) + t * (i64::from(hi[k]) - i64::from(lo[k])) / 100) as i32 & !15);
                let back = grid.point(grid.nearest(point)).map(i64::from);
                for k in 0..3 {
                    let (own, step) = (i64::from(point[k]), i64::from(grid.step));
                    assert!((back[k] - own).abs() <= step / 2 || own > i64::from(limit) - step, "{point:?} {back:?}");
                    assert!(back[k].abs() <= i64::from(limit) && (back[k] - i64::from(lo[k])) % 16 == 0);
                }
            }
        }
    }
}
