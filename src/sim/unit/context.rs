//! One ray under way: the state machine of `docs/traversal-unit.md` (`rtl/ray_context.sv`).
//!
//! [`Context::tick`] is the end of a cycle: every condition is on registers as they stood at its start, but for grants, results and memory lines
//! of the same cycle. What a context asks for, and with which operands, is in `operands`.

use super::closest::{Closest, Met};
use super::register::Register;
use super::wires::{Cycle, DIVIDE_FOR_T, DIVIDE_FOR_V, DIVIDE_FOR_W};
use crate::block::bary_map::NodeIndex;
use crate::block::node_deciders::{self, NodeDeciders};
use crate::block::{Block, child_test, lod_test, ray_setup, tessellate::child_triangle, tree_deciders};
use crate::format::{L0Record, VertexData};
use crate::hardware::ports::{Behind, ContextView, Epoch, Owed, RayIn, SceneConfig, SecondaryIn};
use crate::hardware::{Fetch, Hardware, RayError, State};
use crate::method::{Entry, Op, TraversalStack, is_beyond};
use crate::num::{BoundCode, Point, Ray, S_ONE, U, Wire};

/// Triangle of a node: corners and inserted vertices, of full resolution and as morphed for this ray.
#[derive(Clone, Copy, Default)]
pub struct Split {
    /// Corners of full resolution.
    f: [Point; 3],
    /// Corners as morphed.
    p: [Point; 3],
    /// Inserted vertices of full resolution.
    g: [Point; 3],
    /// Inserted vertices as morphed.
    q: [Point; 3],
}

/// The registers of a context; those with names of the RTL's `*_q`.
#[derive(Clone, Default)]
pub struct Context {
    pub state: State,
    pub fetch: Register<Fetch>,
    pub tag: U<32>,
    pub ray: Ray,
    /// What it has besides, where rays can start on a surface; else that of a primary ray.
    pub secondary: SecondaryIn,
    /// Who decides in the tree, and about the node's edges.
    pub deciders: tree_deciders::Out,
    pub by: [tree_deciders::Decider; 3],
    pub setup: ray_setup::Out,
    pub entry: Register<Entry>,
    pub tree: Register<U<28>>,
    /// Of the tree: levels that are stored, and its place among those of each level.
    pub depth: Register<U<4>>,
    pub place: U<28>,
    pub level: Register<U<4>>,
    pub node: Register<NodeIndex>,
    /// Corners of the node's triangle and its inserted vertices, at full resolution and as morphed; bound codes and edge states.
    pub f: Register<[Point; 3]>,
    pub p: Register<[Point; 3]>,
    pub g: Register<[Point; 3]>,
    pub q: Register<[Point; 3]>,
    pub e: [BoundCode; 3],
    pub lod: Register<lod_test::Out>,
    /// Lines asked for and not yet sent, and sent and not yet there, by place.
    pub want: u8,
    pub waiting: u8,
    /// Number of the ray among the context's, which its lines come back with.
    pub epoch: Epoch,
    /// Lines asked for by this ray and those before, and not there.
    pub owed: Owed,
    /// Rays before this one since there was none such.
    pub behind: Behind,
    /// An age has passed since the context rests.
    pub rested: bool,
    /// Why the ray ends early.
    pub error: Option<RayError>,
    /// Entries that it may still visit.
    pub visits_left: Register<U<32>>,
    /// A tick has passed since something came that was waited for.
    pub stale: bool,
    /// Line buffers.
    pub lines: [[u64; 4]; 2],
    /// Children still to be pushed.
    pub sorted: Register<child_test::Out>,
    pub count: Register<U<3>>,
    /// Triangle tests: of the four children, not of the node itself; still to be sent; number of the next; without a verdict yet.
    pub four: Register<bool>,
    pub left: Register<U<3>>,
    pub next: Register<U<2>>,
    pub pending: Register<U<3>>,
    pub stack: TraversalStack,
    pub closest: Closest,
    pub splits: Box<[Split]>,
    /// Entries that the stack has room for.
    pub room: usize,
    /// Of its hardware: levels that trees are stored to, bits of indices and of lines, zeros of coordinates.
    pub stored_levels: u64,
    pub index_bits: u32,
    pub coordinate_zeros: u32,
    /// Its hardware has a LOD test, and a map of hits.
    pub chooses_levels: bool,
    hit_mapping: bool,
    /// Rays can start on a surface, and others decide for them.
    from_surface: bool,
    has_deciders: bool,
}

