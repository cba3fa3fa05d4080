//! Ray from an exact start against one triangle: the triangle test for a point of the surface (`docs/numbers.md`, "Start").
//!
//! The ray starts at x = X + f / 2^31 with X whole and 0 <= f < 2^31. With A, B, C relative to X the exact p x q is P x Q + f x (P - Q) / 2^31: linear in f, as f x f = 0. So
//! d.(b x c) = d.(B x C) + (d x f).(B - C) / 2^31 and a.(b x c) = A.N - f.N / 2^31 with N = (B - A) x (C - A): what the fraction adds is one dot product each. det is as without it.
//! Decisions are those of [`TriTest`](tri_test::TriTest) on these exact numbers, ties on the exact p x q; numerators are rounded down to whole numbers, and `below` has what is left of them.
//!
//! The RTL adds up the exact p x q and takes d.(p x q) of it; a.(b x c) = A.(b x c) - f.(B x C) / 2^31, as f.(f x (B - C)) = 0.
//! Legal: as [`TriTest`](tri_test::TriTest), for X. On a miss all numbers are 0.

use super::parts::{
    EXACT_EDGE, EXACT_NORMAL, EXACT_T, Multiplier, Parts, Registers, START_EDGE_LATENCY, START_PRODUCT_STAGES, TAG, TRI_DECIDE_LATENCY,
    cross_product, cross_product_latency, dot_product, multiplier_latency,
};
use super::tri_test::{self, EdgeFunction, TNumerator, cross, dot_moment, dot_wide, moment, tri_decide};
use super::{Block, EdgesPerCycle, Form, Timing};
use crate::num::{Direction, Point, START_BITS, Start, U, WU, wire_struct};

