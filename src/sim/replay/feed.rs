//! Rays of a partition's groups: what the dispatcher gave them, taken by their cores as they need it.

use super::fed_ray::FedRay;
use super::messages::{Grant, Notice, Told};
use super::prefetch::prefetch;
use crate::step::Batch;
use std::collections::VecDeque;
use std::sync::Arc;

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
