//! What others build the unit in with: lists of files, a FuseSoC core, constraints. Each names all of `rtl/`, and what it makes is linted.

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
        assert_eq!(rules, ["rules/traversal_unit_rules.sv"], "{list}");
    }
}

#[test]
fn constraints_name_every_port() {
    let (constraints, unit) = (read("rtl/traversal_unit.sdc"), read("rtl/traversal_unit.sv"));
    let header = unit.split(");").next().unwrap_or_default();
    let ports: Vec<&str> = header
        .lines()
        .filter(|line| line.trim_start().starts_with("input ") || line.trim_start().starts_with("output "))
        .filter_map(|line| line.split_whitespace().last()?.trim_end_matches(',').into())
        .collect();
    assert_eq!(ports.len(), 17, "{ports:?}");
    let named: Vec<&str> = constraints.split(|c: char| " {}[]*\n".contains(c)).collect();
    for port in ports {
        assert!(named.contains(&port), "rtl/traversal_unit.sdc has no {port}");
    }
}

#[test]
fn what_fusesoc_makes_is_clean() {
    let fusesoc = tb::root().join("target/tools/fusesoc/bin/fusesoc");
    assert!(fusesoc.is_file(), "no file {}: run scripts/tools", fusesoc.display());
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let out = Command::new(fusesoc)
        .args(["--cores-root", "rtl", "run", "--target=lint", "--setup", "--build-root"])
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
    verilator.run("traversal_unit", &arguments).unwrap_or_else(|error| panic!("{error}"));
}

/// Files below a folder with this ending.
fn files_of(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) = entries.flatten().map(|entry| entry.path()).partition(|path| path.is_dir());
    let below = folders.iter().flat_map(|folder| files_of(folder, ending));
    files.iter().filter(|path| path.extension().is_some_and(|e| e == ending)).cloned().chain(below).collect()
}
