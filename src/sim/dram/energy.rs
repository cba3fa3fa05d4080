//! Energy from counts, by the method of Micron's technical note TN-41-01 (Calculating Memory System Power for DDR3).
//!
//! Powers there are averages over shares of time; here each share is a count of clocks, so the sums are energies. Per device and supply,
//! with V the voltage and tCK the clock's period:
//! - background: V tCK (IDD3N x clocks with a bank active + IDD2N x clocks with all precharged), IDD3P and IDD2P in power-down;
//! - activate: V tCK (IDD0 nRC - IDD3N nRAS - IDD2N (nRC - nRAS)) for each activate and its precharge: what IDD0 is above the background;
//! - read: V tCK nBL (IDD4R - IDD3N) each; write: the same with IDD4W;
//! - refresh: V tCK nRFC (IDD5B - IDD3N) each; the clocks of a refresh count as active in the background, so its whole is IDD5B;
//! - I/O: pins x power per pin x tCK nBL for each read and write.
//!
//! All times the devices of a rank. mA x V x ps = 10^-3 pJ.

use super::counts::ChannelCounts;
use super::device::{Device, Supply};
use serde::{Deserialize, Serialize};

/// Energies in picojoules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DramEnergy {
    /// Standby and power-down.
    pub background_pj: f64,
    /// Activates and precharges.
    pub activate_pj: f64,
    /// Reads, without I/O.
    pub read_pj: f64,
    /// Writes, without I/O.
    pub write_pj: f64,
    /// Refreshes.
    pub refresh_pj: f64,
    /// Drivers and terminations of the data bus.
    pub io_pj: f64,
}

impl DramEnergy {
    /// All of it.
    pub fn total_pj(&self) -> f64 {
        self.background_pj + self.activate_pj + self.read_pj + self.write_pj + self.refresh_pj + self.io_pj
    }

    /// Adds another.
    pub fn add(&mut self, other: &Self) {
        self.background_pj += other.background_pj;
        self.activate_pj += other.activate_pj;
        self.read_pj += other.read_pj;
        self.write_pj += other.write_pj;
        self.refresh_pj += other.refresh_pj;
        self.io_pj += other.io_pj;
    }
}

/// What each thing costs that is counted, in picojoules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DramPrices {
    /// A clock of a rank with a bank active or in refresh, but for power-down.
    pub active_clock_pj: f64,
    /// The same in power-down.
    pub active_down_clock_pj: f64,
    /// A clock of a rank with all banks precharged, but for power-down.
    pub precharged_clock_pj: f64,
    /// The same in power-down.
    pub precharged_down_clock_pj: f64,
    /// An activate and its precharge.
    pub activate_pj: f64,
    /// A read, without I/O.
    pub read_pj: f64,
    /// A write, without I/O.
    pub write_pj: f64,
    /// A refresh of all banks of a rank.
    pub refresh_pj: f64,
    /// I/O of a read.
    pub read_io_pj: f64,
    /// I/O of a write.
    pub write_io_pj: f64,
}

impl DramPrices {
    /// Those of a device.
    pub fn new(device: &Device) -> Self {
        let mut sum = Self::default();
        device.supply.iter().for_each(|supply| sum.add_supply(device, supply));
        let of_burst = f64::from(device.io.pins)
            * (device.timing.n_bl * device.clock_ps) as f64
            * f64::from(device.organisation.devices_per_rank)
            * 1e-3;
        (sum.read_io_pj, sum.write_io_pj) = (device.io.read_mw_per_pin * of_burst, device.io.write_mw_per_pin * of_burst);
        sum
    }

    /// The part from one supply; no I/O.
    fn add_supply(&mut self, device: &Device, supply: &Supply) {
        let t = &device.timing;
        // picojoules of 1 mA for one clock in all devices of a rank
        let pj = supply.volts * device.clock_ps as f64 * f64::from(device.organisation.devices_per_rank) * 1e-3;
        let activate = supply.idd0 * t.n_rc as f64 - supply.idd3n * t.n_ras as f64 - supply.idd2n * (t.n_rc - t.n_ras) as f64;
        let burst = t.n_bl as f64;
        self.active_clock_pj += pj * supply.idd3n;
        self.active_down_clock_pj += pj * supply.idd3p;
        self.precharged_clock_pj += pj * supply.idd2n;
        self.precharged_down_clock_pj += pj * supply.idd2p;
        self.activate_pj += pj * activate;
        self.read_pj += pj * (supply.idd4r - supply.idd3n) * burst;
        self.write_pj += pj * (supply.idd4w - supply.idd3n) * burst;
        self.refresh_pj += pj * (supply.idd5b - supply.idd3n) * t.n_rfc as f64;
    }

    /// The energy of one channel of `ranks` that ran for so many clocks and did `counts`.
    ///
    /// The clocks with a bank active must be those of the same time: see [`Dram::counts`](super::Dram::counts).
    pub fn energy(&self, counts: &ChannelCounts, ranks: u32, clocks: u64) -> DramEnergy {
        let of = |count: u64, price: f64| count as f64 * price;
        let precharged = counts.precharged_clocks(ranks, clocks);
        DramEnergy {
            background_pj: of(counts.active_clocks - counts.active_down_clocks, self.active_clock_pj)
                + of(precharged, self.precharged_clock_pj)
                + of(counts.active_down_clocks, self.active_down_clock_pj)
                + of(counts.precharged_down_clocks, self.precharged_down_clock_pj),
            activate_pj: of(counts.activates, self.activate_pj),
            read_pj: of(counts.reads, self.read_pj),
            write_pj: of(counts.writes, self.write_pj),
            refresh_pj: of(counts.refreshes, self.refresh_pj),
            io_pj: of(counts.reads, self.read_io_pj) + of(counts.writes, self.write_io_pj),
        }
    }
}
