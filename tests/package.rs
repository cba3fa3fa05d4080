//! `rtl/lod_pkg.sv` is what the default hardware prints, byte for byte. With `LODRAY_REWRITE_PACKAGE` in the environment the file is written again
//! (`scripts/package`).

use lodray::hardware::Hardware;

#[test]
fn the_package_of_the_rtl_is_that_of_the_default_hardware() {
    // Not `tb::rtl()`: another folder may have another hardware's.
    let path = tb::root().join("rtl/lod_pkg.sv");
    let printed = Hardware::default().package();
    if std::env::var_os("LODRAY_REWRITE_PACKAGE").is_some() {
        std::fs::write(&path, &printed).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    let file = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let differs = printed.lines().zip(file.lines()).position(|(a, b)| a != b).map_or(0, |at| at + 1);
    assert!(
        file == printed,
        "rtl/lod_pkg.sv is not what Hardware::default() prints, from line {differs} on; scripts/package writes it again"
    );
    assert!(printed.lines().count() > 500);
}
