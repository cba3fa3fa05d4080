//! Rays that start behind the end of others: put aside until then, and ready when the other has ended.

use super::fed_ray::FedRay;
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};

/// Most rays that are put aside: beyond, a group is given one more that is put aside and nothing else until that one is ready or there is room, so that what is held in memory
/// does not grow with the frame. The first ray that has not ended waits for none, and no group stands still before it: all go on in the end.
pub(super) const MOST_WAITING: usize = 1 << 16;

/// A ray that waits, and the group that stands still until it is ready, if one does.
struct Waiting {
    ray: FedRay,
    holds_back: Option<u32>,
}

/// Rays that wait for others.
pub struct Order {
    /// All rays before this one have ended, and so have those of `ended`.
    open: u64,
    ended: HashSet<u64>,
    /// By the ray that they wait for.
    waiting: HashMap<u64, Vec<Waiting>>,
    waiting_count: usize,
    /// Rays that wait no more, by the group in which the one ended that they waited for.
    ready: Vec<VecDeque<FedRay>>,
    ready_count: usize,
    /// Groups that stand still, and those that do no more.
    held_back: BTreeSet<u32>,
    released: Vec<u32>,
}

impl Order {
    /// None yet.
    pub fn new(groups: u32) -> Self {
        Self {
            open: 0,
            ended: HashSet::new(),
            waiting: HashMap::new(),
            waiting_count: 0,
            ready: vec![VecDeque::new(); groups as usize],
            ready_count: 0,
            held_back: BTreeSet::new(),
            released: Vec::new(),
        }
    }

    /// The ray behind whose end `ray` starts, if that is still to come.
    pub fn waits_for(&self, ray: &FedRay) -> Option<u64> {
        ray.link()?.after.filter(|after| *after >= self.open && !self.ended.contains(after))
    }

    fn is_full(&self) -> bool {
        self.waiting_count >= MOST_WAITING
    }

    /// Whether `group`, which was to have `ray`, goes on.
    pub fn put_aside(&mut self, waits_for: u64, ray: FedRay, group: u32) -> bool {
        let holds_back = self.is_full().then_some(group);
        self.held_back.extend(holds_back);
        self.waiting.entry(waits_for).or_default().push(Waiting { ray, holds_back });
        self.waiting_count += 1;
        holds_back.is_none()
    }

    /// `group` does not go on in its batches yet.
    pub fn holds_back(&mut self, group: u32) -> bool {
        if !self.is_full() {
            self.held_back.remove(&group);
        }
        self.held_back.contains(&group)
    }

    /// A ray of `group` has ended: those that waited for it are ready.
    pub fn ended(&mut self, number: u64, group: u32) {
        self.ended.insert(number);
        while self.ended.remove(&self.open) {
            self.open += 1;
        }
        let rays = self.waiting.remove(&number).unwrap_or_default();
        self.waiting_count -= rays.len();
        self.ready_count += rays.len();
        for Waiting { ray, holds_back } in rays {
            self.ready[group as usize].push_back(ray);
            if let Some(other) = holds_back
                && self.held_back.remove(&other)
            {
                self.released.push(other);
            }
        }
    }

    /// A group that stands still no more.
    pub fn released(&mut self) -> Option<u32> {
        if let Some(group) = self.released.pop() {
            return Some(group);
        }
        if self.is_full() { None } else { self.held_back.pop_first() }
    }

    /// Some rays wait no more and have not been given.
    pub fn has_ready(&self) -> bool {
        self.ready_count > 0
    }

    /// At most `most` rays that wait no more: of `group`.
    pub fn own(&mut self, group: u32, most: usize) -> VecDeque<FedRay> {
        let own = &mut self.ready[group as usize];
        let rays: VecDeque<_> = own.drain(..most.min(own.len())).collect();
        self.ready_count -= rays.len();
        rays
    }

    /// The same of the group with the most of them: half, and at most `most`.
    pub fn others(&mut self, most: usize) -> VecDeque<FedRay> {
        let Some(richest) = self.ready.iter_mut().rev().max_by_key(|rays| rays.len()) else { return VecDeque::new() };
        let rays: VecDeque<_> = richest.drain(..most.min(richest.len().div_ceil(2))).collect();
        self.ready_count -= rays.len();
        rays
    }
}
