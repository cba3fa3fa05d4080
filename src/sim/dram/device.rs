//! What a DRAM device is: organisation, timings and currents, read from TOML.
//!
//! Timings are in clocks of the command clock and bear JEDEC's names with `n` for `t` (`nRCDRD` is tRCD for reads in clocks). A column is
//! one line of 32 bytes, the burst of one read or write.

use super::error::{DramError, invalid};
use crate::num::LINE_BYTES;
use serde::Deserialize;

/// The devices that come with the program: name and description (`machines/dram`).
pub const PRESETS: [(&str, &str); 3] = [
    ("gddr5", include_str!("../../../machines/dram/gddr5.toml")),
    ("gddr6", include_str!("../../../machines/dram/gddr6.toml")),
    ("ddr3-scaled", include_str!("../../../machines/dram/ddr3-scaled.toml")),
];

/// The devices of one channel.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// What to call it in reports.
    pub name: String,
    /// Period of the command clock, in picoseconds.
    pub clock_ps: u64,
    /// How many of what.
    pub organisation: Organisation,
    /// Timings.
    pub timing: Timing,
    /// Supplies and their currents; at least one.
    pub supply: Vec<Supply>,
    /// Pins of the data bus.
    pub io: Io,
}

/// How many of what; all but `devices_per_rank` powers of two.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Organisation {
    /// Ranks of a channel.
    pub ranks: u32,
    /// Bank groups of a rank.
    pub bank_groups: u32,
    /// Banks of a bank group.
    pub banks_per_group: u32,
    /// Rows of a bank.
    pub rows: u32,
    /// Lines of 32 bytes in a row.
    pub columns: u32,
    /// Devices side by side in a rank; the currents are those of one.
    pub devices_per_rank: u32,
}

/// Timings in clocks of the command clock.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// The data bus's time for one line.
    #[serde(rename = "nBL")]
    pub n_bl: u64,
    /// Read command to first data.
    #[serde(rename = "nCL")]
    pub n_cl: u64,
    /// Write command to first data.
    #[serde(rename = "nCWL")]
    pub n_cwl: u64,
    /// Activate to read.
    #[serde(rename = "nRCDRD")]
    pub n_rcd_rd: u64,
    /// Activate to write.
    #[serde(rename = "nRCDWR")]
    pub n_rcd_wr: u64,
    /// Precharge to activate or refresh.
    #[serde(rename = "nRP")]
    pub n_rp: u64,
    /// Activate to precharge.
    #[serde(rename = "nRAS")]
    pub n_ras: u64,
    /// Activate to activate or refresh, same bank.
    #[serde(rename = "nRC")]
    pub n_rc: u64,
    /// Read to read and write to write, across bank groups.
    #[serde(rename = "nCCD_S")]
    pub n_ccd_s: u64,
    /// The same within a bank group.
    #[serde(rename = "nCCD_L")]
    pub n_ccd_l: u64,
    /// Activate to activate, across bank groups.
    #[serde(rename = "nRRD_S")]
    pub n_rrd_s: u64,
    /// The same within a bank group.
    #[serde(rename = "nRRD_L")]
    pub n_rrd_l: u64,
    /// Window that holds at most four activates of a rank.
    #[serde(rename = "nFAW")]
    pub n_faw: u64,
    /// End of write data to precharge.
    #[serde(rename = "nWR")]
    pub n_wr: u64,
    /// End of write data to read, across bank groups.
    #[serde(rename = "nWTR_S")]
    pub n_wtr_s: u64,
    /// The same within a bank group.
    #[serde(rename = "nWTR_L")]
    pub n_wtr_l: u64,
    /// Read to precharge.
    #[serde(rename = "nRTP")]
    pub n_rtp: u64,
    /// Read to write, same rank.
    #[serde(rename = "nRTW")]
    pub n_rtw: u64,
    /// Gap on the data bus when another rank takes over.
    #[serde(rename = "nRTRS")]
    pub n_rtrs: u64,
    /// Precharge to precharge.
    #[serde(rename = "nPPD")]
    pub n_ppd: u64,
    /// Exit of power-down to any command.
    #[serde(rename = "nXP")]
    pub n_xp: u64,
    /// Refresh to activate or refresh.
    #[serde(rename = "nRFC")]
    pub n_rfc: u64,
    /// One refresh of all banks is due every so many clocks.
    #[serde(rename = "nREFI")]
    pub n_refi: u64,
}

