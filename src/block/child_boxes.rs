//! The boxes of the four children of a node for this ray (paper section 3.4).
//!
//! Of a quad-BVH node they lie in its frame: origin + steps. Of a tree's node each is the box of the child's full-resolution triangle F, let out by the stored excess so that
//! it holds all full-resolution vertices below, and widened by the child's triangle as morphed, P:
//! lo = min(max(-32767, floor(F) - steps), floor(P)), hi = max(min(32767, ceil(F) + steps), ceil(P)), in codes of 2^16 units.
//! Enough for all deeper levels: every later vertex is a convex combination of the morphed corners and of full-resolution vertices.
//! Steps: floor((2 + half) v 2^exponent / 2) of their axis ([`box_steps`]).
//! Legal: |points| <= `COORD_LIMIT`, so that ceilings fit 16 bits; origin at least -32767; any planes and steps.

use super::parts::{Parts, Registers, TAG};
use super::tessellate::child_triangle;
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

#[inline(always)]
fn lower(steps: i32, f: [S<32>; 3], p: [S<32>; 3]) -> S<16> {
    // floor is monotone: one shift behind the minima.
    let least = |[a, b, c]: [S<32>; 3]| a.narrow().min(b.narrow()).min(c.narrow()) >> BOX_SHIFT;
    S::new(i64::from((least(f) - steps).max(-MOST).min(least(p))))
}

#[inline(always)]
fn upper(steps: i32, f: [S<32>; 3], p: [S<32>; 3]) -> S<16> {
    let round_up = (1 << BOX_SHIFT) - 1;
    // At most ceil(COORD_LIMIT / 2^16) = 32766.
    let most = |[a, b, c]: [S<32>; 3]| (a.narrow().max(b.narrow()).max(c.narrow()) + round_up) >> BOX_SHIFT;
    S::new(i64::from((most(f) + steps).min(MOST).max(most(p))))
}

/// The box of a child of a tree's node with full-resolution triangle `f` and morphed triangle `p`.
#[inline(always)]
pub fn widened(reach: Reach, f: [Point; 3], p: [Point; 3]) -> Box16 {
    let ([fa, fb, fc], [pa, pb, pc]) = (f, p);
    let (fx, fy, fz) = ([fa.x, fb.x, fc.x], [fa.y, fb.y, fc.y], [fa.z, fb.z, fc.z]);
    let (px, py, pz) = ([pa.x, pb.x, pc.x], [pa.y, pb.y, pc.y], [pa.z, pb.z, pc.z]);
    Box16 {
        lo: Vec3 { x: lower(reach.lo[0], fx, px), y: lower(reach.lo[1], fy, py), z: lower(reach.lo[2], fz, pz) },
        hi: Vec3 { x: upper(reach.hi[0], fx, px), y: upper(reach.hi[1], fy, py), z: upper(reach.hi[2], fz, pz) },
    }
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
        let bounds = [0, 1, 2, 3].map(|k| {
            let steps = |axis: usize, at: usize| {
                // Below 2^24.
                box_steps(i.halves[axis], exponents[axis], i.planes[6 * k + at].narrow().cast_unsigned()).cast_signed()
            };
            let reach = Reach { lo: [steps(0, 0), steps(1, 1), steps(2, 2)], hi: [steps(0, 3), steps(1, 4), steps(2, 5)] };
            if i.tree { widened(reach, child_triangle(f, g, k), child_triangle(p, q, k)) } else { framed(origin, reach) }
        });
        Out { bounds }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const LIMIT: i32 = crate::num::COORD_LIMIT;

    fn points(v: &[[i32; 3]]) -> [Point; 3] {
        [v[0], v[1], v[2]].map(Point::from_i32)
    }

    proptest! {
        #[test]
        fn without_excess_a_box_is_the_smallest_around_both_triangles(v in prop::array::uniform6(prop::array::uniform3(-LIMIT..=LIMIT))) {
            let none = Reach { lo: [0; 3], hi: [0; 3] };
            prop_assert_eq!(widened(none, points(&v[..3]), points(&v[3..])), Box16::of_points(&v));
        }

        #[test]
        fn excess_lets_out_the_full_triangle_alone(
            v in prop::array::uniform6(prop::array::uniform3(-LIMIT..=LIMIT)), lo in prop::array::uniform3(0i32..1 << 23), hi in prop::array::uniform3(0i32..1 << 23), bits in 0u32..23
        ) {
            let reach = Reach { lo: lo.map(|c| c >> bits), hi: hi.map(|c| c >> bits) };
            let (own, morphed) = (Box16::of_points(&v[..3]), Box16::of_points(&v[3..]));
            let out = widened(reach, points(&v[..3]), points(&v[3..]));
            for c in 0..3 {
                let low = (own.lo.get()[c] - i64::from(reach.lo[c])).max(-32_767).min(morphed.lo.get()[c]);
                let high = (own.hi.get()[c] + i64::from(reach.hi[c])).min(32_767).max(morphed.hi.get()[c]);
                prop_assert_eq!((out.lo.get()[c], out.hi.get()[c]), (low, high));
            }
        }
    }
}
