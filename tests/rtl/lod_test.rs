//! The level-of-detail test.

use crate::draw::{Draw, POINT_MAX};
use crate::rays::{DIAGONAL, direction, is_direction, is_point, point};
use crate::suite::{Category, Suite};
use lodray::block::bound_decode::{self, BoundDecode};
use lodray::block::lod_test::{In, LodTest, Out};
use lodray::block::{Block, Timing};
use lodray::num::{BoundCode, BoundScale, Cone, Point, Ray, S_ONE, U};
use tb::Build;

/// Bound, distance l, displacement before its clamp, and state of edge `k`.
struct Edge {
    h: u64,
    l: i64,
    unclamped: i64,
    s: u64,
}

/// l of edge `k`.
fn distance(i: &In, k: usize) -> i64 {
    let (x, d) = (i.ray.origin.get(), i.ray.direction.get());
    let dot = |p: Point| (0..3).map(|k| (p.get()[k] - x[k]) * d[k]).sum::<i64>();
    let p = [i.p0, i.p1, i.p2];
    dot(p[(k + 1) % 3]).min(dot(p[(k + 2) % 3])) >> 30
}

fn bound(code: BoundCode, scale: BoundScale) -> u64 {
    BoundDecode::eval(&bound_decode::In { code, scale }).h.get()
}

fn edges(i: &In, o: &Out) -> [Edge; 3] {
    let (codes, states, cone) = ([i.e0, i.e1, i.e2], [o.s0, o.s1, o.s2], i.ray.cone);
    [0, 1, 2].map(|k| {
        let l = distance(i, k);
        let unclamped = (cone.offset.get().cast_signed() + l * cone.slope.get().cast_signed()) >> cone.shift.get();
        Edge { h: bound(codes[k], i.scale), l, unclamped, s: states[k].get() }
    })
}

pub fn random(draw: &mut Draw) -> In {
    let [p0, p1, p2] = [0; 3].map(|_| draw.point(POINT_MAX));
    In { ray: draw.ray(), p0, p1, p2, e0: draw.bits(), e1: draw.bits(), e2: draw.bits(), scale: draw.scale() }
}

/// A plausible frame: bounds small against distances, cones of about a pixel, a small triangle ahead.
pub fn pixels(draw: &mut Draw) -> In {
    let d = draw.full_direction();
    let size = 1 << draw.between(8, 24);
    let target = [0; 3].map(|_| draw.between(-(1 << 30), 1 << 30));
    let origin = draw.afar(target, d);
    let [p0, p1, p2] = [0; 3].map(|_| point(target.map(|v| v + draw.between(-size, size))));
    let cone = Cone { offset: U::new(draw.below(1 << 40)), slope: U::new(draw.below(1 << 18)), shift: U::new(24 + draw.below(12)) };
    let [e0, e1, e2] = [0; 3].map(|_| U::new(draw.below(256)));
    In { ray: Ray { origin, direction: d, cone }, p0, p1, p2, e0, e1, e2, scale: draw.scale() }
}

/// A cone that tolerates exactly `tolerance` at distance `l`: with as large a part from its slope as fits.
fn cone_through(draw: &mut Draw, l: i64, tolerance: u64) -> Cone {
    // The tolerance and its fraction take 53 bits at most.
    let room = 53 - u64::from(u64::BITS - tolerance.leading_zeros());
    let shift = draw.below(room + 1);
    let wanted = (tolerance << shift | draw.below(1 << shift)).cast_signed();
    let mut slope = draw.bits::<18>().get();
    while !(0..1 << 53).contains(&(wanted - l * slope.cast_signed())) {
        slope >>= 1;
    }
    let offset = (wanted - l * slope.cast_signed()).cast_unsigned();
    Cone { offset: U::new(offset), slope: U::new(slope), shift: U::new(shift) }
}

/// An edge with a bound of at least 1024 units whose ray tolerates `tolerance` of that bound.
fn tolerating(draw: &mut Draw, tolerance: fn(&mut Draw, u64) -> u64) -> In {
    let input = if draw.once_in(2) { random(draw) } else { pixels(draw) };
    let (mut codes, k) = ([input.e0, input.e1, input.e2], draw.below(3) as usize);
    let scale = draw.scale();
    if bound(codes[k], scale) < 1024 {
        // More than that in every scale.
        codes[k] = U::MAX;
    }
    let tolerance = tolerance(draw, bound(codes[k], scale));
    let cone = cone_through(draw, distance(&input, k), tolerance);
    let [e0, e1, e2] = codes;
    In { ray: Ray { cone, ..input.ray }, e0, e1, e2, scale, ..input }
}

