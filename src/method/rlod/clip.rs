//! Triangles cut to cells.
//!
//! Corners are whole numbers; where an edge meets a side of a cell is worked out in double precision, and boxes of what is left are rounded outwards, so that no point of a triangle within
//! a cell lies outside of its part's box.

use crate::bvh::Box32;

/// Units by which a cell is wider where it is asked whether a triangle reaches into it: far above what double precision loses, far below a unit.
const MARGIN: f64 = 1.0 / 256.0;
/// Units by which a coordinate that was worked out may be off, and more: 2^31 at 52 bits, after six cuts.
const LOST: f64 = 1.0 / 1024.0;

/// A corner of what is left of a triangle.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    at: [f64; 3],
    /// Which coordinates were worked out, and may be off.
    rough: [bool; 3],
}

/// What is left of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    /// Nine at most: each side of a cell adds one. Rounding may cut a sliver more often.
    corners: [Corner; 12],
    count: usize,
}

impl Polygon {
    /// A triangle cut to a cell that is wider by so many units.
    fn cut(triangle: &[[i32; 3]; 3], cell: &Box32, wider: f64) -> Self {
        let mut own = Self { corners: Default::default(), count: 3 };
        for (corner, p) in own.corners.iter_mut().zip(triangle) {
            corner.at = p.map(f64::from);
        }
        for axis in 0..3 {
            own.halve(axis, 1.0, f64::from(cell.lo[axis]) - wider);
            own.halve(axis, -1.0, -(f64::from(cell.hi[axis]) + wider));
        }
        own
    }

    /// A triangle cut to a cell.
    pub fn within(triangle: &[[i32; 3]; 3], cell: &Box32) -> Self {
        Self::cut(triangle, cell, 0.0)
    }

    /// Keeps where `sign` times the coordinate is at least `side` (Sutherland and Hodgman 1974).
    fn halve(&mut self, axis: usize, sign: f64, side: f64) {
        let beyond = |corner: &Corner| sign * corner.at[axis] - side;
        let before = *self;
        let all = &before.corners[..before.count];
        if all.iter().all(|corner| beyond(corner) >= 0.0) {
            return;
        }
        self.count = 0;
        for (k, to) in all.iter().enumerate() {
            let from = &all[(k + all.len() - 1) % all.len()];
            let (a, b) = (beyond(from), beyond(to));
            if (a >= 0.0) != (b >= 0.0) {
                let share = a / (a - b);
                let mut met = Corner::default();
                for c in 0..3 {
                    let way = to.at[c] - from.at[c];
                    met.at[c] = from.at[c] + share * way;
                    met.rough[c] = from.rough[c] || to.rough[c] || way != 0.0;
                }
                (met.at[axis], met.rough[axis]) = (sign * side, false);
                self.put(met);
            }
            if b >= 0.0 {
                self.put(*to);
            }
        }
    }

