//! Prisms over the triangles of a node's children: what building and traversal derive from the same stored corners (docs/numbers.md, "Prisms").
//!
//! All of it lies in the node's local space: coordinates from its first full-resolution corner in steps of 2^shift units. A child's prism is that of its triangle with corners L_i,
//! rounded down to whole steps: all sum(beta_i L_i) + height `HEIGHT` N with sum(beta_i) = 1, beta_i >= -reach_i and -below <= height <= above, N being [`normal`].

/// Bits of a local coordinate, with its sign.
pub const LOCAL_BITS: u32 = 10;
/// Bits of a component of a normal, without its sign.
pub const NORMAL_BITS: u32 = 7;
/// A height of 1 is so many normals: a child's edges have about as many steps.
pub const HEIGHT: i32 = 4;
/// Largest code of a plane.
pub const MOST_PLANE: u32 = 7;
/// Reaches are multiples of 2^-(1 + exponent); with this exponent nothing bounds the children.
pub const OPEN: u32 = 7;
/// Largest exponent of heights, which are multiples of 2^-exponent.
pub const MOST_HEIGHT: u32 = 15;

/// Corners of a triangle.
pub type Corners = [[i32; 3]; 3];

/// Local coordinates of a node's full-resolution corners and inserted vertices, and their shift: the least with which they have [`LOCAL_BITS`].
#[inline(always)]
pub fn local_corners(points: &[[i32; 3]; 6]) -> ([[i32; 3]; 6], u32) {
    let from = points[0];
    let difference = |p: &[i32; 3], c: usize| i64::from(p[c]) - i64::from(from[c]);
    let mut bits = 0;
    for p in &points[1..] {
        for c in 0..3 {
            let d = difference(p, c);
            bits |= d ^ (d >> 63);
        }
    }
    let shift = (64 - bits.leading_zeros()).saturating_sub(LOCAL_BITS - 1);
    (points.map(|p| std::array::from_fn(|c| (difference(&p, c) >> shift) as i32)), shift) // 10 bits
}

/// Cross product of the edges (p0, p1) and (p0, p2) of a triangle with these local corners: below 2^21.
#[inline(always)]
pub fn area([a, b, c]: Corners) -> [i32; 3] {
    let [e, f] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]]
}

/// Direction of heights over a triangle with this [`area`]: its leading bits. Rounded towards zero, so that it mirrors with the triangle.
#[inline(always)]
pub fn normal(area: [i32; 3]) -> [i32; 3] {
    let bits = area.iter().fold(0, |bits, c| bits | c.unsigned_abs());
    let shift = (32 - bits.leading_zeros()).saturating_sub(NORMAL_BITS);
    area.map(|c| (c.unsigned_abs() >> shift).cast_signed() * c.signum())
}

/// Corners of child `k` of a node with these corners and inserted vertices.
#[inline(always)]
pub fn child<T: Copy>(of: &[T; 6], k: usize) -> [T; 3] {
    const PLACES: [[usize; 3]; 4] = [[0, 5, 4], [5, 1, 3], [4, 3, 2], [3, 4, 5]];
    PLACES[k].map(|at| of[at])
}

/// Bounds of the children of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Prisms {
    /// Codes of child k: reach beyond the edges (p1, p2), (p2, p0), (p0, p1), height below and above.
    pub planes: [[u8; 5]; 4],
    /// Exponent of reaches, up to [`OPEN`].
    pub reach: u8,
    /// Exponent of heights.
    pub height: u8,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::COORD_LIMIT;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn local_coordinates_have_their_bits_and_no_more_are_dropped_than_must_be(
            v in prop::collection::vec(prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT), 6), bits in 0u32..31
        ) {
            let points: [[i32; 3]; 6] = std::array::from_fn(|k| v[k].map(|c| c >> bits));
            let (local, shift) = local_corners(&points);
            let wide = |shift: u32| points.iter().flatten().zip(points[0].iter().cycle()).any(|(&p, &o)| {
                let step = (i64::from(p) - i64::from(o)) >> shift;
                !(-512..512).contains(&step)
            });
            prop_assert!(!wide(shift) && (shift == 0 || wide(shift - 1)) && shift <= 23);
            for (l, p) in local.iter().zip(&points) {
                for c in 0..3 {
                    let exact = i64::from(p[c]) - i64::from(points[0][c]);
                    let rest = exact - (i64::from(l[c]) << shift);
                    prop_assert!((0..1 << shift).contains(&rest));
                }
            }
        }

        #[test]
        fn normals_mirror_and_turn_with_their_triangles(v in prop::array::uniform3(prop::array::uniform3(-512i32..512)), mirror in prop::array::uniform3(any::<bool>()), turn in 0usize..3) {
            let n = normal(area(v));
            let map = |p: [i32; 3]| -> [i32; 3] { std::array::from_fn(|c| { let from = (c + turn) % 3; if mirror[from] { -p[from] } else { p[from] } }) };
            let sign = if mirror.iter().filter(|&&m| m).count() % 2 == 1 { -1 } else { 1 };
            prop_assert_eq!(normal(area(v.map(map))), map(n).map(|c| sign * c));
            prop_assert!(n.iter().all(|c| c.unsigned_abs() < 128));
            let of = area(v);
            // Never against the triangle's own side; nothing but a degenerate triangle has none.
            let along: i64 = (0..3).map(|c| i64::from(n[c]) * i64::from(of[c])).sum();
            prop_assert_eq!(along > 0, of != [0; 3]);
        }
    }
}