/// All corners at or behind the origin.
fn behind(draw: &mut Draw) -> In {
    let input = random(draw);
    let (x, d) = (input.ray.origin.get(), input.ray.direction.get());
    let mut corner = || {
        if draw.once_in(4) {
            return input.ray.origin;
        }
        // Against the ray on each axis.
        let size = 1 << draw.below(31);
        point([0, 1, 2].map(|k| (x[k] - d[k].signum() * draw.between(0, size)).clamp(-POINT_MAX, POINT_MAX)))
    };
    let (p0, p1, p2) = (corner(), corner(), corner());
    In { p0, p1, p2, ..input }
}

/// The cone narrows to nothing, or to less, before the triangle.
fn no_radius(draw: &mut Draw) -> In {
    let input = behind(draw);
    let nearest = [0, 1, 2].map(|k| distance(&input, k)).into_iter().max().unwrap_or(0);
    let slope = draw.below(1 << 18);
    let most = slope * nearest.unsigned_abs();
    let cone = Cone { offset: U::new(draw.below(most + 1)), slope: U::new(slope), shift: draw.bits() };
    In { ray: Ray { cone, ..input.ray }, e0: U::MAX, e1: U::MAX, e2: U::MAX, ..input }
}

fn corner_at_origin(draw: &mut Draw) -> In {
    let input = random(draw);
    let cone = Cone { offset: U::ZERO, ..input.ray.cone };
    In { p0: input.ray.origin, ray: Ray { cone, ..input.ray }, e1: U::MAX, e2: U::MAX, ..input }
}

fn zero_bounds(draw: &mut Draw) -> In {
    In { e0: U::ZERO, e1: U::ZERO, e2: U::ZERO, ..behind(draw) }
}

fn one_zero_bound(draw: &mut Draw) -> In {
    In { e0: U::ZERO, e1: U::MAX, e2: U::MAX, ..no_radius(draw) }
}

fn with_cone(draw: &mut Draw, cone: Cone) -> In {
    let input = random(draw);
    In { ray: Ray { cone, ..input.ray }, ..input }
}

/// delta = 0.
fn base_mesh(draw: &mut Draw) -> In {
    with_cone(draw, Cone { offset: U::MAX, slope: U::ZERO, shift: U::ZERO })
}

/// delta = infinity.
fn full_detail(draw: &mut Draw) -> In {
    with_cone(draw, Cone { offset: U::ZERO, slope: U::ZERO, shift: U::new(63) })
}

/// More than 34 bits of tolerance.
fn saturated(draw: &mut Draw) -> In {
    let cone = Cone { offset: U::MAX, slope: U::new(draw.below(1 << 10)), shift: U::new(draw.below(16)) };
    with_cone(draw, cone)
}

fn degenerate(draw: &mut Draw) -> In {
    let input = pixels(draw);
    In { p1: input.p0, p2: if draw.once_in(2) { input.p0 } else { input.p2 }, ..input }
}

/// The longest way there is, forwards or backwards.
fn extreme(draw: &mut Draw) -> In {
    let from = draw.corner();
    let mut across = || point(from.map(|v| -v + v.signum() * draw.bits::<8>().get().cast_signed()));
    let (p0, p1, p2) = (across(), across(), across());
    let way = draw.sign(1);
    let ray = Ray { origin: point(from), direction: direction(from.map(|v| -way * v.signum() * DIAGONAL)), cone: draw.cone() };
    In { ray, p0, p1, p2, ..random(draw) }
}

pub fn legal(i: &In) -> bool {
    is_direction(i.ray.direction) && [i.ray.origin, i.p0, i.p1, i.p2].into_iter().all(is_point)
}

fn has(o: &Out, s: u64) -> bool {
    [o.s0, o.s1, o.s2].iter().any(|state| state.get() == s)
}

