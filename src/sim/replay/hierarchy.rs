//! L1s, crossbar, L2 and memory, driven by events.
//!
//! A request that misses everywhere: in its L1 bank at c (its turn in the queue), known as a miss at c + L1 latency, through the group's port of the crossbar and
//! after `request_cycles` in the queue of its L2 bank; a miss there after the L2's latency; then memory. The line is written into the L2 when memory has it,
//! goes through the group's answer port, and after `answer_cycles` is written into the L1, from which all its waiters have it in that cycle. So without others in
//! the way an L1 hit takes the L1's latency; an L2 hit L1 + request + L2 + answer; a line from memory the same and memory's own time.
//!
//! Whoever cannot go on sleeps in a list and is woken by what makes room: nothing polls.

use super::counts::{Counts, Supplier};
use super::event::{ANSWERS, Asked, EventKind, FAR, Happening, MOVES, NEAR, SERVES, WAKES, id};
use super::level::{CacheRequest, Level, Served};
use super::mshr::Waiter;
use super::slots::Slots;
use super::stalls::{Cause, Histogram, Path};
use super::wheel::Wheel;
use crate::machine::{Cores, Crossbar, Machine};
use crate::sim::dram::{Dram, DramConfig, DramError};
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

/// A request that no queue has room for: its port, and since when.
#[derive(Clone, Copy, Debug)]
struct Held {
    port: u32,
    request: CacheRequest,
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

/// Latencies in cycles.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Latencies {
    /// Of rays, from their start to their end.
    pub rays: Histogram,
    /// Of misses of the L1s, from the look-up to the line.
    pub l1_misses: Histogram,
    /// The same of the L2.
    pub l2_misses: Histogram,
}

/// A way with what was waited for in front of the L1's bank.
#[inline]
fn in_front(mut path: Path, [held, turn, still]: [u32; 3]) -> Path {
    path.add(Cause::L1Queue, held.into());
    path.add(Cause::L1Turn, turn.into());
    path.add(Cause::L1Mshr, still.into());
    path
}

/// The memory system.
pub struct Hierarchy {
    /// Cycles and their events.
    pub wheel: Wheel,
    /// What was counted; caches count for themselves: see [`Hierarchy::counts`].
    counts: Counts,
    l1: Level,
    l2: Level,
    dram: Dram,
    cores: Cores,
    crossbar: Crossbar,
    ports: Vec<CrossbarPort>,
    doors: Vec<Door>,
    /// Requests before full banks of the L1s.
    held: Vec<VecDeque<Held>>,
    /// Registers of the L2 whose channel's queue is full, by channel, and since when.
    refused: Vec<VecDeque<(u32, u64)>>,
    refused_count: usize,
    /// Room for the waiters of a line.
    waiters: Vec<Waiter>,
    /// The cycle in which memory is to be looked at again.
    dram_next: Option<u64>,
    /// The ways of the lines of the L1s' and the L2's registers.
    l1_paths: Vec<Path>,
    l2_paths: Vec<Path>,
    /// When the L2's registers asked memory.
    pushed: Vec<u64>,
    /// By waiter's slot, the way of the line that came last for it.
    told: Vec<Path>,
    slot: fn(u32) -> usize,
    /// Cycles of rays from their start to their end.
    rays: Histogram,
}

impl Hierarchy {
    /// An idle machine. Of so many waiters at once it keeps the way of the last line, and the function says where.
    ///
    /// # Errors
    /// The memory's configuration is impossible.
    pub fn new(machine: &Machine, dram: &DramConfig, (slots, slot): (usize, fn(u32) -> usize)) -> Result<Self, DramError> {
        let groups = machine.cores.groups;
        let (l1, l2) = (Level::new(&machine.l1, groups), Level::new(&machine.l2, 1));
        Ok(Self {
            wheel: Wheel::new(),
            counts: Counts::default(),
            held: vec![VecDeque::new(); (groups * machine.l1.banks) as usize],
            l1_paths: vec![Path::default(); l1.registers()],
            l2_paths: vec![Path::default(); l2.registers()],
            pushed: vec![0; l2.registers()],
            told: vec![Path::default(); slots],
            slot,
            rays: Histogram::default(),
            l1,
            l2,
            dram: Dram::new(dram)?,
            cores: machine.cores.clone(),
            crossbar: machine.crossbar.clone(),
            ports: vec![CrossbarPort::default(); groups as usize],
            doors: vec![Door::default(); machine.l2.banks as usize],
            refused: vec![VecDeque::new(); dram.channels as usize],
            refused_count: 0,
            waiters: Vec::new(),
            dram_next: None,
        })
    }

