//! Inserted vertices, at full resolution and morphed.

use crate::draw::Draw;
use crate::rays::point;
use crate::suite::{Category, Coarsen, Suite};
use lodray::block::tessellate::{In, Out, Tessellate};
use lodray::hardware::Hardware;
use lodray::num::{BoundCode, COORD_LIMIT, EdgeState, MAX_BOUND_OFFSET, MAX_DISPLACEMENT_SHIFT, MAX_LEVELS, Point, S_ONE, U};

const LIMIT: i64 = 0x7FFE_0000;
const _: () = assert!(LIMIT == COORD_LIMIT as i64);
/// Most zero bits of an inserted vertex as morphed.
const MOST_GRID: u64 = 15;
/// What displacements can be.
const STEPS: [i64; 2] = [-4096, 4095];

/// A point of which each coordinate has its low `zeros` bits zero.
fn on_grid(draw: &mut Draw, zeros: u64) -> Point {
    point([0; 3].map(|_| draw.signed(LIMIT >> zeros) << zeros))
}

fn midpoint(a: Point, b: Point) -> [i64; 3] {
    [0, 1, 2].map(|k| (a.get()[k] + b.get()[k]) / 2)
}

/// Ends of edge `k` at full resolution, and as morphed.
fn ends(i: &In, k: usize) -> [[Point; 2]; 2] {
    let of = |p: [Point; 3]| [p[(k + 1) % 3], p[(k + 2) % 3]];
    [of([i.f0, i.f1, i.f2]), of([i.p0, i.p1, i.p2])]
}

fn middles(i: &In, as_morphed: bool) -> [[i64; 3]; 3] {
    [0, 1, 2].map(|k| {
        let [a, b] = ends(i, k)[usize::from(as_morphed)];
        midpoint(a, b)
    })
}

fn codes(i: &In) -> [BoundCode; 3] {
    [i.e0, i.e1, i.e2]
}

/// Shift of the displacement on edge `k`.
fn shift(i: &In, k: usize) -> u64 {
    let octave = (codes(i)[k].get() + i.scale.offset.get()) / 16;
    octave.saturating_sub(11).max(i.grid.get() + i.padding.get())
}

fn full(o: &Out) -> [[i64; 3]; 3] {
    [o.g0, o.g1, o.g2].map(Point::get)
}

fn morphed(o: &Out) -> [[i64; 3]; 3] {
    [o.q0, o.q1, o.q2].map(Point::get)
}

/// Corners and states in either form, and as what vertices `vertex` gives: from the midpoint of the full-resolution edge and the shift to be used.
fn triangle(draw: &mut Draw, mut state: impl FnMut(&mut Draw) -> EdgeState) -> In {
    // Of models on coarser grids too, as far as there are.
    let zeros = draw.zeros.max(if draw.once_in(2) { draw.below(7) } else { 0 });
    let grid = (draw.below(draw.levels) + zeros).min(MOST_GRID);
    let padding = U::new(4u64.saturating_sub(zeros));
    let [s0, s1, s2] = [0; 3].map(|_| state(draw));
    let [f0, f1, f2, p0, p1, p2] = [0; 6].map(|_| on_grid(draw, grid + 1));
    let [e0, e1, e2] = [0; 3].map(|_| draw.bits());
    let (compact, grid, scale) = (draw.once_in(2), U::new(grid), draw.scale());
    let input = In { compact, grid, padding, scale, e0, e1, e2, s0, s1, s2, f0, f1, f2, p0, p1, p2, ..In::default() };
    stored(draw, input, |draw, low, high| match draw.below(8) {
        0 => low,
        1 => high,
        2..5 => draw.between(low, high) >> draw.below(32),
        _ => draw.between(low, high),
    })
}

