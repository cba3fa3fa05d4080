//! Both box tests against exact rational slabs, with the nasty categories counted.

use lodray::block::Block;
use lodray::block::box_test::{self, BoxTest};
use lodray::block::box_test32::{self, BoxTest32};
use lodray::block::ray_setup::{self, RaySetup};
use lodray::num::{Box16, Direction, Point, RayT};
use lodray_test_support::cases;
use lodray_test_support::slabs::slabs;
use proptest::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

fn ray(x: [i64; 3], d: [i64; 3]) -> ray_setup::In {
    ray_setup::In { origin: Point::new(x[0], x[1], x[2]), direction: Direction::new(d[0], d[1], d[2]) }
}

/// What was tried, so that no category passes by being empty.
struct Tried {
    hits: AtomicU64,
    misses: AtomicU64,
    inside: AtomicU64,
    axis_parallel: AtomicU64,
    flat_boxes: AtomicU64,
}

impl Tried {
    const fn new() -> Self {
        Self {
            hits: AtomicU64::new(0),
            misses: AtomicU64::new(0),
            inside: AtomicU64::new(0),
            axis_parallel: AtomicU64::new(0),
            flat_boxes: AtomicU64::new(0),
        }
    }

    /// Prints the counts and fails unless each is at least `least`.
    fn report(&self, name: &str, least: u64) {
        let Self { hits, misses, inside, axis_parallel, flat_boxes } = self;
        let all = [("hits", hits), ("misses", misses), ("inside", inside), ("axis-parallel", axis_parallel), ("flat", flat_boxes)];
        for (kind, count) in all {
            let count = count.load(Relaxed);
            println!("{name}: {count} {kind}");
            assert!(count >= least, "{name}: only {count} {kind}");
        }
    }
}

fn check(out: box_test::Out, exact: Option<(i128, i128)>, name: &str) {
    assert_eq!(out.hit, exact.is_some(), "{name}");
    match exact {
        // t_near counts 2^16 units of 2^-30 of the direction: t_near 2^16 <= t 2^30.
        Some((n, m)) => assert!((i128::from(out.t_near.get()) << 16) * m <= n << 30, "{name}: t_near beyond the entry"),
        None => assert_eq!(out.t_near.get(), 0, "{name}"),
    }
}

/// A direction of nearly full length.
fn direction(v: [i64; 3]) -> Option<[i64; 3]> {
    let length = v.iter().map(|&c| (c as f64).powi(2)).sum::<f64>().sqrt();
    (length > 0.0).then(|| v.map(|c| (c as f64 / length * f64::from((1 << 30) - 1)).round() as i64))
}

fn both(x: [i64; 3], d: [i64; 3], codes: [[i64; 3]; 2], tried: &Tried) {
    let (lo, hi): ([i64; 3], [i64; 3]) =
        (std::array::from_fn(|k| codes[0][k].min(codes[1][k])), std::array::from_fn(|k| codes[0][k].max(codes[1][k])));
    let setup = RaySetup::eval(&ray(x, d));
    let units = |c: [i64; 3]| c.map(|v| v << 16);
    let exact = slabs(x, d, units(lo), units(hi));
    let count = |counter: &AtomicU64, yes: bool| counter.fetch_add(u64::from(yes), Relaxed);
    count(&tried.hits, exact.is_some());
    count(&tried.misses, exact.is_none());
    count(&tried.inside, (0..3).all(|k| units(lo)[k] <= x[k] && x[k] <= units(hi)[k]));
    count(&tried.axis_parallel, d.contains(&0));
    count(&tried.flat_boxes, (0..3).any(|k| lo[k] == hi[k]));
    let bounds = Box16::from_codes(lo.map(|v| v as i16), hi.map(|v| v as i16));
    check(BoxTest::eval(&box_test::In { ray: setup, t_max: RayT::MAX, bounds }), exact, "16 bits");
    let p = |c: [i64; 3]| Point::new(c[0], c[1], c[2]);
    check(BoxTest32::eval(&box_test32::In { ray: setup, t_max: RayT::MAX, lo: p(units(lo)), hi: p(units(hi)) }), exact, "32 bits");
    // The same walls moved off the 16-bit grid.
    let (lo, hi) = (units(lo).map(|v| v + 12_345), units(hi).map(|v| v + 54_321));
    check(
        BoxTest32::eval(&box_test32::In { ray: setup, t_max: RayT::MAX, lo: p(lo), hi: p(hi) }),
        slabs(x, d, lo, hi),
        "32 bits, unaligned",
    );
}

