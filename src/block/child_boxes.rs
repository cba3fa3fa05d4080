//! The boxes of the four children of a node for this ray (paper section 3.4).
//!
//! Of a quad-BVH node they lie in its frame: origin + steps. Of a tree's node each is the box of the child's full-resolution triangle F, let out by the stored excess so that
//! it holds all full-resolution vertices below, and widened by the child's triangle as morphed, P:
//! lo = min(max(-32767, floor(F) - steps), floor(P)), hi = max(min(32767, ceil(F) + steps), ceil(P)), in codes of 2^16 units.
//! Enough for all deeper levels: every later vertex is a convex combination of the morphed corners and of full-resolution vertices.
//! Steps: floor((2 + half) v 2^exponent / 2) of their axis ([`box_steps`]).
//! Legal: |points| <= `COORD_LIMIT`, so that ceilings fit 16 bits; origin at least -32767; any planes and steps.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{BOX_SHIFT, Box16, Point, S, U, Vec3, box_steps, wire_struct};

wire_struct! {
    /// Input of [`ChildBoxes`].
    pub struct In {
        /// Children of a tree's node; else of a quad-BVH node.
        tree: bool,
        /// Lower corner of a quad-BVH node's frame.
        origin: Vec3<16>,
        /// Steps along x, y, z are half as long again.
        halves: [bool; 3],
        /// Powers of two of these steps.
        exponents: [U<4>; 3],
        /// Steps of child k: lower x, y, z and upper x, y, z at 6k to 6k + 5.
        planes: [U<7>; 24],
        /// Corner p0 of full resolution.
        f0: Point,
        /// Corner p1 of full resolution.
        f1: Point,
        /// Corner p2 of full resolution.
        f2: Point,
        /// Inserted vertex of full resolution on (p1, p2).
        g0: Point,
        /// On (p2, p0).
        g1: Point,
        /// On (p0, p1).
        g2: Point,
        /// Corner p0 as morphed for this ray.
        p0: Point,
        /// Corner p1.
        p1: Point,
        /// Corner p2.
        p2: Point,
        /// Inserted vertex on (p1, p2) as morphed for this ray.
        q0: Point,
        /// On (p2, p0).
        q1: Point,
        /// On (p0, p1).
        q2: Point,
    }
}

wire_struct! {
    /// Output of [`ChildBoxes`].
    pub struct Out {
        /// Box of child k.
        bounds: [Box16; 4],
    }
}

/// The block.
pub struct ChildBoxes;

/// Largest code in magnitude.
const MOST: i32 = 32_767;

/// Steps of the six planes of a child, in codes.
#[derive(Clone, Copy)]
pub struct Reach {
    /// Of its lower corner.
    pub lo: [i32; 3],
    /// Of its upper corner.
    pub hi: [i32; 3],
}

/// The box of a child of a quad-BVH node.
#[inline(always)]
pub fn framed(origin: [i32; 3], reach: Reach) -> Box16 {
    // 16 and 24 bits.
    let plane = |origin: i32, steps: i32| S::new(i64::from((origin + steps).min(MOST)));
    let corner = |steps: [i32; 3]| Vec3 { x: plane(origin[0], steps[0]), y: plane(origin[1], steps[1]), z: plane(origin[2], steps[2]) };
    Box16 { lo: corner(reach.lo), hi: corner(reach.hi) }
}

/// The least of the corners of each child along an axis, from those of its parent.
#[inline(always)]
fn least([p0, p1, p2]: [i32; 3], [q0, q1, q2]: [i32; 3]) -> [i32; 4] {
    let [a, b, c] = [q1.min(q2), q2.min(q0), q0.min(q1)];
    [p0.min(a), p1.min(b), p2.min(c), q2.min(c)]
}

/// The largest.
#[inline(always)]
fn most([p0, p1, p2]: [i32; 3], [q0, q1, q2]: [i32; 3]) -> [i32; 4] {
    let [a, b, c] = [q1.max(q2), q2.max(q0), q0.max(q1)];
    [p0.max(a), p1.max(b), p2.max(c), q2.max(c)]
}

/// Planes of all children along an axis, lower and upper, from the corners and inserted vertices of the node, of full resolution and as morphed.
#[inline(always)]
fn planes(down: [i32; 4], up: [i32; 4], [f, g, p, q]: [[i32; 3]; 4]) -> [[i32; 4]; 2] {
    const ROUND_UP: i32 = (1 << BOX_SHIFT) - 1;
    // Floor and ceiling are monotone: one shift behind the minima and maxima. At most ceil(COORD_LIMIT / 2^16) = 32766.
    let (full, morphed) = (least(f, g), least(p, q));
    let (mut lo, mut hi) = ([0; 4], [0; 4]);
    for k in 0..4 {
        lo[k] = ((full[k] >> BOX_SHIFT) - down[k]).max(-MOST).min(morphed[k] >> BOX_SHIFT);
    }
    let (full, morphed) = (most(f, g), most(p, q));
    for k in 0..4 {
        hi[k] = (((full[k] + ROUND_UP) >> BOX_SHIFT) + up[k]).min(MOST).max((morphed[k] + ROUND_UP) >> BOX_SHIFT);
    }
    [lo, hi]
}

