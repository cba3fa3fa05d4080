//! Ray against one triangle: exact Plücker test with a tie rule (paper appendix A).
//!
//! With a, b, c relative to the origin: u = d.(b x c), v = d.(c x a), w = d.(a x b), det = u + v + w, t_num = a.(b x c), all exact.
//! Sign of an edge function d.(p x q): its own; if 0, that of the first non-zero component of p x q (the direction perturbed by (e, e^2, e^3));
//! if p x q = 0, either: the origin is then in the triangle's plane, or the triangle is flat, and t_num = 0. (The RTL takes the sign of q - p there, which decides nothing.) Hit iff the three signs agree, det != 0 and
//! t_num / det > 0; both faces are hit, the front one if det < 0. Half edges have parallel normals and directions, so both sides of a T-junction and of an edge
//! decide alike: a closed surface is crossed exactly once.
//! Legal: |v| < 2^31 for points and origin, |d| <= 2^30 and each |d_i| < 2^30. On a miss all numbers are 0. On a hit they are taken with det > 0.

use super::parts::{
    Multiplier, Parts, Registers, TAG, TRI_DECIDE_LATENCY, cross_product, cross_product_latency, dot_product, multiplier_latency,
};
use super::{Block, EdgesPerCycle, Form, Timing, parts};
use crate::num::{Direction, Point, WU, wire_struct};

wire_struct! {
    /// Input of [`TriTest`].
    pub struct In {
        /// Origin of the ray.
        origin: Point,
        /// Its direction.
        direction: Direction,
        /// Corner a = p0.
        p0: Point,
        /// Corner b = p1.
        p1: Point,
        /// Corner c = p2.
        p2: Point,
    }
}

/// Edge functions and det, positive: |p x q| |d| <= (2^32.8)^2 2^30 < 2^96 (Hadamard), det likewise from the triangle's edges.
pub type EdgeFunction = WU<{ parts::EDGE_FUNCTION }>;
/// Numerator of t, positive: |a| |b| |c| < 2^98.4.
pub type TNumerator = WU<{ parts::T_NUMERATOR }>;

wire_struct! {
    /// Output of [`TriTest`].
    pub struct Out {
        /// The ray meets the triangle.
        hit: bool,
        /// It meets its front (counter-clockwise) face.
        front: bool,
        /// Weight of p1 times det.
        v: EdgeFunction,
        /// Weight of p2 times det.
        w: EdgeFunction,
        /// u + v + w.
        det: EdgeFunction,
        /// t times det.
        t_num: TNumerator,
    }
}

/// The block.
pub struct TriTest;

impl TriTest {
    /// Timing of the default's RTL with one edge function (its parameter `EDGES_PER_CYCLE` = 1).
    pub const ONE_EDGE: Timing = one_edge(&Form::FULL);
    /// And with three.
    pub const THREE_EDGES: Timing = three_edges(&Form::FULL);
}

/// p x d: components below 2^62.8 (Lagrange). The edge function d.(p x q) is p.(q x d), of 64 x 64-bit products where p x q takes wider ones.
#[inline(always)]
pub(crate) fn moment(p: [i64; 3], d: [i64; 3]) -> [i64; 3] {
    [p[1] * d[2] - p[2] * d[1], p[2] * d[0] - p[0] * d[2], p[0] * d[1] - p[1] * d[0]]
}

/// p.m: partial sums below 2^95.6 (32.8 and 62.8 bits; Cauchy-Schwarz).
#[inline(always)]
pub(crate) fn dot_moment(p: [i64; 3], m: [i64; 3]) -> i128 {
    let wide = |a: i64, b: i64| i128::from(a) * i128::from(b);
    wide(p[0], m[0]) + wide(p[1], m[1]) + wide(p[2], m[2])
}

/// p x q: components below 2 * 2^64, and below 2^65.6 together.
#[inline(always)]
pub(crate) fn cross(p: [i64; 3], q: [i64; 3]) -> [i128; 3] {
    let wide = |a: i64, b: i64| i128::from(a) * i128::from(b);
    [wide(p[1], q[2]) - wide(p[2], q[1]), wide(p[2], q[0]) - wide(p[0], q[2]), wide(p[0], q[1]) - wide(p[1], q[0])]
}

/// Partial sums below 2^98.4 for a point (32.8 bits): Cauchy-Schwarz.
#[inline(always)]
pub(crate) fn dot_wide(n: [i128; 3], d: [i64; 3]) -> i128 {
    n[0] * i128::from(d[0]) + n[1] * i128::from(d[1]) + n[2] * i128::from(d[2])
}

