//! The side of a replay that all groups share: crossbar, L2 and memory, driven by events.
//!
//! A miss that is known at k goes through its group's port of the crossbar and is after `request_cycles` in the queue of its L2 bank; a miss there after the L2's latency;
//! then memory. The answer goes through the group's answer port, and after `answer_cycles` the line is written into the L1. So without others in the way an L2 hit takes
//! L1 + request + L2 + answer; a line from memory the same and memory's own time.
//!
//! A look-up of the L2 sees what comes while it is under way: a line that memory has at f is ready for who looked it up at f - L2 latency or later at the end of its own
//! look-up, whether it found the line or merged with its miss. So nothing that is asked for is answered sooner than the L2's latency later, and groups and the shared side can
//! go on without each other for as long as [`SharedSide::reply`] says.

use super::causes::MissCauses;
use super::counts::{Counts, Supplier};
use super::event::{EventKind, MOVES, SERVES, id};
use super::intervals::{Series, SharedCounts};
use super::level::{CacheRequest, Level, Served};
use super::messages::{Fill, Miss};
use super::mshr::Waiter;
use super::slots::Slots;
use super::stalls::{Cause, Histogram, Path};
use super::wave::Shown;
use super::wheel::Wheel;
use crate::machine::{Cores, Crossbar, Machine};
use crate::sim::dram::{ChannelCounts, Dram, DramConfig, DramError};
use crate::step::SectionId;
use std::collections::VecDeque;

/// A group's side of the crossbar: misses in order.
#[derive(Clone, Debug, Default)]
struct CrossbarPort {
    /// Registers of the L1, since when they wait, and cycles that the port had slept when they came.
    misses: VecDeque<(u32, u64, u64)>,
    /// An event for the head is entered, or it sleeps before a full bank.
    awake: bool,
    requests: Slots,
    answers: Slots,
    /// Cycles in which the head slept before a full bank, and since when it does.
    slept: u64,
    asleep: Option<u64>,
}

impl CrossbarPort {
    /// Cycles up to `now` in which the head slept before a full bank.
    fn slept(&self, now: u64) -> u64 {
        self.slept + self.asleep.map_or(0, |since| now.saturating_sub(since))
    }
}

/// A bank of the L2, seen from the crossbar.
#[derive(Clone, Debug, Default)]
struct Door {
    /// Requests on their way to the bank's queue.
    coming: usize,
    handed: Slots,
    /// Groups whose head found no room.
    asleep: VecDeque<(u32, u64)>,
}

/// Causes of the stretches of a [`Way`](crate::sim::dram::Way) through memory.
const OF_DRAM: [Cause; 6] =
    [Cause::DramBank, Cause::DramConflict, Cause::DramActivate, Cause::DramOpening, Cause::DramBus, Cause::DramAccess];

/// The number of writes at memory; reads have their register's.
const WRITE: u64 = u64::MAX;

/// A register of an L1 whose miss is under way.
#[derive(Clone, Copy, Debug, Default)]
struct Asking {
    line: u32,
    section: SectionId,
    stores: bool,
    path: Path,
}

/// Crossbar, L2 and memory.
pub struct SharedSide {
    /// Cycles and their events.
    wheel: Wheel,
    /// What was counted; the L2 counts for itself.
    counts: Counts,
    /// The same over time.
    pub over_time: Series<SharedCounts>,
    l1_latency: u64,
    /// Registers of a group's L1.
    registers: u32,
    l2: Level,
    dram: Dram,
    cores: Cores,
    crossbar: Crossbar,
    ports: Vec<CrossbarPort>,
    doors: Vec<Door>,
    /// The L1s' registers.
    asking: Vec<Asking>,
    /// Registers of the L2 whose channel's queue is full, by channel, and since when.
    refused: Vec<VecDeque<(u32, u64)>>,
    refused_count: usize,
    /// The same of lines to be written, which nobody waits for.
    unwritten: Vec<VecDeque<(u32, SectionId)>>,
    /// Lines of both that are not in memory yet, and the latest cycle in which one was.
    writing: u64,
    written: u64,
    /// Room for the waiters of a line.
    waiters: Vec<Waiter>,
    /// The cycle in which memory is to be looked at again.
    dram_next: Option<u64>,
    /// The ways of the lines of the L2's registers, when they asked memory, and when it has the line.
    paths: Vec<Path>,
    pushed: Vec<u64>,
    ready: Vec<u64>,
    /// For the groups.
    pub fills: Vec<Fill>,
}