    /// This cycle.
    pub fn now(&self) -> u64 {
        self.wheel.now()
    }

    /// What was counted so far.
    pub fn counts(&self) -> Counts {
        Counts { l1: self.l1.counts(), l2: self.l2.counts(), ..self.counts }
    }

    /// What whoever uses it counts.
    pub fn counts_mut(&mut self) -> &mut Counts {
        &mut self.counts
    }

    /// Charges a wait of `waiter` since cycle `since`, which the line that came last has ended in this cycle.
    #[inline]
    pub fn charge(&mut self, waiter: u32, since: u64) {
        // Behind it came another of the L1's, found at once.
        self.charge_between(waiter, since, self.now(), Cause::L1LookUp);
    }

    /// The same for a wait that ended in cycle `end`; what lies between that and the line's own end has the cause `behind`.
    #[inline]
    pub fn charge_between(&mut self, waiter: u32, since: u64, end: u64, behind: Cause) {
        self.told[(self.slot)(waiter)].charge([since, end], behind, &mut self.counts.stalls);
    }

    /// The L1 has the line that `waiter` asked for at once, in cycle `end`.
    #[inline(always)]
    pub fn look_up(&mut self, waiter: u32, end: u64) {
        let latency = self.l1.latency;
        self.told[(self.slot)(waiter)].look_up(latency, end);
    }

    /// A ray ends in this cycle that began in cycle `started`.
    #[inline]
    pub fn ray_ends(&mut self, started: u64) {
        let cycles = self.now() - started;
        self.rays.add(cycles);
    }

    /// Latencies of rays, and of misses of the L1s and the L2; and the requests that each bank of the L1s looked up.
    pub fn distributions(&self) -> (Latencies, Vec<u64>) {
        let latencies = Latencies { rays: self.rays.clone(), l1_misses: self.l1.latencies.clone(), l2_misses: self.l2.latencies.clone() };
        (latencies, self.l1.looked_up())
    }

    /// The memory, at this cycle.
    pub fn dram(&mut self) -> &Dram {
        self.advance_dram();
        &self.dram
    }

    /// Tells [`Happening::Wake`] in `cycle`.
    #[inline]
    pub fn wake_at(&mut self, cycle: u64, id: u32) {
        self.enter(cycle, EventKind::Wake, id);
    }

    /// Tells [`Happening::Answer`] of `waiter` in `cycle`.
    #[inline]
    pub fn answer_at(&mut self, cycle: u64, waiter: u32, from: Supplier) {
        let kind = match from {
            Supplier::L1 => EventKind::AnswerL1,
            Supplier::L2 => EventKind::AnswerL2,
            Supplier::Dram => EventKind::AnswerDram,
        };
        self.enter(cycle, kind, waiter);
    }

    #[inline]
    fn enter(&mut self, cycle: u64, kind: EventKind, id: u32) {
        self.wheel.at(cycle, kind.class(), kind.event(id));
    }

    /// `port` of `group` asks for `line` of `section`, of which `waiter` is told; it is counted by whoever asks.
    #[inline]
    pub fn request(&mut self, group: u32, port: u32, waiter: u32, line: u32, section: SectionId) -> Asked {
        let now = self.now();
        let bank = self.l1.bank(group, line);
        if self.l1.hit_now(bank, line, now) {
            return Asked::Comes(now + self.l1.latency);
        }
        let request = CacheRequest { waiter, line, section, since: now, held: 0, blocked: 0 };
        if !self.l1.has_room(bank, 0) || !self.held[bank as usize].is_empty() {
            self.held[bank as usize].push_back(Held { port, request });
            return Asked::Held;
        }
        self.enqueue_l1(bank, request);
        Asked::Taken
    }

