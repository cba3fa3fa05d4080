//! What rays have the hardware blocks do, whatever it takes.

use crate::sim::energy::{Operation, Operations};
use crate::sim::stream::Step;

/// Operations of the blocks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    operations: Operations,
    /// A full-resolution BVH: its hits are on the mesh already.
    leaves: bool,
}

impl Work {
    /// The operations.
    pub fn operations(&self) -> &Operations {
        &self.operations
    }

    /// A ray begins.
    #[inline]
    pub fn ray(&mut self) {
        self.operations.add(Operation::RaySetup, 1);
    }

    /// A step of a ray.
    #[inline]
    pub fn step(&mut self, step: Step) {
        let mut add = |operation, count| self.operations.add(operation, count);
        if let Some((.., lines)) = step.lines() {
            add(Operation::NodeAddress, u64::from(lines));
        }
        match step {
            Step::Node { wide: false, .. } | Step::Bounds { .. } => add(Operation::ChildTest, 1),
            Step::Node { wide: true, .. } => {
                add(Operation::BoxTest32, 4);
                add(Operation::ChildSort, 1);
            }
            Step::Tree { .. } => add(Operation::TreeBase, 1),
            Step::Lod { .. } => add(Operation::LodTest, 1),
            Step::Split { .. } => add(Operation::Tessellate, 1),
            Step::Leaf { .. } => self.leaves = true,
            Step::Triangles { count, hits } => {
                add(Operation::TriTest, u64::from(count));
                let met = u64::from(hits.count_ones());
                add(Operation::HitDivide, met);
                add(Operation::HitSelect, met);
            }
            Step::End { found: true } => {
                add(Operation::HitDivide, 2);
                add(Operation::BaryMap, u64::from(!self.leaves));
            }
            Step::Pop { .. } | Step::End { found: false } => (),
        }
    }
}
