//! Does a node's triangle serve this ray, and if not, how far do its edges open? (paper section 3.7)
//!
//! Per edge (a, b) with bound h: l = floor(min((a-x).d, (b-x).d) / 2^30), D = clamp(floor((offset + l slope) / 2^shift), 0, 2^34 - 1);
//! s = 0 iff h <= D, s = 256 iff h >= 2D (and h > D), else clamp(floor((h-D) 256 / D), 1, 255).
//! So s = 0 is decided on the exact comparison; h = 0 gives 0 whatever D is; an edge at or behind the origin has D = 0: full detail.
//! s is symmetric in a and b, does not decrease in h and does not increase in l.
//! Legal: points and origin with |v| < 2^31, |d| <= 2^30 and each |d_i| < 2^30.

use super::bound_decode::{self, Bound, BoundDecode};
use super::parts::{
    CONE_TOLERANCE_LATENCY, DISTANCE, EDGE_OPENING_LATENCY, Multiplier, Parts, Registers, TAG, TOLERANCE, dot_product, dot_product_latency,
    multiplier_latency,
};
use super::{Block, EdgesPerCycle, Form, Timing, dot};
use crate::num::{BoundCode, BoundScale, Cone, EdgeState, Point, Ray, S, S_ONE, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`LodTest`].
    pub struct In {
        /// The ray.
        ray: Ray,
        /// Corner p0 of the (morphed) triangle.
        p0: Point,
        /// Corner p1.
        p1: Point,
        /// Corner p2.
        p2: Point,
        /// Bound code of edge (p1, p2).
        e0: BoundCode,
        /// Bound code of edge (p2, p0).
        e1: BoundCode,
        /// Bound code of edge (p0, p1).
        e2: BoundCode,
        /// The model's bound scale.
        scale: BoundScale,
    }
}

wire_struct! {
    /// Output of [`LodTest`].
    pub struct Out {
        /// Some edge state is not 0: go down.
        refine: bool,
        /// State of edge (p1, p2).
        s0: EdgeState,
        /// State of edge (p2, p0).
        s1: EdgeState,
        /// State of edge (p0, p1).
        s2: EdgeState,
    }
}

/// The block.
pub struct LodTest;

/// Distance along the ray, in steps of 2^-30 units: |p - x| < 2^32 sqrt 3 and |d| <= 2^30, so below 2^62.8, partial sums too (Cauchy-Schwarz).
#[inline(always)]
fn along(ray: &Ray, p: Point) -> S<64> {
    let ([px, py, pz], [x, y, z]) = (p.get(), ray.origin.get());
    S::new(dot([px - x, py - y, pz - z], ray.direction.get()))
}

/// D: the displacement that the ray tolerates for an edge whose nearer end lies at `nearer`.
#[inline(always)]
fn tolerated(cone: &Cone, nearer: i64) -> U<34> {
    // 64 - 30 = 34 bits signed.
    let l = S::<34>::new(nearer >> 30);
    // 34 x 18 bits: 52 signed; with the 53-bit unsigned offset: 55 signed.
    let sum = S::<55>::new(cone.offset.get().cast_signed() + l.get() * cone.slope.get().cast_signed());
    let shifted = sum.get() >> cone.shift.get();
    U::new(shifted.clamp(0, U::<34>::MAX.get().cast_signed()).cast_unsigned())
}

/// s of an edge with bound `h` of which the ray tolerates `d`.
#[inline(always)]
fn edge_state(h: Bound, d: U<34>) -> EdgeState {
    let (h, d) = (h.get(), d.get());
    if h <= d {
        EdgeState::ZERO
    } else if h >= 2 * d {
        EdgeState::new(S_ONE)
    } else {
        // 0 < h - d < d: the quotient is below 256.
        EdgeState::new(((h - d) * S_ONE / d).clamp(1, S_ONE - 1))
    }
}

/// Bound h and tolerance D of the edge with bound code `code` between end points at `a` and `b` along the ray.
#[inline(always)]
fn limits(input: &In, code: BoundCode, a: S<64>, b: S<64>) -> (Bound, U<34>) {
    let h = BoundDecode::eval(&bound_decode::In { code, scale: input.scale }).h;
    (h, tolerated(&input.ray.cone, a.min(b).get()))
}

