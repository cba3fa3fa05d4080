//! The closest hit of one ray so far, and its way to the hit record (`rtl/closest_hit.sv`).

use super::register::Register;
use crate::block::bary_map::{self, NodeIndex};
use crate::block::hit_divide;
use crate::block::hit_select::{self, FullId};
use crate::block::start_divide;
use crate::block::start_test::{self, Below};
use crate::block::tri_test::{EdgeFunction, TNumerator};
use crate::hardware::ports::Corners;
use crate::method::Hit;
use crate::num::{BARY_ONE, Bary, Point, RayT, U};

/// A triangle that was met.
#[derive(Clone, Copy, Debug, Default)]
pub struct Met {
    /// Context of the ray.
    pub owner: usize,
    /// Which of the context's triangles.
    pub number: u16,
    /// Its numerators.
    pub test: start_test::Out,
}

/// Registers of the closest hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Closest {
    pub known: Register<bool>,
    pub t_max: Register<RayT>,
    pub id: Register<FullId>,
    tree: U<28>,
    level: U<4>,
    node: NodeIndex,
    pub front: Register<bool>,
    v: EdgeFunction,
    w: EdgeFunction,
    det: EdgeFunction,
    /// What v and w have below whole numbers.
    below: Below,
    pub corners: Corners,
    b0: Bary,
    b1: Bary,
    b2: Bary,
    full: bary_map::Out,
}

impl Closest {
    /// Nothing yet, and nothing beyond `t_max` counts.
    pub fn clear(&mut self, t_max: RayT) {
        self.known.set(false);
        self.t_max.set(t_max);
    }

    /// Takes a hit that was compared if it is closer, and not before `t_min` or beyond the largest t.
    pub fn select(
        &mut self,
        select: &hit_select::Out,
        [t_min, t]: [RayT; 2],
        [tree, level, node]: [u64; 3],
        test: &start_test::Out,
        corners: [Point; 3],
    ) {
        if select.closer && t >= t_min && t <= self.t_max.get() {
            self.known.set(true);
            self.t_max.set(t);
            self.id.set(select.id);
            (self.tree, self.level, self.node) = (U::new(tree), U::new(level), U::new(node));
            let &start_test::Out { test, below } = test;
            self.front.set(test.front);
            (self.v, self.w, self.det, self.below) = (test.v, test.w, test.det, below);
            let [p0, p1, p2] = corners;
            self.corners = Corners { p0, p1, p2 };
        }
    }

    /// Operands of the division of v, or of w.
    pub fn divide_in(&self, v: bool) -> start_divide::In {
        let (numerator, low) = if v { (self.v, self.below.v) } else { (self.w, self.below.w) };
        start_divide::In { numerator: TNumerator::new(numerator.get()), low, denominator: self.det }
    }

    /// The quotient of v, or of w.
    pub fn divided(&mut self, v: bool, out: &hit_divide::Out) {
        // An edge function is at most det: the quotient is at most 2^32 before its last bit is dropped.
        let weight = Bary::new(out.quotient.get() >> 1);
        *(if v { &mut self.b1 } else { &mut self.b2 }) = weight;
    }

    /// The third weight.
    pub fn sum(&mut self) {
        // Both were rounded down and v + w <= det.
        self.b0 = Bary::new(BARY_ONE - self.b1.get() - self.b2.get());
    }

    /// Operands of the map to full resolution in a hierarchy of `levels` splits.
    pub fn map_in(&self, levels: U<4>) -> bary_map::In {
        bary_map::In { levels: U::new(levels.get() - self.level.get()), node: self.node, b0: self.b0, b1: self.b1, b2: self.b2 }
    }

    /// The hit is on a full-resolution triangle.
    pub fn is_finest(&mut self) {
        self.full = bary_map::Out { node: self.node, b0: self.b0, b1: self.b1, b2: self.b2 };
    }

    /// The full-resolution triangle.
    pub fn mapped(&mut self, out: &bary_map::Out) {
        self.full = *out;
    }

    /// The hit record, if there is a hit.
    pub fn hit(&self) -> Option<Hit> {
        self.known.get().then(|| Hit {
            t: self.t_max.get(),
            front: self.front.get(),
            tree: self.tree,
            level: self.level,
            node: self.node,
            b0: self.b0,
            b1: self.b1,
            b2: self.b2,
            full_node: self.full.node,
            full_b0: self.full.b0,
            full_b1: self.full.b1,
            full_b2: self.full.b2,
        })
    }
}
