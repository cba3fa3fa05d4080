//! The triangle test against big integers and a perturbed direction.

use lodray::block::Block;
use lodray::block::tri_test::{In, TriTest};
use lodray::num::{Direction, Point};
use lodray_test_support::cases;
use num_bigint::{BigInt, Sign};
use proptest::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

type Big = [BigInt; 3];

fn big(v: [i64; 3]) -> Big {
    v.map(BigInt::from)
}

fn cross(a: &Big, b: &Big) -> Big {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn dot(a: &Big, b: &Big) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// What the test must give, with the direction really perturbed: 2^400 d + (2^300, 2^150, 1) has the sign of the tie rule because components
/// of the normals are far below 2^100.
fn expected(x: [i64; 3], d: [i64; 3], p: [[i64; 3]; 3]) -> Option<(bool, [BigInt; 4])> {
    let shift = |n: u32| BigInt::from(1) << n;
    let perturbed: Big = {
        let d = big(d).map(|c| c << 400u32);
        [&d[0] + shift(300), &d[1] + shift(150), &d[2] + shift(0)]
    };
    let [a, b, c] = p.map(|p| big(std::array::from_fn(|k| p[k] - x[k])));
    let sign = |p: &Big, q: &Big| match dot(&perturbed, &cross(p, q)).sign() {
        Sign::Plus => true,
        Sign::Minus => false,
        // The origin is on the edge's line: nothing is met ahead.
        Sign::NoSign => true,
    };
    let signs = [sign(&b, &c), sign(&c, &a), sign(&a, &b)];
    let d = big(d);
    let (v, w) = (dot(&d, &cross(&c, &a)), dot(&d, &cross(&a, &b)));
    let det = dot(&d, &cross(&b, &c)) + &v + &w;
    let t_num = dot(&a, &cross(&b, &c));
    if signs != [signs[0]; 3] || det.sign() == Sign::NoSign || (&t_num * &det).sign() != Sign::Plus {
        return None;
    }
    let front = det.sign() == Sign::Minus;
    let numbers = [v, w, det, t_num];
    Some((front, if front { numbers.map(|n| -n) } else { numbers }))
}

fn check(x: [i64; 3], d: [i64; 3], p: [[i64; 3]; 3]) -> bool {
    let point = |v: [i64; 3]| Point::new(v[0], v[1], v[2]);
    let direction = Direction::new(d[0], d[1], d[2]);
    let out = TriTest::eval(&In { origin: point(x), direction, p0: point(p[0]), p1: point(p[1]), p2: point(p[2]) });
    match expected(x, d, p) {
        None => assert!(!out.hit, "{x:?} {d:?} {p:?}"),
        Some((front, numbers)) => {
            assert!(out.hit && out.front == front, "{x:?} {d:?} {p:?}");
            let [v, w, det] = [out.v, out.w, out.det].map(|n| BigInt::from(n.get()));
            assert_eq!(numbers, [v, w, det, BigInt::from(out.t_num.get())]);
        }
    }
    out.hit
}

const LIMIT: i64 = 0x7FFE_0000;

fn triple(limit: i64) -> impl Strategy<Value = [i64; 3]> {
    prop::array::uniform3(-limit..=limit)
}

static ANYTHING: AtomicU64 = AtomicU64::new(0);
static TIES: AtomicU64 = AtomicU64::new(0);

#[test]
fn random_triangles_and_rays() {
    anything();
    ties();
    let hits = [&ANYTHING, &TIES].map(|c| c.load(Relaxed));
    println!("{hits:?} hits");
    assert!(hits.iter().all(|&n| n > 300), "{hits:?} hits");
}

proptest! {
    #![proptest_config(cases(30_000))]

    fn anything(x in triple(LIMIT + 64), d in triple(600_000_000), p in prop::array::uniform3(triple(LIMIT)), shift in 0u32..31) {
        ANYTHING.fetch_add(check(x.map(|c| c >> shift), d, p.map(|p| p.map(|c| c >> shift))).into(), Relaxed);
    }

    /// Coordinates so small that ties, coincidences and degenerate triangles are common.
    fn ties(x in triple(3), d in triple(2), p in prop::array::uniform3(triple(2)), scale in 0u32..28) {
        let up = |v: [i64; 3]| v.map(|c| c << scale);
        TIES.fetch_add(check(up(x), d.map(|c| c << 28), p.map(up)).into(), Relaxed);
    }

    /// A closed tetrahedron is entered as often as left, whatever the tie.
    #[test]
    fn a_tetrahedron_is_crossed_evenly(far in triple(4), d in triple(3), p in prop::array::uniform4(triple(3))) {
        if d != [0; 3] {
            let x: [i64; 3] = std::array::from_fn(|k| far[k] - 16 * d[k]);
            let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
            let hits = faces.iter().filter(|f| check(x, d.map(|c| c << 27), f.map(|i| p[i]))).count();
            prop_assert_eq!(hits % 2, 0);
        }
    }
}
