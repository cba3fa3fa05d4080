//! Groups of cores with their L1s, driven by events: the side of a replay that has no part in others of its kind.
//!
//! A request that misses everywhere: in its L1 bank at c (its turn in the queue), known as a miss at c + L1 latency; then it is the shared side's
//! ([`shared_side`](super::shared_side)), which says when the line is written into the L1. All its waiters have it in that cycle, or at the end of their own look-up where that
//! is later. An L1 hit takes the L1's latency.
//!
//! Whoever cannot go on sleeps in a list and is woken by what makes room: nothing polls.

use super::counts::{Counts, Supplier};
use super::event::{ANSWERS, Ask, Asked, EventKind, FAR, GRANTS, Happening, MOVES, NEAR, SERVES, WAKES, id};
use super::intervals::Series;
use super::level::{CacheRequest, Level, Served};
use super::messages::{Fill, Miss};
use super::mshr::Waiter;
use super::stalls::{Cause, Histogram, Path};
use super::wheel::Wheel;
use crate::machine::Machine;
use std::collections::VecDeque;

/// A request that no queue has room for: its port, and since when.
#[derive(Clone, Copy, Debug)]
struct Held {
    port: u32,
    request: CacheRequest,
}

/// A way with what was waited for in front of the L1's bank.
#[inline]
fn in_front(mut path: Path, [held, turn, still]: [u32; 3]) -> Path {
    path.add(Cause::L1Queue, held.into());
    path.add(Cause::L1Turn, turn.into());
    path.add(Cause::L1Mshr, still.into());
    path
}

/// Some groups' L1s.
pub struct GroupSide {
    /// Cycles and their events.
    wheel: Wheel,
    /// What was counted; caches count for themselves: see [`GroupSide::counts`].
    counts: Counts,
    /// The same over time.
    pub over_time: Series<Counts>,
    l1: Level,
    /// The first of the groups, and of their registers, among all.
    first: u32,
    first_register: u32,
    /// Requests before full banks of the L1s.
    held: Vec<VecDeque<Held>>,
    /// The ways of the lines that come for the L1s' registers.
    paths: Vec<Path>,
    /// By waiter's slot, the way of the line that came last for it.
    told: Vec<Path>,
    slot: fn(u32) -> usize,
    /// Cycles of rays from their start to their end.
    rays: Histogram,
    /// The cycles in which the last of them ended, the latest last, at most so many.
    last_ends: VecDeque<u64>,
    most_ends: usize,
    /// For the shared side.
    pub misses: Vec<Miss>,
}

impl GroupSide {
    /// Idle groups from `first` on, as many as `machine` has. Of so many waiters at once the way of the last line is kept, and the function says where. When the last `ends` rays
    /// ended is kept, or of one.
    pub fn new(machine: &Machine, first: u32, (slots, slot): (usize, fn(u32) -> usize), ends: usize) -> Self {
        let groups = machine.cores.groups;
        let l1 = Level::new(&machine.l1, groups);
        Self {
            wheel: Wheel::new(),
            counts: Counts::default(),
            over_time: Series::new(),
            held: vec![VecDeque::new(); (groups * machine.l1.banks) as usize],
            paths: vec![Path::default(); l1.registers()],
            told: vec![Path::default(); slots],
            slot,
            rays: Histogram::default(),
            last_ends: VecDeque::new(),
            most_ends: ends.max(1),
            first,
            first_register: first * machine.l1.banks * machine.l1.mshrs,
            l1,
            misses: Vec::new(),
        }
    }

    /// This cycle.
    #[inline(always)]
    pub fn now(&self) -> u64 {
        self.wheel.now()
    }

    /// What was counted so far.
    pub fn counts(&self) -> Counts {
        self.counts_at(self.now())
    }

