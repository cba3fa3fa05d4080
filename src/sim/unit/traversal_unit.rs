//! The whole unit: contexts, arbiters, blocks, and the way of hits (`rtl/traversal_unit.sv`).

use super::arbiter::Arbiter;
use super::closest::Met;
use super::context::Context;
use super::fitted::Fitted;
use super::register::{Pipeline, Register, Stage};
use super::wires::{Cycle, DIVIDE_FOR_T, Link, Quotient, Served, Wires};
use crate::block::bary_map::BaryMap;
use crate::block::child_test::ChildTest;
use crate::block::hit_select::HitSelect;
use crate::block::lod_test_by::LodTestBy;
use crate::block::node_address::{self, NodeAddress};
use crate::block::start_divide::{self, StartDivide};
use crate::block::start_setup::StartSetup;
use crate::block::start_test::{self, StartTest};
use crate::block::tessellate::Tessellate;
use crate::block::tree_deciders::TreeDeciders;
use crate::hardware::Resource;
use crate::hardware::ports::{
    Behind, ContextView, Corners, Epoch, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn, UnitCounters,
};
use crate::hardware::{Hardware, State};
use crate::num::{RayT, U, Wire};
use std::collections::VecDeque;

/// Output ports in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// `ready_o`: a ray would be taken.
    pub ready: bool,
    /// `valid_o` and `out_o`.
    pub hit: Option<HitOut>,
    /// `corners_o`, with the hit; all 0 where rays cannot start there.
    pub corners: Corners,
    /// `mem_valid_o` and `mem_o`.
    pub mem: Option<MemoryRequest>,
    /// `busy_o`: some ray is under way, or something waits at a port.
    pub busy: bool,
}

/// Input ports in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// `valid_i` and `in_i`.
    pub ray: Option<RayIn>,
    /// `secondary_i`, with the ray.
    pub secondary: SecondaryIn,
    /// `ready_i`.
    pub hit_ready: bool,
    /// `mem_ready_i`.
    pub mem_ready: bool,
    /// `mem_valid_i` and `mem_i`.
    pub answer: Option<MemoryAnswer>,
    /// `flush_i`: every ray under way ends.
    pub flush: bool,
}

/// The unit.
pub struct TraversalUnit {
    pub(super) hardware: Hardware,
    pub(super) scene: SceneConfig,
    /// Cycles since the last tick of the limit of answers.
    ticks: u64,
    /// Ticks since the last age.
    age_ticks: Behind,
    pub(super) contexts: Vec<Context>,
    arbiters: [Arbiter; Resource::COUNT],
    pub(super) ray_setup: Fitted<StartSetup>,
    pub(super) node_address: Pipeline<NodeAddress>,
    pub(super) child_test: Pipeline<ChildTest>,
    pub(super) tree_deciders: Pipeline<TreeDeciders>,
    pub(super) lod_test: Fitted<LodTestBy>,
    pub(super) tessellate: Pipeline<Tessellate>,
    pub(super) tri_test: Fitted<StartTest>,
    pub(super) hit_divide: Fitted<StartDivide>,
    pub(super) hit_select: Pipeline<HitSelect>,
    pub(super) bary_map: Pipeline<BaryMap>,
    /// Hits on their way from the triangle test to the division.
    pub(super) queue: VecDeque<Met>,
    /// Hits in the division, the oldest first, and the one in the comparison with its t.
    dividing: VecDeque<Met>,
    pub(super) chosen: Register<(Met, RayT)>,
    /// An answer on its way to the contexts, where results have a register.
    answer: Option<MemoryAnswer>,
    /// The hit port's register.
    pub(super) hit: Stage<(HitOut, Corners)>,
    /// `counters_o`.
    counters: UnitCounters,
    pub(super) cycles: u64,
    pub(super) states: [u64; State::Done as usize + 1],
    pub(super) longest_queue: usize,
}