/// What bounds and tolerances of the three edges come to.
#[inline(always)]
fn decided(limits: [(Bound, U<34>); 3]) -> Out {
    // s = 0 exactly when h <= D: one decision for all three edges.
    let [(h0, d0), (h1, d1), (h2, d2)] = limits;
    if (h0.get() <= d0.get()) & (h1.get() <= d1.get()) & (h2.get() <= d2.get()) {
        return Out::default();
    }
    let [s0, s1, s2] = limits.map(|(h, d)| edge_state(h, d));
    Out { refine: true, s0, s1, s2 }
}

impl LodTest {
    /// Timing of the default's RTL with one edge (its parameter `EDGES_PER_CYCLE` = 1).
    pub const ONE_EDGE: Timing = one_edge(&Form::FULL);
    /// And with three.
    pub const THREE_EDGES: Timing = three_edges(&Form::FULL);

    /// The outcome where another ray may decide about each edge: `viewers[k]` about edge k (paper section 3.8).
    #[inline]
    pub fn by(viewers: [&Ray; 3], input: &In) -> Out {
        let &In { p0, p1, p2, e0, e1, e2, .. } = input;
        let edge = |ray: &Ray, code, a, b| limits(&In { ray: *ray, ..*input }, code, along(ray, a), along(ray, b));
        let [v0, v1, v2] = viewers;
        decided([edge(v0, e0, p1, p2), edge(v1, e1, p2, p0), edge(v2, e2, p0, p1)])
    }

    /// The outcome for a ray that tolerates nothing, wherever it and the triangle are: each edge is open or has no bound.
    #[inline(always)]
    pub fn of_full_detail(codes: [BoundCode; 3], scale: BoundScale) -> Out {
        decided(codes.map(|code| (BoundDecode::eval(&bound_decode::In { code, scale }).h, U::ZERO)))
    }
}

/// Behind how many stages the nearer ends of the edges stand where all three go at once.
const fn nearer(form: &Form) -> u32 {
    1 + dot_product_latency(form.relative(), form.component()) + 1
}

/// And their limits.
const fn limits_at(form: &Form) -> u32 {
    nearer(form) + CONE_TOLERANCE_LATENCY
}

/// Timing with three edges.
const fn three_edges(form: &Form) -> Timing {
    Timing::pipelined(limits_at(form) + EDGE_OPENING_LATENCY + 1)
}

/// Timing with one: two corners more, which wait for the third, and two edges more.
const fn one_edge(form: &Form) -> Timing {
    Timing { latency: three_edges(form).latency + 5, interval: 3 }
}

const fn timing(form: &Form) -> Timing {
    match form.lod_edges_per_cycle {
        EdgesPerCycle::Three => three_edges(form),
        EdgesPerCycle::One => one_edge(form),
    }
}

/// Bits of a cone's offset.
const OFFSET: u32 = 53;
/// Bits of a cone's slope and shift, and of offset + l slope.
const SLOPE: u32 = 18;
const SHIFT: u32 = 6;
const SUM: u32 = 55;
/// Bits of s below 1: steps of a division.
const BITS: u32 = EdgeState::WIDTH - 1;

/// `cone_tolerance`: the product with the rest beside it, the sum, the shift in two steps, the clamp.
pub(super) fn cone_tolerance() -> Registers {
    let product = Multiplier::new(DISTANCE, SLOPE).near();
    let beside = Registers::line(SUM + SHIFT, 1 + multiplier_latency(DISTANCE, SLOPE), 0);
    let shift = Registers::stage(SUM + SHIFT) + Registers::stage(SUM + 4) + Registers::stage(SUM);
    product.registers() + beside + shift + Registers::stage(TOLERANCE)
}

/// `edge_opening`: the comparison, and the steps.
pub(super) fn edge_opening() -> Registers {
    let state = 2 + 2 * TOLERANCE + BITS;
    // Quotient bits to come are 0; behind the last step divisor and remainder have no use.
    let to_come = 2 * BITS + BITS * (BITS - 1) / 2;
    (Registers::skid(state) + Registers::line(state, BITS, 0)).without(to_come + 2 * TOLERANCE)
}

/// A tag of one bit for which there is no use, in each of its registers.
pub(super) fn bound() -> Registers {
    BoundDecode::registers(1).without(BoundDecode::TIMING.latency)
}

