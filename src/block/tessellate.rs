//! Inserted vertices of a node's triangle for this ray: put together, and morphed between edge midpoint and their stored position (paper section 3.4).
//!
//! The stored vertex g is given as it is, or as its displacement from the midpoint of the full-resolution ends of its edge: g = (fa + fb) / 2 + v 2^e,
//! e = max(grid + padding, (code + offset) / 16 - 11), so that the edge's bound is below 4096 steps (docs/numbers.md). All of that is the edge's own: whichever triangle
//! asks, in whatever tree, g is the same.
//!
//! m = (pa + pb) / 2, exact; q = m + (floor((g - m) s / 256) with its low `grid` bits cleared). s = 0 gives m, s = 256 gives g; g - m is
//! a multiple of 2^grid and so is what is added, hence q lies between m and g in each coordinate and on the level's grid. Neither m nor the
//! rounding depends on which triangle asks.
//! Legal: all corners multiples of 2^(grid+1), g of 2^grid, grid = N - level - 1 + Z (0 to 15), |corners| and |g| at most `COORD_LIMIT`, s from 0 to 256; v of 13 bits where it is a displacement.
//! Any v is taken, as it comes from memory: a g that is not legal shows in the output.

use super::parts::{Multiplier, Parts, Registers, TAG, multiplier_latency};
use super::{Block, Form, Timing};
use crate::num::{BoundCode, BoundScale, Displacement, EdgeState, MAX_DISPLACEMENT_SHIFT, Point, S, U, Vec3, Wire, wire_struct};

wire_struct! {
    /// Input of [`Tessellate`].
    pub struct In {
        /// Stored vertices are displacements.
        compact: bool,
        /// Zero bits at the bottom of an inserted vertex as morphed.
        grid: U<4>,
        /// How many more it has as stored.
        padding: U<3>,
        /// The model's bound scale.
        scale: BoundScale,
        /// Bound code of edge (p1, p2).
        e0: BoundCode,
        /// Bound code of edge (p2, p0).
        e1: BoundCode,
        /// Bound code of edge (p0, p1).
        e2: BoundCode,
        /// State of edge (p1, p2).
        s0: EdgeState,
        /// State of edge (p2, p0).
        s1: EdgeState,
        /// State of edge (p0, p1).
        s2: EdgeState,
        /// Corner p0 of full resolution.
        f0: Point,
        /// Corner p1 of full resolution.
        f1: Point,
        /// Corner p2 of full resolution.
        f2: Point,
        /// Corner p0 as morphed for this ray.
        p0: Point,
        /// Corner p1.
        p1: Point,
        /// Corner p2.
        p2: Point,
        /// Stored vertex on (p1, p2), or its displacement.
        v0: Point,
        /// On (p2, p0).
        v1: Point,
        /// On (p0, p1).
        v2: Point,
    }
}

wire_struct! {
    /// Output of [`Tessellate`]: the inserted vertices of full resolution, and as morphed.
    pub struct Out {
        /// Full resolution, on (p1, p2).
        g0: Point,
        /// On (p2, p0).
        g1: Point,
        /// On (p0, p1).
        g2: Point,
        /// Morphed, on (p1, p2).
        q0: Point,
        /// On (p2, p0).
        q1: Point,
        /// On (p0, p1).
        q2: Point,
    }
}

/// The block.
pub struct Tessellate;

/// What the vertices of a triangle share.
#[derive(Clone, Copy)]
struct Split {
    compact: bool,
    grid: U<4>,
    padding: U<3>,
    scale: BoundScale,
}

/// Shift of a displacement: its edge's bound has fewer than 13 bits beyond it.
#[inline(always)]
fn displacement_shift(split: Split, code: BoundCode) -> U<5> {
    // 8 and 9 bits: k / 16 is below 48 (below 33 in a legal scale), less 11.
    let octave = (code.get() + split.scale.offset.get()) >> 4;
    let shift = octave.saturating_sub(11).max(split.grid.get() + split.padding.get());
    // Legal scales and grids keep it to this.
    U::new(shift.min(u64::from(MAX_DISPLACEMENT_SHIFT)))
}

/// The full-resolution vertex between `a` and `b`.
#[inline(always)]
fn stored_coordinate(a: S<32>, b: S<32>, v: S<32>, compact: bool, shift: U<5>) -> S<32> {
    // 33-bit sum, even: the midpoint is exact and fits 32 bits again. 13 bits and 21 more: legal vertices fit 32, others wrap.
    let displaced = ((a.get() + b.get()) >> 1) + (v.get() << shift.get());
    S::wrapping(if compact { displaced } else { v.get() })
}

