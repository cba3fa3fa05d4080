//! Traversal units that take the cycles of the RTL ([`timing`](crate::sim::timing)): each is a port of its group's L1, and holds as many rays as it has contexts.
//!
//! A unit's request that finds its bank's queue full is taken when there is room, which the unit sees in the cycle after; of lines that come in one cycle, a unit takes the
//! first, and each other a cycle later.

use super::FrontEnd;
use super::counts::Supplier;
use super::event::{Ask, Asked};
use super::fed_ray::FedRay;
use super::feed::Feed;
use super::group_side::GroupSide;
use super::slots::Slots;
use super::stalls::Cause;
use crate::block::Operations;
use crate::hardware::{Resource, State};
use crate::machine::Machine;
use crate::sim::timing::{LineRequest, Phases, Ports, Steps, UnitTiming};
use crate::sim::unit::UnitCounts;
use crate::step::Step;
use std::collections::VecDeque;

/// Bits of a unit's tag in the number of who waits for a line.
const TAG_BITS: u32 = 16;

/// Most units: their numbers and tags are an event's number.
pub const MOST_UNITS: u64 = 1 << 12;

impl Steps for FedRay {
    #[inline(always)]
    fn step(&self) -> Step {
        self.peek().step()
    }

    #[inline(always)]
    fn advance(&mut self) {
        self.skip(1);
    }
}

/// A unit and its port.
struct Unit {
    timing: UnitTiming<FedRay>,
    /// The cycle of its next wake, if one is entered.
    wake: Option<u64>,
    /// The first cycle without a tick.
    free: u64,
    port: RequestPort,
    /// Lines that came in the cycle of another, and when each is taken.
    come: VecDeque<(u64, u16)>,
    answers: Slots,
}

/// A unit's way to its L1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RequestPort {
    /// Takes a request.
    Free,
    /// Holds one until its bank has room.
    Held,
    /// The request it held is taken, which the unit is to be told.
    Taken,
}

/// All units.
pub struct Units {
    feed: Feed,
    units: Vec<Unit>,
    per_group: u32,
    /// Lines that a unit takes in a cycle.
    answers: u32,
    under_way: u64,
}

impl Units {
    /// The units of `machine`, whose groups are those from `first` on.
    pub fn new(machine: &Machine, first: u32) -> Self {
        let (groups, per_group) = (machine.cores.groups, machine.units.per_group);
        let unit = |_| Unit {
            timing: UnitTiming::new(machine.units.config()).easing(machine.units.eased),
            wake: None,
            free: 0,
            port: RequestPort::Free,
            come: VecDeque::new(),
            answers: Slots::default(),
        };
        let units = (0..groups * per_group).map(unit).collect();
        let answers = if machine.units.eased.has(Resource::Fetch) { u32::MAX } else { 1 };
        Self { feed: Feed::new(first, groups, contexts_of_group(machine)), units, per_group, answers, under_way: 0 }
    }

    /// What all units did in `cycles` cycles.
    pub fn counts(&self, cycles: u64) -> UnitCounts {
        let mut sum = UnitCounts::default();
        self.units.iter().for_each(|unit| sum.add(&unit.timing.counts(cycles)));
        sum
    }

    /// How full the parts of each unit were in `cycles` cycles.
    pub fn phases(&self, cycles: u64) -> impl Iterator<Item = Phases> {
        self.units.iter().map(move |unit| unit.timing.phases(cycles))
    }

    /// Cycles by state in which contexts of all units waited for lines, other than `FETCH`; and cycles in `FETCH` that no line ended.
    pub fn line_waits(&self) -> ([u64; State::ALL.len()], u64) {
        let (mut late, mut port) = ([0; State::ALL.len()], 0);
        for unit in &self.units {
            let (of_unit, of_port) = unit.timing.line_waits();
            late.iter_mut().zip(of_unit).for_each(|(sum, cycles)| *sum += cycles);
            port += of_port;
        }
        (late, port)
    }

    /// Does what unit `id` has to do in this cycle.
    fn tick(&mut self, id: u32, memory: &mut GroupSide) {
        let now = memory.now();
        let unit = &mut self.units[id as usize];
        while let Some(&(_, tag)) = unit.come.front().filter(|come| come.0 <= now) {
            unit.come.pop_front();
            told(id, tag, unit.timing.answer(now, tag), memory);
        }
        if unit.free <= now {
            let group = id / self.per_group;
            let Self { feed, under_way, .. } = self;
            let mut ports = Surroundings { id, group, port: &mut unit.port, feed, under_way, memory };
            unit.timing.tick(now, &mut ports);
            unit.free = now + 1;
        }
        self.sleep(id, memory);
    }

    /// Enters a wake of unit `id` in cycle `next`, if none is entered before.
    #[inline]
    fn wake_at(&mut self, next: u64, id: u32, memory: &mut GroupSide) {
        let unit = &mut self.units[id as usize];
        // One of this cycle is still to come, and enters the next.
        if unit.wake.is_none_or(|wake| wake > next) {
            unit.wake = Some(next);
            memory.wake_at(next, 2 * id);
        }
    }

