//! Where rays come from: batches of the functional layer, in order, taken by groups of cores as they need them.
//!
//! A ray that starts behind the end of another is put aside until then by the group that took it, which goes on with the next; when the other has ended, it is the
//! first that its group takes.

use super::prefetch::prefetch;
use crate::block::Operations;
use crate::step::{Batch, Link, StepWord};
use std::collections::{HashMap, HashSet, VecDeque};
use std::sync::Arc;

/// Batches that were traced together.
pub type Chunk = Arc<[Batch]>;

/// Gives the chunks of a frame in order.
pub trait ChunkSource {
    /// The next one; `None` after the last. May wait for it.
    fn next(&mut self) -> Option<Chunk>;
}

impl<I: Iterator<Item = Chunk>> ChunkSource for I {
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
pub struct FedRay {
    chunk: Chunk,
    batch: u32,
    at: u32,
    /// Its number in the batch.
    ray: u32,
}

impl FedRay {
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

impl FedRay {
    fn link(&self) -> Option<Link> {
        self.chunk[self.batch as usize].link(self.ray as usize)
    }
}

/// Rays that wait for others.
struct Order {
    /// Rays that have ended, where any wait for others.
    ended: HashSet<u64>,
    /// By the ray that they wait for: rays, and the groups that took them.
    waiting: HashMap<u64, Vec<(u32, FedRay)>>,
    /// Rays that wait no more, by group.
    ready: Vec<VecDeque<FedRay>>,
    released: Vec<u32>,
}

impl Order {
    fn new(groups: u32) -> Self {
        Self { ended: HashSet::new(), waiting: HashMap::new(), ready: vec![VecDeque::new(); groups as usize], released: Vec::new() }
    }

    /// The ray behind whose end `ray` starts, if that is still to come.
    fn waits_for(&self, ray: &FedRay) -> Option<u64> {
        ray.link()?.after.filter(|after| !self.ended.contains(after))
    }

    fn ended(&mut self, number: u64) {
        self.ended.insert(number);
        for (group, ray) in self.waiting.remove(&number).unwrap_or_default() {
            self.ready[group as usize].push_back(ray);
            self.released.push(group);
        }
    }
}

/// Hands out rays: a group takes a batch at a time, its cores the rays of it.
pub struct Feed<S> {
    source: S,
    /// The chunk that batches come from, and its next.
    open: Option<(Chunk, u32)>,
    groups: Vec<Option<Current>>,
    order: Order,
    /// What the rays of batches taken have the hardware blocks do.
    pub operations: Operations,
}

impl<S: ChunkSource> Feed<S> {
    /// Nothing taken yet.
    pub fn new(source: S, groups: u32) -> Self {
        Self { source, open: None, groups: vec![None; groups as usize], order: Order::new(groups), operations: Operations::default() }
    }

    /// The next ray of `group`; `None` when all are taken or wait for others.
    pub fn ray(&mut self, group: u32) -> Option<FedRay> {
        if let Some(ray) = self.order.ready[group as usize].pop_front() {
            return Some(ray);
        }
        loop {
            if let Some(current) = &mut self.groups[group as usize] {
                let batch = &current.chunk[current.batch as usize];
                if (current.ray as usize) < batch.rays() {
                    let at_ray = current.ray as usize;
                    let at = batch.start(at_ray);
                    current.ray += 1;
                    // The next to be taken.
                    prefetch(batch.words(), batch.end(at_ray) as usize);
                    let ray = FedRay { chunk: Arc::clone(&current.chunk), batch: current.batch, at, ray: at_ray as u32 };
                    let Some(waits_for) = self.order.waits_for(&ray) else { return Some(ray) };
                    self.order.waiting.entry(waits_for).or_default().push((group, ray));
                    continue;
                }
            }
            self.groups[group as usize] = None; // lets go of the chunk
            self.groups[group as usize] = Some(self.batch()?);
        }
    }

    /// `ray` has ended: rays that waited for it are ready. Their groups are added to [`Feed::released`].
    #[inline(always)]
    pub fn ended(&mut self, ray: &FedRay) {
        if let Some(link) = ray.link() {
            self.order.ended(link.number);
        }
    }

    /// Rays wait for nobody any more, and have not been taken.
    pub fn has_ready(&self) -> bool {
        self.order.ready.iter().any(|rays| !rays.is_empty())
    }

    /// A group that has rays again since it was last asked for, if there is one.
    #[inline(always)]
    pub fn released(&mut self) -> Option<u32> {
        self.order.released.pop()
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
