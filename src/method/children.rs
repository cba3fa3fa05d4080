//! The four children of a group against a ray: widened, tested side by side as in hardware, and sorted.
//!
//! All of it is written once, child by child. A compiler that may use 256-bit registers puts the four children into their lanes (one 32 x 32 -> 64-bit
//! multiplication per product of the four box tests), so on x86-64 the same code is compiled a second time for processors with AVX2.

use crate::block::Block;
use crate::block::box_test::{self, BoxTest};
use crate::block::child_sort;
use crate::block::child_test::{self, sort};
use crate::block::ray_setup;
use crate::block::tessellate::child_triangle;
use crate::block::widen_box::{self, WidenBox};
use crate::format::{BoundData, BvhChild, ChildRef};
use crate::num::{Point, RayT, Wire};

/// Triangle of a node: corners, and its inserted vertices as morphed for this ray.
#[derive(Clone, Copy, Default)]
pub(crate) struct Split {
    /// Corners.
    pub p: [Point; 3],
    /// Inserted vertices.
    pub q: [Point; 3],
}

/// Child `k` of a group of four 16-byte records.
#[inline(always)]
pub(crate) fn quarter<T: Wire>(group: &[u64; 8], k: usize) -> T {
    T::from_words(&group[2 * k..2 * k + 2])
}

/// Children of a quad-BVH node; an empty slot is never hit.
#[inline(always)]
fn bvh(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8], out: &mut child_test::Out) {
    let mut tests = child_sort::In::default();
    for k in 0..4 {
        let BvhChild { child, bounds } = quarter(group, k);
        let test = BoxTest::eval(&box_test::In { ray: *ray, t_max, bounds });
        tests.hit[k] = test.hit & (child.kind.get() != ChildRef::EMPTY);
        tests.t_near[k] = test.t_near;
    }
    *out = sort(&tests);
}

/// Children of a tree's node (where nothing was morphed, widening changes nothing).
#[inline(always)]
fn tree(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8], split: &Split, out: &mut child_test::Out) {
    let mut tests = child_sort::In::default();
    for k in 0..4 {
        let BoundData { bounds, .. } = quarter(group, k);
        let [p0, p1, p2] = child_triangle(split.p, split.q, k);
        let bounds = WidenBox::eval(&widen_box::In { bounds, p0, p1, p2 }).bounds;
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
    /// Tests and sorts the children of the quad-BVH node `group`.
    bvh_children = bvh(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8])
}

