//! The device's side of a channel: which rows are open, and from which clock on each command is allowed.
//!
//! Every command pushes the earliest clocks of later commands forward, at the level at which the rule holds: bank, bank group, rank, other
//! ranks.

use super::counts::ChannelCounts;
use super::device::{Device, Timing};
use super::queue::{READ, WRITE};

/// Most banks of a channel: as many as a word has flags.
pub(super) const MOST_BANKS: usize = 64;

/// No row is open.
pub(super) const NO_ROW: u32 = u32::MAX;

/// Earliest clocks of a bank's commands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bank {
    /// The open row, or [`NO_ROW`].
    pub row: u32,
    pub activate: u64,
    pub precharge: u64,
    /// Read and write.
    pub column: [u64; 2],
    /// When the row was last read, written or opened.
    pub last_use: u64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Group {
    activate: u64,
    column: [u64; 2],
}

/// Earliest clocks of a rank's commands, and what it is doing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rank {
    activate: u64,
    column: [u64; 2],
    precharge: u64,
    /// The last four activates, oldest at `oldest`; `None` before there were as many.
    window: [Option<u64>; 4],
    oldest: usize,
    /// When the next refresh is due.
    pub due: u64,
    /// Banks with an open row.
    pub open: u32,
    /// Since when some bank was open, if one is.
    active_since: u64,
    /// End of the last refresh.
    refreshed: u64,
    /// Since when no command is under way.
    pub idle_from: u64,
    /// Requests that wait for this rank.
    pub waiting: u32,
}

/// Ranks, bank groups and banks of a channel. A bank's number is (rank x groups + group) x banks per group + bank, a group's rank x groups
/// + group.
#[derive(Clone, Debug)]
pub(super) struct Ranks {
    pub timing: Timing,
    pub banks: Vec<Bank>,
    pub ranks: Vec<Rank>,
    groups: Vec<Group>,
    groups_per_rank: usize,
    banks_per_rank: usize,
    /// Group and rank of each bank.
    homes: [(u8, u8); MOST_BANKS],
}

impl Ranks {
    /// All banks precharged, every command allowed at clock 0.
    pub fn new(device: &Device) -> Self {
        let organisation = &device.organisation;
        let bank = Bank { row: NO_ROW, activate: 0, precharge: 0, column: [0; 2], last_use: 0 };
        let rank = Rank {
            activate: 0,
            column: [0; 2],
            precharge: 0,
            window: [None; 4],
            oldest: 0,
            due: device.timing.n_refi,
            open: 0,
            active_since: 0,
            refreshed: 0,
            idle_from: 0,
            waiting: 0,
        };
        let banks_per_group = organisation.banks_per_group as usize;
        let banks_per_rank = banks_per_group * organisation.bank_groups as usize;
        Self {
            timing: device.timing.clone(),
            banks: vec![bank; device.banks() as usize],
            ranks: vec![rank; organisation.ranks as usize],
            groups: vec![Group::default(); (organisation.ranks * organisation.bank_groups) as usize],
            groups_per_rank: organisation.bank_groups as usize,
            banks_per_rank,
            homes: std::array::from_fn(|bank| ((bank / banks_per_group) as u8, (bank / banks_per_rank) as u8)), // at most 63
        }
    }

    /// The group of a bank.
    pub fn group_of(&self, bank: usize) -> usize {
        usize::from(self.homes[bank].0)
    }

    /// The rank of a bank.
    pub fn rank_of(&self, bank: usize) -> usize {
        usize::from(self.homes[bank].1)
    }

    /// The banks of a rank.
    pub fn banks_of(&self, rank: usize) -> std::ops::Range<usize> {
        rank * self.banks_per_rank..(rank + 1) * self.banks_per_rank
    }

    /// The groups of a rank.
    pub fn groups_of(&self, rank: usize) -> std::ops::Range<usize> {
        rank * self.groups_per_rank..(rank + 1) * self.groups_per_rank
    }

    /// First clock that a group and its rank allow a read or write.
    pub fn column_of_group(&self, rank: usize, group: usize, kind: usize) -> u64 {
        self.groups[group].column[kind].max(self.ranks[rank].column[kind])
    }

    /// First clock that a group and its rank allow an activate.
    pub fn activate_of_group(&self, rank: usize, group: usize) -> u64 {
        let rank = &self.ranks[rank];
        let window = rank.window[rank.oldest].map_or(0, |clock| clock + self.timing.n_faw);
        self.groups[group].activate.max(rank.activate).max(window)
    }

    /// First clock that the rank allows a precharge.
    pub fn precharge_of_rank(&self, rank: usize) -> u64 {
        self.ranks[rank].precharge
    }

    /// First clock for what a due refresh needs next: closing all rows (`true`) or the refresh itself.
    pub fn refresh_step(&self, rank: usize) -> (u64, bool) {
        let state = &self.ranks[rank];
        let banks = &self.banks[self.banks_of(rank)];
        if state.open > 0 {
            let open = banks.iter().filter(|bank| bank.row != NO_ROW);
            (open.map(|bank| bank.precharge).max().unwrap_or(0).max(state.precharge).max(state.due), true)
        } else {
            // A bank that may be activated may be refreshed: nRP, nRC and nRFC hold for both.
            (banks.iter().map(|bank| bank.activate).max().unwrap_or(0).max(state.due), false)
        }
    }

