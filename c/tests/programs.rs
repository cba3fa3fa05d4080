//! The programs of `examples/c` and the short form of `scripts/c-interface`, with the library that this test was built beside.

use std::path::Path;
use std::process::Command;

#[test]
fn the_programs_in_c_agree_with_golden_and_find_what_was_made_wrong() {
    let this = std::env::current_exe().unwrap();
    let out = Command::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scripts/c-interface"))
        .arg("--short")
        .env("LODRAY_LIB", this.parent().unwrap())
        .output()
        .unwrap();
    let said = format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
    assert!(out.status.success() && said.matches(": 0 differ").count() == 2, "{said}");
}
