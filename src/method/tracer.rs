//! Tracing rays through any method.

use super::{Departure, Landing, SurfaceHit};
use crate::rays::Query;
use crate::step::{Act, LineCounter, NoSteps, Recorder, Step, StepSink};

/// What a method's tracer does, for any listener; compiled for each. It neither begins a ray nor ends it: a ray may go on in another model.
pub trait Trace {
    /// What `query` meets first, or, if any hit serves, meets; every step goes to `steps`, but for the ray's end.
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit>;

    /// The same for a ray whose path may go on; it starts at `from`, a hit of this method, if there is one, whatever the query's origin.
    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing>;

    /// Adds every hit of a query to `hits`, nearest first, whether any would serve or not; false from a method that finds but the closest.
    fn all(&mut self, _query: &Query, _hits: &mut Vec<SurfaceHit>) -> bool {
        false
    }

    /// Its hits are mapped to the full resolution when a ray ends ([`Act::End`]).
    fn is_mapped(&self) -> bool;

    /// How many rays it traces together.
    fn lanes(&self) -> usize {
        1
    }

    /// Traces rays together, at most [`lanes`](Self::lanes) of them; what each meets first is added to `hits`, in their order.
    fn packet<S: StepSink>(&mut self, queries: &[Query], hits: &mut Vec<Option<SurfaceHit>>, steps: &mut S) {
        hits.extend(queries.iter().map(|query| self.trace(query, steps)));
    }
}

/// Any method's tracer: one call for each ray decides which method it is, and none for each step.
///
/// All but [`Tracer::enter`] are for a whole ray, whose last step is its end.
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
    /// The same for a ray through several models that enters this one: it does not end here.
    fn enter(&mut self, query: &Query, from: Option<&Departure>, steps: &mut dyn StepSink) -> Option<Landing>;
    /// Adds every hit of a ray to `hits`, nearest first, whether any would serve or not; false from a method that finds but the closest.
    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool;
    /// How many rays it traces together.
    fn lanes(&self) -> usize {
        1
    }
    /// Traces rays together, at most [`lanes`](Self::lanes) of them, to their end; what each meets first is added to `hits`, in their order.
    fn packet(&mut self, queries: &[Query], hits: &mut Vec<Option<SurfaceHit>>, steps: &mut dyn StepSink) {
        hits.extend(queries.iter().map(|query| self.heard(query, steps)));
    }
    /// Its hits are mapped to the full resolution when a ray ends ([`Act::End`]).
    fn is_mapped(&self) -> bool;
}

/// What rays meet that follow each other, each as many together as the tracer takes.
pub fn trace_together(tracer: &mut dyn Tracer, queries: &[Query], steps: &mut dyn StepSink) -> Vec<Option<SurfaceHit>> {
    let mut hits = Vec::with_capacity(queries.len());
    queries.chunks(tracer.lanes()).for_each(|packet| tracer.packet(packet, &mut hits, steps));
    hits
}

impl<T: Trace> Tracer for T {
    fn hit(&mut self, query: &Query) -> Option<SurfaceHit> {
        self.trace(query, &mut NoSteps)
    }
    fn counted(&mut self, query: &Query, counter: &mut LineCounter<'_>) -> Option<SurfaceHit> {
        whole(self, query, counter)
    }
    fn recorded(&mut self, query: &Query, recorder: &mut Recorder) -> Option<SurfaceHit> {
        whole(self, query, recorder)
    }
    fn heard(&mut self, query: &Query, mut steps: &mut dyn StepSink) -> Option<SurfaceHit> {
        whole(self, query, &mut steps)
    }
    fn follow(&mut self, query: &Query, from: Option<&Departure>, recorder: Option<&mut Recorder>) -> Option<Landing> {
        let Some(recorder) = recorder else { return Trace::follow(self, query, from, &mut NoSteps) };
        let landing = Trace::follow(self, query, from, recorder);
        recorder.step(Step::end(landing.is_some(), Trace::is_mapped(self)));
        landing
    }
    fn enter(&mut self, query: &Query, from: Option<&Departure>, mut steps: &mut dyn StepSink) -> Option<Landing> {
        Trace::follow(self, query, from, &mut steps)
    }
    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        Trace::all(self, query, hits)
    }
    fn lanes(&self) -> usize {
        Trace::lanes(self)
    }
    fn packet(&mut self, queries: &[Query], hits: &mut Vec<Option<SurfaceHit>>, mut steps: &mut dyn StepSink) {
        let first = hits.len();
        Trace::packet(self, queries, hits, &mut steps);
        let found = hits[first..].iter().flatten().count();
        let end = Act::End { found: found as u32, mapped: Trace::is_mapped(self) }; // at most as many as a packet has
        steps.step(Step::of(end).by(queries.len() as u32));
    }
    fn is_mapped(&self) -> bool {
        Trace::is_mapped(self)
    }
}

/// A ray from its first step to its end.
#[inline(always)]
fn whole<T: Trace, S: StepSink>(tracer: &mut T, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
    let hit = tracer.trace(query, steps);
    steps.step(Step::end(hit.is_some(), tracer.is_mapped()));
    hit
}
