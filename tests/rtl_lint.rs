//! Every module of `rtl/` is clean under Verilator's lint with all warnings on and for slang, which is stricter about names; declares all its nets;
//! and is free of what the free synthesis tools get wrong.

use lodray::hardware::Hardware;
use lodray_test_support::hardware::OTHERS;
use lodray_test_support::sv::donts;

/// Names of the files of `rtl/`.
fn modules() -> Vec<String> {
    let rtl = tb::rtl();
    let entries = std::fs::read_dir(&rtl).unwrap_or_else(|error| panic!("{}: {error}", rtl.display()));
    let mut names: Vec<String> =
        entries.filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".sv").map(str::to_owned)).collect();
    names.sort();
    assert!(names.len() >= 20, "only {} files in {}", names.len(), rtl.display());
    names
}

fn text(module: &str) -> String {
    let path = tb::rtl().join(format!("{module}.sv"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn every_module_is_clean_by_itself() {
    let mut tops: Vec<(String, Vec<(&str, u64)>)> = modules().into_iter().map(|name| (name, Vec::new())).collect();
    // Verilator takes no module as the top that contains itself: such a one is linted within its users.
    tops.retain(|(name, _)| name != "lod_pkg" && !text(name).contains(&format!("\n    {name} #(")));
    assert!(tops.len() >= 20, "only {} tops in {}", tops.len(), tb::rtl().display());
    // And with other values of the parameters that choose between structures.
    for (top, parameter, value) in
        [("tri_test", "EDGES_PER_CYCLE", 1), ("traversal_unit", "EDGES_PER_CYCLE", 1), ("traversal_unit", "CONTEXTS", 1)]
    {
        tops.push((top.to_owned(), vec![(parameter, value)]));
    }
    let wrong: Vec<String> =
        tops.iter().filter_map(|(top, parameters)| tb::lint(top, parameters, &Hardware::default()).err()).map(|e| e.to_string()).collect();
    println!("{} tops linted", tops.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Hardware at the ends of what there can be, and the others that tests build.
fn hardwares() -> Vec<Hardware> {
    let smallest = Hardware { levels: 2, bvh_depth: 1, contexts: 1, context_bits: 1, ..Hardware::default() };
    // A stack of a power of two: its length has one bit more than its places.
    let even = Hardware { levels: 5, bvh_depth: 16, contexts: 16, context_bits: 4, ..Hardware::default() };
    OTHERS.into_iter().chain([smallest, even]).collect()
}

#[test]
fn every_module_is_clean_in_other_hardware() {
    let mut wrong = Vec::new();
    let mut linted = 0;
    for hardware in hardwares() {
        hardware.validate().unwrap_or_else(|error| panic!("{error}"));
        // With everything in them: all of `rtl/`.
        for top in ["traversal_unit", "box_test32"] {
            wrong.extend(tb::lint(top, &[], &hardware).err().map(|error| format!("{hardware:?}: {error}")));
            linted += 1;
        }
        tb::elaborate(&[], &hardware).unwrap_or_else(|error| panic!("{hardware:?}: {error}"));
    }
    println!("{linted} tops linted");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn nothing_is_used_that_free_tools_get_wrong() {
    let mut wrong = Vec::new();
    let names = modules();
    for name in &names {
        wrong.extend(donts(&text(name)).into_iter().map(|dont| format!("{name}.sv, {dont}")));
    }
    println!("{} files searched", names.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_net_is_implicit() {
    let formal = tb::rtl().join("formal");
    let mut compared = 0;
    for folder in [tb::rtl(), formal] {
        let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for path in entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "sv")) {
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            // The second line is for files of others that are read behind it.
            let declared = text.starts_with("`default_nettype none\n") && text.ends_with("\n`default_nettype wire\n");
            assert!(declared, "{} does not begin with `default_nettype none` and end with `default_nettype wire`", path.display());
            compared += 1;
        }
    }
    println!("{compared} files searched");
    assert!(compared >= 60, "only {compared} files");
}

#[test]
fn a_strict_front_end_takes_every_module() {
    // Slang refuses what Verilator lets pass: a name before its declaration, from which other tools make a net of their own that nothing drives.
    for options in [&[][..], &["--top", "traversal_unit", "-GEDGES_PER_CYCLE=1"], &["--top", "traversal_unit", "-GCONTEXTS=1"]] {
        tb::elaborate(options, &Hardware::default()).unwrap_or_else(|error| panic!("{options:?}: {error}"));
    }
}