    /// Opens a row at clock `t`.
    pub fn activate(&mut self, bank: usize, row: u32, t: u64) {
        let (group, rank) = (self.group_of(bank), self.rank_of(bank));
        let n = &self.timing;
        let state = &mut self.banks[bank];
        state.row = row;
        state.last_use = t;
        state.activate = t + n.n_rc;
        state.precharge = t + n.n_ras;
        state.column = [t + n.n_rcd_rd, t + n.n_rcd_wr];
        self.groups[group].activate = t + n.n_rrd_l;
        let rank = &mut self.ranks[rank];
        rank.activate = t + n.n_rrd_s;
        rank.window[rank.oldest] = Some(t);
        rank.oldest = (rank.oldest + 1) % rank.window.len();
        if rank.open == 0 {
            rank.active_since = t;
        }
        rank.open += 1;
        rank.idle_from = rank.idle_from.max(t + 1);
    }

    /// Closes a bank's row at clock `t`.
    pub fn precharge(&mut self, bank: usize, t: u64, counts: &mut ChannelCounts) {
        let rank = self.rank_of(bank);
        let state = &mut self.banks[bank];
        state.row = NO_ROW;
        state.activate = state.activate.max(t + self.timing.n_rp);
        let rank = &mut self.ranks[rank];
        rank.precharge = t + self.timing.n_ppd;
        rank.open -= 1;
        if rank.open == 0 {
            counts.active_clocks += t - rank.active_since;
        }
        rank.idle_from = rank.idle_from.max(t + 1);
        counts.precharges += 1;
    }

    /// Reads or writes a line of the open row at clock `t`; returns the clock in which its data are through.
    pub fn column(&mut self, bank: usize, kind: usize, t: u64) -> u64 {
        let (group, rank) = (self.group_of(bank), self.rank_of(bank));
        let n = &self.timing;
        let state = &mut self.banks[bank];
        state.last_use = t;
        let later = |clock: &mut u64, at: u64| *clock = (*clock).max(at);
        let end;
        if kind == READ {
            end = t + n.n_cl + n.n_bl;
            later(&mut state.precharge, t + n.n_rtp);
            later(&mut self.groups[group].column[READ], t + n.n_ccd_l);
            later(&mut self.ranks[rank].column[READ], t + n.n_ccd_s);
            later(&mut self.ranks[rank].column[WRITE], t + n.n_rtw);
            later(&mut self.ranks[rank].idle_from, end);
        } else {
            end = t + n.n_cwl + n.n_bl;
            later(&mut state.precharge, end + n.n_wr);
            later(&mut self.groups[group].column[WRITE], t + n.n_ccd_l);
            later(&mut self.ranks[rank].column[WRITE], t + n.n_ccd_s);
            later(&mut self.groups[group].column[READ], end + n.n_wtr_l);
            later(&mut self.ranks[rank].column[READ], end + n.n_wtr_s);
            later(&mut self.ranks[rank].idle_from, end + n.n_wr);
        }
        // Another rank's burst must start nRTRS after this one's end.
        for (_, other) in self.ranks.iter_mut().enumerate().filter(|(other, _)| *other != rank) {
            later(&mut other.column[READ], (end + n.n_rtrs).saturating_sub(n.n_cl));
            later(&mut other.column[WRITE], (end + n.n_rtrs).saturating_sub(n.n_cwl));
        }
        end
    }

    /// Refreshes a rank, all rows closed, at clock `t`.
    pub fn refresh(&mut self, rank: usize, t: u64, counts: &mut ChannelCounts) {
        let end = t + self.timing.n_rfc;
        for bank in self.banks_of(rank) {
            self.banks[bank].activate = end;
        }
        let rank = &mut self.ranks[rank];
        rank.due += self.timing.n_refi;
        rank.refreshed = end;
        rank.idle_from = end;
        counts.refreshes += 1;
        counts.active_clocks += self.timing.n_rfc;
    }

    /// Allows no command of a rank before clock `t`.
    pub fn hold(&mut self, rank: usize, t: u64) {
        let banks = self.banks_of(rank);
        for bank in &mut self.banks[banks] {
            bank.activate = bank.activate.max(t); // holds refreshes too
        }
        let rank = &mut self.ranks[rank];
        rank.precharge = rank.precharge.max(t);
        rank.column = rank.column.map(|clock| clock.max(t));
    }

    /// Clocks with a bank active or in refresh until clock `t`, beyond those in `counts.active_clocks`; negative if a refresh ends later.
    pub fn active_now(&self, t: u64) -> i64 {
        let of = |rank: &Rank| {
            let open = if rank.open > 0 { t.saturating_sub(rank.active_since) } else { 0 };
            open as i64 - rank.refreshed.saturating_sub(t) as i64 // clocks are far below 2^63
        };
        self.ranks.iter().map(of).sum()
    }
}
