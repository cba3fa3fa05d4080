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

/// The energy of one channel that ran for `elapsed_ps` and did `counts`.
///
/// The clocks with a bank active must be those of the same time: see [`Dram::counts`](super::Dram::counts).
pub fn energy(counts: &ChannelCounts, device: &Device, elapsed_ps: u64) -> DramEnergy {
    let mut sum = DramEnergy::default();
    for supply in &device.supply {
        sum.add(&of_supply(counts, device, supply, elapsed_ps));
    }
    let burst_ps = (device.timing.n_bl * device.clock_ps) as f64;
    let mw_ps = f64::from(device.io.pins) * burst_ps;
    let io = counts.reads as f64 * device.io.read_mw_per_pin + counts.writes as f64 * device.io.write_mw_per_pin;
    sum.io_pj = io * mw_ps * f64::from(device.organisation.devices_per_rank) * 1e-3;
    sum
}

/// The part from one supply; no I/O.
fn of_supply(counts: &ChannelCounts, device: &Device, supply: &Supply, elapsed_ps: u64) -> DramEnergy {
    let t = &device.timing;
    let clock_ps = device.clock_ps as f64;
    // picojoules of 1 mA for one clock in all devices of a rank
    let pj = supply.volts * clock_ps * f64::from(device.organisation.devices_per_rank) * 1e-3;
    let rank_clocks = elapsed_ps as f64 / clock_ps * f64::from(device.organisation.ranks);
    let active = (counts.active_clocks - counts.active_down_clocks) as f64;
    let precharged = rank_clocks - (counts.active_clocks + counts.precharged_down_clocks) as f64;
    let background = supply.idd3n * active
        + supply.idd2n * precharged
        + supply.idd3p * counts.active_down_clocks as f64
        + supply.idd2p * counts.precharged_down_clocks as f64;
    let activate = supply.idd0 * t.n_rc as f64 - supply.idd3n * t.n_ras as f64 - supply.idd2n * (t.n_rc - t.n_ras) as f64;
    let burst = t.n_bl as f64;
    DramEnergy {
        background_pj: pj * background,
        activate_pj: pj * activate * counts.activates as f64,
        read_pj: pj * (supply.idd4r - supply.idd3n) * burst * counts.reads as f64,
        write_pj: pj * (supply.idd4w - supply.idd3n) * burst * counts.writes as f64,
        refresh_pj: pj * (supply.idd5b - supply.idd3n) * t.n_rfc as f64 * counts.refreshes as f64,
        io_pj: 0.0,
    }
}
