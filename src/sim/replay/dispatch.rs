//! Where rays come from: batches of the functional layer, in order, given to groups as they ask.
//!
//! A group asks when it has fewer rays left than contexts; it has the next batch `delay` cycles later: as many as the shortest way back from the side that all groups share, so
//! that a replay's partitions need to hear of each other no sooner. Groups that ask in one cycle are served in their order.
//!
//! A ray that starts behind the end of another is put aside until then ([`Order`]); when the other has ended, it is among the first that the other's group gets, or
//! whoever asks and finds nothing else.

use super::fed_ray::FedRay;
use super::messages::{Grant, Granted, Notice, Told};
use super::order::Order;
use crate::step::Batch;
use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

/// Batches that were traced together.
#[derive(Clone)]
pub struct Chunk {
    batches: Arc<[Arc<Batch>]>,
    begins_frame: bool,
    is_before: bool,
}

impl Chunk {
    /// The same as the first of another frame: its rays, and those behind them, wait until all rays before have ended. Caches and memory stay as they are.
    pub fn beginning_frame(self) -> Self {
        Self { begins_frame: true, ..self }
    }

    /// The same as work that the rays of a frame wait for: the frame's first chunk is to begin one.
    pub fn before_frame(self) -> Self {
        Self { is_before: true, ..self }
    }
}

impl FromIterator<Batch> for Chunk {
    fn from_iter<I: IntoIterator<Item = Batch>>(batches: I) -> Self {
        Self { batches: batches.into_iter().map(Arc::new).collect(), begins_frame: false, is_before: false }
    }
}

impl From<Vec<Batch>> for Chunk {
    fn from(batches: Vec<Batch>) -> Self {
        batches.into_iter().collect()
    }
}

impl<const N: usize> From<[Batch; N]> for Chunk {
    fn from(batches: [Batch; N]) -> Self {
        batches.into_iter().collect()
    }
}

/// Gives the chunks of a frame, or of frames after each other, in order.
pub trait ChunkSource {
    /// The next one; `None` after the last. May wait for it.
    fn next(&mut self) -> Option<Chunk>;
}

impl<I: Iterator<Item = Chunk>> ChunkSource for I {
    fn next(&mut self) -> Option<Chunk> {
        Iterator::next(self)
    }
}

/// Hands out rays.
pub struct Dispatcher<S> {
    source: S,
    /// The chunk that batches come from, and its next.
    open: Option<(Chunk, usize)>,
    /// The first chunk of the next frame, while rays of this one are under way.
    next_frame: Option<Chunk>,
    /// By group, what is left of a batch whose rays wait for others: its next ray.
    begun: Vec<Option<(Arc<Batch>, u32)>>,
    order: Order,
    asking: BTreeSet<u32>,
    /// Contexts of a group: rays that it is given at once, but for whole batches.
    contexts: usize,
    delay: u64,
    /// What was given last is work before a frame.
    pub is_before: bool,
    /// For the groups.
    pub granted: Vec<Granted>,
}

impl<S: ChunkSource> Dispatcher<S> {
    /// Nothing given yet to `groups` of so many contexts.
    pub fn new(source: S, groups: u32, contexts: u32, delay: u64) -> Self {
        Self {
            source,
            open: None,
            next_frame: None,
            begun: vec![None; groups as usize],
            order: Order::new(groups),
            asking: BTreeSet::new(),
            contexts: contexts.max(1) as usize,
            delay,
            is_before: false,
            granted: Vec::new(),
        }
    }

    /// Gives every group its first rays, in cycle 0.
    pub fn start(&mut self) {
        for group in 0..self.begun.len() as u32 {
            match self.grant(group) {
                Some(grant) => self.granted.push(Granted { cycle: 0, group, grant }),
                None => drop(self.asking.insert(group)),
            }
        }
    }

    /// Does what was told, in the order of cycles and groups.
    pub fn hear(&mut self, told: &[Told]) {
        for &Told { cycle, group, notice } in told {
            match notice {
                Notice::Asks => {
                    self.asking.insert(group);
                    self.serve(group, cycle);
                }
                Notice::Ended(number) => {
                    self.order.ended(number, group);
                    // The group itself first; then others that asked in vain.
                    self.serve(group, cycle);
                    while self.order.has_ready()
                        && let Some(&other) = self.asking.first()
                        && self.serve(other, cycle)
                    {}
                    while let Some(other) = self.order.released() {
                        self.serve(other, cycle);
                    }
                }
            }
        }
    }

    /// Gives `group` rays if it asked and there are some.
    fn serve(&mut self, group: u32, cycle: u64) -> bool {
        if !self.asking.contains(&group) {
            return false;
        }
        let at = cycle + self.delay;
        let Some(grant) = self.grant(group) else { return false };
        self.asking.remove(&group);
        self.granted.push(Granted { cycle: at, group, grant });
        true
    }

    /// Rays that waited for others of the group, else of the source, else any that waited.
    fn grant(&mut self, group: u32) -> Option<Grant> {
        let own = self.order.own(group, self.contexts);
        if !own.is_empty() {
            return Some(Grant::Rays(own));
        }
        if let Some(grant) = self.fresh(group) {
            return Some(grant);
        }
        let others = self.order.others(self.contexts);
        (!others.is_empty()).then_some(Grant::Rays(others))
    }

    /// The group's next batch, or those of its rays that wait for nobody.
    fn fresh(&mut self, group: u32) -> Option<Grant> {
        if self.order.holds_back(group) {
            return None;
        }
        loop {
            let (batch, first) = match self.begun[group as usize].take() {
                Some(begun) => begun,
                None => (self.batch()?, 0),
            };
            if batch.rays() > 0 && batch.link(0).is_none() {
                return Some(Grant::Batch(batch));
            }
            let (mut rays, mut next, mut goes_on) = (VecDeque::new(), first, true);
            while goes_on && rays.len() < self.contexts && (next as usize) < batch.rays() {
                let ray = FedRay::new(Arc::clone(&batch), next);
                next += 1;
                match self.order.waits_for(&ray) {
                    Some(waits_for) => goes_on = self.order.put_aside(waits_for, ray, group),
                    None => rays.push_back(ray),
                }
            }
            if (next as usize) < batch.rays() {
                self.begun[group as usize] = Some((batch, next));
            }
            if !rays.is_empty() {
                return Some(Grant::Rays(rays));
            }
            if !goes_on {
                return None;
            }
        }
    }

    fn batch(&mut self) -> Option<Arc<Batch>> {
        loop {
            if let Some((chunk, next)) = &mut self.open
                && let Some(batch) = chunk.batches.get(*next)
            {
                *next += 1;
                return Some(Arc::clone(batch));
            }
            self.open = None;
            if self.next_frame.is_some() {
                return None;
            }
            let chunk = self.source.next()?;
            if chunk.begins_frame {
                self.next_frame = Some(chunk);
            } else {
                self.is_before = chunk.is_before;
                self.open = Some((chunk, 0));
            }
        }
    }

    /// All rays given have ended, the last in cycle `end`, and every group has asked for more. If there is another frame, gives them its rays, and the cycle in which they have them.
    pub fn go_to_next_frame(&mut self, end: u64) -> Option<u64> {
        let chunk = self.next_frame.take()?;
        self.is_before = chunk.is_before;
        self.open = Some((chunk, 0));
        // Rays of another frame have numbers of their own.
        self.order = Order::new(self.begun.len() as u32);
        for group in 0..self.begun.len() as u32 {
            self.serve(group, end);
        }
        Some(end + self.delay)
    }
}