    #[inline]
    fn enqueue_l1(&mut self, bank: u32, request: CacheRequest) {
        match self.l1.enqueue(bank, request) {
            Some(cycle) if cycle <= self.now() => self.serve_l1_and_tell(bank),
            Some(cycle) => self.enter(cycle, EventKind::ServeL1, bank),
            None => (),
        }
    }

    fn serve_l1_and_tell(&mut self, bank: u32) {
        if let Some(waiter) = self.serve_l1(bank) {
            self.enter(self.now() + self.l1.latency, EventKind::AnswerL1, waiter);
        }
    }

    /// Serves a bank of an L1: whose line it found, which comes after the L1's latency.
    #[inline]
    fn serve_l1(&mut self, bank: u32) -> Option<u32> {
        let now = self.now();
        let look = self.l1.serve(bank, now)?;
        if look.again {
            self.enter(now + 1, EventKind::ServeL1, bank);
        }
        let known = now + self.l1.latency;
        match look.served {
            Served::Hit => {
                let path = Path::begin(Cause::L1LookUp, self.l1.latency);
                self.told[(self.slot)(look.waiter)] = in_front(path, look.before).ended(known);
            }
            Served::Merged => (),
            Served::Miss(register) => {
                let group = self.l1.copy(bank);
                self.l1_paths[register as usize] = Path::begin(Cause::L1LookUp, self.l1.latency);
                let slept = self.ports[group as usize].slept(now);
                self.ports[group as usize].misses.push_back((register, known, slept));
                if !std::mem::replace(&mut self.ports[group as usize].awake, true) {
                    self.enter(known, EventKind::Crossbar, group);
                }
            }
        }
        if let Some(held) = self.held[bank as usize].pop_front() {
            let waited = now - held.request.since;
            self.l1.counts.refused_cycles += waited;
            self.enter(now + 1, EventKind::Wake, held.port);
            self.enqueue_l1(bank, CacheRequest { since: now, held: waited as u32, ..held.request }); // a wait of 2^32 cycles does not end
        }
        (look.served == Served::Hit).then_some(look.waiter)
    }

    /// The head of a group's misses goes on, if its bank has room.
    fn crossbar(&mut self, group: u32) {
        let now = self.now();
        let port = &mut self.ports[group as usize];
        let Some(&(register, ..)) = port.misses.front() else {
            port.awake = false;
            return;
        };
        let bank = self.l2.bank(0, self.l1.line(register));
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
        let next = port.misses.front().map(|&(_, known, _)| known);
        // The next may pass in the same cycle if the port is that wide.
        port.awake = next.is_some();
        let door = &mut self.doors[bank as usize];
        door.coming += 1;
        let handed = door.handed.take(passes, self.crossbar.per_bank);
        self.counts.crossbar_cycles += handed - known;
        let (waited, path) = (handed - known, &mut self.l1_paths[register as usize]);
        path.add(Cause::L2Queue, slept.min(waited));
        path.add(Cause::CrossbarRequest, waited - slept.min(waited) + u64::from(self.crossbar.request_cycles));
        self.enter(handed + u64::from(self.crossbar.request_cycles), EventKind::ArriveL2, register);
        if let Some(known) = next {
            let full = self.ports[group as usize].requests.is_full(now, self.crossbar.per_group);
            self.enter(known.max(now + u64::from(full)), EventKind::Crossbar, group);
        }
    }

    fn arrive_l2(&mut self, register: u32) {
        let (line, section) = (self.l1.line(register), self.l1.section(register));
        let bank = self.l2.bank(0, line);
        self.doors[bank as usize].coming -= 1;
        self.counts.traffic[section.place()].l2 += 1;
        let request = CacheRequest { waiter: register, line, section, since: self.now(), held: 0, blocked: 0 };
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
        let path = &mut self.l1_paths[look.waiter as usize];
        path.add(Cause::L2Turn, turn.into());
        path.add(Cause::L2Mshr, still.into());
        match look.served {
            Served::Hit => {
                path.add(Cause::L2LookUp, self.l2.latency);
                self.answer_l1(look.waiter, known, Supplier::L2);
            }
            Served::Merged => (),
            Served::Miss(register) => {
                self.l2_paths[register as usize] = Path::begin(Cause::L2LookUp, self.l2.latency);
                self.enter(known, EventKind::PushDram, register);
            }
        }
        if let Some((group, since)) = self.doors[bank as usize].asleep.pop_front() {
            self.l2.counts.refused_cycles += now - since;
            self.send(group, bank);
        }
    }

