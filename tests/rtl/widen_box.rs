//! Boxes widened by morphed triangles.

use crate::draw::Draw;
use crate::rays::point;
use crate::suite::{Category, Suite};
use lodray::block::widen_box::{In, WidenBox};
use lodray::num::{Box16, COORD_LIMIT, Point};
use tb::Mode;

const LIMIT: i64 = 0x7FFE_0000;
const _: () = assert!(LIMIT == COORD_LIMIT as i64);

fn random(draw: &mut Draw) -> In {
    In { bounds: draw.box16(32767), p0: draw.model_point(), p1: draw.model_point(), p2: draw.model_point() }
}

fn triangle(draw: &mut Draw, mut corner: impl FnMut(&mut Draw) -> Point) -> In {
    In { bounds: draw.box16(32767), p0: corner(draw), p1: corner(draw), p2: corner(draw) }
}

/// Corners on a step of box codes, plus `by`.
fn on_steps(draw: &mut Draw, by: i64) -> In {
    triangle(draw, |draw| point([0; 3].map(|_| ((draw.signed(32766) << 16) + by).clamp(-LIMIT, LIMIT))))
}

fn around_zero(draw: &mut Draw) -> In {
    let input = triangle(draw, |draw| point([0; 3].map(|_| draw.between(-3, 3))));
    In { bounds: Box16::default(), ..input }
}

fn at_the_limit(draw: &mut Draw) -> In {
    triangle(draw, |draw| point([LIMIT; 3].map(|v| draw.sign(v))))
}

fn one_point(draw: &mut Draw) -> In {
    let p = draw.model_point();
    triangle(draw, |_| p)
}

/// A triangle in a box of the model.
fn inside(draw: &mut Draw) -> In {
    let bounds = draw.box16(32766);
    let (lo, hi) = (bounds.lo.get(), bounds.hi.get());
    let mut corner = || point([0, 1, 2].map(|k| draw.between(lo[k] << 16, hi[k] << 16)));
    In { bounds, p0: corner(), p1: corner(), p2: corner() }
}

/// A triangle one unit out of its box on every side.
fn just_outside(draw: &mut Draw) -> In {
    let bounds = draw.box16(32765);
    let (lo, hi) = (bounds.lo.get(), bounds.hi.get());
    let (p0, p1) = (point(lo.map(|v| (v << 16) - 1)), point(hi.map(|v| (v << 16) + 1)));
    In { bounds, p0, p1, p2: if draw.once_in(2) { p0 } else { p1 } }
}

fn legal(i: &In) -> bool {
    let (lo, hi) = (i.bounds.lo.get(), i.bounds.hi.get());
    let boxed = (0..3).all(|k| lo[k] <= hi[k] && lo[k] >= -32767 && hi[k] <= 32767);
    boxed && [i.p0, i.p1, i.p2].iter().all(|p| p.get().iter().all(|v| v.abs() <= LIMIT))
}

type Is = Category<WidenBox>;

pub fn suite() -> Suite<WidenBox> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::any("on steps of box codes", |d| on_steps(d, 0)),
            Is::any("just above steps", |d| on_steps(d, 1)),
            Is::any("just below steps", |d| on_steps(d, -1)),
            Is::all("around zero", around_zero, |_, o| {
                o.bounds.lo.get().iter().all(|v| [-1, 0].contains(v)) && o.bounds.hi.get().iter().all(|v| [0, 1].contains(v))
            }),
            Is::often("at the limit", at_the_limit, |_, o| o.bounds.lo.get().contains(&-32766) && o.bounds.hi.get().contains(&32766)),
            Is::any("no extent", one_point),
            Is::all("inside: nothing widened", inside, |i, o| o.bounds == i.bounds),
            Is::all("one unit outside: one step", just_outside, |i, o| {
                let (a, b) = (i.bounds, o.bounds);
                (0..3).all(|k| b.lo.get()[k] == a.lo.get()[k] - 1 && b.hi.get()[k] == a.hi.get()[k] + 1)
            }),
        ],
        vec![],
        vec![("sides widened", 0..=63, |i, o| {
            let (a, b) = (i.bounds, o.bounds);
            let moved = |x: [i64; 3], y: [i64; 3]| (0..3).map(|k| u64::from(x[k] != y[k]) << k).sum::<u64>();
            moved(a.lo.get(), b.lo.get()) << 3 | moved(a.hi.get(), b.hi.get())
        })],
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
