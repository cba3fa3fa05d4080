//! The four children of a node: widened, tested, sorted.

use crate::boxes::is_setup;
use crate::draw::Draw;
use crate::rays::{direction, point};
use crate::suite::{Category, Suite};
use lodray::block::Block;
use lodray::block::child_test::{ChildTest, In, Out};
use lodray::block::ray_setup::{self, RaySetup};
use lodray::num::{Box16, COORD_LIMIT, Direction, Point, RayT, T_NEAR_TO_T_SHIFT, TNear, U};
use tb::Mode;

fn setup(origin: Point, direction: Direction) -> ray_setup::Out {
    RaySetup::eval(&ray_setup::In { origin, direction })
}

fn corners(i: &In) -> [Point; 6] {
    [i.p0, i.p1, i.p2, i.q0, i.q1, i.q2]
}

fn random(draw: &mut Draw) -> In {
    let [p0, p1, p2, q0, q1, q2] = [0; 6].map(|_| draw.model_point());
    In {
        ray: setup(draw.point(i64::from(i32::MAX)), draw.direction()),
        t_max: draw.t_max(),
        present: [0; 4].map(|_| !draw.once_in(4)),
        bounds: [0; 4].map(|_| draw.box16(32767)),
        widen: draw.once_in(2),
        p0,
        p1,
        p2,
        q0,
        q1,
        q2,
    }
}

/// A point within `size` units around `centre`, within the model.
fn near(draw: &mut Draw, centre: [i64; 3], size: i64) -> Point {
    let limit = i64::from(COORD_LIMIT);
    point(centre.map(|c| (c + draw.between(-size, size)).clamp(-limit, limit)))
}

/// A box around two points.
fn around(a: Point, b: Point) -> Box16 {
    let points = [a, b].map(|p| p.get().map(|v| v as i32)); // 32 bits
    Box16::of_points(&points)
}

/// Four boxes around one place that the ray is aimed at, and a triangle there.
fn crowded(draw: &mut Draw, widen: bool) -> In {
    let size = 1 << draw.between(16, 29);
    let centre = draw.model_point().get();
    let bounds = [0; 4].map(|_| around(near(draw, centre, size), near(draw, centre, size)));
    let d = draw.direction();
    let target = near(draw, centre, size).get();
    let [p0, p1, p2, q0, q1, q2] = [0; 6].map(|_| near(draw, centre, size));
    let ray = setup(draw.before(target, d), d);
    In { ray, t_max: RayT::MAX, present: [0; 4].map(|_| !draw.once_in(8)), bounds, widen, p0, p1, p2, q0, q1, q2 }
}

/// A quarter of space each: distances that widening turns around.
fn quarters(draw: &mut Draw) -> In {
    let input = crowded(draw, true);
    let size = 1 << draw.between(20, 28);
    let centre = [0; 3].map(|_| draw.between(-(1 << 29), 1 << 29));
    let bounds = [0; 4].map(|_| {
        let a = near(draw, centre, size);
        around(a, near(draw, a.get(), size / 4))
    });
    let [p0, p1, p2, q0, q1, q2] = [0; 6].map(|_| near(draw, centre, 2 * size));
    let d = draw.full_direction();
    In { ray: setup(draw.afar(centre, d), d), present: [true; 4], bounds, p0, p1, p2, q0, q1, q2, ..input }
}

/// Four times the same box, ahead of the ray.
fn equal(draw: &mut Draw) -> In {
    let input = crowded(draw, false);
    // Halved, so that there is room before it.
    let (lo, hi) = (input.bounds[0].lo.get().map(|v| v >> 1), input.bounds[0].hi.get().map(|v| v >> 1));
    let target = [0, 1, 2].map(|k| draw.between(lo[k] << 16, hi[k] << 16));
    let d = draw.full_direction();
    let codes = |v: [i64; 3]| v.map(|c| c as i16); // 16 bits
    let bounds = [Box16::from_codes(codes(lo), codes(hi)); 4];
    In { ray: setup(draw.afar(target, d), d), present: [true; 4], bounds, ..input }
}

/// The origin in all boxes.
fn within(draw: &mut Draw) -> In {
    let input = random(draw);
    let x = near(draw, input.p0.get(), 1 << 20).get();
    let bounds = [0; 4].map(|_| {
        let size = 1i64 << draw.between(0, 15);
        let code = |v: i64| (v >> 16).clamp(-32767, 32766) as i16; // clamped to 16 bits
        Box16::from_codes(x.map(|v| code(v - (size << 16))), x.map(|v| code(v + (size << 16)) + 1))
    });
    In { ray: setup(point(x), draw.direction()), present: [true; 4], bounds, ..input }
}