/// A dot product along the ray; the fraction of a distance is dropped.
pub(super) fn distance_along(form: &Form) -> Registers {
    let (relative, component) = (form.relative(), form.component());
    dot_product(relative, component, relative + component, 1, relative + component - DISTANCE)
}

/// Bits of a cone's start that are always 0.
const fn no_start(form: &Form) -> u32 {
    if form.start_radius { 0 } else { OFFSET }
}

/// Bits of the codes of three edges with their scale.
const CODES: u32 = 3 * BoundCode::WIDTH + BoundScale::WIDTH;

/// `lod_edges_parallel`: the corners, three distances, and three edges.
fn parallel(form: &Form) -> Registers {
    let corners = Registers::stage(9 * form.relative() + 3 * form.component());
    let cone = Registers::line(Cone::WIDTH, nearer(form), 2).without((nearer(form) + 2) * no_start(form));
    let codes = Registers::line(CODES, limits_at(form) - BoundDecode::TIMING.latency, 2);
    let edges = Registers::skid(3 * DISTANCE) + cone + codes + 3 * (cone_tolerance() + bound() + edge_opening());
    corners + 3 * distance_along(form) + edges + Registers::line(TAG, limits_at(form) + EDGE_OPENING_LATENCY, 3)
}

/// `lod_edges_serial`: the corners, which turn; one distance; the distances, which turn; one edge; the states, which wait.
fn serial(form: &Form) -> Registers {
    let (pass, along) = (2, dot_product_latency(form.relative(), form.component()));
    let beside = Cone::WIDTH + CODES + TAG;
    let corners = Registers::bits(9 * form.relative() + 3 * form.component() + beside + 1 + pass).without(no_start(form));
    let beside_along = Registers::line(pass + beside, along, 1).without((along + 1) * no_start(form));
    let distances = Registers::bits((2 + 3) * DISTANCE + beside + 1 + pass).without(no_start(form));
    let nearer_end = Registers::skid(DISTANCE + Cone::WIDTH).without(2 * no_start(form));
    let to_limits = 1 + CONE_TOLERANCE_LATENCY;
    let code = Registers::line(BoundCode::WIDTH + BoundScale::WIDTH, to_limits - BoundDecode::TIMING.latency, 1);
    let edge = nearer_end + cone_tolerance() + code + bound() + edge_opening();
    let states = Registers::line(pass + TAG, to_limits + EDGE_OPENING_LATENCY, 2) + Registers::bits(2 * (1 + EdgeState::WIDTH));
    (corners + distance_along(form) + beside_along + distances + edge + states).in_turns(3)
}

/// Products, sums and selections of three edges with so many distances along rays.
pub(super) fn edge_arithmetic(distances: u32, relative: u32, component: u32) -> (Vec<[u32; 3]>, u32, u32) {
    let (decode_adds, decode_selects) = BoundDecode::arithmetic();
    let products = vec![[3 * distances, relative, component], [3, DISTANCE, SLOPE]];
    // Sums along the ray, nearer ends, sums of the cone, bounds, openings, divisions.
    let adds =
        2 * distances * (relative + component) + 3 * DISTANCE + 6 * SUM + 3 * decode_adds + 9 * TOLERANCE + 3 * BITS * (TOLERANCE + 1);
    // Nearer ends, shifts of cone and bound, clamps, divisions, ends of s.
    let selects = 3 * (DISTANCE + SUM * SHIFT + decode_selects + TOLERANCE + BITS * TOLERANCE + EdgeState::WIDTH);
    (products, adds, selects)
}

