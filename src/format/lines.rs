//! The records that traversal reads, as packed structs; a memory line is a 256-bit little-endian integer (four `u64` words).
//!
//! | record | size | at |
//! |---|---|---|
//! | quad-BVH node | a line: [`BvhNode`] | `nodes` |
//! | L0 record | a line: [`L0Record`]; if vertices are exact a second one: [`VertexData`] with p0, p1, p2 | `records` |
//! | split of a node whose children are nodes | a line: [`SplitRecord`] | `splits` |
//! | inserted vertices q0, q1, q2, exact | a line: [`VertexData`] | `vertices` |
//! | those of a last split, compact | half a line: [`Displacements`], an even sibling's in the lower half | `vertices` |
//! | those of four siblings that are last splits, short | a line: [`ShortLine`] | `vertices` |
//!
//! The full-resolution BVHs with 16-bit boxes have nodes of four [`BvhChild`], 64 bytes.

pub use crate::num::Box16;
use crate::num::{
    BASE_ZERO_BITS, BoundCode, BoxStep, Displacement, PADDING_BITS, Point, ROTATION_BITS, S, SHORT_BITS, SHORT_SHIFT, U, Vec3, Wire,
    box_steps, wire_struct,
};

/// A memory line.
pub type Line = [u64; 4];

wire_struct! {
    /// What traversal needs of a tree's node that splits into nodes: its inserted vertices, and of its four children bound codes and boxes. 32 bytes.
    ///
    /// A plane is how far the box of the full-resolution triangles below a child reaches beyond the box of its own full-resolution triangle, which whoever
    /// reads the split has: [`box_steps`] of its axis.
    pub struct SplitRecord {
        /// Inserted vertex q0, if they are compact (else zero): its displacement from the midpoint of its edge between full-resolution corners, in steps of
        /// [`displacement_shift`](crate::num::displacement_shift).
        v0: Displacement,
        /// The same of q1.
        v1: Displacement,
        /// Of q2.
        v2: Displacement,
        /// Codes of the nine different edges: 3k, 3k + 1, 3k + 2 of e0, e1, e2 of child k < 3; child 3 has 0, 4 and 8 ([`SplitRecord::codes_of`]).
        codes: [BoundCode; 9],
        /// Zero.
        reserved: U<4>,
        /// Steps along x, y, z are half as long again.
        halves: [bool; 3],
        /// Powers of two of these steps.
        exponents: [U<4>; 3],
        /// Child k: below in x, y, z and above in x, y, z at 6k to 6k + 5.
        planes: [U<2>; 24],
    }
}

wire_struct! {
    /// A quad-BVH node: 32 bytes. Its boxes lie in a frame of its own: [`box_steps`] of their axis from its origin.
    ///
    /// Children of a kind stand side by side: inner ones are consecutive nodes, leaves consecutive things, both in the order of their slots.
    pub struct BvhNode {
        /// Zero.
        reserved: U<1>,
        /// Kind of each child: 0 empty, 1 inner node, 2 leaf.
        kinds: [U<2>; 4],
        /// Leaf: number of triangles or trees minus one; else 0.
        counts: [U<2>; 4],
        /// The first inner child.
        first_node: U<28>,
        /// The first triangle slot or tree of the first leaf.
        first_leaf: U<28>,
        /// Lower corner of the frame.
        origin: Vec3<16>,
        /// Steps along x, y, z are half as long again.
        halves: [bool; 3],
        /// Powers of two of these steps.
        exponents: [U<4>; 3],
        /// Child k: lower corner x, y, z and upper corner x, y, z at 6k to 6k + 5; zero in an empty slot.
        planes: [U<5>; 24],
    }
}

