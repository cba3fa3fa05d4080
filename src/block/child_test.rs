//! The four children of a node against a ray: their boxes, tested and sorted (paper figure 9).
//!
//! [`ChildBoxes`], four [`BoxTest`] (or fewer, through which the children go in turn) and one [`ChildSort`] in a row. A child that is not present is never hit. (Software runs the same parts lane by lane:
//! `src/method/children.rs`.)
//! Legal: what the parts ask for.

use super::box_test::{self, BoxTest};
use super::child_boxes::{self, ChildBoxes};
use super::child_sort::{self, ChildSort};
use super::parts::{Parts, Registers, TAG};
use super::ray_setup;
use super::{Block, BoxesPerCycle, Form, Timing};
use crate::num::{Point, RayT, T_NEAR_TO_T_SHIFT, TNear, U, Vec3, Wire, wire_struct};

wire_struct! {
    /// Input of [`ChildTest`].
    pub struct In {
        /// The ray's constants.
        ray: ray_setup::Out,
        /// t of the closest hit so far.
        t_max: RayT,
        /// Child k exists.
        present: [bool; 4],
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
        /// Corner p0 of full resolution of the parent.
        f0: Point,
        /// Corner p1 of full resolution.
        f1: Point,
        /// Corner p2 of full resolution.
        f2: Point,
        /// Its inserted vertex of full resolution on (p1, p2).
        g0: Point,
        /// On (p2, p0).
        g1: Point,
        /// On (p0, p1).
        g2: Point,
        /// Corner p0 of the parent as morphed for this ray.
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

impl ChildTest {
    /// Timing of the RTL with so many box tests (its parameter `BOXES_PER_CYCLE`): each pass but the first takes a cycle more.
    pub const fn with_boxes(boxes: BoxesPerCycle) -> Timing {
        let passes = boxes.passes(4);
        let latency = ChildBoxes::TIMING.latency + BoxTest::TIMING.latency + ChildSort::TIMING.latency + passes - 1;
        Timing { latency, interval: passes }
    }
}

impl Block for ChildTest {
    const NAME: &'static str = "child_test";
    const TIMING: Timing = Self::with_boxes(Form::FULL.boxes_per_cycle);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        Self::with_boxes(form.boxes_per_cycle)
    }
    fn parts(form: &Form) -> Parts {
        let (boxes, test, sort) = (ChildBoxes::parts(form), BoxTest::parts(form), ChildSort::parts(form));
        let (boxed, tested) = (ChildBoxes::TIMING.latency, BoxTest::TIMING.latency);
        // The ray beside the boxes: 16-bit boxes need neither the origins nor what t_near leaves of t_max, nor zeros of directions and moments.
        let zeros = 3 * form.direction_zeros + 3 * (form.coordinate_zeros + form.direction_zeros);
        let unread = 3 * (Point::WIDTH / 3) + T_NEAR_TO_T_SHIFT + zeros;
        let ray = Registers::line(ray_setup::Out::WIDTH + RayT::WIDTH + 4 + TAG, boxed, 1).without((boxed + 1) * unread);
        // A tag of one bit for which there is no use, in each of their registers; that of the first box test is of use.
        let bounds = ChildBoxes::registers(form, 1).without(boxed + 1);
        let (side_by_side, passes) = (form.boxes_per_cycle.side_by_side(4), form.boxes_per_cycle.passes(4));
        let child = BoxTest::registers(form, 1).without(tested + 1);
        let pass = passes.ilog2();
        let first = BoxTest::registers(form, TAG + side_by_side + pass);
        // Which pass it is, and how many cycles until the next node; children that wait for the last pass.
        let turns = Registers::bits(2 * pass + (4 - side_by_side) * (1 + TNear::WIDTH));
        let tests = first + (side_by_side - 1) * child + turns;
        Parts {
            products: test.products.iter().map(|&[count, a, b]| [4 * count, a, b]).collect(),
            add_bits: boxes.add_bits + 4 * test.add_bits + sort.add_bits,
            select_bits: boxes.select_bits + 4 * test.select_bits + sort.select_bits,
            // The distances pass through the sort as its tag.
            registers: ray + bounds + tests.in_turns(passes) + ChildSort::registers(4 * TNear::WIDTH + TAG),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let &In { tree, origin, halves, exponents, planes, .. } = i;
        let &In { f0, f1, f2, g0, g1, g2, p0, p1, p2, q0, q1, q2, .. } = i;
        let boxes = child_boxes::In { tree, origin, halves, exponents, planes, f0, f1, f2, g0, g1, g2, p0, p1, p2, q0, q1, q2 };
        let bounds = ChildBoxes::eval(&boxes).bounds;
        let mut tests = child_sort::In::default();
        for (k, bounds) in bounds.into_iter().enumerate() {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::ray_setup::RaySetup;
    use crate::num::{Direction, Random};

    #[test]
    fn present_children_that_are_met_come_by_their_distance() {
        let mut met = [0; 5];
        for number in 0..2_000 {
            let mut random = Random::of(5, number);
            let mut input = In { t_max: RayT::MAX, exponents: [U::new(7); 3], ..In::default() };
            let corner = [(); 3].map(|()| random.within(8_000));
            input.origin = Vec3::new(corner[0], corner[1], corner[2]);
            input.present = [(); 4].map(|()| random.below(4) > 0);
            for (at, plane) in input.planes.iter_mut().enumerate() {
                let (upper, step) = (at % 6 >= 3, random.below(16));
                *plane = U::new(if upper { 16 + step } else { step });
            }
            // From outside through the frame, whose steps are 128 codes, or past it.
            let d = [(); 3].map(|()| random.within(1 << 28));
            let x: [i64; 3] = std::array::from_fn(|k| ((corner[k] + 2_048 + random.within(2_500)) << 16) - 4 * d[k]);
            let (origin, direction) = (Point::new(x[0], x[1], x[2]), Direction::new(d[0], d[1], d[2]));
            input.ray = RaySetup::eval(&ray_setup::In { origin, direction });

            let In { ray, t_max, origin, exponents, planes, .. } = input;
            let boxes = ChildBoxes::eval(&child_boxes::In { origin, exponents, planes, ..Default::default() }).bounds;
            let tests = boxes.map(|bounds| BoxTest::eval(&box_test::In { ray, t_max, bounds }));
            let mut wanted: Vec<usize> = (0..4).filter(|&k| input.present[k] && tests[k].hit).collect();
            wanted.sort_by_key(|&k| tests[k].t_near);
            let out = ChildTest::eval(&input);
            let order: Vec<usize> = out.order.iter().take(out.met() as usize).map(|k| k.get() as usize).collect();
            assert_eq!(order, wanted, "{number}");
            let distances: [TNear; 4] = std::array::from_fn(|k| if input.present[k] { tests[k].t_near } else { TNear::ZERO });
            assert_eq!(out.t_near, distances, "{number}");
            met[wanted.len()] += 1;
        }
        assert!(met.iter().all(|&count| count > 20), "{met:?}");
    }
}
