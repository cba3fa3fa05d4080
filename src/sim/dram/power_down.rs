//! Power-down: a rank that nobody asks for and that had no command for `power_down` clocks draws IDD2P or IDD3P, and costs nXP to wake.

use super::channel::Channel;
use super::counts::ChannelCounts;

impl Channel {
    /// Since when a rank is in power-down, if it is at clock `t` and nobody woke it.
    fn down_since(&self, rank: usize, t: u64) -> Option<u64> {
        let state = &self.ranks.ranks[rank];
        let since = state.idle_from + self.controller.power_down?;
        (state.waiting == 0 && since < t).then_some(since)
    }

    /// When a command that could be given at clock `t` can be given in truth, if the rank must be woken for it.
    pub(super) fn awake(&self, rank: usize, t: u64) -> u64 {
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
