//! How a DRAM is set up: device, channels, address mapping and controller.

use super::device::Device;
use super::error::{DramError, invalid};
use super::mapping::DEFAULT_MAPPING;
use serde::{Deserialize, Serialize};

/// When a row without waiting requests is closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PagePolicy {
    /// When another row of the bank is wanted or a refresh is due.
    #[default]
    Open,
    /// As soon as it may.
    Closed,
    /// When it was not used for so many clocks.
    Timeout(u64),
}

/// Which request of those that are served (reads, or writes) goes first. A row that was opened for a request is not closed before it is read or written,
/// and that goes before all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheduler {
    /// Of the commands that are allowed in a clock the hits of open rows, then the oldest request's; at most [`Controller::hit_cap`] hits overtake the oldest request of
    /// their bank per activate.
    #[default]
    HitsCapped,
    /// The same without a cap.
    Hits,
    /// The oldest request whose command is allowed: it closes a row whatever younger hits wait (FRFCFS of Ramulator 1 and 2.1).
    OldestReady,
    /// The same, but when a row was read and written [`Controller::hit_cap`] + 1 times since its activate its hits count as not ready: one is served only
    /// if it is the oldest of all and nothing else is ready (FRFCFS_Cap of Ramulator 1, its default).
    OldestReadyCapped,
}

/// A channel's controller. The defaults are common choices, not a product's.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Controller {
    /// Reads that may wait.
    pub read_queue: u16,
    /// Writes that may wait.
    pub write_queue: u16,
    /// So many waiting writes go before reads ...
    pub write_high: u16,
    /// ... until so few are left.
    pub write_low: u16,
    /// Which request goes first.
    pub scheduler: Scheduler,
    /// How many hits of an open row go before others: what is counted is said by the scheduler.
    pub hit_cap: u32,
    /// When rows are closed.
    pub page: PagePolicy,
    /// Clocks without a request or command after which a rank goes into power-down; never if absent.
    pub power_down: Option<u64>,
}

impl Default for Controller {
    fn default() -> Self {
        // The cap has the number of Ramulator's FRFCFS_Cap (src/Scheduler.h), not its rule: that is OldestReadyCapped.
        let (scheduler, page) = (Scheduler::default(), PagePolicy::Open);
        Self { read_queue: 64, write_queue: 64, write_high: 48, write_low: 16, scheduler, hit_cap: 16, page, power_down: None }
    }
}

impl Controller {
    fn validate(&self) -> Result<(), DramError> {
        for (key, depth) in [("read_queue", self.read_queue), ("write_queue", self.write_queue)] {
            if !(1..=4096).contains(&depth) {
                return Err(invalid(&format!("controller.{key}"), "must be 1 to 4096", depth));
            }
        }
        if self.write_high == 0 || self.write_high > self.write_queue {
            return Err(invalid("controller.write_high", format!("must be 1 to write_queue = {}", self.write_queue), self.write_high));
        }
        if self.write_low >= self.write_high {
            return Err(invalid("controller.write_low", format!("must be below write_high = {}", self.write_high), self.write_low));
        }
        let clocks = [("page.timeout", if let PagePolicy::Timeout(clocks) = self.page { clocks } else { 0 })];
        for (key, clocks) in clocks.into_iter().chain(self.power_down.map(|clocks| ("power_down", clocks))) {
            if clocks > 1 << 32 {
                return Err(invalid(&format!("controller.{key}"), "must be at most 2^32 clocks", clocks));
            }
        }
        Ok(())
    }
}

/// A DRAM.
#[derive(Clone, Debug, PartialEq)]
pub struct DramConfig {
    /// The devices of each channel.
    pub device: Device,
    /// Channels; a power of two.
    pub channels: u32,
    /// Bits of a line number, from the most significant: see [`mapping`](super::mapping).
    pub mapping: String,
    /// Each channel's controller.
    pub controller: Controller,
}

impl DramConfig {
    /// `channels` channels of `device`, all else by default.
    pub fn new(device: Device, channels: u32) -> Self {
        Self { device, channels, mapping: DEFAULT_MAPPING.to_owned(), controller: Controller::default() }
    }

    /// Refuses what cannot be; [`Mapping::new`](super::mapping::Mapping::new) checks channels and mapping.
    ///
    /// # Errors
    /// The first impossible value.
    pub fn validate(&self) -> Result<(), DramError> {
        self.device.validate()?;
        self.controller.validate()
    }
}