static ANYTHING: Tried = Tried::new();
static AIMED: Tried = Tried::new();

#[test]
fn random_boxes_and_rays() {
    anything();
    ANYTHING.report("anything", 1000);
    aimed_at_corners_faces_and_edges();
    AIMED.report("aimed", 100);
}

proptest! {
    #![proptest_config(cases(100_000))]

    fn anything(x in prop::array::uniform3(-0x7FFE_0040i64..=0x7FFE_0040), d in prop::array::uniform3(-1000i64..=1000), zero in 0u32..16,
                a in prop::array::uniform3(-32_766i64..=32_766), size in prop::array::uniform3(0i64..2000), shrink in 0u32..12) {
        let mut d = d;
        for (k, d) in d.iter_mut().enumerate() {
            if zero >> k & 1 == 1 { *d = 0; }
        }
        if let Some(d) = direction(d) {
            let b: [i64; 3] = std::array::from_fn(|k| (a[k] + (size[k] >> shrink)).min(32_766));
            // Every other ray starts in or near the box.
            let near = std::array::from_fn(|k| ((x[k] >> 8) + ((a[k] + b[k]) << 15)).clamp(-0x7FFE_0040, 0x7FFE_0040));
            both(if zero < 8 { x } else { near }, d, [a, b], &ANYTHING);
        }
    }

    fn aimed_at_corners_faces_and_edges(corner in prop::array::uniform3(-30_000i64..=30_000), size in prop::array::uniform3(0i64..4),
                                        step in prop::array::uniform3(-400i64..=400), steps in prop_oneof![0i64..8, 0i64..200_000], off in prop::array::uniform3(-1i64..=1), on in 0u32..3) {
        if step != [0; 3] {
            // Exactly through a corner, or one unit beside it.
            let length = step.iter().map(|&c| (c * c) as f64).sum::<f64>().sqrt();
            let d = step.map(|s| s * (f64::from((1 << 30) - 1) / length) as i64);
            let x: [i64; 3] = std::array::from_fn(|k| ((corner[k] << 16) - steps * step[k] + if on == 0 { off[k] } else { 0 }).clamp(-0x7FFE_0040, 0x7FFE_0040));
            both(x, d, [corner, std::array::from_fn(|k| corner[k] + size[k])], &AIMED);
        }
    }
}

#[test]
fn named_cases() {
    let one = (1 << 30) - 1;
    let (lo, hi) = ([-2i64, -2, -2], [2i64, 2, 2]);
    let at = |x: [i64; 3], d: [i64; 3], codes: [[i64; 3]; 2]| {
        let setup = RaySetup::eval(&ray(x, d));
        both(x, d, codes, &Tried::new());
        let bounds = Box16::from_codes(codes[0].map(|v| v as i16), codes[1].map(|v| v as i16));
        BoxTest::eval(&box_test::In { ray: setup, t_max: RayT::MAX, bounds }).hit
    };
    assert!(at([0, 0, 0], [0, 0, one], [lo, hi]), "origin inside");
    assert!(at([2 << 16, 0, 0], [0, one, 0], [lo, hi]), "along a face");
    assert!(!at([(2 << 16) + 1, 0, 0], [0, one, 0], [lo, hi]), "one unit beside it");
    assert!(at([2 << 16, 2 << 16, 2 << 16], [one, 0, 0], [lo, hi]), "at a corner, leaving");
    assert!(!at([0, 0, 3 << 16], [0, 0, one], [lo, hi]), "behind");
    assert!(at([0, 0, 3 << 16], [0, 0, -one], [[0; 3], [0; 3]]), "a box of no size, met");
    assert!(at([-0x7FFE_0040, 0, 0], [one, 0, 0], [[32_766, 0, 0], [32_766, 0, 0]]), "across the whole range");
}

#[test]
fn a_box_beyond_the_closest_hit_is_missed() {
    let setup = RaySetup::eval(&ray([0, 0, 0], [0, 0, (1 << 30) - 1]));
    let bounds = Box16::from_codes([0, 0, 100], [1, 1, 101]);
    let near = BoxTest::eval(&box_test::In { ray: setup, t_max: RayT::MAX, bounds });
    assert!(near.hit && near.t_near.get() >= 99);
    let t = near.t_near.get() << 18;
    assert!(BoxTest::eval(&box_test::In { ray: setup, t_max: RayT::new(t), bounds }).hit, "an equal distance may still win by its id");
    assert!(!BoxTest::eval(&box_test::In { ray: setup, t_max: RayT::new(t - 1), bounds }).hit);
}