    /// Enters the unit's next wake.
    #[inline]
    fn sleep(&mut self, id: u32, memory: &mut GroupSide) {
        let now = memory.now();
        let unit = &mut self.units[id as usize];
        let come = unit.come.front().map(|come| come.0);
        let told = (unit.port == RequestPort::Taken).then_some(unit.free);
        let next = unit.timing.next().into_iter().chain(come).chain(told).min().map(|next| next.max(unit.free).max(now));
        if let Some(next) = next {
            self.wake_at(next, id, memory);
        }
    }
}

impl FrontEnd for Units {
    fn slots(&self) -> (usize, fn(u32) -> usize) {
        (self.units.len() << 8, slot)
    }

    fn wake(&mut self, id: u32, memory: &mut GroupSide) {
        let (id, is_port) = (id / 2, id % 2 == 1);
        let unit = &mut self.units[id as usize];
        if is_port {
            unit.port = RequestPort::Taken;
            self.tick(id, memory);
        } else if unit.wake == Some(memory.now()) {
            unit.wake = None;
            self.tick(id, memory);
        }
    }

    fn answer(&mut self, waiter: u32, _: Supplier, memory: &mut GroupSide) {
        let (id, tag) = (waiter >> TAG_BITS, waiter as u16);
        let now = memory.now();
        let unit = &mut self.units[id as usize];
        let at = unit.answers.take(now, self.answers);
        if at == now {
            told(id, tag, unit.timing.answer(now, tag), memory);
        } else {
            unit.come.push_back((at, tag));
        }
        self.sleep(id, memory);
    }

    fn granted(&mut self, group: u32, memory: &mut GroupSide) {
        self.feed.came(group);
        for id in group * self.per_group..(group + 1) * self.per_group {
            // In this cycle, if the unit has not had it.
            let next = self.units[id as usize].free.max(memory.now());
            self.wake_at(next, id, memory);
        }
    }

    fn feed(&mut self) -> &mut Feed {
        &mut self.feed
    }

    fn under_way(&self) -> u64 {
        self.under_way
    }

    fn operations(&self) -> Operations {
        let mut sum = Operations::default();
        self.units.iter().for_each(|unit| sum.join(unit.timing.operations()));
        sum
    }

    fn describe(&self) -> String {
        let held = self.units.iter().filter(|unit| unit.port == RequestPort::Held).count();
        let waiting = self.units.iter().enumerate().filter(|(_, unit)| !unit.timing.is_idle());
        let lines: Vec<String> = waiting.take(8).map(|(id, unit)| format!("unit {id}: {}", unit.timing.describe())).collect();
        format!("{} rays under way, {held} units before a full bank\n{}", self.under_way, lines.join("\n"))
    }
}

/// Contexts of a group.
pub fn contexts_of_group(machine: &Machine) -> u32 {
    machine.units.per_group * machine.units.contexts
}

/// Charges a wait of a context, if the line of `tag` ended one.
#[inline]
fn told(id: u32, tag: u16, wait: Option<(u64, u64)>, memory: &mut GroupSide) {
    if let Some((since, end)) = wait {
        memory.charge_between(id << TAG_BITS | u32::from(tag), since, end, Cause::Port);
    }
}

/// Where the way of a waiter's line is kept: lines of a record that are four places apart share one, as a context waits for the last alone.
pub fn slot(waiter: u32) -> usize {
    ((waiter >> TAG_BITS) << 8 | waiter & 0xff) as usize
}

/// What surrounds a unit in one cycle.
struct Surroundings<'a> {
    id: u32,
    group: u32,
    port: &'a mut RequestPort,
    feed: &'a mut Feed,
    under_way: &'a mut u64,
    memory: &'a mut GroupSide,
}

impl Ports for Surroundings<'_> {
    type Ray = FedRay;

    fn ray(&mut self) -> Option<FedRay> {
        let ray = self.feed.ray(self.group, self.memory.now())?;
        *self.under_way += 1;
        Some(ray)
    }

    fn request(&mut self, LineRequest { tag, line, section, stores }: LineRequest) -> bool {
        match *self.port {
            RequestPort::Held => false,
            RequestPort::Taken => {
                *self.port = RequestPort::Free;
                true
            }
            RequestPort::Free => {
                let waiter = self.id << TAG_BITS | u32::from(tag);
                self.memory.counts_mut().traffic[section.place()].l1 += 1;
                match self.memory.request(self.group, 2 * self.id + 1, waiter, Ask { line, section, stores }) {
                    Asked::Comes(cycle) => {
                        self.memory.look_up(waiter, cycle);
                        self.memory.answer_at(cycle, waiter, Supplier::L1);
                    }
                    Asked::Taken => (),
                    Asked::Held => *self.port = RequestPort::Held,
                }
                *self.port == RequestPort::Free
            }
        }
    }

    fn hit(&mut self, ray: &FedRay, found: bool) -> bool {
        let counts = self.memory.counts_mut();
        counts.rays += 1;
        counts.hits += u64::from(found);
        *self.under_way -= 1;
        self.memory.ray_ends(ray.started, false);
        self.feed.ended(ray, self.group, self.memory.now());
        true
    }
}