impl TraversalUnit {
    /// A unit behind its reset.
    ///
    /// # Panics
    /// There is no such hardware ([`Hardware::validate`]).
    pub fn new(config: Hardware, scene: SceneConfig) -> Self {
        config.validate().unwrap_or_else(|error| panic!("{error}"));
        Self {
            hardware: config,
            scene,
            ticks: 0,
            age_ticks: Behind::ZERO,
            contexts: vec![Context::new(&config); config.contexts],
            arbiters: Default::default(),
            ray_setup: Fitted::linked(&config, config.setup_copies),
            node_address: Pipeline::new(&config),
            child_test: Pipeline::linked(&config),
            tree_deciders: Pipeline::linked(&config),
            lod_test: Fitted::linked(&config, 1),
            tessellate: Pipeline::linked(&config),
            tri_test: Fitted::linked(&config, 1),
            hit_divide: Fitted::linked(&config, config.divide_copies),
            hit_select: Pipeline::new(&config),
            bary_map: Pipeline::linked(&config),
            queue: VecDeque::new(),
            dividing: VecDeque::new(),
            chosen: Register::default(),
            answer: None,
            hit: Stage::default(),
            counters: UnitCounters::default(),
            cycles: 0,
            states: Default::default(),
            longest_queue: 0,
        }
    }

    /// `scene_i` from this cycle on.
    pub fn set_scene(&mut self, scene: SceneConfig) {
        self.scene = scene;
    }

    /// The end of a cycle in which `rst_ni` is low.
    pub fn reset(&mut self) {
        *self = Self::new(self.hardware, self.scene);
    }

    /// The output ports in this cycle.
    pub fn outputs(&self) -> Outputs {
        // Context and place, and the epoch, eight bits each.
        let request = |(out, tag): (node_address::Out, u16)| MemoryRequest {
            tag: U::new(u64::from(tag >> Epoch::WIDTH)),
            epoch: Epoch::wrapping(tag.into()),
            address: out.address,
        };
        let ((hit, corners), mem) = (self.hit.offered().unzip(), self.node_address.offered().map(request));
        Outputs {
            ready: self.contexts.iter().any(Context::is_free),
            hit,
            corners: corners.filter(|_| self.hardware.secondary).unwrap_or_default(),
            mem,
            busy: self.contexts.iter().any(|c| c.state != State::Idle) || hit.is_some() || mem.is_some(),
        }
    }

    /// How many contexts it has.
    pub fn contexts(&self) -> usize {
        self.contexts.len()
    }

    /// `view_o` for this context: all 0 if there is none of that number.
    pub fn view(&self, context: usize) -> ContextView {
        self.contexts.get(context).map(Context::view).unwrap_or_default()
    }

    /// `counters_o`.
    pub fn counters(&self) -> UnitCounters {
        self.counters
    }

    /// `counters_clear_i`, in the cycle that has just ended.
    pub fn clear_counters(&mut self) {
        self.counters = UnitCounters::default();
    }

    /// Tag of the ray that context `context` has, if it is not idle.
    pub fn ray_tag(&self, context: usize) -> Option<u64> {
        self.contexts.get(context).filter(|c| c.state != State::Idle).map(|c| c.tag.get())
    }

    /// Tag of the ray that asks for this line, if it is still under way.
    pub fn owner(&self, request: &MemoryRequest) -> Option<u64> {
        let context = self.contexts.get(request.tag.get() as usize >> 2)?; // eight bits
        // A ray that has not asked for anything still has the epoch of the one before.
        let has_asked = !matches!(context.state, State::Idle | State::Setup | State::SetupWait);
        (has_asked && context.epoch == request.epoch).then(|| context.tag.get())
    }

    /// The end of a cycle.
    pub fn tick(&mut self, inputs: &Inputs) {
        let wires = self.wires(inputs);
        self.commit(inputs, &wires);
    }