/// The boxes of the children of a tree's node with these corners and inserted vertices, of full resolution (`f`, `g`) and as morphed (`p`, `q`).
#[inline(always)]
pub fn widened(reach: &[Reach; 4], [f, g, p, q]: [[Point; 3]; 4]) -> [Box16; 4] {
    let axis = |of: fn(&Point) -> S<32>, at: usize| {
        let component = |v: [Point; 3]| [of(&v[0]).narrow(), of(&v[1]).narrow(), of(&v[2]).narrow()];
        let steps = |of: fn(&Reach) -> [i32; 3]| [of(&reach[0])[at], of(&reach[1])[at], of(&reach[2])[at], of(&reach[3])[at]];
        planes(steps(|r| r.lo), steps(|r| r.hi), [component(f), component(g), component(p), component(q)])
    };
    let ([x_lo, x_hi], [y_lo, y_hi], [z_lo, z_hi]) = (axis(|v| v.x, 0), axis(|v| v.y, 1), axis(|v| v.z, 2));
    let code = |c: i32| S::new(i64::from(c));
    [0, 1, 2, 3].map(|k| Box16 {
        lo: Vec3 { x: code(x_lo[k]), y: code(y_lo[k]), z: code(z_lo[k]) },
        hi: Vec3 { x: code(x_hi[k]), y: code(y_hi[k]), z: code(z_hi[k]) },
    })
}

/// Bits of a box code, of a code with whether it is to be rounded up, of steps times two or three, of steps in codes, and of a code less or plus them.
const CODE: u32 = 16;
const STICKY: u32 = CODE + 1;
const DOUBLED: u32 = 9;
const STEPS: u32 = 16;
const SUM: u32 = CODE + 2;

impl ChildBoxes {
    /// Registers with a tag of so many bits: corners and pairs of inserted vertices, least and largest of each child, boxes.
    pub(super) fn registers(tag: u32) -> Registers {
        // Of both triangles, along each axis, three corners and three pairs of inserted vertices, and which of the first of them is less.
        let pairs = 2 * 3 * (3 * (STICKY + CODE + STICKY) + 1) + 24 * DOUBLED + 3 * 4 + 1;
        // Planes of the full-resolution triangle with its excess, and of the morphed one.
        let ends = 24 * (SUM + CODE) + 1;
        Registers::stage(pairs + tag) + Registers::stage(ends + tag) + Registers::skid(4 * 6 * CODE + tag)
    }
}

impl Block for ChildBoxes {
    const NAME: &'static str = "child_boxes";
    const TIMING: Timing = Timing::pipelined(3);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        let (pairs, ends, planes) = (2 * 3 * 3 * (CODE + STICKY), 2 * 4 * 3 * (CODE + STICKY), 24);
        Parts {
            products: vec![],
            // Comparisons of pairs and of them with single corners; steps and a half; sums, and their comparison with the morphed triangle.
            add_bits: pairs + ends + planes * (DOUBLED + STEPS + STEPS),
            // The same; shifts in four steps; the frame or the triangle, and which of three.
            select_bits: pairs + ends + planes * (4 * STEPS + CODE + 2 * CODE),
            registers: Self::registers(TAG),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let exponents = i.exponents.map(U::narrow).map(i32::cast_unsigned);
        let origin = [i.origin.x.narrow(), i.origin.y.narrow(), i.origin.z.narrow()];
        let (f, g, p, q) = ([i.f0, i.f1, i.f2], [i.g0, i.g1, i.g2], [i.p0, i.p1, i.p2], [i.q0, i.q1, i.q2]);
        let reach = [0, 1, 2, 3].map(|k| {
            let steps = |axis: usize, at: usize| {
                // Below 2^24.
                box_steps(i.halves[axis], exponents[axis], i.planes[6 * k + at].narrow().cast_unsigned()).cast_signed()
            };
            Reach { lo: [steps(0, 0), steps(1, 1), steps(2, 2)], hi: [steps(0, 3), steps(1, 4), steps(2, 5)] }
        });
        let bounds = if i.tree { widened(&reach, [f, g, p, q]) } else { reach.map(|reach| framed(origin, reach)) };
        Out { bounds }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::tessellate::child_triangle;
    use proptest::prelude::*;

    const LIMIT: i32 = crate::num::COORD_LIMIT;

    proptest! {
        #[test]
        fn boxes_are_the_smallest_around_the_morphed_triangle_and_the_full_one_let_out(
            v in prop::collection::vec(prop::array::uniform3(-LIMIT..=LIMIT), 12), steps in prop::collection::vec(0i32..1 << 23, 24), bits in 0u32..=23
        ) {
            let set = |at: usize| [v[at], v[at + 1], v[at + 2]].map(Point::from_i32);
            let [f, g, p, q] = [set(0), set(3), set(6), set(9)];
            let three = |at: usize| [steps[at] >> bits, steps[at + 1] >> bits, steps[at + 2] >> bits];
            let reach = [0, 6, 12, 18].map(|at| Reach { lo: three(at), hi: three(at + 3) });
            let out = widened(&reach, [f, g, p, q]);
            for k in 0..4 {
                let of = |corners: [Point; 3]| Box16::of_points(&corners.map(|c| c.get().map(|c| i32::try_from(c).unwrap())));
                let (own, morphed) = (of(child_triangle(f, g, k)), of(child_triangle(p, q, k)));
                for c in 0..3 {
                    let low = (own.lo.get()[c] - i64::from(reach[k].lo[c])).max(-32_767).min(morphed.lo.get()[c]);
                    let high = (own.hi.get()[c] + i64::from(reach[k].hi[c])).min(32_767).max(morphed.hi.get()[c]);
                    prop_assert_eq!((out[k].lo.get()[c], out[k].hi.get()[c]), (low, high));
                }
            }
        }
    }
}
