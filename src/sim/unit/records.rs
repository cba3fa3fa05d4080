//! The four children in two memory lines (`rtl/child_records.sv`): boxes for [`child_test`], and one of them as a stack entry.

use super::context::Context;
use crate::block::child_test;
use crate::format::{BoundData, BvhChild, ChildRef};
use crate::hardware::Fetch;
use crate::method::{Entry, quarter};
use crate::num::{TNear, U};

impl Context {
    /// Operands of the test of a node's children.
    pub fn children_in(&self) -> child_test::In {
        let widen = self.fetch.get() == Fetch::Vertex;
        let [p0, p1, p2] = self.p.get();
        let [q0, q1, q2] = self.q.get();
        let mut input =
            child_test::In { ray: self.setup, t_max: self.closest.t_max.get(), widen, p0, p1, p2, q0, q1, q2, ..Default::default() };
        for k in 0..4 {
            let BvhChild { child, bounds } = quarter(&self.record, k);
            input.present[k] = widen || child.kind.get() != ChildRef::EMPTY;
            input.bounds[k] = bounds;
        }
        input
    }

    /// The child at `place` of the order as a stack entry.
    pub fn child_entry(&self, place: usize) -> Entry {
        let sorted = self.sorted.get();
        let k = sorted.order[place].get();
        let child = k as usize; // two bits
        let t_near: TNear = sorted.t_near[child];
        if self.fetch.get() == Fetch::Vertex {
            let BoundData { e0, e1, e2, .. } = quarter(&self.record, child);
            let level = U::new(self.level.get().get() + 1);
            Entry { t_near, kind: U::new(Entry::TREE_NODE), level, index: U::new(self.node.get().get() << 2 | k), e0, e1, e2 }
        } else {
            let BvhChild { child, .. } = quarter(&self.record, child);
            // Inner nodes and leaves have the kinds of their entries one lower.
            Entry { t_near, kind: U::new(child.kind.get() - 1), index: child.index, ..Entry::default() }
        }
    }
}
