//! A level of cache: banks that each take a request per cycle, with a queue in front, tags, and registers for misses.

use super::causes::{MissCauses, Shadow};
use super::counts::CacheCounts;
use super::mshr::{Entered, Mshrs, Waiter};
use super::prefetch::prefetch;
use super::stalls::Histogram;
use super::tags::Tags;
use crate::machine::Cache;
use crate::sim::dram::Standing;
use crate::step::SectionId;
use std::collections::{HashMap, VecDeque};

/// A request in front of a bank.
#[derive(Clone, Copy, Debug)]
pub struct CacheRequest {
    /// Who gets the answer.
    pub waiter: u32,
    /// The line.
    pub line: u32,
    /// What it holds.
    pub section: SectionId,
    /// It is written.
    pub stores: bool,
    /// The cycle since when it waits in the queue.
    pub since: u64,
    /// Cycles that it waited before the queue, which was full.
    pub held: u32,
    /// Cycles that its bank had stood still when it came.
    pub blocked: u64,
}

/// A bank.
#[derive(Clone, Debug, Default)]
struct Bank {
    queue: VecDeque<CacheRequest>,
    /// The first cycle in which it can look up again.
    free: u64,
    /// It will look up the queue's head in a cycle that is entered in the wheel.
    awake: bool,
    /// Since when its head has no room among the misses.
    blocked: Option<u64>,
    /// Cycles in which it had none before that.
    stood_still: u64,
    /// Requests looked up.
    looked_up: u64,
}

impl Bank {
    /// Cycles up to `now` in which its head had no room among the misses.
    #[inline]
    fn blocked_cycles(&self, now: u64) -> u64 {
        self.stood_still + self.blocked.map_or(0, |since| now - since)
    }
}

/// What a look-up gave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Served {
    /// Found.
    Hit,
    /// Not found; the register, through all banks, that keeps the miss, to be asked of the next level.
    Miss(u32),
    /// Not found, but asked for.
    Merged,
}

/// A look-up.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Who gets the answer.
    pub waiter: u32,
    /// Cycles that it waited before the bank's full queue, in it for its turn, and while the bank stood still.
    pub before: [u32; 3],
    /// What became of it.
    pub served: Served,
    /// To come back in the next cycle.
    pub again: bool,
}

/// A level: one cache, or one for each group.
pub struct Level {
    banks: Vec<Bank>,
    per_copy: u32,
    tags: Tags,
    /// Lines that it has and memory has not, and what they hold, where it keeps what is written; none where that goes through it to the next level.
    dirty: Option<HashMap<u32, SectionId>>,
    /// Such lines that had to go, for whoever writes them to memory.
    pub written_back: Vec<(u32, SectionId)>,
    /// Why it misses, where that is asked.
    shadow: Option<Shadow>,
    mshrs: Mshrs,
    mshrs_per_bank: u32,
    queue: usize,
    /// Requests in the queues of all banks.
    queued: Standing,
    /// Cycles of a look-up.
    pub latency: u64,
    /// What it did.
    pub counts: CacheCounts,
    /// Cycles from a miss to its line.
    pub latencies: Histogram,
}

impl Level {
    /// `copies` empty caches.
    pub fn new(cache: &Cache, copies: u32) -> Self {
        let banks = cache.banks * copies;
        Self {
            banks: vec![Bank::default(); banks as usize],
            per_copy: cache.banks,
            tags: Tags::new(cache, copies),
            dirty: None,
            written_back: Vec::new(),
            shadow: None,
            mshrs: Mshrs::new(banks, cache.mshrs, cache.targets),
            mshrs_per_bank: cache.mshrs,
            queue: cache.queue as usize,
            queued: Standing::default(),
            latency: u64::from(cache.latency_cycles),
            counts: CacheCounts::default(),
            latencies: Histogram::default(),
        }
    }

    /// The same single cache, which keeps what is written and tells why it misses.
    pub fn explaining(cache: &Cache) -> Self {
        let sets = u64::from(cache.banks) * cache.sets_per_bank();
        Self { dirty: Some(HashMap::new()), shadow: Some(Shadow::new(cache.lines(), sets)), ..Self::new(cache, 1) }
    }

    /// Why it missed, and the different lines of the busiest set and of all.
    pub fn causes(&self) -> (MissCauses, (u64, u64)) {
        self.shadow.as_ref().map(|shadow| (shadow.causes(), shadow.busiest_set())).unwrap_or_default()
    }

    /// The bank of `line` in cache `copy`, counted through all.
    #[inline]
    pub fn bank(&self, copy: u32, line: u32) -> u32 {
        copy * self.per_copy + self.tags.bank(line)
    }

    /// The cache of a bank.
    pub fn copy(&self, bank: u32) -> u32 {
        bank / self.per_copy
    }

