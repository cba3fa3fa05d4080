//! Boxes of children.

use crate::draw::Draw;
use crate::rays::point;
use crate::suite::{Category, Suite};
use lodray::block::child_boxes::{ChildBoxes, In, Out};
use lodray::block::tessellate::child_triangle;
use lodray::num::{Box16, COORD_LIMIT, Point, U, Vec3};

const LIMIT: i64 = 0x7FFE_0000;
const _: () = assert!(LIMIT == COORD_LIMIT as i64);
const MOST: i64 = 32767;

/// Twelve points: corners and inserted vertices at full resolution, and the same as morphed.
pub fn with_points(input: In, [f0, f1, f2, g0, g1, g2]: [Point; 6], [p0, p1, p2, q0, q1, q2]: [Point; 6]) -> In {
    In { f0, f1, f2, g0, g1, g2, p0, p1, p2, q0, q1, q2, ..input }
}

fn tree(draw: &mut Draw, mut vertex: impl FnMut(&mut Draw) -> Point) -> In {
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| vertex(draw)));
    let input = In {
        tree: true,
        halves: [0; 3].map(|_| draw.once_in(2)),
        exponents: [0; 3].map(|_| U::new(draw.below(16))),
        planes: [0; 24].map(|_| draw.bits()),
        ..In::default()
    };
    with_points(input, full, morphed)
}

fn random(draw: &mut Draw) -> In {
    tree(draw, Draw::model_point)
}

/// Planes that let out by nothing.
fn tight(input: In) -> In {
    In { planes: [U::ZERO; 24], ..input }
}

/// Excess of a few codes.
fn few(draw: &mut Draw) -> In {
    In { exponents: [0; 3].map(|_| U::new(draw.below(3))), ..random(draw) }
}

fn on_steps(draw: &mut Draw, by: i64) -> In {
    let input = tree(draw, |draw| point([0; 3].map(|_| (draw.signed(32765) << 16) + by)));
    if draw.once_in(2) { tight(input) } else { In { exponents: [U::ZERO; 3], ..input } }
}

/// Above steps by one bit: each bit below the code counts for a ceiling.
fn above_by_a_bit(draw: &mut Draw) -> In {
    tight(tree(draw, |draw| point([0; 3].map(|_| (draw.signed(32765) << 16) + (1 << draw.below(16))))))
}

fn around_zero(draw: &mut Draw) -> In {
    tight(tree(draw, |draw| point([0; 3].map(|_| draw.between(-3, 3)))))
}

fn at_the_limit(draw: &mut Draw) -> In {
    tight(tree(draw, |draw| point([LIMIT; 3].map(|v| draw.sign(v)))))
}

fn one_point(draw: &mut Draw) -> In {
    let p = draw.model_point();
    tight(tree(draw, |_| p))
}

/// No vertex has moved.
fn unmorphed(draw: &mut Draw) -> In {
    unmoved(&few(draw))
}

/// The same without morphing.
fn unmoved(i: &In) -> In {
    let full = full(i);
    with_points(*i, full, full)
}

/// Let out to both ends of the range.
fn far_out(draw: &mut Draw) -> In {
    In { exponents: [U::MAX; 3], planes: [0; 24].map(|_| U::new(4 + draw.below(28))), ..random(draw) }
}

/// The excess ends where the morphed triangle does, or a code beside.
fn level(draw: &mut Draw) -> In {
    let input = tree(draw, |draw| point([0; 3].map(|_| draw.signed(LIMIT / 2))));
    let by = draw.between(0, 31);
    let (halves, exponents) = ([false; 3], [U::ZERO; 3]);
    // All corners in the same place, and morphed by as much, in codes.
    let from = input.f0.get().map(|v| v >> 16 << 16);
    let way = draw.sign(1);
    let to = from.map(|v| v + ((way * (by + draw.beside())) << 16) + draw.beside());
    let planes = [U::new(by.unsigned_abs()); 24];
    In { halves, exponents, planes, ..with_points(input, [point(from); 6], [point(to); 6]) }
}

fn node(draw: &mut Draw) -> In {
    let origin = Vec3::new(draw.signed(MOST), draw.signed(MOST), draw.signed(MOST));
    let planes = [0; 24].map(|_| draw.bits());
    // Whatever the registers of a triangle hold.
    let [full, morphed] = [0; 2].map(|_| [0; 6].map(|_| point([0; 3].map(|_| draw.between(i32::MIN.into(), i32::MAX.into())))));
    with_points(In { tree: false, origin, planes, ..random(draw) }, full, morphed)
}

fn node_within(draw: &mut Draw) -> In {
    In { exponents: [0; 3].map(|_| U::new(draw.below(11))), ..node(draw) }
}

fn node_at_the_origin(draw: &mut Draw) -> In {
    tight(node(draw))
}

fn node_of_all_of_space(draw: &mut Draw) -> In {
    In { origin: Vec3::new(-MOST, -MOST, -MOST), planes: [U::new(31); 24], exponents: [U::new(12); 3], ..node(draw) }
}

fn full(i: &In) -> [Point; 6] {
    [i.f0, i.f1, i.f2, i.g0, i.g1, i.g2]
}

fn morphed(i: &In) -> [Point; 6] {
    [i.p0, i.p1, i.p2, i.q0, i.q1, i.q2]
}