wire_struct! {
    /// A node of six children of a full-resolution BVH: 64 bytes. As a [`BvhNode`], with planes of 8 bits.
    pub struct SixNode {
        /// Zero.
        reserved: [U<37>; 2],
        /// Frame that its boxes lie in, by number; 0 is that of all coordinates.
        rotation: U<ROTATION_BITS>,
        /// Kind of each child: 0 empty, 1 inner node, 2 leaf.
        kinds: [U<2>; 6],
        /// Leaf: number of triangles, or lines of its block, minus one; else 0.
        counts: [U<2>; 6],
        /// The first inner child.
        first_node: U<28>,
        /// The first triangle slot or line of the first leaf.
        first_leaf: U<28>,
        /// Lower corner of the frame.
        origin: Vec3<16>,
        /// Steps along x, y, z are half as long again.
        halves: [bool; 3],
        /// Powers of two of these steps.
        exponents: [U<4>; 3],
        /// Of each child, lower corner x, y, z and upper corner x, y, z; zero in an empty slot.
        planes: [[U<8>; 6]; 6],
    }
}

wire_struct! {
    /// Three points of 28-bit coordinates (the stored part: units / 16): one 32-byte line.
    pub struct VertexData {
        /// Zero.
        reserved: U<4>,
        /// q0 (or p0 beside an L0 record).
        v0: Vec3<28>,
        /// q1 (or p1).
        v1: Vec3<28>,
        /// q2 (or p2).
        v2: Vec3<28>,
    }
}

wire_struct! {
    /// Inserted vertices of a last split, compact: displacements as in a [`SplitRecord`]. 16 bytes.
    pub struct Displacements {
        /// Zero.
        reserved: U<11>,
        /// Of q0.
        v0: Displacement,
        /// Of q1.
        v1: Displacement,
        /// Of q2.
        v2: Displacement,
    }
}

wire_struct! {
    /// Inserted vertices of a last split, short: the leading bits of displacements, of which the others are zero. 63 bits.
    pub struct ShortDisplacements {
        /// Of q0.
        v0: Vec3<SHORT_BITS>,
        /// Of q1.
        v1: Vec3<SHORT_BITS>,
        /// Of q2.
        v2: Vec3<SHORT_BITS>,
    }
}

wire_struct! {
    /// Those of four siblings that are last splits: 32 bytes.
    pub struct ShortLine {
        /// Zero.
        reserved: U<4>,
        /// Of each sibling.
        siblings: [ShortDisplacements; 4],
    }
}

wire_struct! {
    /// What traversal needs of a base triangle: 32 bytes.
    pub struct L0Record {
        /// Levels of the tree that are stored, 0 to N: below them is nothing that a ray could want.
        depth: U<4>,
        /// Its place among the trees of each level (`layout.rs`).
        place: U<28>,
        /// Code of edge (p1, p2) of the root; zero if depth is 0, like the others.
        e0: BoundCode,
        /// Code of edge (p2, p0).
        e1: BoundCode,
        /// Code of edge (p0, p1).
        e2: BoundCode,
        /// Zero.
        reserved: U<2>,
        /// Corner p0 in steps of 2^[`BASE_ZERO_BITS`] units, if vertices are compact; else zero, and the corners are in a second line.
        p0: Vec3<22>,
        /// Corner p1.
        p1: Vec3<22>,
        /// Corner p2.
        p2: Vec3<22>,
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
    /// One of the four children of a full-resolution BVH's node with 16-bit boxes: 16 bytes.
    pub struct BvhChild {
        /// What it refers to.
        child: ChildRef,
        /// Its box; all zero in an empty slot.
        bounds: Box16,
    }
}

/// What of a tree is stored, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TreeLines {
    /// Levels of it: all nodes of that level serve every ray, and none below is stored.
    pub depth: u32,
    /// Its place among the trees of each level ([`LevelStarts`](super::LevelStarts)).
    pub place: usize,
}

impl L0Record {
    /// The record of a tree with these corners, whose low [`BASE_ZERO_BITS`] bits are zero.
    #[must_use]
    pub fn with_corners(self, corners: [[i32; 3]; 3]) -> Self {
        let [p0, p1, p2] = corners.map(|c| {
            let [x, y, z] = c.map(|u| i64::from(u >> BASE_ZERO_BITS));
            Vec3::new(x, y, z)
        });
        Self { p0, p1, p2, ..self }
    }

    /// Its corners in units.
    #[inline(always)]
    pub fn corners(&self) -> [Point; 3] {
        // 22 + 10 = 32 bits.
        let pad = |v: Vec3<22>| Point {
            x: S::new(v.x.get() << BASE_ZERO_BITS),
            y: S::new(v.y.get() << BASE_ZERO_BITS),
            z: S::new(v.z.get() << BASE_ZERO_BITS),
        };
        [pad(self.p0), pad(self.p1), pad(self.p2)]
    }

