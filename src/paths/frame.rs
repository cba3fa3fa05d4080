//! Rays of any source through several models, for the simulator.

use super::memory::WorldMemory;
use super::world::{Heard, World, WorldRay};
use crate::method::{Before, Tracer};
use crate::rays::RaySource;
use crate::run::{Frame, RayHit, Worker};
use crate::step::{Batch, Link, MapError, MemoryMap, Nodes, Recorder};

/// The rays of a source as a frame for machines, each from its own origin; one that names an earlier ray waits for that.
pub struct WorldFrame<'a> {
    worlds: &'a [World<'a>],
    rays: &'a dyn RaySource,
    memory: WorldMemory,
}

impl<'a> WorldFrame<'a> {
    /// These rays through these models: one world for all frames of the rays, or one for each, of the same models elsewhere.
    ///
    /// # Errors
    /// The models have more lines than can be numbered.
    ///
    /// # Panics
    /// There is no world.
    pub fn new(worlds: &'a [World<'a>], rays: &'a dyn RaySource) -> Result<Self, MapError> {
        let nodes = worlds.iter().map(World::nodes).max().expect("a world");
        Ok(Self { worlds, rays, memory: worlds[0].memory_with(nodes)? })
    }

    /// The models as they stand in a frame.
    fn world(&self, frame: usize) -> &World<'a> {
        &self.worlds[frame.min(self.worlds.len() - 1)]
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
        self.world(frame).before(&self.memory, frame, frame.checked_sub(1).map(|last| self.world(last)))
    }

    fn models(&self) -> usize {
        self.worlds[0].instances().len()
    }

    fn worker(&self, frame: usize) -> Box<dyn Worker + '_> {
        let of_several = (!self.rays.frame_starts().is_empty()).then_some(frame);
        let world = self.world(frame);
        Box::new(WorldWorker { frame: self, world, tracers: world.tracers_of(of_several) })
    }
}

struct WorldWorker<'a> {
    frame: &'a WorldFrame<'a>,
    world: &'a World<'a>,
    tracers: Vec<Box<dyn Tracer + 'a>>,
}

impl Worker for WorldWorker<'_> {
    fn batch(&mut self, batch: usize) -> (Batch, Vec<RayHit>) {
        let WorldFrame { rays, memory, .. } = self.frame;
        let (mut recorder, is_ordered) = (Recorder::default(), rays.is_ordered());
        rays.batch(batch, &mut |number, query| {
            if is_ordered {
                recorder.link(Link { number, after: query.after });
            }
            let heard = Heard { memory, steps: &mut recorder };
            self.world.trace(&mut self.tracers, &WorldRay::of(query), None, Some(heard));
        });
        (recorder.batch(), Vec::new())
    }
}
