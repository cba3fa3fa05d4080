//! The controller's side of a channel: which command is given next.
//!
//! FR-FCFS: of the commands that are allowed in the earliest clock in which any is, a read or write of an open row goes first, then the
//! oldest request's. One command per clock. A due refresh goes before everything of its rank. Requests of a bank may overtake its oldest
//! one `hit_cap` times per activate, so that none waits forever.

use super::candidates::{BankCommand, Candidates, Choice, Purpose};
use super::config::{Controller, PagePolicy};
use super::counts::ChannelCounts;
use super::device::Device;
use super::queue::{NONE, Opened, Queue, READ, WRITE};
use super::ranks::{NO_ROW, Ranks};
use super::trace::{Command, Given};

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
    /// Requests served before an older one of the bank since its activate.
    pub(super) overtaken: Vec<u32>,
    pub(super) candidates: Candidates,
    /// Banks with an open row.
    pub(super) open: u64,
    /// First clock without a command.
    pub(super) free: u64,
    pub(super) ages: u64,
    pub(super) next: Option<Choice>,
    pub counts: ChannelCounts,
    pub trace: Option<Vec<Command>>,
}

impl Channel {
    /// A channel at clock 0, all rows closed.
    pub fn new(device: &Device, controller: &Controller) -> Self {
        let banks = device.banks();
        let mut channel = Self {
            candidates: Candidates::new(),
            ranks: Ranks::new(device),
            queues: [Queue::new(controller.read_queue, banks), Queue::new(controller.write_queue, banks)],
            controller: controller.clone(),
            kind: READ,
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

    /// Gives the commands up to clock `until`; `done` gets the id and last data clock of each request whose read or write command was
    /// given.
    pub fn advance(&mut self, until: u64, done: &mut impl FnMut(u64, u64)) {
        while let Some(choice) = self.next.filter(|choice| choice.clock <= until) {
            self.give(choice, done);
        }
    }

    /// What was done up to clock `t`, not before the last command.
    pub fn counts_at(&self, t: u64) -> ChannelCounts {
        let mut counts = self.counts;
        counts.active_clocks = counts.active_clocks.saturating_add_signed(self.ranks.active_now(t));
        for rank in 0..self.ranks.ranks.len() {
            self.count_down(rank, t, &mut counts);
        }
        counts
    }

    fn give(&mut self, choice: Choice, done: &mut impl FnMut(u64, u64)) {
        let t = choice.clock;
        self.free = t + 1;
        match choice.purpose {
            Purpose::Towards { bank } => {
                let step = self.candidates.steps[bank];
                if self.step(bank, t, done) {
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

    /// Gives a bank's candidate at clock `t`; whether the other kind is now served.
    fn step(&mut self, bank: usize, t: u64, done: &mut impl FnMut(u64, u64)) -> bool {
        let (slot, kind) = (self.candidates.slots[bank], self.kind);
        match self.candidates.steps[bank] {
            BankCommand::Activate => {
                let request = self.queues[kind].get_mut(slot);
                let row = request.row;
                if request.opened == Opened::Already {
                    request.opened = Opened::Activated;
                }
                self.ranks.activate(bank, row, t);
                self.counts.activates += 1;
                self.open |= 1 << bank;
                self.overtaken[bank] = 0;
                self.hits[bank] = [self.first_hit(bank, READ, row), self.first_hit(bank, WRITE, row)];
                self.note(t, Given::Activate { bank, row });
                false
            }
            BankCommand::Precharge => {
                self.queues[kind].get_mut(slot).opened = Opened::ClosedFirst;
                self.close(bank, t);
                self.note(t, Given::Precharge { bank });
                false
            }
            BankCommand::Column => {
                if slot != self.queues[kind].head(bank) {
                    self.overtaken[bank] += 1;
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
                done(request.id, end);
                self.choose_kind()
            }
        }
    }

    /// The oldest request of a kind to a bank's row.
    fn first_hit(&self, bank: usize, kind: usize, row: u32) -> u16 {
        let queue = &self.queues[kind];
        queue.first_to_row(queue.head(bank), row)
    }

    fn close(&mut self, bank: usize, t: u64) {
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
