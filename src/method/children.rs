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