    /// What was counted up to `cycle`, this one or one until which nothing happens.
    pub fn counts_at(&self, cycle: u64) -> Counts {
        Counts { l1: self.l1.counts_at(cycle), ..self.counts }
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

    /// A ray ends in this cycle that began in cycle `started`, or a piece of work.
    #[inline]
    pub fn ray_ends(&mut self, started: u64, is_work: bool) {
        if self.last_ends.len() == self.most_ends {
            self.last_ends.pop_front();
        }
        self.last_ends.push_back(self.now());
        if !is_work {
            let cycles = self.now() - started;
            self.rays.add(cycles);
        }
    }

    /// The cycles in which the last rays ended, the latest last; none if none has.
    pub fn last_ends(&self) -> &VecDeque<u64> {
        &self.last_ends
    }

    /// Latencies of rays, and of misses of the L1s; and the requests that each bank of them looked up.
    pub fn distributions(&self) -> (&Histogram, &Histogram, Vec<u64>) {
        (&self.rays, &self.l1.latencies, self.l1.looked_up())
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

    /// `port` of `group` asks for a line, of which `waiter` is told; it is counted by whoever asks.
    #[inline]
    pub fn request(&mut self, group: u32, port: u32, waiter: u32, Ask { line, section, stores }: Ask) -> Asked {
        let now = self.now();
        let bank = self.l1.bank(group, line);
        if !stores && self.l1.hit_now(bank, line, now) {
            return Asked::Comes(now + self.l1.latency);
        }
        let request = CacheRequest { waiter, line, section, stores, since: now, held: 0, blocked: 0 };
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
                let group = self.first + self.l1.copy(bank);
                let ask = Ask { line: self.l1.line(register), section: self.l1.section(register), stores: self.l1.stores(register) };
                self.misses.push(Miss { cycle: known, group, register: self.first_register + register, ask });
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

    /// A line will come.
    pub fn comes(&mut self, fill: &Fill) {
        let register = fill.register - self.first_register;
        self.paths[register as usize] = fill.path;
        assert!(fill.cycle > self.now(), "a line of cycle {} comes too late", fill.cycle);
        self.enter(fill.cycle, fill.kind, register);
    }

    /// Tells [`Happening::Granted`] of `group` in `cycle`.
    pub fn grants_at(&mut self, cycle: u64, group: u32) {
        self.enter(cycle, EventKind::Grant, group);
    }

    fn fill_l1(&mut self, register: u32, kind: EventKind) {
        let now = self.now();
        let (wheel, told, slot, path, latency) =
            (&mut self.wheel, &mut self.told, self.slot, &self.paths[register as usize], self.l1.latency);
        let answer = |Waiter { waiter, before, since }: Waiter| {
            let end = now.max(since + latency);
            let mut rest = Path::default();
            if end > now {
                rest.add(Cause::L1LookUp, latency)
            } else {
                rest.add_rest(path, now - since)
            }
            told[slot(waiter)] = in_front(rest, before).ended(end);
            wheel.at(end, kind.class(), kind.event(waiter));
        };
        self.l1.land(register, answer);
        if self.l1.free(register, now) {
            self.serve_l1_and_tell(self.l1.bank_of(register));
        }
    }

    /// The next happening of this cycle.
    #[inline]
    pub fn take(&mut self) -> Option<Happening> {
        loop {
            if let Some(event) = self.wheel.take(MOVES) {
                let answer = if EventKind::of(event) == EventKind::FillL1FromL2 { EventKind::AnswerL2 } else { EventKind::AnswerDram };
                self.fill_l1(id(event), answer);
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
                let woken = self.wheel.take(WAKES).map(|event| Happening::Wake(id(event)));
                return woken.or_else(|| self.wheel.take(GRANTS).map(|event| Happening::Granted(id(event))));
            }
        }
    }

    /// Who is told soon what is like `happening`, if anybody: first far ahead, then near.
    #[inline(always)]
    pub fn soon(&self, happening: Happening) -> [Option<u32>; 2] {
        let class = match happening {
            Happening::Answer(..) => ANSWERS,
            Happening::Wake(_) => WAKES,
            Happening::Comes(..) | Happening::Granted(_) => return [None; 2],
        };
        [FAR, NEAR].map(|ahead| self.wheel.peek(class, ahead).map(id))
    }

    /// The next cycle in which something happens.
    #[inline]
    pub fn next(&self) -> Option<u64> {
        self.wheel.next()
    }

    /// Goes to `cycle`, which [`GroupSide::next`] gave.
    #[inline]
    pub fn go(&mut self, cycle: u64) {
        if let Some(end) = self.over_time.end_before(cycle) {
            self.over_time.note(end, self.counts_at(end));
        }
        self.wheel.go(cycle);
    }

    /// Requests queued and misses under way in the L1 of `group`.
    pub fn occupancy(&self, group: u32) -> (usize, usize) {
        self.l1.occupancy(group)
    }

    /// The L1s hold no lines any more.
    pub fn empty(&mut self) {
        self.l1.empty();
    }

    /// What is not at rest, for error messages.
    pub fn describe(&self) -> String {
        self.l1.describe("L1")
    }
}
