//! What follows when a resource takes a request or a line comes: the states up to the next in which the context asks for something.
//!
//! States are those of `docs/traversal-unit.md`. A result of cycle c, a grant or an answer in it, shows in registers from cycle c + 1 on. Every sequence of steps has
//! its cycles: which states a ray goes through is what its steps say. Runs of triangles that follow each other are of one leaf.

use super::context::ContextTiming;
use super::ports::{LineRequest, Steps};
use super::unit::UnitTiming;
use crate::block::Operation;
use crate::hardware::{Resource, State};
use crate::step::{Act, Step};

impl<R: Steps> UnitTiming<R> {
    /// The idle context of the lowest number takes `ray`.
    pub(super) fn take(&mut self, ray: R, now: u64) {
        let who = self.idle.trailing_zeros() as usize;
        self.idle &= self.idle - 1;
        let context = &mut self.contexts[who];
        *context = ContextTiming { ray: Some(ray), ..ContextTiming::idle() };
        self.operations.add(Operation::RaySetup, 1);
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
    pub(super) fn fetch(&mut self, who: usize, now: u64) -> (LineRequest, bool) {
        let context = &mut self.contexts[who];
        self.operations.add(Operation::NodeAddress, 1);
        let request = context.ask_line(who, now);
        if context.owed == 0 && context.state == State::Fetch {
            let (since, end) = self.fetched(who, now);
            self.port_cycles += end - since;
        }
        request
    }

    /// A block takes the request of context `who`, which was offered from `since` on; whether the context goes on asking.
    #[inline]
    pub(super) fn granted(&mut self, resource: Resource, who: usize, since: u64, now: u64) -> bool {
        let station = &mut self.stations[resource as usize];
        let context = &mut self.contexts[who];
        let result = match (resource, context.act) {
            (Resource::Child, Act::Children { shape, .. }) => station.take_for(self.nodes[shape as usize], since, now),
            _ => station.take(since, now),
        };
        match resource {
            Resource::Setup => {
                self.left(State::Setup, who, now + 1);
                self.states[State::SetupWait as usize] += result - now;
                self.onward(who, result + 1, now);
            }
            Resource::Child => {
                let Some(met) = context.act.met() else { unreachable!("asks for its act's block only") };
                self.left(State::Child, who, now + 1);
                self.states[State::ChildWait as usize] += result - now;
                // One child a cycle, and none takes one too.
                let push = u64::from(met.max(1));
                self.states[State::Push as usize] += push;
                self.onward(who, result + 1 + push, now);
            }
            Resource::Decide => {
                self.left(State::Decide, who, now + 1);
                self.states[State::DecideWait as usize] += result - now;
                self.onward(who, result + 1, now);
            }
            Resource::Lod => {
                self.left(State::Lod, who, now + 1);
                self.states[State::LodWait as usize] += result - now;
                self.onward(who, result + 1, now);
            }
            Resource::Morph => {
                self.left(State::Morph, who, now + 1);
                self.states[State::MorphWait as usize] += result - now;
                self.onward(who, result + 1, now);
            }
            Resource::Tri => {
                context.left -= 1;
                if context.hits & 1 == 1 {
                    self.hits.push(result + 1, who);
                } else {
                    context.settle(result + 1);
                }
                context.hits >>= 1;
                if context.left == 0 {
                    self.more_triangles(who);
                }
                let more = self.contexts[who].left > 0;
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
                context.enter(if context.mapped && self.hit_mapping { State::Map } else { State::Done }, result + 2);
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

    /// The line at `place` comes for context `who`.
    pub(super) fn answered(&mut self, who: usize, place: u16, now: u64) {
        let context = &mut self.contexts[who];
        if context.later.comes(place.into(), now) {
            if context.later.owed == 0 && std::mem::take(&mut context.later.waits) {
                let (state, since) = (context.state, context.entered);
                let end = context.later.ready.max(since);
                self.late[state as usize] += end - since;
                self.line_wait = Some((since, end));
                self.sleep(who, now);
            }
        } else {
            context.settle(now + 1);
            if context.owed == 0 {
                self.line_wait = Some(self.fetched(who, now));
            }
        }
    }

    /// Context `who` has all lines that it waits for in `FETCH`: from when to when it was there.
    fn fetched(&mut self, who: usize, now: u64) -> (u64, u64) {
        let (since, at) = (self.contexts[who].entered, self.contexts[who].ready + 1);
        self.left(State::Fetch, who, at);
        if let Some(at) = self.act(who, at, now) {
            self.onward(who, at, now);
        }
        (since, at)
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

    /// Triangles of the next step follow those of context `who` at once: they are of one leaf.
    fn more_triangles(&mut self, who: usize) {
        let context = &mut self.contexts[who];
        if let Act::Triangles { count, hits } = context.step().act {
            context.advance();
            Step::of(Act::Triangles { count, hits }).count(&mut self.operations);
            (context.left, context.hits) = (count, hits);
            context.owed += count;
        }
    }

    /// Context `who` takes its next steps from cycle `at` on, up to one that asks for something.
    fn onward(&mut self, who: usize, mut at: u64, now: u64) {
        loop {
            let context = &mut self.contexts[who];
            let step = context.step();
            context.advance();
            context.act = step.act;
            if step.visits {
                self.states[State::Visit as usize] += 1;
                at += 1;
            }
            let asked = std::mem::take(&mut context.later.asked);
            if let Some(fetch) = step.fetch.filter(|_| !asked) {
                context.enter_fetch(fetch, at);
                return self.sleep(who, now);
            }
            let Some(next) = self.act(who, at, now) else { return };
            at = next;
        }
    }

    /// The act of context `who` begins in cycle `at`: the cycle of its next step, or `None` if it asks for something first.
    fn act(&mut self, who: usize, at: u64, now: u64) -> Option<u64> {
        let context = &mut self.contexts[who];
        Step::of(context.act).count(&mut self.operations);
        match context.act {
            Act::Fetch | Act::Work { .. } => return Some(at),
            Act::Pop { .. } => {
                self.states[State::Pop as usize] += 1;
                return Some(at + 1);
            }
            Act::End { found, mapped } => {
                // It finds the stack empty, or wants nothing more of it.
                self.states[State::Pop as usize] += 1;
                (context.found, context.mapped) = (found > 0, mapped);
                context.enter(if found > 0 { State::DivideV } else { State::Done }, at + 1);
            }
            Act::Children { .. } => context.enter(State::Child, at),
            // Hardware without such rays takes them as if each decided for itself.
            Act::Decide if !self.has_deciders => return Some(at),
            Act::Decide => context.enter(State::Decide, at),
            // A context sees itself which edges are open, where rays are of full detail or of none.
            Act::LodTest { .. } if !self.chooses_levels => {
                self.states[State::Lod as usize] += 1;
                return Some(at + 1);
            }
            Act::LodTest { .. } => {
                context.enter(State::Lod, at);
                if self.splits_early && context.want_split(at) {
                    self.ask_for(Resource::Fetch, who, now);
                }
            }
            Act::Tessellate => context.enter(State::Morph, at),
            Act::Triangles { count, hits } => context.enter_triangles(count, hits, at),
        }
        let context = &mut self.contexts[who];
        if context.later.owed > 0 && !context.later.asked {
            context.later.waits = true;
        } else {
            self.sleep(who, now);
        }
        None
    }

    /// Context `who` was in `state` and is in the next from cycle `at` on.
    #[inline(always)]
    fn left(&mut self, state: State, who: usize, at: u64) {
        debug_assert_eq!(self.contexts[who].state, state);
        self.states[state as usize] += at - self.contexts[who].entered;
    }

    /// Context `who` sleeps until it is in its state and what its act waited for is there.
    #[inline(always)]
    fn sleep(&mut self, who: usize, now: u64) {
        let context = &self.contexts[who];
        // Lines that the next step will wait for do not hold this one back.
        let at = if context.later.asked { context.entered } else { context.entered.max(context.later.ready) };
        self.wheel.sleep(now, at, who);
    }
}
