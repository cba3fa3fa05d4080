//! The four children of a tree's node: their prisms, tested, sorted.

use crate::boxes::{is_setup, octant};
use crate::draw::Draw;
use crate::rays::point;
use crate::suite::{Category, Suite};
use lodray::block::child_prisms::{ChildPrisms, In};
use lodray::block::child_test::Out;
use lodray::block::ray_setup::{self, RaySetup};
use lodray::block::{Block, BoxesPerCycle};
use lodray::num::{COORD_LIMIT, Direction, Point, RayT, T_NEAR_TO_T_SHIFT, TNear, U};
use tb::{Build, Mode};

fn setup(origin: Point, direction: Direction) -> ray_setup::Out {
    RaySetup::eval(&ray_setup::In { origin, direction })
}

/// A point within `size` units around `centre`, within the model.
fn near(draw: &mut Draw, centre: [i64; 3], size: i64) -> Point {
    let limit = i64::from(COORD_LIMIT);
    point(centre.map(|c| (c + draw.between(-size, size)).clamp(-limit, limit)))
}

/// The middle of two points.
fn middle(a: Point, b: Point) -> [i64; 3] {
    let (a, b) = (a.get(), b.get());
    [0, 1, 2].map(|c| (a[c] + b[c]) >> 1)
}

/// A triangle of this size around a place, its inserted vertices near the middles of its edges; the same as morphed, nearer to them.
fn triangle(draw: &mut Draw, centre: [i64; 3], size: i64) -> ([Point; 6], [Point; 6]) {
    let [a, b, c] = [0; 3].map(|_| near(draw, centre, size));
    let (bulge, morph) = (size >> draw.below(12), size >> (3 + draw.below(20)));
    let [p, q, r] = [middle(b, c), middle(c, a), middle(a, b)].map(|m| near(draw, m, bulge));
    let full = [a, b, c, p, q, r];
    let morphed = if draw.once_in(3) { full } else { full.map(|p| near(draw, p.get(), morph)) };
    (full, morphed)
}

/// Codes up to a random one, of any steps.
fn with_codes(draw: &mut Draw, input: In) -> In {
    let most = draw.below(8);
    In { reach: U::new(draw.below(7)), height: U::new(draw.below(16)), planes: [0; 20].map(|_| U::new(draw.below(most + 1))), ..input }
}

/// A node and a ray to a place near it, from afar.
fn aimed(draw: &mut Draw) -> In {
    let size = 1 << draw.between(2, 28);
    let centre = [0; 3].map(|_| draw.between(-(1 << 29), 1 << 29));
    let (full, morphed) = triangle(draw, centre, size);
    let d = draw.full_direction();
    let target = near(draw, centre, size).get();
    let input = In { ray: setup(draw.afar(target, d), d), t_max: RayT::MAX, full, morphed, ..In::default() };
    with_codes(draw, input)
}

/// Anything.
fn random(draw: &mut Draw) -> In {
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| draw.model_point()));
    let ray = setup(draw.point(i64::from(i32::MAX)), draw.direction());
    In { ray, t_max: draw.t_max(), reach: draw.bits(), height: draw.bits(), planes: [0; 20].map(|_| draw.bits()), full, morphed }
}

/// Within the plane of a triangle, or almost.
fn edge_on(draw: &mut Draw) -> In {
    let input = aimed(draw);
    let axis = draw.below(3) as usize;
    let at = draw.between(-(1 << 29), 1 << 29);
    let flat = |p: Point, by: i64| {
        let mut v = p.get();
        v[axis] = at + by;
        point(v)
    };
    let full = input.full.map(|p| flat(p, draw.between(-2, 2)));
    let mut d = draw.full_direction().get();
    d[axis] = draw.between(-9, 9);
    let d = Direction::new(d[0], d[1], d[2]);
    let d = if d == Direction::default() { Direction::new(1, 1, 1) } else { d };
    let from = draw.afar(input.full[0].get(), d);
    let by = draw.between(-16, 16);
    In { ray: setup(flat(from, by), d), morphed: full, full, ..input }
}

/// Corners on one line, or in one place.
fn degenerate(draw: &mut Draw) -> In {
    let input = aimed(draw);
    let a = input.full[0];
    let full = match draw.below(3) {
        0 => [a; 6],
        1 => [a, a, input.full[2], input.full[3], a, a],
        _ => [0, 1, 2, 3, 4, 5].map(|k| point(a.get().map(|c| c + k * 64))),
    };
    In { full, morphed: full, ..input }
}

/// The triangle as morphed lies elsewhere.
fn moved(draw: &mut Draw) -> In {
    let input = aimed(draw);
    let size = 1 << draw.between(20, 27);
    let centre = [0; 3].map(|_| draw.between(-(1 << 28), 1 << 28));
    let (full, _) = triangle(draw, centre, size);
    let by = [0; 3].map(|_| draw.between(-size, size));
    let morphed = full.map(|p| point([0, 1, 2].map(|c| p.get()[c] + by[c])));
    let target = [0, 1, 2].map(|c| centre[c] + by[c]);
    let d = draw.full_direction();
    In { ray: setup(draw.afar(target, d), d), full, morphed, t_max: RayT::MAX, ..input }
}

fn open(draw: &mut Draw) -> In {
    In { reach: U::new(7), ..random(draw) }
}

