//! What follows when a resource takes a request or a line comes: the states up to the next in which the context asks for something.
//!
//! States are those of `docs/traversal-unit.md`. A result of cycle c, a grant or an answer in it, shows in registers from cycle c + 1 on.

use super::context::{Context, Fetch};
use super::ports::{Request, Steps};
use super::unit::UnitTiming;
use crate::block::Block;
use crate::block::box_test32::BoxTest32;
use crate::block::child_sort::ChildSort;
use crate::sim::stream::Step;
use crate::sim::unit::{Resource, State};

/// Cycles of the test of a node with 32-bit boxes.
const WIDE_NODE: u64 = (BoxTest32::TIMING.latency + ChildSort::TIMING.latency) as u64;

impl<R: Steps> UnitTiming<R> {
    /// The idle context of the lowest number takes `ray`.
    pub(super) fn take(&mut self, ray: R, now: u64) {
        let who = self.idle.trailing_zeros() as usize;
        self.idle &= self.idle - 1;
        let context = &mut self.contexts[who];
        *context = Context { ray: Some(ray), ..Context::idle() };
        context.enter(State::Setup, now + 1);
        self.sleep(who, now);
    }

    /// Context `who` is done; gives its ray, and whether it met anything.
    pub(super) fn finish(&mut self, who: usize, now: u64) -> (R, bool) {
        self.left(State::Done, who, now + 1);
        self.idle |= 1 << who;
        let context = &mut self.contexts[who];
        (context.ray.take().expect("a context that is done has a ray"), context.found)
    }

    /// `node_address` takes a line of context `who`; whether it wants more.
    pub(super) fn fetch(&mut self, who: usize, now: u64) -> (Request, bool) {
        let context = &mut self.contexts[who];
        let request = context.ask_line(who, now);
        if context.owed == 0 {
            self.fetched(who, now);
        }
        request
    }

    /// A block takes the request of context `who`, which was offered from `since` on; whether the context goes on asking.
    #[inline]
    pub(super) fn granted(&mut self, resource: Resource, who: usize, since: u64, now: u64) -> bool {
        let station = &mut self.stations[resource as usize];
        let context = &mut self.contexts[who];
        if let (Resource::Child, Step::Node { wide: true, .. }) = (resource, context.step()) {
            let result = station.take_for(WIDE_NODE, since, now);
            self.tested(who, result, now);
            return false;
        }
        let result = station.take(since, now);
        match resource {
            Resource::Setup => {
                self.left(State::Setup, who, now + 1);
                self.states[State::SetupWait as usize] += result - now;
                self.onward(who, result + 1, now);
            }
            Resource::Base => {
                context.settle(result + 1);
                if context.owed == 0 {
                    self.fetched(who, now);
                }
            }
            Resource::Child => self.tested(who, result, now),
            Resource::Lod => {
                self.left(State::Lod, who, now + 1);
                self.states[State::LodWait as usize] += result - now;
                let context = &mut self.contexts[who];
                let Step::Lod { refine } = context.step() else { panic!("an LOD test here, not {:?}", context.step()) };
                context.advance();
                if refine {
                    context.enter_split(result + 1)
                } else {
                    context.enter_triangles(result + 1)
                }
                self.sleep(who, now);
            }
            Resource::Morph => {
                self.left(State::Morph, who, now + 1);
                self.states[State::MorphWait as usize] += result - now;
                let context = &mut self.contexts[who];
                if let Step::Bounds { .. } = context.step() {
                    context.enter(State::Child, result + 1);
                    if context.bounds_owed == 0 {
                        self.sleep_for_bounds(who, now);
                    }
                } else {
                    context.enter_triangles(result + 1);
                    self.sleep(who, now);
                }
            }
            Resource::Tri => {
                context.left -= 1;
                if context.hits & 1 == 1 {
                    self.hits.push(result + 1, who);
                } else {
                    context.settle(result + 1);
                }
                context.hits >>= 1;
                let more = context.left > 0;
                self.tried(who, now);
                return more;
            }
            Resource::Divide if context.state == State::DivideV => {
                self.left(State::DivideV, who, now + 1);
                self.contexts[who].enter(State::DivideW, now + 1);
                return true;
            }
            Resource::Divide => {
                self.left(State::DivideW, who, now + 1);
                self.states[State::DivideWait as usize] += result - now;
                self.states[State::Sum as usize] += 1;
                let context = &mut self.contexts[who];
                context.enter(if context.map { State::Map } else { State::Done }, result + 2);
                self.sleep(who, now);
            }
            Resource::Map => {
                self.left(State::Map, who, now + 1);
                self.states[State::MapWait as usize] += result - now;
                self.contexts[who].enter(State::Done, result + 1);
                self.sleep(who, now);
            }
            Resource::Fetch | Resource::Hit => unreachable!("ports take these"),
        }
        false
    }

