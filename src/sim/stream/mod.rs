//! The functional layer: what every ray of a frame does, as steps, without time.
//!
//! Which lines a ray reads does not depend on when they come, so rays are traced once, in parallel ([`FrameRays`](crate::render::FrameRays)), and their steps replayed
//! on any number of machines.

mod event;
mod record;
mod work;

pub use event::{Asking, Event, Step};
pub use record::{Layout, Recorder};

use super::energy::Operations;

/// Rays that a group of cores takes at once: a tile of the picture.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    events: Box<[Event]>,
    /// Where each ray's steps end.
    ends: Box<[u32]>,
    operations: Operations,
}

impl Batch {
    /// The rays written to `recorder`, the steps of each ending where `ends` says.
    pub fn recorded(recorder: Recorder<'_>, ends: Vec<u32>) -> Self {
        Self::of(recorder.into_events(), ends.into())
    }

    /// A batch of these rays.
    pub fn new(rays: &[Vec<Step>]) -> Self {
        let ends = rays.iter().scan(0, |end, ray| {
            *end += ray.len() as u32;
            Some(*end)
        });
        Self::of(rays.iter().flatten().map(|&step| Event::pack(step)).collect(), ends.collect())
    }

    fn of(events: Box<[Event]>, ends: Box<[u32]>) -> Self {
        let operations = work::operations(ends.len(), &events);
        Self { events, ends, operations }
    }

    /// What its rays have the hardware blocks do.
    pub fn operations(&self) -> &Operations {
        &self.operations
    }

    /// Number of rays.
    pub fn rays(&self) -> usize {
        self.ends.len()
    }

    /// The steps of all rays.
    #[inline(always)]
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Where the steps of ray `ray` end.
    #[inline(always)]
    pub fn end(&self, ray: usize) -> u32 {
        self.ends[ray]
    }

    /// Where the steps of ray `ray` begin; they end with [`Step::End`].
    #[inline(always)]
    pub fn start(&self, ray: usize) -> u32 {
        ray.checked_sub(1).map_or(0, |before| self.ends[before])
    }
}
