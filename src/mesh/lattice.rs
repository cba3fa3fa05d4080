//! Index arithmetic of a tessellation tree's vertex lattice (`docs/numbers.md`: "Triangles, edges, children").
//!
//! A tree with `levels` splits has M = 2^levels steps per side; point (i, j) with i, j >= 0 and i + j <= M has barycentrics
//! ((M-i-j)/M, i/M, j/M). Points are stored row by row (j), each row by i.

/// A lattice point (i, j).
pub type LatticePoint = (u32, u32);

/// Number of lattice points of a tree with `levels` splits.
#[inline]
pub const fn len(levels: u32) -> usize {
    let m = 1usize << levels;
    (m + 1) * (m + 2) / 2
}

/// Storage index of point (i, j) in a lattice of `levels` splits.
#[inline]
pub const fn index(levels: u32, (i, j): LatticePoint) -> usize {
    let (m, i, j) = (1usize << levels, i as usize, j as usize);
    // Rows 0..j hold (m+1) + m + ... : j (m+1) - j (j-1) / 2.
    j * (m + 1) + i - (j * j.wrapping_sub(1)) / 2 * (j > 0) as usize
}

/// Level at which point (i, j) enters: 0 for the corners, n for a point inserted by split n.
#[inline]
pub const fn level_of(levels: u32, (i, j): LatticePoint) -> u32 {
    let bits = (i | j | (1 << levels)).trailing_zeros();
    levels - bits
}

/// Corners (p0, p1, p2) of the tree's own triangle (node (0, 0)).
#[inline]
pub const fn root(levels: u32) -> [LatticePoint; 3] {
    let m = 1 << levels;
    [(0, 0), (m, 0), (0, m)]
}

/// The inserted vertices (q0, q1, q2) of a triangle with these corners; the triangle must not be of the finest level.
#[inline]
pub const fn midpoints([p0, p1, p2]: [LatticePoint; 3]) -> [LatticePoint; 3] {
    [mid(p1, p2), mid(p2, p0), mid(p0, p1)]
}

/// The corners of child `k` (0 to 3) of a triangle with corners `p`.
#[inline]
pub const fn child(p: [LatticePoint; 3], k: u32) -> [LatticePoint; 3] {
    let q = midpoints(p);
    match k {
        0 => [p[0], q[2], q[1]],
        1 => [q[2], p[1], q[0]],
        2 => [q[1], q[0], p[2]],
        _ => q,
    }
}

/// The corners of node (`level`, `node`) of a lattice with `levels` splits.
#[inline]
pub fn node(levels: u32, level: u32, node: u32) -> [LatticePoint; 3] {
    (0..level).rev().fold(root(levels), |p, step| child(p, (node >> (2 * step)) & 3))
}

/// What the split of `level` inserts in a tree of `levels` splits, 0 to `levels` - 1: each vertex with the two ends of its edge.
pub fn inserted(levels: u32, level: u32) -> impl Iterator<Item = [LatticePoint; 3]> {
    let (k, half) = (1u32 << level, 1u32 << (levels - level - 1));
    // The edges of upward triangles are all edges.
    (0..k).flat_map(move |j| (0..k - j).map(move |i| (i, j))).flat_map(move |(i, j)| {
        let at = |x: u32, y: u32| ((2 * i + x) * half, (2 * j + y) * half);
        let p = [at(0, 0), at(2, 0), at(0, 2)];
        let q = midpoints(p);
        [[q[0], p[1], p[2]], [q[1], p[2], p[0]], [q[2], p[0], p[1]]]
    })
}

/// An inserted vertex and the ends of its edge as storage indices, and on which side of the tree it lies.
#[derive(Clone, Copy, Debug)]
pub struct Insertion {
    /// The vertex.
    pub own: u32,
    /// The ends of its edge.
    pub ends: [u32; 2],
    /// The tree's side s, between corners s+1 and s+2 (modulo 3); 3 inside.
    pub side: u8,
}

/// What the splits of a tree insert, level by level in the order of [`inserted`], which is that of the codes of their edges.
pub fn insertions(levels: u32) -> Vec<Vec<Insertion>> {
    let side = |(i, j): LatticePoint| match (i, j) {
        (i, j) if i + j == 1 << levels => 0,
        (0, _) => 1,
        (_, 0) => 2,
        _ => 3,
    };
    let one = |places: [LatticePoint; 3]| {
        let [own, a, b] = places.map(|place| index(levels, place) as u32); // half a million points at most
        Insertion { own, ends: [a, b], side: side(places[0]) }
    };
    (0..levels).map(|level| inserted(levels, level).map(one).collect()).collect()
}

const fn mid(a: LatticePoint, b: LatticePoint) -> LatticePoint {
    (a.0.midpoint(b.0), a.1.midpoint(b.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_up_without_gaps() {
        for levels in 0..=5 {
            let m = 1 << levels;
            let mut next = 0;
            for j in 0..=m {
                for i in 0..=m - j {
                    assert_eq!(index(levels, (i, j)), next);
                    next += 1;
                }
            }
            assert_eq!(next, len(levels));
        }
    }

    #[test]
    fn levels_of_points_match_the_split_that_inserts_them() {
        let levels = 4;
        for level in 0..levels {
            for n in 0..1u32 << (2 * level) {
                let p = node(levels, level, n);
                assert!(p.iter().all(|&c| level_of(levels, c) <= level));
                assert!(midpoints(p).iter().all(|&q| level_of(levels, q) == level + 1));
            }
        }
    }

    #[test]
    fn finest_triangles_are_distinct_and_keep_the_winding() {
        let levels = 3;
        let mut seen = std::collections::HashSet::new();
        for n in 0..64 {
            let [a, b, c] = node(levels, levels, n).map(|(i, j)| (i as i32, j as i32));
            assert_eq!((b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0), 1);
            assert!(seen.insert([a, b, c]));
        }
    }
}
