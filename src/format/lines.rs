//! The records that traversal reads, as packed structs; a memory line is a 256-bit little-endian integer (four `u64` words).
//!
//! | record | size | at |
//! |---|---|---|
//! | quad-BVH node, 16-bit boxes | 64 bytes: four [`BvhChild`], child 0 first | `nodes` |
//! | L0 record | 64 bytes: [`VertexData`] line holding p0, p1, p2; then [`L0Record`] | `records` |
//! | sibling group | 64 bytes: four [`BoundData`], child 0 first | `bounds` |
//! | inserted vertices q0, q1, q2 | 32 bytes: [`VertexData`] | `vertices` |

pub use crate::num::Box16;
use crate::num::{BoundCode, PADDING_BITS, Point, S, U, Vec3, wire_struct};

wire_struct! {
    /// Bound data of one node: 16 bytes.
    pub struct BoundData {
        /// Zero.
        reserved: U<2>,
        /// Code of edge (p1, p2).
        e0: BoundCode,
        /// Code of edge (p2, p0).
        e1: BoundCode,
        /// Code of edge (p0, p1).
        e2: BoundCode,
        /// Box of the full-resolution triangles below the node.
        bounds: Box16,
    }
}

wire_struct! {
    /// Three points of 28-bit coordinates (the stored part: units / 16): one 32-byte line.
    pub struct VertexData {
        /// Zero.
        reserved: U<4>,
        /// q0 (or p0 in an L0 record).
        v0: Vec3<28>,
        /// q1 (or p1).
        v1: Vec3<28>,
        /// q2 (or p2).
        v2: Vec3<28>,
    }
}

wire_struct! {
    /// Second line of an L0 record.
    pub struct L0Record {
        /// Zero.
        reserved_high: U<64>,
        /// Zero.
        reserved: U<48>,
        /// Material index.
        material: U<16>,
        /// Bound data of the root (codes zero if N = 0).
        root: BoundData,
    }
}

wire_struct! {
    /// What a quad-BVH slot refers to.
    pub struct ChildRef {
        /// 0 empty, 1 inner node, 2 leaf.
        kind: U<2>,
        /// Leaf: number of triangles or trees minus one.
        count: U<2>,
        /// Node index, or index of the leaf's first triangle slot or tree.
        index: U<28>,
    }
}

wire_struct! {
    /// One of the four children of a quad-BVH node: 16 bytes.
    pub struct BvhChild {
        /// What it refers to.
        child: ChildRef,
        /// Its box; all zero in an empty slot.
        bounds: Box16,
    }
}

impl ChildRef {
    /// `kind` of an empty slot.
    pub const EMPTY: u64 = 0;
    /// `kind` of an inner node.
    pub const INNER: u64 = 1;
    /// `kind` of a leaf.
    pub const LEAF: u64 = 2;

    /// Reference to inner node `index` (below 2^28).
    pub fn inner(index: u32) -> Self {
        Self { kind: U::new(Self::INNER), count: U::ZERO, index: U::new(u64::from(index)) }
    }

    /// Reference to a leaf of `count` (1 to 4) things from `index` (below 2^28) on.
    pub fn leaf(index: u32, count: u32) -> Self {
        Self { kind: U::new(Self::LEAF), count: U::new(u64::from(count) - 1), index: U::new(u64::from(index)) }
    }
}

impl VertexData {
    /// From three stored points (their low 4 bits zero).
    pub fn from_points(p: [[i32; 3]; 3]) -> Self {
        let v = |c: [i32; 3]| {
            let [x, y, z] = c.map(|u| i64::from(u >> PADDING_BITS));
            Vec3::new(x, y, z)
        };
        Self { reserved: U::ZERO, v0: v(p[0]), v1: v(p[1]), v2: v(p[2]) }
    }

    /// The three points in units.
    #[inline(always)]
    pub fn points(&self) -> [Point; 3] {
        // 28 + 4 = 32 bits.
        let pad = |v: Vec3<28>| Point { x: S::new(v.x.get() << 4), y: S::new(v.y.get() << 4), z: S::new(v.z.get() << 4) };
        [pad(self.v0), pad(self.v1), pad(self.v2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Wire;

    #[test]
    fn records_have_their_stated_sizes() {
        assert_eq!(BoundData::WIDTH, 128);
        assert_eq!(VertexData::WIDTH, 256);
        assert_eq!(L0Record::WIDTH, 256);
        assert_eq!(BvhChild::WIDTH, 128);
    }

    #[test]
    fn vertex_lines_give_their_points_back() {
        let p = [[16, -32, 0x7FFE_0000], [-0x7FFE_0000, 0, 48], [1 << 20, -(1 << 20), 160]];
        let mut line = [0u64; 4];
        VertexData::from_points(p).to_words(&mut line);
        assert_eq!(VertexData::from_words(&line).points(), p.map(Point::from_i32));
    }
}
