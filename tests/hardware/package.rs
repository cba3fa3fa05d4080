//! `rtl/lod_pkg.sv` is what the default hardware prints, byte for byte. With `LODRAY_REWRITE_PACKAGE` in the environment the file is written again
//! (`scripts/package`). With `LODRAY_FPGA_PACKAGE` that of the hardware for an FPGA is written there, of `LODRAY_CONTEXTS` contexts
//! with `LODRAY_LINK_REGISTERS` on their links (`scripts/synth --fpga`).

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

#[test]
fn the_package_for_an_fpga_is_that_of_its_contexts() {
    for (contexts, bits) in [(1, 1), (2, 1), (3, 2), (4, 2), (5, 3), (64, 6)] {
        assert_eq!(Hardware::fpga(contexts).context_bits, bits);
        assert_eq!(Hardware::fpga(contexts).validate(), Ok(()));
    }
    let Some(path) = std::env::var_os("LODRAY_FPGA_PACKAGE") else { return };
    let number =
        |name: &str| std::env::var(name).ok().map(|text| text.parse::<u32>().unwrap_or_else(|_| panic!("{name}: {text:?} is no number")));
    let standard = Hardware::fpga(number("LODRAY_CONTEXTS").unwrap_or(2) as usize);
    let hardware = Hardware { link_registers: number("LODRAY_LINK_REGISTERS").unwrap_or(standard.link_registers), ..standard };
    hardware.validate().unwrap_or_else(|error| panic!("{error}"));
    std::fs::write(&path, hardware.package()).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
}
