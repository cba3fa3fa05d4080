//! A frame as the steps of its rays, for the simulator.
//!
//! Batches are given in order, in chunks, and whoever takes them holds the next chunks back: memory is bounded by what waits, not by the frame.

use crate::method::{Before, Method, SurfaceHit, Tracer, trace_together};
use crate::rays::{RaySource, Sight};
use crate::sim::replay::Chunk;
use crate::step::{Batch, Link, Nodes, Recorder};
use rayon::prelude::*;

/// Batches traced at once: enough for many threads, and small beside a frame.
const CHUNK: usize = 256;

/// Rays to trace, in batches that do not depend on each other.
pub trait Frame: Sync {
    /// Nodes that all rays begin with.
    fn nodes(&self) -> Nodes;

    /// How many batches there are.
    fn batches(&self) -> usize;

    /// Traces batches of a frame, the first being 0; one for each thread.
    fn worker(&self, frame: usize) -> Box<dyn Worker + '_>;

    /// The first batches of the frames behind the first, in order, where it is several frames after one another.
    fn frame_starts(&self) -> Vec<usize> {
        Vec::new()
    }

    /// What is to be done before the rays of a frame, the first being 0.
    fn before(&self, _frame: usize) -> Option<Box<dyn Before + '_>> {
        None
    }

    /// Models among which its rays go from one space to the next.
    fn models(&self) -> usize {
        1
    }

    /// Rays that are traced together.
    fn lanes(&self) -> usize {
        1
    }

    /// Every batch numbers its own rays from 0, and they wait for none of another.
    fn numbers_by_batch(&self) -> bool {
        false
    }

    /// Traces all rays; gives them to `take`, in order, until it wants no more.
    fn produce(&self, take: &mut dyn FnMut(Traced) -> bool) {
        let (batches, starts, mut rays) = (self.batches(), self.frame_starts(), 0);
        let (mut first, mut frame, mut has_begun) = (0, 0, false);
        while first < batches {
            let mut begins_frame = starts.contains(&first);
            frame += usize::from(begins_frame);
            if (begins_frame || first == 0)
                && let Some(before) = self.before(frame)
            {
                let work = before.batches();
                for from in (0..work).step_by(CHUNK) {
                    let batches: Vec<_> = (from..work.min(from + CHUNK)).into_par_iter().map(|batch| before.batch(batch)).collect();
                    let begins_frame = from == 0 && has_begun;
                    if !take(Traced { batches, hits: Vec::new(), begins_frame, is_before: true }) {
                        return;
                    }
                    has_begun = true;
                }
                // The rays wait for all of it.
                begins_frame |= work > 0;
            }
            has_begun = true;
            // A chunk is of one frame.
            let next_frame = starts.iter().copied().find(|&start| start > first).unwrap_or(batches);
            let end = next_frame.min(first + CHUNK);
            let chunk = (first..end).into_par_iter();
            let traced = chunk.map_init(|| self.worker(frame), |worker, batch| worker.batch(batch));
            let (mut batches, hits): (Vec<_>, Vec<_>) = traced.unzip();
            if self.numbers_by_batch() {
                for batch in &mut batches {
                    batch.number_from(rays);
                    rays += batch.rays() as u64;
                }
            }
            if !take(Traced { batches, hits: hits.concat(), begins_frame, is_before: false }) {
                return;
            }
            first = end;
        }
    }
}

/// Traces the batches of a frame.
pub trait Worker {
    /// The steps of a batch's rays, and what those of them met that pictures are made of.
    fn batch(&mut self, batch: usize) -> (Batch, Vec<RayHit>);
}

/// The rays of one source as a frame.
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
    /// They are the first of a frame behind another, or behind work before it.
    pub begins_frame: bool,
    /// They are work before a frame, and no rays.
    pub is_before: bool,
}

impl Traced {
    /// The steps, for a replay.
    pub fn chunk(self) -> Chunk {
        let chunk = Chunk::from(self.batches);
        let chunk = if self.is_before { chunk.before_frame() } else { chunk };
        if self.begins_frame { chunk.beginning_frame() } else { chunk }
    }
}

/// Traces them.
struct RayWorker<'a> {
    rays: &'a dyn RaySource,
    tracer: Box<dyn Tracer + 'a>,
}

impl Frame for FrameRays<'_> {
    fn nodes(&self) -> Nodes {
        self.method.map(self.sight).nodes()
    }

    fn batches(&self) -> usize {
        self.rays.batches()
    }

    fn frame_starts(&self) -> Vec<usize> {
        self.rays.frame_starts()
    }

    fn before(&self, frame: usize) -> Option<Box<dyn Before + '_>> {
        self.method.before(self.sight, frame)
    }

    fn lanes(&self) -> usize {
        self.method.tracer(self.sight).lanes()
    }

    fn worker(&self, frame: usize) -> Box<dyn Worker + '_> {
        let is_one = self.rays.frame_starts().is_empty();
        let tracer = if is_one { self.method.tracer(self.sight) } else { self.method.tracer(&self.sight.of_frame(frame)) };
        Box::new(RayWorker { rays: self.rays, tracer })
    }
}

impl Worker for RayWorker<'_> {
    fn batch(&mut self, batch: usize) -> (Batch, Vec<RayHit>) {
        let mut hits = Vec::new();
        let mut recorder = Recorder::default();
        let is_ordered = self.rays.is_ordered();
        if self.tracer.lanes() > 1 && !is_ordered {
            let (mut numbers, mut queries) = (Vec::new(), Vec::new());
            self.rays.batch(batch, &mut |number, query| {
                numbers.push(number);
                queries.push(*query);
            });
            let found = trace_together(&mut *self.tracer, &queries, &mut recorder);
            return (recorder.batch(), numbers.into_iter().zip(found).map(|(ray, hit)| RayHit { ray, hit }).collect());
        }
        self.rays.batch(batch, &mut |number, query| {
            if is_ordered {
                recorder.link(Link { number, after: query.after });
            }
            hits.push(RayHit { ray: number, hit: self.tracer.recorded(query, &mut recorder) });
        });
        (recorder.batch(), hits)
    }
}
