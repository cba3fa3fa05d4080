//! A ray under way.

use super::ports::{LineRequest, Steps, tag};
use crate::sim::unit::State;
use crate::step::{Act, Fetch, SectionId, Step};

/// A context. Cycles are those in which registers show something, from the start of the cycle on.
pub struct ContextTiming<R> {
    /// The ray; none if it is idle.
    pub ray: Option<R>,
    /// The state it is in, or sleeps until, and since or from when.
    pub state: State,
    pub entered: u64,
    /// What it does, or does when its lines are there.
    pub act: Act,
    /// What it waits for in `FETCH` or `TRI` without knowing the cycle, and the last known cycle.
    pub owed: u32,
    pub ready: u64,
    /// Lines still to be asked for: how many, the next, its place in the record, what it holds, and whether they are written.
    pub want: u32,
    pub line: u32,
    pub place: u32,
    pub section: SectionId,
    pub stores: bool,
    /// Lines of the next step, asked for with those of this one.
    pub later: Later,
    /// Triangles still to be tested, and which of them are met.
    pub left: u32,
    pub hits: u32,
    /// What the ray ends with.
    pub found: bool,
    pub mapped: bool,
}

/// Lines that were asked for together with those of the step before the one that needs them.
#[derive(Clone, Copy, Debug, Default)]
pub struct Later {
    /// They are the next step's, which asks for no others.
    pub asked: bool,
    /// Some are still to be asked for, beside what a block does: the step need not wait until they are.
    pub beside: bool,
    /// The step has begun, and waits for them.
    pub waits: bool,
    /// How many have not come, and the cycle from which the last that came is there.
    pub owed: u32,
    pub ready: u64,
    /// Places of their record, from the first on.
    first: u32,
    lines: u32,
}

impl Later {
    /// The line at `place` is one of them.
    fn has(&self, place: u32) -> bool {
        self.owed > 0 && (self.first..self.first + self.lines).contains(&place)
    }

    /// One of them comes in cycle `now`, if `place` is one's; whether it was.
    #[inline(always)]
    pub fn comes(&mut self, place: u32, now: u64) -> bool {
        let has = self.has(place);
        if has {
            self.owed -= 1;
            self.ready = now + 1;
        }
        has
    }
}

impl<R: Steps> ContextTiming<R> {
    /// An idle context.
    pub fn idle() -> Self {
        Self {
            ray: None,
            state: State::Idle,
            entered: 0,
            act: Act::Fetch,
            owed: 0,
            ready: 0,
            want: 0,
            line: 0,
            place: 0,
            section: SectionId::default(),
            stores: false,
            later: Later::default(),
            left: 0,
            hits: 0,
            found: false,
            mapped: false,
        }
    }

    /// The ray's next step.
    #[inline(always)]
    pub fn step(&self) -> Step {
        self.ray.as_ref().expect("only contexts with a ray are under way").step()
    }

    /// That step is begun.
    #[inline(always)]
    pub fn advance(&mut self) {
        self.ray.as_mut().expect("only contexts with a ray are under way").advance();
    }

    /// In state `state` from cycle `at` on.
    #[inline(always)]
    pub fn enter(&mut self, state: State, at: u64) {
        (self.state, self.entered) = (state, at);
    }

    /// Asks for the lines of a step from cycle `at` on.
    #[inline(always)]
    pub fn enter_fetch(&mut self, fetch: Fetch, at: u64) {
        self.enter(State::Fetch, at);
        self.want(fetch);
        (self.owed, self.ready) = (fetch.lines, at);
    }

    /// Tests triangles from cycle `at` on.
    #[inline(always)]
    pub fn enter_triangles(&mut self, count: u32, hits: u32, at: u64) {
        self.enter(State::Tri, at);
        (self.left, self.hits, self.owed, self.ready) = (count, hits, count, at);
    }

    #[inline(always)]
    fn want(&mut self, fetch: Fetch) {
        (self.section, self.line, self.want, self.place, self.stores) = (fetch.section, fetch.line, fetch.lines, fetch.place, fetch.stores);
    }

    /// The line to ask for next, by context number `me`, which is granted in cycle `now`; and whether more are wanted.
    #[inline]
    pub fn ask_line(&mut self, me: usize, now: u64) -> (LineRequest, bool) {
        let tag = tag(me, self.place as u16); // places have ten bits
        let request = LineRequest { tag, line: self.line, section: self.section, stores: self.stores };
        self.line += 1;
        self.place += 1;
        self.want -= 1;
        if self.later.beside {
            self.later.beside = self.want > 0;
        } else if self.later.asked {
            // They must only be asked for.
            self.settle(now + 1);
        } else if self.want == 0 {
            self.join();
        }
        (request, self.want > 0)
    }

    /// Wants the lines of the split that the LOD test is for, from cycle `at` on; whether it is for one.
    pub fn want_split(&mut self, at: u64) -> bool {
        let step = self.step();
        let Some(fetch) = step.fetch.filter(|_| step.act == Act::Tessellate && self.later.owed == 0) else { return false };
        self.want(fetch);
        self.later =
            Later { asked: true, beside: true, waits: false, owed: fetch.lines, ready: at, first: fetch.place, lines: fetch.lines };
        true
    }

    /// Goes on with the lines that are asked for together with those so far, if there are any.
    #[inline(always)]
    fn join(&mut self) {
        let step = self.step();
        let Some(fetch) = step.fetch.filter(|fetch| fetch.joins) else { return };
        self.want(fetch);
        self.owed += fetch.lines;
        if self.act == Act::Fetch {
            // What follows needs all of them.
            self.advance();
            self.act = step.act;
        } else {
            self.later = Later {
                asked: true,
                beside: false,
                waits: false,
                owed: fetch.lines,
                ready: self.entered,
                first: fetch.place,
                lines: fetch.lines,
            };
        }
    }

    /// One thing less that it waits for: it is there from cycle `at` on.
    #[inline(always)]
    pub fn settle(&mut self, at: u64) {
        self.owed -= 1;
        self.ready = self.ready.max(at);
    }
}
