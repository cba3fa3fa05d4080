//! What `scripts/synth --fpga` does to a netlist between synthesis and placement changes nothing that a block does.

use std::process::Command;

#[test]
fn registers_that_move_into_multipliers_do_what_they_did() {
    let root = tb::root();
    assert!(root.join("target/tools/synth/bin").is_dir(), "no Yosys: run scripts/tools");
    let out = Command::new("python3").args(["-m", "synthesis.same"]).current_dir(root.join("scripts")).output().expect("python3 runs");
    let said = String::from_utf8_lossy(&out.stdout);
    assert!(out.status.success(), "{said}{}", String::from_utf8_lossy(&out.stderr));
    // Four products of 34 or 36 bits, and both factors of 33.
    let moved = said.split(' ').next().and_then(|number| number.parse::<u32>().ok());
    assert!(moved.is_some_and(|moved| moved > 100), "{said}");
}
