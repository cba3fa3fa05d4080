//! Rays that start on a triangle, at a point between whole ones: everything in big integers, in steps of 2^-31 units.

use super::predicates::{self, Meeting, Vector, held, sub};
use num_bigint::{BigInt, BigUint, Sign};

/// A point in steps of 2^-31 units.
pub(super) type Fine = [i64; 3];

type Big = [BigInt; 3];

fn cross(p: &Big, q: &Big) -> Big {
    std::array::from_fn(|k| &p[(k + 1) % 3] * &q[(k + 2) % 3] - &p[(k + 2) % 3] * &q[(k + 1) % 3])
}

fn dot(p: &Big, q: &Big) -> BigInt {
    (0..3).map(|k| &p[k] * &q[k]).sum()
}

/// Corners seen from `start`.
fn relative(corners: [Vector; 3], start: Fine) -> [Big; 3] {
    corners.map(|p| std::array::from_fn(|k| (BigInt::from(p[k]) << 31) - start[k]))
}

/// The mean of a triangle's corners by barycentrics of sum 2^31, each taken as 1 at least at the cost of the first of the largest.
pub(super) fn inside(corners: [Vector; 3], bary: [u32; 3]) -> Fine {
    let mut b = bary.map(i64::from);
    let most = (0..3).rev().max_by_key(|&k| b[k]).unwrap_or(0);
    b[most] -= b.iter().filter(|&&v| v == 0).count() as i64; // two at most
    let b = b.map(|v| v.max(1));
    std::array::from_fn(|axis| (0..3).map(|k| b[k] * corners[k][axis]).sum())
}

/// The meeting of the ray from `start` along `d` with a triangle, if there is one.
pub(super) fn meet(start: Fine, d: Vector, corners: [Vector; 3]) -> Option<Meeting> {
    let d = d.map(BigInt::from);
    let [a, b, c] = relative(corners, start);
    let edge = |p: &Big, q: &Big| {
        let n = cross(p, q);
        let value = dot(&d, &n);
        let leading = std::iter::once(&value).chain(&n).map(BigInt::sign).find(|&s| s != Sign::NoSign).unwrap_or(Sign::Plus);
        (value, leading)
    };
    let [(u, sign), (v, sign_v), (w, sign_w)] = [edge(&b, &c), edge(&c, &a), edge(&a, &b)];
    let det = &u + &v + &w;
    let t_num = dot(&a, &cross(&b, &c));
    if sign_v != sign || sign_w != sign || (&t_num * &det).sign() != Sign::Plus {
        return None;
    }
    // Edge functions are in steps of 2^-62, of which those of 2^-31 are enough: d.(p x q) has a factor 2^31, as the start's part of it is a product of d, one fraction, and a whole edge.
    let exact = |e: &BigInt| (e.magnitude() & BigUint::from((1u32 << 31) - 1)) == BigUint::ZERO;
    debug_assert!([&u, &v, &w, &det].into_iter().all(exact));
    let size = |e: &BigInt| i128::try_from(e.magnitude() >> 31u32).unwrap_or(i128::MAX);
    // t's numerator is in steps of 2^-93: t 2^32 = 2 t_num / det.
    let t = held(BigInt::from((t_num.magnitude() << 1u32) / det.magnitude()));
    let front = det.sign() == Sign::Minus;
    Some(Meeting { u: size(&u), v: size(&v), w: size(&w), det: size(&det), t_num: 0, t: Some(t), front })
}

/// The triangle `corners` holds the point `start`, and does not lie in the plane of the triangle `own`, in which `start` lies.
pub(super) fn holds_another(start: Fine, own: [Vector; 3], corners: [Vector; 3]) -> bool {
    let n = predicates::cross(sub(own[1], own[0]), sub(own[2], own[0]));
    if corners.iter().all(|&p| predicates::dot(sub(p, own[0]), n) == 0) {
        return false;
    }
    let [a, b, c] = relative(corners, start);
    let sides = [cross(&b, &c), cross(&c, &a), cross(&a, &b)];
    // In its plane, and the three areas around the point are turned alike; flat triangles hold what they may.
    dot(&a, &sides[0]).sign() == Sign::NoSign && (0..3).all(|i| dot(&sides[i], &sides[(i + 1) % 3]).sign() != Sign::Minus)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: [Vector; 3] = [[0, 0, 0], [64, 0, 0], [0, 64, 1]];

    #[test]
    fn a_start_by_hand() {
        assert_eq!(inside(OWN, [1 << 30, 1 << 29, 1 << 29]), [16 << 31, 16 << 31, 1 << 29]);
        // Weights of 0 are taken from the largest: at a corner, and on an edge.
        assert_eq!(inside(OWN, [0, 1 << 31, 0]), [64 * ((1 << 31) - 2), 64, 1]);
        assert_eq!(inside(OWN, [1 << 30, 0, 1 << 30]), [64, 64 << 30, 1 << 30]);
    }

    #[test]
    fn its_own_triangle_is_not_met_and_one_a_unit_away_is() {
        let start = inside(OWN, [1 << 30, 1 << 29, 1 << 29]);
        let above = |by: i64| OWN.map(|[x, y, z]| [x, y, z + by]);
        let t = |d, corners| meet(start, d, corners).map(|met| (met.t(), met.bary(), met.front));
        assert!(t([0, 0, 8], OWN).is_none() && t([0, 0, -8], OWN).is_none());
        let weights = [1 << 30, 1 << 29, 1 << 29];
        assert_eq!(t([0, 0, 8], above(1)), Some((1 << 29, weights, false)));
        assert_eq!((t([0, 0, -8], above(1)), t([0, 0, -8], above(-2))), (None, Some((1 << 30, weights, true))));
        // As it says of whole points what the plain predicate says.
        for d in [[0, 0, 8], [3, 1, 9], [1, 2, -7]] {
            let x = [9, 7, 3];
            let whole = predicates::meet(d, sub(OWN[0], x), sub(OWN[1], x), sub(OWN[2], x)).map(|met| (met.t(), met.bary(), met.front));
            assert_eq!(meet(x.map(|c| c << 31), d, OWN).map(|met| (met.t(), met.bary(), met.front)), whole);
        }
    }

    #[test]
    fn another_triangle_through_the_start_is_told() {
        let start = inside(OWN, [1 << 30, 1 << 29, 1 << 29]);
        let upright = [[16, 0, -8], [16, 64, -8], [16, 16, 64]];
        assert!(holds_another(start, OWN, upright) && !holds_another(start, OWN, OWN));
        // One corner in the plane of its own does not make it lie there.
        assert!(holds_another(start, OWN, [[16, 0, 0], upright[1], upright[2]]));
        assert!(!holds_another(start, OWN, upright.map(|[x, y, z]| [x + 1, y, z])));
        assert!(!holds_another(start, OWN, upright.map(|[x, y, z]| [x, y + 32, z])));
    }
}
