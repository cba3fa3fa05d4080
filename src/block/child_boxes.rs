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
        planes: [U<5>; 24],
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

/// A number of each child, side by side.
pub type Four = [i32; 4];

/// The triangle of a node, along each axis: p0, p1, p2, q0, q1, q2, q0, q1, q2. In that order the corners of the four children lie side by side from places 0, 4 and 5 on.
#[derive(Clone, Copy, Default)]
pub struct Corners([[i32; 9]; 3]);

impl Corners {
    /// Of the node with corners `p` and inserted vertices `q`.
    #[inline(always)]
    pub fn of([p0, p1, p2]: [Point; 3], [q0, q1, q2]: [Point; 3]) -> Self {
        let mut corners = Self::default();
        for (at, of) in [p0, p1, p2, q0, q1, q2, q0, q1, q2].into_iter().enumerate() {
            let [x, y, z] = &mut corners.0;
            (x[at], y[at], z[at]) = (of.x.narrow(), of.y.narrow(), of.z.narrow());
        }
        corners
    }

    /// The triangle of child `k`, as [`child_triangle`](super::tessellate::child_triangle) has it: read from memory, since which child it is is what no predictor knows.
    #[inline(always)]
    pub fn child(&self, k: usize) -> [Point; 3] {
        const PLACES: [[usize; 3]; 4] = [[0, 5, 4], [5, 1, 3], [4, 3, 2], [3, 4, 5]];
        let ([x, y, z], [a, b, c]) = (&self.0, PLACES[k]);
        let point = |at: usize| Point::from_i32([x[at], y[at], z[at]]);
        [point(a), point(b), point(c)]
    }

    /// A corner of child `k` along an axis each.
    #[inline(always)]
    fn along(&self, axis: usize, k: usize) -> [i32; 3] {
        let of = &self.0[axis];
        [of[k], of[4 + k], of[5 + k]]
    }
}

/// Planes of the boxes of the children, or their steps: lower x, y, z and upper x, y, z; in codes.
pub type Planes = [Four; 6];

/// A plane of a box in a frame that starts at `origin`.
#[inline(always)]
pub(super) fn framed_plane(origin: i32, steps: i32) -> i32 {
    // 16 and 24 bits.
    (origin + steps).min(MOST)
}

/// The boxes of the children of a quad-BVH node.
#[inline(always)]
pub fn framed(origin: [i32; 3], steps: &Planes) -> Planes {
    let mut planes = Planes::default();
    for (at, (planes, steps)) in planes.iter_mut().zip(steps).enumerate() {
        for k in 0..4 {
            planes[k] = framed_plane(origin[at % 3], steps[k]);
        }
    }
    planes
}

#[inline(always)]
fn least([a, b, c]: [i32; 3]) -> i32 {
    a.min(b).min(c) >> BOX_SHIFT
}

#[inline(always)]
fn most([a, b, c]: [i32; 3]) -> i32 {
    // Floor and ceiling are monotone: one shift behind minimum and maximum. At most ceil(COORD_LIMIT / 2^16) = 32766.
    (a.max(b).max(c) + ((1 << BOX_SHIFT) - 1)) >> BOX_SHIFT
}

/// The boxes of the children of a tree's node with this full-resolution triangle, let out by their steps.
#[inline(always)]
pub fn let_out(steps: &Planes, full: &Corners) -> Planes {
    let mut planes = Planes::default();
    for axis in 0..3 {
        for k in 0..4 {
            planes[axis][k] = (least(full.along(axis, k)) - steps[axis][k]).max(-MOST);
        }
        for k in 0..4 {
            planes[axis + 3][k] = (most(full.along(axis, k)) + steps[axis + 3][k]).min(MOST);
        }
    }
    planes
}

/// These boxes widened by the triangle as morphed; if it is the full-resolution one, they stay what they are.
#[inline(always)]
pub fn widened(boxes: Planes, morphed: &Corners) -> Planes {
    let mut planes = boxes;
    for axis in 0..3 {
        for (k, plane) in planes[axis].iter_mut().enumerate() {
            *plane = (*plane).min(least(morphed.along(axis, k)));
        }
        for (k, plane) in planes[axis + 3].iter_mut().enumerate() {
            *plane = (*plane).max(most(morphed.along(axis, k)));
        }
    }
    planes
}

/// The boxes with these planes.
#[inline(always)]
pub fn boxed(planes: &Planes) -> [Box16; 4] {
    let mut codes = [[0; 4]; 6];
    for (codes, planes) in codes.iter_mut().zip(planes) {
        for k in 0..4 {
            codes[k] = i64::from(planes[k]);
        }
    }
    // Behind this the compiler finds them in memory, four in a row, and goes on in lanes; otherwise it takes them apart and puts them together again.
    let codes = std::hint::black_box(codes);
    let code = |at: usize, k: usize| S::new(codes[at][k]);
    let bounds = |k: usize| Box16 {
        lo: Vec3 { x: code(0, k), y: code(1, k), z: code(2, k) },
        hi: Vec3 { x: code(3, k), y: code(4, k), z: code(5, k) },
    };
    [bounds(0), bounds(1), bounds(2), bounds(3)]
}