impl SharedSide {
    /// An idle one.
    ///
    /// # Errors
    /// The memory's configuration is impossible.
    pub fn new(machine: &Machine, dram: &DramConfig) -> Result<Self, DramError> {
        let groups = machine.cores.groups;
        let l2 = Level::explaining(&machine.l2);
        let registers = machine.l1.banks * machine.l1.mshrs;
        Ok(Self {
            wheel: Wheel::new(),
            counts: Counts::default(),
            over_time: Series::new(),
            l1_latency: machine.l1.latency_cycles.into(),
            registers,
            asking: vec![Asking::default(); (groups * registers) as usize],
            paths: vec![Path::default(); l2.registers()],
            pushed: vec![0; l2.registers()],
            ready: vec![0; l2.registers()],
            l2,
            dram: Dram::new(dram)?,
            cores: machine.cores.clone(),
            crossbar: machine.crossbar.clone(),
            ports: vec![CrossbarPort::default(); groups as usize],
            doors: vec![Door::default(); machine.l2.banks as usize],
            refused: vec![VecDeque::new(); dram.channels as usize],
            refused_count: 0,
            unwritten: vec![VecDeque::new(); dram.channels as usize],
            writing: 0,
            written: 0,
            waiters: Vec::new(),
            dram_next: None,
            fills: Vec::new(),
        })
    }

    /// Fewest cycles from anything that happens here to a line in an L1 that follows from it: the L2's latency, or memory's from a read command to its data where that is
    /// shorter, and the way back.
    pub fn reply(machine: &Machine, dram: &DramConfig) -> u64 {
        let timing = &dram.device.timing;
        // Command and data may each come within a cycle.
        let access = machine.cores.cycle_at((timing.n_cl + timing.n_bl) * dram.device.clock_ps).saturating_sub(1);
        access.min(machine.l2.latency_cycles.into()) + u64::from(machine.crossbar.answer_cycles)
    }

    fn now(&self) -> u64 {
        self.wheel.now()
    }

    /// Why the L2 missed, and the different lines of its busiest set and of all.
    pub fn l2_causes(&self) -> (MissCauses, (u64, u64)) {
        self.l2.causes()
    }

    /// What was counted up to this cycle.
    pub fn counts(&self) -> SharedCounts {
        self.counts_at(self.now())
    }

    fn counts_at(&self, cycle: u64) -> SharedCounts {
        let mut channels = ChannelCounts::default();
        self.dram.counts().iter().for_each(|channel| channels.add(channel));
        SharedCounts { counts: Counts { l2: self.l2.counts_at(cycle), ..self.counts }, channels, dram: self.dram.energy() }
    }

    /// Lines that the L2 has and memory has not.
    pub fn dirty_lines(&self) -> u64 {
        self.l2.dirty_lines()
    }

    /// All rays have ended, the last in cycle `end`: goes on until what the L2 gave up is in memory. The cycle in which it is; `end` if nothing was on its way any more.
    pub fn drain(&mut self, end: u64) -> u64 {
        while self.writing > 0 {
            self.cycle();
            match self.next() {
                Some(next) => self.go(next),
                None => unreachable!("writes that wait are events of the memory"),
            }
        }
        end.max(self.written)
    }

    /// Latencies of misses of the L2.
    pub fn latencies(&self) -> &Histogram {
        &self.l2.latencies
    }

    /// The memory.
    pub fn dram(&self) -> &Dram {
        &self.dram
    }

    #[inline]
    fn enter(&mut self, cycle: u64, kind: EventKind, id: u32) {
        self.wheel.at(cycle, kind.class(), kind.event(id));
    }

    /// A miss will be known. They come in the order of cycles and groups.
    pub fn comes(&mut self, miss: &Miss) {
        assert!(miss.cycle > self.now(), "a miss of cycle {} comes too late", miss.cycle);
        let path = Path::begin(Cause::L1LookUp, self.l1_latency);
        self.asking[miss.register as usize] = Asking { line: miss.ask.line, section: miss.ask.section, stores: miss.ask.stores, path };
        self.enter(miss.cycle, EventKind::Miss, miss.register);
    }