side_by_side! {
    /// Tests and sorts the children of the tree's node with bound data `group` and triangle `split`.
    tree_children = tree(ray: &ray_setup::Out, t_max: RayT, group: &[u64; 8], split: &Split)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::child_test::ChildTest;
    use crate::block::ray_setup::RaySetup;
    use crate::num::{BOX_SHIFT, Box16, COORD_LIMIT, Direction, Random, S, U, Vec3, Wire};

    const LIMIT: u64 = COORD_LIMIT as u64;

    fn point(random: &mut Random, most: u64) -> Point {
        Point::from_i32([(); 3].map(|()| random.within(most) as i32))
    }

    /// A box of up to `2^bits` codes a side around the middle.
    fn bounds(random: &mut Random, bits: u64) -> Box16 {
        let a = [(); 3].map(|()| random.within(0x3FFF) as i32);
        let b = a.map(|v| v + random.within(1 << bits) as i32);
        let at = |pick: fn(i32, i32) -> i32| std::array::from_fn(|k| pick(a[k], b[k]).clamp(-32_766, 32_766) as i16);
        Box16::from_codes(at(i32::min), at(i32::max))
    }

    fn ray(random: &mut Random) -> ray_setup::Out {
        let mut d = [(); 3].map(|()| random.within(1 << 29));
        // Along planes and axes too.
        d[random.below(3) as usize] *= i64::from(random.below(4) > 0);
        d[0] += i64::from(d == [0; 3]);
        RaySetup::eval(&ray_setup::In { origin: point(random, LIMIT), direction: Direction::new(d[0], d[1], d[2]) })
    }

    fn group<T: Wire>(children: [T; 4]) -> [u64; 8] {
        let mut group = [0; 8];
        children.iter().zip(group.chunks_exact_mut(2)).for_each(|(child, words)| child.to_words(words));
        group
    }

    /// The scalar bodies, which a processor with AVX2 never runs otherwise, and what it does run, against the hardware's block.
    #[test]
    fn side_by_side_and_one_by_one_are_the_block() {
        let mut met = [0u64; 5];
        let mut early = 0u64;
        for number in 0..200_000 {
            let mut random = Random::of(9, number);
            let (ray, bits) = (ray(&mut random), random.below(16));
            let t_max = if random.below(2) == 0 { RayT::MAX } else { RayT::new(RayT::MAX.get() >> random.below(8)) };
            let boxes: [Box16; 4] = std::array::from_fn(|_| bounds(&mut random, bits));
            let kinds = [(); 4].map(|()| random.below(3));
            let children = std::array::from_fn(|k| BvhChild {
                child: ChildRef { kind: U::new(kinds[k]), ..ChildRef::inner(k as u32) },
                bounds: boxes[k],
            });
            let nodes = group(children);
            let none = [Point::default(); 3];
            let block = |present, widen, p: [Point; 3], q: [Point; 3], t_max| {
                let ([p0, p1, p2], [q0, q1, q2]) = (p, q);
                ChildTest::eval(&child_test::In { ray, t_max, present, bounds: boxes, widen, p0, p1, p2, q0, q1, q2 })
            };
            let wanted = block(kinds.map(|kind| kind != ChildRef::EMPTY), false, none, none, t_max);
            let mut scalar = child_test::Out::default();
            bvh(&ray, t_max, &nodes, &mut scalar);
            // Of a child that is not there no distance is read.
            let seen = |out: &child_test::Out| {
                (out.count, out.order, (0..out.met() as usize).map(|k| out.t_near[out.order[k].get() as usize]).collect::<Vec<_>>())
            };
            assert_eq!(seen(&scalar), seen(&wanted), "{number}");
            assert_eq!(bvh_children(&ray, t_max, &nodes), scalar, "{number}");
            met[wanted.met() as usize] += 1;

            let split = Split { p: [(); 3].map(|()| point(&mut random, LIMIT)), q: [(); 3].map(|()| point(&mut random, LIMIT)) };
            // Nothing morphed beyond the box, or nearly so, in half of the cases.
            let split = if random.below(2) == 0 { split } else { Split { p: [corner(&boxes[0]); 3], q: [corner(&boxes[0]); 3] } };
            let nodes = group(boxes.map(|bounds| BoundData { bounds, ..BoundData::default() }));
            let wanted = block([true; 4], true, split.p, split.q, t_max);
            let mut scalar = child_test::Out::default();
            tree(&ray, t_max, &nodes, &split, &mut scalar);
            assert_eq!(scalar, wanted, "{number}");
            assert_eq!(tree_children(&ray, t_max, &nodes, &split), scalar, "{number}");
            met[wanted.met() as usize] += 1;
            early += u64::from(wanted != block([true; 4], true, split.p, split.q, RayT::MAX));
        }
        assert!(met.iter().all(|&count| count > 2_000) && early > 2_000, "{met:?}, {early} ended early");
        #[cfg(target_arch = "x86_64")]
        println!("{met:?}, {early} ended early; AVX2: {}", std::arch::is_x86_feature_detected!("avx2"));
    }

    fn corner(bounds: &Box16) -> Point {
        let units = |code: S<16>| S::new(code.get() << BOX_SHIFT);
        Vec3 { x: units(bounds.lo.x), y: units(bounds.lo.y), z: units(bounds.lo.z) }
    }
}
