//! Nodes as memory lines: boxes in a frame of their own in one 32-byte line, 16-bit boxes in two, 32-bit boxes in four; of six children, with finer boxes in a
//! frame, in two.

use super::{Box32, Child, QuadNode, WideNode};
use crate::format::{Box16, BvhChild, BvhNode, ChildRef, Line, SixNode};
use crate::num::{BoxStep, U, Vec3, Wire, box_code_ceil, box_code_floor, wire_struct};

/// A node with 16-bit boxes: four [`BvhChild`] of 16 bytes, child k in words 2k and 2k + 1.
pub type Node16 = [u64; 8];
/// A node of six children: a [`SixNode`] as words.
pub type Node6 = [u64; 8];
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

pub(super) fn box16(b: &Box32) -> Box16 {
    // Boxes keep to the coordinate limit, or a few units more where they are turned: `box_code_ceil` adds without overflow.
    Box16::from_codes(b.lo.map(box_code_floor), b.hi.map(box_code_ceil))
}

/// The node with its boxes rounded outwards to 16-bit codes. It keeps to the limits of [`super::build()`]: indices below 2^28, leaves of 1 to 4.
pub fn encode16(node: &QuadNode) -> Node16 {
    let mut words = [0; 8];
    for (line, (b, &c)) in words.as_chunks_mut::<2>().0.iter_mut().zip(node.boxes.iter().zip(&node.children)) {
        BvhChild { child: reference(c), bounds: box16(b) }.to_words(line);
    }
    words
}

/// The node in one line: its boxes rounded outwards to 16-bit codes and then to 31 steps of the node's frame. The same limits as for [`encode16`], and children of
/// a kind stand side by side ([`super::QuadTree::side_by_side`]).
pub fn encode_line(node: &QuadNode) -> Line {
    let Framed { kinds, counts, firsts, origin, steps, planes } = Framed::of(node, BvhNode::MOST);
    let out = BvhNode {
        reserved: U::ZERO,
        kinds,
        counts,
        first_node: firsts[0],
        first_leaf: firsts[1],
        origin,
        halves: steps.map(|step| step.half),
        exponents: steps.map(|step| U::new(u64::from(step.exponent))),
        planes: std::array::from_fn(|at| U::new(u64::from(planes[at / 6][at % 6]))),
    };
    debug_assert!((0..4).all(|k| out.child(k) == reference(node.children[k])), "children of a kind stand side by side");
    let mut line = [0; 4];
    out.to_words(&mut line);
    line
}

/// The node of six children: its boxes rounded outwards to 16-bit codes and then to 255 steps of the node's frame, which is turned by a
/// [`Rotation`](crate::num::Rotation) of this number. The same limits as for [`encode_line`].
pub fn encode6(node: &WideNode<6>, rotation: u32) -> Node6 {
    let Framed { kinds, counts, firsts, origin, steps, planes } = Framed::of(node, SixNode::MOST);
    let out = SixNode {
        reserved: [U::ZERO; 2],
        rotation: U::new(u64::from(rotation)),
        kinds,
        counts,
        first_node: firsts[0],
        first_leaf: firsts[1],
        origin,
        halves: steps.map(|step| step.half),
        exponents: steps.map(|step| U::new(u64::from(step.exponent))),
        planes: planes.map(|planes| planes.map(|plane| U::new(u64::from(plane)))),
    };
    debug_assert!((0..6).all(|k| out.child(k) == reference(node.children[k])), "children of a kind stand side by side");
    let mut words = [0; 8];
    out.to_words(&mut words);
    words
}

/// What a node whose boxes lie in a frame of its own holds.
struct Framed<const W: usize> {
    kinds: [U<2>; W],
    counts: [U<2>; W],
    /// The first inner child, and what the first leaf refers to.
    firsts: [U<28>; 2],
    origin: Vec3<16>,
    /// Along x, y, z.
    steps: [BoxStep; 3],
    /// Of each child, lower x, y, z and upper x, y, z.
    planes: [[u32; 6]; W],
}

impl<const W: usize> Framed<W> {
    /// Its boxes rounded outwards to 16-bit codes and then to `most` steps.
    fn of(node: &WideNode<W>, most: u32) -> Self {
        let used = node.children.iter().take_while(|c| **c != Child::Empty).count();
        let boxes = node.boxes.each_ref().map(box16);
        let corners = || boxes[..used].iter().map(|b| (b.lo.get(), b.hi.get()));
        let origin: [i64; 3] = std::array::from_fn(|axis| corners().map(|(lo, _)| lo[axis]).min().unwrap_or(0));
        let mut planes = [[0; 6]; W];
        let steps = std::array::from_fn(|axis| {
            let from = |code: i64| (code - origin[axis]) as u32; // not below it, and 17 bits
            let step = BoxStep::reaching(corners().map(|(_, hi)| from(hi[axis])).max().unwrap_or(0), most);
            for (planes, (lo, hi)) in planes.iter_mut().zip(corners()) {
                (planes[axis], planes[axis + 3]) = (step.below(from(lo[axis])), step.above(from(hi[axis])));
            }
            step
        });
        let children = node.children.map(reference);
        let first = |kind| children.iter().find(|child| child.kind.get() == kind).map_or(U::ZERO, |child| child.index);
        Self {
            kinds: children.map(|child| child.kind),
            counts: children.map(|child| child.count),
            firsts: [first(ChildRef::INNER), first(ChildRef::LEAF)],
            origin: Vec3::new(origin[0], origin[1], origin[2]),
            steps,
            planes,
        }
    }
}