impl Context {
    /// An idle context of this hardware.
    pub fn new(hardware: &Hardware) -> Self {
        let splits = vec![Split::default(); hardware.split_triangles() as usize].into();
        let &Hardware { hit_mapping, index_bits, coordinate_zeros, secondary: from_surface, .. } = hardware;
        let (room, stored_levels) = (hardware.stack_entries() as usize, u64::from(hardware.stored_levels()));
        let (chooses_levels, has_deciders) = (hardware.chooses_levels(), hardware.has_deciders());
        let of_hardware = Self { index_bits, coordinate_zeros, chooses_levels, hit_mapping, ..Self::default() };
        Self { splits, room, stored_levels, from_surface, has_deciders, secondary: SecondaryIn::primary(), ..of_hardware }
    }

    /// The node's children are as deep as the tree: triangles, not nodes.
    pub fn last_split(&self) -> bool {
        self.level.get().get() + 1 == self.depth.get().get()
    }

    /// The node is one of a compact model that has a split: its inserted vertices are there.
    pub fn split_has_vertices(&self, scene: &SceneConfig) -> bool {
        scene.compact && (!self.last_split() || self.level.get() == U::ZERO)
    }

    /// The corners in the line buffers, which hold an L0 record.
    pub fn record_corners(&self, scene: &SceneConfig) -> [Point; 3] {
        let corners = match scene.compact {
            true => L0Record::from_words(&self.lines[0]).corners(),
            false => VertexData::from_words(&self.lines[1]).points(),
        };
        corners.map(|point| self.kept(point))
    }

    /// Tree, level and node of triangle `number`: of this node, or its child of that number.
    pub fn triangle_id(&self, number: u16) -> [u64; 3] {
        let [tree, level, node] = [self.tree.get().get(), self.level.get().get(), self.node.get().get()];
        if self.four.get() { [tree, level + 1, node << 2 | u64::from(number)] } else { [tree, level, node] }
    }

