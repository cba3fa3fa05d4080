//! Where rays come from: batches of the functional layer, in order, taken by groups of cores as they need them.

use super::prefetch::prefetch;
use crate::sim::energy::Operations;
use crate::step::{Batch, StepWord};
use std::sync::Arc;

/// Batches that were traced together.
pub type Chunk = Arc<[Batch]>;

/// Gives the chunks of a frame in order.
pub trait Source {
    /// The next one; `None` after the last. May wait for it.
    fn next(&mut self) -> Option<Chunk>;
}

impl<I: Iterator<Item = Chunk>> Source for I {
    fn next(&mut self) -> Option<Chunk> {
        Iterator::next(self)
    }
}

/// A batch in its chunk, and its next ray.
#[derive(Clone)]
struct Current {
    chunk: Chunk,
    batch: u32,
    ray: u32,
}

/// A ray: its place among its batch's steps.
#[derive(Clone)]
pub struct Ray {
    chunk: Chunk,
    batch: u32,
    at: u32,
}

impl Ray {
    /// Its next step; a ray ends with [`Act::End`](crate::step::Act::End), after which it has none.
    #[inline(always)]
    pub fn peek(&self) -> StepWord {
        self.chunk[self.batch as usize].words()[self.at as usize]
    }

    /// Its steps from the next on, and those of the rays behind it.
    #[inline(always)]
    pub fn rest(&self) -> &[StepWord] {
        &self.chunk[self.batch as usize].words()[self.at as usize..]
    }

    /// Goes on by `steps`.
    #[inline(always)]
    pub fn skip(&mut self, steps: u32) {
        self.at += steps;
    }

    /// The steps behind the next are read soon.
    #[inline(always)]
    pub fn prefetch(&self) {
        prefetch(self.chunk[self.batch as usize].words(), self.at as usize);
    }
}

/// Hands out rays: a group takes a batch at a time, its cores the rays of it.
pub struct Feed<S> {
    source: S,
    /// The chunk that batches come from, and its next.
    open: Option<(Chunk, u32)>,
    groups: Vec<Option<Current>>,
    /// What the rays of batches taken have the hardware blocks do.
    pub operations: Operations,
}

impl<S: Source> Feed<S> {
    /// Nothing taken yet.
    pub fn new(source: S, groups: u32) -> Self {
        Self { source, open: None, groups: vec![None; groups as usize], operations: Operations::default() }
    }

    /// The next ray of `group`; `None` when all are taken.
    pub fn ray(&mut self, group: u32) -> Option<Ray> {
        loop {
            if let Some(current) = &mut self.groups[group as usize] {
                let batch = &current.chunk[current.batch as usize];
                if (current.ray as usize) < batch.rays() {
                    let at_ray = current.ray as usize;
                    let at = batch.start(at_ray);
                    current.ray += 1;
                    // The next to be taken.
                    prefetch(batch.words(), batch.end(at_ray) as usize);
                    return Some(Ray { chunk: Arc::clone(&current.chunk), batch: current.batch, at });
                }
            }
            self.groups[group as usize] = None; // lets go of the chunk
            self.groups[group as usize] = Some(self.batch()?);
        }
    }

    fn batch(&mut self) -> Option<Current> {
        loop {
            if let Some((chunk, next)) = &mut self.open
                && (*next as usize) < chunk.len()
            {
                let batch = *next;
                *next += 1;
                self.operations.join(chunk[batch as usize].operations());
                return Some(Current { chunk: Arc::clone(chunk), batch, ray: 0 });
            }
            self.open = None;
            self.open = Some((self.source.next()?, 0));
        }
    }
}
