//! The four children of a node: their boxes, tested, sorted.

use crate::boxes::is_setup;
use crate::draw::Draw;
use crate::rays::{direction, point};
use crate::suite::{Category, Suite};
use lodray::block::child_test::{ChildTest, In, Out};
use lodray::block::ray_setup::{self, RaySetup};
use lodray::block::{Block, BoxesPerCycle};
use lodray::num::{Box16, BoxStep, COORD_LIMIT, Direction, Point, RayT, T_NEAR_TO_T_SHIFT, TNear, U, Vec3};
use tb::Build;

fn setup(origin: Point, direction: Direction) -> ray_setup::Out {
    RaySetup::eval(&ray_setup::In { origin, direction })
}

fn full(i: &In) -> [Point; 6] {
    [i.f0, i.f1, i.f2, i.g0, i.g1, i.g2]
}

fn morphed(i: &In) -> [Point; 6] {
    [i.p0, i.p1, i.p2, i.q0, i.q1, i.q2]
}

/// Corners and inserted vertices at full resolution, and the same as morphed.
fn with_points(input: In, [f0, f1, f2, g0, g1, g2]: [Point; 6], [p0, p1, p2, q0, q1, q2]: [Point; 6]) -> In {
    In { f0, f1, f2, g0, g1, g2, p0, p1, p2, q0, q1, q2, ..input }
}

/// Planes of a group, of small steps or any.
fn with_planes(draw: &mut Draw, input: In, exponents: u64) -> In {
    In {
        halves: [0; 3].map(|_| draw.once_in(2)),
        exponents: [0; 3].map(|_| U::new(draw.below(exponents))),
        planes: [0; 24].map(|_| draw.bits()),
        ..input
    }
}

fn random(draw: &mut Draw) -> In {
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| draw.model_point()));
    let code = |draw: &mut Draw| draw.signed(32767);
    let input = In {
        ray: setup(draw.point(i64::from(i32::MAX)), draw.direction()),
        t_max: draw.t_max(),
        present: [0; 4].map(|_| !draw.once_in(4)),
        tree: draw.once_in(2),
        origin: Vec3::new(code(draw), code(draw), code(draw)),
        ..In::default()
    };
    let input = with_planes(draw, input, 16);
    with_points(input, full, morphed)
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

/// A quad-BVH node with these boxes: in its frame they may be a little larger.
fn node_of(input: In, boxes: [Box16; 4]) -> In {
    let (lo, hi) = (boxes.map(|b| b.lo.get()), boxes.map(|b| b.hi.get()));
    let mut node = In { tree: false, ..input };
    let mut origin = [0; 3];
    for axis in 0..3 {
        let least = lo.iter().map(|v| v[axis]).min().unwrap_or(0);
        let most = hi.iter().map(|v| v[axis]).max().unwrap_or(0);
        let codes = |v: i64| (v - least) as u32; // 17 bits
        let step = BoxStep::reaching(codes(most), 31);
        origin[axis] = least;
        node.halves[axis] = step.half;
        node.exponents[axis] = U::new(step.exponent.into());
        for k in 0..4 {
            node.planes[6 * k + axis] = U::new(step.below(codes(lo[k][axis])).into());
            node.planes[6 * k + 3 + axis] = U::new(step.above(codes(hi[k][axis])).into());
        }
    }
    In { origin: Vec3::new(origin[0], origin[1], origin[2]), ..node }
}

/// Four boxes or triangles around one place that the ray is aimed at.
fn crowded(draw: &mut Draw, tree: bool) -> In {
    let size = 1 << draw.between(16, 29);
    let centre = draw.model_point().get();
    let boxes = [0; 4].map(|_| around(near(draw, centre, size), near(draw, centre, size)));
    let d = draw.direction();
    let target = near(draw, centre, size).get();
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| near(draw, centre, size)));
    let ray = setup(draw.before(target, d), d);
    let present = [0; 4].map(|_| !draw.once_in(8));
    let input = with_points(In { ray, t_max: RayT::MAX, present, tree, ..In::default() }, full, morphed);
    if tree { with_planes(draw, input, 3) } else { node_of(input, boxes) }
}

/// A triangle, and a larger one as morphed: distances that morphing turns around.
fn moved(draw: &mut Draw) -> In {
    let input = crowded(draw, true);
    let size = 1 << draw.between(20, 28);
    let centre = [0; 3].map(|_| draw.between(-(1 << 29), 1 << 29));
    let full = [0; 6].map(|_| near(draw, centre, size / 2));
    let morphed = [0; 6].map(|_| near(draw, centre, 2 * size));
    let d = draw.full_direction();
    let input = In { ray: setup(draw.afar(centre, d), d), present: [true; 4], ..input };
    with_points(input, full, morphed)
}