    /// The group of an L1's register.
    pub fn group(&self, register: u32) -> u32 {
        register / self.registers
    }

    fn missed(&mut self, register: u32) {
        let now = self.now();
        let group = self.group(register);
        let port = &mut self.ports[group as usize];
        port.misses.push_back((register, now, port.slept(now)));
        if !std::mem::replace(&mut port.awake, true) {
            self.enter(now, EventKind::Crossbar, group);
        }
    }

    /// The head of a group's misses goes on, if its bank has room.
    fn crossbar(&mut self, group: u32) {
        let now = self.now();
        let port = &mut self.ports[group as usize];
        let Some(&(register, ..)) = port.misses.front() else {
            port.awake = false;
            return;
        };
        let bank = self.l2.bank(0, self.asking[register as usize].line);
        let door = &mut self.doors[bank as usize];
        if !door.asleep.is_empty() || !self.l2.has_room(bank, door.coming) {
            door.asleep.push_back((group, now));
            port.asleep = Some(now);
            return;
        }
        self.send(group, bank);
    }

    fn send(&mut self, group: u32, bank: u32) {
        let now = self.now();
        let port = &mut self.ports[group as usize];
        let Some((register, known, slept)) = port.misses.pop_front() else { return };
        let slept = port.slept(now) - slept;
        if let Some(since) = port.asleep.take() {
            port.slept += now - since;
        }
        let passes = port.requests.take(now, self.crossbar.per_group);
        port.awake = !port.misses.is_empty();
        let door = &mut self.doors[bank as usize];
        door.coming += 1;
        let handed = door.handed.take(passes, self.crossbar.per_bank);
        self.counts.crossbar_cycles += handed - known;
        let (waited, path) = (handed - known, &mut self.asking[register as usize].path);
        path.add(Cause::L2Queue, slept.min(waited));
        path.add(Cause::CrossbarRequest, waited - slept.min(waited) + u64::from(self.crossbar.request_cycles));
        self.enter(handed + u64::from(self.crossbar.request_cycles), EventKind::ArriveL2, register);
        let port = &self.ports[group as usize];
        if port.awake {
            // The next may pass in the same cycle if the port is that wide.
            let full = port.requests.is_full(now, self.crossbar.per_group);
            self.enter(now + u64::from(full), EventKind::Crossbar, group);
        }
    }

    fn arrive_l2(&mut self, register: u32) {
        let Asking { line, section, stores, .. } = self.asking[register as usize];
        let bank = self.l2.bank(0, line);
        self.doors[bank as usize].coming -= 1;
        self.counts.traffic[section.place()].l2 += 1;
        let request = CacheRequest { waiter: register, line, section, stores, since: self.now(), held: 0, blocked: 0 };
        match self.l2.enqueue(bank, request) {
            Some(cycle) if cycle <= self.now() => self.serve_l2(bank),
            Some(cycle) => self.enter(cycle, EventKind::ServeL2, bank),
            None => (),
        }
    }

    fn serve_l2(&mut self, bank: u32) {
        let now = self.now();
        let Some(look) = self.l2.serve(bank, now) else { return };
        if look.again {
            self.enter(now + 1, EventKind::ServeL2, bank);
        }
        let known = now + self.l2.latency;
        let [_, turn, still] = look.before;
        let path = &mut self.asking[look.waiter as usize].path;
        path.add(Cause::L2Turn, turn.into());
        path.add(Cause::L2Mshr, still.into());
        match look.served {
            Served::Hit => {
                path.add(Cause::L2LookUp, self.l2.latency);
                self.answer_l1(look.waiter, known, Supplier::L2);
            }
            Served::Merged => (),
            Served::Miss(register) => {
                self.paths[register as usize] = Path::begin(Cause::L2LookUp, self.l2.latency);
                self.enter(known, EventKind::PushDram, register);
            }
        }
        self.write_back();
        if let Some((group, since)) = self.doors[bank as usize].asleep.pop_front() {
            self.l2.counts.refused_cycles += now - since;
            self.send(group, bank);
        }
    }