impl Block for LodTest {
    const NAME: &'static str = "lod_test";
    const TIMING: Timing = timing(&Form::FULL);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let (relative, component) = (form.relative(), form.component());
        let edges = match form.lod_edges_per_cycle {
            EdgesPerCycle::Three => parallel(form),
            EdgesPerCycle::One => serial(form),
        };
        let (products, adds, select_bits) = edge_arithmetic(3, relative, component);
        Parts {
            products,
            // Corners besides.
            add_bits: 9 * relative + adds,
            select_bits,
            registers: edges + Registers::stage(Out::WIDTH + TAG),
        }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        let (l0, l1, l2) = (along(&input.ray, input.p0), along(&input.ray, input.p1), along(&input.ray, input.p2));
        let limits = [(input.e0, l1, l2), (input.e1, l2, l0), (input.e2, l0, l1)].map(|(code, a, b)| limits(input, code, a, b));
        decided(limits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Direction;
    use proptest::prelude::*;

    fn cone(offset: u64, slope: u64, shift: u64) -> Cone {
        Cone { offset: U::new(offset), slope: U::new(slope), shift: U::new(shift) }
    }

    #[test]
    fn states_at_the_borders() {
        let s = |h, d| edge_state(Bound::new(h), U::new(d)).get();
        assert_eq!([s(0, 0), s(1, 0), s(0, 5)], [0, 256, 0]);
        assert_eq!([s(100, 100), s(101, 100), s(199, 100), s(200, 100), s(150, 100)], [0, 2, 253, 256, 128]);
        assert_eq!(s(1_000_001, 1_000_000), 1); // above 0, so never rounded to it
    }

    #[test]
    fn an_edge_is_judged_by_the_nearer_of_its_ends_along_the_ray() {
        // The corners' distances along the ray are 500, 1000 and 2000, of which each tolerates twice as much; code 160 is a bound of 1024.
        let place = |x: i64, z: i64| Point::new(10 + x, 20, 30 + z);
        let ray = Ray { origin: Point::new(10, 20, 30), direction: Direction::new(1 << 28, 0, 1 << 29), cone: cone(0, 2, 0) };
        let [e0, e1, e2] = [BoundCode::new(160); 3];
        let corners = In { ray, p0: place(400, 800), p1: place(-400, 2200), p2: place(0, 4000), e0, e1, e2, ..In::default() };
        let states = |input: &In| {
            let out = LodTest::eval(input);
            (out.refine, [out.s0, out.s1, out.s2].map(|s| s.get()))
        };
        assert_eq!(states(&corners), (true, [0, 6, 6]));
        let In { p0, p1, p2, .. } = corners;
        assert_eq!(states(&In { p0: p1, p1: p2, p2: p0, ..corners }), (true, [6, 6, 0]));
        assert_eq!(states(&In { p0: p1, ..corners }), (false, [0; 3]));
    }

    #[test]
    fn behind_the_origin_is_full_detail_and_saturation_is_the_base() {
        assert_eq!(tolerated(&cone(0, 1000, 4), -5 << 30).get(), 0);
        assert_eq!(tolerated(&cone((1 << 53) - 1, 0, 0), -5 << 30), U::MAX);
        assert_eq!(tolerated(&cone(0, 0, 0), i64::MAX).get(), 0);
        assert_eq!(tolerated(&cone(7, 3, 1), (10 << 30) + 5).get(), 18); // floor(37 / 2)
    }

    proptest! {
        #[test]
        fn rays_that_tolerate_nothing_need_no_place(
            codes in prop::array::uniform3(0u64..256), offset in 0u64..=crate::num::MAX_BOUND_OFFSET, p in prop::array::uniform9(-(1i64 << 31) + 1..1 << 31), shift in 0u64..64
        ) {
            let [e0, e1, e2] = codes.map(|code| BoundCode::new(if code % 3 == 0 { 0 } else { code }));
            let [p0, p1, p2] = [0, 3, 6].map(|k| Point::new(p[k], p[k + 1], p[k + 2]));
            let ray = Ray { direction: Direction::new(1 << 29, -5, 0), cone: cone(0, 0, shift), ..Ray::default() };
            let scale = BoundScale { offset: U::new(offset) };
            let out = LodTest::eval(&In { ray, p0, p1, p2, e0, e1, e2, scale });
            prop_assert_eq!(LodTest::of_full_detail([e0, e1, e2], scale), out);
        }

        #[test]
        fn states_are_monotone(h in 0u64..1 << 33, more in 0u64..1 << 20, d in 0u64..1 << 34, shift in 0u64..30) {
            let (h, d) = (h >> shift, d >> shift);
            let s = |h: u64, d| edge_state(Bound::new(h.min((1 << 33) - 1)), U::new(d)).get();
            prop_assert!(s(h + more, d) >= s(h, d));
            prop_assert!(s(h, (d + more).min((1 << 34) - 1)) <= s(h, d));
            prop_assert_eq!(s(h, d) == 0, h <= d);
            prop_assert_eq!(s(h, d) == 256, h > d && h >= 2 * d);
        }
    }
}
