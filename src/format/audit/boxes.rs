//! Boxes: those of vertices, and those that lines store, worked out from the words of `docs/numbers.md`.

use crate::format::{BvhNode, SplitRecord};

/// Codes of a box's corners, in steps of 2^16 units.
pub(super) type Codes = [i64; 3];

/// The box of some vertices in units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub lo: [i32; 3],
    pub hi: [i32; 3],
}

impl Span {
    /// Around nothing.
    pub const EMPTY: Self = Self { lo: [i32::MAX; 3], hi: [i32::MIN; 3] };

    pub fn around(points: impl IntoIterator<Item = [i32; 3]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |span, p| span.with(&Self { lo: p, hi: p }))
    }

    #[inline]
    pub fn with(&self, other: &Self) -> Self {
        Self { lo: std::array::from_fn(|k| self.lo[k].min(other.lo[k])), hi: std::array::from_fn(|k| self.hi[k].max(other.hi[k])) }
    }

    /// Whether a box of codes contains it.
    pub fn is_within(&self, lo: Codes, hi: Codes) -> bool {
        (0..3).all(|k| lo[k] * 65_536 <= i64::from(self.lo[k]) && hi[k] * 65_536 >= i64::from(self.hi[k]))
    }
}

/// Codes in `v` steps of (2 + half) 2^exponent halves of a code.
fn steps(half: bool, exponent: u64, v: u64) -> i64 {
    let halves = i64::from(half) + 2;
    (v.cast_signed() * halves * 2i64.pow(exponent as u32)).div_euclid(2) // 4 bits
}

/// The box of child `k` of a split: that of its own full-resolution triangle, rounded outwards, and its excess.
pub(super) fn excess(split: &SplitRecord, k: usize, triangle: [[i32; 3]; 3]) -> (Codes, Codes) {
    let own = Span::around(triangle);
    let reach = |axis: usize, plane: usize| steps(split.halves[axis], split.exponents[axis].get(), split.planes[6 * k + plane].get());
    let lo = |axis: usize| i64::from(own.lo[axis]).div_euclid(65_536) - reach(axis, axis);
    let hi = |axis: usize| -(-i64::from(own.hi[axis])).div_euclid(65_536) + reach(axis, 3 + axis);
    (std::array::from_fn(|axis| lo(axis).max(-32_767)), std::array::from_fn(|axis| hi(axis).min(32_767)))
}

/// The box of child `k` of a quad-BVH node.
pub(super) fn local(node: &BvhNode, k: usize) -> (Codes, Codes) {
    let origin = node.origin.get();
    let at = |axis: usize, plane: usize| {
        let reach = steps(node.halves[axis], node.exponents[axis].get(), node.planes[6 * k + plane].get());
        (origin[axis] + reach).min(32_767)
    };
    (std::array::from_fn(|axis| at(axis, axis)), std::array::from_fn(|axis| at(axis, 3 + axis)))
}
