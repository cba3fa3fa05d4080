//! The controller's side of a channel: which command is given next.
//!
//! Of the commands that are allowed in the earliest clock in which any is, one goes first by the [`Scheduler`]. One command per clock. The request for
//! which a row was opened is owed its read or write: until then the row stays open, for it nothing else of the bank is given, and it goes before other
//! requests, also if reads and writes have changed turns meanwhile. A due refresh goes before everything of its rank but what is owed.

use super::candidates::{BankCommand, Candidates, Choice, Purpose};
use super::config::{Controller, PagePolicy, Scheduler};
use super::counts::ChannelCounts;
use super::device::Device;
use super::queue::{DramRequest, NONE, Opened, Queue, READ, WRITE};
use super::ranks::{NO_ROW, Ranks};
use super::trace::{Command, Given};

/// The way of a request through its channel: until which clock each stretch lasted, from its arrival on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// Of waiting for its bank; while another row was closed for it; for the activates of other banks; while its row was opened (nRCD); for reads and
    /// writes before it, and the data bus; and from its command to its last data.
    pub ends: [u64; 6],
}

impl Way {
    /// The clock of its last data.
    pub fn end(&self) -> u64 {
        self.ends[5]
    }
}

/// One channel.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    pub(super) controller: Controller,
    pub(super) ranks: Ranks,
    pub(super) queues: [Queue; 2],
    /// Which queue is served: [`READ`] or [`WRITE`].
    pub(super) kind: usize,
    /// First request to the open row, by bank and kind.
    pub(super) hits: Vec<[u16; 2]>,
    /// Requests served before an older one of the bank since its activate; for [`Scheduler::OldestReadyCapped`] all that were served.
    pub(super) overtaken: Vec<u32>,
    /// Kind and slot of the request for which a bank's row was opened, until it is served.
    pub(super) owed: Vec<Option<(usize, u16)>>,
    /// Banks with such a request.
    pub(super) owing: u64,
    pub(super) candidates: Candidates,
    /// Where hits wait and an older request that wants another row: closing it for that one, if the scheduler may.
    pub(super) closers: Candidates,
    /// Banks of `closers`.
    pub(super) closing: u64,
    /// Banks whose hits count as not ready.
    pub(super) capped: u64,
    /// Banks with an open row.
    pub(super) open: u64,
    /// First clock without a command.
    pub(super) free: u64,
    pub(super) ages: u64,
    pub(super) next: Option<Choice>,
    pub counts: ChannelCounts,
    /// Requests to each bank.
    pub of_banks: Vec<u64>,
    pub trace: Option<Vec<Command>>,
}

impl Channel {
    /// A channel at clock 0, all rows closed.
    pub fn new(device: &Device, controller: &Controller) -> Self {
        let banks = device.banks();
        let mut channel = Self {
            candidates: Candidates::new(),
            closers: Candidates::new(),
            owed: vec![None; banks as usize],
            owing: 0,
            closing: 0,
            capped: 0,
            ranks: Ranks::new(device),
            queues: [Queue::new(controller.read_queue, banks), Queue::new(controller.write_queue, banks)],
            controller: controller.clone(),
            kind: READ,
            of_banks: vec![0; banks as usize],
            hits: vec![[NONE; 2]; banks as usize],
            overtaken: vec![0; banks as usize],
            open: 0,
            free: 0,
            ages: 0,
            next: None,
            counts: ChannelCounts::default(),
            trace: None,
        };
        channel.update_limits();
        channel.choose();
        channel
    }

    /// Requests that wait.
    pub fn waiting(&self) -> usize {
        self.queues[READ].len() + self.queues[WRITE].len()
    }

    /// Whether the queue has room.
    pub fn accepts(&self, write: bool) -> bool {
        !self.queues[usize::from(write)].is_full()
    }

    /// Clock of the next command.
    pub fn next_clock(&self) -> u64 {
        self.next.map_or(u64::MAX, |choice| choice.clock)
    }

