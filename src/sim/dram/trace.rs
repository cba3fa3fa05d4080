//! The commands that a channel gave, for tests and for looking at.

/// A command and its clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Command {
    /// Clock of the command clock.
    pub clock: u64,
    /// What was given.
    pub given: Given,
}

/// What was given; banks are numbered through the channel: (rank x groups + group) x banks per group + bank.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// Opens a row.
    Activate {
        /// Bank.
        bank: usize,
        /// Row.
        row: u32,
    },
    /// Closes a bank's row.
    Precharge {
        /// Bank.
        bank: usize,
    },
    /// Closes all rows of a rank.
    PrechargeAll {
        /// Rank.
        rank: usize,
    },
    /// Reads a line of the open row.
    Read {
        /// Bank.
        bank: usize,
        /// Row.
        row: u32,
    },
    /// Writes a line of the open row.
    Write {
        /// Bank.
        bank: usize,
        /// Row.
        row: u32,
    },
    /// Refreshes all banks of a rank.
    Refresh {
        /// Rank.
        rank: usize,
    },
}
