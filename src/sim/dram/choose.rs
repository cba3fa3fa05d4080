//! How a channel finds its next command.

use super::candidates::{BankCommand, CLOSE_ORDER, COLUMN_ORDER, Choice, Purpose, REFRESH_ORDER, ROW_ORDER, STEPS, clock_of, key};
use super::channel::Channel;
use super::config::PagePolicy;
use super::queue::NONE;
use super::ranks::{MOST_BANKS, NO_ROW};

impl Channel {
    /// Finds the next command: the earliest, and in one clock the first in order.
    pub(super) fn choose(&mut self) {
        let mut best = u128::MAX;
        let mut purpose = Purpose::Refresh { rank: 0 };
        for rank in 0..self.ranks.ranks.len() {
            let mask = u64::MAX >> (MOST_BANKS - self.ranks.banks_of(rank).len()) << self.ranks.banks_of(rank).start;
            let towards = self.candidates.first(self.queues[self.kind].banks & mask, self.free);
            let close = self.first_close(rank, mask);
            let mut mine = towards.min(close);
            let bank = mine as usize % MOST_BANKS; // the low bits of the order
            let mut mine_purpose = if towards <= close { Purpose::Towards { bank } } else { Purpose::Close { bank } };
            if clock_of(mine) >= self.ranks.ranks[rank].due {
                let (ready, close) = self.ranks.refresh_step(rank);
                mine = key(self.awake(rank, ready.max(self.free)), REFRESH_ORDER | rank as u64);
                mine_purpose = if close { Purpose::CloseAll { rank } } else { Purpose::Refresh { rank } };
            }
            if mine < best {
                (best, purpose) = (mine, mine_purpose);
            }
        }
        self.next = Some(Choice { clock: clock_of(best), purpose });
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
        let queue = &self.queues[self.kind];
        let (head, hit) = (queue.head(bank), self.hits[bank][self.kind]);
        if head == NONE {
            return;
        }
        let state = &self.ranks.banks[bank];
        let (step, slot, ready, order) = if state.row == NO_ROW {
            (BankCommand::Activate, head, state.activate, ROW_ORDER)
        } else if hit != NONE && (hit == head || self.overtaken[bank] < self.controller.hit_cap) {
            (BankCommand::Column, hit, state.column[self.kind], COLUMN_ORDER)
        } else {
            (BankCommand::Precharge, head, state.precharge, ROW_ORDER)
        };
        let request = queue.get(slot);
        let candidates = &mut self.candidates;
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
        if step == BankCommand::Column && self.ranks.ranks.len() > 1 {
            return self.update_limits(); // the data bus is shared
        }
        for group in self.ranks.groups_of(rank) {
            self.update_limit(rank, group, step);
        }
    }

    /// Recomputes what groups and ranks allow.
    pub(super) fn update_limits(&mut self) {
        for rank in 0..self.ranks.ranks.len() {
            for group in self.ranks.groups_of(rank) {
                for step in [BankCommand::Column, BankCommand::Activate, BankCommand::Precharge] {
                    self.update_limit(rank, group, step);
                }
            }
        }
    }

    fn update_limit(&mut self, rank: usize, group: usize, step: BankCommand) {
        self.candidates.limits[group * STEPS + step as usize] = match step {
            BankCommand::Column => self.ranks.column_of_group(rank, group, self.kind),
            BankCommand::Activate => self.ranks.activate_of_group(rank, group),
            BankCommand::Precharge => self.ranks.precharge_of_rank(rank),
        };
    }
}