fn absent(draw: &mut Draw) -> In {
    In { present: [false; 4], ..within(draw) }
}

/// Stored boxes at the corner of the model that the ray is not aimed at; only the triangle can make it hit.
fn by_the_triangle(draw: &mut Draw) -> In {
    let input = crowded(draw, true);
    let away = input.p0.get().map(|v| if v > 0 { -32766i16 } else { 32766 });
    let reach = 1 << draw.between(0, 20);
    let x = near(draw, input.p0.get(), reach);
    let bounds = [Box16::from_codes(away, away); 4];
    In { ray: setup(x, draw.full_direction()), bounds, present: [true; 4], ..input }
}

/// The ray ends where the box of some child begins, plus `by` steps.
fn ends(draw: &mut Draw, by: i64) -> In {
    let input = equal(draw);
    let out = ChildTest::eval(&input);
    let entry = (out.t_near[0].get() << T_NEAR_TO_T_SHIFT).cast_signed();
    In { t_max: U::new((entry + by).max(0).cast_unsigned()), ..input }
}

fn extreme(draw: &mut Draw) -> In {
    let limit = i64::from(COORD_LIMIT);
    let [p0, p1, p2, q0, q1, q2] = [0; 6].map(|_| point([limit; 3].map(|v| draw.sign(v))));
    let d = if draw.once_in(4) { Direction::default() } else { direction([(1 << 30) - 1; 3].map(|v| draw.sign(v))) };
    In { ray: setup(point(draw.corner()), d), p0, p1, p2, q0, q1, q2, ..random(draw) }
}

fn unwidened(i: &In) -> Out {
    ChildTest::eval(&In { widen: false, ..*i })
}

fn legal(i: &In) -> bool {
    let limit = i64::from(COORD_LIMIT);
    let boxed = |b: &Box16| (0..3).all(|k| b.lo.get()[k] <= b.hi.get()[k] && b.lo.get()[k] >= -32767 && b.hi.get()[k] <= 32767);
    is_setup(&i.ray) && i.bounds.iter().all(boxed) && corners(i).iter().all(|p| p.get().iter().all(|v| v.abs() <= limit))
}

type Is = Category<ChildTest>;

pub fn suite() -> Suite<ChildTest> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::often("children of a quad-BVH node", |d| crowded(d, false), |_, o| o.count.get() > 0),
            Is::often("children of a tree's node", |d| crowded(d, true), |_, o| o.count.get() > 0),
            Is::often("boxes beside triangles", quarters, |i, o| o.count.get() > unwidened(i).count.get()),
            Is::often("equal t_near", equal, |_, o| {
                o.count.get() == 4 && o.t_near == [o.t_near[0]; 4] && o.order.map(U::get) == [0, 1, 2, 3]
            }),
            Is::all("origin in all boxes", within, |_, o| o.count.get() == 4 && o.t_near == [TNear::ZERO; 4]),
            Is::all("no child", absent, |_, o| o.count.get() == 0),
            Is::often("hit by the triangle alone", by_the_triangle, |i, o| o.count.get() > unwidened(i).count.get()),
            Is::often("t_max at the entry", |d| ends(d, 0), |_, o| o.count.get() == 4),
            Is::often("t_max one step before the entry", |d| ends(d, -1), |_, o| o.count.get() == 0),
            Is::some("extremes", extreme, |_, o| o.count.get() > 0),
        ],
        vec![
            ("absent child in front", |i, o| !i.present[0] && o.count.get() > 0),
            ("two children at one distance beside others", |_, o| {
                let t = |k: usize| o.t_near[o.order[k].get() as usize];
                o.count.get() == 4 && t(0) < t(1) && t(1) == t(2) && t(2) < t(3)
            }),
            ("saturated distance", |_, o| o.t_near.contains(&TNear::MAX)),
            ("widened to another order", |i, o| {
                let stored = unwidened(i);
                i.widen && o.count.get() > 1 && o.count == stored.count && o.order != stored.order
            }),
        ],
        vec![
            ("count", 0..=4, |_, o| o.count.get()),
            ("nearest child", 0..=3, |_, o| o.order[0].get()),
            ("widen", 0..=1, |i, _| i.widen.into()),
        ],
    )
}

#[test]
fn free_running() {
    suite().run(Mode::Free);
}

#[test]
fn stalled() {
    suite().run(Mode::Stalled);
}
