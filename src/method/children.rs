//! The four children of a group against a ray: widened, tested side by side as in hardware, and sorted.
//!
//! All of it is written once, child by child. A compiler that may use 256-bit registers puts the four children into their lanes (one 32 x 32 -> 64-bit
//! multiplication per product of the four box tests), so on x86-64 the same code is compiled a second time for processors with AVX2.

use crate::block::Block;
use crate::block::box_test::{self, BoxTest};
use crate::block::child_boxes::{Reach, framed, widened};
use crate::block::child_sort;
use crate::block::child_test::{self, sort};
use crate::block::ray_setup;
use crate::format::{BvhChild, BvhNode, ChildRef, Line, SiblingGroup};
use crate::num::{BoxStep, Point, RayT, Wire};

/// Triangle of a node: corners and inserted vertices, of full resolution and as morphed for this ray.
#[derive(Clone, Copy, Default)]
pub(crate) struct Split {
    /// Corners of full resolution.
    pub f: [Point; 3],
    /// Corners as morphed.
    pub p: [Point; 3],
    /// Inserted vertices of full resolution.
    pub g: [Point; 3],
    /// Inserted vertices as morphed.
    pub q: [Point; 3],
}

/// Child `k` of a group of four 16-byte records.
#[inline(always)]
pub(crate) fn quarter<T: Wire>(group: &[u64; 8], k: usize) -> T {
    T::from_words(&group[2 * k..2 * k + 2])
}

/// Planes of a child in codes.
#[inline(always)]
fn reach(steps: &[BoxStep; 3], planes: [u32; 6]) -> Reach {
    let codes = |axis: usize, at: usize| steps[axis].codes(planes[at]) as i32; // below 2^24
    Reach { lo: [codes(0, 0), codes(1, 1), codes(2, 2)], hi: [codes(0, 3), codes(1, 4), codes(2, 5)] }
}

/// Children of a quad-BVH node in its own frame; an empty slot is never hit.
#[inline(always)]
fn bvh(ray: &ray_setup::Out, t_max: RayT, line: &Line, out: &mut child_test::Out) {
    let mut tests = child_sort::In::default();
    let (origin, steps) = (BvhNode::line_origin(line), BvhNode::line_steps(line));
    for k in 0..4 {
        let bounds = framed(origin, reach(&steps, BvhNode::line_planes(line, k)));
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit & (BvhNode::line_kind(line, k) != ChildRef::EMPTY);
        tests.t_near[k] = test.t_near;
    }
    *out = sort(&tests);
}

/// Children of a quad-BVH node with boxes of 16-bit codes; an empty slot is never hit.
#[inline(always)]
fn coded(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8], out: &mut child_test::Out) {
    let mut tests = child_sort::In::default();
    for k in 0..4 {
        let BvhChild { child, bounds } = quarter(group, k);
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit & (child.kind.get() != ChildRef::EMPTY);
        tests.t_near[k] = test.t_near;
    }
    *out = sort(&tests);
}

/// Children of a tree's node.
#[inline(always)]
fn tree(ray: &ray_setup::Out, t_max: RayT, line: &Line, split: &Split, out: &mut child_test::Out) {
    let mut tests = child_sort::In::default();
    let steps = SiblingGroup::line_steps(line);
    let reach = [0, 1, 2, 3].map(|k| reach(&steps, SiblingGroup::line_planes(line, k)));
    let boxes = widened(&reach, [split.f, split.g, split.p, split.q]);
    for (k, bounds) in boxes.into_iter().enumerate() {
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit;
        tests.t_near[k] = test.t_near;
    }
    *out = sort(&tests);
}

/// Declares `$name`, which does what `$body` does, compiled for AVX2 where the processor has it.
macro_rules! side_by_side {
    ($(#[$doc:meta])* $name:ident = $body:ident($($arg:ident: $ty:ty),*)) => {
        $(#[$doc])*
        #[inline(always)]
        pub(crate) fn $name($($arg: $ty),*) -> child_test::Out {
            // Written through a reference: that the results lie side by side in memory is what starts the compiler's search for lanes.
            let mut out = child_test::Out::default();
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                fn avx2($($arg: $ty),*, out: &mut child_test::Out) {
                    $body($($arg),*, out);
                }
                if std::arch::is_x86_feature_detected!("avx2") {
                    // SAFETY: the processor has AVX2, as was just asked.
                    unsafe { avx2($($arg),*, &mut out) };
                    return out;
                }
            }
            $body($($arg),*, &mut out);
            out
        }
    };
}

side_by_side! {
    /// Tests and sorts the children of the quad-BVH node `line`, whose boxes lie in its frame.
    bvh_children = bvh(ray: &ray_setup::Out, t_max: RayT, line: &Line)
}

side_by_side! {
    /// Tests and sorts the children of the quad-BVH node `group` with boxes of 16-bit codes.
    coded_children = coded(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8])
}

