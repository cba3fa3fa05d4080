//! The triangle test, with three edges per cycle and with one.

use crate::draw::{DIRECTION_MAX, Draw, POINT_MAX};
use crate::rays::{DIAGONAL, direction, is_direction, is_point, point};
use crate::suite::{Category, Suite};
use lodray::block::Timing;
use lodray::block::tri_test::{In, TriTest};
use lodray::num::{Direction, Point};
use tb::Build;

/// Corners of the exact cases are multiples of 2^FINE, so that points between them with weights of 2^-FINE are whole.
const FINE: u32 = 8;
pub const WHOLE: i64 = 1 << FINE;

fn random(draw: &mut Draw) -> In {
    let [p0, p1, p2] = [0; 3].map(|_| draw.point(POINT_MAX));
    In { origin: draw.point(POINT_MAX), direction: draw.direction(), p0, p1, p2 }
}

/// Three points with coordinates up to `max`, of every size and shape.
pub fn corners(draw: &mut Draw, max: i64) -> [[i64; 3]; 3] {
    let size = (max >> draw.below(16)) >> FINE;
    match draw.below(4) {
        // Small numbers: axis-aligned edges and coincidences are common.
        0 => [0; 3].map(|_| [0; 3].map(|_| draw.between(-3, 3) << FINE)),
        1 => [0; 3].map(|_| [0; 3].map(|_| draw.signed(size) << FINE)),
        _ => [0; 3].map(|_| [0; 3].map(|_| draw.between(-size, size) << FINE)),
    }
}

/// The point with these weights, of which 2^FINE make one.
pub fn weighted(p: [[i64; 3]; 3], weights: [i64; 3]) -> [i64; 3] {
    [0, 1, 2].map(|k| (0..3).map(|i| weights[i] * p[i][k]).sum::<i64>() >> FINE)
}

/// A triangle of these corners from any of them on, in either winding.
fn turned(draw: &mut Draw, origin: Point, direction: Direction, p: [[i64; 3]; 3]) -> In {
    let mut p = p.map(point);
    p.rotate_left(draw.below(3) as usize);
    if draw.once_in(2) {
        p.swap(0, 1);
    }
    let [p0, p1, p2] = p;
    In { origin, direction, p0, p1, p2 }
}

/// A ray exactly through the point with these weights.
fn through(draw: &mut Draw, weights: [i64; 3], d: Direction) -> In {
    let p = corners(draw, POINT_MAX);
    let origin = draw.before(weighted(p, weights), d);
    turned(draw, origin, d, p)
}

pub fn inside_weights(draw: &mut Draw) -> [i64; 3] {
    let (x, y) = (draw.between(1, WHOLE - 2), draw.between(1, WHOLE - 2));
    let (low, high) = (x.min(y), x.max(y) + 1);
    [WHOLE - high, high - low, low]
}

pub fn edge_weights(draw: &mut Draw) -> [i64; 3] {
    let along = draw.between(1, WHOLE - 1);
    [along, WHOLE - along, 0]
}

/// A ray through a triangle, as a frame has them: from any distance, hits by any weights.
pub fn inside(draw: &mut Draw) -> In {
    let (p, weights) = (corners(draw, DIRECTION_MAX), inside_weights(draw));
    let d = if draw.once_in(4) { draw.direction() } else { draw.full_direction() };
    let origin = draw.afar(weighted(p, weights), d);
    turned(draw, origin, d, p)
}

fn behind(draw: &mut Draw) -> In {
    let p = corners(draw, DIRECTION_MAX);
    let (weights, d) = (inside_weights(draw), draw.direction());
    let origin = draw.beyond(weighted(p, weights), d);
    turned(draw, origin, d, p)
}

fn vertex(draw: &mut Draw) -> In {
    let d = draw.direction();
    through(draw, [WHOLE, 0, 0], d)
}

fn edge(draw: &mut Draw) -> In {
    let (weights, d) = (edge_weights(draw), draw.direction());
    through(draw, weights, d)
}

/// Through the line of an edge, beyond its end.
fn edge_line(draw: &mut Draw) -> In {
    let p = corners(draw, DIRECTION_MAX / 2);
    let (past, d) = (draw.between(1, WHOLE), draw.direction());
    let origin = draw.before(weighted(p, [WHOLE + past, -past, 0]), d);
    turned(draw, origin, d, p)
}

pub fn any_weights(draw: &mut Draw) -> [i64; 3] {
    match draw.below(3) {
        0 => [0, WHOLE, 0],
        1 => edge_weights(draw),
        _ => inside_weights(draw),
    }
}

fn axis_parallel(draw: &mut Draw) -> In {
    let (weights, d) = (any_weights(draw), draw.axis_parallel());
    through(draw, weights, d)
}