    /// Takes a request whose first possible clock is `arrival`.
    ///
    /// # Panics
    /// The queue is full.
    pub fn push(&mut self, arrival: u64, bank: usize, row: u32, id: u64, write: bool) {
        let kind = usize::from(write);
        self.free = self.free.max(arrival); // if the other kind is now served, not in clocks that have passed
        let slot = self.queues[kind].push(bank, id, arrival, self.ages, row);
        self.ages += 1;
        self.counts.longest_queue = self.counts.longest_queue.max(self.waiting() as u64);
        self.of_banks[bank] += 1;
        let woken = self.wake(bank, arrival);
        let first_hit = self.ranks.banks[bank].row == row && self.hits[bank][kind] == NONE;
        if first_hit {
            self.hits[bank][kind] = slot;
        }
        let changed = kind == self.kind && (first_hit || self.queues[kind].head(bank) == slot);
        if self.choose_kind() || woken {
            self.update_candidates();
        } else if changed || self.controller.page != PagePolicy::Open {
            self.update_candidate(bank);
        } else {
            return;
        }
        self.choose();
    }

    /// Gives the commands up to clock `until`; `done` gets the id and way of each request whose read or write command was
    /// given.
    pub fn advance(&mut self, until: u64, done: &mut impl FnMut(u64, &Way)) {
        while let Some(choice) = self.next.filter(|choice| choice.clock <= until) {
            self.give(choice, done);
        }
    }

    /// What was done up to clock `t`, not before the last command.
    pub fn counts_at(&self, t: u64) -> ChannelCounts {
        let mut counts = self.counts;
        counts.queued_clocks += self.queues.iter().map(|queue| queue.standing.time(t)).sum::<u64>();
        counts.active_clocks = counts.active_clocks.saturating_add_signed(self.ranks.active_now(t));
        for rank in 0..self.ranks.ranks.len() {
            self.count_down(rank, t, &mut counts);
        }
        counts
    }

    fn give(&mut self, choice: Choice, done: &mut impl FnMut(u64, &Way)) {
        let t = choice.clock;
        self.free = t + 1;
        match choice.purpose {
            Purpose::Towards { bank, older } => {
                let candidates = if older { &self.closers } else { &self.candidates };
                let (step, slot) = (candidates.steps[bank], candidates.slots[bank]);
                if self.step(step, slot, bank, t, done) {
                    self.update_limits();
                    self.update_candidates();
                } else {
                    self.update_limits_of(self.ranks.rank_of(bank), step);
                    self.update_candidate(bank);
                }
            }
            Purpose::Close { bank } => {
                self.leave_power_down(self.ranks.rank_of(bank), t);
                self.close(bank, t);
                self.note(t, Given::Precharge { bank });
                self.update_limits_of(self.ranks.rank_of(bank), BankCommand::Precharge);
            }
            Purpose::CloseAll { rank } => {
                self.leave_power_down(rank, t);
                for bank in self.ranks.banks_of(rank) {
                    if self.ranks.banks[bank].row != NO_ROW {
                        self.close(bank, t);
                    }
                }
                self.note(t, Given::PrechargeAll { rank });
                self.update_limits();
                self.update_candidates();
            }
            Purpose::Refresh { rank } => {
                self.leave_power_down(rank, t);
                self.ranks.refresh(rank, t, &mut self.counts);
                self.note(t, Given::Refresh { rank });
                self.update_limits();
                self.update_candidates();
            }
        }
        self.choose();
    }