/// True if the edge function `value` = d.(p x q) counts as positive.
#[inline(always)]
fn is_positive(value: i128, p: [i64; 3], q: [i64; 3]) -> bool {
    if value != 0 {
        return value > 0;
    }
    tie_is_positive(p, q)
}

#[cold]
fn tie_is_positive(p: [i64; 3], q: [i64; 3]) -> bool {
    cross(p, q).into_iter().find(|&c| c != 0).is_none_or(|c| c > 0)
}

/// `edge_function`: the cross product with d and the sign of q - p beside it, the dot product with the tie's sign beside it.
fn edge_function(form: &Form) -> Registers {
    let (cross, [with_d, _]) = (cross_product_latency(form.relative()), form.edge_product_stages());
    let normal = cross_product(form.relative()) + Registers::line(3 * form.component() + 1, cross, 1);
    let dot = dot_product(form.normal(), form.component(), form.signed_edge(), with_d, 0);
    normal + dot + Registers::line(1, form.edge_function_latency() - cross, 1)
}

/// `tri_decide`: signs, decision, numbers, of edge functions and a t of so many bits.
pub(super) fn tri_decide(signed_edge: u32, signed_t: u32) -> Registers {
    let numbers = 3 * signed_edge + signed_t + TAG;
    // Magnitudes leave: behind the signs no number needs its top bit, but for t until the decision.
    let signs = Registers::stage(7 + numbers).without(3);
    signs + Registers::skid(2 + numbers).without(2 * 4) + Registers::stage(2 + numbers - 4)
}

/// `tri_edges_parallel`: the corners, three edge functions, and a . (b x c).
fn parallel(form: &Form) -> Registers {
    let (cross, [_, with_a]) = (cross_product_latency(form.relative()), form.edge_product_stages());
    let corners = Registers::stage(9 * form.relative() + 3 * form.component() + TAG);
    let t = Registers::line(3 * form.relative(), cross, 1) + dot_product(form.normal(), form.relative(), form.signed_t(), with_a, 0);
    corners + 3 * edge_function(form) + t + Registers::line(TAG, form.edge_function_latency(), 2)
}

/// `tri_edges_serial`: the corners, which turn; one edge function; t, a component a pass; u and v, which wait.
fn serial(form: &Form) -> Registers {
    let (pass, relative, normal, [_, with_a]) = (2, form.relative(), form.normal(), form.edge_product_stages());
    let corners = Registers::bits(9 * relative + 3 * form.component() + TAG + 1 + pass);
    let beside_cross = Registers::line(relative + pass + TAG, cross_product_latency(relative), 1);
    let factors = Registers::bits(2 * normal) + Registers::stage(normal + relative + pass + TAG);
    let product = Multiplier { product_stages: with_a, last_is_skid: true, ..Multiplier::new(normal, relative) };
    let beside_product = Registers::line(pass + TAG, with_a - 1 + multiplier_latency(normal, relative), 1);
    let sum = Registers::bits(form.signed_t()) + Registers::stage(pass + TAG) + Registers::stage(form.signed_t() + pass + TAG);
    let waiting = Registers::bits(2 * (form.signed_edge() + 1));
    (corners + edge_function(form) + beside_cross + factors + product.registers() + beside_product + sum + waiting).in_turns(3)
}

/// Timing with three edge functions.
const fn three_edges(form: &Form) -> Timing {
    Timing::pipelined(1 + form.edge_function_latency() + TRI_DECIDE_LATENCY)
}

/// Timing with one, which u, v and w pass through in turn: two passes more.
const fn one_edge(form: &Form) -> Timing {
    Timing { latency: three_edges(form).latency + 2, interval: 3 }
}

const fn timing(form: &Form) -> Timing {
    match form.edges_per_cycle {
        EdgesPerCycle::Three => three_edges(form),
        EdgesPerCycle::One => one_edge(form),
    }
}

impl Block for TriTest {
    const NAME: &'static str = "tri_test";
    const TIMING: Timing = timing(&Form::FULL);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let (relative, normal, component) = (form.relative(), form.normal(), form.component());
        let (edge, t) = (form.signed_edge(), form.signed_t());
        // Signs and zeros of three edge functions and t; corners, cross products, edge functions, det, ties.
        let signs = 3 * edge + t;
        let add_bits = 9 * relative + 9 * normal + 6 * edge + 2 * edge + signs + 9 * relative;
        let (add_bits, select_bits, edges) = match form.edges_per_cycle {
            EdgesPerCycle::Three => (add_bits + 2 * t, signs, parallel(form)),
            // t grows by a component from zero; a component of a and of b x c is chosen for each.
            EdgesPerCycle::One => (add_bits + 3 * t, signs + 3 * (2 * normal + 2 * relative), serial(form)),
        };
        // Cross products, edge functions, t.
        let products = vec![[18, relative, relative], [9, normal, component], [3, normal, relative]];
        Parts { products, add_bits, select_bits, registers: edges + tri_decide(edge, t) }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        let x = input.origin.get();
        let d = input.direction.get();
        // 33-bit differences.
        let relative = |p: Point| {
            let p = p.get();
            [p[0] - x[0], p[1] - x[1], p[2] - x[2]]
        };
        let (a, b, c) = (relative(input.p0), relative(input.p1), relative(input.p2));