#[inline(always)]
fn morph_coordinate(a: S<32>, b: S<32>, g: S<32>, s: EdgeState, grid: U<4>) -> S<32> {
    // 33-bit sum, even: the midpoint is exact and fits 32 bits again.
    let m = (a.get() + b.get()) >> 1;
    // 33-bit difference times 9 bits: 42.
    let product = S::<42>::new((g.get() - m) * s.get().cast_signed());
    let step = (product.get() >> 8) & (-1 << grid.get());
    // Between m and g, so 32 bits; of a g that is on no grid it wraps.
    S::wrapping(m + step)
}

/// An edge: its ends of full resolution and as morphed, its code and its state.
#[derive(Clone, Copy)]
struct Edge {
    f: [Point; 2],
    p: [Point; 2],
    code: BoundCode,
    s: EdgeState,
}

/// The vertex `v` on an edge, of full resolution and as morphed; if `ENDS`, s is 0 or 256, and nothing is multiplied.
#[inline(always)]
fn vertex<const ENDS: bool>(split: Split, edge: Edge, v: Point) -> (Point, Point) {
    let ([fa, fb], [pa, pb], shift) = (edge.f, edge.p, displacement_shift(split, edge.code));
    let stored = |a, b, v| stored_coordinate(a, b, v, split.compact, shift);
    let g = Vec3 { x: stored(fa.x, fb.x, v.x), y: stored(fa.y, fb.y, v.y), z: stored(fa.z, fb.z, v.z) };
    let morph = |a: S<32>, b: S<32>, g: S<32>| match ENDS {
        true => S::new(if edge.s == EdgeState::ZERO { (a.get() + b.get()) >> 1 } else { g.get() }),
        false => morph_coordinate(a, b, g, edge.s, split.grid),
    };
    (g, Vec3 { x: morph(pa.x, pb.x, g.x), y: morph(pa.y, pb.y, g.y), z: morph(pa.z, pb.z, g.z) })
}

#[inline(always)]
fn vertices<const ENDS: bool>(i: &In) -> Out {
    let split = Split { compact: i.compact, grid: i.grid, padding: i.padding, scale: i.scale };
    let (g0, q0) = vertex::<ENDS>(split, Edge { f: [i.f1, i.f2], p: [i.p1, i.p2], code: i.e0, s: i.s0 }, i.v0);
    let (g1, q1) = vertex::<ENDS>(split, Edge { f: [i.f2, i.f0], p: [i.p2, i.p0], code: i.e1, s: i.s1 }, i.v1);
    let (g2, q2) = vertex::<ENDS>(split, Edge { f: [i.f0, i.f1], p: [i.p0, i.p1], code: i.e2, s: i.s2 }, i.v2);
    Out { g0, g1, g2, q0, q1, q2 }
}

/// Bits of a state as a signed number, and of the number of zero bits.
const STATE: u32 = EdgeState::WIDTH + 1;
const GRID: u32 = 4;
/// Of the shift of a displacement.
const SHIFT: u32 = 5;

/// Midpoints, the vertex, the difference; its product with a state; the step, and the sum. Where nothing is morphed: midpoint and vertex.
const fn latency(form: &Form) -> u32 {
    if form.lod_test { 3 + multiplier_latency(form.relative(), STATE) + 2 } else { 2 }
}

impl Block for Tessellate {
    const NAME: &'static str = "tessellate";
    const TIMING: Timing = Timing::pipelined(latency(&Form::FULL));
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        Timing::pipelined(latency(form))
    }
    fn parts(form: &Form) -> Parts {
        let tag = Registers::line(TAG, latency(form), 0);
        // Of vertices that are stored as they are no displacement and no shift.
        let displaced = if form.compact_vertices { 3 * Displacement::WIDTH / 3 + SHIFT } else { 0 };
        let unread = 3 * Displacement::WIDTH / 3 + SHIFT - displaced;
        let [shift_adds, shift_selects] = if form.compact_vertices { [3 * (BoundScale::WIDTH + 1 + 6), 3 * 5] } else { [0, 0] };
        // The displacement in five steps, or the vertex as it is.
        let placed = 5 * u32::from(form.compact_vertices) + u32::from(form.compact_vertices && form.exact_vertices);
        if !form.lod_test {
            let w = form.coordinate();
            let vertex = Registers::stage(3 * (w + Displacement::WIDTH / 3) + SHIFT).without(unread) + Registers::stage(3 * w);
            return Parts {
                products: vec![],
                add_bits: shift_adds + 9 * (form.relative() + w),
                select_bits: shift_selects + 9 * placed * w,
                registers: 3 * vertex + tag,
            };
        }
        // A coordinate, its difference from the midpoint, s as a signed number, and the fraction of the product that is dropped.
        let (w, relative, s, grid, fraction) = (form.coordinate(), form.relative(), STATE, GRID, 8);
        let product = Multiplier { low: fraction, high: fraction + w, ..Multiplier::new(relative, s) };
        // Three coordinates share state, grid and shift. Both midpoints and the displacement; the vertex; the difference. The vertex goes along to the end.
        let opening = s - 1 + grid;
        let ahead = Registers::stage(3 * (2 * w + Displacement::WIDTH / 3) + SHIFT + opening).without(unread)
            + Registers::stage(6 * w + opening)
            + Registers::stage(3 * relative + 6 * w + opening);
        let beside = Registers::line(6 * w + grid, multiplier_latency(relative, s), 0);
        let vertex = ahead + 3 * product.registers() + beside + Registers::stage(9 * w) + Registers::stage(6 * w);
        Parts {
            products: vec![[9, relative, s]],
            // Shifts of three edges; midpoints, vertex, difference, sum.
            add_bits: shift_adds + 9 * (2 * relative + w + relative + w),
            // Shifts; the vertex; the grid.
            select_bits: shift_selects + 9 * (placed * w + w),
            registers: 3 * vertex + tag,
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        vertices::<false>(i)
    }
}

