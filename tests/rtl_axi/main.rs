//! The unit behind AXI: its adapter between any memory port and any memory, the rules of its ports, and a frame of the whole.
//! `LODRAY_TRANSACTIONS` asks for so many lines of each width (default a hundred thousand), `LODRAY_SEED` for another seed.

mod adapter;
mod bus;
mod frame;
mod rules;

use lodray::hardware::Hardware;
use tb::Verilator;

#[test]
fn what_no_bus_has_is_refused() {
    let verilator = Verilator::find().unwrap_or_else(|error| panic!("{error}"));
    for (parameter, wrong) in [("DATA_W", 16), ("DATA_W", 512), ("ADDRESS_W", 11), ("ADDRESS_W", 65), ("READS", 257)] {
        let error = tb::lint(&verilator, "axi_read_adapter", &[(parameter, wrong)], &Hardware::default()).expect_err("it was taken");
        assert!(
            error.to_string().contains(&format!("axi_read_adapter: {parameter} = {wrong}, must be ")),
            "{parameter} = {wrong}: {error}"
        );
    }
}