    /// The children of context `who` are tested in cycle `result`.
    fn tested(&mut self, who: usize, result: u64, now: u64) {
        self.left(State::Child, who, now + 1);
        self.states[State::ChildWait as usize] += result - now;
        let context = &mut self.contexts[who];
        let (Step::Node { met, .. } | Step::Bounds { met, .. }) = context.step() else {
            panic!("children are tested, not {:?}", context.step())
        };
        context.advance();
        // One child a cycle, and none takes one too.
        let push = u64::from(met.max(1));
        self.states[State::Push as usize] += push;
        self.onward(who, result + 1 + push, now);
    }

    /// The line at `place` comes for context `who`.
    pub(super) fn answered(&mut self, who: usize, place: u16, now: u64) {
        let context = &mut self.contexts[who];
        if context.fetch == Fetch::Vertex && place < 2 {
            context.bounds_owed -= 1;
            context.bounds_ready = now + 1;
            if context.bounds_owed == 0 && context.state == State::Child {
                self.sleep_for_bounds(who, now);
            }
        } else {
            context.settle(now + 1);
            if context.owed == 0 {
                self.fetched(who, now);
            }
        }
    }

    /// Context `who` has all lines that it waits for in `FETCH`.
    fn fetched(&mut self, who: usize, now: u64) {
        let at = self.contexts[who].ready + 1;
        self.left(State::Fetch, who, at);
        let context = &mut self.contexts[who];
        match (context.fetch, context.step()) {
            (Fetch::Node, _) => context.enter(State::Child, at),
            (Fetch::Record, Step::Lod { .. }) => context.enter(State::Lod, at),
            (Fetch::Record | Fetch::Leaf, _) => context.enter_triangles(at),
            (Fetch::Vertex, _) => context.enter(State::Morph, at),
        }
        self.sleep(who, now);
    }

    /// The comparison of a hit of context `who` ends in cycle `result`.
    pub(super) fn selected(&mut self, who: usize, result: u64, now: u64) {
        self.contexts[who].settle(result + 1);
        self.tried(who, now);
    }

    /// Goes on if all triangles of context `who` are through.
    fn tried(&mut self, who: usize, now: u64) {
        let context = &self.contexts[who];
        if context.owed == 0 {
            let at = context.ready + 1;
            self.left(State::Tri, who, at);
            self.onward(who, at, now);
        }
    }

    /// From cycle `at` on context `who` is in `POP`, or in `VISIT` of the node that its next step is about.
    fn onward(&mut self, who: usize, mut at: u64, now: u64) {
        let context = &mut self.contexts[who];
        loop {
            match context.step() {
                Step::Pop { dropped } => {
                    context.advance();
                    self.states[State::Pop as usize] += 1;
                    at += 1;
                    if !dropped {
                        break;
                    }
                }
                Step::End { found } => {
                    self.states[State::Pop as usize] += 1;
                    context.found = found;
                    context.enter(if found { State::DivideV } else { State::Done }, at + 1);
                    return self.sleep(who, now);
                }
                _ => break,
            }
        }
        self.states[State::Visit as usize] += 1;
        at += 1;
        match context.step() {
            Step::Node { line, wide, .. } => context.enter_fetch(Fetch::Node, line, if wide { 4 } else { 2 }, at),
            Step::Tree { line } => {
                context.advance();
                context.map = true;
                context.enter_fetch(Fetch::Record, line, 2, at);
            }
            Step::Leaf { .. } => context.enter_fetch(Fetch::Leaf, 0, 1, at),
            Step::Lod { .. } => context.enter(State::Lod, at),
            step => panic!("a node is visited here, not {step:?}"),
        }
        self.sleep(who, now);
    }

    /// Context `who` was in `state` and is in the next from cycle `at` on.
    #[inline(always)]
    fn left(&mut self, state: State, who: usize, at: u64) {
        debug_assert_eq!(self.contexts[who].state, state);
        self.states[state as usize] += at - self.contexts[who].entered;
    }

    /// Context `who` sleeps until it enters its state.
    #[inline(always)]
    fn sleep(&mut self, who: usize, now: u64) {
        self.wheel.sleep(now, self.contexts[who].entered, who);
    }

    /// Context `who` sleeps until it may ask for the test of its children.
    #[inline(always)]
    fn sleep_for_bounds(&mut self, who: usize, now: u64) {
        let context = &self.contexts[who];
        self.wheel.sleep(now, context.entered.max(context.bounds_ready), who);
    }
}
