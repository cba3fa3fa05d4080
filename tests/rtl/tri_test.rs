use crate::draw::{Draw, POINT_MAX};
use crate::suite::{Category, Promise, Suite};
use lodray::block::Block;
use lodray::block::tri_test::{In, Out, TriTest};
use lodray::num::{Direction, Point};

/// Room for targets of exact rays.
const MIDDLE: i64 = 1 << 29;

fn point(v: [i64; 3]) -> Point {
    Point::new(v[0], v[1], v[2])
}

fn random(draw: &mut Draw) -> In {
    let [p0, p1, p2] = [0; 3].map(|_| draw.point(POINT_MAX));
    In { origin: draw.point(POINT_MAX), direction: draw.direction(), p0, p1, p2 }
}

/// A ray exactly through `weights` / 4 of the corners, which are moved so that this point is whole.
fn through(draw: &mut Draw, weights: [i64; 3], direction: Direction) -> In {
    let p = [0; 3].map(|_| draw.point(MIDDLE / 4).get().map(|v| 4 * v));
    let target = [0, 1, 2].map(|k| (0..3).map(|i| weights[i] * p[i][k] / 4).sum());
    let mut corners = p.map(point);
    corners.rotate_left(draw.below(3) as usize);
    if draw.once_in(2) {
        corners.swap(0, 1);
    }
    let [p0, p1, p2] = corners;
    In { origin: draw.origin_towards(target, direction), direction, p0, p1, p2 }
}

fn inside(draw: &mut Draw) -> In {
    let d = draw.short_direction();
    through(draw, [1, 1, 2], d)
}

fn vertex(draw: &mut Draw) -> In {
    let d = draw.short_direction();
    through(draw, [4, 0, 0], d)
}

fn edge(draw: &mut Draw) -> In {
    let d = draw.short_direction();
    let along = draw.below(5).cast_signed();
    through(draw, [along, 4 - along, 0], d)
}

/// Through the line of an edge, beyond its end.
fn edge_line(draw: &mut Draw) -> In {
    let d = draw.short_direction();
    through(draw, [5, -1, 0], d)
}

fn axis_parallel(draw: &mut Draw) -> In {
    let [x, y, z] = draw.axis_parallel().get().map(|v| v >> 2);
    let weights = [[2, 1, 1], [2, 2, 0], [4, 0, 0]][draw.below(3) as usize];
    through(draw, weights, Direction::new(x, y, z))
}

/// A unit beside a tie.
fn beside(draw: &mut Draw) -> In {
    let input = if draw.once_in(2) { edge(draw) } else { vertex(draw) };
    let mut origin = input.origin.get();
    let k = draw.below(3) as usize;
    origin[k] = (origin[k] + if draw.once_in(2) { 1 } else { -1 }).clamp(-POINT_MAX, POINT_MAX);
    In { origin: point(origin), ..input }
}

/// Along an edge: the ray lies in the triangle's plane, and two edge functions tie.
fn in_plane(draw: &mut Draw) -> In {
    let input = inside(draw);
    let (a, b) = (input.p0.get(), input.p1.get());
    let [x, y, z] = [0, 1, 2].map(|k| (b[k] - a[k]) / 4);
    let direction = Direction::new(x, y, z);
    let steps = draw.below(4).cast_signed();
    let from = if draw.once_in(2) { a } else { input.p2.get() };
    let origin = [0, 1, 2].map(|k| from[k] - steps * direction.get()[k]);
    In { origin: point(origin), direction, ..input }
}

/// Nearly in the plane.
fn grazing(draw: &mut Draw) -> In {
    let input = in_plane(draw);
    let mut d = input.direction.get();
    d[draw.below(3) as usize] += draw.below(3).cast_signed() - 1;
    In { direction: Direction::new(d[0], d[1], d[2]), ..input }
}

/// Origin at a vertex, or on an edge or its line: p x q = 0.
fn origin_on_edge(draw: &mut Draw) -> In {
    let input = edge(draw);
    let (a, b) = (input.p0.get(), input.p1.get());
    let along = draw.below(6).cast_signed() - 1;
    let origin = [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) / 4 * along);
    In { origin: point(origin), ..input }
}