    fn put(&mut self, corner: Corner) {
        // There is room for all that rounding adds.
        if self.count < self.corners.len() {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }

    /// Its corners, in order; none if nothing is left.
    pub fn corners(&self) -> impl Iterator<Item = [f64; 3]> {
        self.corners.iter().take(self.count).map(|corner| corner.at)
    }

    /// Its area times its normal.
    pub fn area(&self) -> [f64; 3] {
        let all = &self.corners[..self.count];
        let mut sum = [0.0; 3];
        let from = |corner: &Corner| -> [f64; 3] { std::array::from_fn(|k| corner.at[k] - all[0].at[k]) };
        for two in all.windows(2).skip(1) {
            let (a, b) = (from(&two[0]), from(&two[1]));
            for (k, sum) in sum.iter_mut().enumerate() {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                *sum += 0.5 * (a[i] * b[j] - a[j] * b[i]);
            }
        }
        sum
    }
}

/// The box of a triangle within a cell, in whole units, rounded outwards; none if it does not reach into the cell.
pub fn part(triangle: &[[i32; 3]; 3], cell: &Box32) -> Option<Box32> {
    let polygon = Polygon::cut(triangle, cell, MARGIN);
    let mut bounds: Option<Box32> = None;
    for corner in &polygon.corners[..polygon.count] {
        let lost = corner.rough.map(|rough| if rough { LOST } else { 0.0 });
        // Within the cell: 32 bits.
        let lo = std::array::from_fn(|k| ((corner.at[k] - lost[k]).floor() as i32).clamp(cell.lo[k], cell.hi[k]));
        let hi = std::array::from_fn(|k| ((corner.at[k] + lost[k]).ceil() as i32).clamp(cell.lo[k], cell.hi[k]));
        let own = Box32 { lo, hi };
        bounds = Some(bounds.map_or(own, |bounds| bounds.union(&own)));
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    #[test]
    fn parts_hold_every_point_of_a_triangle_in_a_cell_and_little_more() {
        let mut random = Random::new(11);
        let mut within = 0;
        for round in 0..4000 {
            // From cells of a few units to almost all that coordinates reach.
            let side = 8i64 << (round % 28);
            let mut place = || -> [i32; 3] { std::array::from_fn(|_| (random.next() % (2 * side as u64)) as i32 - side as i32) };
            let triangle = [place(), place(), place()];
            let (a, b) = (place(), place());
            let cell = Box32 { lo: std::array::from_fn(|k| a[k].min(b[k])), hi: std::array::from_fn(|k| a[k].max(b[k]) + 1) };
            let bounds = part(&triangle, &cell);
            for _ in 0..40 {
                let mut weights = [0; 3].map(|_| (random.next() % 1024) as f64 + 1e-3);
                let sum: f64 = weights.iter().sum();
                weights = weights.map(|w| w / sum);
                let p: [f64; 3] = std::array::from_fn(|k| (0..3).map(|c| weights[c] * f64::from(triangle[c][k])).sum());
                if (0..3).any(|k| p[k] < f64::from(cell.lo[k]) || p[k] > f64::from(cell.hi[k])) {
                    continue;
                }
                within += 1;
                let bounds = bounds.expect("the triangle reaches into the cell");
                assert!((0..3).all(|k| p[k] >= f64::from(bounds.lo[k]) - 1e-6 && p[k] <= f64::from(bounds.hi[k]) + 1e-6));
            }
            if let Some(bounds) = bounds {
                assert!((0..3).all(|k| cell.lo[k] <= bounds.lo[k] && bounds.lo[k] <= bounds.hi[k] && bounds.hi[k] <= cell.hi[k]));
                // No more than two units beyond what is there, along any axis.
                let polygon = Polygon::cut(&triangle, &cell, MARGIN);
                for k in 0..3 {
                    let least = polygon.corners().map(|p| p[k]).fold(f64::INFINITY, f64::min);
                    assert!(f64::from(bounds.lo[k]) > least - 2.0);
                }
            }
        }
        assert!(within > 4000, "{within}");
    }

    #[test]
    fn nothing_is_rounded_where_edges_run_along_axes() {
        let cell = Box32 { lo: [0; 3], hi: [64; 3] };
        let triangle = [[-64, 16, 32], [128, 16, 32], [-64, 48, 32]];
        let bounds = part(&triangle, &cell).unwrap();
        assert_eq!((bounds.lo, bounds.hi[2]), ([0, 16, 32], 32));
        assert!(part(&[[65, 0, 0], [90, 0, 0], [65, 9, 9]], &cell).is_none());
        // It touches the cell in an edge.
        assert_eq!(part(&[[64, 8, 8], [64, 24, 8], [90, 8, 8]], &cell), Some(Box32 { lo: [64, 8, 8], hi: [64, 24, 8] }));
        let whole = Polygon::within(&[[0, 0, 0], [64, 0, 0], [0, 64, 0]], &cell);
        assert_eq!((whole.corners().count(), whole.area()), (3, [0.0, 0.0, 2048.0]));
        let half = Polygon::within(&[[0, 0, 0], [128, 0, 0], [0, 64, 0]], &cell);
        assert_eq!((half.corners().count(), half.area()), (4, [0.0, 0.0, 3072.0]));
    }
}
