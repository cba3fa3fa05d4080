//! What surrounds a unit: its rays' steps, and the three ports that can wait.

use crate::step::{Batch, SectionId, Step};
use std::ops::Deref;

/// A ray and how far it is.
pub trait Steps {
    /// The step that it takes next; behind the last, [`Act::End`](crate::step::Act::End), nobody asks.
    fn step(&self) -> Step;
    /// That step is over.
    fn advance(&mut self);
}

/// A ray of a batch.
#[derive(Clone, Copy, Debug)]
pub struct RayCursor<B> {
    batch: B,
    ray: u32,
    at: u32,
}

impl<B: Deref<Target = Batch>> RayCursor<B> {
    /// Ray number `ray` of `batch`, before its first step.
    pub fn new(batch: B, ray: u32) -> Self {
        let at = batch.start(ray as usize);
        Self { batch, ray, at }
    }

    /// The batch.
    pub fn batch(&self) -> &B {
        &self.batch
    }

    /// Its number in the batch.
    pub fn ray(&self) -> u32 {
        self.ray
    }
}

impl<B: Deref<Target = Batch>> Steps for RayCursor<B> {
    #[inline(always)]
    fn step(&self) -> Step {
        self.batch.words()[self.at as usize].step()
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.at += 1;
    }
}

/// A memory line asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineRequest {
    /// Comes back with the answer. The context is in bits 7:2; the place of the line in its record in bits 1:0 and, above the third, in 15:8: the RTL's tag wherever the
    /// RTL has one.
    pub tag: u16,
    /// The line, as the step has it.
    pub line: u32,
    /// What it holds.
    pub section: SectionId,
    /// It is written.
    pub stores: bool,
}

/// The tag of the line at `place`, below 1024, of a record that `context` asks for.
pub const fn tag(context: usize, place: u16) -> u16 {
    (place & !3) << 6 | (context as u16) << 2 | place & 3 // at most 64 contexts
}

/// Context and place of a tag.
pub(super) const fn untag(tag: u16) -> (usize, u16) {
    ((tag >> 2 & 63) as usize, tag >> 6 & !3 | tag & 3)
}

/// What surrounds a unit; asked by [`UnitTiming::tick`](super::UnitTiming::tick), each at most once a cycle.
pub trait Ports {
    /// How the unit holds a ray.
    type Ray: Steps;

    /// The ray offered in this cycle, if there is one: it is taken. Asked if a context is idle.
    fn ray(&mut self) -> Option<Self::Ray>;

    /// The memory port's request; false if it is not taken in this cycle.
    fn request(&mut self, request: LineRequest) -> bool;

    /// The hit port's ray, and whether it met anything; false if it is not taken in this cycle.
    fn hit(&mut self, ray: &Self::Ray, found: bool) -> bool;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_are_the_rtls_for_its_places_and_differ_for_all() {
        assert_eq!([tag(0, 0), tag(5, 2), tag(63, 1)], [0, 5 << 2 | 2, 63 << 2 | 1]);
        let mut seen = vec![false; 1 << 16];
        for (context, place) in (0..64).flat_map(|context| (0..1024).map(move |place| (context, place))) {
            let tag = tag(context, place);
            assert_eq!(untag(tag), (context, place));
            assert!(!std::mem::replace(&mut seen[tag as usize], true));
        }
    }
}
