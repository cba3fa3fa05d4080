//! Rays for the blocks that take one: directions of every kind, and origins from which they pass exactly through a point.

use crate::draw::{DIRECTION_MAX, Draw, POINT_MAX};
use lodray::num::{Direction, Point};
use lodray_test_support::models;

/// The most that each component of a longest diagonal can have: 2^30 / sqrt 3.
pub const DIAGONAL: i64 = 619_925_131;

/// |v| < 2^31 in each coordinate.
pub fn is_point(p: Point) -> bool {
    p.get().iter().all(|v| v.abs() <= POINT_MAX)
}

/// Each |d_i| < 2^30.
pub fn has_components(d: Direction) -> bool {
    d.get().iter().all(|v| v.abs() <= DIRECTION_MAX)
}

/// Each |d_i| < 2^30, and |d| <= 2^30.
pub fn is_direction(d: Direction) -> bool {
    has_components(d) && d.get().iter().map(|&v| v * v).sum::<i64>() <= 1 << 60
}

/// Components as a direction or a point.
pub fn direction([x, y, z]: [i64; 3]) -> Direction {
    Direction::new(x, y, z)
}

/// Components as a point.
pub fn point([x, y, z]: [i64; 3]) -> Point {
    Point::new(x, y, z)
}

impl Draw {
    /// Three components of every magnitude; the length may exceed 2^30.
    pub fn components(&mut self) -> Direction {
        direction([0; 3].map(|_| self.signed(DIRECTION_MAX)))
    }

    /// A direction of every length up to 2^30 and every kind; not zero.
    pub fn direction(&mut self) -> Direction {
        let d = match self.below(16) {
            0 => self.axis_parallel(),
            1 => self.plane_parallel(),
            2 => self.leaning(),
            3 => direction([0; 3].map(|_| self.between(-3, 3))),
            4 => direction([DIAGONAL; 3].map(|v| self.sign(v))),
            5..8 => self.components(),
            _ => self.full_direction(),
        };
        let d = if is_direction(d) { d } else { direction(d.get().map(|v| v / 2)) };
        // Half of them shorter, so that a ray can take many steps within the range.
        let shorter = if self.once_in(2) { self.below(24) } else { 0 };
        let d = direction(d.get().map(|v| v >> shorter));
        if d == Direction::default() { Direction::new(0, 0, 1) } else { d }
    }

    /// A direction of the length that a frame's rays have.
    pub fn full_direction(&mut self) -> Direction {
        direction(models::direction(&mut self.rng))
    }

    /// A direction along an axis, mostly of full length.
    pub fn axis_parallel(&mut self) -> Direction {
        let mut d = [0; 3];
        let length = if self.once_in(4) { 1 + self.bits::<20>().get().cast_signed() } else { DIRECTION_MAX };
        d[self.below(3) as usize] = self.sign(length);
        direction(d)
    }

    /// A direction within a coordinate plane; not zero.
    pub fn plane_parallel(&mut self) -> Direction {
        let mut d = self.full_direction().get();
        d[self.below(3) as usize] = 0;
        if d == [0; 3] { Direction::new(0, 0, 1) } else { direction(d) }
    }

    /// A direction almost along an axis: the others grow by a few units.
    pub fn leaning(&mut self) -> Direction {
        let mut d = [0; 3].map(|_| self.between(-3, 3));
        d[self.below(3) as usize] = self.sign(DIRECTION_MAX);
        direction(d)
    }

    /// The origin of a ray that passes exactly through `target` after as many whole steps of `d` as fit, or fewer; `d` is not zero.
    pub fn before(&mut self, target: [i64; 3], d: Direction) -> Point {
        let mut most = i64::MAX;
        for (t, c) in target.into_iter().zip(d.get()) {
            if c != 0 {
                most = most.min((if c > 0 { t + POINT_MAX } else { POINT_MAX - t }) / c.abs());
            }
        }
        let steps = match self.below(16) {
            0 => 0,
            1 => most,
            2..6 => self.between(0, most) >> self.below(32),
            _ => self.between(most.min(1), most),
        };
        point([0, 1, 2].map(|k| target[k] - steps * d.get()[k]))
    }

    /// The origin of a ray that comes close to `target` from any distance; |target| < 2^31 - 2^30 in each coordinate.
    pub fn afar(&mut self, target: [i64; 3], d: Direction) -> Point {
        let steps = self.between(0, 1 << 16);
        point([0, 1, 2].map(|k| target[k] - ((d.get()[k] * steps) >> 16)))
    }

    /// The origin of a ray that leaves `target` behind it, by one step of `d` at least; |target| < 2^30 in each coordinate.
    pub fn beyond(&mut self, target: [i64; 3], d: Direction) -> Point {
        let origin = self.before(target, direction(d.get().map(|v| -v)));
        if origin.get() == target { point([0, 1, 2].map(|k| target[k] + d.get()[k])) } else { origin }
    }
}