    /// The end of a cycle of context `me`.
    pub fn tick(&mut self, me: usize, scene: &SceneConfig, cycle: &Cycle) {
        let (want, waiting) = (self.want, self.waiting);
        let asked = 1 << self.place_of(want);
        let objection = self.objection(me, scene, cycle);
        let (error, stale) = (self.error_after(me, cycle, objection), self.stale_after(me, cycle));
        let arrival = self.arrival(me, cycle).copied();
        let (owed, rested) = (self.owed_after(me, cycle), self.rests() && (cycle.age || self.rested));
        let stops = self.stops(objection);
        self.error = error;
        if let Some(&quotient) = cycle.divide.result(me)
            && quotient.what != DIVIDE_FOR_T
        {
            self.closest.divided(quotient.what == DIVIDE_FOR_V, &quotient.out);
        }
        let to = match self.state {
            _ if stops => State::Done,
            State::Idle => match cycle.ray {
                Some((owner, ray)) if owner == me => self.take(&ray, cycle),
                _ => State::Idle,
            },
            State::Setup => self.when(cycle.setup.granted(me), State::SetupWait),
            State::SetupWait => match cycle.setup.result(me) {
                Some(setup) => {
                    self.setup = *setup;
                    self.stack.clear();
                    self.stand_at(Entry::default());
                    self.visits_left.set(scene.visits);
                    self.epoch = Epoch::wrapping(self.epoch.get() + 1);
                    self.behind = if self.owed == Owed::ZERO { Behind::ZERO } else { Behind::wrapping(self.behind.get() + 1) };
                    State::Visit
                }
                None => State::SetupWait,
            },
            State::Visit => self.visit(scene),
            State::Fetch => {
                let there = want == 0 && waiting == 0;
                match self.fetch.get() {
                    Fetch::Node => self.when(there, State::Child),
                    Fetch::Record if there => self.enter_tree(scene),
                    Fetch::Record => State::Fetch,
                    // The split may still be under way where the vertices are elsewhere.
                    Fetch::Split => self.when(want == 0 && waiting & if scene.compact { 0b11 } else { 0b10 } == 0, State::Morph),
                }
            }
            State::Child => self.when(cycle.child.granted(me), State::ChildWait),
            State::ChildWait => match cycle.child.result(me) {
                Some(&sorted) => {
                    self.sorted.set(sorted);
                    self.count.set(sorted.count);
                    State::Push
                }
                None => State::ChildWait,
            },
            State::Push => self.push(),
            State::Pop => self.pop(),
            State::Decide => self.when(cycle.decide.granted(me), State::DecideWait),
            State::DecideWait => match cycle.decide.result(me) {
                Some(&deciders) => {
                    self.deciders = deciders;
                    self.look_up_deciders();
                    State::Lod
                }
                None => State::DecideWait,
            },
            State::Lod if !self.chooses_levels => self.decided(scene, self.extreme()),
            State::Lod => self.when(cycle.lod.granted(me), State::LodWait),
            State::LodWait => match cycle.lod.result(me) {
                Some(&lod) => self.decided(scene, lod),
                None => State::LodWait,
            },
            State::Morph => self.when(cycle.morph.granted(me), State::MorphWait),
            State::MorphWait => match cycle.morph.result(me) {
                Some(morphed) => {
                    let g = [morphed.g0, morphed.g1, morphed.g2];
                    // Without a LOD test nothing is morphed: of an image that no scene has, even where an edge has no bound and its vertex is not in its middle.
                    let q = if self.chooses_levels { [morphed.q0, morphed.q1, morphed.q2] } else { g };
                    self.g.set(g);
                    self.q.set(q);
                    if self.last_split() {
                        self.enter_triangles(true)
                    } else {
                        self.splits[self.level.get().get() as usize] = Split { f: self.f.get(), p: self.p.get(), g, q };
                        State::Child
                    }
                }
                None => State::MorphWait,
            },
            State::Tri => self.triangles(me, cycle),
            State::DivideV => self.when(cycle.divide.granted(me), State::DivideW),
            State::DivideW => self.when(cycle.divide.granted(me), State::DivideWait),
            State::DivideWait => self.when(cycle.divide.result(me).is_some_and(|q| q.what == DIVIDE_FOR_W), State::Sum),
            State::Sum => {
                self.closest.sum();
                if self.hit_mapping {
                    State::Map
                } else {
                    self.closest.is_finest();
                    State::Done
                }
            }
            State::Map => self.when(cycle.map.granted(me), State::MapWait),
            State::MapWait => match cycle.map.result(me) {
                Some(full) => {
                    self.closest.mapped(full);
                    State::Done
                }
                None => State::MapWait,
            },
            State::Done => self.when(cycle.hit.granted(me), State::Idle),
        };
        if cycle.fetch.granted(me) {
            self.want &= !asked;
            self.waiting |= asked;
        }
        if let Some(answer) = arrival {
            let place = answer.tag.get() as usize & 3;
            self.lines[place] = answer.line.map(U::get);
            if place == 1 {
                // Inserted vertices of full resolution lie where their line was.
                self.g.forget();
            }
            self.waiting &= !(1 << place);
        }
        self.stale = stale;
        (self.owed, self.rested) = (owed, rested);
        self.state = to;
    }

    /// It takes no ray before the lines that it is owed have come: long before an epoch comes again while a line of it may.
    pub fn rests(&self) -> bool {
        self.state == State::Idle && self.behind == Behind::MAX && self.owed != Owed::ZERO
    }

