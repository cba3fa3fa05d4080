//! The four children in a memory line (`rtl/child_records.sv`): the line as operands of [`child_test`], and one of them as a stack entry.

use super::context::Context;
use crate::block::child_test;
use crate::format::{BvhNode, ChildRef, SplitRecord};
use crate::hardware::Fetch;
use crate::method::Entry;
use crate::num::{TNear, U, Wire};

impl Context {
    /// Line buffer 0 holds a split, not a node of the quad-BVH.
    fn is_split(&self) -> bool {
        self.fetch.get() == Fetch::Split
    }

    /// Operands of the test of a node's children.
    pub fn children_in(&self) -> child_test::In {
        let ([f0, f1, f2], [g0, g1, g2]) = (self.f.get(), self.g.get());
        let ([p0, p1, p2], [q0, q1, q2]) = (self.p.get(), self.q.get());
        let tree = self.is_split();
        let (ray, t_max) = (self.setup, self.closest.t_max.get());
        let input = child_test::In { ray, t_max, tree, f0, f1, f2, g0, g1, g2, p0, p1, p2, q0, q1, q2, ..Default::default() };
        if tree {
            let SplitRecord { halves, exponents, planes, .. } = SplitRecord::from_words(&self.lines[0]);
            child_test::In { present: [true; 4], halves, exponents, planes: planes.map(|plane| U::new(plane.get())), ..input }
        } else {
            let BvhNode { kinds, origin, halves, exponents, planes, .. } = BvhNode::from_words(&self.lines[0]);
            let present = kinds.map(|kind| kind.get() != ChildRef::EMPTY);
            child_test::In { present, origin, halves, exponents, planes, ..input }
        }
    }

    /// The child at `place` of the order as a stack entry.
    pub fn child_entry(&self, place: usize) -> Entry {
        let sorted = self.sorted.get();
        let k = sorted.order[place].get();
        let child = k as usize; // two bits
        let t_near: TNear = sorted.t_near[child];
        if self.is_split() {
            let [e0, e1, e2] = SplitRecord::line_codes(&self.lines[0], child);
            let level = U::new(self.level.get().get() + 1);
            Entry { t_near, kind: U::new(Entry::TREE_NODE), level, index: U::new(self.node.get().get() << 2 | k), e0, e1, e2 }
        } else {
            let child = BvhNode::line_child(&self.lines[0], child);
            // Inner nodes and leaves have the kinds of their entries one lower.
            Entry { t_near, kind: U::new(child.kind.get() - 1), index: child.index, ..Entry::default() }
        }
    }
}