/// The node with its boxes in units; the same limits as for [`encode16`].
pub fn encode32(node: &QuadNode) -> Node32 {
    let mut words = [0; 16];
    for (line, (b, &c)) in words.as_chunks_mut::<4>().0.iter_mut().zip(node.boxes.iter().zip(&node.children)) {
        BvhChild32 { child: reference(c), lo: Vec3::from_i32(b.lo), hi: Vec3::from_i32(b.hi) }.to_words(line);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::COORD_LIMIT;
    use proptest::prelude::*;

    fn node<const W: usize>(corners: Vec<([i32; 3], [i32; 3])>) -> WideNode<W> {
        let mut node = WideNode::default();
        let (mut inner, mut slot) = (40, 900);
        for (k, (a, b)) in corners.into_iter().enumerate() {
            let pick = |f: fn(i32, i32) -> i32| std::array::from_fn(|c| f(a[c], b[c]));
            node.boxes[k] = Box32 { lo: pick(i32::min), hi: pick(i32::max) };
            node.children[k] = if a[0] & 1 == 0 {
                inner += 1;
                Child::Inner(inner)
            } else {
                let count = (b[0] & 3) as u8 + 1; // 1 to 4
                slot += u32::from(count);
                Child::Leaf { first: slot - u32::from(count), count }
            };
        }
        node
    }

    proptest! {
        #[test]
        fn a_line_holds_the_children_and_boxes_around_theirs(
            corners in prop::collection::vec((prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT), prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT)), 1..=4), bits in 0u32..20
        ) {
            let node: QuadNode = node(corners.into_iter().map(|(a, b)| (a.map(|c| c >> bits), b.map(|c| c >> bits))).collect());
            let line = BvhNode::from_words(&encode_line(&node));
            let used = node.children.iter().take_while(|c| **c != Child::Empty).count();
            let all: Vec<_> = node.boxes[..used].iter().map(box16).collect();
            for k in 0..4 {
                prop_assert_eq!(line.child(k), reference(node.children[k]));
                if k >= used {
                    prop_assert!((0..6).all(|j| line.planes[6 * k + j] == U::ZERO));
                    continue;
                }
                let (stored, own) = (line.bounds(k), all[k]);
                for c in 0..3 {
                    prop_assert!(stored.lo.get()[c] <= own.lo.get()[c] && stored.hi.get()[c] >= own.hi.get()[c]);
                    let extent = all.iter().map(|b| b.hi.get()[c]).max().unwrap_or(0) - all.iter().map(|b| b.lo.get()[c]).min().unwrap_or(0);
                    // A step is at most half as long again as a 31st of the extent, and a code more for its rounding.
                    let most = extent * 3 / 62 + 2;
                    prop_assert!(own.lo.get()[c] - stored.lo.get()[c] <= most && stored.hi.get()[c] - own.hi.get()[c] <= most);
                }
            }
        }

        #[test]
        fn six_children_too(
            corners in prop::collection::vec((prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT), prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT)), 1..=6), bits in 0u32..20
        ) {
            let node: WideNode<6> = node(corners.into_iter().map(|(a, b)| (a.map(|c| c >> bits), b.map(|c| c >> bits))).collect());
            let stored = SixNode::from_words(&encode6(&node, 0));
            let used = node.children.iter().take_while(|c| **c != Child::Empty).count();
            let all: Vec<_> = node.boxes[..used].iter().map(box16).collect();
            for k in 0..6 {
                prop_assert_eq!(stored.child(k), reference(node.children[k]));
                if k >= used {
                    prop_assert!((0..6).all(|j| stored.planes[k][j] == U::ZERO));
                    continue;
                }
                let (stored, own) = (stored.bounds(k), all[k]);
                for c in 0..3 {
                    prop_assert!(stored.lo.get()[c] <= own.lo.get()[c] && stored.hi.get()[c] >= own.hi.get()[c]);
                    let extent = all.iter().map(|b| b.hi.get()[c]).max().unwrap_or(0) - all.iter().map(|b| b.lo.get()[c]).min().unwrap_or(0);
                    // Exactly as codes where a step is one; else as above, of 255 steps.
                    let most = if extent <= 255 { 0 } else { extent * 3 / 510 + 2 };
                    prop_assert!(own.lo.get()[c] - stored.lo.get()[c] <= most && stored.hi.get()[c] - own.hi.get()[c] <= most);
                }
            }
        }
    }
}
