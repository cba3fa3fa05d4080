//! Ray against triangle, exactly: 3x3 determinants and a direction that is perturbed by a polynomial.
//!
//! The ray direction is taken as d + (e, e^2, e^3) for an e > 0 smaller than any that matters. The edge function det[d; p; q] is
//! then the polynomial E + e n_x + e^2 n_y + e^3 n_z with n = p x q, and its sign that of its first non-zero coefficient. If all
//! vanish, the origin lies on the edge's line, so in the triangle's plane, and whatever they count as it is met nowhere ahead of the origin.

use num_bigint::BigInt;

/// An exact integer vector: at most 33 bits a component, 34 for differences.
pub(super) type Vector = [i64; 3];

/// A triangle that the ray meets: barycentrics and distance as fractions with the common, positive denominator `det`; 2^31 times all of them for a ray from a [`Fine`](super::fine::Fine) point.
pub(super) struct Meeting {
    pub u: i128,
    pub v: i128,
    pub w: i128,
    pub det: i128,
    pub t_num: i128,
    /// floor(t 2^32) where t's numerator is too long.
    pub t: Option<u64>,
    /// The determinant was negative before it was made positive.
    pub front: bool,
}

/// Distance and barycentrics of a hit as they are before any rounding: fractions over one denominator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fractions {
    /// t times `det`, t in lengths of the direction; positive, below 2^99.
    pub t_num: i128,
    /// Weights of p0, p1, p2 times `det`; none negative, their sum is `det`.
    pub weights: [i128; 3],
    /// The denominator, positive, below 2^96.
    pub det: i128,
}

pub(super) fn sub(p: Vector, q: Vector) -> Vector {
    std::array::from_fn(|k| p[k] - q[k])
}

pub(super) fn cross(p: Vector, q: Vector) -> [i128; 3] {
    // Components below 2^32 in magnitude: the difference of two products stays below 2^66.
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        i128::from(p[i]) * i128::from(q[j]) - i128::from(p[j]) * i128::from(q[i])
    })
}

pub(super) fn dot(p: Vector, q: [i128; 3]) -> i128 {
    // Below 3 * 2^32 * 2^66 < 2^100.
    (0..3).map(|k| i128::from(p[k]) * q[k]).sum()
}

/// The edge function det[d; p; q] and the sign, +1 or -1, of its perturbed value.
fn edge_function(d: Vector, p: Vector, q: Vector) -> (i128, i32) {
    let n = cross(p, q);
    let value = dot(d, n);
    let polynomial = [value, n[0], n[1], n[2]];
    let leading = polynomial.into_iter().find(|&c| c != 0).unwrap_or(1);
    (value, if leading > 0 { 1 } else { -1 })
}

/// The meeting of the ray from the coordinates' origin along `d` with the triangle (a, b, c), if there is one.
pub(super) fn meet(d: Vector, a: Vector, b: Vector, c: Vector) -> Option<Meeting> {
    let (u, sign) = edge_function(d, b, c);
    let (v, sign_v) = edge_function(d, c, a);
    if sign_v != sign {
        return None;
    }
    let (w, sign_w) = edge_function(d, a, b);
    let det = u + v + w;
    if sign_w != sign || det == 0 {
        return None;
    }
    let t_num = dot(a, cross(b, c));
    let s = det.signum();
    let met = Meeting { u: u * s, v: v * s, w: w * s, det: det * s, t_num: t_num * s, t: None, front: det < 0 };
    (met.t_num > 0).then_some(met)
}

/// At most 2^35 - 1.
pub(super) fn held(t: BigInt) -> u64 {
    u64::try_from(t).unwrap_or(u64::MAX).min((1 << 35) - 1)
}

/// The coordinates' origin lies in the closed triangle (a, b, c), which may be degenerate.
pub(super) fn holds_origin(a: Vector, b: Vector, c: Vector) -> bool {
    let edges = [(a, b), (b, c), (c, a)];
    let on_edge =
        |&(p, q): &(Vector, Vector)| cross(p, q) == [0; 3] && (0..3).map(|k| i128::from(p[k]) * i128::from(q[k])).sum::<i128>() <= 0;
    if edges.iter().any(on_edge) {
        return true;
    }
    // In its plane, and strictly on the same side of the three edges seen along the axis that its normal is nearest to.
    let n = cross(sub(b, a), sub(c, a));
    let k = (0..3).max_by_key(|&k| n[k].unsigned_abs()).unwrap_or(0);
    let sides = edges.map(|(p, q)| cross(p, q)[k].signum());
    n[k] != 0 && dot(a, n) == 0 && sides[0] != 0 && sides == [sides[0]; 3]
}

