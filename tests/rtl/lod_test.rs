use crate::draw::{Draw, POINT_MAX};
use crate::suite::Suite;
use lodray::block::Block;
use lodray::block::bound_decode::{self, BoundDecode};
use lodray::block::lod_test::{In, LodTest, Out};
use lodray::num::{Cone, Direction, Point, Ray, S_ONE, U, bound_scale};

fn random(draw: &mut Draw) -> In {
    In {
        ray: draw.ray(),
        p0: draw.point(POINT_MAX),
        p1: draw.point(POINT_MAX),
        p2: draw.point(POINT_MAX),
        e0: draw.bits(),
        e1: draw.bits(),
        e2: draw.bits(),
        scale: bound_scale(draw.bits::<32>().get()),
    }
}

/// A plausible frame: full-length rays, bounds small against distances, cones of a pixel.
fn pixels(draw: &mut Draw) -> In {
    let d = draw.axis_parallel().get().map(|v| v / 2 + draw.signed(1 << 28));
    let origin = draw.point(1 << 30);
    let cone = Cone { offset: U::new(draw.below(1 << 40)), slope: U::new(draw.below(1 << 18)), shift: U::new(24 + draw.below(12)) };
    let ray = Ray { origin, direction: Direction::new(d[0], d[1], d[2]), cone };
    let largest = 1 << (8 + draw.below(20));
    In { ray, scale: bound_scale(largest), ..random(draw) }
}

/// A cone that tolerates exactly `tolerance`, whatever the distance.
fn flat_cone(tolerance: u64) -> Cone {
    Cone { offset: U::new(tolerance), slope: U::ZERO, shift: U::ZERO }
}

/// Tolerances around a bound of the triangle, and around half of it: the borders of s.
fn borders(draw: &mut Draw) -> In {
    let input = random(draw);
    let code = [input.e0, input.e1, input.e2][draw.below(3) as usize];
    let h = BoundDecode::eval(&bound_decode::In { code, scale: input.scale }).h.get();
    let tolerance = match draw.below(4) {
        0 => h,
        1 => h.div_ceil(2),
        2 => h / 2,
        // s = 255 / 256 or about.
        _ => (h * 256 / 511).max(1),
    };
    let tolerance = (tolerance + draw.below(3)).saturating_sub(1);
    In { ray: Ray { cone: flat_cone(tolerance), ..input.ray }, ..input }
}

/// Triangles behind, at and before the origin: r below, at and above 0.
fn behind(draw: &mut Draw) -> In {
    let input = random(draw);
    let p = |draw: &mut Draw| {
        let at = input.ray.origin.get();
        let [x, y, z] = at.map(|c| (c + draw.signed(1 << 20)).clamp(-POINT_MAX, POINT_MAX));
        if draw.once_in(3) { input.ray.origin } else { Point::new(x, y, z) }
    };
    let cone = Cone { offset: U::new(draw.below(3)), slope: draw.bits(), shift: U::new(draw.below(4)) };
    In { ray: Ray { cone, ..input.ray }, p0: p(draw), p1: p(draw), p2: p(draw), ..input }
}

/// No bounds at all, on one edge or on all.
fn no_bounds(draw: &mut Draw) -> In {
    let input = borders(draw);
    let zero = draw.below(4);
    let keep = |k: u64, code| if zero == k || zero == 3 { U::ZERO } else { code };
    let cone = if draw.once_in(2) { flat_cone(0) } else { input.ray.cone };
    In { ray: Ray { cone, ..input.ray }, e0: keep(0, input.e0), e1: keep(1, input.e1), e2: keep(2, input.e2), ..input }
}

/// The farthest corners along the longest ray.
fn extreme(draw: &mut Draw) -> In {
    let side = |draw: &mut Draw| if draw.once_in(2) { POINT_MAX } else { -POINT_MAX };
    let corner = |draw: &mut Draw| Point::new(side(draw), side(draw), side(draw));
    // (2^30 / sqrt 3) in each component.
    let component = |draw: &mut Draw| if draw.once_in(2) { 619_925_131 } else { -619_925_131 };
    let direction = Direction::new(component(draw), component(draw), component(draw));
    let ray = Ray { origin: corner(draw), direction, cone: draw.cone() };
    In { ray, p0: corner(draw), p1: corner(draw), p2: corner(draw), ..random(draw) }
}

fn has(out: &Out, s: u64) -> bool {
    [out.s0, out.s1, out.s2].iter().any(|state| state.get() == s)
}

#[test]
fn rtl_equals_rust() {
    Suite::<LodTest>::new(
        &[
            ("random", random),
            ("pixels", pixels),
            ("borders of s", borders),
            ("behind and at the origin", behind),
            ("zero bounds", no_bounds),
            ("extremes", extreme),
        ],
        &[
            ("serves", |_, o| !o.refine),
            ("s = 0 beside others", |_, o| o.refine && has(o, 0)),
            ("s just above 0", |_, o| has(o, 1)),
            ("s just below 1", |_, o| has(o, S_ONE - 1)),
            ("s = 1", |_, o| has(o, S_ONE)),
            ("s between", |_, o| has(o, 100)),
            ("h = D exactly", |i, o| {
                let h = BoundDecode::eval(&bound_decode::In { code: i.e0, scale: i.scale }).h.get();
                i.ray.cone.slope.get() == 0 && i.ray.cone.shift.get() == 0 && h > 0 && h == i.ray.cone.offset.get() && o.s0.get() == 0
            }),
            ("h = 2D exactly", |i, o| {
                let h = BoundDecode::eval(&bound_decode::In { code: i.e0, scale: i.scale }).h.get();
                i.ray.cone.slope.get() == 0
                    && i.ray.cone.shift.get() == 0
                    && h > 0
                    && h == 2 * i.ray.cone.offset.get()
                    && o.s0.get() == S_ONE
            }),
            ("D = 0 and h = 0", |i, o| i.ray.cone == flat_cone(0) && i.e1.get() == 0 && o.s1.get() == 0 && o.refine),
            ("a corner at the origin", |i, o| i.p0 == i.ray.origin && o.refine),
        ],
    )
    .run();
}
