//! The four children of a group against a ray: widened, tested side by side as in hardware, and sorted.
//!
//! All of it is written once, four numbers at a time. A compiler that may use 256-bit registers puts the four children into their lanes (one 32 x 32 -> 64-bit
//! multiplication per product of the four box tests), so on x86-64 the loops of traversal are compiled a second time for processors that [have them](has_lanes).

use crate::block::Block;
use crate::block::box_test::{self, BoxTest};
use crate::block::box_test32::{self, BoxTest32};
use crate::block::child_boxes::{Corners, Planes, boxed, framed, let_out, widened};
use crate::block::child_prisms::{self, ChildPrisms};
use crate::block::child_sort;
use crate::block::child_sort6::{self, ChildSort6};
use crate::block::child_test::{self, sort};
use crate::block::ray_setup;
use crate::bvh::BvhChild32;
use crate::format::{BvhChild, BvhNode, ChildRef, Line, SixNode, SplitRecord};
use crate::num::prism::Prisms;
use crate::num::{Box16, BoxStep, RayT, TNear, U, Vec3, Wire};

/// Whether the processor has what `#[target_feature(enable = "avx2,bmi1,bmi2")]` asks for.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn has_lanes() -> bool {
    #[cfg(test)]
    if tests::WITHOUT_LANES.get() {
        return false;
    }
    std::arch::is_x86_feature_detected!("avx2")
        && std::arch::is_x86_feature_detected!("bmi1")
        && std::arch::is_x86_feature_detected!("bmi2")
}

/// Triangles of a node's children.
#[derive(Clone, Copy, Default)]
pub(crate) struct Split {
    /// Of full resolution.
    pub full: Corners,
    /// As morphed.
    pub morphed: Corners,
}

/// Child `k` of a group of four 16-byte records.
#[inline(always)]
pub(crate) fn quarter<T: Wire>(group: &[u64; 8], k: usize) -> T {
    T::from_words(&group[2 * k..2 * k + 2])
}

/// Planes of the children in codes.
#[inline(always)]
fn reach(steps: &[BoxStep; 3], planes: &[[u32; 4]; 6]) -> Planes {
    let mut reach = Planes::default();
    for (at, (reach, planes)) in reach.iter_mut().zip(planes).enumerate() {
        for k in 0..4 {
            reach[k] = steps[at % 3].codes(planes[k]) as i32; // below 2^24
        }
    }
    reach
}

/// Boxes of the children of the quad-BVH node `line`, which lie in its frame; those of empty slots are of no meaning.
#[inline(always)]
pub(crate) fn bvh_boxes(line: &Line) -> [Box16; 4] {
    boxed(&framed(BvhNode::line_origin(line), &reach(&BvhNode::line_steps(line), &BvhNode::line_planes(line))))
}

/// Tests and sorts the children of the quad-BVH node `line`, whose boxes lie in its frame; an empty slot is never hit.
#[inline(always)]
pub(crate) fn bvh_children(ray: &ray_setup::Out, t_max: RayT, line: &Line) -> child_test::Out {
    let mut tests = child_sort::In::default();
    for (k, bounds) in bvh_boxes(line).into_iter().enumerate() {
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit & (BvhNode::line_kind(line, k) != ChildRef::EMPTY);
        tests.t_near[k] = test.t_near;
    }
    sort(&tests)
}

/// Tests and sorts the children of the quad-BVH node `group` with boxes of 16-bit codes; an empty slot is never hit.
#[inline(always)]
pub(crate) fn coded_children(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8]) -> child_test::Out {
    let mut tests = child_sort::In::default();
    for k in 0..4 {
        let BvhChild { child, bounds } = quarter(group, k);
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit & (child.kind.get() != ChildRef::EMPTY);
        tests.t_near[k] = test.t_near;
    }
    sort(&tests)
}

/// Tests and sorts the children of the quad-BVH node `group` with boxes of 32 bits, for rays that leave a surface if `LEAVING`; an empty slot is never hit.
#[inline(always)]
pub(crate) fn wide_children<const LEAVING: bool>(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 16]) -> child_test::Out {
    let mut tests = child_sort::In::default();
    for k in 0..4 {
        let BvhChild32 { child, lo, hi } = BvhChild32::from_words(&group[4 * k..4 * k + 4]);
        if child.kind.get() != ChildRef::EMPTY {
            // What is ahead of a start is ahead of its whole point, if the box reaches as far down as the start's fraction can.
            let lo = if LEAVING { Vec3::new(lo.x.get() - 1, lo.y.get() - 1, lo.z.get() - 1) } else { lo };
            let test = BoxTest32::eval(&box_test32::In { ray: *ray, t_max, lo, hi });
            (tests.hit[k], tests.t_near[k]) = (test.hit, test.t_near);
        }
    }
    sort(&tests)
}

