//! Rays, memory and a taker of hits around a unit, cycle by cycle: one environment for the model and for the RTL.
//!
//! In every cycle it looks at the outputs, which come from registers, and gives the inputs. A ray once offered, and what the unit offers, is held
//! until it is taken: the environment checks that. Memory answers at most once a cycle: of the answers due the one due first, then that of the
//! request taken first. What the unit must not do (an address outside of the model, a tag in use, a hit of no ray, silence) is an error.

use super::error::UnitError;
use super::memory::SceneMemory;
use super::traffic::Traffic;
use super::{Inputs, Outputs, TraversalUnit};
use crate::hardware::ports::{Corners, HitOut, MemoryAnswer, MemoryRequest, RayIn, SecondaryIn};
use crate::num::{Ray, U};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A unit with its ports: the model, its RTL, or both side by side.
pub trait UnitPort {
    /// The output ports in this cycle.
    fn outputs(&mut self) -> Outputs;
    /// The end of the cycle with these inputs.
    fn tick(&mut self, inputs: &Inputs);
    /// What every context is doing, for error messages.
    fn describe(&mut self) -> String;
}

impl UnitPort for TraversalUnit {
    fn outputs(&mut self) -> Outputs {
        Self::outputs(self)
    }
    fn tick(&mut self, inputs: &Inputs) {
        Self::tick(self, inputs);
    }
    fn describe(&mut self) -> String {
        Self::describe(self)
    }
}

/// A ray traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayReport {
    /// Cycle in which the unit took it.
    pub taken: u64,
    /// Cycle in which its hit was taken.
    pub done: u64,
    /// The hit.
    pub hit: HitOut,
    /// Corners of its triangle, from hardware whose rays can start there.
    pub corners: Corners,
}

impl RayReport {
    /// Cycles from ray to hit.
    pub fn cycles(&self) -> u64 {
        self.done - self.taken
    }
}

/// What happened at the ports.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunReport {
    /// Cycles until the last hit was taken.
    pub cycles: u64,
    /// Every ray, in the order given.
    pub rays: Vec<RayReport>,
    /// Memory requests.
    pub requests: u64,
    /// Cycles in which a memory request waited, a hit waited, and a ray waited.
    pub waited: [u64; 3],
}

/// The quiet cycles beyond the memory's latency that no unit needs: every block's latency together is far below.
const PATIENCE: u64 = 10_000;

/// Runs `rays`, whose tags are their numbers, through `unit` until all are done.
///
/// # Errors
/// The unit did something that it must not do.
pub fn run(unit: &mut impl UnitPort, memory: &SceneMemory<'_>, traffic: &Traffic, rays: &[Ray]) -> Result<RunReport, UnitError> {
    run_secondary(unit, memory, traffic, rays, &[])
}

/// The same for rays that have more than primary ones, as far as `secondary` goes.
///
/// # Errors
/// The unit did something that it must not do.
pub fn run_secondary(
    unit: &mut impl UnitPort,
    memory: &SceneMemory<'_>,
    traffic: &Traffic,
    rays: &[Ray],
    secondary: &[SecondaryIn],
) -> Result<RunReport, UnitError> {
    let mut around = Environment::new(memory, traffic, rays, secondary);
    while around.done < rays.len() {
        let outputs = unit.outputs();
        let inputs = around.inputs();
        around.check_held(&outputs)?;
        let moved = around.take(&outputs, &inputs)?;
        unit.tick(&inputs);
        around.quiet = if moved { 0 } else { around.quiet + 1 };
        if around.quiet > PATIENCE + traffic.latency.longest() {
            return Err(UnitError::Deadlock { cycle: around.cycle, quiet: around.quiet, contexts: unit.describe() });
        }
        around.cycle += 1;
    }
    Ok(around.report())
}

/// A ray on its way.
#[derive(Clone, Copy)]
enum Way {
    Waiting,
    Taken(u64),
    Done(RayReport),
}

struct Environment<'a> {
    memory: &'a SceneMemory<'a>,
    traffic: &'a Traffic,
    rays: &'a [Ray],
    secondary: &'a [SecondaryIn],
    cycle: u64,
    ways: Vec<Way>,
    /// Rays taken, and hits taken.
    next: usize,
    done: usize,
    /// A ray is being offered.
    offering: bool,
    /// Answers by the cycle they are due in, and by request.
    due: BinaryHeap<Reverse<(u64, u64, MemoryRequestBits)>>,
    outstanding: [bool; 256],
    requests: u64,
    waited: [u64; 3],
    /// What the ports offered in the last cycle and was not taken.
    held: Outputs,
    quiet: u64,
}

/// Tag, epoch and address of a request.
type MemoryRequestBits = (u64, u64, u64);