    /// It takes a ray.
    pub fn is_free(&self) -> bool {
        self.state == State::Idle && !self.rests()
    }

    /// Every line is owed until it comes, late or not. What has not come in an age of rest is given up.
    fn owed_after(&self, me: usize, cycle: &Cycle) -> Owed {
        if self.rests() && cycle.age && self.rested {
            return Owed::ZERO;
        }
        let come = u64::from(cycle.fetch.result(me).is_some() && self.owed != Owed::ZERO);
        Owed::wrapping(self.owed.get() + u64::from(cycle.fetch.granted(me)) - come)
    }

    /// What it is doing, for who looks from outside.
    pub fn view(&self) -> ContextView {
        let all = ContextView {
            state: U::new(self.state as u64),
            rests: self.rests(),
            epoch: self.epoch,
            owed: self.owed,
            stacked: U::new(self.stack.len() as u64), // 103 at most
            ..ContextView::default()
        };
        if self.state == State::Idle {
            return all;
        }
        let of_ray = ContextView { tag: self.tag, error: RayError::code(self.error), ..all };
        if matches!(self.state, State::Setup | State::SetupWait | State::Done) {
            return of_ray;
        }
        let (entry, visits) = (self.entry.get(), self.visits_left.get());
        let (want, waiting) = (U::new(self.want.into()), U::new(self.waiting.into()));
        let of_entry =
            ContextView { kind: entry.kind, level: entry.level, index: U::new(entry.index.get()), visits, want, waiting, ..of_ray };
        match self.state {
            State::Tri => ContextView { left: self.left.get(), pending: self.pending.get(), ..of_entry },
            _ => of_entry,
        }
    }

    /// A ray comes. What the one before still waited for comes too late, if at all.
    fn take(&mut self, ray: &RayIn, cycle: &Cycle) -> State {
        (self.tag, self.ray) = (ray.tag, ray.ray);
        if self.from_surface {
            self.secondary = cycle.secondary;
        }
        self.deciders = tree_deciders::Out::default();
        self.closest.clear(self.secondary.t_max);
        (self.want, self.waiting) = (0, 0);
        self.error = if cycle.flush {
            Some(RayError::Aborted)
        } else if cycle.fits {
            None
        } else {
            Some(RayError::Scene)
        };
        if self.error.is_some() { State::Done } else { State::Setup }
    }

    /// Who decides about the edges of the node.
    fn look_up_deciders(&mut self) {
        let input = node_deciders::In { tree: self.deciders, level: self.level.get(), node: self.node.get() };
        self.by = NodeDeciders::eval(&input).by;
    }

    /// The next state: `to` when something happened.
    fn when(&self, happened: bool, to: State) -> State {
        if happened { to } else { self.state }
    }

    /// What a ray of full detail, or of none, makes of the node: edges with a bound are open, or none is.
    fn extreme(&self) -> lod_test::Out {
        let open = |code: BoundCode| !self.ray.cone.is_of_no_detail() && code != BoundCode::ZERO;
        let [o0, o1, o2] = self.e.map(open);
        let state = |open| if open { U::new(S_ONE) } else { U::ZERO };
        lod_test::Out { refine: o0 || o1 || o2, s0: state(o0), s1: state(o1), s2: state(o2) }
    }

    /// It is known whether the node's triangle serves.
    fn decided(&mut self, scene: &SceneConfig, lod: lod_test::Out) -> State {
        self.lod.set(lod);
        if !lod.refine {
            self.enter_triangles(false)
        } else {
            self.fetch.set(Fetch::Split);
            self.want = match self.split_has_vertices(scene) {
                true => 0b01,
                false if self.last_split() => 0b10,
                false => 0b11,
            };
            State::Fetch
        }
    }