wire_struct! {
    /// Input of [`StartTest`].
    pub struct In {
        /// Where the ray starts.
        start: Start,
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

wire_struct! {
    /// What numerators have below whole numbers, in steps of 2^-31: nothing for a ray from a whole point.
    pub struct Below {
        /// Of v.
        v: U<START_BITS>,
        /// Of w.
        w: U<START_BITS>,
        /// Of t.
        t: U<START_BITS>,
    }
}

wire_struct! {
    /// Output of [`StartTest`].
    pub struct Out {
        /// As the triangle test has it, its numerators rounded down.
        test: tri_test::Out,
        /// What is left of them.
        below: Below,
    }
}

/// The block.
pub struct StartTest;

impl StartTest {
    /// Timing of the default's RTL with one edge function (its parameter `EDGES_PER_CYCLE` = 1).
    pub const ONE_EDGE: Timing = one_edge();
    /// And with three.
    pub const THREE_EDGES: Timing = three_edges();
}

/// Whole part of a number in steps of 2^-31.
const LOW: i128 = (1 << START_BITS) - 1;

/// Corners as seen from X, components of a direction and of P x Q: exact starts have no zeros to leave out.
const RELATIVE: u32 = Form::FULL.relative();
const COMPONENT: u32 = Form::FULL.component();
const NORMAL: u32 = Form::FULL.normal();
/// A fraction as a signed factor.
const FRACTION: u32 = START_BITS + 1;
/// f.(P x Q): below 2^97.4.
const LESS: u32 = 99;
const CROSS: u32 = cross_product_latency(RELATIVE);
/// The product of a component of a with one of b x c, and that of f's with one of B x C beside it.
const PRODUCT: u32 = multiplier_latency(EXACT_NORMAL, RELATIVE);
const LESS_STAGES: u32 = 1 + PRODUCT - multiplier_latency(NORMAL, FRACTION);

/// Three edge functions: corners, edges, the difference of t's two parts, decision.
const fn three_edges() -> Timing {
    Timing::pipelined(1 + START_EDGE_LATENCY + 1 + TRI_DECIDE_LATENCY)
}

/// One, which u, v and w pass through in turn: two passes more; t's parts meet before they have passed.
const fn one_edge() -> Timing {
    Timing { latency: three_edges().latency + 1, interval: 3 }
}

const fn timing(form: &Form) -> Timing {
    match form.edges_per_cycle {
        EdgesPerCycle::Three => three_edges(),
        EdgesPerCycle::One => one_edge(),
    }
}

/// `start_edge`: two cross products with f and d beside them, their sum, and its product with d with the tie's sign beside it.
fn start_edge() -> Registers {
    let crosses = 2 * cross_product(RELATIVE) + Registers::line(3 * COMPONENT, CROSS, 1);
    // A fraction is unsigned: its two upper bits are 0 in each of the factors of its cross product.
    let fraction = 6 * 2;
    let exact = Registers::stage(3 * EXACT_NORMAL + 3 * NORMAL + 3 * COMPONENT);
    let dot = dot_product(EXACT_NORMAL, COMPONENT, EXACT_NORMAL + COMPONENT, START_PRODUCT_STAGES, 0);
    crosses.without(fraction) + exact + dot.without(1) + Registers::line(1, START_EDGE_LATENCY - CROSS - 1, 1)
}

/// `start_edges_parallel`: the corners, three edge functions, A.(b x c) and f.(B x C), and their difference.
fn parallel() -> Registers {
    let corners = Registers::stage(9 * RELATIVE + 3 * COMPONENT + 3 * START_BITS + TAG);
    let beside = Registers::line(3 * RELATIVE + 3 * START_BITS, CROSS + 1, 1);
    let dots = dot_product(EXACT_NORMAL, RELATIVE, EXACT_T, START_PRODUCT_STAGES, 0)
        + dot_product(NORMAL, FRACTION, LESS, START_PRODUCT_STAGES + LESS_STAGES - 1, 0);
    let difference = Registers::stage(3 * (EXACT_EDGE + 1) + EXACT_T + TAG);
    corners + 3 * start_edge() + beside + dots + difference + Registers::line(TAG, START_EDGE_LATENCY, 2)
}

/// `start_edges_serial`: the corners, which turn; one edge function; t, a component a pass; u and v, which wait.
fn serial() -> Registers {
    let pass = 2;
    let corners = Registers::bits(9 * RELATIVE + 3 * COMPONENT + 3 * START_BITS + TAG + 1 + pass);
    let beside = Registers::line(RELATIVE + START_BITS + pass + TAG, CROSS + 1, 1);
    let factors =
        Registers::bits(2 * (EXACT_NORMAL + NORMAL)) + Registers::stage(EXACT_NORMAL + NORMAL + RELATIVE + START_BITS + pass + TAG);
    let products = Multiplier::new(EXACT_NORMAL, RELATIVE).registers()
        + Multiplier { product_stages: LESS_STAGES, ..Multiplier::new(NORMAL, FRACTION) }.registers();
    let beside_product = Registers::line(pass + TAG, PRODUCT, 0);
    let difference = Registers::skid(EXACT_T + pass + TAG);
    let sum = Registers::bits(EXACT_T) + Registers::stage(pass + TAG) + Registers::stage(EXACT_T + pass + TAG);
    let waiting = Registers::bits(2 * (EXACT_EDGE + 1));
    (corners + start_edge() + beside + factors + products + beside_product + difference + sum + waiting).in_turns(3)
}

impl Block for StartTest {
    const NAME: &'static str = "start_test";
    const TIMING: Timing = timing(&Form::FULL);
    type In = In;
    type Out = Out;
    fn timing(form: &Form) -> Timing {
        timing(form)
    }
    fn parts(form: &Form) -> Parts {
        // Signs and zeros of three edge functions and t; corners and P - Q, cross products and their sums, edge functions, det, ties.
        let signs = 3 * EXACT_EDGE + EXACT_T;
        let add_bits = 18 * RELATIVE + 18 * NORMAL + 9 * EXACT_NORMAL + 6 * EXACT_EDGE + 2 * EXACT_EDGE + signs + 9 * EXACT_NORMAL;
        let (add_bits, select_bits, edges) = match form.edges_per_cycle {
            EdgesPerCycle::Three => (add_bits + 3 * EXACT_T + 2 * LESS, signs, parallel()),
            // t grows by a component from zero, each the difference of two products; the factors of each are chosen.
            EdgesPerCycle::One => {
                let chosen = 2 * (EXACT_NORMAL + NORMAL + RELATIVE + START_BITS);
                (add_bits + 6 * EXACT_T, signs + 3 * chosen, serial())
            }
        };
        // Cross products, edge functions, t.
        let products = vec![
            [18, RELATIVE, RELATIVE],
            [18, RELATIVE, FRACTION],
            [9, EXACT_NORMAL, COMPONENT],
            [3, EXACT_NORMAL, RELATIVE],
            [3, NORMAL, FRACTION],
        ];
        Parts { products, add_bits, select_bits, registers: edges + tri_decide(EXACT_EDGE, EXACT_T) }
    }
    #[inline(always)]
    fn eval(input: &In) -> Out {
        let (x, d) = (input.start.point.get(), input.direction.get());
        let fraction = input.start.fraction.map(|f| f.get().cast_signed());
        let relative = |p: Point| {
            let p = p.get();
            [p[0] - x[0], p[1] - x[1], p[2] - x[2]]
        };
        let (a, b, c) = (relative(input.p0), relative(input.p1), relative(input.p2));
        // d x f: components below 2^61.9.
        let turned = moment(d, fraction);
        // In steps of 2^-31: an edge function is below 2^96 for any start, so below 2^127.
        let edge = |p: [i64; 3], q: [i64; 3]| {
            (dot_moment(p, moment(q, d)) << START_BITS) + dot_moment([p[0] - q[0], p[1] - q[1], p[2] - q[2]], turned)
        };
        let (u, v) = (edge(b, c), edge(c, a));
        let positive = is_positive(u, fraction, b, c);
        if positive != is_positive(v, fraction, c, a) {
            return Default::default();
        }
        let w = edge(a, b);
        if positive != is_positive(w, fraction, a, b) {
            return Default::default();
        }
        // Their sum is that of whole points: the fractions cancel.
        let det = (u + v + w) >> START_BITS;
        if det == 0 {
            return Default::default();
        }
        let normal = cross([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
        // Below 2^98.4; f.N below 2^65.6 2^31.8.
        let (whole, less) = (dot_wide(normal, a), dot_wide(normal, fraction));
        let (v, w, det, whole, less) = if positive { (v, w, det, whole, less) } else { (-v, -w, -det, -whole, -less) };
        let (t_num, t_low) = (whole + (-less >> START_BITS), -less & LOW);
        if t_num < 0 || t_num == 0 && t_low == 0 {
            return Default::default();
        }
        #[expect(clippy::as_conversions, reason = "31 bits")]
        let low = |v: i128| U::new((v & LOW) as u64);
        let test = tri_test::Out {
            hit: true,
            front: !positive,
            v: EdgeFunction::new((v >> START_BITS).cast_unsigned()),
            w: EdgeFunction::new((w >> START_BITS).cast_unsigned()),
            det: WU::new(det.cast_unsigned()),
            t_num: TNumerator::new(t_num.cast_unsigned()),
        };
        Out { test, below: Below { v: low(v), w: low(w), t: low(t_low) } }
    }
}

#[inline(always)]
fn is_positive(value: i128, fraction: [i64; 3], p: [i64; 3], q: [i64; 3]) -> bool {
    if value != 0 { value > 0 } else { tie_is_positive(fraction, p, q) }
}

/// The tie rule of the triangle test, with p x q of the exact start in steps of 2^-31: P x Q 2^31 + f x (P - Q), below 2^97.
#[cold]
fn tie_is_positive(fraction: [i64; 3], p: [i64; 3], q: [i64; 3]) -> bool {
    let (whole, turned) = (cross(p, q), cross(fraction, [p[0] - q[0], p[1] - q[1], p[2] - q[2]]));
    let normal: [i128; 3] = std::array::from_fn(|k| (whole[k] << START_BITS) + turned[k]);
    normal.into_iter().find(|&c| c != 0).is_none_or(|c| c > 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::tri_test::TriTest;
    use crate::num::{Random, Vec3};

    #[test]
    fn from_a_whole_point_it_is_the_triangle_test() {
        let mut hits = 0;
        for number in 0..20_000 {
            let mut random = Random::of(3, number);
            let most = 1 << random.below(31);
            let mut point = || {
                let [x, y, z] = [(); 3].map(|()| random.within(most));
                Point::new(x, y, z)
            };
            let [origin, p0, p1, p2] = [(); 4].map(|()| point());
            let [x, y, z] = [(); 3].map(|()| random.within(1 << 29) * i64::from(random.below(5) > 0));
            let direction = Direction::new(x, y, z);
            let start = Start { point: origin, fraction: Default::default() };
            let test = TriTest::eval(&tri_test::In { origin, direction, p0, p1, p2 });
            assert_eq!(StartTest::eval(&In { start, direction, p0, p1, p2 }), Out { test, below: Below::default() });
            hits += u64::from(test.hit);
        }
        assert!(hits > 500, "{hits}");
    }

    /// The largest coordinates, so that every width is used.
    #[test]
    fn nothing_overflows() {
        let m = (1i64 << 31) - 1;
        let ends = [-m, m];
        for corner in 0..8u64 {
            for d in [[1, 1, 1], [1, -1, 1], [-1, 1, 1], [1, 1, -1]] {
                let direction = Vec3::new(d[0] * 619_925_131, d[1] * 619_925_131, d[2] * 619_925_131);
                let p: [i64; 3] = std::array::from_fn(|k| ends[usize::from(corner >> k & 1 != 0)]);
                let [p0, p1, p2] = [[m, -m, -m], [-m, m, -m], [-m, -m, m]].map(|[x, y, z]| Point::new(x, y, z));
                let start = Start { point: Point::new(p[0], p[1], p[2]), fraction: [U::new((1 << 31) - 1); 3] };
                let whole = TriTest::eval(&tri_test::In { origin: start.point, direction, p0, p1, p2 });
                let out = StartTest::eval(&In { start, direction, p0, p1, p2 }).test;
                assert!(!out.hit || out.det == whole.det || !whole.hit);
            }
        }
    }
}
