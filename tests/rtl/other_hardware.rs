//! The blocks of other hardware than the default: from the package that it prints, with its timings.

use crate::suite::Suite;
use crate::{
    bary_map, bound_decode, box_decode, box_decode8, box_test, box_test32, child_boxes, child_prisms, child_sort, child_sort6, child_test,
    hit_divide, hit_select, lod_test, node_address, ray_setup, tessellate, traversal_stack, tri_test,
};
use lodray::block::{self, Block};
use lodray::hardware::Hardware;
use lodray::num::U;
use lodray_test_support::hardware::{FULL_DETAIL, MIDDLE, OTHERS, SHALLOW, SMALL};
use std::fmt::Debug;
use tb::Mode;

/// Enough for every event and spread.
const TRANSACTIONS: u64 = 100_000;

/// The block of each of these, its suite made for so many levels.
fn play<B: Block>(hardware: &[Hardware], suite: impl Fn(u64) -> Suite<B>)
where
    B::In: Debug,
    B::Out: Debug,
{
    for &hardware in hardware {
        let suite = suite(u64::from(hardware.levels)).of(hardware);
        suite.run_some(Mode::Free, TRANSACTIONS);
        suite.run_some(Mode::Stalled, TRANSACTIONS);
    }
}

#[test]
fn blocks_that_depend_on_the_levels() {
    play(&OTHERS, bary_map::suite);
    play(&OTHERS, hit_select::suite);
    play(&OTHERS, node_address::suite);
    for &hardware in &OTHERS {
        let zeros = u64::from(hardware.coordinate_zeros);
        let suite = |levels| {
            let suite = tessellate::suite(levels, zeros);
            let has_all = hardware.compact_vertices && hardware.exact_vertices && hardware.chooses_levels();
            if has_all { suite } else { suite.coarsened(tessellate::of_less(&hardware)) }
        };
        play(&[hardware], suite);
    }
    OTHERS.iter().for_each(|hardware| traversal_stack::play(hardware, TRANSACTIONS));
}

#[test]
fn blocks_that_depend_on_features() {
    play(&[SHALLOW], |_| {
        lod_test::suite().coarsened(|mut i, _| {
            i.ray.cone.offset = U::ZERO;
            i
        })
    });
    play(&[FULL_DETAIL], |_| {
        child_boxes::suite().coarsened(|i, _| block::child_boxes::In { p0: i.f0, p1: i.f1, p2: i.f2, q0: i.g0, q1: i.g1, q2: i.g2, ..i })
    });
    play(&[FULL_DETAIL], |_| {
        child_test::suite().coarsened(|i, _| block::child_test::In { p0: i.f0, p1: i.f1, p2: i.f2, q0: i.g0, q1: i.g1, q2: i.g2, ..i })
    });
    play(&[FULL_DETAIL], |_| child_prisms::suite().coarsened(|i, _| block::child_prisms::In { morphed: i.full, ..i }));
}

#[test]
fn blocks_that_divide() {
    // One and two bits a cycle; the default's three are in the suites' own tests.
    play(&[SMALL, MIDDLE], |_| hit_divide::suite());
    play(&[SMALL, MIDDLE], |_| ray_setup::suite());
}

#[test]
fn blocks_that_do_not() {
    // Of one of the others: the text of these is the same for all but for the edges of `tri_test`.
    play(&[SMALL], |_| bound_decode::suite());
    play(&[SMALL], |_| box_decode::suite());
    play(&[SMALL], |_| box_decode8::suite());
    play(&[SMALL], |_| box_test::suite());
    play(&[SMALL], |_| box_test32::suite());
    play(&[SMALL], |_| child_boxes::suite());
    play(&[SMALL], |_| child_prisms::suite());
    play(&[SMALL], |_| child_sort::suite());
    play(&[SMALL], |_| child_sort6::suite());
    play(&[SMALL], |_| child_test::suite());
    play(&[SMALL], |_| lod_test::suite());
    play(&[SMALL], |_| tri_test::suite());
}
