//! A ray under way.

use super::ports::{Request, Steps, tag};
use crate::sim::stream::Step;
use crate::sim::unit::State;
use crate::traverse::Kind;

/// What a context fetches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fetch {
    /// Quad-BVH node.
    #[default]
    Node,
    /// L0 record.
    Record,
    /// Inserted vertices and, but on the last split, the children's bound data.
    Vertex,
    /// A leaf's triangles.
    Leaf,
}

/// A context. Cycles are those in which registers show something, from the start of the cycle on.
pub struct Context<R> {
    /// The ray; none if it is idle.
    pub ray: Option<R>,
    /// The state it is in, or sleeps until, and since or from when.
    pub state: State,
    pub entered: u64,
    /// What it waits for in `FETCH` or `TRI` without knowing the cycle, and the last known cycle.
    pub owed: u32,
    pub ready: u64,
    /// The same for the bound data, which `CHILD` waits for.
    pub bounds_owed: u32,
    pub bounds_ready: u64,
    pub fetch: Fetch,
    /// The line of inserted vertices, until it is asked for.
    pub split: Option<u32>,
    /// Line 0, lines still to be asked for, and the place of the next; a leaf's lines are its steps.
    pub line: u32,
    pub want: u32,
    pub place: u16,
    /// Triangles still to be tested, and which of them are met.
    pub left: u32,
    pub hits: u32,
    /// It was in a tree: a hit is mapped to the full resolution.
    pub map: bool,
    pub found: bool,
}

impl<R: Steps> Context<R> {
    /// An idle context.
    pub fn idle() -> Self {
        Self {
            ray: None,
            state: State::Idle,
            entered: 0,
            owed: 0,
            ready: 0,
            bounds_owed: 0,
            bounds_ready: 0,
            fetch: Fetch::Node,
            split: None,
            line: 0,
            want: 0,
            place: 0,
            left: 0,
            hits: 0,
            map: false,
            found: false,
        }
    }

    /// The ray's next step.
    #[inline(always)]
    pub fn step(&self) -> Step {
        self.ray.as_ref().expect("only contexts with a ray are under way").step()
    }

    /// That step is over.
    #[inline(always)]
    pub fn advance(&mut self) {
        self.ray.as_mut().expect("only contexts with a ray are under way").advance();
    }

    /// In state `state` from cycle `at` on.
    #[inline(always)]
    pub fn enter(&mut self, state: State, at: u64) {
        (self.state, self.entered) = (state, at);
    }

    /// Fetches `want` lines, the first of them `line`.
    #[inline(always)]
    pub fn enter_fetch(&mut self, fetch: Fetch, line: u32, want: u32, at: u64) {
        self.enter(State::Fetch, at);
        (self.fetch, self.line, self.want, self.place) = (fetch, line, want, 0);
        // A tree also for its bases.
        self.owed = want + u32::from(fetch == Fetch::Record);
        self.ready = at;
    }

    /// Fetches inserted vertices, which the next step is about, and the bound data of the step behind it if there is any.
    #[inline(always)]
    pub fn enter_split(&mut self, at: u64) {
        let Step::Split { line: vertices } = self.step() else { panic!("a triangle to be refined is split, not {:?}", self.step()) };
        self.advance();
        let (line, want) = if let Step::Bounds { line, .. } = self.step() { (line, 2) } else { (0, 0) };
        self.enter_fetch(Fetch::Vertex, line, want, at);
        self.split = Some(vertices);
        // The vertices must be there, but the bound data only be asked for.
        self.owed += 1;
        (self.bounds_owed, self.bounds_ready) = (want, at);
    }

    /// Tests the triangles that the next step is about.
    #[inline(always)]
    pub fn enter_triangles(&mut self, at: u64) {
        let Step::Triangles { count, hits } = self.step() else { panic!("triangles are tested here, not {:?}", self.step()) };
        self.advance();
        self.enter(State::Tri, at);
        (self.left, self.hits, self.owed, self.ready) = (count, hits, count, at);
    }

    /// It fetches an L0 record, and asks for its tree's bases too.
    pub fn fetches_tree(&self) -> bool {
        self.fetch == Fetch::Record
    }

    /// The line to ask for next, by context number `me`, which is granted in cycle `now`; and whether more are wanted.
    #[inline]
    pub fn ask_line(&mut self, me: usize, now: u64) -> (Request, bool) {
        if let Some(line) = self.split.take() {
            return (Request { tag: tag(me, 2), line, kind: Kind::VertexData }, self.want > 0);
        }
        let place = self.place;
        let mut line = self.line + u32::from(place);
        self.place += 1;
        self.want -= 1;
        let kind = match self.fetch {
            Fetch::Node => Kind::BvhNode,
            Fetch::Record => Kind::L0Record,
            Fetch::Vertex => {
                self.settle(now + 1);
                Kind::BoundData
            }
            Fetch::Leaf => {
                if let Step::Leaf { line: own } = self.step() {
                    line = own;
                    self.advance();
                }
                if let Step::Leaf { .. } = self.step() {
                    (self.want, self.owed) = (1, self.owed + 1);
                }
                Kind::Leaf
            }
        };
        (Request { tag: tag(me, place), line, kind }, self.want > 0)
    }

    /// One thing less that it waits for: it is there from cycle `at` on.
    #[inline(always)]
    pub fn settle(&mut self, at: u64) {
        self.owed -= 1;
        self.ready = self.ready.max(at);
    }
}
