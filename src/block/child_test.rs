//! The four children of a node against a ray: boxes widened by their morphed triangles, tested, and sorted (paper figure 9).
//!
//! Four [`WidenBox`], four [`BoxTest`] and one [`ChildSort`] in a row. Children of a quad-BVH node have no triangles: `widen` is false and their
//! boxes stay as they are. A child that is not present is never hit. (Software runs the same parts lane by lane: `src/method/children.rs`.)
//! Legal: what the parts ask for.

use super::box_test::{self, BoxTest};
use super::child_sort::{self, ChildSort};
use super::parts::{Parts, Registers, TAG};
use super::ray_setup;
use super::tessellate::child_triangle;
use super::widen_box::{self, WidenBox};
use super::{Block, Form, Timing};
use crate::num::{Box16, Point, RayT, T_NEAR_TO_T_SHIFT, TNear, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`ChildTest`].
    pub struct In {
        /// The ray's constants.
        ray: ray_setup::Out,
        /// t of the closest hit so far.
        t_max: RayT,
        /// Child k exists.
        present: [bool; 4],
        /// Box of child k.
        bounds: [Box16; 4],
        /// Widen the boxes by the children of the triangle below.
        widen: bool,
        /// Corner p0 of the parent.
        p0: Point,
        /// Corner p1.
        p1: Point,
        /// Corner p2.
        p2: Point,
        /// Its inserted vertex on (p1, p2), as morphed for this ray.
        q0: Point,
        /// On (p2, p0).
        q1: Point,
        /// On (p0, p1).
        q2: Point,
    }
}

wire_struct! {
    /// Output of [`ChildTest`].
    pub struct Out {
        /// Number of children hit, 0 to 4.
        count: U<3>,
        /// Child numbers, nearest first.
        order: [U<2>; 4],
        /// Entry distance of child k; 0 if it is missed.
        t_near: [TNear; 4],
    }
}

impl Out {
    /// Number of children hit.
    #[inline(always)]
    #[expect(clippy::as_conversions, reason = "three bits")]
    pub fn met(&self) -> u32 {
        self.count.get() as u32
    }
}

/// The block.
pub struct ChildTest;

impl Block for ChildTest {
    const NAME: &'static str = "child_test";
    const TIMING: Timing = Timing::pipelined(WidenBox::TIMING.latency + BoxTest::TIMING.latency + ChildSort::TIMING.latency);
    type In = In;
    type Out = Out;
    fn parts(form: &Form) -> Parts {
        let (widen, test, sort) = (WidenBox::parts(form), BoxTest::parts(form), ChildSort::parts(form));
        let (widened, tested) = (WidenBox::TIMING.latency, BoxTest::TIMING.latency);
        // The ray beside the widening: 16-bit boxes need neither the origins nor what t_near leaves of t_max.
        let unread = 3 * (Point::WIDTH / 3) + T_NEAR_TO_T_SHIFT;
        let ray = Registers::line(ray_setup::Out::WIDTH + RayT::WIDTH + 4, widened, 1).without((widened + 1) * unread);
        // A tag of one bit for which there is no use, in each of their registers.
        let child = WidenBox::registers(1).without(widened + 1) + BoxTest::registers(1).without(tested + 1);
        let present = Registers::line(4, tested, 1);
        let tag = Registers::line(TAG, Self::TIMING.latency, 2);
        Parts {
            products: test.products.iter().map(|&[count, a, b]| [4 * count, a, b]).collect(),
            add_bits: 4 * (widen.add_bits + test.add_bits) + sort.add_bits,
            select_bits: 4 * (widen.select_bits + test.select_bits) + sort.select_bits,
            // The distances pass through the sort as its tag.
            registers: ray + 4 * child + present + ChildSort::registers(4 * TNear::WIDTH) + tag,
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let mut tests = child_sort::In::default();
        for k in 0..4 {
            let [p0, p1, p2] = child_triangle([i.p0, i.p1, i.p2], [i.q0, i.q1, i.q2], k);
            let stored = i.bounds[k];
            let bounds = if i.widen { WidenBox::eval(&widen_box::In { bounds: stored, p0, p1, p2 }).bounds } else { stored };
            let test = BoxTest::eval(&box_test::In { ray: i.ray, t_max: i.t_max, bounds });
            tests.hit[k] = test.hit & i.present[k];
            tests.t_near[k] = if i.present[k] { test.t_near } else { TNear::ZERO };
        }
        sort(&tests)
    }
}

/// The sorted children with their distances.
#[inline(always)]
pub fn sort(tests: &child_sort::In) -> Out {
    let sorted = ChildSort::eval(tests);
    Out { count: sorted.count, order: sorted.order, t_near: tests.t_near }
}
