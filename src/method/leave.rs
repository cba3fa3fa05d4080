//! Rays that leave a surface: where they start, and to which side (`docs/numbers.md`, "Start").
//!
//! A ray starts at b0 p0 + b1 p1 + b2 p2 of the triangle that was hit, a point of the triangle's plane and inside the triangle, exact in steps of 2^-31 units: x = X + f / 2^31 with X
//! whole and 0 <= f < 2^31. What the fraction changes are blocks: of the ray's constants (`start_setup`), of the triangle test (`start_test`) and of the division of hits (`start_divide`).

use crate::block::dot;
use crate::block::tri_test::{cross, dot_wide};
use crate::num::{BARY_ONE, Bary, Direction, Point, START_BITS, Start, U};
use std::cmp::Ordering;

/// Whole part of a number in steps of 2^-31.
const LOW: i64 = (1 << START_BITS) - 1;

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Block;
    use crate::block::start_test::{self, StartTest};
    use crate::num::Random;

    fn point(random: &mut Random, most: u64) -> Point {
        let [x, y, z] = [(); 3].map(|()| random.within(most));
        Point::new(x, y, z)
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
    fn what_a_ray_leaves_is_not_met_and_what_lies_ahead_is() {
        let triangle = |z: i64| [[0, 0, z], [64, 0, z], [0, 64, z + 1]].map(|[x, y, z]: [i64; 3]| Point::new(x, y, z));
        let own = triangle(0);
        let third = Bary::new(BARY_ONE / 3);
        let from = start(&own, [Bary::new(BARY_ONE - 2 * (BARY_ONE / 3)), third, third]);
        let met = |direction: Direction, [p0, p1, p2]: [Point; 3]| {
            StartTest::eval(&start_test::In { start: from, direction, p0, p1, p2 }).test.hit
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
}
