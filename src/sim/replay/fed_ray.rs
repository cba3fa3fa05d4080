//! A ray as a core has it: its steps, read one by one.

use super::prefetch::prefetch;
use crate::block::Operations;
use crate::step::{Batch, Link, StepWord};
use std::sync::Arc;

/// A ray: its place among its batch's steps.
#[derive(Clone)]
pub struct FedRay {
    batch: Arc<Batch>,
    at: u32,
    /// The first step that has not had the blocks do what it does: see [`FedRay::count`].
    counted: u32,
    /// Its number in the batch.
    ray: u32,
    /// The cycle in which it was taken.
    pub started: u64,
}

impl FedRay {
    /// Ray number `ray` of `batch`.
    pub fn new(batch: Arc<Batch>, ray: u32) -> Self {
        let at = batch.start(ray as usize);
        Self { batch, at, counted: at, ray, started: 0 }
    }

    /// It is no ray, but work before a frame.
    #[inline(always)]
    pub fn is_work(&self) -> bool {
        self.batch.is_work()
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

    /// Adds what the steps before the next have the blocks do, but for those that were added before.
    #[inline]
    pub fn count(&mut self, operations: &mut Operations) {
        let steps = &self.batch.words()[self.counted as usize..self.at as usize];
        steps.iter().for_each(|word| word.step().count(operations));
        self.counted = self.at;
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