    /// The bank of a miss register.
    pub fn bank_of(&self, register: u32) -> u32 {
        register / self.mshrs_per_bank
    }

    /// The line of a miss register.
    pub fn line(&self, register: u32) -> u32 {
        self.mshrs.line(register)
    }

    /// Whether a miss register is a store's.
    pub fn stores(&self, register: u32) -> bool {
        self.mshrs.stores(register)
    }

    /// What the line of a miss register holds.
    pub fn section(&self, register: u32) -> SectionId {
        self.mshrs.section(register)
    }

    /// Whether `bank` has room for `ahead` requests and one more.
    #[inline]
    pub fn has_room(&self, bank: u32, ahead: usize) -> bool {
        self.banks[bank as usize].queue.len() + ahead < self.queue
    }

    /// Looks up `line` in `bank` at once, if nobody is before it: true if it is found. Otherwise nothing has happened.
    #[inline(always)]
    pub fn hit_now(&mut self, bank: u32, line: u32, now: u64) -> bool {
        let state = &mut self.banks[bank as usize];
        if state.awake || state.free > now || !state.queue.is_empty() || !self.tags.look_up(bank, line) {
            return false;
        }
        if let Some(shadow) = &mut self.shadow {
            shadow.look_up(line, self.tags.set_of_all(line), false);
        }
        state.free = now + 1;
        state.looked_up += 1;
        self.counts.hits += 1;
        self.counts.requests += 1;
        true
    }

    /// Puts a request into the queue of `bank`. Gives the cycle in which to [`Level::serve`] the bank, if it slept.
    #[inline]
    pub fn enqueue(&mut self, bank: u32, request: CacheRequest) -> Option<u64> {
        let bank = &mut self.banks[bank as usize];
        self.queued.comes(request.since);
        bank.queue.push_back(CacheRequest { blocked: bank.blocked_cycles(request.since), ..request });
        self.counts.longest_queue = self.counts.longest_queue.max(bank.queue.len() as u64);
        if bank.awake || bank.blocked.is_some() {
            return None;
        }
        bank.awake = true;
        Some(bank.free.max(request.since))
    }

    /// Looks up the head of the queue of `bank` in cycle `now`; `None`
    /// if there is no room for its miss: the bank sleeps until [`Level::free`].
    #[inline]
    pub fn serve(&mut self, bank: u32, now: u64) -> Option<Look> {
        let state = &mut self.banks[bank as usize];
        state.awake = false;
        let request = *state.queue.front()?;
        let still = state.blocked_cycles(now) - request.blocked;
        let turn = now - request.since - still;
        let before = [request.held, turn as u32, still as u32]; // a wait of 2^32 cycles does not end
        let waiter = Waiter { waiter: request.waiter, before, since: now };
        let served = if request.stores {
            match self.store(bank, &request, waiter) {
                Some(served) => served,
                None => {
                    self.banks[bank as usize].blocked = Some(now);
                    return None;
                }
            }
        } else if self.tags.look_up(bank, request.line) {
            self.counts.hits += 1;
            Served::Hit
        } else {
            match self.mshrs.enter(bank, request.line, request.section, waiter) {
                Entered::New { slot } => {
                    self.counts.misses += 1;
                    Served::Miss(bank * self.mshrs_per_bank + slot)
                }
                Entered::Merged => {
                    self.counts.merges += 1;
                    Served::Merged
                }
                Entered::Full => {
                    state.blocked = Some(now);
                    return None;
                }
            }
        };
        if let Some(shadow) = &mut self.shadow {
            shadow.look_up(request.line, self.tags.set_of_all(request.line), matches!(served, Served::Miss(_)));
        }
        let state = &mut self.banks[bank as usize];
        state.queue.pop_front();
        self.queued.goes(request.since);
        state.looked_up += 1;
        state.free = now + 1;
        state.awake = !state.queue.is_empty();
        self.counts.requests += 1;
        self.counts.queued_cycles += now - request.since;
        self.counts.conflicts += u64::from(now > request.since);
        Some(Look { waiter: request.waiter, before, served, again: state.awake })
    }