/// Box of child `k` of a triangle with its inserted vertices.
fn own([p0, p1, p2, q0, q1, q2]: [Point; 6], k: usize) -> Box16 {
    let corners = child_triangle([p0, p1, p2], [q0, q1, q2], k);
    Box16::of_points(&corners.map(|p| p.get().map(|v| v as i32))) // 32 bits
}

/// Codes of the plane at `at` of child `k`.
fn steps(i: &In, k: usize, at: usize) -> i64 {
    let twice = (i.planes[6 * k + at].get() * (2 + u64::from(i.halves[at % 3]))) << i.exponents[at % 3].get();
    (twice / 2).cast_signed()
}

fn sides(b: &Box16) -> [i64; 6] {
    let ([a, b, c], [d, e, f]) = (b.lo.get(), b.hi.get());
    [a, b, c, d, e, f]
}

/// Which sides of child 0 of a tree's node its morphed triangle decides alone.
fn decided(i: &In, o: &Out) -> u64 {
    if !i.tree {
        return 0;
    }
    let (all, full) = (sides(&o.bounds[0]), sides(&own(full(i), 0)));
    let out = |at: usize| if at < 3 { (full[at] - steps(i, 0, at)).max(-MOST) } else { (full[at] + steps(i, 0, at)).min(MOST) };
    (0..6).map(|at| u64::from(all[at] != out(at)) << at).sum()
}

fn legal(i: &In) -> bool {
    let points = || full(i).into_iter().chain(morphed(i));
    i.origin.get().iter().all(|&v| v >= -MOST) && (!i.tree || points().all(|p| p.get().iter().all(|v| v.abs() <= LIMIT)))
}

type Is = Category<ChildBoxes>;

pub fn suite() -> Suite<ChildBoxes> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::any("a few codes of excess", few),
            Is::any("on steps of box codes", |d| on_steps(d, 0)),
            Is::any("just above steps", |d| on_steps(d, 1)),
            Is::all("above steps by one bit", above_by_a_bit, |i, o| {
                let [full, morphed, all] = [own(full(i), 3), own(morphed(i), 3), o.bounds[3]].map(|b| sides(&b));
                (0..3).all(|at| all[at] == full[at].min(morphed[at])) && (3..6).all(|at| all[at] == full[at].max(morphed[at]))
            }),
            Is::any("just below steps", |d| on_steps(d, -1)),
            Is::all("around zero", around_zero, |_, o| {
                o.bounds.iter().all(|b| b.lo.get().iter().all(|v| [-1, 0].contains(v)) && b.hi.get().iter().all(|v| [0, 1].contains(v)))
            }),
            Is::often("at the limit", at_the_limit, |_, o| o.bounds[3].lo.get().contains(&-32766) && o.bounds[3].hi.get().contains(&32766)),
            Is::all("no extent", one_point, |i, o| (0..4).all(|k| o.bounds[k] == own(full(i), 0))),
            Is::all("nothing morphed", unmorphed, |i, o| {
                (0..4).all(|k| {
                    let (own, all) = (sides(&own(full(i), k)), sides(&o.bounds[k]));
                    (0..3).all(|at| all[at] == (own[at] - steps(i, k, at)).max(-MOST))
                        && (3..6).all(|at| all[at] == (own[at] + steps(i, k, at)).min(MOST))
                })
            }),
            Is::often("to the ends of the range", far_out, |_, o| {
                o.bounds.iter().all(|b| b.lo.get() == [-MOST; 3] && b.hi.get() == [MOST; 3])
            }),
            Is::any("excess as far as morphing", level),
            Is::any("children of a quad-BVH node", node),
            Is::often("of these within the range", node_within, |_, o| o.bounds.iter().all(|b| b.hi.get().iter().all(|&v| v < MOST))),
            Is::all("at the origin", node_at_the_origin, |i, o| o.bounds.iter().all(|b| b.lo == i.origin && b.hi == i.origin)),
            Is::all("beyond the range", node_of_all_of_space, |_, o| {
                o.bounds.iter().all(|b| b.lo.get() == [MOST; 3] && b.hi.get() == [MOST; 3])
            }),
        ],
        vec![
            ("morphed by as much as the excess", |i, o| {
                i.tree && i.planes[0].get() > 0 && o.bounds[0].lo.get()[0] == own(morphed(i), 0).lo.get()[0] && decided(i, o) == 0
            }),
            ("half a code, rounded down", |i, o| {
                let odd = i.tree && i.halves[1] && i.exponents[1].get() == 0 && i.planes[4].get() & 1 == 1;
                odd && decided(i, o) == 0
            }),
            ("the lower end of the range, not beyond it", |i, o| {
                i.tree && o.bounds[2].lo.get()[0] == -MOST && sides(&own(full(i), 2))[0] - steps(i, 2, 0) == -MOST
            }),
            ("a node's plane at the last code", |i, o| {
                !i.tree && o.bounds[1].lo.get()[2] == MOST && i.origin.get()[2] + steps(i, 1, 2) == MOST
            }),
        ],
        vec![
            ("sides that the morphed triangle decides", 0..=63, decided),
            ("tree", 0..=1, |i, _| i.tree.into()),
            ("exponent", 0..=15, |i, _| i.exponents[2].get()),
            ("halves", 0..=7, |i, _| i.halves.iter().fold(0, |all, &half| all << 1 | u64::from(half))),
        ],
    )
}

crate::suite::modes!(suite());
