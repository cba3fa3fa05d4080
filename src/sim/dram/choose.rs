//! How a channel finds its next command.

use super::candidates::{
    BankCommand, CAPPED_ORDER, CLOSE_ORDER, COLUMN_ORDER, Choice, OWED_ORDER, Purpose, REFRESH_ORDER, ROW_ORDER, STEPS, clock_of, key,
};
use super::channel::Channel;
use super::config::{PagePolicy, Scheduler};
use super::queue::NONE;
use super::ranks::{MOST_BANKS, NO_ROW};

impl Channel {
    /// Finds the next command: the earliest, and in one clock the first in order.
    pub(super) fn choose(&mut self) {
        let mut best = u128::MAX;
        let mut purpose = Purpose::Refresh { rank: 0 };
        let waiting = self.queues[self.kind].banks | self.owing;
        let last_resort = self.last_resort();
        for rank in 0..self.ranks.ranks.len() {
            let mask = u64::MAX >> (MOST_BANKS - self.ranks.banks_of(rank).len()) << self.ranks.banks_of(rank).start;
            let towards =
                self.candidates.first(waiting & !self.capped & mask, self.free).min(self.candidates.first(last_resort & mask, self.free));
            let older = self.closers.first(self.closing & mask, self.free);
            let close = self.first_close(rank, mask);
            let mut mine = towards.min(older).min(close);
            let bank = mine as usize % MOST_BANKS; // the low bits of the order
            let mut mine_purpose = if mine == close { Purpose::Close { bank } } else { Purpose::Towards { bank, older: mine == older } };
            if clock_of(mine) >= self.ranks.ranks[rank].due {
                let owed = self.owing & mask;
                if owed == 0 {
                    let (ready, close) = self.ranks.refresh_step(rank);
                    mine = key(self.awake(rank, ready.max(self.free)), REFRESH_ORDER | rank as u64);
                    mine_purpose = if close { Purpose::CloseAll { rank } } else { Purpose::Refresh { rank } };
                } else {
                    mine = self.candidates.first(owed, self.free);
                    mine_purpose = Purpose::Towards { bank: mine as usize % MOST_BANKS, older: false };
                }
            }
            if mine < best {
                (best, purpose) = (mine, mine_purpose);
            }
        }
        self.next = Some(Choice { clock: clock_of(best), purpose });
    }

    /// The bank whose hit counts as not ready but is served where nothing else is, as the oldest request of all is one.
    fn last_resort(&self) -> u64 {
        if self.capped == 0 {
            return 0;
        }
        let queue = &self.queues[self.kind];
        let mut oldest = (u64::MAX, 0, NONE);
        let mut banks = queue.banks;
        while banks != 0 {
            let bank = banks.trailing_zeros() as usize;
            banks &= banks - 1;
            // What is owed stands beside the queue.
            let head = queue.head(bank);
            let slot = if self.owed[bank] == Some((self.kind, head)) { queue.second(bank) } else { head };
            if slot != NONE {
                oldest = oldest.min((queue.get(slot).age, bank, slot));
            }
        }
        let (_, bank, slot) = oldest;
        if slot != NONE && self.candidates.slots[bank] == slot { self.capped & 1 << bank } else { 0 }
    }

    /// Rows that nobody waits for, if the policy closes them.
    fn first_close(&self, rank: usize, mask: u64) -> u128 {
        let unused = match self.controller.page {
            PagePolicy::Open => return u128::MAX,
            PagePolicy::Closed => 0,
            PagePolicy::Timeout(clocks) => clocks,
        };
        let mut best = u128::MAX;
        let mut banks = self.open & mask & !self.queues[0].banks & !self.queues[1].banks;
        while banks != 0 {
            let bank = banks.trailing_zeros() as usize;
            banks &= banks - 1;
            let state = &self.ranks.banks[bank];
            let ready = state.precharge.max(state.last_use + unused).max(self.ranks.precharge_of_rank(rank));
            let clock = self.awake(rank, ready.max(self.free));
            best = best.min(key(clock, CLOSE_ORDER | bank as u64));
        }
        best
    }

