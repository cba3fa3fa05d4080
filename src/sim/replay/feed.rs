//! Rays of a partition's groups: what the dispatcher gave them, taken by their cores as they need it.

use super::messages::{Notice, Told};
use super::prefetch::prefetch;
use crate::step::{Batch, Link, StepWord};
use std::collections::VecDeque;
use std::sync::Arc;

/// A ray: its place among its batch's steps.
#[derive(Clone)]
pub struct FedRay {
    batch: Arc<Batch>,
    at: u32,
    /// Its number in the batch.
    ray: u32,
    /// The cycle in which it was taken.
    pub started: u64,
}

impl FedRay {
    /// Ray number `ray` of `batch`.
    pub fn new(batch: Arc<Batch>, ray: u32) -> Self {
        let at = batch.start(ray as usize);
        Self { batch, at, ray, started: 0 }
    }

    /// Its next step; a ray ends with [`Act::End`](crate::step::Act::End), after which it has none.
    #[inline(always)]
    pub fn peek(&self) -> StepWord {
        self.batch.words()[self.at as usize]
    }

    /// Its steps from the next on, and those of the rays behind it.
    #[inline(always)]
    pub fn rest(&self) -> &[StepWord] {
        &self.batch.words()[self.at as usize..]
    }

    /// Goes on by `steps`.
    #[inline(always)]
    pub fn skip(&mut self, steps: u32) {
        self.at += steps;
    }

    /// The steps behind the next are read soon.
    #[inline(always)]
    pub fn prefetch(&self) {
        prefetch(self.batch.words(), self.at as usize);
    }

    /// Its place among the rays of a frame whose rays wait for others.
    pub fn link(&self) -> Option<Link> {
        self.batch.link(self.ray as usize)
    }
}

/// What a group is given at once.
#[derive(Clone)]
pub enum Grant {
    /// A batch, none of whose rays waits for another.
    Batch(Arc<Batch>),
    /// Rays, of whatever batches.
    Rays(VecDeque<FedRay>),
}

/// What a group holds.
struct Held {
    /// On its way: in this order.
    coming: VecDeque<Grant>,
    /// Its batches, and the next ray of the first.
    batches: VecDeque<Arc<Batch>>,
    next: u32,
    rays: VecDeque<FedRay>,
    /// Rays that are left of these.
    left: u32,
    /// It asked for more; at first all have.
    asked: bool,
}

impl Held {
    fn new() -> Self {
        Self { coming: VecDeque::new(), batches: VecDeque::new(), next: 0, rays: VecDeque::new(), left: 0, asked: true }
    }

    fn take(&mut self) -> Option<FedRay> {
        if let Some(ray) = self.rays.pop_front() {
            return Some(ray);
        }
        loop {
            let batch = self.batches.front()?;
            if (self.next as usize) < batch.rays() {
                let ray = FedRay::new(Arc::clone(batch), self.next);
                // The next to be taken.
                prefetch(batch.words(), batch.end(self.next as usize) as usize);
                self.next += 1;
                return Some(ray);
            }
            self.batches.pop_front();
            self.next = 0;
        }
    }
}

/// The rays of some groups.
pub struct Feed {
    /// Their number of the first.
    first: u32,
    groups: Vec<Held>,
    /// With fewer rays left a group asks for more.
    reserve: u32,
    /// For the dispatcher.
    pub told: Vec<Told>,
}

impl Feed {
    /// Nothing yet for `count` groups from `first` on, of so many contexts each.
    pub fn new(first: u32, count: u32, contexts: u32) -> Self {
        Self { first, groups: (0..count).map(|_| Held::new()).collect(), reserve: contexts.max(1), told: Vec::new() }
    }

    /// The next ray of `group`, which is taken in cycle `now`, if it has one.
    #[inline]
    pub fn ray(&mut self, group: u32, now: u64) -> Option<FedRay> {
        let held = &mut self.groups[group as usize];
        let mut ray = held.take();
        if let Some(ray) = &mut ray {
            ray.started = now;
            held.left -= 1;
        }
        if held.left < self.reserve && !held.asked {
            held.asked = true;
            self.told.push(Told { cycle: now, group: self.first + group, notice: Notice::Asks });
        }
        ray
    }

    /// `ray` of `group` has ended in cycle `now`.
    #[inline(always)]
    pub fn ended(&mut self, ray: &FedRay, group: u32, now: u64) {
        if let Some(link) = ray.link() {
            self.told.push(Told { cycle: now, group: self.first + group, notice: Notice::Ended(link.number) });
        }
    }

    /// `group` will have a grant.
    pub fn comes(&mut self, group: u32, grant: Grant) {
        self.groups[group as usize].coming.push_back(grant);
    }

    /// It has it now.
    pub fn came(&mut self, group: u32) {
        let held = &mut self.groups[group as usize];
        held.asked = false;
        match held.coming.pop_front() {
            Some(Grant::Batch(batch)) => {
                held.left += batch.rays() as u32; // far fewer than 2^32
                held.batches.push_back(batch);
            }
            Some(Grant::Rays(rays)) => {
                held.left += rays.len() as u32;
                held.rays.extend(rays);
            }
            None => (),
        }
    }

    /// No group has or gets any.
    pub fn is_empty(&self) -> bool {
        self.groups.iter().all(|held| held.left == 0 && held.coming.is_empty())
    }
}
