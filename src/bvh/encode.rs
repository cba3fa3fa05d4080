//! Nodes as memory lines: 16-bit boxes in two 32-byte lines, 32-bit boxes in four.

use super::{Box32, Child, QuadNode};
use crate::format::{Box16, BvhChild, ChildRef};
use crate::num::{COORD_LIMIT, Vec3, Wire, box_code_ceil, box_code_floor, wire_struct};

/// A node with 16-bit boxes: four [`BvhChild`] of 16 bytes, child k in words 2k and 2k + 1.
pub type Node16 = [u64; 8];
/// A node with 32-bit boxes: four [`BvhChild32`], child k in words 4k to 4k + 3 (a line of its own), the top 32 bits of each line zero.
pub type Node32 = [u64; 16];

wire_struct! {
    /// One of the four children of a node with 32-bit boxes: 28 bytes.
    pub struct BvhChild32 {
        /// What it refers to.
        child: ChildRef,
        /// Lower corner of its box in units; zero in an empty slot.
        lo: Vec3<32>,
        /// Upper corner.
        hi: Vec3<32>,
    }
}

/// Indices are below 2^28 and counts 1 to 4 in every tree that [`super::build()`] makes.
fn reference(c: Child) -> ChildRef {
    match c {
        Child::Empty => ChildRef::default(),
        Child::Inner(index) => ChildRef::inner(index),
        Child::Leaf { first, count } => ChildRef::leaf(first, u32::from(count)),
    }
}

fn box16(b: &Box32) -> Box16 {
    // Boxes keep to the coordinate limit; the minimum only spells it out for the addition in `box_code_ceil`.
    Box16::from_codes(b.lo.map(box_code_floor), b.hi.map(|v| box_code_ceil(v.min(COORD_LIMIT))))
}

/// The node with its boxes rounded outwards to 16-bit codes. It keeps to the limits of [`super::build()`]: indices below 2^28, leaves of 1 to 4.
pub fn encode16(node: &QuadNode) -> Node16 {
    let mut words = [0; 8];
    for (line, (b, &c)) in words.as_chunks_mut::<2>().0.iter_mut().zip(node.boxes.iter().zip(&node.children)) {
        BvhChild { child: reference(c), bounds: box16(b) }.to_words(line);
    }
    words
}

/// The node with its boxes in units; the same limits as for [`encode16`].
pub fn encode32(node: &QuadNode) -> Node32 {
    let mut words = [0; 16];
    for (line, (b, &c)) in words.as_chunks_mut::<4>().0.iter_mut().zip(node.boxes.iter().zip(&node.children)) {
        BvhChild32 { child: reference(c), lo: Vec3::from_i32(b.lo), hi: Vec3::from_i32(b.hi) }.to_words(line);
    }
    words
}
