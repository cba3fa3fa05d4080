//! Rays of any source through several models, for the simulator.

use super::memory::WorldMemory;
use super::world::{Heard, World, WorldRay};
use crate::method::{Before, Tracer};
use crate::rays::RaySource;
use crate::run::{Frame, RayHit, Worker};
use crate::step::{Batch, Link, MapError, MemoryMap, Nodes, Recorder};

/// The rays of a source as a frame for machines, each from its own origin; one that names an earlier ray waits for that.
pub struct WorldFrame<'a> {
    world: &'a World<'a>,
    rays: &'a dyn RaySource,
    memory: WorldMemory,
}

impl<'a> WorldFrame<'a> {
    /// These rays through these models.
    ///
    /// # Errors
    /// The models have more lines than can be numbered.
    pub fn new(world: &'a World<'a>, rays: &'a dyn RaySource) -> Result<Self, MapError> {
        Ok(Self { world, rays, memory: world.memory()? })
    }

    /// Where the lines of all models lie.
    pub fn map(&self) -> &MemoryMap {
        self.memory.map()
    }
}

impl Frame for WorldFrame<'_> {
    fn nodes(&self) -> Nodes {
        self.memory.map().nodes()
    }

    fn batches(&self) -> usize {
        self.rays.batches()
    }

    fn frame_starts(&self) -> Vec<usize> {
        self.rays.frame_starts()
    }

    fn before(&self, frame: usize) -> Option<Box<dyn Before + '_>> {
        self.world.before(&self.memory, frame)
    }

    fn models(&self) -> usize {
        self.world.instances().len()
    }

    fn worker(&self, frame: usize) -> Box<dyn Worker + '_> {
        let of_several = (!self.rays.frame_starts().is_empty()).then_some(frame);
        Box::new(WorldWorker { frame: self, tracers: self.world.tracers_of(of_several) })
    }
}

struct WorldWorker<'a> {
    frame: &'a WorldFrame<'a>,
    tracers: Vec<Box<dyn Tracer + 'a>>,
}

impl Worker for WorldWorker<'_> {
    fn batch(&mut self, batch: usize) -> (Batch, Vec<RayHit>) {
        let WorldFrame { world, rays, memory } = self.frame;
        let (mut recorder, is_ordered) = (Recorder::default(), rays.is_ordered());
        rays.batch(batch, &mut |number, query| {
            if is_ordered {
                recorder.link(Link { number, after: query.after });
            }
            let heard = Heard { memory, steps: &mut recorder };
            world.trace(&mut self.tracers, &WorldRay::of(query), None, Some(heard));
        });
        (recorder.batch(), Vec::new())
    }
}
