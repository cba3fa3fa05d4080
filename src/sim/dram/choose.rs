//! How a channel finds its next command, and its ranks' power-down.

use super::channel::{Act, CLOSE_ORDER, COLUMN_ORDER, Channel, Choice, REFRESH_ORDER, ROW_ORDER, Step};
use super::config::PagePolicy;
use super::counts::ChannelCounts;
use super::queue::NONE;
use super::ranks::NO_ROW;

impl Channel {
    /// Finds the next command: the earliest, and in one clock the first in order.
    pub(super) fn choose(&mut self) {
        let mut best = Choice { clock: u64::MAX, order: u64::MAX, act: Act::Refresh { rank: 0 } };
        let mut banks = self.queues[self.kind].banks;
        while banks != 0 {
            let bank = banks.trailing_zeros() as usize;
            banks &= banks - 1;
            let candidate = &self.candidates[bank];
            let limits = &self.limits[usize::from(candidate.group)];
            let clock = candidate.ready.max(limits.steps[candidate.step as usize]).max(self.free);
            if clock < limits.due && (clock, candidate.order) < (best.clock, best.order) {
                best = Choice { clock, order: candidate.order, act: Act::Towards { bank } };
            }
        }
        self.choose_close(&mut best);
        for rank in 0..self.ranks.ranks.len() {
            if best.clock >= self.ranks.ranks[rank].due {
                let (ready, close) = self.ranks.refresh_step(rank);
                let clock = self.awake(rank, ready.max(self.free));
                if (clock, REFRESH_ORDER) < (best.clock, best.order) {
                    best = Choice { clock, order: REFRESH_ORDER, act: if close { Act::CloseAll { rank } } else { Act::Refresh { rank } } };
                }
            }
        }
        self.next = (best.clock < u64::MAX).then_some(best);
    }

    /// Rows that nobody waits for, if the policy closes them.
    fn choose_close(&self, best: &mut Choice) {
        let unused = match self.controller.page {
            PagePolicy::Open => return,
            PagePolicy::Closed => 0,
            PagePolicy::Timeout(clocks) => clocks,
        };
        let mut banks = self.open & !self.queues[0].banks & !self.queues[1].banks;
        while banks != 0 {
            let bank = banks.trailing_zeros() as usize;
            banks &= banks - 1;
            let rank = self.ranks.rank_of(bank);
            let state = &self.ranks.banks[bank];
            let ready = state.precharge.max(state.last_use + unused).max(self.ranks.precharge_of_rank(rank));
            let clock = self.awake(rank, ready.max(self.free));
            if clock < self.ranks.ranks[rank].due && (clock, CLOSE_ORDER) < (best.clock, best.order) {
                *best = Choice { clock, order: CLOSE_ORDER, act: Act::Close { bank } };
            }
        }
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
            (Step::Activate, head, state.activate, ROW_ORDER)
        } else if hit != NONE && (hit == head || self.overtaken[bank] < self.controller.hit_cap) {
            (Step::Column, hit, state.column[self.kind], COLUMN_ORDER)
        } else {
            (Step::Precharge, head, state.precharge, ROW_ORDER)
        };
        let request = queue.get(slot);
        let candidate = &mut self.candidates[bank];
        candidate.step = step;
        candidate.slot = slot;
        candidate.ready = ready.max(request.arrival);
        candidate.order = order | request.age;
    }

    /// Recomputes the next steps of all banks.
    pub(super) fn update_candidates(&mut self) {
        for bank in 0..self.candidates.len() {
            self.update_candidate(bank);
        }
    }

    /// Recomputes what groups and ranks allow after a command to `rank`.
    pub(super) fn update_limits_of(&mut self, rank: usize) {
        if self.ranks.ranks.len() > 1 {
            return self.update_limits(); // the data bus is shared
        }
        for group in self.ranks.groups_of(rank) {
            self.update_limit(rank, group);
        }
    }

    /// Recomputes what groups and ranks allow.
    pub(super) fn update_limits(&mut self) {
        for rank in 0..self.ranks.ranks.len() {
            for group in self.ranks.groups_of(rank) {
                self.update_limit(rank, group);
            }
        }
    }

    fn update_limit(&mut self, rank: usize, group: usize) {
        let limits = &mut self.limits[group];
        limits.due = self.ranks.ranks[rank].due;
        limits.steps[Step::Column as usize] = self.ranks.column_of_group(group, self.kind);
        limits.steps[Step::Activate as usize] = self.ranks.activate_of_group(group);
        limits.steps[Step::Precharge as usize] = self.ranks.precharge_of_rank(rank);
    }

    /// Since when a rank is in power-down, if it is at clock `t` and nobody woke it.
    fn down_since(&self, rank: usize, t: u64) -> Option<u64> {
        let state = &self.ranks.ranks[rank];
        let since = state.idle_from + self.controller.power_down?;
        (state.waiting == 0 && since < t).then_some(since)
    }

    /// When a command that could be given at clock `t` can be given in truth, if the rank must be woken for it.
    fn awake(&self, rank: usize, t: u64) -> u64 {
        match self.down_since(rank, t) {
            Some(_) => t + self.ranks.timing.n_xp,
            None => t,
        }
    }

    /// Counts a rank's power-down up to clock `t`.
    pub(super) fn count_down(&self, rank: usize, t: u64, counts: &mut ChannelCounts) {
        let Some(since) = self.down_since(rank, t) else { return };
        if self.ranks.ranks[rank].open > 0 {
            counts.active_down_clocks += t - since;
        } else {
            counts.precharged_down_clocks += t - since;
        }
    }

    /// Before a command at clock `t` for which the rank was woken if it was in power-down.
    pub(super) fn leave_power_down(&mut self, rank: usize, t: u64) {
        let mut counts = self.counts;
        self.count_down(rank, t.saturating_sub(self.ranks.timing.n_xp), &mut counts);
        self.counts = counts;
    }

    /// Notes that a request for `bank` arrives at clock `t`; whether it woke the rank.
    pub(super) fn wake(&mut self, bank: usize, t: u64) -> bool {
        let rank = self.ranks.rank_of(bank);
        let woken = self.down_since(rank, t).is_some();
        if woken {
            let mut counts = self.counts;
            self.count_down(rank, t, &mut counts);
            self.counts = counts;
            self.ranks.hold(rank, t + self.ranks.timing.n_xp);
            self.update_limits();
        }
        self.ranks.ranks[rank].waiting += 1;
        woken
    }
}