/// The least |edge function| that decides: of those whose two companions have one sign. `None` if there is none.
pub(super) fn closest_edge(d: Vector, a: Vector, b: Vector, c: Vector) -> Option<u128> {
    let edges = [edge_function(d, b, c), edge_function(d, c, a), edge_function(d, a, b)];
    let decides = |&k: &usize| edges[(k + 1) % 3].1 == edges[(k + 2) % 3].1;
    (0..3).filter(decides).map(|k| edges[k].0.unsigned_abs()).min()
}

impl Meeting {
    /// The quotients before they are rounded, of a ray from a whole point.
    pub fn fractions(&self) -> Fractions {
        Fractions { t_num: self.t_num, weights: [self.u, self.v, self.w], det: self.det }
    }

    /// floor(t_num 2^32 / det), saturated at 35 bits.
    pub fn t(&self) -> u64 {
        // The product has up to 132 bits: a big integer, since both are positive and its division truncates.
        self.t.unwrap_or_else(|| held((BigInt::from(self.t_num) << 32) / self.det))
    }

    /// Barycentrics of sum 2^31: two rounded down, the first what is left.
    pub fn bary(&self) -> [u32; 3] {
        // 0 <= v, w <= det, so each quotient is at most 2^31 and their sum too.
        debug_assert!(self.u >= 0 && self.v >= 0 && self.w >= 0 && self.u + self.v + self.w == self.det);
        let part = |e: i128| u32::try_from((BigInt::from(e) << 31) / self.det).unwrap_or(1 << 31);
        let (b1, b2) = (part(self.v), part(self.w));
        [(1 << 31) - b1 - b2, b1, b2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: Vector = [0, 0, 64];
    const B: Vector = [64, 0, 64];
    const C: Vector = [0, 64, 64];

    fn shoot(from: Vector, d: Vector) -> Option<Meeting> {
        meet(d, sub(A, from), sub(B, from), sub(C, from))
    }

    #[test]
    fn distance_and_barycentrics_by_hand() {
        // det = 64^2 * 32, normal +z along the ray; the hit is at (16, 8, 64): 2 directions away.
        let m = shoot([16, 8, 0], [0, 0, 32]).unwrap();
        assert_eq!(m.t(), 2 << 32);
        assert_eq!(m.bary(), [(1 << 31) / 8 * 5, 1 << 29, 1 << 28]);
        assert!(!m.front);
        let back = shoot([16, 8, 128], [0, 0, -48]).unwrap();
        assert_eq!(back.t(), (4u64 << 32) / 3);
        assert!(back.front);
        assert!(shoot([16, 8, 65], [0, 0, 32]).is_none());
        assert!(shoot([16, 8, 64], [0, 0, 32]).is_none(), "where it starts");
    }

    #[test]
    fn distance_saturates_at_35_bits() {
        assert_eq!(shoot([16, 8, 0], [0, 0, 8]).unwrap().t(), (1 << 35) - 1);
        assert_eq!(shoot([16, 8, 1], [0, 0, 8]).unwrap().t(), 63 << 29);
    }

    #[test]
    fn ties_at_each_edge_by_hand() {
        // Perturbed by +x first: the edge x = 0 (C, A) is in, the slanted edge out; on y = 0 the x part of n vanishes and +y decides: in.
        let d = [0, 0, 32];
        assert!(shoot([0, 8, 0], d).is_some());
        assert!(shoot([8, 0, 0], d).is_some());
        assert!(shoot([32, 32, 0], d).is_none());
        // The same at the corners: only A sees the perturbed ray inside.
        assert!(shoot([0, 0, 0], d).is_some());
        assert!(shoot([64, 0, 0], d).is_none());
        assert!(shoot([0, 64, 0], d).is_none());
    }

    #[test]
    fn the_neighbour_across_an_edge_takes_the_tie_the_other_way() {
        let d = [3, -5, 32];
        for (p, q) in [(A, B), (B, C), ([5, 5, 4], [-5, -5, -5]), ([3, 3, 3], [9, 9, 8]), ([0, 1, 7], [0, 0, 9])] {
            let ((e, s), (f, r)) = (edge_function(d, p, q), edge_function(d, q, p));
            assert_eq!((e, s), (-f, -r));
        }
        // From a point of its line, or to itself, an edge has no side.
        assert_eq!([(A, A), ([3, 3, 3], [9, 9, 9])].map(|(p, q)| edge_function(d, p, q)), [(0, 1); 2]);
    }

    #[test]
    fn each_coefficient_decides_when_those_before_it_vanish() {
        // In each row the coefficient after the deciding one, if there is one that is not 0, says the opposite.
        for (d, p, q, sign) in [
            ([0, 1, 0], [0, 8, 0], [0, 0, 8], 1),    // n = (64, 0, 0)
            ([1, 0, 0], [0, 0, 8], [8, 0, -8], 1),   // n = (0, 64, 0)
            ([1, 0, 0], [-8, 0, 0], [0, 0, -8], -1), // n = (0, -64, 0)
            ([1, 0, 0], [8, 0, 0], [0, 8, 0], 1),    // n = (0, 0, 64)
            ([0, 0, -1], [0, 8, 0], [-8, 0, 0], -1), // E = -64, n = (0, 0, 64)
            ([5, 6, 7], [2, 0, 0], [-3, 0, 0], 1),   // origin on the edge
            ([5, 6, 7], [0, 3, -9], [0, 1, -3], 1),  // origin on its line
            ([5, 6, 7], [0, 0, -9], [0, 0, 4], 1),
        ] {
            assert_eq!(edge_function(d, p, q).1, sign, "{d:?} {p:?} {q:?}");
        }
    }

    #[test]
    fn halves_of_an_edge_keep_its_sign() {
        // Through the origin's line, the plane of the ray, and at large: splitting at the midpoint halves every coefficient.
        for (p, q) in
            [([4, 8, 12], [8, 16, 24]), ([3 << 20, -(5 << 20), 0], [0, 0, 32 << 20]), ([1 << 32, -(1 << 32), 6], [-(1 << 32), 8, 2])]
        {
            let m: Vector = std::array::from_fn(|k| (p[k] + q[k]) / 2);
            let sign = |p, q| edge_function([3, -5, 32], p, q).1;
            assert!(sign(p, q) == sign(p, m) && sign(p, q) == sign(m, q));
        }
    }

    #[test]
    fn a_ray_in_the_plane_and_flat_triangles_miss() {
        assert!(shoot([-8, 8, 64], [32, 0, 0]).is_none());
        assert!(meet([0, 0, 32], A, A, C).is_none());
        assert!(meet([0, 0, 32], A, A, A).is_none());
    }

    #[test]
    fn the_closest_edge_by_hand() {
        let at = |x: i64, y: i64| {
            let [a, b, c] = [A, B, C].map(|p| sub(p, [x, y, 0]));
            closest_edge([0, 0, 32], a, b, c)
        };
        // det = 2^17; weights 5/8, 1/4, 1/8: all may decide. Outside only that whose companions agree: -1/4, 3/4, 1/2; 3/2, -1/4, -1/4; 1/2, 3/4, -1/4.
        assert_eq!([at(16, 8), at(48, 32), at(-16, -16), at(48, -16)], [Some(1 << 14), Some(1 << 15), Some(3 << 16), Some(1 << 15)]);
    }

    #[test]
    fn the_origin_in_a_triangle() {
        let at = |x: i64, y: i64, z: i64| [A, B, C].map(|p| sub(p, [x, y, z]));
        let holds = |[a, b, c]: [Vector; 3]| holds_origin(a, b, c);
        assert!([(16, 8), (0, 0), (64, 0), (32, 32), (0, 9)].iter().all(|&(x, y)| holds(at(x, y, 64))));
        assert!(![(33, 32, 64), (-1, 0, 64), (16, 8, 63), (65, 0, 64)].iter().any(|&(x, y, z)| holds(at(x, y, z))));
        assert!(holds_origin([-4, 2, 0], [4, -2, 0], [8, -4, 0]) && !holds_origin([4, -2, 0], [6, -3, 0], [8, -4, 0]));
        assert!(holds_origin([0; 3], [0; 3], [0; 3]) && !holds_origin([1; 3], [1; 3], [1; 3]));
    }

    #[test]
    fn the_largest_coordinates_do_not_overflow() {
        let m = 1 << 32;
        let hit = meet([619_925_131, 619_925_131, 619_925_131], [m, 0, 0], [0, m, 0], [0, 0, m]).unwrap();
        assert_eq!(hit.t(), u64::try_from((1u128 << 64) / (3 * 619_925_131)).unwrap());
        assert!(meet([-1 << 30, 0, 0], [-m, -m, m], [-m, m, m], [-m, m, -m]).is_some());
    }
}
