//! A frame as the steps of its rays, for the simulator.
//!
//! Batches are given in order, in chunks, and whoever takes them holds the next chunks back: memory is bounded by what waits, not by the frame.

use crate::method::{Method, SurfaceHit, Tracer};
use crate::rays::{RaySource, Sight};
use crate::step::{Batch, Link, Recorder};
use rayon::prelude::*;

/// Batches traced at once: enough for many threads, and small beside a frame.
const CHUNK: usize = 256;

/// A frame to trace.
#[derive(Clone, Copy)]
pub struct FrameRays<'a> {
    /// How rays find their hits; one that is hardware.
    pub method: &'a dyn Method,
    /// The rays.
    pub rays: &'a dyn RaySource,
    /// What they see.
    pub sight: &'a Sight,
}

/// What a ray met.
#[derive(Clone, Copy, Debug)]
pub struct RayHit {
    /// The ray's number: a pixel's, row by row from the top, or its place in a file.
    pub ray: u64,
    /// None if it met nothing.
    pub hit: Option<SurfaceHit>,
}

/// Some of a frame's batches, traced.
pub struct Traced {
    /// The steps of their rays.
    pub batches: Vec<Batch>,
    /// What the rays met, in the same order.
    pub hits: Vec<RayHit>,
}

impl FrameRays<'_> {
    /// Traces all rays; gives them to `take`, in order, until it wants no more.
    pub fn produce(&self, mut take: impl FnMut(Traced) -> bool) {
        let batches = self.rays.batches();
        for first in (0..batches).step_by(CHUNK) {
            let chunk = (first..batches.min(first + CHUNK)).into_par_iter();
            let traced = chunk.map_init(|| self.method.tracer(self.sight), |tracer, batch| self.batch(&mut **tracer, batch));
            let (batches, hits): (Vec<_>, Vec<_>) = traced.unzip();
            if !take(Traced { batches, hits: hits.concat() }) {
                return;
            }
        }
    }

    fn batch(&self, tracer: &mut dyn Tracer, batch: usize) -> (Batch, Vec<RayHit>) {
        let mut hits = Vec::new();
        let mut recorder = Recorder::default();
        let is_ordered = self.rays.is_ordered();
        self.rays.batch(batch, &mut |number, query| {
            if is_ordered {
                recorder.link(Link { number, after: query.after });
            }
            hits.push(RayHit { ray: number, hit: tracer.recorded(query, &mut recorder) });
        });
        (recorder.batch(), hits)
    }
}
