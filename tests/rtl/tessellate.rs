//! Morphed vertices.

use crate::draw::{Draw, POINT_MAX};
use crate::rays::{is_point, point};
use crate::suite::{Category, Suite};
use lodray::block::tessellate::{In, Tessellate};
use lodray::num::{EdgeState, MAX_LEVELS, Point, S_ONE, U};
use tb::Mode;

/// A point of which each coordinate has its low `zeros` bits zero.
fn on_grid(draw: &mut Draw, zeros: u64) -> Point {
    point([0; 3].map(|_| draw.signed(POINT_MAX >> zeros) << zeros))
}

fn triangle(draw: &mut Draw, mut state: impl FnMut(&mut Draw) -> EdgeState) -> In {
    let grid = draw.below(draw.levels);
    let [s0, s1, s2] = [0; 3].map(|_| state(draw));
    let [p0, p1, p2] = [0; 3].map(|_| on_grid(draw, grid + 1));
    let [q0, q1, q2] = [0; 3].map(|_| on_grid(draw, grid));
    In { grid: U::new(grid), s0, s1, s2, p0, p1, p2, q0, q1, q2 }
}

fn random(draw: &mut Draw) -> In {
    triangle(draw, |draw| U::new(draw.below(S_ONE + 1)))
}

fn with_state(draw: &mut Draw, s: u64) -> In {
    triangle(draw, |_| U::new(s))
}

fn border_states(draw: &mut Draw) -> In {
    triangle(draw, |draw| U::new(draw.one_of(&[0, 1, S_ONE - 1, S_ONE])))
}

fn edges(i: &In) -> [(Point, Point, Point); 3] {
    [(i.p1, i.p2, i.q0), (i.p2, i.p0, i.q1), (i.p0, i.p1, i.q2)]
}

fn midpoint(a: Point, b: Point) -> [i64; 3] {
    [0, 1, 2].map(|k| (a.get()[k] + b.get()[k]) / 2)
}

/// Inserted vertices a few steps of the grid from the midpoint: what is added rounds to none or few of them.
fn beside_midpoint(draw: &mut Draw, steps: i64) -> In {
    let input = random(draw);
    let grid = input.grid.get();
    let most = POINT_MAX >> grid;
    let [q0, q1, q2] = edges(&input)
        .map(|(a, b, _)| point(midpoint(a, b).map(|m| ((m >> grid) + draw.between(-steps, steps)).clamp(-most, most) << grid)));
    In { q0, q1, q2, ..input }
}

/// Edges in one corner of the range, their vertices in another.
fn extreme(draw: &mut Draw) -> In {
    let input = border_states(draw);
    let zeros = input.grid.get() + 1;
    let far = draw.corner().map(|v| v.signum() * (POINT_MAX >> zeros << zeros));
    let (p, q) = (point(far), point(far.map(|v| -v)));
    In { p0: p, p1: p, p2: p, q0: q, q1: q, q2: q, ..input }
}

fn legal(i: &In) -> bool {
    let grid = i.grid.get();
    let on = |p: Point, zeros: u64| is_point(p) && p.get().iter().all(|v| v & ((1 << zeros) - 1) == 0);
    grid <= 9
        && [i.s0, i.s1, i.s2].iter().all(|s| s.get() <= S_ONE)
        && [i.p0, i.p1, i.p2].into_iter().all(|p| on(p, grid + 1))
        && [i.q0, i.q1, i.q2].into_iter().all(|q| on(q, grid))
}

type Is = Category<Tessellate>;

/// For hardware of so many levels.
pub fn suite(levels: u64) -> Suite<Tessellate> {
    Suite::new(
        legal,
        vec![
            Is::any("random", random),
            Is::any("states at the borders", border_states),
            Is::all(
                "s = 0: midpoints",
                |d| with_state(d, 0),
                |i, o| edges(i).map(|(a, b, _)| midpoint(a, b)) == [o.q0, o.q1, o.q2].map(Point::get),
            ),
            Is::all("s just above 0", |d| with_state(d, 1), |i, _| i.s0.get() == 1),
            Is::all("s just below 1", |d| with_state(d, S_ONE - 1), |i, _| i.s0.get() == S_ONE - 1),
            Is::all("s = 1: stored vertices", |d| with_state(d, S_ONE), |i, o| [i.q0, i.q1, i.q2] == [o.q0, o.q1, o.q2]),
            Is::all("stored at the midpoint", |d| beside_midpoint(d, 0), |i, o| [i.q0, i.q1, i.q2] == [o.q0, o.q1, o.q2]),
            Is::any("a step from the midpoint", |d| beside_midpoint(d, 1)),
            Is::any("a few steps from the midpoint", |d| beside_midpoint(d, 300)),
            Is::all("the longest way", extreme, |i, _| (i.q0.get()[0] - i.p0.get()[0]).abs() > (1 << 32) - 4096),
        ],
        vec![("a step down that rounds to one", |i, o| {
            let (m, q, got) = (midpoint(i.p1, i.p2)[0], i.q0.get()[0], o.q0.get()[0]);
            q < m && (m - q) >> i.grid.get() == 1 && got == q && i.s0.get() < S_ONE
        })],
        vec![("grid: N - n - 1", 0..=levels - 1, |i, _| i.grid.get()), ("s", 0..=256, |i, _| i.s1.get())],
    )
}

#[test]
fn free_running() {
    suite(u64::from(MAX_LEVELS)).run(Mode::Free);
}

#[test]
fn stalled() {
    suite(u64::from(MAX_LEVELS)).run(Mode::Stalled);
}
