//! The full-resolution mesh in `f64`: the truth that pictures are compared with. It is no hardware, and reads no memory.

use super::hit::plane;
use super::{Departure, Landing, Method, Over, Registered, SurfaceHit, Trace, Tracer};
use crate::golden::reference::Reference;
use crate::rays::{ModelSpace, Query, Sight};
use crate::step::{MemoryMap, StepSink};

/// The method.
pub static METHOD: Registered = Registered {
    name: "reference",
    help: "f64, full resolution: the truth",
    knobs: &[],
    error: None,
    over: Over::Scene,
    unit: None,
    works: &[],
    make: |scene, _, _| Ok(Box::new(Truth { reference: Reference::new(&scene.decode()), space: ModelSpace::of(scene) })),
};

struct Truth {
    reference: Reference,
    space: ModelSpace,
}

impl Method for Truth {
    fn map(&self, _: &Sight) -> MemoryMap {
        MemoryMap::default()
    }

    fn tracer(&self, _: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(self)
    }

    /// Its hits are not exact.
    fn leaves(&self) -> bool {
        false
    }
}

impl Trace for &Truth {
    fn trace<S: StepSink>(&mut self, query: &Query, _: &mut S) -> Option<SurfaceHit> {
        let scale = self.space.placement.scale;
        let [near, far] = [query.t_min, query.t_max].map(|t| t / scale);
        let hit = self.reference.trace_between(self.space.to_units(query.origin), query.direction, [near, far])?;
        Some(SurfaceHit {
            distance: hit.t * scale,
            tree: hit.tree,
            full_node: hit.full_node,
            full_bary: hit.bary.map(|b| b as f32),
            level: self.reference.levels() as u8, // at most 10
            node: hit.full_node,
            bary: hit.bary.map(|b| b as f32),
            front: hit.front,
            plane: plane(self.reference.corners(hit.tree, hit.full_node).map(|p| p.map(f64::from))),
        })
    }

    fn follow<S: StepSink>(&mut self, _: &Query, _: Option<&Departure>, _: &mut S) -> Option<Landing> {
        None
    }

    fn is_mapped(&self) -> bool {
        false
    }
}