fn plane_parallel(draw: &mut Draw) -> In {
    let (weights, d) = (any_weights(draw), draw.plane_parallel());
    through(draw, weights, d)
}

/// A unit beside a tie.
fn beside(draw: &mut Draw) -> In {
    let input = if draw.once_in(2) { edge(draw) } else { vertex(draw) };
    let mut origin = input.origin.get();
    let k = draw.below(3) as usize;
    origin[k] = (origin[k] + draw.sign(1)).clamp(-POINT_MAX, POINT_MAX);
    In { origin: point(origin), ..input }
}

/// Whole numbers of halves of edges as a direction: in the plane, often along an edge; with the point that the ray passes.
fn in_plane_parts(draw: &mut Draw) -> ([[i64; 3]; 3], [i64; 3], Direction) {
    let p = corners(draw, DIRECTION_MAX / 4);
    let (m, n) = draw.one_of(&[(1, 0), (0, 1), (1, -1), (1, 1), (2, -1), (-1, 2)]);
    let d = [0, 1, 2].map(|k| (m * (p[1][k] - p[0][k]) + n * (p[2][k] - p[0][k])) >> 1);
    let weights = any_weights(draw);
    (p, weighted(p, weights), if d == [0; 3] { Direction::new(1, 0, 0) } else { direction(d) })
}

/// The ray lies in the triangle's plane.
fn in_plane(draw: &mut Draw) -> In {
    let (p, target, d) = in_plane_parts(draw);
    let origin = draw.before(target, d);
    turned(draw, origin, d, p)
}

/// Almost in the plane: it meets the triangle at the flattest angle there is.
fn grazing(draw: &mut Draw) -> In {
    let (p, target, d) = in_plane_parts(draw);
    let mut d = d.get();
    d[draw.below(3) as usize] += draw.sign(1);
    let d = if d == [0; 3] { Direction::new(0, 1, 0) } else { direction(d) };
    let origin = draw.before(target, d);
    turned(draw, origin, d, p)
}

/// The origin in the triangle: t = 0.
fn on_the_surface(draw: &mut Draw) -> In {
    let (p, weights) = (corners(draw, POINT_MAX), inside_weights(draw));
    let d = draw.direction();
    turned(draw, point(weighted(p, weights)), d, p)
}

/// The origin at a vertex, on an edge, or on its line: p x q = 0.
fn on_an_edge(draw: &mut Draw) -> In {
    let p = corners(draw, DIRECTION_MAX / 2);
    let along = draw.one_of(&[-WHOLE, -1, 0, 1, WHOLE / 2, WHOLE, WHOLE + 1]);
    let d = draw.direction();
    turned(draw, point(weighted(p, [along, WHOLE - along, 0])), d, p)
}

/// Needles: one corner within a unit of the line of the others, hit exactly on the line.
fn sliver(draw: &mut Draw) -> In {
    let mut p = corners(draw, POINT_MAX - 1);
    let weights = edge_weights(draw);
    let d = draw.direction();
    let origin = draw.before(weighted(p, weights), d);
    let weights = edge_weights(draw);
    p[2] = weighted(p, weights).map(|v| v + draw.beside());
    turned(draw, origin, d, p)
}

/// All corners on a line, two of them in one place, or all.
fn no_area(draw: &mut Draw) -> In {
    let mut p = corners(draw, POINT_MAX);
    let (weights, d) = (any_weights(draw), draw.direction());
    let origin = draw.before(weighted(p, weights), d);
    let along = draw.one_of(&[0, 1, WHOLE / 2, WHOLE]);
    p[2] = weighted(p, [along, WHOLE - along, 0]);
    if draw.once_in(4) {
        p[1] = p[0];
        p[2] = p[0];
    }
    turned(draw, origin, d, p)
}

fn no_direction(draw: &mut Draw) -> In {
    In { direction: Direction::default(), ..inside(draw) }
}

fn extreme(draw: &mut Draw) -> In {
    let [p0, p1, p2] = [0; 3].map(|_| point(draw.corner()));
    let d = if draw.once_in(2) { direction([DIAGONAL; 3].map(|v| draw.sign(v))) } else { draw.axis_parallel() };
    In { origin: point(draw.corner()), direction: d, p0, p1, p2 }
}