    /// A line is written. Where what is written goes on to the next level, a register keeps it until that has it; where it stays, it takes a place as one that was read does,
    /// unless a read of it is under way, whose place it will have. `None` if there is no room.
    fn store(&mut self, bank: u32, request: &CacheRequest, waiter: Waiter) -> Option<Served> {
        let CacheRequest { line, section, .. } = *request;
        let is_there = self.tags.look_up(bank, line);
        let Some(dirty) = &mut self.dirty else {
            let Entered::New { slot } = self.mshrs.enter_store(bank, line, section, waiter) else { return None };
            self.counts.stores += 1;
            self.counts.updates += u64::from(is_there);
            return Some(Served::Miss(bank * self.mshrs_per_bank + slot));
        };
        let is_under_way = !is_there && self.mshrs.is_open(bank, line);
        if is_under_way && self.mshrs.enter(bank, line, section, waiter) == Entered::Full {
            return None;
        }
        dirty.insert(line, section);
        self.counts.stores += 1;
        self.counts.updates += 1;
        if is_under_way {
            return Some(Served::Merged);
        }
        if !is_there {
            self.place(bank, line);
        }
        Some(Served::Hit)
    }

    /// Gives a line a place; the one that goes for it is written back if memory does not have it.
    #[inline]
    fn place(&mut self, bank: u32, line: u32) {
        let gone = self.tags.fill(bank, line);
        if let Some(dirty) = self.dirty.as_mut().filter(|dirty| !dirty.is_empty())
            && let Some((line, section)) = gone.and_then(|gone| dirty.remove_entry(&gone))
        {
            self.counts.write_backs += 1;
            self.written_back.push((line, section));
        }
    }

    /// Holds no lines any more; what was written has gone on to the next level.
    pub fn empty(&mut self) {
        debug_assert!(self.dirty.is_none(), "what is written would be lost");
        self.tags.clear();
    }

    /// Lines that it has and memory has not.
    pub fn dirty_lines(&self) -> u64 {
        self.dirty.as_ref().map_or(0, |dirty| dirty.len() as u64)
    }

    /// The line of `register` is written: from now on it is found, but for a store's, which the next level has; who waits for it is given to `answer`, and nobody joins them.
    pub fn land(&mut self, register: u32, answer: impl FnMut(Waiter)) {
        if !self.mshrs.stores(register) {
            self.place(self.bank_of(register), self.mshrs.line(register));
            self.counts.fills += 1;
        }
        self.mshrs.land(register, answer);
    }

    /// `register`, whose line was written, is free in cycle `now`. True if the bank was blocked and is to be served now.
    pub fn free(&mut self, register: u32, now: u64) -> bool {
        let is_store = self.mshrs.stores(register);
        let taken = now - self.mshrs.free(register);
        self.counts.register_cycles += taken;
        if !is_store {
            self.latencies.add(taken);
        }
        let bank = self.bank_of(register);
        let bank = &mut self.banks[bank as usize];
        let Some(since) = bank.blocked.take() else { return false };
        self.counts.blocked_cycles += now - since;
        bank.stood_still += now - since;
        bank.awake = true;
        true
    }

    /// What it did before cycle `cycle`, the next or one until which nothing happens here; registers in use and requests queued count up to then.
    pub fn counts_at(&self, cycle: u64) -> CacheCounts {
        let registers = self.mshrs.standing;
        CacheCounts {
            most_registers: self.mshrs.most.into(),
            register_cycles: self.counts.register_cycles + registers.time(cycle),
            queued_cycles: self.counts.queued_cycles + self.queued.time(cycle),
            registers_now: registers.count(),
            queued_now: self.queued.count(),
            ..self.counts
        }
    }

    /// How many miss registers there are.
    pub fn registers(&self) -> usize {
        self.banks.len() * self.mshrs_per_bank as usize
    }

    /// Requests looked up, by bank.
    pub fn looked_up(&self) -> Vec<u64> {
        self.banks.iter().map(|bank| bank.looked_up).collect()
    }

    /// `bank` is served soon.
    #[inline(always)]
    pub fn prefetch(&self, bank: u32) {
        prefetch(&self.banks, bank as usize);
    }

    /// The same, later: its state is there.
    #[inline(always)]
    pub fn prefetch_tags(&self, bank: u32) {
        if let Some(request) = self.banks[bank as usize].queue.front() {
            self.tags.prefetch(bank, request.line);
        }
    }

    /// Requests queued and misses under way in cache `copy`.
    pub fn occupancy(&self, copy: u32) -> (usize, usize) {
        let banks = copy * self.per_copy..(copy + 1) * self.per_copy;
        banks.fold((0, 0), |(queued, misses), bank| (queued + self.banks[bank as usize].queue.len(), misses + self.mshrs.in_use_of(bank)))
    }

    /// What is not at rest, for error messages.
    pub fn describe(&self, name: &str) -> String {
        let waiting: usize = self.banks.iter().map(|bank| bank.queue.len()).sum();
        let blocked = self.banks.iter().filter(|bank| bank.blocked.is_some()).count();
        format!(
            "{name}: {waiting} requests queued, {blocked} banks blocked, {} misses under way",
            (0..self.banks.len() as u32).map(|bank| self.mshrs.in_use_of(bank)).sum::<usize>()
        )
    }
}
