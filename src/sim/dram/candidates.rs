//! The commands that a channel may give next, and in which order.

use super::queue::NONE;
use super::ranks::MOST_BANKS;

/// Steps towards a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BankCommand {
    Column,
    Activate,
    Precharge,
    /// A read while writes are served, or the other way round: the row was opened for it before.
    Owed,
}

/// Limits are stored by bank group and step, a power of two per group.
pub(super) const STEPS: usize = 4;

/// What a command is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    CloseAll {
        rank: usize,
    },
    Refresh {
        rank: usize,
    },
    /// `older`: closing the row for the bank's oldest request, while hits of the row wait too.
    Towards {
        bank: usize,
        older: bool,
    },
    Close {
        bank: usize,
    },
}

/// The next command and its clock.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    pub clock: u64,
    pub purpose: Purpose,
}

// Within a clock the smallest order goes first: its kind of command, then the age of the request; the bank is in the low bits.
pub(super) const REFRESH_ORDER: u64 = 0;
pub(super) const OWED_ORDER: u64 = 1 << 60;
pub(super) const COLUMN_ORDER: u64 = 2 << 60;
pub(super) const ROW_ORDER: u64 = 3 << 60;
pub(super) const CAPPED_ORDER: u64 = 4 << 60;
pub(super) const CLOSE_ORDER: u64 = 5 << 60;

/// Clock and order as one number: the smallest is given.
pub(super) fn key(clock: u64, order: u64) -> u128 {
    u128::from(clock) << 64 | u128::from(order)
}

/// The clock of a key.
pub(super) fn clock_of(key: u128) -> u64 {
    (key >> 64) as u64
}

/// The next step of each bank's queue, and what bank groups and ranks allow. Arrays side by side: this is what is searched for every
/// command.
#[derive(Clone, Debug)]
pub(super) struct Candidates {
    /// First clock that the bank itself allows.
    pub ready: [u64; MOST_BANKS],
    pub orders: [u64; MOST_BANKS],
    /// Which of `limits` holds.
    pub limit: [u8; MOST_BANKS],
    pub slots: [u16; MOST_BANKS],
    pub steps: [BankCommand; MOST_BANKS],
    /// First clock that a bank group and its rank allow, by group and step.
    pub limits: [u64; MOST_BANKS * STEPS],
}

impl Candidates {
    pub fn new() -> Self {
        Self {
            ready: [0; MOST_BANKS],
            orders: [0; MOST_BANKS],
            limit: [0; MOST_BANKS],
            slots: [NONE; MOST_BANKS],
            steps: [BankCommand::Activate; MOST_BANKS],
            limits: [0; MOST_BANKS * STEPS],
        }
    }

    /// The smallest key of some banks, none before clock `free`.
    pub fn first(&self, mut banks: u64, free: u64) -> u128 {
        let mut best = u128::MAX;
        while banks != 0 {
            let bank = banks.trailing_zeros() as usize % MOST_BANKS;
            banks &= banks - 1;
            let clock = self.ready[bank].max(self.limits[usize::from(self.limit[bank])]).max(free);
            let key = key(clock, self.orders[bank]);
            best = std::hint::select_unpredictable(key < best, key, best);
        }
        best
    }
}
