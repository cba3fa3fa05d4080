//! Which ray decides in a base triangle: the ray itself, or one of the two that a secondary ray has from the rays before it (paper section 3.8).
//!
//! 0 is the ray itself, 1 and 2 its first and second viewer. In the base triangle of the last hit the first one decides inside, and about each base edge the one that `second` tells. Of another
//! triangle, a base edge is decided as that of the last hit's with the same two ends, in either order, and everything else by the ray itself. Two edges are the same if their ends are the same points.
//! Legal: any.

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{Point, U, Wire, wire_struct};

wire_struct! {
    /// Input of [`TreeDeciders`].
    pub struct In {
        /// Base triangle of the last hit.
        last: U<28>,
        /// Its corner p0.
        a0: Point,
        /// Its corner p1.
        a1: Point,
        /// Its corner p2.
        a2: Point,
        /// Of its edges (p1, p2), (p2, p0), (p0, p1): the second viewer decides, not the first.
        second: [bool; 3],
        /// The base triangle entered.
        tree: U<28>,
        /// Its corner p0.
        p0: Point,
        /// Its corner p1.
        p1: Point,
        /// Its corner p2.
        p2: Point,
    }
}

wire_struct! {
    /// Output of [`TreeDeciders`].
    pub struct Out {
        /// Who decides about inner edges.
        inner: Decider,
        /// About base edge (p1, p2), (p2, p0), (p0, p1), and parts of it.
        edges: [Decider; 3],
    }
}

/// Who decides: 0 the ray itself, 1 and 2 its viewers.
pub type Decider = U<2>;

/// The block.
pub struct TreeDeciders;

/// Bits of the number of a base triangle.
const TREE: u32 = 28;

impl Out {
    /// Whether anyone but the ray itself decides.
    #[inline]
    pub fn is_any(&self) -> bool {
        *self != Self::default()
    }
}

/// Ends of edge `k` of a triangle, which is opposite corner `k`.
fn ends(corners: &[Point; 3], k: usize) -> [Point; 2] {
    [corners[(k + 1) % 3], corners[(k + 2) % 3]]
}

impl Block for TreeDeciders {
    const NAME: &'static str = "tree_deciders";
    const TIMING: Timing = Timing::pipelined(2);
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        // Which corners are the same points, whether the triangles are, and `second`; then the deciders.
        // Inside of a triangle the second viewer never decides.
        let registers = Registers::stage(9 + 1 + 3 + TAG) + Registers::stage(Out::WIDTH + TAG).without(1);
        Parts { products: vec![], add_bits: 9 * Point::WIDTH + TREE, select_bits: 3 * 3 * 2 + Out::WIDTH, registers }
    }
    #[inline]
    fn eval(input: &In) -> Out {
        let &In { last, a0, a1, a2, second, tree, p0, p1, p2 } = input;
        let of = |second: bool| Decider::new(if second { 2 } else { 1 });
        if tree == last {
            return Out { inner: of(false), edges: second.map(of) };
        }
        let (of_last, of_tree) = ([a0, a1, a2], [p0, p1, p2]);
        let edges = std::array::from_fn(|k| {
            let [a, b] = ends(&of_tree, k);
            let shared = (0..3).find(|&i| {
                let [p, q] = ends(&of_last, i);
                p == a && q == b || p == b && q == a
            });
            shared.map_or(Decider::ZERO, |i| of(second[i]))
        });
        Out { inner: Decider::ZERO, edges }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(v: i64) -> Point {
        Point::new(v, v * v, -v)
    }

    fn deciders(second: [bool; 3], a: [i64; 3], tree: u64, p: [i64; 3]) -> [u64; 4] {
        let ([a0, a1, a2], [p0, p1, p2]) = (a.map(point), p.map(point));
        let Out { inner, edges } = TreeDeciders::eval(&In { last: U::new(5), a0, a1, a2, second, tree: U::new(tree), p0, p1, p2 });
        [inner, edges[0], edges[1], edges[2]].map(Decider::get)
    }

    #[test]
    fn edges_are_the_same_by_their_ends_in_either_order() {
        let (second, a) = ([false, true, false], [10, 11, 12]);
        assert_eq!(deciders(second, a, 5, a), [1, 1, 2, 1]);
        // Edge 1 of the last is (12, 10).
        assert_eq!(deciders(second, a, 6, [10, 12, 13]), [0, 0, 0, 2]);
        assert_eq!(deciders(second, a, 6, [13, 12, 10]), [0, 2, 0, 0]);
        assert_eq!(deciders(second, a, 6, [12, 13, 10]), [0, 0, 2, 0]);
        assert_eq!(deciders(second, a, 6, [12, 11, 10]), [0, 1, 2, 1]);
        assert_eq!(deciders(second, a, 6, [10, 13, 14]), [0; 4], "a vertex is not enough");
    }
}