    /// The L2 has the line of an L1's register in cycle `ready`.
    fn answer_l1(&mut self, register: u32, ready: u64, source: Supplier) {
        let group = self.l1.copy(self.l1.bank_of(register));
        let passes = self.ports[group as usize].answers.take(ready, self.crossbar.per_group);
        self.counts.answer_cycles += passes - ready;
        self.l1_paths[register as usize].add(Cause::CrossbarAnswer, passes - ready + u64::from(self.crossbar.answer_cycles));
        let kind = if source == Supplier::L2 { EventKind::FillL1FromL2 } else { EventKind::FillL1FromDram };
        self.enter(passes + u64::from(self.crossbar.answer_cycles), kind, register);
    }

    fn fill_l1(&mut self, register: u32, kind: EventKind) {
        let now = self.now();
        let (wheel, told, slot, path) = (&mut self.wheel, &mut self.told, self.slot, &self.l1_paths[register as usize]);
        let answer = |Waiter { waiter, before, since }: Waiter| {
            let mut rest = Path::default();
            rest.add_rest(path, now - since);
            told[slot(waiter)] = in_front(rest, before).ended(now);
            wheel.at(now, kind.class(), kind.event(waiter));
        };
        if self.l1.fill(register, now, answer) {
            self.serve_l1_and_tell(self.l1.bank_of(register));
        }
    }

