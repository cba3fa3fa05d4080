//! The rays of paths for the simulator: a bounce starts when its hit is known.

use super::integrate::{Path, PathTracer, Paths};
use super::memory::WorldMemory;
use super::world::Listener;
use crate::method::Before;
use crate::rays::RaySource;
use crate::run::{Frame, RayHit, Worker};
use crate::step::{Batch, MapError, MemoryMap, Nodes};

/// Most paths of a pixel in a batch.
const SAMPLES: u32 = 64;

/// Paths of a scene as a frame for machines.
///
/// A batch has the paths of a tile of pixels, those of 64 samples of each at most, so that memory does not grow with them: first all rays of the camera, then all that leave their hits, and so on. A ray waits for the one behind whose hit it starts.
pub struct PathFrame<'a> {
    paths: &'a Paths<'a>,
    memory: WorldMemory,
}

impl<'a> PathFrame<'a> {
    /// The paths as rays.
    ///
    /// # Errors
    /// The models have more lines than can be numbered.
    pub fn new(paths: &'a Paths<'a>) -> Result<Self, MapError> {
        Ok(Self { paths, memory: paths.world.memory()? })
    }

    /// Where the lines of all models lie.
    pub fn map(&self) -> &MemoryMap {
        self.memory.map()
    }
}

impl Frame for PathFrame<'_> {
    fn nodes(&self) -> Nodes {
        self.memory.map().nodes()
    }

    fn batches(&self) -> usize {
        self.paths.camera.batches() * parts(self.paths)
    }

    fn worker(&self, _: usize) -> Box<dyn Worker + '_> {
        Box::new(PathWorker { tracer: self.paths.tracer(), paths: self.paths, memory: &self.memory })
    }

    fn before(&self, frame: usize) -> Option<Box<dyn Before + '_>> {
        self.paths.world.before(&self.memory, frame, None)
    }

    fn models(&self) -> usize {
        self.paths.world.instances().len()
    }

    fn numbers_by_batch(&self) -> bool {
        true
    }
}

/// Batches of a tile.
fn parts(paths: &Paths<'_>) -> usize {
    paths.samples.div_ceil(SAMPLES) as usize
}

struct PathWorker<'a> {
    paths: &'a Paths<'a>,
    memory: &'a WorldMemory,
    tracer: PathTracer<'a>,
}

impl Worker for PathWorker<'_> {
    fn batch(&mut self, batch: usize) -> (Batch, Vec<RayHit>) {
        let (paths, mut under_way) = (self.paths, Vec::<Path>::new());
        let (tile, first) = (batch / parts(paths), (batch % parts(paths)) as u32 * SAMPLES);
        let samples = first..paths.samples.min(first + SAMPLES);
        paths.camera.batch(tile, &mut |number, _| {
            let width = u64::from(paths.camera.width);
            let [x, y] = [number % width, number / width].map(|at| at as u32); // within the picture
            under_way.extend(samples.clone().map(|sample| paths.start(x, y, sample)));
        });
        let mut listener = Listener::new(self.memory);
        while !under_way.is_empty() {
            under_way.iter_mut().for_each(|path| self.tracer.advance(path, Some(&mut listener)));
            under_way.retain(|path| !path.is_over);
        }
        (listener.recorder.batch(), Vec::new())
    }
}