/// A small node far beside the ray.
fn beside(draw: &mut Draw) -> In {
    let size = 1 << draw.between(4, 16);
    let centre = [0; 3].map(|_| draw.between(-(1 << 28), 1 << 28));
    let (full, _) = triangle(draw, centre, size);
    let d = draw.full_direction();
    let mut target = centre;
    // Across the axis along which the ray moves most.
    let main = (0..3).max_by_key(|&c| d.get()[c].abs()).unwrap_or(0);
    target[(main + 1) % 3] += 1 << 28;
    In { ray: setup(draw.afar(target, d), d), full, morphed: full, ..aimed(draw) }
}

/// The node lies behind the origin.
fn behind(draw: &mut Draw) -> In {
    let size = 1 << draw.between(4, 20);
    let centre = [0; 3].map(|_| draw.between(-(1 << 28), 1 << 28));
    let (full, morphed) = triangle(draw, centre, size);
    let d = draw.full_direction();
    let by = draw.between(1 << 14, 1 << 15);
    let origin = [0, 1, 2].map(|c| centre[c] + ((d.get()[c] * by) >> 16));
    let input = In { ray: setup(point(origin), d), full, morphed, t_max: RayT::MAX, ..In::default() };
    In { height: U::new(15), reach: U::new(6), ..with_codes(draw, input) }
}

/// The ray ends where the nearest child begins, plus `by` steps.
fn ends(draw: &mut Draw, by: i64) -> In {
    let input = aimed(draw);
    let out = ChildPrisms::eval(&input);
    let entry = (out.t_near[out.order[0].get() as usize].get() << T_NEAR_TO_T_SHIFT).cast_signed();
    In { t_max: U::new((entry + by).max(0).cast_unsigned()), ..input }
}

fn extreme(draw: &mut Draw) -> In {
    let limit = i64::from(COORD_LIMIT);
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| point([limit; 3].map(|v| draw.sign(v)))));
    let d = draw.direction();
    In { ray: setup(point(draw.corner()), d), full, morphed, ..random(draw) }
}

fn unmorphed(i: &In) -> Out {
    ChildPrisms::eval(&In { morphed: i.full, ..*i })
}

pub fn legal(i: &In) -> bool {
    let limit = i64::from(COORD_LIMIT);
    let moves = [i.ray.x, i.ray.y, i.ray.z].iter().any(|axis| axis.d.get() > 0);
    moves && is_setup(&i.ray) && i.full.iter().chain(&i.morphed).all(|p| p.get().iter().all(|v| v.abs() <= limit))
}

fn main_axis(i: &In) -> u64 {
    let [x, y, z] = [i.ray.x, i.ray.y, i.ray.z].map(|axis| axis.d.get());
    if z >= x && z >= y { 2 } else { u64::from(y >= x) }
}

type Is = Category<ChildPrisms>;

pub fn suite() -> Suite<ChildPrisms> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::often("aimed at a node", aimed, |_, o| o.count.get() > 0),
            Is::often("past some of its children", aimed, |_, o| o.count.get() < 4),
            Is::some("edge-on", edge_on, |_, o| o.count.get() > 0),
            Is::some("edge-on, and past", edge_on, |_, o| o.count.get() < 4),
            Is::any("no area", degenerate),
            Is::often("moved by morphing", moved, |i, o| o.count.get() > unmorphed(i).count.get()),
            Is::all("not bounded", open, |_, o| o.count.get() == 4 && o.t_near == [TNear::ZERO; 4]),
            Is::often("too far beside the ray to be told", beside, |_, o| o.count.get() == 4 && o.t_near == [TNear::ZERO; 4]),
            Is::often("behind the origin", behind, |_, o| o.count.get() == 0),
            Is::often("t_max at the entry", |d| ends(d, 0), |_, o| o.count.get() > 0),
            Is::some("t_max one step before the entry", |d| ends(d, -1), |_, o| o.count.get() < 4),
            Is::any("extremes", extreme),
        ],
        vec![
            ("saturated distance", |_, o| o.t_near.contains(&TNear::MAX)),
            ("met in another order than by number", |_, o| o.count.get() == 4 && o.order.map(U::get) == [3, 2, 1, 0]),
            ("morphed to another order", |i, o| {
                let before = unmorphed(i);
                o.count.get() > 1 && o.count == before.count && o.order != before.order
            }),
        ],
        vec![
            ("count", 0..=4, |_, o| o.count.get()),
            ("nearest child", 0..=3, |_, o| o.order[0].get()),
            ("axis", 0..=2, |i, _| main_axis(i)),
            ("octant", 0..=7, |i, _| octant(&i.ray)),
            ("reach", 0..=7, |i, _| i.reach.get()),
            ("height", 0..=15, |i, _| i.height.get()),
        ],
    )
}

fn with(tests: BoxesPerCycle) -> Suite<ChildPrisms> {
    let build = Build::block::<ChildPrisms>().parameter("PRISMS_PER_CYCLE", tests.count());
    Suite { build, timing: ChildPrisms::with_tests(tests), ..suite() }
}

#[test]
fn four_a_cycle_free_running() {
    with(BoxesPerCycle::Four).run(Mode::Free);
}

#[test]
fn two_a_cycle_stalled() {
    with(BoxesPerCycle::Two).run(Mode::Stalled);
}

#[test]
fn one_a_cycle_free_running() {
    with(BoxesPerCycle::One).run(Mode::Free);
}

#[test]
fn one_a_cycle_stalled() {
    with(BoxesPerCycle::One).run(Mode::Stalled);
}
