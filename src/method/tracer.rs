//! Tracing rays through any method.

use super::SurfaceHit;
use crate::rays::Query;
use crate::step::{LineCounter, NoSteps, Recorder, Step, StepSink};

/// What a method's tracer does, for any listener; compiled for each.
pub trait Trace {
    /// What `query` meets first, or, if any hit serves, meets; every step goes to `steps`, the last one being the end.
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit>;
}

/// Any method's tracer: one call for each ray decides which method it is, and none for each step.
pub trait Tracer {
    /// Nobody listens.
    fn hit(&mut self, query: &Query) -> Option<SurfaceHit>;
    /// Steps and lines are counted.
    fn counted(&mut self, query: &Query, counter: &mut LineCounter<'_>) -> Option<SurfaceHit>;
    /// Steps are kept for the simulator.
    fn recorded(&mut self, query: &Query, recorder: &mut Recorder) -> Option<SurfaceHit>;
    /// Whoever listens, at a call for each step.
    fn heard(&mut self, query: &Query, steps: &mut dyn StepSink) -> Option<SurfaceHit>;
}

/// A listener behind a reference.
struct Heard<'a>(&'a mut dyn StepSink);

impl StepSink for Heard<'_> {
    fn step(&mut self, step: Step) {
        self.0.step(step);
    }
}

impl<T: Trace> Tracer for T {
    fn hit(&mut self, query: &Query) -> Option<SurfaceHit> {
        self.trace(query, &mut NoSteps)
    }
    fn counted(&mut self, query: &Query, counter: &mut LineCounter<'_>) -> Option<SurfaceHit> {
        self.trace(query, counter)
    }
    fn recorded(&mut self, query: &Query, recorder: &mut Recorder) -> Option<SurfaceHit> {
        self.trace(query, recorder)
    }
    fn heard(&mut self, query: &Query, steps: &mut dyn StepSink) -> Option<SurfaceHit> {
        self.trace(query, &mut Heard(steps))
    }
}
