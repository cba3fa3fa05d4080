//! The rays of paths for the simulator: a bounce starts when its hit is known.

use super::integrate::{Path, PathTracer, Paths};
use super::world::Listener;
use crate::method::Before;
use crate::rays::RaySource;
use crate::run::{Frame, RayHit, Worker};
use crate::step::{Batch, Nodes};

/// Paths of a scene of one model as a frame for machines.
///
/// A batch has the paths of a tile of pixels: first all rays of the camera, then all that leave their hits, and so on. A ray waits for the one behind whose hit it starts.
pub struct PathFrame<'a> {
    paths: &'a Paths<'a>,
}

impl<'a> PathFrame<'a> {
    /// The paths as rays; `None` if the scene has several models: a machine's memory holds one.
    pub fn new(paths: &'a Paths<'a>) -> Option<Self> {
        (paths.world.instances().len() == 1).then_some(Self { paths })
    }
}

impl Frame for PathFrame<'_> {
    fn nodes(&self) -> Nodes {
        let own = &self.paths.world.instances()[0];
        own.method.map(own.sight()).nodes()
    }

    fn batches(&self) -> usize {
        self.paths.camera.batches()
    }

    fn worker(&self) -> Box<dyn Worker + '_> {
        Box::new(PathWorker { tracer: self.paths.tracer(), paths: self.paths })
    }

    fn before(&self, frame: usize) -> Option<Box<dyn Before + '_>> {
        let own = &self.paths.world.instances()[0];
        own.method.before(own.sight(), frame)
    }

    fn numbers_by_batch(&self) -> bool {
        true
    }
}

struct PathWorker<'a> {
    paths: &'a Paths<'a>,
    tracer: PathTracer<'a>,
}

impl Worker for PathWorker<'_> {
    fn batch(&mut self, batch: usize) -> (Batch, Vec<RayHit>) {
        let (paths, mut under_way) = (self.paths, Vec::<Path>::new());
        paths.camera.batch(batch, &mut |number, _| {
            let width = u64::from(paths.camera.width);
            let [x, y] = [number % width, number / width].map(|at| at as u32); // within the picture
            under_way.extend((0..paths.samples).map(|sample| paths.start(x, y, sample)));
        });
        let mut listener = Listener::default();
        while !under_way.is_empty() {
            under_way.iter_mut().for_each(|path| self.tracer.advance(path, Some(&mut listener)));
            under_way.retain(|path| !path.is_over);
        }
        (listener.recorder.batch(), Vec::new())
    }
}
