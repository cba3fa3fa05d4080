//! Random integers as blocks like them least: all magnitudes, zeros, extremes.

use lodray::block::Block;
use lodray::block::ray_setup::{self, RaySetup};
use lodray::num::{Box16, COORD_LIMIT, Cone, Direction, Point, Ray, RayT, U};
use lodray_test_support::models::Rng;

/// Largest magnitude of a point's coordinate.
pub const POINT_MAX: i64 = (1 << 31) - 1;
/// Largest magnitude of a direction's component.
pub const DIRECTION_MAX: i64 = (1 << 30) - 1;

/// The source of a test's inputs.
pub struct Draw(Rng);

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self(Rng(seed))
    }

    /// 0 to `n` - 1.
    pub fn below(&mut self, n: u64) -> u64 {
        self.0.below(n)
    }

    /// True once in `n`.
    pub fn once_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// `W` random bits, often of a smaller magnitude, sometimes all zero or all one.
    pub fn bits<const W: u32>(&mut self) -> U<W> {
        let v = self.0.draw() >> (64 - W);
        U::new(match self.below(8) {
            0 => 0,
            1 => U::<W>::MAX.get(),
            2..5 => v >> self.below(u64::from(W)),
            _ => v,
        })
    }

    /// The same for 128 bits.
    pub fn wide(&mut self, width: u32) -> u128 {
        let v = (u128::from(self.0.draw()) << 64 | u128::from(self.0.draw())) >> (128 - width);
        match self.below(8) {
            0 => 0,
            1 => u128::MAX >> (128 - width),
            2..5 => v >> self.below(u64::from(width)),
            _ => v,
        }
    }

    /// -`max` to `max`, of all magnitudes, with zeros and extremes.
    pub fn signed(&mut self, max: i64) -> i64 {
        let v = self.below(2 * max.unsigned_abs() + 1).cast_signed() - max;
        match self.below(8) {
            0 => 0,
            1 => max,
            2 => -max,
            3..6 => v >> self.below(32),
            _ => v,
        }
    }

    /// A point with |v| <= `max`.
    pub fn point(&mut self, max: i64) -> Point {
        Point::new(self.signed(max), self.signed(max), self.signed(max))
    }

    /// A point of a model.
    pub fn model_point(&mut self) -> Point {
        self.point(i64::from(COORD_LIMIT))
    }

    /// A direction of any length up to 2^30.
    pub fn direction(&mut self) -> Direction {
        let d = [0; 3].map(|_| self.signed(DIRECTION_MAX));
        // 2^60 is the square of the largest length.
        let long = d.iter().map(|&c| i128::from(c) * i128::from(c)).sum::<i128>() > 1 << 60;
        let [x, y, z] = if long { d.map(|c| c / 2) } else { d };
        Direction::new(x, y, z)
    }

    /// A direction along an axis.
    pub fn axis_parallel(&mut self) -> Direction {
        let mut d = [0; 3];
        d[self.below(3) as usize] = if self.once_in(2) { DIRECTION_MAX } else { -DIRECTION_MAX };
        Direction::new(d[0], d[1], d[2])
    }

    /// A direction within a coordinate plane.
    pub fn plane_parallel(&mut self) -> Direction {
        let mut d = self.direction().get();
        d[self.below(3) as usize] = 0;
        Direction::new(d[0], d[1], d[2])
    }

    /// A direction for which a step or a few from any middling point stay within range.
    pub fn short_direction(&mut self) -> Direction {
        let [x, y, z] = [0; 3].map(|_| self.signed(1 << 28));
        Direction::new(x, y, z)
    }

    /// The origin of a ray that passes exactly through `target` (|v| <= 2^29) after one to four steps of `d`, or starts there.
    pub fn origin_towards(&mut self, target: [i64; 3], d: Direction) -> Point {
        let steps = self.below(5).cast_signed();
        let [x, y, z] = [0, 1, 2].map(|k| target[k] - steps * d.get()[k]);
        Point::new(x, y, z)
    }

    /// Constants of a ray from `origin` in `direction`.
    pub fn setup_of(&mut self, origin: Point, direction: Direction) -> ray_setup::Out {
        RaySetup::eval(&ray_setup::In { origin, direction })
    }

    /// Constants of any ray.
    pub fn setup(&mut self) -> ray_setup::Out {
        let (origin, direction) = (self.point(POINT_MAX), self.direction());
        self.setup_of(origin, direction)
    }

    /// A cone of all kinds: none, parallel, wide, saturated.
    pub fn cone(&mut self) -> Cone {
        Cone { offset: self.bits(), slope: self.bits(), shift: self.bits() }
    }

    /// Any ray with any cone.
    pub fn ray(&mut self) -> Ray {
        Ray { origin: self.point(POINT_MAX), direction: self.direction(), cone: self.cone() }
    }

    /// The end of the ray so far: mostly open.
    pub fn t_max(&mut self) -> RayT {
        if self.once_in(2) { RayT::MAX } else { self.bits() }
    }

    /// A box of codes, often flat, sometimes the largest.
    pub fn box16(&mut self) -> Box16 {
        let mut corner = || [0; 3].map(|_| self.signed(32766) as i16);
        let (a, b) = (corner(), corner());
        let flat = self.below(6) as usize;
        let lo = [0, 1, 2].map(|k: usize| a[k].min(b[k]));
        let hi = [0, 1, 2].map(|k: usize| if k == flat { lo[k] } else { a[k].max(b[k]) });
        Box16::from_codes(lo, hi)
    }

    /// One of the points of a box of codes, in units: a corner, or on an edge or a face.
    pub fn on_box(&mut self, lo: [i64; 3], hi: [i64; 3]) -> [i64; 3] {
        [0, 1, 2].map(|k| match self.below(4) {
            0 => lo[k],
            1 | 2 => hi[k],
            _ => (lo[k] + hi[k]) / 2,
        })
    }
}
