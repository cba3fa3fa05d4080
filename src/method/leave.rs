//! Rays that leave a surface: where they start, and what that changes of a ray's constants and of the triangle test (`docs/numbers.md`, "Start").
//!
//! A ray starts at b0 p0 + b1 p1 + b2 p2 of the triangle that was hit, a point of the triangle's plane and inside the triangle, exact in steps of 2^-31 units: x = X + f / 2^31 with X
//! whole and 0 <= f < 2^31. With A, B, C relative to X, d.(b x c) = d.(B x C) + (d x f).(B - C) / 2^31 and a.(b x c) = A.N - f.N / 2^31 with N = (B - A) x (C - A):
//! what the fraction adds is one dot product each. det is as without it, and so are boxes, but for the moment's floor and ceilings. Written as blocks are, without float and with every
//! width proved; the RTL has no such rays yet.
//! Legal: as [`TriTest`](tri_test::TriTest); the weights' sum is 2^31.

use crate::block::hit_divide;
use crate::block::ray_setup::{self, Axis, RaySetup};
use crate::block::tri_test::{self, EdgeFunction, TNumerator, cross, dot_moment, dot_wide, moment};
use crate::block::{Block, dot};
use crate::num::{BARY_ONE, BOX_SHIFT, Bary, Direction, Point, RayT, S, START_BITS, Start, U, WU, wire_struct};
use std::cmp::Ordering;

/// Whole part of a number in steps of 2^-31.
const LOW: i64 = (1 << START_BITS) - 1;

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

/// The point of a triangle with these weights, each taken as 1 at least at the cost of the largest: inside, and not on an edge.
#[inline]
pub fn start(corners: &[Point; 3], weights: [Bary; 3]) -> Start {
    let b = inside(weights.map(|b| b.get().cast_signed()));
    let corners = corners.map(Point::get);
    // A mean: below 2^31 units, and so 62 bits with its sign.
    let sum: [i64; 3] = std::array::from_fn(|k| dot(b, [corners[0][k], corners[1][k], corners[2][k]]));
    let [x, y, z] = sum.map(|c| c >> START_BITS);
    Start { point: Point::new(x, y, z), fraction: sum.map(|c| U::new((c & LOW).cast_unsigned())) }
}

/// Weights of sum 2^31 of which none is 0.
fn inside(mut b: [i64; 3]) -> [i64; 3] {
    debug_assert_eq!(b.iter().sum::<i64>(), BARY_ONE.cast_signed());
    // At most two are 0, so the largest is far above 2.
    let largest = if b[0] >= b[1] && b[0] >= b[2] {
        0
    } else if b[1] >= b[2] {
        1
    } else {
        2
    };
    for k in 0..3 {
        if b[k] == 0 {
            b[k] = 1;
            b[largest] -= 1;
        }
    }
    b
}

/// On which side of a triangle a direction leads: `Greater` to where its normal (p1 - p0) x (p2 - p0) points, `Equal` along it.
#[inline]
pub fn side(corners: &[Point; 3], direction: Direction) -> Ordering {
    let [a, b, c] = corners.map(Point::get);
    let d = direction.get();
    let along = |p: [i64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
    // Below 2^96 (Hadamard).
    dot_wide(cross(along(b), along(c)), d).cmp(&0)
}

/// What the tests of one ray need of its start's fraction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leaving {
    fraction: [i64; 3],
    /// d x f: components below 2^61.9.
    turned: [i64; 3],
}

impl Leaving {
    /// Of a ray from `start` along `direction`.
    #[inline]
    pub fn new(start: &Start, direction: Direction) -> Self {
        let fraction = start.fraction.map(|f| f.get().cast_signed());
        Self { fraction, turned: moment(direction.get(), fraction) }
    }

    /// The ray's constants: those of [`RaySetup`] for its exact start, the moment rounded down to whole numbers.
    #[inline]
    pub fn setup(&self, point: Point, direction: Direction) -> ray_setup::Out {
        let out = RaySetup::eval(&ray_setup::In { origin: point, direction });
        let ray_setup::Out { x, y, z, moment } = out;
        let axes = [x, y, z];
        let fraction: [i64; 3] = std::array::from_fn(|k| if axes[k].mirror { -self.fraction[k] } else { self.fraction[k] });
        // Products below 2^61; the sum stays below 2^62 like the moment of any point.
        let more =
            |i: usize, j: usize| (fraction[i] * axes[j].d.get().cast_signed() - fraction[j] * axes[i].d.get().cast_signed()) >> START_BITS;
        let [yz, zx, xy] = moment.get();
        let [x, y, z] = [0, 1, 2].map(|k| {
            // With a fraction ahead of it a whole point's ceiling is that of the next one.
            let ahead = i64::from(fraction[k] > 0);
            Axis { ceil: S::new((axes[k].origin.get() + ahead + ((1 << BOX_SHIFT) - 1)) >> BOX_SHIFT), ..axes[k] }
        });
        let moment = crate::num::Vec3::new(yz + more(1, 2), zx + more(2, 0), xy + more(0, 1));
        ray_setup::Out { x, y, z, moment }
    }