/// With vertices from `place`, which chooses between two numbers of steps: of displacements, or of the grid.
fn stored(draw: &mut Draw, input: In, mut place: impl FnMut(&mut Draw, i64, i64) -> i64) -> In {
    let [v0, v1, v2] = [0, 1, 2].map(|k| {
        if !input.compact {
            let (grid, most) = (input.grid.get(), LIMIT >> input.grid.get());
            return point([0; 3].map(|_| place(draw, -most, most) << grid));
        }
        let by = shift(&input, k);
        point(middles(&input, false)[k].map(|m| {
            // Within the model: rounded towards zero, which it always reaches.
            let (low, high) = ((-LIMIT - m) / (1 << by), (LIMIT - m) / (1 << by));
            place(draw, low.max(STEPS[0]), high.min(STEPS[1]))
        }))
    });
    In { v0, v1, v2, ..input }
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

/// Exact, a few steps of the grid from the midpoint: what is added rounds to none or few of them.
fn beside_midpoint(draw: &mut Draw, steps: i64) -> In {
    let input = In { compact: false, ..random(draw) };
    let grid = input.grid.get();
    let most = LIMIT >> grid;
    let [v0, v1, v2] =
        middles(&input, true).map(|m| point(m.map(|m| ((m >> grid) + draw.between(-steps, steps)).clamp(-most, most) << grid)));
    In { v0, v1, v2, ..input }
}

/// No corner has moved.
fn unmorphed(draw: &mut Draw) -> In {
    let input = random(draw);
    In { p0: input.f0, p1: input.f1, p2: input.f2, ..input }
}

fn no_displacement(draw: &mut Draw) -> In {
    let input = In { compact: true, ..random(draw) };
    let none = Point::default();
    In { v0: none, v1: none, v2: none, ..input }
}

/// The longest displacements of all, from one end of the range towards the other.
fn far(draw: &mut Draw) -> In {
    let way = draw.sign(1);
    let zeros = 17;
    let end = point([way * (LIMIT >> zeros << zeros); 3]);
    let input = border_states(draw);
    let (scale, codes) = (lodray::num::BoundScale { offset: U::new(MAX_BOUND_OFFSET) }, U::MAX);
    let input = In { compact: true, scale, e0: codes, e1: codes, e2: codes, f0: end, f1: end, f2: end, ..input };
    stored(draw, input, |_, low, high| if way > 0 { low } else { high })
}

/// Edges in one corner of the range, their vertices in another.
fn extreme(draw: &mut Draw) -> In {
    let input = In { compact: false, ..border_states(draw) };
    let corner = [LIMIT; 3].map(|v| draw.sign(v));
    let (p, v) = (point(corner), point(corner.map(|v| -v)));
    In { p0: p, p1: p, p2: p, v0: v, v1: v, v2: v, ..input }
}

fn legal(i: &In) -> bool {
    let grid = i.grid.get();
    let on = |p: [i64; 3], zeros: u64| p.iter().all(|v| v.abs() <= LIMIT && v & ((1 << zeros) - 1) == 0);
    let vertex = |k: usize| {
        let v = [i.v0, i.v1, i.v2][k].get();
        if !i.compact {
            return on(v, grid);
        }
        let (m, by) = (middles(i, false)[k], shift(i, k));
        v.iter().all(|v| (STEPS[0]..=STEPS[1]).contains(v)) && on([0, 1, 2].map(|k| m[k] + (v[k] << by)), grid)
    };
    grid <= MOST_GRID
        && i.scale.offset.get() <= MAX_BOUND_OFFSET
        && [i.s0, i.s1, i.s2].iter().all(|s| s.get() <= S_ONE)
        && [i.f0, i.f1, i.f2, i.p0, i.p1, i.p2].into_iter().all(|p| on(p.get(), grid + 1))
        && (0..3).all(vertex)
}

fn stored_as_they_are(i: &In, o: &Out) -> bool {
    i.compact || full(o) == [i.v0, i.v1, i.v2].map(Point::get)
}

/// Inputs as hardware that leaves out features takes them: of one form of vertices, and where nothing is morphed, open.
pub fn of_less(hardware: &Hardware) -> Coarsen<Tessellate> {
    fn open(i: In) -> In {
        let s = U::new(S_ONE);
        In { p0: i.f0, p1: i.f1, p2: i.f2, s0: s, s1: s, s2: s, ..i }
    }
    /// The midpoints as vertices of a form, where it was the other.
    fn formed(i: In, compact: bool) -> In {
        let [v0, v1, v2] = if i.compact == compact {
            [i.v0, i.v1, i.v2]
        } else if compact {
            [Point::default(); 3]
        } else {
            middles(&i, false).map(point)
        };
        In { compact, v0, v1, v2, ..i }
    }
    match (hardware.compact_vertices, hardware.exact_vertices, hardware.chooses_levels()) {
        (true, true, false) => |i, _| open(i),
        (true, false, false) => |i, _| formed(open(i), true),
        (true, false, true) => |i, _| formed(i, true),
        (false, true, true) => |i, _| formed(i, false),
        _ => unreachable!("{hardware:?}"),
    }
}

type Is = Category<Tessellate>;

/// For hardware of so many levels, and so many zeros of all coordinates.
pub fn suite(levels: u64, zeros: u64) -> Suite<Tessellate> {
    Suite::new(
        legal,
        vec![
            Is::all("random", random, stored_as_they_are),
            Is::all("states at the borders", border_states, stored_as_they_are),
            Is::all("s = 0: midpoints", |d| with_state(d, 0), |i, o| middles(i, true) == morphed(o)),
            Is::all("s just above 0", |d| with_state(d, 1), |i, _| i.s0.get() == 1),
            Is::all("s just below 1", |d| with_state(d, S_ONE - 1), |i, _| i.s0.get() == S_ONE - 1),
            Is::all("s = 1: full resolution", |d| with_state(d, S_ONE), |_, o| full(o) == morphed(o)),
            Is::all("stored at the midpoint", |d| beside_midpoint(d, 0), |_, o| full(o) == morphed(o)),
            Is::any("a step from the midpoint", |d| beside_midpoint(d, 1)),
            Is::any("a few steps from the midpoint", |d| beside_midpoint(d, 300)),
            Is::all("nothing morphed", unmorphed, |i, _| middles(i, true) == middles(i, false)),
            Is::all("no displacement", no_displacement, |i, o| middles(i, false) == full(o)),
            Is::all("the longest displacements", far, |i, o| {
                (o.g1.get()[2] - i.f0.get()[2]).abs() > (1 << 32) - (1 << 22) && shift(i, 1) == u64::from(MAX_DISPLACEMENT_SHIFT)
            }),
            Is::all("the longest way", extreme, |i, o| (o.g0.get()[0] - i.p0.get()[0]).abs() == 2 * LIMIT),
        ],
        vec![
            ("a step down that rounds to one", |i, o| {
                let (m, g, got) = (middles(i, true)[0][0], o.g0.get()[0], o.q0.get()[0]);
                g < m && (m - g) >> i.grid.get() == 1 && got == g && i.s0.get() < S_ONE
            }),
            ("the most steps back", |i, _| i.compact && i.v1.get()[1] == STEPS[0]),
            ("the most steps ahead", |i, _| i.compact && i.v1.get()[1] == STEPS[1]),
            ("shifts of all kinds in a triangle", |i, _| {
                i.compact && shift(i, 0) < shift(i, 1) && shift(i, 1) < shift(i, 2) && shift(i, 0) > i.grid.get() + i.padding.get()
            }),
            ("code 0", |i, _| i.compact && i.e2.get() == 0 && i.scale.offset.get() == MAX_BOUND_OFFSET),
        ],
        vec![
            ("grid: N - n - 1 + Z", zeros..=MOST_GRID.min(levels - 1 + zeros.max(6)), |i, _| i.grid.get()),
            ("s", 0..=256, |i, _| i.s1.get()),
            ("shift", zeros.max(4)..=21, |i, _| if i.compact { shift(i, 2) } else { 21 }),
        ],
    )
}

crate::suite::modes!(suite(u64::from(MAX_LEVELS), 0));
