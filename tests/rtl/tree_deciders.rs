//! Which ray decides in a base triangle: triangles that share corners with the last hit's, in every way.

use crate::draw::{Draw, POINT_MAX};
use crate::suite::{Category, Suite};
use lodray::block::tree_deciders::{In, TreeDeciders};
use lodray::num::{Point, U};

/// Triangles of these corners.
fn of(draw: &mut Draw, [a0, a1, a2]: [Point; 3], [p0, p1, p2]: [Point; 3]) -> In {
    let last = draw.bits();
    let tree = if draw.once_in(4) { last } else { draw.bits() };
    In { last, a0, a1, a2, second: [0; 3].map(|_| draw.once_in(2)), tree, p0, p1, p2 }
}

fn corners(draw: &mut Draw) -> [Point; 3] {
    [0; 3].map(|_| draw.point(POINT_MAX))
}

fn random(draw: &mut Draw) -> In {
    let (a, p) = (corners(draw), corners(draw));
    of(draw, a, p)
}

/// Corners of a handful of points: shared in any number, in any order, and not always different from each other.
fn of_few(draw: &mut Draw) -> In {
    let few = [0; 5].map(|_| draw.point(POINT_MAX));
    let (a, p) = ([0; 3].map(|_| draw.one_of(&few)), [0; 3].map(|_| draw.one_of(&few)));
    of(draw, a, p)
}

/// Two corners shared.
fn neighbours(draw: &mut Draw) -> In {
    let (a, apart) = (corners(draw), draw.point(POINT_MAX));
    let k = draw.below(3) as usize;
    let mut p = [a[(k + 2) % 3], a[(k + 1) % 3], apart];
    p.rotate_left(draw.below(3) as usize);
    if draw.once_in(2) {
        p.swap(0, 1);
    }
    of(draw, a, p)
}

/// A corner that differs from a shared one by one bit.
fn almost(draw: &mut Draw) -> In {
    let mut input = neighbours(draw);
    let mut v = input.p0.get();
    v[draw.below(3) as usize] ^= 1 << draw.below(31);
    let [x, y, z] = v.map(|v| v.clamp(-POINT_MAX, POINT_MAX));
    input.p0 = Point::new(x, y, z);
    input
}

fn same(draw: &mut Draw) -> In {
    let input = random(draw);
    In { tree: input.last, p0: input.a0, p1: input.a1, p2: input.a2, ..input }
}

fn both_sides(draw: &mut Draw) -> In {
    let a = corners(draw);
    of(draw, a, [a[0], a[2], a[1]])
}

type Is = Category<TreeDeciders>;

pub fn suite() -> Suite<TreeDeciders> {
    Suite::new(
        |_| true,
        vec![
            Is::any("random", random),
            Is::any("of few points", of_few),
            Is::often("neighbours", neighbours, |i, o| i.tree != i.last && o.edges.iter().filter(|by| by.get() > 0).count() == 1),
            Is::often("almost neighbours", almost, |_, o| !o.is_any()),
            Is::all("the same triangle", same, |_, o| o.inner == U::new(1) && o.edges.iter().all(|by| by.get() > 0)),
            Is::all("both sides of one", both_sides, |_, o| o.edges.iter().all(|by| by.get() > 0)),
        ],
        vec![
            ("another number at the same corners", |i, o| i.tree != i.last && o.inner == U::ZERO && o.edges.iter().all(|by| by.get() > 0)),
            ("the second viewer about one edge, the first about another", |_, o| {
                o.edges.contains(&U::new(2)) && o.edges.contains(&U::new(1))
            }),
        ],
        vec![
            ("inner", 0..=1, |_, o| o.inner.get()),
            ("edge 0", 0..=2, |_, o| o.edges[0].get()),
            ("edge 1", 0..=2, |_, o| o.edges[1].get()),
            ("edge 2", 0..=2, |_, o| o.edges[2].get()),
        ],
    )
}

crate::suite::modes!(suite());
