//! Whose level of detail counts where: the rule that keeps secondary rays on the surface they start from (paper section 3.8).
//!
//! The base triangle that was hit last keeps the decisions that were in force when it was hit, its inner edges those of one ray, its three base edges those of one each. A base
//! triangle that shares a base edge with it takes that edge's. All else is the ray's own. So every base edge, and the inside of every base triangle, is decided by one
//! ray, whichever triangle asks: the surface is closed, and where the last hit lies it is the same bit for bit.
//!
//! Base edges are the same if their ends are the same points: no number is stored for them and none is fetched. (A base vertex is never morphed, so triangles that share
//! no more than a vertex meet there whatever they decide.)

use crate::block::Block;
use crate::block::tree_deciders::{self, Decider, TreeDeciders};
use crate::num::{Point, Ray, U};

/// Who decides in a base triangle: 0 the ray itself, 1 and 2 the viewers of its [`Prior`].
pub type Deciders = tree_deciders::Out;

/// What a ray needs of the rays before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Base triangle of the last hit.
    pub tree: u32,
    /// Its corners p0, p1, p2.
    pub corners: [Point; 3],
    /// The ray that decides inside it; and another one, for some of its edges.
    pub viewers: [Ray; 2],
    /// Base edges (p1, p2), (p2, p0), (p0, p1) that the second one decides.
    pub second: [bool; 3],
}

impl Prior {
    /// What a ray needs that starts at a hit of `ray` in the base triangle `tree` with these `corners`; `prior` is what `ray` needed. With it, whether three
    /// rays had decided there, and the third's edges count as `ray`'s now: on no surface whose edges have at most two triangles.
    pub fn after(ray: &Ray, prior: Option<&Self>, tree: u32, corners: [Point; 3]) -> (Self, bool) {
        let mut next = Self { tree, corners, viewers: [*ray; 2], second: [false; 3] };
        let Some(prior) = prior else { return (next, false) };
        if prior.tree == tree {
            return (*prior, false);
        }
        let Deciders { edges, .. } = prior.deciders(tree, &corners);
        let Some(second) = edges.into_iter().find(|&by| by > Decider::ZERO) else { return (next, false) };
        next.viewers[1] = *prior.viewer(second).unwrap_or(ray);
        next.second = edges.map(|by| by == second);
        (next, edges.iter().any(|&by| by > Decider::ZERO && by != second))
    }

    /// Who this is, of those that decide; none if it is the ray itself.
    pub fn viewer(&self, by: Decider) -> Option<&Ray> {
        match by.get() {
            0 => None,
            1 => Some(&self.viewers[0]),
            _ => Some(&self.viewers[1]),
        }
    }

    /// Who decides in base triangle `tree` with these corners.
    pub fn deciders(&self, tree: u32, corners: &[Point; 3]) -> Deciders {
        let ([a0, a1, a2], [p0, p1, p2]) = (self.corners, *corners);
        let [last, tree] = [self.tree, tree].map(|tree| U::new(u64::from(tree)));
        TreeDeciders::eval(&tree_deciders::In { last, a0, a1, a2, second: self.second, tree, p0, p1, p2 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{Cone, Vec3};

    fn ray(number: u64) -> Ray {
        Ray { cone: Cone { offset: U::new(number), ..Cone::default() }, origin: Point::new(0, 0, 0), direction: Vec3::new(0, 0, 1) }
    }

    /// Corners 0 to 9 stand for points of their own.
    fn corners(of: [i64; 3]) -> [Point; 3] {
        of.map(|v| Point::new(v, v * v, -v))
    }

    fn deciders(prior: &Prior, tree: u32, of: [i64; 3]) -> [u64; 4] {
        let Deciders { inner, edges } = prior.deciders(tree, &corners(of));
        [inner, edges[0], edges[1], edges[2]].map(|by| prior.viewer(by).map_or(0, |ray| ray.cone.offset.get()))
    }

    #[test]
    fn a_strip_of_triangles_keeps_its_edges() {
        let [a, b, c, far] = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [7, 8, 9]];
        // Ray 1 hits a; ray 2, from there, b; ray 3 c.
        let (of_a, _) = Prior::after(&ray(1), None, 0, corners(a));
        assert_eq!(deciders(&of_a, 0, a), [1; 4]);
        assert_eq!(deciders(&of_a, 1, b), [0, 0, 0, 1], "edge (2, 1) is the last of b and the first of a");
        assert_eq!((deciders(&of_a, 2, c), deciders(&of_a, 9, far)), ([0; 4], [0; 4]), "a vertex is not enough");
        let (of_b, crowded) = Prior::after(&ray(2), Some(&of_a), 1, corners(b));
        assert!(!crowded);
        assert_eq!(deciders(&of_b, 1, b), [2, 2, 2, 1]);
        assert_eq!(deciders(&of_b, 0, a), [0, 1, 0, 0], "back in a that edge is still ray 1's, the rest the ray's own");
        assert_eq!(deciders(&of_b, 2, c), [0, 0, 0, 2]);
        // Staying changes nothing; so ray 1 still decides at that edge after any number of hits.
        assert_eq!(Prior::after(&ray(3), Some(&of_b), 1, corners(b)), (of_b, false));
        let (of_c, _) = Prior::after(&ray(4), Some(&of_b), 2, corners(c));
        assert_eq!((deciders(&of_c, 2, c), deciders(&of_c, 0, a)), ([4, 4, 4, 2], [0; 4]));
        let (of_far, _) = Prior::after(&ray(5), Some(&of_c), 9, corners(far));
        assert_eq!(deciders(&of_far, 9, far), [5; 4]);
    }

    #[test]
    fn both_sides_of_a_triangle_share_all_edges_and_a_third_ray_is_told() {
        let [front, back, beside] = [[0, 1, 2], [0, 2, 1], [1, 0, 3]];
        let (of_front, _) = Prior::after(&ray(1), None, 0, corners(front));
        assert_eq!(deciders(&of_front, 1, back), [0, 1, 1, 1]);
        let (of_back, crowded) = Prior::after(&ray(2), Some(&of_front), 1, corners(back));
        assert!(!crowded && deciders(&of_back, 1, back) == [2, 1, 1, 1]);
        // A third triangle at one of these edges: who comes from it and goes on to the other side needs three rays.
        let (of_beside, _) = Prior::after(&ray(1), None, 5, corners(beside));
        let (of_front, crowded) = Prior::after(&ray(2), Some(&of_beside), 0, corners(front));
        assert!(!crowded && deciders(&of_front, 0, front) == [2, 2, 2, 1]);
        let (of_back, crowded) = Prior::after(&ray(3), Some(&of_front), 1, corners(back));
        assert!(crowded && deciders(&of_back, 1, back) == [3, 2, 3, 2], "{:?}", deciders(&of_back, 1, back));
    }
}
