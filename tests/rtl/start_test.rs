//! The triangle test of rays from exact starts, with three edges per cycle and with one.

use crate::draw::{Draw, POINT_MAX};
use crate::rays::{direction, is_direction, is_point, point};
use crate::start_setup::fraction;
use crate::suite::{Category, Suite};
use crate::tri_test::{self, WHOLE, any_weights, corners, edge_weights, weighted};
use lodray::block::start_test::{Below, In, StartTest};
use lodray::block::tri_test::TriTest;
use lodray::block::{self, Block, Timing};
use lodray::method::leave;
use lodray::num::{BARY_ONE, Bary, Direction, Point, START_BITS, Start, U};
use tb::Build;

/// One unit.
const ONE: i128 = 1 << START_BITS;

fn of(case: &block::tri_test::In, start: Start) -> In {
    let &block::tri_test::In { direction, p0, p1, p2, .. } = case;
    In { start, direction, p0, p1, p2 }
}

/// A case of whole points, a fraction of a unit beside it.
fn beside(draw: &mut Draw) -> In {
    let case = tri_test::any(draw);
    of(&case, Start { point: case.origin, fraction: fraction(draw) })
}

fn whole(draw: &mut Draw) -> In {
    let case = tri_test::any(draw);
    of(&case, Start { point: case.origin, fraction: [U::ZERO; 3] })
}

fn random(draw: &mut Draw) -> In {
    let [p0, p1, p2] = [0; 3].map(|_| draw.point(POINT_MAX));
    let start = Start { point: draw.point(POINT_MAX), fraction: fraction(draw) };
    In { start, direction: draw.direction(), p0, p1, p2 }
}

/// The start of the ray that passes exactly through `target` after `steps` times its direction in steps of 2^-31: any, as far as it is within the range.
fn before(draw: &mut Draw, target: [i64; 3], d: Direction) -> Start {
    let mut most = i64::MAX;
    for (t, c) in target.into_iter().zip(d.get()) {
        if c != 0 {
            let room = i128::from(if c > 0 { t + POINT_MAX } else { POINT_MAX - 1 - t }.max(0)) << START_BITS;
            most = most.min(i64::try_from(room / i128::from(c.abs())).unwrap_or(i64::MAX));
        }
    }
    let steps = match draw.below(8) {
        0 => 0,
        1 => most,
        2..4 => draw.between(0, most) >> draw.below(60),
        _ => draw.between(0, most),
    };
    let at = [0, 1, 2].map(|k| (i128::from(target[k]) << START_BITS) - i128::from(steps) * i128::from(d.get()[k]));
    // In range: at a bound the target itself may be at the end of it.
    let [x, y, z] = at.map(|c| (c >> START_BITS) as i64);
    Start { point: Point::new(x, y, z), fraction: at.map(|c| U::new((c & (ONE - 1)) as u64)) }
}

fn turned(draw: &mut Draw, p: [[i64; 3]; 3], start: Start, direction: Direction) -> In {
    let mut p = p.map(point);
    p.rotate_left(draw.below(3) as usize);
    if draw.once_in(2) {
        p.swap(0, 1);
    }
    let [p0, p1, p2] = p;
    In { start, direction, p0, p1, p2 }
}

/// Exactly through the point with these weights.
fn through(draw: &mut Draw, weights: [i64; 3]) -> In {
    let (p, d) = (corners(draw, POINT_MAX - WHOLE), draw.direction());
    let start = before(draw, weighted(p, weights), d);
    turned(draw, p, start, d)
}

fn inside(draw: &mut Draw) -> In {
    let weights = tri_test::inside_weights(draw);
    through(draw, weights)
}

fn vertex(draw: &mut Draw) -> In {
    through(draw, [WHOLE, 0, 0])
}

fn edge(draw: &mut Draw) -> In {
    let weights = edge_weights(draw);
    through(draw, weights)
}

/// From a triangle, in whatever direction: exactly in its plane and inside it.
fn own(draw: &mut Draw) -> In {
    let p = corners(draw, POINT_MAX);
    let start = on(draw, p);
    let d = if draw.once_in(4) { along(draw, p) } else { draw.direction() };
    turned(draw, p, start, d)
}

/// A point of a triangle with any weights.
fn on(draw: &mut Draw, p: [[i64; 3]; 3]) -> Start {
    let b1 = draw.below(BARY_ONE + 1) >> draw.below(32);
    let b2 = draw.below(BARY_ONE - b1 + 1) >> draw.below(32);
    let mut weights = [BARY_ONE - b1 - b2, b1, b2];
    weights.rotate_left(draw.below(3) as usize);
    leave::start(&p.map(point), weights.map(Bary::new))
}