    /// What of the tree is stored, from the record's line.
    #[inline(always)]
    pub fn line_tree(line: &Line) -> TreeLines {
        const NUMBER: u64 = (1 << 28) - 1;
        TreeLines { depth: (line[3] >> 60) as u32, place: (line[3] >> 32 & NUMBER) as usize } // 4 and 28 bits
    }

    /// The record of a tree of which this is stored.
    #[must_use]
    pub fn of_tree(self, lines: TreeLines) -> Self {
        Self { depth: U::new(lines.depth.into()), place: U::new(lines.place as u64), ..self }
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

/// Bits of a plane of a split and of a node: those of all planes lie at the bottom of their records.
const SPLIT_PLANE: u32 = 2;
const NODE_PLANE: u32 = 5;

/// The bits of a line from bit `at` on.
#[inline(always)]
fn bits(line: &Line, at: u32) -> u64 {
    let (word, bit) = ((at / 64) as usize, at % 64);
    let above = if word < 3 { line[word + 1] } else { 0 };
    line[word] >> bit | (above << 1) << (63 - bit)
}

/// The six planes of the four children, of `BITS` bits each; plane j of child k at `[j][k]`.
#[inline(always)]
fn planes<const BITS: u32>(line: &Line) -> [[u32; 4]; 6] {
    // Words that start at whole bytes: one load each, where the line lies in memory.
    let bytes: &[u8; 32] = bytemuck::cast_ref(line);
    let word = |k: u32| {
        let at = 6 * BITS * k;
        let from = (at / 8) as usize;
        // At most 30 bits, from bit 6 on at the furthest; the last at byte 11.
        u64::from_ne_bytes(std::array::from_fn(|j| bytes[from + j])) >> (at % 8)
    };
    let all = [word(0), word(1), word(2), word(3)];
    let mut planes = [[0; 4]; 6];
    for (j, planes) in (0..).zip(&mut planes) {
        for k in 0..4 {
            planes[k] = (all[k] >> (BITS * j)) as u32 & ((1 << BITS) - 1);
        }
    }
    planes
}

/// Steps at bit `from`, behind the planes: exponents of x, y, z, then their halves.
#[inline(always)]
fn steps(line: &Line, from: u32) -> [BoxStep; 3] {
    let all = bits(line, from) as u32; // 15 bits
    let step = |axis: u32| BoxStep { half: all >> (12 + axis) & 1 == 1, exponent: all >> (4 * axis) & 15 };
    [step(0), step(1), step(2)]
}

impl SplitRecord {
    /// Most steps of a plane.
    pub const MOST: u32 = (1 << SPLIT_PLANE) - 1;

    /// Where the codes of e0, e1, e2 of child `k` stand: those of child 3 are e0 of child 0, e1 of child 1 and e2 of child 2.
    #[inline(always)]
    pub const fn places_of(k: usize) -> [usize; 3] {
        const PLACES: [[usize; 3]; 4] = [[0, 1, 2], [3, 4, 5], [6, 7, 8], [0, 4, 8]];
        PLACES[k]
    }

    /// Codes of e0, e1, e2 of child `k`.
    #[inline(always)]
    pub fn codes_of(&self, k: usize) -> [BoundCode; 3] {
        Self::places_of(k).map(|place| self.codes[place])
    }

    /// The same from the split's line.
    #[inline(always)]
    pub fn line_codes(line: &Line, k: usize) -> [BoundCode; 3] {
        // Behind planes, steps and reserved bits, in the second and third word: read from memory as bytes, since which of them is what no predictor knows.
        const FIRST: u32 = 24 * SPLIT_PLANE + 15 + 4 - 64;
        let bytes = ((u128::from(line[2]) << 64 | u128::from(line[1])) >> FIRST).to_le_bytes();
        let [e0, e1, e2] = Self::places_of(k);
        let code = |place: usize| U::new(u64::from(bytes[place]));
        [code(e0), code(e1), code(e2)]
    }

    /// Displacements of the inserted vertices, from the split's line.
    #[inline(always)]
    pub fn line_displacements(line: &Line) -> [Point; 3] {
        // 117 bits from bit 139 on; the lowest bits are those of z of q2.
        let all = (u128::from(line[3]) << 64 | u128::from(line[2])) >> 11;
        displacements(all)
    }

    /// Plane j of child k of the split's line at `[j][k]`.
    #[inline(always)]
    pub fn line_planes(line: &Line) -> [[u32; 4]; 6] {
        planes::<SPLIT_PLANE>(line)
    }

    /// Steps along x, y, z of the split's line.
    #[inline(always)]
    pub fn line_steps(line: &Line) -> [BoxStep; 3] {
        steps(line, 24 * SPLIT_PLANE)
    }

    /// The record of a split with these displacements.
    #[must_use]
    pub fn with_displacements(self, split: Displacements) -> Self {
        let Displacements { v0, v1, v2, .. } = split;
        Self { v0, v1, v2, ..self }
    }
}

impl BvhNode {
    /// Most steps of a plane.
    pub const MOST: u32 = (1 << NODE_PLANE) - 1;

    /// What child `k` is.
    #[inline(always)]
    pub fn child(&self, k: usize) -> ChildRef {
        child_at(&self.kinds, &self.counts, [self.first_node, self.first_leaf], k)
    }

    /// The same from the node's line.
    #[inline(always)]
    pub fn line_child(line: &Line, k: usize) -> ChildRef {
        let count = |j: usize| line[3] >> (47 + 2 * j) & 3;
        let kind = Self::line_kind(line, k);
        let (mut inner, mut slots) = (0, 0);
        for j in 0..k {
            let of = Self::line_kind(line, j);
            inner += u64::from(of == ChildRef::INNER);
            slots += if of == ChildRef::LEAF { count(j) + 1 } else { 0 };
        }
        let index = match kind {
            ChildRef::INNER => (line[3] >> 19) + inner,
            // Bits 183 to 210: nine of them in the third word.
            ChildRef::LEAF => (line[2] >> 55 | line[3] << 9) + slots,
            _ => 0,
        };
        ChildRef { kind: U::new(kind), count: U::new(count(k)), index: U::new(index & U::<28>::MAX.get()) }
    }

    /// Kind of child `k` of the node's line.
    #[inline(always)]
    pub fn line_kind(line: &Line, k: usize) -> u64 {
        line[3] >> (55 + 2 * k) & 3 // kinds end below the reserved bit
    }

    /// Lower corner of the frame of the node's line.
    #[inline(always)]
    pub fn line_origin(line: &Line) -> [i32; 3] {
        // Bits 135 to 182, x highest.
        let bits = line[2] >> 7;
        let code = |shift: u32| i32::from((bits >> shift) as i16);
        [code(32), code(16), code(0)]
    }

    /// Plane j of child k of the node's line at `[j][k]`.
    #[inline(always)]
    pub fn line_planes(line: &Line) -> [[u32; 4]; 6] {
        planes::<NODE_PLANE>(line)
    }

    /// Steps along x, y, z of the node's line.
    #[inline(always)]
    pub fn line_steps(line: &Line) -> [BoxStep; 3] {
        steps(line, 24 * NODE_PLANE)
    }

    /// Box of child `k`.
    pub fn bounds(&self, k: usize) -> Box16 {
        let planes = std::array::from_fn(|j| self.planes[6 * k + j].get() as u32); // 5 bits
        framed_bounds(self.origin.get(), self.halves, self.exponents, planes)
    }
}

impl SixNode {
    /// Most steps of a plane.
    pub const MOST: u32 = 255;

    /// What child `k` is.
    #[inline(always)]
    pub fn child(&self, k: usize) -> ChildRef {
        child_at(&self.kinds, &self.counts, [self.first_node, self.first_leaf], k)
    }

    /// Box of child `k`.
    #[inline(always)]
    pub fn bounds(&self, k: usize) -> Box16 {
        let planes = self.planes[k].map(|plane| plane.get() as u32); // 8 bits
        framed_bounds(self.origin.get(), self.halves, self.exponents, planes)
    }
}

/// What child `k` is among children of these kinds and counts, of which those of a kind stand side by side: inner ones from the first of `firsts` on, leaves
/// from the second.
#[inline(always)]
fn child_at(kinds: &[U<2>], counts: &[U<2>], firsts: [U<28>; 2], k: usize) -> ChildRef {
    let before = |of: u64| (0..k).filter(move |&j| kinds[j].get() == of);
    let [first_node, first_leaf] = firsts.map(U::get);
    let index = match kinds[k].get() {
        ChildRef::INNER => first_node + before(ChildRef::INNER).count() as u64,
        ChildRef::LEAF => first_leaf + before(ChildRef::LEAF).map(|j| counts[j].get() + 1).sum::<u64>(),
        _ => 0,
    };
    // Whatever the file says: 28 bits, as in hardware.
    ChildRef { kind: kinds[k], count: counts[k], index: U::new(index & U::<28>::MAX.get()) }
}

/// The box with these planes, lower x, y, z and upper x, y, z in steps of a frame.
#[inline(always)]
fn framed_bounds(origin: [i64; 3], halves: [bool; 3], exponents: [U<4>; 3], planes: [u32; 6]) -> Box16 {
    let corner = |from: usize| {
        std::array::from_fn(|axis| {
            let up = box_steps(halves[axis], exponents[axis].get() as u32, planes[from + axis]); // 4 bits
            (origin[axis] + i64::from(up)).min(32_767) as i16
        })
    };
    Box16::from_codes(corner(0), corner(3))
}

/// Steps of nine coordinates of 13 bits, z of the last vertex the lowest.
#[inline(always)]
fn displacements(all: u128) -> [Point; 3] {
    // Sign-extended.
    let step = |at: u32| S::new(((all >> (13 * at)) as i64) << 51 >> 51);
    let point = |at: u32| Point { x: step(at + 2), y: step(at + 1), z: step(at) };
    [point(6), point(3), point(0)]
}

impl Displacements {
    /// From steps of each vertex's coordinates, 13 bits each.
    pub fn from_steps(steps: [[i32; 3]; 3]) -> Self {
        let [v0, v1, v2] = steps.map(|v| {
            let [x, y, z] = v.map(i64::from);
            Vec3::new(x, y, z)
        });
        Self { reserved: U::ZERO, v0, v1, v2 }
    }

    /// Steps of the vertices' coordinates of node `number` of a level, from the line that it shares with a sibling.
    #[inline(always)]
    pub fn line_half(line: &Line, number: usize) -> [Point; 3] {
        let at = 2 * (number & 1);
        displacements(u128::from(line[at + 1]) << 64 | u128::from(line[at]))
    }
}

impl ShortDisplacements {
    /// From displacements whose lowest bits are zero.
    pub fn of(of: &Displacements) -> Self {
        let short = |v: Displacement| {
            let [x, y, z] = v.get().map(|c| c >> SHORT_SHIFT);
            Vec3::new(x, y, z)
        };
        Self { v0: short(of.v0), v1: short(of.v1), v2: short(of.v2) }
    }

    /// Steps of the vertices' coordinates.
    #[inline(always)]
    pub fn steps(&self) -> [Point; 3] {
        let whole = |v: Vec3<SHORT_BITS>| {
            let [x, y, z] = v.get().map(|c| c << SHORT_SHIFT);
            Point { x: S::new(x), y: S::new(y), z: S::new(z) }
        };
        [whole(self.v0), whole(self.v1), whole(self.v2)]
    }
}

impl ShortLine {
    /// Steps of the vertices' coordinates of node `number` of a level, from the line that it shares with its siblings.
    #[inline(always)]
    pub fn line_steps(line: &Line, number: usize) -> [Point; 3] {
        let at = ShortDisplacements::WIDTH * (number & 3) as u32; // 0 to 189
        let all = bits(line, at);
        // Sign-extended, with zeros below.
        let step = |at: u32| S::new(((all >> (SHORT_BITS * at)) << (64 - SHORT_BITS)).cast_signed() >> (64 - SHORT_BITS) << SHORT_SHIFT);
        let point = |at: u32| Point { x: step(at + 2), y: step(at + 1), z: step(at) };
        [point(6), point(3), point(0)]
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
    use proptest::prelude::*;

    #[test]
    fn records_have_their_stated_sizes() {
        assert_eq!(SplitRecord::WIDTH, 256);
        assert_eq!(BvhNode::WIDTH, 256);
        assert_eq!(VertexData::WIDTH, 256);
        assert_eq!(Displacements::WIDTH, 128);
        assert_eq!((ShortDisplacements::WIDTH, ShortLine::WIDTH), (63, 256));
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

    #[test]
    fn halves_of_a_line_are_told_apart() {
        let steps = [[[1, -2, 4095], [-4096, 5, 6], [7, 8, -9]], [[-1, 2, -4095], [0, 0, 0], [11, -12, 13]]];
        let mut line = [0u64; 4];
        for (steps, half) in steps.iter().zip(line.chunks_exact_mut(2)) {
            Displacements::from_steps(*steps).to_words(half);
        }
        for (k, steps) in steps.iter().enumerate() {
            assert_eq!(Displacements::line_half(&line, k + 4), steps.map(Point::from_i32));
        }
    }

    #[test]
    fn siblings_in_a_line_are_told_apart() {
        let steps: [[[i32; 3]; 3]; 4] = [
            [[64, -64, 4032], [-4096, 320, 0], [448, 0, -576]],
            [[-64, 128, -4032], [0, 0, 0], [704, -768, 832]],
            [[-4096; 3], [4032; 3], [-4096; 3]],
            [[0, 0, 64], [0, -64, 0], [4032, 0, -4096]],
        ];
        let mut line = [0u64; 4];
        ShortLine { reserved: U::ZERO, siblings: steps.map(|of| ShortDisplacements::of(&Displacements::from_steps(of))) }
            .to_words(&mut line);
        for (k, steps) in steps.iter().enumerate() {
            let wanted = steps.map(Point::from_i32);
            assert_eq!((ShortLine::line_steps(&line, k + 8), ShortLine::from_words(&line).siblings[k].steps()), (wanted, wanted));
        }
    }

    proptest! {
        #[test]
        fn parts_of_lines_are_the_fields(line in prop::array::uniform4(any::<u64>())) {
            let (split, node) = (SplitRecord::from_words(&line), BvhNode::from_words(&line));
            let (record, lines) = (L0Record::from_words(&line), L0Record::line_tree(&line));
            prop_assert_eq!(record.of_tree(lines), record);
            prop_assert_eq!(record.with_corners(record.corners().map(|p| p.get().map(|c| c as i32))), record);
            let displacements = Displacements { reserved: U::ZERO, v0: split.v0, v1: split.v1, v2: split.v2 };
            prop_assert_eq!(SplitRecord::line_displacements(&line), [split.v0, split.v1, split.v2].map(|v| {
                let [x, y, z] = v.get();
                Point { x: S::new(x), y: S::new(y), z: S::new(z) }
            }));
            prop_assert_eq!(split.with_displacements(displacements), split);
            for axis in 0..3 {
                let step = |half: [bool; 3], exponents: [U<4>; 3]| BoxStep { half: half[axis], exponent: exponents[axis].get() as u32 };
                prop_assert_eq!(SplitRecord::line_steps(&line)[axis], step(split.halves, split.exponents));
                prop_assert_eq!(BvhNode::line_steps(&line)[axis], step(node.halves, node.exponents));
            }
            prop_assert_eq!(BvhNode::line_origin(&line).map(i64::from), node.origin.get());
            for k in 0..4 {
                let own = |j: usize| (u64::from(SplitRecord::line_planes(&line)[j][k]), u64::from(BvhNode::line_planes(&line)[j][k]));
                prop_assert!((0..6).all(|j| own(j) == (split.planes[6 * k + j].get(), node.planes[6 * k + j].get())));
                prop_assert_eq!(SplitRecord::line_codes(&line, k), split.codes_of(k));
                prop_assert_eq!(BvhNode::line_kind(&line, k), node.kinds[k].get());
                prop_assert_eq!(BvhNode::line_child(&line, k), node.child(k));
            }
        }
    }
}