    /// The triangle test for its exact start: the same decisions, numerators rounded down to whole numbers, and what is below those.
    #[inline(always)]
    pub fn test(&self, input: &tri_test::In) -> (tri_test::Out, Below) {
        let (x, d) = (input.origin.get(), input.direction.get());
        let relative = |p: Point| {
            let p = p.get();
            [p[0] - x[0], p[1] - x[1], p[2] - x[2]]
        };
        let (a, b, c) = (relative(input.p0), relative(input.p1), relative(input.p2));
        // In steps of 2^-31: an edge function is below 2^96 for any start, so below 2^127.
        let edge = |p: [i64; 3], q: [i64; 3]| {
            (dot_moment(p, moment(q, d)) << START_BITS) + dot_moment([p[0] - q[0], p[1] - q[1], p[2] - q[2]], self.turned)
        };
        let (u, v) = (edge(b, c), edge(c, a));
        let positive = self.is_positive(u, b, c);
        if positive != self.is_positive(v, c, a) {
            return Default::default();
        }
        let w = edge(a, b);
        if positive != self.is_positive(w, a, b) {
            return Default::default();
        }
        // Their sum is that of whole points: the fractions cancel.
        let det = (u + v + w) >> START_BITS;
        if det == 0 {
            return Default::default();
        }
        let normal = cross([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
        // Below 2^98.4; f.N below 2^65.6 2^31.8.
        let (whole, less) = (dot_wide(normal, a), dot_wide(normal, self.fraction));
        let (v, w, det, whole, less) = if positive { (v, w, det, whole, less) } else { (-v, -w, -det, -whole, -less) };
        let (t_num, t_low) = (whole + (-less >> START_BITS), -less & i128::from(LOW));
        if t_num < 0 || t_num == 0 && t_low == 0 {
            return Default::default();
        }
        #[expect(clippy::as_conversions, reason = "31 bits")]
        let low = |v: i128| U::new((v & i128::from(LOW)) as u64);
        let out = tri_test::Out {
            hit: true,
            front: !positive,
            v: EdgeFunction::new((v >> START_BITS).cast_unsigned()),
            w: EdgeFunction::new((w >> START_BITS).cast_unsigned()),
            det: WU::new(det.cast_unsigned()),
            t_num: TNumerator::new(t_num.cast_unsigned()),
        };
        (out, Below { v: low(v), w: low(w), t: low(t_low) })
    }

    #[inline(always)]
    fn is_positive(&self, value: i128, p: [i64; 3], q: [i64; 3]) -> bool {
        if value != 0 { value > 0 } else { self.tie_is_positive(p, q) }
    }

    /// The tie rule of the triangle test, with p x q of the exact start in steps of 2^-31: P x Q 2^31 + f x (P - Q), below 2^97.
    #[cold]
    fn tie_is_positive(&self, p: [i64; 3], q: [i64; 3]) -> bool {
        let (whole, turned) = (cross(p, q), cross(self.fraction, [p[0] - q[0], p[1] - q[1], p[2] - q[2]]));
        let normal: [i128; 3] = std::array::from_fn(|k| (whole[k] << START_BITS) + turned[k]);
        normal.into_iter().find(|&c| c != 0).is_none_or(|c| c > 0)
    }
}

/// The division of hits for a numerator with something below whole numbers: floor((n + low / 2^31) 2^32 / d), saturating at 35 bits. Where [`hit_divide`]'s has zeros, a step
/// of this one takes the next bit of `low`.
#[inline(always)]
pub fn divide(input: &hit_divide::In, low: U<START_BITS>) -> RayT {
    let (n, d) = (input.numerator.get(), input.denominator.get());
    let whole = n / d;
    if whole >= 1 << 3 {
        return RayT::MAX;
    }
    // r <= d - 1 and 2 low < 2^32: r 2^32 + 2 low < d 2^32, 128 bits.
    let fraction = (((n - whole * d) << 32) + (u128::from(low.get()) << 1)) / d;
    #[expect(clippy::as_conversions, reason = "below 2^3 and below 2^32")]
    let [whole, fraction] = [whole as u64, fraction as u64];
    RayT::new(whole << 32 | fraction)
}
