//! What rays have the hardware blocks do, whatever it takes.

use super::event::{Event, Step};
use crate::sim::energy::{Operation, Operations};

/// The operations of `rays` rays, whose steps are these.
pub fn operations(rays: usize, steps: &[Event]) -> Operations {
    let mut operations = Operations::default();
    let mut add = |operation, count| operations.add(operation, count);
    add(Operation::RaySetup, rays as u64);
    // A full-resolution BVH: its hits are on the mesh already.
    let mut leaves = false;
    for step in steps.iter().map(|event| event.step()) {
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
            Step::Leaf { .. } => leaves = true,
            Step::Triangles { count, hits } => {
                add(Operation::TriTest, u64::from(count));
                let met = u64::from(hits.count_ones());
                add(Operation::HitDivide, met);
                add(Operation::HitSelect, met);
            }
            Step::End { found: true } => {
                add(Operation::HitDivide, 2);
                add(Operation::BaryMap, u64::from(!leaves));
            }
            Step::Pop { .. } | Step::End { found: false } => (),
        }
    }
    operations
}