    /// Recomputes the next step of a bank's queue.
    pub(super) fn update_candidate(&mut self, bank: usize) {
        let (at, scheduler) = (1 << bank, self.controller.scheduler);
        self.closing &= !at;
        self.capped &= !at;
        let state = &self.ranks.banks[bank];
        if let Some((kind, slot)) = self.owed[bank] {
            let step = if kind == self.kind { BankCommand::Column } else { BankCommand::Owed };
            let ready = state.column[kind];
            return self.put(bank, false, (step, kind, slot), ready, OWED_ORDER);
        }
        let (head, hit) = (self.queues[self.kind].head(bank), self.hits[bank][self.kind]);
        if head == NONE {
            return;
        }
        let (activate, precharge, column) = (state.activate, state.precharge, state.column[self.kind]);
        let by_age = matches!(scheduler, Scheduler::OldestReady | Scheduler::OldestReadyCapped);
        let row_order = if by_age { COLUMN_ORDER } else { ROW_ORDER };
        let overtaken = self.overtaken[bank];
        if state.row == NO_ROW {
            self.put(bank, false, (BankCommand::Activate, self.kind, head), activate, row_order);
        } else if hit == NONE || scheduler == Scheduler::HitsCapped && hit != head && overtaken >= self.controller.hit_cap {
            self.put(bank, false, (BankCommand::Precharge, self.kind, head), precharge, row_order);
        } else {
            let capped = scheduler == Scheduler::OldestReadyCapped && overtaken > self.controller.hit_cap;
            let order = if capped { CAPPED_ORDER } else { COLUMN_ORDER };
            self.capped |= if capped { at } else { 0 };
            self.put(bank, false, (BankCommand::Column, self.kind, hit), column, order);
            if by_age && hit != head {
                self.closing |= at;
                self.put(bank, true, (BankCommand::Precharge, self.kind, head), precharge, row_order);
            }
        }
    }

    /// Notes a step towards a request of a kind in a slot.
    fn put(&mut self, bank: usize, older: bool, (step, kind, slot): (BankCommand, usize, u16), ready: u64, order: u64) {
        let request = self.queues[kind].get(slot);
        let candidates = if older { &mut self.closers } else { &mut self.candidates };
        candidates.steps[bank] = step;
        candidates.slots[bank] = slot;
        candidates.limit[bank] = (self.ranks.group_of(bank) * STEPS + step as usize) as u8; // a group has a bank at least: below 256
        candidates.ready[bank] = ready.max(request.arrival);
        candidates.orders[bank] = order | request.age << 6 | bank as u64;
    }

    /// Recomputes the next steps of all banks.
    pub(super) fn update_candidates(&mut self) {
        for bank in 0..self.ranks.banks.len() {
            self.update_candidate(bank);
        }
    }

    /// Recomputes what groups and ranks allow after a step in `rank`.
    pub(super) fn update_limits_of(&mut self, rank: usize, step: BankCommand) {
        let column = matches!(step, BankCommand::Column | BankCommand::Owed);
        if column && self.ranks.ranks.len() > 1 {
            return self.update_limits(); // the data bus is shared
        }
        for group in self.ranks.groups_of(rank) {
            if column {
                self.update_limit(rank, group, BankCommand::Column);
                self.update_limit(rank, group, BankCommand::Owed);
            } else {
                self.update_limit(rank, group, step);
            }
        }
    }

    /// Recomputes what groups and ranks allow.
    pub(super) fn update_limits(&mut self) {
        for rank in 0..self.ranks.ranks.len() {
            for group in self.ranks.groups_of(rank) {
                for step in [BankCommand::Column, BankCommand::Activate, BankCommand::Precharge, BankCommand::Owed] {
                    self.update_limit(rank, group, step);
                }
            }
        }
    }

    fn update_limit(&mut self, rank: usize, group: usize, step: BankCommand) {
        let limit = match step {
            BankCommand::Column => self.ranks.column_of_group(rank, group, self.kind),
            BankCommand::Activate => self.ranks.activate_of_group(rank, group),
            BankCommand::Precharge => self.ranks.precharge_of_rank(rank),
            BankCommand::Owed => self.ranks.column_of_group(rank, group, 1 - self.kind),
        };
        self.candidates.limits[group * STEPS + step as usize] = limit;
        self.closers.limits[group * STEPS + step as usize] = limit;
    }
}
