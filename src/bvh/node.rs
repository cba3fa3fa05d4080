//! Nodes of BVHs and their boxes, before they are written.

use crate::num::COORD_LIMIT;

/// A box in units: `lo <= hi`, both at most [`COORD_LIMIT`] in magnitude.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Box32 {
    /// Lower corner.
    pub lo: [i32; 3],
    /// Upper corner.
    pub hi: [i32; 3],
}

impl Box32 {
    /// The smallest box around three points.
    #[inline]
    pub fn of_triangle(p: [[i32; 3]; 3]) -> Self {
        Self {
            lo: std::array::from_fn(|k| p[0][k].min(p[1][k]).min(p[2][k])),
            hi: std::array::from_fn(|k| p[0][k].max(p[1][k]).max(p[2][k])),
        }
    }

    /// The smallest box around both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { lo: std::array::from_fn(|k| self.lo[k].min(other.lo[k])), hi: std::array::from_fn(|k| self.hi[k].max(other.hi[k])) }
    }

    /// Whether `inner` lies in this box, borders included.
    #[inline]
    pub fn contains(&self, inner: &Self) -> bool {
        (0..3).all(|k| self.lo[k] <= inner.lo[k] && inner.hi[k] <= self.hi[k])
    }

    /// Half the surface area, in square units; a flat box may have none.
    #[inline]
    pub fn half_area(&self) -> f64 {
        // f64 before the difference: it needs 33 bits.
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| f64::from(self.hi[k]) - f64::from(self.lo[k]));
        x * y + y * z + z * x
    }

    pub(super) fn is_legal(&self) -> bool {
        (0..3).all(|k| -COORD_LIMIT <= self.lo[k] && self.lo[k] <= self.hi[k] && self.hi[k] <= COORD_LIMIT)
    }
}

/// What a child of a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Child {
    /// An unused slot; always after the used ones.
    #[default]
    Empty,
    /// Another node.
    Inner(u32),
    /// Primitives `order[first..first + count]`.
    Leaf {
        /// Position of the first in the order; of a leaf block, its first line.
        first: u32,
        /// Number of primitives, 1 to 4; of a leaf block, its lines.
        count: u8,
    },
}

/// A node: up to `W` children and their boxes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WideNode<const W: usize> {
    /// The boxes, all zero in an empty slot.
    pub boxes: [Box32; W],
    /// The children.
    pub children: [Child; W],
}

impl<const W: usize> Default for WideNode<W> {
    fn default() -> Self {
        Self { boxes: [Box32::default(); W], children: [Child::Empty; W] }
    }
}

/// A node of a quad-BVH.
pub type QuadNode = WideNode<4>;
