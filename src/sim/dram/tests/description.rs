//! Device descriptions: what is refused, and that the error names the key.

use crate::sim::dram::{Controller, Device, Dram, DramConfig};

const GDDR5: &str = include_str!("../../../../machines/dram/gddr5.toml");

/// The error of gddr5.toml with a key's line replaced.
fn error(key: &str, by: &str) -> String {
    let mut replaced = 0;
    let lines = GDDR5.lines().map(|line| {
        if line.split_whitespace().next() == Some(key) {
            replaced += 1;
            by
        } else {
            line
        }
    });
    let text = lines.collect::<Vec<_>>().join("\n");
    assert_eq!(replaced, 1, "{key}");
    Device::from_toml(&text).unwrap_err().to_string()
}

#[test]
fn presets_are_valid_and_named() {
    for name in Device::presets() {
        let device = Device::preset(name).unwrap();
        assert!(device.banks() == 16, "{name}");
    }
    let message = Device::preset("gddr7").unwrap_err().to_string();
    assert_eq!(message, "no DRAM preset \"gddr7\"; there are: gddr5, gddr6, ddr3-scaled");
}

#[test]
fn every_value_has_its_source_beside_it() {
    let sources = ["[R]", "[G]", "[D]", "[A]", "[U]", "[J]"];
    let files = [GDDR5, include_str!("../../../../machines/dram/gddr6.toml"), include_str!("../../../../machines/dram/ddr3-scaled.toml")];
    for text in files {
        let mut values = 0;
        for line in text.lines().filter(|line| line.contains(" = ") && !line.starts_with('#')) {
            let (assignment, comment) = line.split_once('#').unwrap_or((line, ""));
            let spoken = ["name", "devices_per_rank", "read_mw_per_pin", "write_mw_per_pin"]; // said above or beside in words
            let key = assignment.split_whitespace().next().unwrap();
            let in_words =
                spoken.contains(&key) || comment.contains("nRAS + nRP") || comment.contains("has none") || comment.contains("1.75 GHz");
            assert!(in_words || sources.iter().any(|source| comment.contains(source)), "{line}");
            values += 1;
        }
        assert!(values > 40);
    }
}

#[test]
fn unknown_and_missing_keys_are_named() {
    assert!(error("nRCDRD", "nRCD = 15").contains("unknown field `nRCD`"));
    assert!(error("nFAW", "").contains("missing field `nFAW`"));
    assert!(error("IDD3N", "").contains("missing field `IDD3N`"));
    assert!(error("columns", "columns = 64\nbanks = 16").contains("unknown field `banks`"));
    assert!(error("clock_ps", "clock_ps = 800\ncolour = 1").contains("unknown field `colour`"));
    assert!(error("nCL", "nCL = -1").contains("-1"));
    assert!(error("nCL", "nCL = 1.5").contains("1.5"));
}

#[test]
fn impossible_values_are_named() {
    for key in ["nBL", "nCL", "nRCDWR", "nRP", "nFAW", "nPPD", "nRFC", "nREFI", "nXP"] {
        assert!(error(key, &format!("{key} = 0")).starts_with(&format!("DRAM: timing.{key} must be 1 to")), "{key}");
    }
    assert_eq!(error("nRC", "nRC = 49"), "DRAM: timing.nRC must be at least nRAS + nRP = 50, but is 49");
    assert!(error("nCCD_S", "nCCD_S = 1").contains("timing.nCCD_S must be at least nBL"));
    assert!(error("nCCD_L", "nCCD_L = 1").contains("timing.nCCD_L must be at least nCCD_S = 2"));
    assert!(error("nRRD_L", "nRRD_L = 6").contains("timing.nRRD_L must be at least nRRD_S = 7"));
    assert!(error("nWTR_L", "nWTR_L = 6").contains("timing.nWTR_L"));
    assert!(error("nRTW", "nRTW = 12").contains("timing.nRTW must be at least nCL + nBL - nCWL (the bursts would overlap) = 13"));
    assert!(error("nREFI", "nREFI = 147").contains("timing.nREFI must be at least"));
    assert!(error("nREFI", "nREFI = 2000000").contains("timing.nREFI must be 1 to 1048576 clocks"));
    assert!(error("rows", "rows = 4095").contains("organisation.rows must be a power of two"));
    assert!(error("columns", "columns = 0").contains("organisation.columns must be a power of two"));
    assert!(error("ranks", "ranks = 8").contains("must be at most 64, but is 128"));
    assert!(error("devices_per_rank", "devices_per_rank = 0").contains("organisation.devices_per_rank"));
    assert!(error("clock_ps", "clock_ps = 0").contains("clock_ps must be"));
    assert!(error("volts", "volts = 0").contains("supply VDD: volts"));
    assert!(error("IDD4R", "IDD4R = 449").contains("supply VDD: IDD4R must be at least IDD3N = 450, but is 449"));
    assert!(error("IDD0", "IDD0 = 389").contains("supply VDD: IDD0 must be at least the standby current over nRC, 390, but is 389"));
    assert!(error("IDD2P", "IDD2P = nan").contains("supply VDD: IDD2P"));
    assert!(error("pins", "pins = 2000").contains("io.pins"));
    assert!(error("read_mw_per_pin", "read_mw_per_pin = -1").contains("io.read_mw_per_pin"));
}

#[test]
fn values_at_the_limits_pass() {
    let pass = |key: &str, by: &str| {
        let lines = GDDR5.lines().map(|line| if line.split_whitespace().next() == Some(key) { by } else { line });
        Device::from_toml(&lines.collect::<Vec<_>>().join("\n")).unwrap()
    };
    assert_eq!(pass("nRTW", "nRTW = 13").timing.n_rtw, 13);
    assert_eq!(pass("nREFI", "nREFI = 148").timing.n_refi, 148);
    assert_eq!(pass("IDD0", "IDD0 = 390").supply[0].idd0, 390.0);
    assert_eq!(pass("ranks", "ranks = 4").banks(), 64);
}

#[test]
fn controllers_are_checked() {
    let error = |controller: Controller| {
        let config = DramConfig { controller, ..DramConfig::new(Device::preset("gddr5").unwrap(), 1) };
        Dram::new(&config).unwrap_err().to_string()
    };
    let good = Controller::default();
    assert!(error(Controller { read_queue: 0, ..good.clone() }).contains("controller.read_queue must be 1 to 4096, but is 0"));
    assert!(error(Controller { write_high: 65, ..good.clone() }).contains("controller.write_high must be 1 to write_queue = 64"));
    assert!(error(Controller { write_low: 48, ..good }).contains("controller.write_low must be below write_high = 48"));
    let read: Controller = toml::from_str("read_queue = 32\npage = { timeout = 200 }").unwrap();
    assert_eq!(read, Controller { read_queue: 32, page: crate::sim::dram::PagePolicy::Timeout(200), ..Controller::default() });
    assert!(toml::from_str::<Controller>("read_queues = 32").unwrap_err().to_string().contains("unknown field `read_queues`"));
}