    /// Everything that is combinational in this cycle.
    pub(super) fn wires(&self, inputs: &Inputs) -> Wires {
        let mut asking = [0u64; Resource::COUNT];
        for (k, context) in self.contexts.iter().enumerate() {
            context.requests(|resource| asking[resource as usize] |= 1 << k);
        }
        let winner = |resource| self.arbiters[resource as usize].winner(asking[resource as usize]);
        let scene = &self.scene;
        // Six bits, and two of triangle number or place.
        let numbered = |k: usize, number: u16| (k as u16) << 2 | number;

        let queue_empty = self.queue.is_empty();
        let divide_ready = self.hit_divide.ready();
        let divide = match self.queue.front() {
            Some(head) => {
                let start_test::Out { test, below } = head.test;
                let input = start_divide::In { numerator: test.t_num, low: below.t, denominator: test.det };
                let tag = DIVIDE_FOR_T << 8 | numbered(head.owner, head.number);
                Link { input: Some((input, tag)), ready: divide_ready, winner: None }
            }
            None => self.link(winner(Resource::Divide), divide_ready, |c, k| {
                let (what, input) = c.divide_in();
                (input, what << 8 | numbered(k, 0))
            }),
        };
        let select = self.hit_divide.offered().filter(|&(_, tag)| tag >> 8 == DIVIDE_FOR_T).map(|(out, tag)| {
            let owner = usize::from(tag >> 2 & 63);
            let front = self.dividing.front().is_some_and(|met| met.test.test.front);
            (self.contexts[owner].select_in(scene, tag & 3, out.quotient, front), tag >> 2 & 63)
        });
        Wires {
            asking,
            take: inputs.ray.and_then(|_| self.contexts.iter().position(Context::is_free)),
            setup: self.link(winner(Resource::Setup), self.ray_setup.ready(), |c, k| (c.setup_in(), k as u16)),
            fetch: self.link(winner(Resource::Fetch), self.node_address.ready(inputs.mem_ready), |c, k| {
                (c.fetch_in(scene), numbered(k, c.place_of(c.want)) << Epoch::WIDTH | c.epoch.get() as u16)
            }),
            child: self.link(winner(Resource::Child), self.child_test.ready(true), |c, k| (c.child_in(), k as u16)),
            decide: self.link(winner(Resource::Decide), self.tree_deciders.ready(true), |c, k| (c.decide_in(), k as u16)),
            lod: self.link(winner(Resource::Lod), self.lod_test.ready(), |c, k| (c.lod_in(scene), k as u16)),
            morph: self.link(winner(Resource::Morph), self.tessellate.ready(true), |c, k| (c.morph_in(scene), k as u16)),
            tri: self.link(winner(Resource::Tri), self.tri_test.ready(), |c, k| {
                let number = c.next.get().get() as u16; // two bits
                (c.tri_in(), numbered(k, number))
            }),
            divide,
            queue_pop: divide_ready && !queue_empty,
            select: Link { input: select, ready: true, winner: None },
            map: self.link(winner(Resource::Map), self.bary_map.ready(true), |c, k| (c.map_in(scene), k as u16)),
            hit: self.link(winner(Resource::Hit), self.hit.ready(inputs.hit_ready), |c, _| (c.hit_out(), 0)),
        }
    }

    /// What the counters see of a cycle.
    fn count(&mut self, inputs: &Inputs, w: &Wires) {
        let Outputs { ready, hit, mem, busy, .. } = self.outputs();
        let done = hit.filter(|_| inputs.hit_ready);
        let c = &mut self.counters;
        let add = |count: &mut U<32>, happened: bool| *count = U::wrapping(count.get() + u64::from(happened));
        add(&mut c.cycles, true);
        add(&mut c.busy, busy);
        add(&mut c.rays, inputs.ray.is_some() && ready);
        add(&mut c.hits, done.is_some_and(|hit| hit.found));
        add(&mut c.misses, done.is_some_and(|hit| !hit.found && hit.error().is_none()));
        add(&mut c.errors, done.is_some_and(|hit| hit.error().is_some()));
        add(&mut c.requests, mem.is_some() && inputs.mem_ready);
        add(&mut c.answers, inputs.answer.is_some());
        add(&mut c.compared, w.select.input.is_some());
        add(&mut c.rays_wait, inputs.ray.is_some() && !ready);
        add(&mut c.hits_wait, hit.is_some() && !inputs.hit_ready);
        add(&mut c.requests_wait, mem.is_some() && !inputs.mem_ready);
        for (k, granted) in w.granted().into_iter().enumerate() {
            add(&mut c.taken[k], granted.is_some());
            add(&mut c.refused[k], w.asking[k] != 0 && granted.is_none());
        }
    }

    fn link<I>(&self, winner: Option<usize>, ready: bool, input: impl FnOnce(&Context, usize) -> (I, u16)) -> Link<I> {
        Link { input: winner.map(|k| input(&self.contexts[k], k)), ready, winner }
    }

