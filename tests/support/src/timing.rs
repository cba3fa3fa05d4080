//! Rays as steps, and what drives the timing of a unit with them: the environment of the cycle model, or events alone.

use lodray::hardware::Hardware;
use lodray::hardware::ports::{HitOut, MemoryRequest};
use lodray::method::ClosestHit;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::{Ray, U};
use lodray::sim::timing::{LineRequest, Ports, RayCursor, UnitTiming};
use lodray::sim::unit::environment::UnitPort;
use lodray::sim::unit::{Inputs, Outputs, SceneMemory};
use lodray::step::{Batch, Recorder};
use std::collections::VecDeque;

/// What `rays` do in `image`.
pub fn steps_of(image: LodImage<'_>, rays: &[Ray]) -> Batch {
    let mut recorder = Recorder::default();
    let mut traverser = LodTraverser::new(image);
    rays.iter().for_each(|ray| traverser.trace(ray, &mut recorder, &mut ClosestHit::new(image.levels)));
    recorder.batch()
}

/// A unit's timing at the ports of the cycle model.
pub struct Timed<'a> {
    pub unit: UnitTiming<RayCursor<&'a Batch>>,
    pub ticks: u64,
    batch: &'a Batch,
    memory: &'a SceneMemory<'a>,
    cycle: u64,
    /// Only cycles that need it are ticked.
    skip: bool,
}

impl<'a> Timed<'a> {
    pub fn new(config: Hardware, memory: &'a SceneMemory<'a>, batch: &'a Batch, skip: bool) -> Self {
        Self { unit: UnitTiming::new(config), ticks: 0, batch, memory, cycle: 0, skip }
    }

    fn memory_request(&self, request: LineRequest) -> MemoryRequest {
        MemoryRequest { tag: U::new(request.tag.into()), address: self.memory.address(request.line), ..MemoryRequest::default() }
    }
}

/// The inputs of a cycle.
struct Given<'a, 'b> {
    batch: &'a Batch,
    inputs: &'b Inputs,
}

impl<'a> Ports for Given<'a, '_> {
    type Ray = RayCursor<&'a Batch>;
    fn ray(&mut self) -> Option<Self::Ray> {
        self.inputs.ray.map(|ray| RayCursor::new(self.batch, ray.tag.get() as u32))
    }
    fn request(&mut self, _: LineRequest) -> bool {
        self.inputs.mem_ready
    }
    fn hit(&mut self, _: &Self::Ray, _: bool) -> bool {
        self.inputs.hit_ready
    }
}

impl UnitPort for Timed<'_> {
    fn outputs(&mut self) -> Outputs {
        let hit = |(ray, found): (&RayCursor<_>, bool)| HitOut { tag: U::new(ray.ray().into()), found, ..HitOut::default() };
        Outputs {
            ready: self.unit.is_ready(),
            hit: self.unit.hit().map(hit),
            mem: self.unit.request(self.cycle).map(|request| self.memory_request(request)),
            ..Outputs::default()
        }
    }
    fn tick(&mut self, inputs: &Inputs) {
        let Outputs { ready, hit, mem, .. } = self.outputs();
        // An answer may be told before or behind the tick of its cycle.
        let early = self.cycle & 1 == 0;
        let answer = |unit: &mut UnitTiming<_>, when: bool| {
            if let Some(answer) = inputs.answer.filter(|_| when) {
                unit.answer(self.cycle, answer.tag.get() as u16);
            }
        };
        answer(&mut self.unit, early);
        let moves = ready && inputs.ray.is_some() || mem.is_some() && inputs.mem_ready || hit.is_some() && inputs.hit_ready;
        if !self.skip || moves || self.unit.next() == Some(self.cycle) {
            self.unit.tick(self.cycle, &mut Given { batch: self.batch, inputs });
            self.ticks += 1;
        }
        answer(&mut self.unit, !early);
        self.cycle += 1;
    }
    fn describe(&mut self) -> String {
        format!("next tick in cycle {:?}", self.unit.next())
    }
}

/// A memory that always takes a request and answers after the same cycles, and rays and takers of hits that are always there.
pub struct Smooth<'a> {
    batch: &'a Batch,
    latency: u64,
    cycle: u64,
    next: u32,
    due: VecDeque<(u64, u16)>,
    /// Cycles in which rays were taken and their hits.
    pub rays: Vec<(u64, u64)>,
    pub done: usize,
    pub requests: u64,
    pub ticks: u64,
}

impl<'a> Ports for Smooth<'a> {
    type Ray = RayCursor<&'a Batch>;
    fn ray(&mut self) -> Option<Self::Ray> {
        let ray = (self.rays.len() < self.batch.rays()).then(|| RayCursor::new(self.batch, self.next))?;
        self.rays.push((self.cycle, 0));
        self.next += 1;
        Some(ray)
    }
    fn request(&mut self, request: LineRequest) -> bool {
        self.due.push_back((self.cycle + self.latency, request.tag));
        self.requests += 1;
        true
    }
    fn hit(&mut self, ray: &Self::Ray, _: bool) -> bool {
        self.rays[ray.ray() as usize].1 = self.cycle;
        self.done += 1;
        true
    }
}

impl<'a> Smooth<'a> {
    pub fn new(batch: &'a Batch, latency: u64) -> Self {
        Self { batch, latency, cycle: 0, next: 0, due: VecDeque::new(), rays: Vec::new(), done: 0, requests: 0, ticks: 0 }
    }

    /// Takes all rays through `unit`; the cycles until the last hit was taken.
    pub fn run(&mut self, unit: &mut UnitTiming<RayCursor<&'a Batch>>) -> u64 {
        let mut next = unit.tick(0, self);
        while self.done < self.batch.rays() {
            let answer = self.due.front().map(|due| due.0);
            self.cycle = next.into_iter().chain(answer).min().expect("a unit with rays goes on");
            if answer == Some(self.cycle)
                && let Some((_, tag)) = self.due.pop_front()
            {
                unit.answer(self.cycle, tag);
                next = unit.next();
            }
            if next == Some(self.cycle) {
                next = unit.tick(self.cycle, self);
                self.ticks += 1;
            }
        }
        self.cycle + 1
    }
}