/// A direction within a triangle's plane; not zero.
fn along(draw: &mut Draw, p: [[i64; 3]; 3]) -> Direction {
    let (m, n) = draw.one_of(&[(1, 0), (0, 1), (1, -1), (1, 1)]);
    let d = [0, 1, 2].map(|k| (m * (p[1][k] - p[0][k]) + n * (p[2][k] - p[0][k])) >> 3);
    let d = direction(d);
    if is_direction(d) && d != Direction::default() { d } else { draw.direction() }
}

/// The sheets next to the one that a ray leaves: a unit or a few from it.
fn next_sheet(draw: &mut Draw) -> In {
    let p = corners(draw, (POINT_MAX >> 1) - 8);
    let start = on(draw, p);
    let by = [0; 3].map(|_| draw.between(-2, 2));
    let p = p.map(|corner| [0, 1, 2].map(|k| corner[k] + by[k]));
    let d = draw.direction();
    turned(draw, p, start, d)
}

/// A neighbour of the triangle that a ray leaves, over one of its edges.
fn neighbour(draw: &mut Draw) -> In {
    let p = corners(draw, POINT_MAX - WHOLE);
    let start = on(draw, p);
    let mut q = p;
    q[draw.below(3) as usize] = corners(draw, POINT_MAX - WHOLE)[0];
    // Towards a point of the neighbour, as far as a direction can tell.
    let weights = any_weights(draw);
    let target = weighted(q, weights);
    let d = direction([0, 1, 2].map(|k| (target[k] - start.point.get()[k]) >> 3));
    let d = if is_direction(d) && d != Direction::default() { d } else { draw.direction() };
    turned(draw, q, start, d)
}

/// All corners on a line, or in one place.
fn no_area(draw: &mut Draw) -> In {
    let mut p = corners(draw, POINT_MAX);
    let along = draw.one_of(&[0, 1, WHOLE / 2, WHOLE]);
    p[2] = weighted(p, [along, WHOLE - along, 0]);
    let (start, d) = (on(draw, p), draw.direction());
    turned(draw, p, start, d)
}

fn extreme(draw: &mut Draw) -> In {
    let case = tri_test::largest(draw);
    of(&case, Start { point: case.origin, fraction: [0; 3].map(|_| if draw.once_in(4) { U::ZERO } else { U::MAX }) })
}

/// Exactly through an edge of which p x q begins with 1 or -1, the least that decides a tie. The edge begins at the whole point, so p x q is f x (p - q).
fn least_tie(draw: &mut Draw) -> In {
    let f = [draw.between(0, 15), draw.between(0, 15), 1];
    let one = draw.one_of(&[-1, 1]);
    let along = if draw.once_in(4) { [one, 0, 0] } else { [draw.between(-8, 8), one, 0] };
    let n = [-f[2] * along[1], f[2] * along[0], f[0] * along[1] - f[1] * along[0]];
    // d.n = 0, and down to the edge.
    let [any, y, z] = [draw.signed(1 << 20), draw.signed(1 << 20), draw.between(-1 << 20, -1)];
    let d = if n[0] == 0 { [any, -z * n[2] * n[1], z] } else { [-n[0] * (y * n[1] + z * n[2]), y, z] };
    let at = draw.point(POINT_MAX >> 1);
    let size = (POINT_MAX >> 2) >> draw.below(29);
    let beside = |by: [i64; 3]| [0, 1, 2].map(|k| at.get()[k] + by[k]);
    let p = [at.get(), beside(along.map(|c| -c)), beside([0; 3].map(|_| draw.signed(size)))];
    let start = Start { point: at, fraction: f.map(|f| U::new(f.cast_unsigned())) };
    turned(draw, p, start, direction(d))
}

/// What decides each tie: the first component of p x q that is not 0, as its place, its value and the next component that is not 0.
fn deciding(i: &In) -> impl Iterator<Item = (usize, [i128; 2])> {
    let ties = edges(i).into_iter().filter(|(value, _)| *value == 0);
    ties.filter_map(|(_, n)| {
        let mut counting = n.into_iter().enumerate().filter(|(_, c)| *c != 0);
        let (place, first) = counting.next()?;
        Some((place, [first, counting.next().map_or(0, |(_, next)| next)]))
    })
}

/// Whether a tie is decided by a 1 in this component, and would be decided otherwise without it.
fn is_by_one(i: &In, component: usize) -> bool {
    deciding(i).any(|(place, [first, next])| place == component && first == 1 && next < 0)
}