/// One supply of a device: its voltage and JEDEC's currents from it in mA.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Supply {
    /// Which.
    pub name: String,
    /// Volts.
    pub volts: f64,
    /// One bank, activate to precharge every nRC.
    #[serde(rename = "IDD0")]
    pub idd0: f64,
    /// All banks precharged, standby.
    #[serde(rename = "IDD2N")]
    pub idd2n: f64,
    /// All banks precharged, power-down.
    #[serde(rename = "IDD2P")]
    pub idd2p: f64,
    /// A bank active, standby.
    #[serde(rename = "IDD3N")]
    pub idd3n: f64,
    /// A bank active, power-down.
    #[serde(rename = "IDD3P")]
    pub idd3p: f64,
    /// Reads without a gap, outputs open.
    #[serde(rename = "IDD4R")]
    pub idd4r: f64,
    /// Writes without a gap.
    #[serde(rename = "IDD4W")]
    pub idd4w: f64,
    /// Refreshes every nRFC.
    #[serde(rename = "IDD5B")]
    pub idd5b: f64,
}

/// Drivers and terminations of the data bus.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Io {
    /// Pins of one device that toggle with data.
    pub pins: u32,
    /// Power of one pin while it carries a read, in mW.
    pub read_mw_per_pin: f64,
    /// Power of one pin while it carries a write, in mW.
    pub write_mw_per_pin: f64,
}

impl Device {
    /// Reads and checks a description.
    ///
    /// # Errors
    /// It is not TOML, lacks a key or has an unknown one, or a value is impossible.
    pub fn from_toml(text: &str) -> Result<Self, DramError> {
        let device: Self = toml::from_str(text)?;
        device.validate()?;
        Ok(device)
    }

    /// A device that comes with the program: `gddr5`, `gddr6` or `ddr3-scaled`.
    ///
    /// # Errors
    /// There is none of that name.
    pub fn preset(name: &str) -> Result<Self, DramError> {
        let found = PRESETS.iter().find(|preset| preset.0 == name);
        let Some((_, text)) = found else { return Err(DramError::NoPreset { name: name.to_owned(), known: Self::presets().join(", ") }) };
        Self::from_toml(text)
    }

    /// The names that [`Device::preset`] knows.
    pub fn presets() -> [&'static str; 3] {
        PRESETS.map(|preset| preset.0)
    }

    /// Banks of a channel.
    pub fn banks(&self) -> u32 {
        self.organisation.ranks * self.organisation.bank_groups * self.organisation.banks_per_group
    }

    /// Most bytes per second of one channel.
    pub fn peak_bytes_per_second(&self) -> f64 {
        LINE_BYTES as f64 / (self.timing.n_ccd_s * self.clock_ps) as f64 * 1e12
    }

    /// Refuses what no device can be; the error names the key.
    ///
    /// # Errors
    /// The first impossible value.
    pub fn validate(&self) -> Result<(), DramError> {
        if !(1..=1_000_000).contains(&self.clock_ps) {
            return Err(invalid("clock_ps", "must be 1 to 1000000", self.clock_ps));
        }
        self.organisation.validate()?;
        self.timing.validate()?;
        if self.supply.is_empty() {
            return Err(invalid("supply", "must have an entry", 0));
        }
        self.supply.iter().try_for_each(|supply| supply.validate(&self.timing))?;
        self.io.validate()
    }
}