impl Tessellate {
    /// The same where every edge is closed or open, its s 0 or 256.
    #[inline(always)]
    pub fn of_full_detail(i: &In) -> Out {
        vertices::<true>(i)
    }
}

/// The corners of child `k` of a triangle `p` with inserted vertices `q`: wiring, no logic.
#[inline(always)]
pub fn child_triangle(p: [Point; 3], q: [Point; 3], k: usize) -> [Point; 3] {
    match k {
        0 => [p[0], q[2], q[1]],
        1 => [q[2], p[1], q[0]],
        2 => [q[1], q[0], p[2]],
        _ => q,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn stored_vertices_are_those_of_the_format(
            grid in 0u64..=9, offset in 0u64..=num::MAX_BOUND_OFFSET, code in 0u8..=255, v in prop::array::uniform2(-(1i32 << 30)..1 << 30), part in -4096i32..4096
        ) {
            let split = Split { compact: true, grid: U::new(grid), padding: U::new(4), scale: BoundScale { offset: U::new(offset) } };
            let shift = displacement_shift(split, BoundCode::new(u64::from(code)));
            prop_assert_eq!(shift.get(), u64::from(num::displacement_shift(split.scale, code, grid as u32 + 4)));
            let [a, b] = v.map(|v| (v >> (grid + 5)) << (grid + 5));
            // Within the coordinates' limit, as in every scene.
            let steps = part >> shift.get().saturating_sub(17);
            let g = stored_coordinate(S::new(a.into()), S::new(b.into()), S::new(steps.into()), true, shift);
            prop_assert_eq!(g.get(), i64::from(num::displaced(a, b, steps, shift.get() as u32)));
            prop_assert_eq!(stored_coordinate(S::new(a.into()), S::new(b.into()), S::new(7), false, shift).get(), 7);
        }

        #[test]
        fn morphed_vertices_stay_between_and_on_the_grid(
            grid in 0u64..=9, s in 0u64..=256, v in prop::array::uniform3(-(1i64 << 31) + 1024..(1 << 31) - 1024)
        ) {
            let on = |v: i64, g: u64| (v >> g) << g;
            let (a, b, q) = (on(v[0], grid + 1), on(v[1], grid + 1), on(v[2], grid));
            let m = (a + b) / 2;
            let r = morph_coordinate(S::new(a), S::new(b), S::new(q), U::new(s), U::new(grid)).get();
            prop_assert!(m.min(q) <= r && r <= m.max(q));
            prop_assert_eq!(r & ((1 << grid) - 1), 0);
            prop_assert!(s != 0 || r == m);
            prop_assert!(s != 256 || r == q);
            let edge = |s| {
                let at = |v| Point::new(v, v, v);
                let split = Split { compact: false, grid: U::new(grid), padding: U::new(4), scale: BoundScale::default() };
                let edge = Edge { f: [at(a), at(b)], p: [at(a), at(b)], code: BoundCode::new(0), s: U::new(s) };
                (vertex::<false>(split, edge, at(q)), vertex::<true>(split, edge, at(q)))
            };
            for (morphed, closed_or_open) in [edge(0), edge(256)] {
                prop_assert_eq!(morphed, closed_or_open);
            }
            let swapped = morph_coordinate(S::new(b), S::new(a), S::new(q), U::new(s), U::new(grid)).get();
            prop_assert_eq!(r, swapped);
        }
    }
}
