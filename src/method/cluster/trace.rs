//! Rays through a frame's clusters.

use super::frame::FrameBvh;
use crate::method::bvh::BvhTraverser;
use crate::method::{AllHits, ClosestHit, Departure, Landing, SurfaceHit, Trace};
use crate::rays::{ModelSpace, Query};
use crate::step::{MemoryMap, NoSteps, StepSink};
use std::sync::Arc;

/// Traces rays through the BVH of a frame; a hit names its triangle among those of all clusters.
pub struct ClusterTracer {
    frame: Arc<FrameBvh>,
    traverser: BvhTraverser,
    space: ModelSpace,
}

impl ClusterTracer {
    /// Through this BVH in the method's memory.
    pub fn new(frame: Arc<FrameBvh>, map: MemoryMap, space: ModelSpace) -> Self {
        Self { traverser: BvhTraverser::within(&frame.bvh, map), frame, space }
    }

    fn named(&self, hit: SurfaceHit) -> SurfaceHit {
        SurfaceHit { tree: self.frame.triangles[hit.tree as usize], ..hit }
    }
}

impl Trace for ClusterTracer {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        // Its triangles are what they are, whatever the ray's cone.
        let ray = self.space.enter(query, 1.0)?;
        let mut hit = ClosestHit::of(0, &ray, query.any);
        self.traverser.descend(&ray.ray, None, steps, &mut hit);
        hit.surface(&ray).map(|hit| self.named(hit))
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        let ray = self.space.enter_from(query, from.map(|from| &from.start), 1.0)?;
        let mut hit = ClosestHit::of(0, &ray, query.any);
        self.traverser.descend(&ray.ray, from, steps, &mut hit);
        // All rays see one surface: none of them decides anything.
        let landing = hit.landing(&ray, BvhTraverser::departure)?;
        Some(Landing { surface: self.named(landing.surface), ..landing })
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        if let Some(ray) = self.space.enter(query, 1.0) {
            let (mut all, first) = (AllHits::of(0, &ray), hits.len());
            self.traverser.descend(&ray.ray, None, &mut NoSteps, &mut all);
            all.surfaces(&ray, hits);
            hits[first..].iter_mut().for_each(|hit| *hit = self.named(*hit));
        }
        true
    }

    fn is_mapped(&self) -> bool {
        false
    }
}