    /// The L2 has the line of an L1's register in cycle `ready`.
    fn answer_l1(&mut self, register: u32, ready: u64, source: Supplier) {
        let group = self.group(register);
        let passes = self.ports[group as usize].answers.take(ready, self.crossbar.per_group);
        self.counts.answer_cycles += passes - ready;
        let mut path = self.asking[register as usize].path;
        path.add(Cause::CrossbarAnswer, passes - ready + u64::from(self.crossbar.answer_cycles));
        let kind = if source == Supplier::L2 { EventKind::FillL1FromL2 } else { EventKind::FillL1FromDram };
        self.fills.push(Fill { cycle: passes + u64::from(self.crossbar.answer_cycles), register, kind, path });
    }

    /// The line of an L2's register will be there by the end of a look-up that begins now: from now on it is found.
    fn fill_l2(&mut self, register: u32) {
        let (now, ready) = (self.now(), self.ready[register as usize]);
        let mut waiters = std::mem::take(&mut self.waiters);
        self.l2.land(register, |waiter| waiters.push(waiter));
        self.write_back();
        for Waiter { waiter, since, .. } in waiters.drain(..) {
            let looked_up = since + self.l2.latency;
            let path = &mut self.asking[waiter as usize].path;
            if looked_up > ready {
                path.add(Cause::L2LookUp, self.l2.latency);
            } else {
                path.add_rest(&self.paths[register as usize], ready - since);
            }
            self.answer_l1(waiter, ready.max(looked_up), Supplier::Dram);
        }
        self.waiters = waiters;
        if ready > now { self.enter(ready, EventKind::FreeL2, register) } else { self.free_l2(register) }
    }

    fn free_l2(&mut self, register: u32) {
        if self.l2.free(register, self.now()) {
            self.serve_l2(self.l2.bank_of(register));
        }
    }

    fn push_dram(&mut self, register: u32) {
        let line = u64::from(self.l2.line(register));
        let channel = self.dram.channel(line) as usize;
        if !self.refused[channel].is_empty() || !self.dram.accepts(line, false) {
            let now = self.now();
            self.refused[channel].push_back((register, now));
            self.refused_count += 1;
            return;
        }
        self.read_dram(register, line);
    }

    /// Lines that the L2 had to give up go to memory: in the cycle in which it gave them up, though their data would take as long as a look-up.
    fn write_back(&mut self) {
        while let Some((line, section)) = self.l2.written_back.pop() {
            self.writing += 1;
            self.unwritten[self.dram.channel(line.into()) as usize].push_back((line, section));
            self.write_dram();
        }
    }

    /// Writes what there is room for.
    fn write_dram(&mut self) {
        for channel in 0..self.unwritten.len() {
            while let Some(&(line, section)) = self.unwritten[channel].front() {
                if !self.dram.accepts(line.into(), true) {
                    break;
                }
                self.unwritten[channel].pop_front();
                self.counts.traffic[section.place()].written += 1;
                self.dram.push(self.cores.start_ps(self.now()), line.into(), WRITE, true);
                self.dram_next = self.dram.next_event().map(|ps| self.cores.cycle_at(ps));
            }
        }
    }

    fn read_dram(&mut self, register: u32, line: u64) {
        self.counts.traffic[self.l2.section(register).place()].dram += 1;
        self.pushed[register as usize] = self.now();
        self.dram.push(self.cores.start_ps(self.now()), line, u64::from(register), false);
        self.dram_next = self.dram.next_event().map(|ps| self.cores.cycle_at(ps));
    }

    /// Lets memory do what it does up to this cycle.
    fn advance_dram(&mut self) {
        let now = self.now();
        let (cores, wheel, paths, clock_ps) = (&self.cores, &mut self.wheel, &mut self.paths, self.dram.clock_ps());
        let (pushed, ready, latency) = (&self.pushed, &mut self.ready, self.l2.latency);
        let (writing, written) = (&mut self.writing, &mut self.written);
        self.dram.advance_by_way(cores.start_ps(now), &mut |register, way| {
            let fill = cores.cycle_at(way.end() * clock_ps).max(now);
            if register == WRITE {
                // Nobody waits for it.
                *writing -= 1;
                *written = fill.max(*written);
                return;
            }
            let path = &mut paths[register as usize];
            let mut from = pushed[register as usize];
            for (cause, end) in OF_DRAM.into_iter().zip(way.ends) {
                let to = if cause == Cause::DramAccess { fill } else { cores.cycle_at(end * clock_ps).clamp(from, fill) };
                path.add(cause, to - from);
                from = to;
            }
            // It was a register's 32 bits.
            ready[register as usize] = fill;
            wheel.at(fill.saturating_sub(latency).max(now), MOVES, EventKind::FillL2.event(register as u32));
        });
        if self.refused_count > 0 {
            self.push_refused();
        }
        if self.writing > 0 {
            self.write_dram();
        }
        self.dram_next = self.dram.next_event().map(|ps| self.cores.cycle_at(ps));
    }