/// Four times the same box, ahead of the ray.
fn equal(draw: &mut Draw) -> In {
    let input = crowded(draw, false);
    let code = |draw: &mut Draw| draw.between(-16000, 0);
    let origin = [code(draw), code(draw), code(draw)];
    let most = [0; 3].map(|_| 1 + draw.below(31));
    let planes = std::array::from_fn(|at| U::new(if at % 6 < 3 { 0 } else { most[at % 3] }));
    let exponents = [0; 3].map(|_| U::new(draw.below(9)));
    let node = In { origin: Vec3::new(origin[0], origin[1], origin[2]), exponents, planes, present: [true; 4], ..input };
    // In codes within the box, at least a step long.
    let target = [0, 1, 2].map(|k| draw.between(origin[k] << 16, (origin[k] + (most[k] << exponents[k].get()).cast_signed()) << 16));
    let d = draw.full_direction();
    In { ray: setup(draw.afar(target, d), d), ..node }
}

/// The origin in all boxes.
fn within(draw: &mut Draw) -> In {
    let input = random(draw);
    let x = near(draw, input.p0.get(), 1 << 20).get();
    let boxes = [0; 4].map(|_| {
        let size = 1i64 << draw.between(0, 15);
        let code = |v: i64| (v >> 16).clamp(-32767, 32766) as i16; // clamped to 16 bits
        Box16::from_codes(x.map(|v| code(v - (size << 16))), x.map(|v| code(v + (size << 16)) + 1))
    });
    let input = In { ray: setup(point(x), draw.direction()), present: [true; 4], ..input };
    // Or let out to all of space.
    let all = In { tree: true, exponents: [U::MAX; 3], planes: [U::MAX; 24], ..input };
    if draw.once_in(4) { all } else { node_of(input, boxes) }
}

fn absent(draw: &mut Draw) -> In {
    In { present: [false; 4], ..within(draw) }
}

/// At full resolution at the corner of the model that the ray is not aimed at; only as morphed the triangle can make it hit.
fn by_the_triangle(draw: &mut Draw) -> In {
    let input = In { planes: [U::ZERO; 24], ..crowded(draw, true) };
    let limit = i64::from(COORD_LIMIT);
    let away = point(input.p0.get().map(|v| if v > 0 { -limit } else { limit }));
    let d = draw.full_direction();
    let target = input.q0.get();
    let before = draw.before(target, d);
    let input = In { ray: setup(before, d), present: [true; 4], ..input };
    with_points(input, [away; 6], morphed(&input))
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
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| point([limit; 3].map(|v| draw.sign(v)))));
    let d = if draw.once_in(4) { Direction::default() } else { direction([(1 << 30) - 1; 3].map(|v| draw.sign(v))) };
    let input = In { ray: setup(point(draw.corner()), d), ..random(draw) };
    with_points(input, full, morphed)
}

fn unmorphed(i: &In) -> Out {
    ChildTest::eval(&with_points(*i, full(i), full(i)))
}

fn legal(i: &In) -> bool {
    let limit = i64::from(COORD_LIMIT);
    is_setup(&i.ray)
        && i.origin.get().iter().all(|&v| v >= -32767)
        && full(i).iter().chain(&morphed(i)).all(|p| p.get().iter().all(|v| v.abs() <= limit))
}

type Is = Category<ChildTest>;

pub fn suite() -> Suite<ChildTest> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::often("children of a quad-BVH node", |d| crowded(d, false), |_, o| o.count.get() > 0),
            Is::often("children of a tree's node", |d| crowded(d, true), |_, o| o.count.get() > 0),
            Is::often("moved by morphing", moved, |i, o| o.count.get() > unmorphed(i).count.get()),
            Is::often("equal t_near", equal, |_, o| {
                o.count.get() == 4 && o.t_near == [o.t_near[0]; 4] && o.order.map(U::get) == [0, 1, 2, 3]
            }),
            Is::all("origin in all boxes", within, |_, o| o.count.get() == 4 && o.t_near == [TNear::ZERO; 4]),
            Is::all("no child", absent, |_, o| o.count.get() == 0),
            Is::often("hit by the morphed triangle alone", by_the_triangle, |i, o| o.count.get() > unmorphed(i).count.get()),
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
            ("morphed to another order", |i, o| {
                let before = unmorphed(i);
                i.tree && o.count.get() > 1 && o.count == before.count && o.order != before.order
            }),
        ],
        vec![
            ("count", 0..=4, |_, o| o.count.get()),
            ("nearest child", 0..=3, |_, o| o.order[0].get()),
            ("tree", 0..=1, |i, _| i.tree.into()),
        ],
    )
}

fn with(boxes: BoxesPerCycle) -> Suite<ChildTest> {
    let build = Build::block::<ChildTest>().parameter("BOXES_PER_CYCLE", boxes.count());
    Suite { build, timing: ChildTest::with_boxes(boxes), ..suite() }
}

crate::suite::modes!(four_boxes_per_cycle: with(BoxesPerCycle::Four));
crate::suite::modes!(two_boxes_per_cycle: with(BoxesPerCycle::Two));
crate::suite::modes!(one_box_per_cycle: with(BoxesPerCycle::One));