    fn visit(&mut self, scene: &SceneConfig) -> State {
        let entry = self.entry.get();
        self.visits_left.set(U::new(self.visits_left.get().get() - 1));
        match entry.kind.get() {
            Entry::BVH_NODE => {
                self.fetch.set(Fetch::Node);
                self.want = 0b01;
                State::Fetch
            }
            Entry::TREE => {
                self.tree.set(entry.index);
                self.by = self.deciders.edges;
                self.fetch.set(Fetch::Record);
                self.want = if scene.compact { 0b01 } else { 0b11 };
                State::Fetch
            }
            _ => {
                self.level.set(entry.level);
                // Nodes of a tree are below 4^10.
                self.node.set(U::new(entry.index.get()));
                self.e = [entry.e0, entry.e1, entry.e2];
                let parent = &self.splits[entry.level.get() as usize - 1];
                let child = entry.index.get() as usize & 3;
                self.f.set(child_triangle(parent.f, parent.g, child));
                self.p.set(child_triangle(parent.p, parent.q, child));
                self.look_up_deciders();
                State::Lod
            }
        }
    }

    /// Another entry: which corners of the triangle that was read last are its own is the entry's to say, so that one is none any more.
    fn stand_at(&mut self, entry: Entry) {
        self.entry.set(entry);
        self.f.forget();
        self.p.forget();
    }

    fn enter_tree(&mut self, scene: &SceneConfig) -> State {
        self.level.set(U::ZERO);
        self.node.set(U::ZERO);
        let corners = self.record_corners(scene);
        self.f.set(corners);
        self.p.set(corners);
        let L0Record { depth, place, e0, e1, e2, .. } = L0Record::from_words(&self.lines[0]);
        self.depth.set(depth);
        self.place = place;
        self.e = [e0, e1, e2];
        if !self.splits.is_empty() {
            // Where entries have codes the root's are kept in its own.
            self.entry.set(Entry { e0, e1, e2, ..self.entry.get() });
        }
        match depth {
            U::ZERO => self.enter_triangles(false),
            _ if self.has_deciders && self.secondary.prior => State::Decide,
            _ => State::Lod,
        }
    }

    fn push(&mut self) -> State {
        let count = self.count.get().get();
        match count {
            0 => State::Pop,
            1 => {
                self.stand_at(self.child_entry(0));
                State::Visit
            }
            _ => {
                self.stack.step(Op::Push(self.child_entry(count as usize - 1)));
                self.count.set(U::new(count - 1));
                State::Push
            }
        }
    }

    fn pop(&mut self) -> State {
        let known = self.closest.known.get();
        if self.secondary.any && known {
            return State::DivideV;
        }
        match self.stack.step(Op::Pop) {
            None if known => State::DivideV,
            None => State::Done,
            Some(top) if is_beyond(top.t_near, self.closest.t_max.get()) => State::Pop,
            Some(top) => {
                self.stand_at(top);
                State::Visit
            }
        }
    }

    fn enter_triangles(&mut self, four: bool) -> State {
        self.four.set(four);
        self.left.set(U::new(if four { 4 } else { 1 }));
        self.next.set(U::ZERO);
        self.pending.set(U::ZERO);
        State::Tri
    }

    fn triangles(&mut self, me: usize, cycle: &Cycle) -> State {
        let (left, mut pending) = (self.left.get().get(), self.pending.get().get());
        let done = left == 0 && pending == 0;
        if cycle.tri.granted(me) {
            self.left.set(U::new(left - 1));
            // Two bits: after number 3 comes no other.
            self.next.set(U::new((self.next.get().get() + 1) & 3));
            pending += 1;
        }
        if cycle.tri.result(me).is_some_and(|out| !out.test.hit) {
            pending -= 1;
        }
        if let Some((select, t, Met { number, test, .. })) = cycle.select.result(me) {
            let (id, corners) = (self.triangle_id(*number), self.triangle(usize::from(*number)));
            self.closest.select(select, [self.secondary.t_min, *t], id, test, corners);
            pending -= 1;
        }
        self.pending.set(U::new(pending));
        self.when(done, State::Pop)
    }
}
