//! Random integers as blocks like them least: all magnitudes, zeros, extremes.

use lodray::num::{BoundScale, COORD_LIMIT, Cone, MAX_BOUND_OFFSET, MAX_LEVELS, Point, Ray, RayT, U};
use lodray_test_support::models::Rng;

/// Largest magnitude of a point's coordinate.
pub const POINT_MAX: i64 = (1 << 31) - 1;
/// Largest magnitude of a direction's component.
pub const DIRECTION_MAX: i64 = (1 << 30) - 1;

/// The source of a test's inputs.
pub struct Draw {
    pub(crate) rng: Rng,
    /// The most levels that the hardware under test is for.
    pub levels: u64,
    /// The zero bits at the bottom of all coordinates that it leaves out.
    pub zeros: u64,
}

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self { rng: Rng(seed), levels: u64::from(MAX_LEVELS), zeros: 0 }
    }

    /// 0 to `n` - 1.
    pub fn below(&mut self, n: u64) -> u64 {
        self.rng.below(n)
    }

    /// `low` to `high`, both included.
    pub fn between(&mut self, low: i64, high: i64) -> i64 {
        low + self.below(high.abs_diff(low) + 1).cast_signed()
    }

    /// True once in `n`.
    pub fn once_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    /// One of these.
    pub fn one_of<T: Copy>(&mut self, these: &[T]) -> T {
        these[self.below(these.len() as u64) as usize]
    }

    /// -1, 0 or 1.
    pub fn beside(&mut self) -> i64 {
        self.between(-1, 1)
    }

    /// `v` or -`v`.
    pub fn sign(&mut self, v: i64) -> i64 {
        if self.once_in(2) { -v } else { v }
    }

    /// `W` random bits, often of a smaller magnitude, sometimes all zero or all one.
    pub fn bits<const W: u32>(&mut self) -> U<W> {
        let v = self.rng.draw() >> (64 - W);
        U::new(match self.below(8) {
            0 => 0,
            1 => U::<W>::MAX.get(),
            2..5 => v >> self.below(u64::from(W)),
            _ => v,
        })
    }

    /// The same for 128 bits.
    pub fn wide(&mut self, width: u32) -> u128 {
        let v = (u128::from(self.rng.draw()) << 64 | u128::from(self.rng.draw())) >> (128 - width);
        match self.below(8) {
            0 => 0,
            1 => u128::MAX >> (128 - width),
            2..5 => v >> self.below(u64::from(width)),
            _ => v,
        }
    }

    /// -`max` to `max`, of all magnitudes, with zeros and extremes.
    pub fn signed(&mut self, max: i64) -> i64 {
        let v = self.between(-max, max);
        match self.below(8) {
            0 => 0,
            1 => max,
            2 => -max,
            3..6 => v >> self.below(32),
            _ => v,
        }
    }

    /// A coordinate, near a step of box codes one time in four.
    pub fn coordinate(&mut self, max: i64) -> i64 {
        match self.below(4) {
            0 => ((self.signed(max >> 16) << 16) + self.beside()).clamp(-max, max),
            _ => self.signed(max),
        }
    }

    /// A point with |v| <= `max`.
    pub fn point(&mut self, max: i64) -> Point {
        Point::new(self.coordinate(max), self.coordinate(max), self.coordinate(max))
    }

    /// A point of a model.
    pub fn model_point(&mut self) -> Point {
        self.point(i64::from(COORD_LIMIT))
    }

    /// A corner of the coordinate range.
    pub fn corner(&mut self) -> [i64; 3] {
        [POINT_MAX; 3].map(|v| self.sign(v))
    }

    /// The scale of any model's bounds.
    pub fn scale(&mut self) -> BoundScale {
        let offset = match self.below(8) {
            0 => 0,
            1 => MAX_BOUND_OFFSET,
            _ => self.below(MAX_BOUND_OFFSET + 1),
        };
        BoundScale { offset: U::new(offset) }
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
}
