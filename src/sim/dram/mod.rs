//! DRAM at command level, driven by events.
//!
//! - [`device`]: what a device is, read from `machines/dram/*.toml`; every figure there bears its source.
//! - [`mapping`]: which bits of a line number choose channel, rank, bank group, bank, row and column.
//! - `channel`, `candidates`, `choose`, `queue`, `power_down`: a channel's controller. Reads and writes wait in queues of fixed depth, a list per bank.
//!   The next command is known at any time (its clock is the largest of a few earliest clocks), so nothing is looked at in the clocks
//!   between; it is found anew when a command was given or a request came.
//! - `ranks`: the devices' rules. Every command moves the earliest clocks of later ones: of its bank (nRCD, nRAS, nRP, nRC, nRTP, nWR), its
//!   bank group (nCCD_L, nRRD_L, nWTR_L), its rank (nCCD_S, nRRD_S, nFAW, nWTR_S, nRTW, nPPD) and the other ranks (the data bus, nRTRS).
//! - Refresh: all banks of a rank every nREFI: from the clock in which it is due the rank gives only the reads and writes for which rows were opened; then its rows
//!   are closed, it is refreshed and blocked for nRFC.
//! - Writes are answered when their data are through; reads do not look into the write queue (there are no data here).
//! - `energy`: joules from counts, at report time.
//!
//! Time is in picoseconds, a command clock a whole number of them, so nothing drifts. A request that comes at time t is first considered in
//! the first clock at or after t.

mod candidates;
mod channel;
mod choose;
pub mod config;
pub mod counts;
pub mod device;
mod energy;
pub mod error;
pub mod mapping;
mod power_down;
mod queue;
mod ranks;
mod standing;
pub mod trace;
mod validate;

#[cfg(test)]
mod tests;

pub use config::{Controller, DramConfig, PagePolicy, Scheduler};
pub use counts::ChannelCounts;
pub use device::Device;
pub use energy::{DramEnergy, DramPrices};
pub use error::DramError;
pub use standing::Standing;

use channel::Channel;
pub use channel::Way;
use mapping::Mapping;
use trace::Command;

/// A DRAM of one or more channels.
///
/// How to drive it: at a time `now`, first [`Dram::advance`] to it, then [`Dram::push`] what is new, and come back at [`Dram::next_event`].
#[derive(Clone, Debug)]
pub struct Dram {
    device: Device,
    mapping: Mapping,
    channels: Vec<Channel>,
    /// Time of each channel's next command.
    next_ps: Vec<u64>,
    /// The same where requests wait, else `u64::MAX`.
    events_ps: Vec<u64>,
    now_ps: u64,
}

impl Dram {
    /// Whether there can be such a DRAM; none of its channels is made.
    ///
    /// # Errors
    /// The configuration has an impossible value.
    pub fn check(config: &DramConfig) -> Result<(), DramError> {
        Self::mapping(config).map(|_| ())
    }

    fn mapping(config: &DramConfig) -> Result<Mapping, DramError> {
        config.validate()?;
        Mapping::new(&config.mapping, config.channels, &config.device.organisation)
    }

    /// A DRAM at time 0, all rows closed.
    ///
    /// # Errors
    /// The configuration has an impossible value.
    pub fn new(config: &DramConfig) -> Result<Self, DramError> {
        let mapping = Self::mapping(config)?;
        let channel = Channel::new(&config.device, &config.controller);
        let next_ps = vec![channel.next_clock() * config.device.clock_ps; config.channels as usize];
        let events_ps = vec![u64::MAX; next_ps.len()];
        Ok(Self { device: config.device.clone(), mapping, channels: vec![channel; next_ps.len()], next_ps, events_ps, now_ps: 0 })
    }

    /// Picoseconds of a command clock.
    pub fn clock_ps(&self) -> u64 {
        self.device.clock_ps
    }

    /// The channel of `line`.
    pub fn channel(&self, line: u64) -> u32 {
        self.mapping.channel(line)
    }

    /// Whether a read or write of `line` can be pushed now: its channel's queue has room.
    pub fn accepts(&self, line: u64, write: bool) -> bool {
        self.channels[self.mapping.channel(line) as usize].accepts(write)
    }

