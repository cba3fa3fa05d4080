//! What the values of a device description must satisfy.

use super::device::{Io, Organisation, Supply, Timing};
use super::error::{DramError, invalid};
use super::ranks::MOST_BANKS;

/// More than any of JEDEC's figures; keeps sums of a few far from overflow.
const MOST_CLOCKS: u64 = 1 << 20;

impl Organisation {
    pub(super) fn validate(&self) -> Result<(), DramError> {
        let powers = [
            ("ranks", self.ranks),
            ("bank_groups", self.bank_groups),
            ("banks_per_group", self.banks_per_group),
            ("rows", self.rows),
            ("columns", self.columns),
        ];
        for (key, value) in powers {
            if !value.is_power_of_two() || value > 1 << 24 {
                return Err(invalid(&format!("organisation.{key}"), "must be a power of two up to 2^24", value));
            }
        }
        let banks = u64::from(self.ranks) * u64::from(self.bank_groups) * u64::from(self.banks_per_group);
        if banks > MOST_BANKS as u64 {
            return Err(invalid(
                "organisation.ranks",
                format!("times bank_groups times banks_per_group must be at most {MOST_BANKS}"),
                banks,
            ));
        }
        if !(1..=64).contains(&self.devices_per_rank) {
            return Err(invalid("organisation.devices_per_rank", "must be 1 to 64", self.devices_per_rank));
        }
        Ok(())
    }
}

impl Timing {
    pub(super) fn validate(&self) -> Result<(), DramError> {
        for (key, clocks) in self.named() {
            if !(1..=MOST_CLOCKS).contains(&clocks) {
                return Err(invalid(&format!("timing.{key}"), format!("must be 1 to {MOST_CLOCKS} clocks"), clocks));
            }
        }
        let at_least = [
            ("nRC", self.n_rc, "nRAS + nRP", self.n_ras + self.n_rp),
            ("nCCD_S", self.n_ccd_s, "nBL (the bursts would overlap)", self.n_bl),
            ("nCCD_L", self.n_ccd_l, "nCCD_S", self.n_ccd_s),
            ("nRRD_L", self.n_rrd_l, "nRRD_S", self.n_rrd_s),
            ("nWTR_L", self.n_wtr_l, "nWTR_S", self.n_wtr_s),
            ("nFAW", self.n_faw, "nRRD_S", self.n_rrd_s),
            ("nRTW", self.n_rtw, "nCL + nBL - nCWL (the bursts would overlap)", (self.n_cl + self.n_bl).saturating_sub(self.n_cwl)),
            // All rows closed, refreshed and one read: else nothing but refreshes happens.
            ("nREFI", self.n_refi, "nRC + nRFC + nRCDRD", self.n_rc + self.n_rfc + self.n_rcd_rd + 1),
        ];
        for (key, clocks, what, least) in at_least {
            if clocks < least {
                return Err(invalid(&format!("timing.{key}"), format!("must be at least {what} = {least}"), clocks));
            }
        }
        Ok(())
    }

    /// Every timing by its key.
    fn named(&self) -> [(&'static str, u64); 23] {
        [
            ("nBL", self.n_bl),
            ("nCL", self.n_cl),
            ("nCWL", self.n_cwl),
            ("nRCDRD", self.n_rcd_rd),
            ("nRCDWR", self.n_rcd_wr),
            ("nRP", self.n_rp),
            ("nRAS", self.n_ras),
            ("nRC", self.n_rc),
            ("nCCD_S", self.n_ccd_s),
            ("nCCD_L", self.n_ccd_l),
            ("nRRD_S", self.n_rrd_s),
            ("nRRD_L", self.n_rrd_l),
            ("nFAW", self.n_faw),
            ("nWR", self.n_wr),
            ("nWTR_S", self.n_wtr_s),
            ("nWTR_L", self.n_wtr_l),
            ("nRTP", self.n_rtp),
            ("nRTW", self.n_rtw),
            ("nRTRS", self.n_rtrs),
            ("nPPD", self.n_ppd),
            ("nXP", self.n_xp),
            ("nRFC", self.n_rfc),
            ("nREFI", self.n_refi),
        ]
    }
}

impl Supply {
    pub(super) fn validate(&self, timing: &Timing) -> Result<(), DramError> {
        let currents = [
            ("IDD0", self.idd0),
            ("IDD2N", self.idd2n),
            ("IDD2P", self.idd2p),
            ("IDD3N", self.idd3n),
            ("IDD3P", self.idd3p),
            ("IDD4R", self.idd4r),
            ("IDD4W", self.idd4w),
            ("IDD5B", self.idd5b),
        ];
        let key = |key: &str| format!("supply {}: {key}", self.name);
        if !(0.1..=20.0).contains(&self.volts) {
            return Err(invalid(&key("volts"), "must be 0.1 to 20", self.volts));
        }
        for (name, value) in currents {
            if !(0.0..=100_000.0).contains(&value) {
                return Err(invalid(&key(name), "must be 0 to 100000 mA", value));
            }
        }
        for (name, value) in [("IDD4R", self.idd4r), ("IDD4W", self.idd4w), ("IDD5B", self.idd5b)] {
            if value < self.idd3n {
                return Err(invalid(&key(name), format!("must be at least IDD3N = {}", self.idd3n), value));
            }
        }
        let standby = (self.idd3n * timing.n_ras as f64 + self.idd2n * (timing.n_rc - timing.n_ras) as f64) / timing.n_rc as f64;
        if self.idd0 < standby * (1.0 - 1e-9) {
            return Err(invalid(&key("IDD0"), format!("must be at least the standby current over nRC, {standby}"), self.idd0));
        }
        Ok(())
    }
}

impl Io {
    pub(super) fn validate(&self) -> Result<(), DramError> {
        if self.pins > 1024 {
            return Err(invalid("io.pins", "must be at most 1024", self.pins));
        }
        for (key, value) in [("io.read_mw_per_pin", self.read_mw_per_pin), ("io.write_mw_per_pin", self.write_mw_per_pin)] {
            if !(0.0..=1000.0).contains(&value) {
                return Err(invalid(key, "must be 0 to 1000 mW", value));
            }
        }
        Ok(())
    }
}