    fn push_refused(&mut self) {
        let now = self.now();
        for channel in 0..self.refused.len() {
            while let Some(&(register, since)) = self.refused[channel].front() {
                let line = u64::from(self.l2.line(register));
                if !self.dram.accepts(line, false) {
                    break;
                }
                self.refused[channel].pop_front();
                self.refused_count -= 1;
                self.counts.dram_refused_cycles += now - since;
                self.paths[register as usize].add(Cause::DramQueue, now - since);
                self.read_dram(register, line);
            }
        }
    }

    /// Does all that happens before cycle `end`, of which all misses must have come.
    pub fn run(&mut self, end: u64) {
        loop {
            self.cycle();
            match self.next() {
                Some(next) if next < end => self.go(next),
                _ => break,
            }
        }
    }

    /// Does what happens in this cycle.
    fn cycle(&mut self) {
        loop {
            if let Some(event) = self.wheel.take(SERVES) {
                self.missed(id(event));
            } else if let Some(event) = self.wheel.take(MOVES) {
                let id = id(event);
                match EventKind::of(event) {
                    EventKind::Crossbar => self.crossbar(id),
                    EventKind::ArriveL2 => self.arrive_l2(id),
                    EventKind::ServeL2 => self.serve_l2(id),
                    EventKind::PushDram => self.push_dram(id),
                    EventKind::FillL2 => self.fill_l2(id),
                    EventKind::FreeL2 => self.free_l2(id),
                    kind => unreachable!("{kind:?} is of the groups' side"),
                }
            } else {
                return;
            }
        }
    }

    /// The next cycle in which something happens.
    pub fn next(&self) -> Option<u64> {
        self.wheel.next().into_iter().chain(self.dram_next).min()
    }

    fn go(&mut self, cycle: u64) {
        if let Some(end) = self.over_time.end_before(cycle) {
            // Time passes for the memory although nothing happens: up to the last cycle of the stretch.
            self.dram.advance(self.cores.start_ps(end - 1), &mut |_, _| ());
            self.over_time.note(end, self.counts_at(end));
        }
        self.wheel.go(cycle);
        if self.dram_next.is_some_and(|next| next <= cycle) {
            self.advance_dram();
        }
    }

    /// The run ends in cycle `end`. Lines are on their way to the last rays before their registers are free: those may be further than this side, which ran a round behind.
    pub fn end(&mut self, end: u64) {
        self.run(end + 1);
        self.dram.advance(self.cores.start_ps(end), &mut |_, _| ());
    }

    /// Misses of `group` before the crossbar.
    pub fn queued(&self, group: u32) -> usize {
        self.ports[group as usize].misses.len()
    }

    /// What a waveform shows of it: scope, name and value of every signal, always in the same order; a scope's signals follow each other.
    pub fn show(&self, show: &mut Shown<'_>) {
        let (queued, misses) = self.l2.occupancy(0);
        let asleep = self.doors.iter().map(|door| door.asleep.len()).sum();
        let unwritten = self.unwritten.iter().map(VecDeque::len).sum();
        for (name, value) in [("l2_queued", queued), ("l2_misses_under_way", misses), ("groups_held_back", asleep)] {
            show("l2", name, value as u64);
        }
        for (name, value) in [("waiting", self.dram.waiting()), ("held_back", self.refused_count), ("writes_held_back", unwritten)] {
            show("dram", name, value as u64);
        }
    }

    /// What is not at rest, for error messages.
    pub fn describe(&self) -> String {
        let misses: usize = self.ports.iter().map(|port| port.misses.len()).sum();
        let asleep: usize = self.doors.iter().map(|door| door.asleep.len()).sum();
        format!(
            "crossbar: {misses} misses queued, {asleep} groups before a full bank\n{}\nmemory: {} reads wait for room, {} in the channels",
            self.l2.describe("L2"),
            self.refused_count,
            self.dram.waiting()
        )
    }
}