/// A ray and a triangle at one of the borders between states.
pub fn border(draw: &mut Draw) -> In {
    match draw.below(6) {
        0 => tolerating(draw, |_, h| h),
        1 => tolerating(draw, |_, h| h - 1),
        2 => tolerating(draw, |_, h| h / 2 + 1),
        3 => tolerating(draw, |_, h| h / 2),
        4 => no_radius(draw),
        _ => corner_at_origin(draw),
    }
}

type Is = Category<LodTest>;

pub fn suite() -> Suite<LodTest> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::often("pixels", pixels, |i, _| distance(i, 0) > 0),
            Is::all(
                "s = 0: D = h exactly",
                |d| tolerating(d, |_, h| h),
                |i, o| edges(i, o).iter().any(|e| e.h > 0 && e.s == 0 && e.unclamped == e.h.cast_signed()),
            ),
            Is::all("s just above 0: D = h - 1", |d| tolerating(d, |_, h| h - 1), |_, o| has(o, 1)),
            Is::all("s just below 1", |d| tolerating(d, |_, h| h / 2 + 1), |_, o| has(o, S_ONE - 1)),
            Is::all("s = 1: D = h / 2", |d| tolerating(d, |_, h| h / 2), |_, o| has(o, S_ONE)),
            Is::all(
                "s between",
                |d| tolerating(d, |d, h| h / 2 + 1 + d.below(h / 2 - 1)),
                |i, o| edges(i, o).iter().any(|e| (1..S_ONE).contains(&e.s) && e.unclamped > 0),
            ),
            Is::all("r <= 0", no_radius, |i, o| edges(i, o).iter().all(|e| e.unclamped <= 0 && e.h > 0 && e.s == S_ONE)),
            Is::all("behind the origin", behind, |i, _| (0..3).all(|k| distance(i, k) <= 0)),
            Is::all("a corner at the origin", corner_at_origin, |i, o| edges(i, o)[1].l <= 0 && o.s1.get() == S_ONE),
            Is::all("zero bounds", zero_bounds, |_, o| !o.refine),
            Is::all("one zero bound", one_zero_bound, |_, o| o.s0.get() == 0 && o.s1.get() == S_ONE),
            Is::all("delta = 0: the base mesh", base_mesh, |_, o| !o.refine),
            Is::all("delta = infinity: full detail", full_detail, |i, o| {
                edges(i, o).iter().all(|e| e.s == if e.h > 0 { S_ONE } else { 0 })
            }),
            Is::some("saturated tolerance", saturated, |i, o| edges(i, o).iter().all(|e| e.unclamped >= 1 << 34) && !o.refine),
            Is::any("corners that coincide", degenerate),
            Is::all("extremes", extreme, |i, _| (0..3).all(|k| distance(i, k).abs() > 6 << 30)),
        ],
        vec![
            ("h = 2D exactly", |i, o| edges(i, o).iter().any(|e| e.unclamped > 0 && e.h == 2 * e.unclamped.cast_unsigned())),
            ("h = 2D - 1", |i, o| edges(i, o).iter().any(|e| e.unclamped > 0 && e.h + 1 == 2 * e.unclamped.cast_unsigned())),
            ("three different states", |_, o| o.s0 != o.s1 && o.s1 != o.s2 && o.s2 != o.s0),
            ("a slope that decides", |i, o| o.refine && i.ray.cone.slope.get() > 0 && (1..S_ONE).contains(&o.s0.get())),
        ],
        vec![
            ("s0 in sixteenths", 0..=16, |_, o| o.s0.get() >> 4),
            ("s1 in sixteenths", 0..=16, |_, o| o.s1.get() >> 4),
            ("s2 in sixteenths", 0..=16, |_, o| o.s2.get() >> 4),
            ("refine", 0..=1, |_, o| o.refine.into()),
        ],
    )
}

fn with(edges_per_cycle: u32, timing: Timing) -> Suite<LodTest> {
    Suite { build: Build::block::<LodTest>().parameter("EDGES_PER_CYCLE", edges_per_cycle), timing, ..suite() }
}

crate::suite::modes!(three_edges_per_cycle: with(3, LodTest::THREE_EDGES));
crate::suite::modes!(one_edge_per_cycle: with(1, LodTest::ONE_EDGE));