        let (u, v) = (dot_moment(b, moment(c, d)), dot_moment(c, moment(a, d)));
        let positive = is_positive(u, b, c);
        if positive != is_positive(v, c, a) {
            return Out::default();
        }
        let w = dot_moment(a, moment(b, d));
        if positive != is_positive(w, a, b) {
            return Out::default();
        }
        let det = u + v + w;
        let t_num = dot_wide(cross(b, c), a);
        let (v, w, det, t_num) = if positive { (v, w, det, t_num) } else { (-v, -w, -det, -t_num) };
        // The signs agree, so det is not negative here.
        if det == 0 || t_num <= 0 {
            return Out::default();
        }
        Out {
            hit: true,
            front: !positive,
            v: WU::new(v.cast_unsigned()),
            w: WU::new(w.cast_unsigned()),
            det: WU::new(det.cast_unsigned()),
            t_num: WU::new(t_num.cast_unsigned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shoot(origin: [i64; 3], direction: [i64; 3], p: [[i64; 3]; 3]) -> Out {
        let v = |a: [i64; 3]| Point::new(a[0], a[1], a[2]);
        let direction = Direction::new(direction[0], direction[1], direction[2]);
        TriTest::eval(&In { origin: v(origin), direction, p0: v(p[0]), p1: v(p[1]), p2: v(p[2]) })
    }

    const DOWN: [i64; 3] = [0, 0, -(1 << 29)];

    #[test]
    fn both_faces_are_hit_and_told_apart() {
        let p = [[0, 0, 0], [16, 0, 0], [0, 16, 0]];
        let out = shoot([4, 4, 1 << 20], DOWN, p);
        assert!(out.hit && out.front, "counter-clockwise seen from above");
        let turned = shoot([4, 4, 1 << 20], DOWN, [p[0], p[2], p[1]]);
        assert!(turned.hit && !turned.front);
        assert!(!shoot([4, 4, -100], DOWN, p).hit, "behind");
        assert!(!shoot([40, 4, 100], DOWN, p).hit, "beside");
    }

    #[test]
    fn a_fan_around_a_vertex_is_hit_once_by_a_ray_through_it() {
        let rim = [[16, 0, 0], [16, 16, 0], [0, 16, 0], [-16, 16, 0], [-16, 0, 0], [-16, -16, 0], [0, -16, 0], [16, -16, 0]];
        for target in [[0, 0], [8, 8], [8, 0], [0, -8], [-8, 0]] {
            let hits = (0..8).filter(|&k| shoot([target[0], target[1], 50], DOWN, [[0, 0, 0], rim[k], rim[(k + 1) % 8]]).hit).count();
            assert_eq!(hits, 1, "{target:?}");
        }
    }

    #[test]
    fn what_an_origin_lies_on_is_not_met() {
        let p = [[0, 0, 0], [32, 0, 0], [0, 32, 0]];
        for origin in [[8, 8, 0], [8, 0, 0], [0, 0, 0], [32, 0, 0], [16, 16, 0]] {
            for direction in [DOWN, DOWN.map(|c| -c), [3, -5, 1 << 20]] {
                assert!(!shoot(origin, direction, p).hit, "{origin:?} {direction:?}");
            }
            assert!(shoot([origin[0], origin[1], 1], DOWN, p).hit == shoot([origin[0], origin[1], 9], DOWN, p).hit);
        }
        assert!(shoot([8, 8, 1], DOWN, p).hit && !shoot([8, 8, -1], DOWN, p).hit);
    }

    #[test]
    fn in_plane_and_degenerate_triangles_are_missed() {
        assert!(!shoot([-10, 2, 0], [1 << 29, 0, 0], [[0, 0, 0], [16, 0, 0], [0, 16, 0]]).hit);
        assert!(!shoot([0, 0, 9], DOWN, [[0, 0, 0], [0, 0, 0], [0, 16, 0]]).hit);
        assert!(!shoot([0, 0, 9], DOWN, [[0, 0, 0]; 3]).hit);
        assert!(!shoot([4, 0, 9], DOWN, [[0, 0, 0], [16, 0, 0], [32, 0, 0]]).hit);
    }
}