/// The largest triangle as seen from a corner of the range, met by the longest diagonal.
pub fn largest(draw: &mut Draw) -> In {
    let from = draw.corner();
    let p = [0, 1, 2].map(|i| [0, 1, 2].map(|k| (if i == k { from[k] } else { -from[k] }) - from[k].signum() * draw.between(-9, 0)));
    // Inwards by up to nine units.
    let p = p.map(|p| p.map(|v| v.clamp(-POINT_MAX, POINT_MAX)));
    let d = direction(from.map(|v| -v.signum() * DIAGONAL));
    turned(draw, point(from), d, p)
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

/// Edges whose line passes through the origin.
fn through_origin(i: &In) -> usize {
    edges(i).iter().filter(|(_, normal)| *normal == [0; 3]).count()
}

fn det(i: &In) -> i128 {
    edges(i).iter().map(|(value, _)| value).sum()
}

fn legal(i: &In) -> bool {
    is_direction(i.direction) && [i.origin, i.p0, i.p1, i.p2].into_iter().all(is_point)
}

/// A ray and a triangle of any of the cases.
pub fn any(draw: &mut Draw) -> In {
    let cases = [
        random,
        inside,
        behind,
        vertex,
        edge,
        edge_line,
        axis_parallel,
        plane_parallel,
        beside,
        in_plane,
        grazing,
        on_the_surface,
        on_an_edge,
        sliver,
        no_area,
        no_direction,
        extreme,
        largest,
    ];
    draw.one_of(&cases)(draw)
}

type Is = Category<TriTest>;

pub fn suite() -> Suite<TriTest> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::often("inside", inside, |_, o| o.hit),
            Is::all("inside, behind the origin", behind, |i, o| !o.hit || ties(i) > 0),
            Is::often("through a vertex", vertex, |i, _| ties(i) >= 2),
            Is::often("through an edge", edge, |i, _| ties(i) >= 1),
            Is::often("through an edge's line beyond its end", edge_line, |i, o| ties(i) >= 1 && !o.hit),
            Is::some("axis-parallel", axis_parallel, |i, o| o.hit && ties(i) > 0),
            Is::some("parallel to a plane", plane_parallel, |i, o| o.hit && ties(i) > 0),
            Is::some("one unit beside a tie", beside, |i, o| o.hit && ties(i) == 0),
            Is::all("in the plane", in_plane, |i, o| !o.hit && (det(i) == 0 || i.direction.get() == [1, 0, 0])),
            Is::some("grazing", grazing, |_, o| o.hit),
            Is::all("origin on the surface", on_the_surface, |_, o| !o.hit),
            Is::all("origin on an edge or its line", on_an_edge, |i, o| through_origin(i) > 0 && !o.hit),
            Is::some("slivers", sliver, |_, o| o.hit),
            Is::all("no area", no_area, |i, o| !o.hit && det(i) == 0),
            Is::all("no direction", no_direction, |_, o| !o.hit),
            Is::some("extremes", extreme, |_, o| o.hit),
            Is::all("the largest", largest, |_, o| o.hit && o.t_num.get() > 31 << 92 && o.det.get() > 3 << 92),
        ],
        vec![
            ("edge tie, hit", |i, o| o.hit && ties(i) == 1),
            ("edge tie, miss", |i, o| !o.hit && ties(i) == 1),
            ("vertex tie, hit", |i, o| o.hit && ties(i) == 2),
            ("vertex tie, miss", |i, o| !o.hit && ties(i) == 2 && det(i) != 0),
            ("three ties", |i, _| ties(i) == 3),
            ("origin at a vertex", |i, _| through_origin(i) == 2 && det(i) != 0),
            ("origin on an edge", |i, _| through_origin(i) == 1 && det(i) != 0),
            ("ties decided by y", |i, o| o.hit && edges(i).iter().any(|(v, n)| *v == 0 && n[0] == 0 && n[1] != 0)),
            ("ties decided by z", |i, o| o.hit && edges(i).iter().any(|(v, n)| *v == 0 && n[0] == 0 && n[1] == 0 && n[2] != 0)),
            ("miss only because t <= 0", |i, o| {
                let e = edges(i);
                !o.hit && (e.iter().all(|(v, _)| *v > 0) || e.iter().all(|(v, _)| *v < 0))
            }),
            ("det = 1 or about", |_, o| o.hit && o.det.get() < 1 << 16),
            ("v = 0 and w = 0", |_, o| o.hit && o.v.get() == 0 && o.w.get() == 0),
        ],
        vec![
            ("hit of the back, of the front", 0..=2, |_, o| if o.hit { 1 + u64::from(o.front) } else { 0 }),
            ("signs of u, v, w", 0..=26, |i, _| {
                edges(i).iter().fold(0, |code, (v, _)| 3 * code + (v.signum() + 1) as u64) // 0 to 2
            }),
        ],
    )
}

fn with(edges_per_cycle: u32, timing: Timing) -> Suite<TriTest> {
    Suite { build: Build::block::<TriTest>().parameter("EDGES_PER_CYCLE", edges_per_cycle), timing, ..suite() }
}

crate::suite::modes!(three_edges_per_cycle: with(3, TriTest::THREE_EDGES));
crate::suite::modes!(one_edge_per_cycle: with(1, TriTest::ONE_EDGE));