/// Tests and sorts the children of a node of six; an empty slot is never hit. With their entry distances.
#[inline(always)]
pub(crate) fn six_children(ray: &ray_setup::Out, t_max: RayT, node: &SixNode) -> (child_sort6::Out, [TNear; 6]) {
    let mut tests = child_sort6::In::default();
    for k in 0..6 {
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds: node.bounds(k) });
        tests.hit[k] = test.hit & (node.kinds[k].get() != ChildRef::EMPTY);
        tests.t_near[k] = test.t_near;
    }
    (ChildSort6::eval(&tests), tests.t_near)
}

/// Tests and sorts the children of the tree's node with split `line`, whose triangles are `split`.
#[inline(always)]
pub(crate) fn tree_children(ray: &ray_setup::Out, t_max: RayT, line: &Line, split: &Split) -> child_test::Out {
    let mut tests = child_sort::In::default();
    let reach = reach(&SplitRecord::line_steps(line), &SplitRecord::line_planes(line));
    let boxes = widened(let_out(&reach, &split.full), &split.morphed);
    for (k, bounds) in boxed(&boxes).into_iter().enumerate() {
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit;
        tests.t_near[k] = test.t_near;
    }
    sort(&tests)
}

/// Tests and sorts the children of a tree's node with these prisms, whose triangles are `split`. Apart from the loops of traversal, which are shorter without it.
#[inline(never)]
pub(crate) fn prism_children(ray: &ray_setup::Out, t_max: RayT, prisms: &Prisms, split: &Split) -> child_test::Out {
    let [full, morphed] = [&split.full, &split.morphed].map(|corners| {
        let [[p0, ..], [_, p1, _], [_, _, p2], q] = [0, 1, 2, 3].map(|k| corners.child(k));
        [p0, p1, p2, q[0], q[1], q[2]]
    });
    let planes = std::array::from_fn(|at| U::new(prisms.planes[at / 5][at % 5].into()));
    let (reach, height) = (U::new(prisms.reach.into()), U::new(prisms.height.into()));
    ChildPrisms::eval(&child_prisms::In { ray: *ray, t_max, reach, height, planes, full, morphed })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::child_test::ChildTest;
    use crate::block::ray_setup::RaySetup;
    use crate::format::Scene;
    use crate::mesh::procedural::{Options, Scene as Kinds};
    use crate::method::Method;
    use crate::num::{COORD_LIMIT, Direction, Point, Random};
    use crate::rays::{Camera, ModelSpace, Query, Sight, View};
    use crate::step::{Step, StepSink};
    use std::cell::Cell;

    thread_local! {
        /// This thread's rays go as by a processor without lanes.
        pub static WITHOUT_LANES: Cell<bool> = const { Cell::new(false) };
    }

    const LIMIT: u64 = COORD_LIMIT as u64;

    /// What an AVX2 processor does run, and what it does not run otherwise.
    macro_rules! both {
        ($name:ident($($arg:expr => $ty:ty),*)) => {{
            let plain = $name($($arg),*);
            #[cfg(target_arch = "x86_64")]
            if has_lanes() {
                #[target_feature(enable = "avx2,bmi1,bmi2")]
                fn lanes(of: ($($ty,)*)) -> child_test::Out {
                    both!(@spread $name of $($ty),*)
                }
                // SAFETY: the processor has them, as was just asked.
                assert_eq!(unsafe { lanes(($($arg,)*)) }, plain);
            }
            plain
        }};
        (@spread $name:ident $of:ident $a:ty, $b:ty, $c:ty) => { $name($of.0, $of.1, $of.2) };
        (@spread $name:ident $of:ident $a:ty, $b:ty, $c:ty, $d:ty) => { $name($of.0, $of.1, $of.2, $of.3) };
    }

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

    /// Compiled for any processor and for this one, against the hardware's block.
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
                planes: record.planes,
                ..child_test::In::default()
            };
            let wanted = ChildTest::eval(&of_node);
            let scalar = both!(bvh_children(&ray => &ray_setup::Out, t_max => RayT, &node => &Line));
            // Of a child that is not there no distance is read.
            let seen = |out: &child_test::Out| {
                (out.count, out.order, (0..out.met() as usize).map(|k| out.t_near[out.order[k].get() as usize]).collect::<Vec<_>>())
            };
            assert_eq!(seen(&scalar), seen(&wanted), "{number}");
            met[wanted.met() as usize] += 1;

            let mut group = [0; 8];
            for (k, words) in group.chunks_exact_mut(2).enumerate() {
                let child = ChildRef { kind: record.kinds[k], ..ChildRef::inner(k as u32) };
                BvhChild { child, bounds: record.bounds(k) }.to_words(words);
            }
            let coded = both!(coded_children(&ray => &ray_setup::Out, t_max => RayT, &group => &[u64; 8]));
            assert_eq!(coded, scalar, "{number}");

            // Triangles of all sizes, morphed a little or beyond the box.
            let (middle, bits) = (point(&mut random, LIMIT / 2), random.below(30));
            let mut near = || {
                let by = point(&mut random, LIMIT / 2).get().map(|c| c >> bits);
                Point::from_i32(std::array::from_fn(|c| (middle.get()[c] + by[c]) as i32))
            };
            let mut three = || [(); 3].map(|()| near());
            let full = [three(), three()];
            let morphed = if number % 2 == 0 { [three(), three()] } else { full };
            // Three steps at most: longer ones.
            let longer = exponents.map(|e| U::new((e.get() + 5).min(15)));
            let siblings = line(&mut random, |split: &mut SplitRecord, _| split.exponents = longer);
            let SplitRecord { halves, exponents, planes, .. } = SplitRecord::from_words(&siblings);
            let planes = planes.map(|plane| U::new(plane.get()));
            let ([[f0, f1, f2], [g0, g1, g2]], [[p0, p1, p2], [q0, q1, q2]]) = (full, morphed);
            let [full, morphed] = [full, morphed].map(|[corners, inserted]| Corners::of(corners, inserted));
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
            let split = Split { full, morphed };
            let out = both!(tree_children(&ray => &ray_setup::Out, t_max => RayT, &siblings => &Line, &split => &Split));
            assert_eq!(out, wanted, "{number}");
            met[wanted.met() as usize] += 1;
            early += u64::from(wanted != ChildTest::eval(&child_test::In { t_max: RayT::MAX, ..of_tree }));
        }
        assert!(met.iter().all(|&count| count > 2_000) && early > 2_000, "{met:?}, {early} ended early");
        #[cfg(target_arch = "x86_64")]
        println!("{met:?}, {early} ended early; lanes: {}", has_lanes());
    }

    /// What rays of a method meet from an eye, and from there on, with every step.
    fn journeys(method: &dyn Method, sight: &Sight, queries: &[Query]) -> (Vec<Step>, Vec<String>) {
        struct Kept(Vec<Step>);
        impl StepSink for Kept {
            fn step(&mut self, step: Step) {
                self.0.push(step);
            }
        }
        let (mut tracer, mut kept, mut met) = (method.tracer(sight), Kept(Vec::new()), Vec::new());
        for query in queries {
            let landing = tracer.enter(query, None, &mut kept);
            if let Some(landing) = &landing {
                let away = Query { direction: query.direction.map(|d| -d), ..*query };
                met.push(format!("{:?}", tracer.enter(&away, Some(&landing.departure), &mut kept)));
            }
            met.push(format!("{landing:?}"));
        }
        (kept.0, met)
    }

    #[test]
    fn rays_do_the_same_without_lanes() {
        let scene = Scene::generate(&Options { levels: Some(3), ..Options::new(Kinds::Terrain) }).unwrap();
        let space = ModelSpace::of(&scene);
        let camera = Camera::new(&View { distance: Some(1.5), ..View::default() }, &space, 32, 32).unwrap();
        let queries: Vec<Query> = (0..32 * 32).map(|pixel| camera.ray(pixel % 32, pixel / 32)).collect();
        for name in ["lod", "bvh", "grid"] {
            let method = scene.method(name).unwrap();
            for delta in [0.0, 1.0] {
                let sight = Sight::new(&camera, &space, delta);
                let with = journeys(method.method(), &sight, &queries);
                WITHOUT_LANES.set(true);
                let without = journeys(method.method(), &sight, &queries);
                WITHOUT_LANES.set(false);
                assert!(with == without, "{name}, delta {delta}");
                assert!(with.1.len() > 1200, "{name}, delta {delta}: {} of 1024 rays and those after them", with.1.len());
            }
        }
    }
}