/// Bits of a box code, of a code with whether it is to be rounded up, of steps times two or three, of steps in codes, and of a code less or plus them.
const CODE: u32 = 16;
const STICKY: u32 = CODE + 1;
const DOUBLED: u32 = 7;
const STEPS: u32 = 16;
const SUM: u32 = CODE + 2;

impl ChildBoxes {
    /// Registers with a tag of so many bits: corners and pairs of inserted vertices, least and largest of each child, boxes.
    pub(super) fn registers(form: &Form, tag: u32) -> Registers {
        // Of both triangles, along each axis, three corners and three pairs of inserted vertices, and which of the first of them is less.
        let pairs = 2 * 3 * (3 * (STICKY + CODE + STICKY) + 1) + 24 * DOUBLED + 3 * 4 + 1;
        // Planes of the full-resolution triangle with its excess, and of the morphed one.
        let ends = 24 * (SUM + CODE) + 1;
        // Where nothing is morphed there is one triangle, and at the end it does not matter of what the boxes are.
        let [second, widens] = if form.lod_test { [0, 0] } else { [3 * (3 * (STICKY + CODE + STICKY) + 1), 24 * CODE + 1] };
        Registers::stage(pairs + tag).without(second) + Registers::stage(ends + tag).without(widens) + Registers::skid(4 * 6 * CODE + tag)
    }
}

impl Block for ChildBoxes {
    const NAME: &'static str = "child_boxes";
    const TIMING: Timing = Timing::pipelined(3);
    type In = In;
    type Out = Out;
    fn parts(form: &Form) -> Parts {
        let triangles = if form.lod_test { 2 } else { 1 };
        let (pairs, ends, planes) = (triangles * 3 * 3 * (CODE + STICKY), triangles * 4 * 3 * (CODE + STICKY), 24);
        let widened = planes * (triangles - 1);
        Parts {
            products: vec![],
            // Comparisons of pairs and of them with single corners; steps and a half; sums, and their comparison with the morphed triangle.
            add_bits: pairs + ends + planes * (DOUBLED + STEPS) + widened * STEPS,
            // The same; shifts in four steps; the frame or the triangle, and which of three.
            select_bits: pairs + ends + planes * (4 * STEPS + CODE + CODE) + widened * CODE,
            registers: Self::registers(form, TAG),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let exponents = i.exponents.map(U::narrow).map(i32::cast_unsigned);
        let origin = [i.origin.x.narrow(), i.origin.y.narrow(), i.origin.z.narrow()];
        let mut reach = Planes::default();
        for (at, reach) in reach.iter_mut().enumerate() {
            let axis = at % 3;
            // Below 2^22.
            let steps = |plane: U<5>| box_steps(i.halves[axis], exponents[axis], plane.narrow().cast_unsigned()).cast_signed();
            *reach = [0, 1, 2, 3].map(|k| steps(i.planes[6 * k + at]));
        }
        let planes = if i.tree {
            let (full, morphed) =
                (Corners::of([i.f0, i.f1, i.f2], [i.g0, i.g1, i.g2]), Corners::of([i.p0, i.p1, i.p2], [i.q0, i.q1, i.q2]));
            widened(let_out(&reach, &full), &morphed)
        } else {
            framed(origin, &reach)
        };
        Out { bounds: boxed(&planes) }
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
            let reach: Planes = std::array::from_fn(|at| std::array::from_fn(|k| steps[6 * k + at] >> bits));
            let (full, morphed) = (Corners::of(f, g), Corners::of(p, q));
            let own = let_out(&reach, &full);
            prop_assert_eq!(widened(own, &full), own);
            let out = boxed(&widened(own, &morphed));
            for k in 0..4 {
                let of = |corners: [Point; 3]| Box16::of_points(&corners.map(|c| c.get().map(|c| i32::try_from(c).unwrap())));
                let triangles = (child_triangle(f, g, k), child_triangle(p, q, k));
                prop_assert_eq!((full.child(k), morphed.child(k)), triangles);
                let (own, morphed) = (of(triangles.0), of(triangles.1));
                for c in 0..3 {
                    let low = (own.lo.get()[c] - i64::from(reach[c][k])).max(-32_767).min(morphed.lo.get()[c]);
                    let high = (own.hi.get()[c] + i64::from(reach[c + 3][k])).min(32_767).max(morphed.hi.get()[c]);
                    prop_assert_eq!((out[k].lo.get()[c], out[k].hi.get()[c]), (low, high));
                }
            }
        }
    }
}