    fn commit(&mut self, inputs: &Inputs, w: &Wires) {
        let plain = |tag: u16| usize::from(tag);
        let owner = |tag: u16| usize::from(tag >> 2 & 63);
        let tri = self.tri_test.offered();
        let divided = self.hit_divide.offered();
        let tick = self.ticks >= self.scene.answer_limit.get();
        let age = tick && self.age_ticks == Behind::MAX;
        self.count(inputs, w);
        let answer = if self.hardware.registers_results() { std::mem::replace(&mut self.answer, inputs.answer) } else { inputs.answer };
        let cycle = Cycle {
            ray: w.take.zip(inputs.ray),
            secondary: inputs.secondary,
            fits: self.hardware.takes(&self.scene),
            flush: inputs.flush,
            tick,
            age,
            setup: Served { granted: w.setup.granted(), result: self.ray_setup.offered().map(|(out, tag)| (plain(tag), out)) },
            fetch: Served { granted: w.fetch.granted(), result: answer.map(|a| (a.tag.get() as usize >> 2, a)) }, // 8 bits
            child: Served { granted: w.child.granted(), result: self.child_test.offered().map(|(out, tag)| (plain(tag), out)) },
            decide: Served { granted: w.decide.granted(), result: self.tree_deciders.offered().map(|(out, tag)| (plain(tag), out)) },
            lod: Served { granted: w.lod.granted(), result: self.lod_test.offered().map(|(out, tag)| (plain(tag), out)) },
            morph: Served { granted: w.morph.granted(), result: self.tessellate.offered().map(|(out, tag)| (plain(tag), out)) },
            tri: Served { granted: w.tri.granted(), result: tri.map(|(out, tag)| (owner(tag), out)) },
            divide: Served {
                granted: w.divide.granted(),
                result: divided.map(|(out, tag)| (owner(tag), Quotient { what: tag >> 8, out })),
            },
            select: Served {
                granted: None,
                result: self.hit_select.offered().map(|(out, tag)| {
                    let (met, t) = self.chosen.get();
                    (plain(tag), (out, t, met))
                }),
            },
            map: Served { granted: w.map.granted(), result: self.bary_map.offered().map(|(out, tag)| (plain(tag), out)) },
            hit: Served { granted: w.hit.granted(), result: None },
        };

        self.cycles += 1;
        self.ticks = if tick { 0 } else { self.ticks + 1 };
        self.age_ticks = Behind::wrapping(self.age_ticks.get() + u64::from(tick));
        for (k, context) in self.contexts.iter_mut().enumerate() {
            self.states[context.state as usize] += 1;
            context.tick(k, &self.scene, &cycle);
        }
        for (resource, granted) in Resource::ALL.into_iter().zip(w.granted()) {
            if let Some(winner) = granted {
                self.arbiters[resource as usize].took(winner);
            }
        }

        // A hit follows its division, and then its comparison.
        if let Some((out, tag)) = divided
            && tag >> 8 == DIVIDE_FOR_T
            && let Some(met) = self.dividing.pop_front()
        {
            self.chosen.set((met, out.quotient));
        }
        if w.queue_pop
            && let Some(head) = self.queue.pop_front()
        {
            self.dividing.push_back(head);
        }
        if let Some((test, tag)) = tri
            && test.test.hit
        {
            self.queue.push_back(Met { owner: owner(tag), number: tag & 3, test });
            self.longest_queue = self.longest_queue.max(self.queue.len());
        }

        self.ray_setup.tick(input(&w.setup));
        self.node_address.tick(input(&w.fetch), inputs.mem_ready);
        self.child_test.tick(input(&w.child), true);
        self.tree_deciders.tick(input(&w.decide), true);
        self.lod_test.tick(input(&w.lod));
        self.tessellate.tick(input(&w.morph), true);
        self.tri_test.tick(input(&w.tri));
        self.hit_divide.tick(input(&w.divide));
        self.hit_select.tick(input(&w.select), true);
        self.bary_map.tick(input(&w.map), true);
        self.hit.tick(w.hit.input.map(|(hit, _)| hit), inputs.hit_ready);
    }
}

/// The input of a link as a pipeline takes it.
fn input<I>(link: &Link<I>) -> Option<(&I, u16)> {
    link.input.as_ref().map(|(input, tag)| (input, *tag))
}