impl<'a> Environment<'a> {
    fn new(memory: &'a SceneMemory<'a>, traffic: &'a Traffic, rays: &'a [Ray], secondary: &'a [SecondaryIn]) -> Self {
        Self {
            memory,
            traffic,
            rays,
            secondary,
            cycle: 0,
            ways: vec![Way::Waiting; rays.len()],
            next: 0,
            done: 0,
            offering: false,
            due: BinaryHeap::new(),
            outstanding: [false; 256],
            requests: 0,
            waited: [0; 3],
            held: Outputs::default(),
            quiet: 0,
        }
    }

    /// The inputs of this cycle, which do not depend on its outputs.
    fn inputs(&mut self) -> Inputs {
        let cycle = self.cycle;
        self.offering |= self.next < self.rays.len() && !self.traffic.ray_gap.at(cycle);
        let ray = || RayIn { tag: U::new(self.next as u64), ray: self.rays[self.next] };
        let ray = self.offering.then(ray);
        let secondary = || self.secondary.get(self.next).copied().unwrap_or_else(SecondaryIn::primary);
        let secondary = if ray.is_some() { secondary() } else { SecondaryIn::default() };
        let due = self.due.peek().is_some_and(|Reverse((due, ..))| *due <= cycle);
        let answer = if due { self.due.pop() } else { None };
        let answer = answer.and_then(|Reverse((_, _, (tag, epoch, address)))| {
            self.outstanding[tag as usize] = false; // eight bits
            // Checked when it was asked for.
            let (tag, epoch) = (U::new(tag), U::new(epoch));
            self.memory.line(U::new(address)).map(|line| MemoryAnswer { tag, epoch, error: false, line })
        });
        let (hit_ready, mem_ready) = (!self.traffic.hit_stall.at(cycle), !self.traffic.memory_stall.at(cycle));
        Inputs { ray, secondary, hit_ready, mem_ready, answer, flush: false }
    }

    fn check_held(&self, outputs: &Outputs) -> Result<(), UnitError> {
        let not_held = |port| Err(UnitError::NotHeld { cycle: self.cycle, port });
        if self.held.mem.is_some() && outputs.mem != self.held.mem {
            return not_held("memory");
        }
        if self.held.hit.is_some() && (outputs.hit, outputs.corners) != (self.held.hit, self.held.corners) {
            return not_held("hit");
        }
        Ok(())
    }

    /// What moves over the ports in this cycle; whether anything does.
    fn take(&mut self, outputs: &Outputs, inputs: &Inputs) -> Result<bool, UnitError> {
        let mut moved = inputs.answer.is_some();
        if inputs.ray.is_some() {
            if outputs.ready {
                self.ways[self.next] = Way::Taken(self.cycle);
                self.next += 1;
                self.offering = false;
                moved = true;
            } else {
                self.waited[2] += 1;
            }
        }
        let (hit, mem) = (outputs.hit.filter(|_| !inputs.hit_ready), outputs.mem.filter(|_| !inputs.mem_ready));
        self.held = Outputs { hit, mem, corners: outputs.corners, ..Outputs::default() };
        self.waited[0] += u64::from(self.held.mem.is_some());
        self.waited[1] += u64::from(self.held.hit.is_some());
        if let Some(request) = outputs.mem.filter(|_| inputs.mem_ready) {
            self.request(&request)?;
            moved = true;
        }
        if let Some(hit) = outputs.hit.filter(|_| inputs.hit_ready) {
            self.finish(hit, outputs.corners)?;
            moved = true;
        }
        Ok(moved)
    }

    fn request(&mut self, request: &MemoryRequest) -> Result<(), UnitError> {
        let (cycle, tag, address) = (self.cycle, request.tag.get(), request.address.get());
        if self.memory.locate(request.address).is_none() {
            return Err(UnitError::Address { cycle, address, tag });
        }
        let outstanding = &mut self.outstanding[tag as usize]; // eight bits
        if std::mem::replace(outstanding, true) {
            return Err(UnitError::TagInUse { cycle, tag });
        }
        self.due.push(Reverse((cycle + self.traffic.latency.of(self.requests), self.requests, (tag, request.epoch.get(), address))));
        self.requests += 1;
        Ok(())
    }

    fn finish(&mut self, hit: HitOut, corners: Corners) -> Result<(), UnitError> {
        let (cycle, tag) = (self.cycle, hit.tag.get());
        // A tag has 32 bits.
        let way = self.ways.get_mut(tag as usize).ok_or(UnitError::StrayHit { cycle, tag })?;
        let Way::Taken(taken) = *way else { return Err(UnitError::StrayHit { cycle, tag }) };
        *way = Way::Done(RayReport { taken, done: cycle, hit, corners });
        self.done += 1;
        Ok(())
    }

    fn report(self) -> RunReport {
        let done = |way: &Way| match way {
            Way::Done(report) => Some(*report),
            _ => None,
        };
        let rays = self.ways.iter().filter_map(done).collect();
        RunReport { cycles: self.cycle, rays, requests: self.requests, waited: self.waited }
    }
}