    fn fill_l2(&mut self, register: u32) {
        let now = self.now();
        let mut waiters = std::mem::take(&mut self.waiters);
        let serve = self.l2.fill(register, now, |waiter| waiters.push(waiter));
        for Waiter { waiter, since, .. } in waiters.drain(..) {
            self.l1_paths[waiter as usize].add_rest(&self.l2_paths[register as usize], now - since);
            self.answer_l1(waiter, now, Supplier::Dram);
        }
        self.waiters = waiters;
        if serve {
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

    fn read_dram(&mut self, register: u32, line: u64) {
        self.counts.traffic[self.l2.section(register).place()].dram += 1;
        self.pushed[register as usize] = self.now();
        self.dram.push(self.cores.start_ps(self.now()), line, u64::from(register), false);
        self.dram_next = self.dram.next_event().map(|ps| self.cores.cycle_at(ps));
    }

    /// Lets memory do what it does up to this cycle.
    fn advance_dram(&mut self) {
        let now = self.now();
        let (cores, wheel, paths, clock_ps) = (&self.cores, &mut self.wheel, &mut self.l2_paths, self.dram.clock_ps());
        let pushed = &self.pushed;
        self.dram.advance_by_way(cores.start_ps(now), &mut |register, way| {
            let fill = cores.cycle_at(way.end() * clock_ps).max(now);
            let path = &mut paths[register as usize];
            let mut from = pushed[register as usize];
            for (cause, end) in OF_DRAM.into_iter().zip(way.ends) {
                let to = if cause == Cause::DramAccess { fill } else { cores.cycle_at(end * clock_ps).clamp(from, fill) };
                path.add(cause, to - from);
                from = to;
            }
            // It was a register's 32 bits.
            wheel.at(fill, MOVES, EventKind::FillL2.event(register as u32));
        });
        if self.refused_count > 0 {
            self.push_refused();
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
                self.l2_paths[register as usize].add(Cause::DramQueue, now - since);
                self.read_dram(register, line);
            }
        }
    }

    /// The next happening of this cycle.
    #[inline]
    pub fn take(&mut self) -> Option<Happening> {
        loop {
            if let Some(event) = self.wheel.take(MOVES) {
                self.moves(EventKind::of(event), id(event));
            } else if let Some(event) = self.wheel.take(SERVES) {
                if let Some(next) = self.wheel.peek(SERVES, FAR) {
                    self.l1.prefetch(id(next));
                }
                if let Some(next) = self.wheel.peek(SERVES, NEAR) {
                    self.l1.prefetch_tags(id(next));
                }
                if let Some(waiter) = self.serve_l1(id(event)) {
                    return Some(Happening::Comes(waiter, self.now() + self.l1.latency));
                }
            } else if let Some(event) = self.wheel.take(ANSWERS) {
                return Some(match EventKind::of(event) {
                    EventKind::AnswerL2 => Happening::Answer(id(event), Supplier::L2),
                    EventKind::AnswerDram => Happening::Answer(id(event), Supplier::Dram),
                    _ => Happening::Answer(id(event), Supplier::L1),
                });
            } else {
                return self.wheel.take(WAKES).map(|event| Happening::Wake(id(event)));
            }
        }
    }

    /// Who is told soon what is like `happening`, if anybody: first far ahead, then near.
    #[inline(always)]
    pub fn soon(&self, happening: Happening) -> [Option<u32>; 2] {
        let class = match happening {
            Happening::Answer(..) => ANSWERS,
            Happening::Wake(_) => WAKES,
            Happening::Comes(..) => return [None; 2],
        };
        [FAR, NEAR].map(|ahead| self.wheel.peek(class, ahead).map(id))
    }

    fn moves(&mut self, kind: EventKind, id: u32) {
        match kind {
            EventKind::Crossbar => self.crossbar(id),
            EventKind::ArriveL2 => self.arrive_l2(id),
            EventKind::ServeL2 => self.serve_l2(id),
            EventKind::PushDram => self.push_dram(id),
            EventKind::FillL2 => self.fill_l2(id),
            EventKind::FillL1FromL2 => self.fill_l1(id, EventKind::AnswerL2),
            EventKind::FillL1FromDram => self.fill_l1(id, EventKind::AnswerDram),
            EventKind::Wake | EventKind::AnswerL1 | EventKind::AnswerL2 | EventKind::AnswerDram | EventKind::ServeL1 => {
                unreachable!("of another class")
            }
        }
    }

    /// The next cycle in which something happens.
    pub fn next(&self) -> Option<u64> {
        self.wheel.next().into_iter().chain(self.dram_next).min()
    }

    /// Goes to `cycle`, which [`Hierarchy::next`] gave.
    pub fn go(&mut self, cycle: u64) {
        self.wheel.go(cycle);
        if self.dram_next.is_some_and(|next| next <= cycle) {
            self.advance_dram();
        }
    }

    /// What a waveform shows of it: scope, name and value of every signal, always in the same order; a scope's signals follow each other.
    pub fn show(&self, show: &mut dyn FnMut(&str, &str, u64)) {
        for (group, port) in self.ports.iter().enumerate() {
            let (queued, misses) = self.l1.occupancy(group as u32);
            let scope = format!("group_{group}");
            for (name, value) in [("l1_queued", queued), ("l1_misses_under_way", misses), ("crossbar_queued", port.misses.len())] {
                show(&scope, name, value as u64);
            }
        }
        let (queued, misses) = self.l2.occupancy(0);
        let asleep = self.doors.iter().map(|door| door.asleep.len()).sum();
        for (name, value) in [("l2_queued", queued), ("l2_misses_under_way", misses), ("groups_held_back", asleep)] {
            show("l2", name, value as u64);
        }
        for (name, value) in [("waiting", self.dram.waiting()), ("held_back", self.refused_count)] {
            show("dram", name, value as u64);
        }
    }

    /// What is not at rest, for error messages.
    pub fn describe(&self) -> String {
        let misses: usize = self.ports.iter().map(|port| port.misses.len()).sum();
        let asleep: usize = self.doors.iter().map(|door| door.asleep.len()).sum();
        format!(
            "{}\ncrossbar: {misses} misses queued, {asleep} groups before a full bank\n{}\nmemory: {} reads wait for room, {} in the channels",
            self.l1.describe("L1"),
            self.l2.describe("L2"),
            self.refused_count,
            self.dram.waiting()
        )
    }
}
