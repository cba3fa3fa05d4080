//! A frame as the steps of its rays, for the simulator.
//!
//! A batch is a tile of 8 x 8 rays; tiles go row by row from the top left. Batches are given in order, in chunks, and whoever takes them holds the next chunks
//! back: memory is bounded by what waits, not by the frame.

use super::Camera;
use super::frame::{Method, Tracer};
use crate::step::{Batch, Recorder};
use crate::traverse::ModelSpace;
use rayon::prelude::*;

/// Columns and rows of a tile.
const TILE: u32 = 8;

/// Batches traced at once: enough for many threads, and small beside a frame.
const CHUNK: usize = 256;

/// A frame to trace.
#[derive(Clone, Copy)]
pub struct FrameRays<'a> {
    /// How rays find their hits; not the reference, which reads no memory.
    pub method: &'a Method<'a>,
    /// Where the model lies.
    pub space: &'a ModelSpace,
    /// One ray per pixel.
    pub camera: &'a Camera,
    /// Quality of the level of detail.
    pub delta: f64,
}

impl FrameRays<'_> {
    /// Batches of the frame.
    pub fn batches(&self) -> usize {
        self.camera.width.div_ceil(TILE) as usize * self.camera.height.div_ceil(TILE) as usize
    }

    /// Traces all rays; gives the batches to `take`, in order, until it wants no more.
    pub fn produce(&self, mut take: impl FnMut(Vec<Batch>) -> bool) {
        let batches = self.batches();
        for first in (0..batches).step_by(CHUNK) {
            let chunk = (first..batches.min(first + CHUNK)).into_par_iter();
            let chunk = chunk.map_init(|| Tracer::new(self.method), |tracer, tile| self.batch(tracer, tile)).collect();
            if !take(chunk) {
                return;
            }
        }
    }

    fn batch(&self, tracer: &mut Tracer<'_>, tile: usize) -> Batch {
        let Camera { width, height, .. } = *self.camera;
        let columns = width.div_ceil(TILE) as usize;
        // Tiles of a picture of at most 2^16 columns and rows.
        let [left, top] = [tile % columns, tile / columns].map(|at| at as u32 * TILE);
        let mut recorder = Recorder::default();
        for y in top..height.min(top + TILE) {
            for x in left..width.min(left + TILE) {
                tracer.pixel(self.space, self.camera, self.delta, [x, y], &mut recorder);
            }
        }
        recorder.batch()
    }
}
