//! What others build the unit in with: lists of files, a FuseSoC core, constraints, a testbench in Python. Each list names all of `rtl/`, what is made of it is linted, and
//! the testbench passes.

use lodray_test_support::hardware::SMALL;
use std::path::{Path, PathBuf};
use std::process::Command;
use tb::Verilator;

fn read(path: &str) -> String {
    std::fs::read_to_string(tb::root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The files of `rtl/`, the package first.
fn sources() -> Vec<String> {
    let rtl = tb::root().join("rtl");
    let entries = std::fs::read_dir(&rtl).unwrap_or_else(|error| panic!("{}: {error}", rtl.display()));
    let mut names: Vec<String> =
        entries.flatten().filter_map(|e| e.file_name().into_string().ok()).filter(|n| n.ends_with(".sv")).collect();
    names.sort_by_key(|name| (name != "lod_pkg.sv", name.clone()));
    assert!(names.len() > 40 && names[0] == "lod_pkg.sv");
    names
}

#[test]
fn every_list_names_every_file_in_order() {
    let sources = sources();
    let listed: Vec<String> = read("rtl/files.f").lines().filter(|line| !line.starts_with("//")).map(str::to_owned).collect();
    assert_eq!(listed, sources, "rtl/files.f");
    for (list, before) in [("rtl/lodray.core", "      - "), ("Bender.yml", "      - rtl/")] {
        let text = read(list);
        let files = text.lines().filter_map(|line| line.strip_prefix(before)).filter(|name| name.ends_with(".sv"));
        let (rules, files): (Vec<_>, Vec<_>) = files.partition(|name| name.starts_with("rules/"));
        assert_eq!(files, sources, "{list}");
        assert_eq!(
            rules,
            ["rules/axi_read_adapter_rules.sv", "rules/traversal_unit_axi_rules.sv", "rules/traversal_unit_rules.sv"],
            "{list}"
        );
    }
}

#[test]
fn constraints_name_every_port() {
    constraints_name_ports("traversal_unit", 25);
    constraints_name_ports("traversal_unit_axi", 37);
}

/// The constraints of a top name its ports, so many.
fn constraints_name_ports(top: &str, count: usize) {
    let (constraints, unit) = (read(&format!("rtl/{top}.sdc")), read(&format!("rtl/{top}.sv")));
    let header = unit.split(");").next().unwrap_or_default();
    let ports: Vec<&str> = header
        .lines()
        .filter(|line| line.trim_start().starts_with("input ") || line.trim_start().starts_with("output "))
        .filter_map(|line| line.split_whitespace().last()?.trim_end_matches(',').into())
        .collect();
    assert_eq!(ports.len(), count, "{ports:?}");
    let named: Vec<&str> = constraints.split(|c: char| " {}[]*\n".contains(c)).collect();
    for port in ports {
        assert!(named.contains(&port), "rtl/{top}.sdc has no {port}");
    }
}

#[test]
fn what_fusesoc_makes_is_clean() {
    what_fusesoc_makes("lint", "traversal_unit");
    what_fusesoc_makes("lint_axi", "traversal_unit_axi");
}

/// Lints what FuseSoC makes of a target of its core.
fn what_fusesoc_makes(target: &str, top: &str) {
    let fusesoc = tb::root().join("target/tools/fusesoc/bin/fusesoc");
    assert!(fusesoc.is_file(), "no file {}: run scripts/tools", fusesoc.display());
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let out = Command::new(fusesoc)
        .args(["--cores-root", "rtl", "run", &format!("--target={target}"), "--setup", "--build-root"])
        .arg(folder.path())
        .arg("lodray:hw:traversal_unit")
        .current_dir(tb::root())
        .output()
        .unwrap_or_else(|error| panic!("fusesoc: {error}"));
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let lists = files_of(folder.path(), "vc");
    let [list] = lists.as_slice() else { panic!("lists of files: {lists:?}") };
    // It names files beside itself.
    let arguments = ["-F".to_owned(), list.display().to_string()];
    let verilator = Verilator::find().unwrap_or_else(|error| panic!("{error}"));
    verilator.run(top, &arguments).unwrap_or_else(|error| panic!("{error}"));
}

/// A top with the default's unit and that of another hardware, under names of its own.
const TWO_UNITS: &str = "`default_nettype none

module two_units (
  input logic clk_i,
  input logic rst_ni
);

  traversal_unit u_default (.clk_i, .rst_ni);
  small_traversal_unit u_small (.clk_i, .rst_ni);

endmodule

`default_nettype wire
";

#[test]
fn units_of_two_hardwares_stand_in_one_design() {
    let desk = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let (package, top, out) = (desk.path().join("lod_pkg.sv"), desk.path().join("two_units.sv"), desk.path().join("small"));
    std::fs::write(&package, SMALL.package()).and_then(|()| std::fs::write(&top, TWO_UNITS)).unwrap_or_else(|error| panic!("{error}"));
    let named = |prefix: &str| {
        let script = tb::root().join("scripts/named-unit");
        let out = Command::new(&script).args(["--prefix", prefix, "--package"]).arg(&package).arg("-o").arg(&out).output();
        let out = out.unwrap_or_else(|error| panic!("{}: {error}", script.display()));
        (out.status.success(), String::from_utf8_lossy(&out.stderr).into_owned())
    };
    assert_eq!(named("small_"), (true, String::new()));
    // The names alone differ.
    let unit = std::fs::read_to_string(out.join("small_traversal_unit.sv")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(unit.replace("small_", ""), read("rtl/traversal_unit.sv"));
    assert!(unit.contains("module small_traversal_unit #(") && unit.contains("small_ray_context #("));
    // The top leaves all other ports open.
    let words = ["--lint-only", "-Wall", "-Wno-PINMISSING", "rtl/lint.vlt", "-F", "rtl/files.f", "-F"].map(str::to_owned);
    let paths = [out.join("files.f"), top].map(|path| path.display().to_string());
    let arguments = [&words[..], &paths[..], &["--top-module", "two_units"].map(str::to_owned)[..]].concat();
    let verilator = Verilator::find().unwrap_or_else(|error| panic!("{error}"));
    verilator.run("two_units", &arguments).unwrap_or_else(|error| panic!("{error}"));
    let (made, said) = named("1st_");
    assert!(!made && said.contains("--prefix 1st_"), "{said}");
}

/// The program that these tests are built with.
fn lodray(folder: &Path, arguments: &str) {
    let out = assert_cmd::cargo::cargo_bin_cmd!("lodray").current_dir(folder).args(arguments.split_whitespace()).output();
    let out = out.unwrap_or_else(|error| panic!("{error}"));
    assert!(out.status.success(), "{arguments}: {}", String::from_utf8_lossy(&out.stderr));
}

#[test]
fn the_cocotb_example_passes() {
    let python = tb::root().join("target/tools/cocotb/bin/python3");
    assert!(python.is_file(), "no file {}: run scripts/tools", python.display());
    // Its own Verilator first, as someone has it who installed one.
    let include = Verilator::find().unwrap_or_else(|error| panic!("{error}")).include();
    let root = include.parent().unwrap_or(Path::new(""));
    let path = std::env::var("PATH").unwrap_or_default();
    let desk = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    lodray(desk.path(), "generate sphere --levels 3 --base 32 -o sphere.lod");
    lodray(desk.path(), "trace sphere.lod --pixel 24,24 --size 48x48 --distance 3 --ports ray.json");
    let run = |ports: &str| {
        let mut command = Command::new(&python);
        command.env("VERILATOR_ROOT", root).env("PATH", format!("{}:{path}", root.join("bin").display()));
        command.arg("examples/cocotb/run.py").args(["sphere.lod", ports].map(|name| desk.path().join(name)));
        command.arg("--build").arg(tb::root().join("target/cocotb")).current_dir(tb::root());
        let out = command.output().unwrap_or_else(|error| panic!("{}: {error}", python.display()));
        (out.status.success(), format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr)))
    };
    let (passed, said) = run("ray.json");
    assert!(passed && said.contains("PASS=1"), "{said}");
    // It looks: another hit is not what came.
    let ray = std::fs::read_to_string(desk.path().join("ray.json")).unwrap_or_else(|error| panic!("{error}"));
    let mut ports: serde_json::Value = serde_json::from_str(&ray).unwrap_or_else(|error| panic!("{error}"));
    ports["out_o"]["bits"] = "0x1".into();
    std::fs::write(desk.path().join("wrong.json"), ports.to_string()).unwrap_or_else(|error| panic!("{error}"));
    let (passed, said) = run("wrong.json");
    assert!(!passed && said.contains("out_o is "), "{said}");
}

/// Files below a folder with this ending.
fn files_of(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) = entries.flatten().map(|entry| entry.path()).partition(|path| path.is_dir());
    let below = folders.iter().flat_map(|folder| files_of(folder, ending));
    files.iter().filter(|path| path.extension().is_some_and(|e| e == ending)).cloned().chain(below).collect()
}