    /// Gives a step of a bank at clock `t`; whether the other kind is now served.
    fn step(&mut self, step: BankCommand, slot: u16, bank: usize, t: u64, done: &mut impl FnMut(u64, &Way)) -> bool {
        let kind = if step == BankCommand::Owed { 1 - self.kind } else { self.kind };
        match step {
            BankCommand::Activate => {
                let request = self.queues[kind].get_mut(slot);
                let row = request.row;
                (request.ready, request.activated) = (self.ranks.banks[bank].activate.max(request.arrival).min(t), t);
                if request.opened == Opened::Already {
                    request.opened = Opened::Activated;
                }
                self.ranks.activate(bank, row, t);
                self.counts.activates += 1;
                self.open |= 1 << bank;
                self.overtaken[bank] = 0;
                self.owed[bank] = Some((kind, slot));
                self.owing |= 1 << bank;
                self.hits[bank] = [self.first_hit(bank, READ, row), self.first_hit(bank, WRITE, row)];
                self.note(t, Given::Activate { bank, row });
                false
            }
            BankCommand::Precharge => {
                let request = self.queues[kind].get_mut(slot);
                (request.opened, request.closed) = (Opened::ClosedFirst, t);
                self.close(bank, t);
                self.note(t, Given::Precharge { bank });
                false
            }
            BankCommand::Column | BankCommand::Owed => {
                if slot != self.queues[kind].head(bank) || self.controller.scheduler == Scheduler::OldestReadyCapped {
                    self.overtaken[bank] += 1;
                }
                if self.owed[bank] == Some((kind, slot)) {
                    self.owed[bank] = None;
                    self.owing &= !(1 << bank);
                }
                let request = self.queues[kind].remove(bank, slot);
                self.hits[bank][kind] = self.queues[kind].first_to_row(Queue::after(&request), request.row);
                let rank = self.ranks.rank_of(bank);
                self.ranks.ranks[rank].waiting -= 1;
                let end = self.ranks.column(bank, kind, t);
                self.counts.bus_clocks += self.ranks.timing.n_bl;
                self.counts.queued_clocks += t - request.arrival;
                match request.opened {
                    Opened::Already => self.counts.row_hits += 1,
                    Opened::Activated => self.counts.row_misses += 1,
                    Opened::ClosedFirst => self.counts.row_conflicts += 1,
                }
                if kind == READ {
                    self.counts.reads += 1;
                    self.note(t, Given::Read { bank, row: request.row });
                } else {
                    self.counts.writes += 1;
                    self.note(t, Given::Write { bank, row: request.row });
                }
                done(request.id, &self.way(&request, t, end));
                self.choose_kind()
            }
        }
    }

    /// What a request that is read or written at clock `t` waited for.
    fn way(&self, request: &DramRequest, t: u64, end: u64) -> Way {
        let within = |clock: u64, from: u64| clock.clamp(from, t);
        // Whose row was open waits for nothing but reads and writes.
        let activated = if request.opened == Opened::Already { request.arrival } else { within(request.activated, request.arrival) };
        let ready = within(request.ready, request.arrival).min(activated);
        let closed = if request.opened == Opened::ClosedFirst { within(request.closed, request.arrival).min(ready) } else { ready };
        let opened = if request.opened == Opened::Already { activated } else { within(activated + self.ranks.timing.n_rcd_rd, activated) };
        Way { ends: [closed, ready, activated, opened, t, end] }
    }

    /// The oldest request of a kind to a bank's row.
    fn first_hit(&self, bank: usize, kind: usize, row: u32) -> u16 {
        let queue = &self.queues[kind];
        queue.first_to_row(queue.head(bank), row)
    }

    fn close(&mut self, bank: usize, t: u64) {
        debug_assert!(self.owed[bank].is_none(), "a row is closed before it was of use");
        self.ranks.precharge(bank, t, &mut self.counts);
        self.open &= !(1 << bank);
        self.hits[bank] = [NONE; 2];
    }

    fn note(&mut self, clock: u64, given: Given) {
        if let Some(trace) = &mut self.trace {
            trace.push(Command { clock, given });
        }
    }

    /// Chooses between reads and writes; whether it changed.
    fn choose_kind(&mut self) -> bool {
        let [reads, writes] = [READ, WRITE].map(|kind| self.queues[kind].len());
        let before = self.kind;
        self.kind = if self.kind == WRITE {
            if writes == 0 || (reads > 0 && writes <= usize::from(self.controller.write_low)) { READ } else { WRITE }
        } else if writes >= usize::from(self.controller.write_high) || (reads == 0 && writes > 0) {
            WRITE
        } else {
            READ
        };
        if self.kind != before {
            self.update_limits();
        }
        self.kind != before
    }
}
