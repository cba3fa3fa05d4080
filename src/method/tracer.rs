//! Tracing rays through any method.

use super::{Departure, Landing, SurfaceHit};
use crate::rays::Query;
use crate::step::{LineCounter, NoSteps, Recorder, Step, StepSink};

/// What a method's tracer does, for any listener; compiled for each.
pub trait Trace {
    /// What `query` meets first, or, if any hit serves, meets; every step goes to `steps`, the last one being the end.
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit>;

    /// The same for a ray whose path may go on; it starts at `from`, a hit of this method, if there is one, whatever the query's origin.
    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing>;
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
    /// A ray of a path, which starts at `from` if the path has hit something; its steps are kept if there is a recorder. Nothing from a method that does not
    /// [`leave`](super::Method::leaves) its surface.
    fn follow(&mut self, query: &Query, from: Option<&Departure>, recorder: Option<&mut Recorder>) -> Option<Landing>;
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
    fn follow(&mut self, query: &Query, from: Option<&Departure>, recorder: Option<&mut Recorder>) -> Option<Landing> {
        match recorder {
            Some(recorder) => Trace::follow(self, query, from, recorder),
            None => Trace::follow(self, query, from, &mut NoSteps),
        }
    }
}