    /// Reads or writes `line` from time `now` on; `id` comes back with the answer. The time must be that of the last [`Dram::advance`], or
    /// later with no event between.
    ///
    /// # Panics
    /// The queue is full: ask [`Dram::accepts`]. In debug builds, if events before `now` are outstanding or time runs backwards.
    pub fn push(&mut self, now: u64, line: u64, id: u64, write: bool) {
        debug_assert!(now >= self.now_ps, "time runs backwards: {now} ps after {} ps", self.now_ps);
        let place = self.mapping.place(line);
        let channel = &mut self.channels[place.channel as usize];
        let clock_ps = self.device.clock_ps;
        if channel.waiting() == 0 {
            channel.advance(now / clock_ps, &mut |_, _| {}); // refreshes of the time without requests
        }
        debug_assert!(channel.next_clock() * clock_ps >= now, "events before {now} ps are outstanding");
        let organisation = &self.device.organisation;
        let bank = (place.rank * organisation.bank_groups + place.group) * organisation.banks_per_group + place.bank;
        channel.push(now.div_ceil(clock_ps), bank as usize, place.row, id, write);
        let next = channel.next_clock() * clock_ps;
        self.next_ps[place.channel as usize] = next;
        self.events_ps[place.channel as usize] = next;
        self.now_ps = now;
    }

    /// When to advance next; `None` if no request waits.
    pub fn next_event(&self) -> Option<u64> {
        self.events_ps.iter().copied().min().filter(|&next| next < u64::MAX)
    }

    /// Lets time pass to `to` and gives all commands up to it. `done` gets the id of each request whose read or write command was given,
    /// and when its data are through, which may be after `to`. Calls come channel by channel, not in order of time. Refreshes have no end:
    /// neither may `to`.
    pub fn advance(&mut self, to: u64, done: &mut impl FnMut(u64, u64)) {
        let clock_ps = self.device.clock_ps;
        self.advance_by_way(to, &mut |id, way| done(id, way.end() * clock_ps));
    }

    /// The same, with the way of each request, in command clocks.
    pub fn advance_by_way(&mut self, to: u64, done: &mut impl FnMut(u64, &Way)) {
        let clock_ps = self.device.clock_ps;
        for ((channel, next), event) in self.channels.iter_mut().zip(&mut self.next_ps).zip(&mut self.events_ps) {
            if *next <= to {
                channel.advance(to / clock_ps, done);
                *next = channel.next_clock() * clock_ps;
                *event = if channel.waiting() > 0 { *next } else { u64::MAX };
            }
        }
        self.now_ps = self.now_ps.max(to);
    }

    /// Requests that wait for their read or write command.
    pub fn waiting(&self) -> usize {
        self.channels.iter().map(Channel::waiting).sum()
    }

    /// What each channel did up to the time of the last advance.
    pub fn counts(&self) -> Vec<ChannelCounts> {
        let clock = self.now_ps / self.device.clock_ps;
        self.channels.iter().map(|channel| channel.counts_at(clock)).collect()
    }

    /// Requests to each bank, channel after channel.
    pub fn requests_of_banks(&self) -> Vec<u64> {
        self.channels.iter().flat_map(|channel| channel.of_banks.iter().copied()).collect()
    }

    /// Energy of all channels up to the time of the last advance.
    pub fn energy(&self) -> DramEnergy {
        let (prices, clocks) = (DramPrices::new(&self.device), self.clocks());
        let mut sum = DramEnergy::default();
        for counts in self.counts() {
            sum.add(&prices.energy(&counts, self.device.organisation.ranks, clocks));
        }
        sum
    }

    /// Command clocks up to the time of the last advance.
    pub fn clocks(&self) -> u64 {
        self.now_ps / self.device.clock_ps
    }

    /// Notes all commands from now on.
    pub fn record(&mut self) {
        for channel in &mut self.channels {
            channel.trace.get_or_insert_default();
        }
    }

    /// The commands of a channel noted since [`Dram::record`].
    pub fn trace(&self, channel: usize) -> &[Command] {
        self.channels[channel].trace.as_deref().unwrap_or_default()
    }
}
