//! Where rays come from: batches of the functional layer, in order, taken by groups of cores as they need them.
//!
//! A ray that starts behind the end of another is put aside until then, and the group that took it goes on with the next; when the other has ended, it is among the
//! first that the other's group takes, or whoever has nothing else to do.

use super::prefetch::prefetch;
use crate::block::Operations;
use crate::step::{Batch, Link, StepWord};
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};
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
    /// The cycle in which it was taken.
    pub started: u64,
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

/// Most rays that are put aside: beyond, a group puts one more aside and stands still until that one is ready or there is room, so that what is held in memory
/// does not grow with the frame. The first ray that has not ended waits for none, and no group stands still before it: all go on in the end.
pub(super) const MOST_WAITING: usize = 1 << 16;

/// A ray that waits, and the group that stands still until it is ready, if one does.
struct Waiting {
    ray: FedRay,
    holds_back: Option<u32>,
}

/// Rays that wait for others.
struct Order {
    /// All rays before this one have ended, and so have those of `ended`.
    open: u64,
    ended: HashSet<u64>,
    /// By the ray that they wait for.
    waiting: HashMap<u64, Vec<Waiting>>,
    waiting_count: usize,
    /// Rays that wait no more, by the group in which the one ended that they waited for.
    ready: Vec<VecDeque<FedRay>>,
    ready_count: usize,
    /// Groups that have got rays.
    released: Vec<u32>,
    /// Groups that asked and got none.
    idle: BTreeSet<u32>,
    /// Those of them that stand still.
    held_back: BTreeSet<u32>,
}

impl Order {
    fn new(groups: u32) -> Self {
        Self {
            open: 0,
            ended: HashSet::new(),
            waiting: HashMap::new(),
            waiting_count: 0,
            ready: vec![VecDeque::new(); groups as usize],
            ready_count: 0,
            released: Vec::new(),
            idle: BTreeSet::new(),
            held_back: BTreeSet::new(),
        }
    }

    /// The ray behind whose end `ray` starts, if that is still to come.
    fn waits_for(&self, ray: &FedRay) -> Option<u64> {
        ray.link()?.after.filter(|after| *after >= self.open && !self.ended.contains(after))
    }

    fn is_full(&self) -> bool {
        self.waiting_count >= MOST_WAITING
    }

    /// Whether `group`, which took `ray`, goes on.
    fn put_aside(&mut self, waits_for: u64, ray: FedRay, group: u32) -> bool {
        let holds_back = self.is_full().then_some(group);
        self.held_back.extend(holds_back);
        self.waiting.entry(waits_for).or_default().push(Waiting { ray, holds_back });
        self.waiting_count += 1;
        holds_back.is_none()
    }

    /// `group` does not go on in its batches yet.
    fn holds_back(&mut self, group: u32) -> bool {
        if !self.is_full() {
            self.held_back.remove(&group);
        }
        self.held_back.contains(&group)
    }

    /// A ray of `group` has ended.
    fn ended(&mut self, number: u64, group: u32) {
        self.ended.insert(number);
        while self.ended.remove(&self.open) {
            self.open += 1;
        }
        let rays = self.waiting.remove(&number).unwrap_or_default();
        if rays.is_empty() {
            return;
        }
        self.waiting_count -= rays.len();
        self.ready_count += rays.len();
        for Waiting { ray, holds_back } in rays {
            self.ready[group as usize].push_back(ray);
            if let Some(other) = holds_back {
                self.held_back.remove(&other);
                self.released.push(other);
            }
        }
        self.released.push(group);
    }

    /// A ray that waits no more: of `group`, or, if `any`, of the group with the most of them.
    fn ready(&mut self, group: u32, any: bool) -> Option<FedRay> {
        if self.ready_count == 0 {
            return None;
        }
        let own = &mut self.ready[group as usize];
        let ray = match own.pop_front() {
            None if any => self.ready.iter_mut().rev().max_by_key(|rays| rays.len())?.pop_front(),
            own => own,
        };
        self.ready_count -= usize::from(ray.is_some());
        ray
    }

    fn released(&mut self) -> Option<u32> {
        let idle = if self.ready_count > 0 { self.idle.first().copied() } else { None };
        let held_back = if self.is_full() { None } else { self.held_back.first().copied() };
        let group = self.released.pop().or(idle).or(held_back)?;
        self.idle.remove(&group);
        self.held_back.remove(&group);
        Some(group)
    }
}

/// Hands out rays: a group takes a batch at a time, its cores the rays of it.
pub struct Feed<S> {
    source: S,
    /// The chunk that batches come from, and its next.
    open: Option<(Chunk, u32)>,
    groups: Vec<Option<Current>>,
    order: Order,
    /// Rays of the frame wait for others.
    is_ordered: bool,
    /// What the rays of batches taken have the hardware blocks do.
    pub operations: Operations,
}

impl<S: ChunkSource> Feed<S> {
    /// Nothing taken yet.
    pub fn new(source: S, groups: u32) -> Self {
        Self {
            source,
            open: None,
            groups: vec![None; groups as usize],
            order: Order::new(groups),
            is_ordered: false,
            operations: Operations::default(),
        }
    }

    /// The next ray of `group`, which is taken in cycle `now`: one that waited for another of the group's, else of the source, else one that waited for another group's. `None` when all are
    /// taken or wait for others.
    pub fn ray(&mut self, group: u32, now: u64) -> Option<FedRay> {
        let mut ray = self.order.ready(group, false).or_else(|| self.taken(group)).or_else(|| self.order.ready(group, true));
        if let Some(ray) = &mut ray {
            ray.started = now;
        }
        if ray.is_none() && self.is_ordered {
            self.order.idle.insert(group);
        }
        ray
    }

    /// The next ray of the group's batches that waits for nobody; those that wait are put aside.
    fn taken(&mut self, group: u32) -> Option<FedRay> {
        if self.is_ordered && self.order.holds_back(group) {
            return None;
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
                    let ray = FedRay { chunk: Arc::clone(&current.chunk), batch: current.batch, at, ray: at_ray as u32, started: 0 };
                    self.is_ordered |= ray.link().is_some();
                    let Some(waits_for) = self.order.waits_for(&ray) else { return Some(ray) };
                    if self.order.put_aside(waits_for, ray, group) {
                        continue;
                    }
                    return None;
                }
            }
            self.groups[group as usize] = None; // lets go of the chunk
            self.groups[group as usize] = Some(self.batch()?);
        }
    }

    /// `ray` of `group` has ended: rays that waited for it are ready, and [`Feed::released`] tells who is to ask for them.
    #[inline(always)]
    pub fn ended(&mut self, ray: &FedRay, group: u32) {
        if let Some(link) = ray.link() {
            self.order.ended(link.number, group);
        }
    }

    /// Rays wait for nobody any more, and have not been taken.
    pub fn has_ready(&self) -> bool {
        self.order.ready_count > 0
    }

    /// A group that may get rays now, if there is one: that of the ray that ended, then those that asked in vain.
    #[inline(always)]
    pub fn released(&mut self) -> Option<u32> {
        if self.is_ordered { self.order.released() } else { None }
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
