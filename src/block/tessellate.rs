//! Inserted vertices of a node's triangle for this ray: morphed between edge midpoint and stored position (paper section 3.4).
//!
//! m = (a + b) / 2, exact; q' = m + (floor((q - m) s / 256) with its low `grid` bits cleared). s = 0 gives m, s = 256 gives q; q - m is
//! a multiple of 2^grid and so is what is added, hence q' lies between m and q in each coordinate and on the level's grid. Neither m nor the
//! rounding depends on which triangle asks.
//! Legal: corners multiples of 2^(grid+1), q of 2^grid, grid = N - level - 1 (0 to 9), |v| < 2^31, s from 0 to 256.

use super::parts::{Multiplier, Parts, RELATIVE, Registers, TAG, multiplier_latency};
use super::{Block, Form, Timing};
use crate::num::{EdgeState, Point, S, U, Vec3, Wire, wire_struct};

wire_struct! {
    /// Input of [`Tessellate`].
    pub struct In {
        /// Zero bits at the bottom of an inserted vertex.
        grid: U<4>,
        /// State of edge (p1, p2).
        s0: EdgeState,
        /// State of edge (p2, p0).
        s1: EdgeState,
        /// State of edge (p0, p1).
        s2: EdgeState,
        /// Corner p0.
        p0: Point,
        /// Corner p1.
        p1: Point,
        /// Corner p2.
        p2: Point,
        /// Stored vertex on (p1, p2).
        q0: Point,
        /// Stored vertex on (p2, p0).
        q1: Point,
        /// Stored vertex on (p0, p1).
        q2: Point,
    }
}

wire_struct! {
    /// Output of [`Tessellate`]: the morphed vertices.
    pub struct Out {
        /// On (p1, p2).
        q0: Point,
        /// On (p2, p0).
        q1: Point,
        /// On (p0, p1).
        q2: Point,
    }
}

/// The block.
pub struct Tessellate;

#[inline(always)]
fn morph_coordinate(a: S<32>, b: S<32>, q: S<32>, s: EdgeState, grid: U<4>) -> S<32> {
    // 33-bit sum, even: the midpoint is exact and fits 32 bits again.
    let m = (a.get() + b.get()) >> 1;
    // 33-bit difference times 9 bits: 42.
    let product = S::<42>::new((q.get() - m) * s.get().cast_signed());
    let step = (product.get() >> 8) & (-1 << grid.get());
    // Between m and q, so 32 bits.
    S::new(m + step)
}

#[inline(always)]
fn morph(a: Point, b: Point, q: Point, s: EdgeState, grid: U<4>) -> Point {
    Vec3 {
        x: morph_coordinate(a.x, b.x, q.x, s, grid),
        y: morph_coordinate(a.y, b.y, q.y, s, grid),
        z: morph_coordinate(a.z, b.z, q.z, s, grid),
    }
}

impl Block for Tessellate {
    const NAME: &'static str = "tessellate";
    const TIMING: Timing = Timing::pipelined(6);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        // A coordinate, its difference from the midpoint, s as a signed number, and the fraction of the product that is dropped.
        let (w, s, grid, fraction) = (RELATIVE - 1, EdgeState::WIDTH + 1, 4, 8);
        let product = Multiplier { low: fraction, high: fraction + w, ..Multiplier::new(RELATIVE, s) };
        let ahead = Registers::stage(2 * w + s - 1 + grid) + Registers::stage(RELATIVE + w + s - 1 + grid);
        let beside = Registers::line(w + grid, multiplier_latency(RELATIVE, s), 0);
        let coordinate = ahead + product.registers() + beside + Registers::stage(2 * w) + Registers::stage(w);
        Parts {
            products: vec![[9, RELATIVE, s]],
            // Midpoint, difference, sum; the grid.
            add_bits: 9 * (RELATIVE + RELATIVE + w),
            select_bits: 9 * w,
            registers: 9 * coordinate + Registers::line(TAG, Self::TIMING.latency, 0),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        Out {
            q0: morph(i.p1, i.p2, i.q0, i.s0, i.grid),
            q1: morph(i.p2, i.p0, i.q1, i.s1, i.grid),
            q2: morph(i.p0, i.p1, i.q2, i.s2, i.grid),
        }
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
    use proptest::prelude::*;

    proptest! {
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
            let swapped = morph_coordinate(S::new(b), S::new(a), S::new(q), U::new(s), U::new(grid)).get();
            prop_assert_eq!(r, swapped);
        }
    }
}