side_by_side! {
    /// Tests and sorts the children of the tree's node with sibling group `line` and triangle `split`.
    tree_children = tree(ray: &ray_setup::Out, t_max: RayT, line: &Line, split: &Split)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::child_test::ChildTest;
    use crate::block::ray_setup::RaySetup;
    use crate::num::{COORD_LIMIT, Direction, Random, U, Vec3};

    const LIMIT: u64 = COORD_LIMIT as u64;

    fn point(random: &mut Random, most: u64) -> Point {
        Point::from_i32([(); 3].map(|()| random.within(most) as i32))
    }

    fn ray(random: &mut Random) -> ray_setup::Out {
        let mut d = [(); 3].map(|()| random.within(1 << 29));
        // Along planes and axes too.
        d[random.below(3) as usize] *= i64::from(random.below(4) > 0);
        d[0] += i64::from(d == [0; 3]);
        RaySetup::eval(&ray_setup::In { origin: point(random, LIMIT), direction: Direction::new(d[0], d[1], d[2]) })
    }

    /// A line of a record with exponents that leave boxes of use.
    fn line<T: Wire>(random: &mut Random, change: impl FnOnce(&mut T, &mut Random)) -> Line {
        let mut record = T::from_words(&[(); 4].map(|()| random.next()));
        change(&mut record, random);
        let mut line = [0; 4];
        record.to_words(&mut line);
        line
    }

    /// The scalar bodies, which a processor with AVX2 never runs otherwise, and what it does run, against the hardware's block.
    #[test]
    fn side_by_side_and_one_by_one_are_the_block() {
        let mut met = [0u64; 5];
        let mut early = 0u64;
        for number in 0..200_000 {
            let mut random = Random::of(9, number);
            let ray = ray(&mut random);
            let t_max = if random.below(2) == 0 { RayT::MAX } else { RayT::new(RayT::MAX.get() >> random.below(8)) };
            let exponents = [(); 3].map(|()| U::new(random.below(13)));

            let node = line(&mut random, |node: &mut BvhNode, random| {
                node.exponents = exponents;
                node.origin = Vec3::new(random.within(32_767), random.within(32_767), random.within(32_767));
                node.kinds = [(); 4].map(|()| U::new(random.below(3)));
                // Inside in.
                for at in (0..24).filter(|at| at % 6 < 3) {
                    let [a, b] = [node.planes[at], node.planes[at + 3]];
                    (node.planes[at], node.planes[at + 3]) = (a.min(b), a.max(b));
                }
            });
            let record = BvhNode::from_words(&node);
            let BvhNode { origin, halves, exponents, .. } = record;
            let of_node = child_test::In {
                ray,
                t_max,
                present: record.kinds.map(|kind| kind.get() != ChildRef::EMPTY),
                origin,
                halves,
                exponents,
                planes: record.planes.map(|plane| U::new(plane.get())),
                ..child_test::In::default()
            };
            let wanted = ChildTest::eval(&of_node);
            let mut scalar = child_test::Out::default();
            bvh(&ray, t_max, &node, &mut scalar);
            // Of a child that is not there no distance is read.
            let seen = |out: &child_test::Out| {
                (out.count, out.order, (0..out.met() as usize).map(|k| out.t_near[out.order[k].get() as usize]).collect::<Vec<_>>())
            };
            assert_eq!(seen(&scalar), seen(&wanted), "{number}");
            assert_eq!(bvh_children(&ray, t_max, &node), scalar, "{number}");
            met[wanted.met() as usize] += 1;

            let mut group = [0; 8];
            for (k, words) in group.chunks_exact_mut(2).enumerate() {
                let child = ChildRef { kind: record.kinds[k], ..ChildRef::inner(k as u32) };
                BvhChild { child, bounds: record.bounds(k) }.to_words(words);
            }
            assert_eq!(coded_children(&ray, t_max, &group), scalar, "{number}");
            let mut one = child_test::Out::default();
            coded(&ray, t_max, &group, &mut one);
            assert_eq!(one, scalar, "{number}");

            // Triangles of all sizes, morphed a little or beyond the box.
            let (middle, bits) = (point(&mut random, LIMIT / 2), random.below(30));
            let mut near = || {
                let by = point(&mut random, LIMIT / 2).get().map(|c| c >> bits);
                Point::from_i32(std::array::from_fn(|c| (middle.get()[c] + by[c]) as i32))
            };
            let mut three = || [(); 3].map(|()| near());
            let split = Split { f: three(), p: three(), g: three(), q: three() };
            let split = if number % 2 == 0 { split } else { Split { p: split.f, q: split.g, ..split } };
            let siblings = line(&mut random, |group: &mut SiblingGroup, _| group.exponents = exponents);
            let SiblingGroup { halves, exponents, planes, .. } = SiblingGroup::from_words(&siblings);
            let Split { f: [f0, f1, f2], p: [p0, p1, p2], g: [g0, g1, g2], q: [q0, q1, q2] } = split;
            let present = [true; 4];
            let of_tree = child_test::In {
                ray,
                t_max,
                present,
                tree: true,
                origin: Vec3::default(),
                halves,
                exponents,
                planes,
                f0,
                f1,
                f2,
                g0,
                g1,
                g2,
                p0,
                p1,
                p2,
                q0,
                q1,
                q2,
            };
            let wanted = ChildTest::eval(&of_tree);
            let mut scalar = child_test::Out::default();
            tree(&ray, t_max, &siblings, &split, &mut scalar);
            assert_eq!(scalar, wanted, "{number}");
            assert_eq!(tree_children(&ray, t_max, &siblings, &split), scalar, "{number}");
            met[wanted.met() as usize] += 1;
            early += u64::from(wanted != ChildTest::eval(&child_test::In { t_max: RayT::MAX, ..of_tree }));
        }
        assert!(met.iter().all(|&count| count > 2_000) && early > 2_000, "{met:?}, {early} ended early");
        #[cfg(target_arch = "x86_64")]
        println!("{met:?}, {early} ended early; AVX2: {}", std::arch::is_x86_feature_detected!("avx2"));
    }
}