/// Needles, and triangles of no area at all.
fn degenerate(draw: &mut Draw) -> In {
    let input = if draw.once_in(2) { edge(draw) } else { vertex(draw) };
    let (a, b) = (input.p0.get(), input.p1.get());
    let p2 = match draw.below(4) {
        0 => a,
        1 => [0, 1, 2].map(|k| (a[k] + b[k]) / 2),
        2 => [0, 1, 2].map(|k| b[k] + draw.signed(1)),
        _ => return In { p1: input.p0, p2: input.p0, ..input },
    };
    In { p2: point(p2), ..input }
}

/// Corners of the coordinate range: the widest products.
fn extreme(draw: &mut Draw) -> In {
    let side = |draw: &mut Draw| if draw.once_in(2) { POINT_MAX } else { -POINT_MAX };
    let corner = |draw: &mut Draw| Point::new(side(draw), side(draw), side(draw));
    // (2^30 / sqrt 3) in each component.
    let component = |draw: &mut Draw| if draw.once_in(2) { 619_925_131 } else { -619_925_131 };
    let direction = if draw.once_in(2) { Direction::new(component(draw), component(draw), component(draw)) } else { draw.axis_parallel() };
    In { origin: corner(draw), direction, p0: corner(draw), p1: corner(draw), p2: corner(draw) }
}

/// d.(p x q) and p x q of the three edges, in 128 bits.
fn edges(i: &In) -> [(i128, [i128; 3]); 3] {
    let x = i.origin.get();
    let p = [i.p0, i.p1, i.p2].map(|p| [0, 1, 2].map(|k| i128::from(p.get()[k] - x[k])));
    let d = i.direction.get().map(i128::from);
    [(1, 2), (2, 0), (0, 1)].map(|(a, b)| {
        let (p, q) = (p[a], p[b]);
        let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        (d[0] * n[0] + d[1] * n[1] + d[2] * n[2], n)
    })
}

/// Edge functions that are 0 though p x q is not.
fn ties(i: &In) -> usize {
    edges(i).iter().filter(|(value, normal)| *value == 0 && *normal != [0; 3]).count()
}

const CATEGORIES: &[Category<TriTest>] = &[
    ("random", random),
    ("inside", inside),
    ("through a vertex", vertex),
    ("through an edge", edge),
    ("through an edge's line", edge_line),
    ("axis-parallel", axis_parallel),
    ("one unit beside", beside),
    ("in the plane", in_plane),
    ("grazing", grazing),
    ("origin on an edge", origin_on_edge),
    ("slivers and no area", degenerate),
    ("extremes", extreme),
];

const PROMISES: &[Promise<TriTest>] = &[
    ("hit", |_, o: &Out| o.hit),
    ("miss", |_, o| !o.hit),
    ("front", |_, o| o.hit && o.front),
    ("back", |_, o| o.hit && !o.front),
    ("edge tie and hit", |i, o| o.hit && ties(i) == 1),
    ("edge tie and miss", |i, o| !o.hit && ties(i) == 1),
    ("vertex tie and hit", |i, o| o.hit && ties(i) == 2),
    ("in the plane", |i, o| !o.hit && ties(i) == 3),
    ("p x q = 0", |i, _| edges(i).iter().any(|(_, normal)| *normal == [0; 3])),
    ("t = 0", |_, o| o.hit && o.t_num.get() == 0),
    ("no area", |i, o| !o.hit && i.p0 == i.p2),
    ("edge functions beyond 2^94", |i, _| edges(i).iter().any(|(value, _)| value.abs() > 1 << 94)),
];

#[test]
fn rtl_equals_rust_at_three_edges_per_cycle() {
    Suite::<TriTest>::new(CATEGORIES, PROMISES).run();
}

#[test]
fn rtl_equals_rust_at_one_edge_per_cycle() {
    let suite = Suite::<TriTest>::new(CATEGORIES, PROMISES);
    Suite { build: suite.build.parameter("EDGES_PER_CYCLE", 1), timing: TriTest::ONE_EDGE, ..suite }.run();
}

#[test]
fn promises_know_a_tie() {
    let input = In {
        origin: point([0, 0, 8]),
        direction: Direction::new(0, 0, -4),
        p0: point([0, 0, 0]),
        p1: point([8, 0, 0]),
        p2: point([0, 8, 0]),
    };
    assert_eq!(ties(&input), 2);
    assert_eq!(TriTest::eval(&input).hit, TriTest::eval(&In { p1: input.p2, p2: input.p1, ..input }).hit);
}
