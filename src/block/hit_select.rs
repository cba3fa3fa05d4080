//! Is a new hit closer than the closest so far?
//!
//! Smaller t first; at equal t a front face before a back face; then smaller id: the first full-resolution triangle below, tree 4^N + node 4^(N - level).
//! So the result does not depend on the order of visit, and a ray from outside a body enters it (docs/exactness.md, L13b). Two hits of equal t and id are the
//! same triangle: not closer.
//! Legal: level <= levels <= 10, node below 4^level.

use super::bary_map::NodeIndex;
use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{RayT, U, Wire, wire_struct};

/// Number of a full-resolution triangle: 28 bits of tree, 2 of each of ten levels.
pub type FullId = U<48>;

wire_struct! {
    /// Input of [`HitSelect`].
    pub struct In {
        /// Number of splits N.
        levels: U<4>,
        /// There is a closest hit so far.
        known: bool,
        /// Its t.
        best_t: RayT,
        /// It is on a front face.
        best_front: bool,
        /// Its id.
        best_id: FullId,
        /// t of the new hit.
        t: RayT,
        /// It is on a front face.
        front: bool,
        /// Its base triangle.
        tree: U<28>,
        /// Its level.
        level: U<4>,
        /// Its node on that level.
        node: NodeIndex,
    }
}

wire_struct! {
    /// Output of [`HitSelect`].
    pub struct Out {
        /// The new hit is the closest now.
        closer: bool,
        /// Its id.
        id: FullId,
    }
}

/// The block.
pub struct HitSelect;

impl Block for HitSelect {
    const NAME: &'static str = "hit_select";
    const TIMING: Timing = Timing::pipelined(3);
    type In = In;
    type Out = Out;
    fn parts(form: &Form) -> Parts {
        let node = 2 * form.levels;
        let (id, level) = (28 + node, 4);
        let tree = Registers::stage(2 + 2 * id + level + node + TAG);
        let registers = tree + Registers::stage(2 + 2 * id + TAG) + Registers::stage(1 + id + TAG);
        // t twice, levels, ids; tree and node at their places. The sides take a few gates, as `known` does.
        Parts { products: vec![], add_bits: 2 * RayT::WIDTH + level + id, select_bits: level * (id + node), registers }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let levels = i.levels.get();
        // A node of level n below 4^n shifted by 2 (N - n): below 4^N, so the fields do not overlap.
        let id = FullId::new(i.tree.get() << (2 * levels) | i.node.get() << (2 * (levels - i.level.get())));
        let order = |t: RayT, front: bool, id: FullId| (t, !front, id);
        let closer = !i.known || order(i.t, i.front, id) < order(i.best_t, i.best_front, i.best_id);
        Out { closer, id }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearer_wins_then_the_front_then_the_first_triangle() {
        let of_sides = |[best_front, front]: [bool; 2], best_t, best_id, t, node| {
            let input = In {
                levels: U::new(3),
                known: true,
                best_t: U::new(best_t),
                best_front,
                best_id: U::new(best_id),
                t: U::new(t),
                front,
                tree: U::new(1),
                level: U::new(2),
                node: U::new(node),
            };
            HitSelect::eval(&input).closer
        };
        // Node 5 of level 2 of tree 1 of 4^3 triangles a tree: 64 + 20.
        for side in [true, false] {
            let closer = |best_t, best_id, t, node| of_sides([side; 2], best_t, best_id, t, node);
            assert!(closer(10, 0, 9, 5) && !closer(10, 100, 11, 5));
            assert!(closer(10, 85, 10, 5) && !closer(10, 84, 10, 5) && !closer(10, 83, 10, 5));
            // Nearer wins whatever the sides.
            assert!(of_sides([!side, side], 10, 0, 9, 5) && !of_sides([!side, side], 10, 100, 11, 5));
        }
        for best_id in [0, 84, 100] {
            assert!(of_sides([false, true], 10, best_id, 10, 5), "front before back, whatever the id");
            assert!(!of_sides([true, false], 10, best_id, 10, 5), "back behind front");
        }
        let first = HitSelect::eval(&In { tree: U::new(7), t: RayT::MAX, ..In::default() });
        assert!(first.closer && first.id.get() == 7);
    }
}
