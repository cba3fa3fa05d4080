//! Rays that leave a surface: where they start, and what that changes of a ray's constants and of the triangle test (`docs/numbers.md`, "Start").
//!
//! A ray starts at b0 p0 + b1 p1 + b2 p2 of the triangle that was hit, a point of the triangle's plane and inside the triangle, exact in steps of 2^-31 units: x = X + f / 2^31 with X
//! whole and 0 <= f < 2^31. With A, B, C relative to X, d.(b x c) = d.(B x C) + (d x f).(B - C) / 2^31 and a.(b x c) = A.N - f.N / 2^31 with N = (B - A) x (C - A):
//! what the fraction adds is one dot product each. det is as without it, and so are boxes, but for the moment's floor and ceilings. Written as blocks are, without float and with every
//! width proved; the RTL has no such rays yet.
//! Legal: as [`TriTest`](tri_test::TriTest); the weights' sum is 2^31.

use crate::block::ray_setup::{self, Axis, RaySetup};
use crate::block::tri_test::{self, EdgeFunction, TNumerator, cross, dot_moment, dot_wide, moment};
use crate::block::{Block, dot};
use crate::num::{BARY_ONE, BOX_SHIFT, Bary, Direction, Point, S, START_BITS, Start, U, WU, wire_struct};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::tri_test::TriTest;
    use crate::num::{Random, Vec3};

    fn point(random: &mut Random, most: u64) -> Point {
        let [x, y, z] = [(); 3].map(|()| random.within(most));
        Point::new(x, y, z)
    }

    fn any_direction(random: &mut Random) -> Direction {
        let [x, y, z] = [(); 3].map(|()| random.within(1 << 29) * i64::from(random.below(5) > 0));
        Direction::new(x, y, z)
    }

    /// Coordinates in steps of 2^-31.
    fn fine(start: &Start) -> [i128; 3] {
        let whole = start.point.get();
        std::array::from_fn(|k| (i128::from(whole[k]) << START_BITS) + i128::from(start.fraction[k].get()))
    }

    #[test]
    fn starts_are_exact_and_inside() {
        for number in 0..20_000 {
            let mut random = Random::of(1, number);
            let corners = [(); 3].map(|()| point(&mut random, (1 << 31) - 1));
            let b1 = random.below(BARY_ONE + 1) >> random.below(32);
            let b2 = random.below(BARY_ONE - b1 + 1) >> random.below(32);
            let mut weights = [BARY_ONE - b1 - b2, b1, b2];
            weights.rotate_left((number % 3) as usize);
            let at = fine(&start(&corners, weights.map(Bary::new)));
            // None is 0, the largest gives what they lack.
            let raised = weights.map(|b| b.max(1));
            let most = (0..3).rev().max_by_key(|&k| weights[k]).unwrap();
            let exact: [i128; 3] = std::array::from_fn(|axis| {
                let weight = |k: usize| i128::from(raised[k]) - i128::from(raised.iter().sum::<u64>() - BARY_ONE) * i128::from(k == most);
                (0..3).map(|k| weight(k) * i128::from(corners[k].get()[axis])).sum()
            });
            assert_eq!(at, exact, "{weights:?}");
        }
    }

    #[test]
    fn constants_are_those_of_the_exact_start() {
        for number in 0..20_000 {
            let mut random = Random::of(2, number);
            let from = Start {
                point: point(&mut random, (1 << 31) - 2),
                fraction: [(); 3].map(|()| U::new(random.below(1 << 31) * random.below(2))),
            };
            let d = any_direction(&mut random);
            let out = Leaving::new(&from, d).setup(from.point, d);
            let (x, d) = (fine(&from), d.get());
            // Mirrored.
            let m: [i128; 3] = std::array::from_fn(|k| if d[k] < 0 { -x[k] } else { x[k] });
            let size = |k: usize| i128::from(d[k].abs());
            let axes = [out.x, out.y, out.z];
            for k in 0..3 {
                let ceil = -((-m[k]) >> (START_BITS + BOX_SHIFT));
                assert_eq!((i128::from(axes[k].ceil.get()), axes[k].mirror), (ceil, d[k] < 0), "{from:?} {d:?}");
            }
            let moment = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| (m[i] * size(j) - m[j] * size(i)) >> START_BITS);
            assert_eq!(out.moment.get().map(i128::from), moment, "{from:?} {d:?}");
        }
    }

    #[test]
    fn from_a_whole_point_it_is_the_block() {
        let mut hits = 0;
        for number in 0..20_000 {
            let mut random = Random::of(3, number);
            let most = 1 << random.below(31);
            let [origin, p0, p1, p2] = [(); 4].map(|()| point(&mut random, most));
            let input = tri_test::In { origin, direction: any_direction(&mut random), p0, p1, p2 };
            let from = Start { point: origin, fraction: Default::default() };
            let leaving = Leaving::new(&from, input.direction);
            assert_eq!(leaving.test(&input), (TriTest::eval(&input), Below::default()));
            let setup = RaySetup::eval(&ray_setup::In { origin, direction: input.direction });
            assert_eq!(leaving.setup(origin, input.direction), setup);
            hits += u64::from(TriTest::eval(&input).hit);
        }
        assert!(hits > 500, "{hits}");
    }

    #[test]
    fn what_a_ray_leaves_is_not_met_and_what_lies_ahead_is() {
        let triangle = |z: i64| [[0, 0, z], [64, 0, z], [0, 64, z + 1]].map(|[x, y, z]: [i64; 3]| Point::new(x, y, z));
        let own = triangle(0);
        let third = Bary::new(BARY_ONE / 3);
        let from = start(&own, [Bary::new(BARY_ONE - 2 * (BARY_ONE / 3)), third, third]);
        let met = |direction: Direction, [p0, p1, p2]: [Point; 3]| {
            Leaving::new(&from, direction).test(&tri_test::In { origin: from.point, direction, p0, p1, p2 }).0.hit
        };
        let (up, down) = (Direction::new(3, 5, 1 << 29), Direction::new(3, 5, -(1 << 29)));
        assert_eq!(
            [side(&own, up), side(&own, down), side(&own, Direction::new(1, 0, 0))],
            [Ordering::Greater, Ordering::Less, Ordering::Equal]
        );
        assert!(!met(up, own) && !met(down, own));
        // The next sheet is one unit away: the rounded start lies on its other side or on it, the exact one does not.
        assert!(met(up, triangle(1)) && !met(down, triangle(1)));
        assert!(met(down, triangle(-1)) && !met(up, triangle(-1)));
    }

    /// The largest coordinates, so that every width is used.
    #[test]
    fn nothing_overflows() {
        let m = (1i64 << 31) - 1;
        let ends = [-m, m];
        for corner in 0..8u64 {
            for d in [[1, 1, 1], [1, -1, 1], [-1, 1, 1], [1, 1, -1]] {
                let direction = Vec3::new(d[0] * 619_925_131, d[1] * 619_925_131, d[2] * 619_925_131);
                let p: [i64; 3] = std::array::from_fn(|k| ends[(corner >> k & 1) as usize]);
                let [p0, p1, p2] = [[m, -m, -m], [-m, m, -m], [-m, -m, m]].map(|[x, y, z]| Point::new(x, y, z));
                let from = Start { point: Point::new(p[0], p[1], p[2]), fraction: [U::new((1 << 31) - 1); 3] };
                let leaving = Leaving::new(&from, direction);
                let input = tri_test::In { origin: from.point, direction, p0, p1, p2 };
                let whole = TriTest::eval(&input);
                let (out, _) = leaving.test(&input);
                assert!(!out.hit || out.det == whole.det || !whole.hit);
                leaving.setup(from.point, direction);
            }
        }
    }
}
