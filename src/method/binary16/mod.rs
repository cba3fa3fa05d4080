//! A binary BVH whose leaves have sixteen places for triangles: what von Buelow measures grids of triangles against ("GPU Ray Tracing of Triangular Grid Primitives", 2024, section 3.1).
//!
//! The surface area heuristic over 256 bins splits triangles until no more than 16 are left. Nodes have boxes of full precision and stand depth first; leaves are padded to 16 index triples, so that
//! nothing points to them; vertices are shared, 12 bytes each. A ray tests the boxes of both children of a node and goes on with the nearer one.
//! Triangles, and so hits, are those of [`bvh`](super::bvh). [`Tree`] is the structure, [`Traverser`] has its rays.

mod float;
mod map;
#[cfg(test)]
mod tests;
mod trace;
mod tree;

pub use float::FloatTree;
pub use map::memory;
pub use trace::Traverser;
pub use tree::Tree;

use super::bvh::BvhTraverser;
use super::{AllHits, ClosestHit, Departure, Landing, Method, MethodUnit, Over, Registered, SurfaceHit, Trace, Tracer};
use crate::block::Operation;
use crate::rays::{ModelSpace, Query, Sight};
use crate::step::{MemoryMap, NoSteps, StepSink};

/// Operations of a unit for its rays: the boxes of both children at once, then their order.
const UNIT: [Operation; 8] = [
    Operation::RaySetup,
    Operation::NodeAddress,
    Operation::BoxTest32,
    Operation::BoxTest32,
    Operation::ChildSort,
    Operation::TriTest,
    Operation::HitDivide,
    Operation::HitSelect,
];

/// The method.
pub static METHOD: Registered = Registered {
    name: "binary16",
    help: "Binary BVH of the full-resolution mesh, 32-bit boxes, leaves padded to 16 indexed triangles",
    knobs: &[],
    error: None,
    over: Over::Scene,
    unit: Some(MethodUnit { blocks: &UNIT, has_levels: false }),
    works: &[],
    make: |scene, _, _| Ok(Box::new(Binary16 { tree: Tree::new(&scene.decode())?, space: ModelSpace::of(scene) })),
};

/// The method on a scene.
struct Binary16 {
    tree: Tree,
    space: ModelSpace,
}

impl Method for Binary16 {
    fn map(&self, _: &Sight) -> MemoryMap {
        memory(&self.tree)
    }

    fn tracer(&self, _: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(Rays { traverser: Traverser::new(&self.tree, memory(&self.tree)), levels: self.tree.levels, space: self.space })
    }

    fn choices(&self, _: &Sight) -> Vec<(&'static str, String)> {
        let Tree { triangles, has_floats, .. } = self.tree;
        let share = |of: u64, by: usize| format!("{:.2}", of as f64 / by as f64);
        vec![
            ("coordinates", if has_floats { "floats" } else { "32-bit integers" }.to_owned()),
            ("triangles a leaf", share(triangles as u64, self.tree.leaves())),
            ("bytes a triangle", share(self.tree.bytes(), triangles)),
        ]
    }
}

/// Its rays.
struct Rays<'a> {
    traverser: Traverser<'a>,
    levels: u32,
    space: ModelSpace,
}

impl Rays<'_> {
    /// The closest hit of a query, which starts at `from` if there is one, as `then` has it.
    fn closest<S: StepSink, R>(
        &mut self,
        query: &Query,
        from: Option<&Departure>,
        steps: &mut S,
        then: impl FnOnce(&ClosestHit, &crate::rays::ModelRay) -> Option<R>,
    ) -> Option<R> {
        // Its triangles are what they are, whatever the quality.
        let ray = self.space.enter_from(query, from.map(|from| &from.start), 1.0)?;
        let mut hit = ClosestHit::of(self.levels, &ray, query.any);
        self.traverser.descend(&ray.ray, from, steps, &mut hit);
        then(&hit, &ray)
    }
}

impl Trace for Rays<'_> {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        self.closest(query, None, steps, ClosestHit::surface)
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        self.closest(query, from, steps, |hit, ray| hit.landing(ray, BvhTraverser::departure))
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        if let Some(ray) = self.space.enter(query, 1.0) {
            let mut all = AllHits::of(self.levels, &ray);
            self.traverser.descend(&ray.ray, None, &mut NoSteps, &mut all);
            all.surfaces(&ray, hits);
        }
        true
    }

    fn is_mapped(&self) -> bool {
        false
    }
}