/// Exact d.(p x q) in steps of 2^-31 and p x q in the same, of the three edges.
fn edges(i: &In) -> [(i128, [i128; 3]); 3] {
    let x = i.start.point.get();
    let f = i.start.fraction.map(|f| i128::from(f.get()));
    let p = [i.p0, i.p1, i.p2].map(|p| [0, 1, 2].map(|k| i128::from(p.get()[k] - x[k])));
    let d = i.direction.get().map(i128::from);
    [(1, 2), (2, 0), (0, 1)].map(|(a, b)| {
        let (p, q) = (p[a], p[b]);
        let n = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| (p[j] * q[k] - p[k] * q[j]) * ONE + f[j] * (p[k] - q[k]) - f[k] * (p[j] - q[j]));
        (d[0] * n[0] + d[1] * n[1] + d[2] * n[2], n)
    })
}

/// Edge functions that are 0 though p x q is not.
fn ties(i: &In) -> usize {
    edges(i).iter().filter(|(value, normal)| *value == 0 && *normal != [0; 3]).count()
}

fn is_whole(i: &In) -> bool {
    i.start.fraction == [U::ZERO; 3]
}

/// What the test says of the whole point alone.
fn of_point(i: &In) -> block::tri_test::Out {
    let &In { start, direction, p0, p1, p2 } = i;
    TriTest::eval(&block::tri_test::In { origin: start.point, direction, p0, p1, p2 })
}

type Is = Category<StartTest>;

pub fn suite() -> Suite<StartTest> {
    Suite::new(
        |i| is_direction(i.direction) && [i.start.point, i.p0, i.p1, i.p2].into_iter().all(is_point),
        vec![
            Is::any("random", random),
            Is::any("beside a case of whole points", beside),
            Is::all("whole points", whole, |i, o| of_point(i) == o.test && o.below == Below::default()),
            Is::often("inside", inside, |_, o| o.test.hit),
            Is::often("through a vertex", vertex, |i, _| ties(i) >= 2),
            Is::often("through an edge", edge, |i, _| ties(i) >= 1),
            Is::all("the triangle that it leaves", own, |_, o| !o.test.hit),
            Is::some("the next sheet", next_sheet, |i, o| o.test.hit && o.test.t_num.get() << 20 < o.test.det.get() && !is_whole(i)),
            Is::some("a neighbour", neighbour, |_, o| o.test.hit),
            Is::all("no area", no_area, |_, o| !o.test.hit),
            Is::all("the least tie", least_tie, |i, _| deciding(i).any(|(_, [first, _])| first.abs() == 1)),
            Is::all("the largest", extreme, |_, o| o.test.t_num.get() > 31 << 92 || !o.test.hit),
        ],
        vec![
            ("edge tie of a fraction, hit", |i, o| o.test.hit && ties(i) == 1 && !is_whole(i)),
            ("edge tie of a fraction, miss", |i, o| !o.test.hit && ties(i) == 1 && !is_whole(i)),
            ("vertex tie of a fraction, hit", |i, o| o.test.hit && ties(i) == 2 && !is_whole(i)),
            ("three ties", |i, _| ties(i) == 3 && !is_whole(i)),
            ("ties decided by y", |i, o| o.test.hit && edges(i).iter().any(|(v, n)| *v == 0 && n[0] == 0 && n[1] != 0)),
            ("ties decided by z", |i, o| o.test.hit && edges(i).iter().any(|(v, n)| *v == 0 && n[0] == 0 && n[1] == 0 && n[2] != 0)),
            ("ties decided by 1 in x against y or z, hit", |i, o| o.test.hit && is_by_one(i, 0)),
            ("ties decided by 1 in y against z, hit", |i, o| o.test.hit && is_by_one(i, 1)),
            ("met though the whole point's ray misses", |i, o| o.test.hit && !of_point(i).hit),
            ("missed though the whole point's ray meets", |i, o| !o.test.hit && of_point(i).hit),
            ("t below 1", |_, o| o.test.hit && o.test.t_num.get() == 0 && o.below.t != U::ZERO),
            ("v below 1", |_, o| o.test.hit && o.test.v.get() == 0 && o.below.v != U::ZERO),
            ("many bits below", |_, o| o.test.hit && o.below.w.get() & 0xFF == 0xFF),
        ],
        vec![
            ("hit of the back, of the front", 0..=2, |_, o| if o.test.hit { 1 + u64::from(o.test.front) } else { 0 }),
            ("signs of u, v, w", 0..=26, |i, _| {
                edges(i).iter().fold(0, |code, (v, _)| 3 * code + (v.signum() + 1) as u64) // 0 to 2
            }),
        ],
    )
}

fn with(edges_per_cycle: u32, timing: Timing) -> Suite<StartTest> {
    Suite { build: Build::block::<StartTest>().parameter("EDGES_PER_CYCLE", edges_per_cycle), timing, ..suite() }
}

crate::suite::modes!(three_edges_per_cycle: with(3, StartTest::THREE_EDGES));
crate::suite::modes!(one_edge_per_cycle: with(1, StartTest::ONE_EDGE));
