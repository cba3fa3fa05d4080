//! Every module of `rtl/` is clean for Verilator with all warnings on, for the distribution's older one, for slang, which is stricter about names, for
//! verible, which looks at style, and for Yosys, which looks at nets; declares all its nets; and is free of what the free synthesis tools get wrong.

use lodray::hardware::Hardware;
use lodray_test_support::hardware::OTHERS;
use lodray_test_support::is_nightly;
use lodray_test_support::sv::donts;
use std::path::PathBuf;
use tb::Verilator;

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

fn verilator() -> Verilator {
    Verilator::find().unwrap_or_else(|error| panic!("{error}"))
}

fn text(module: &str) -> String {
    let path = tb::rtl().join(format!("{module}.sv"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Every top, and with other values of the parameters that choose between structures.
fn tops() -> Vec<(String, Vec<(&'static str, u64)>)> {
    let mut tops: Vec<(String, Vec<(&'static str, u64)>)> = modules().into_iter().map(|name| (name, Vec::new())).collect();
    // Verilator takes no module as the top that contains itself: such a one is linted within its users.
    tops.retain(|(name, _)| name != "lod_pkg" && !text(name).contains(&format!("\n    {name} #(")));
    assert!(tops.len() >= 20, "only {} tops in {}", tops.len(), tb::rtl().display());
    for (top, parameter, value) in [
        ("tri_test", "EDGES_PER_CYCLE", 3),
        ("lod_test", "EDGES_PER_CYCLE", 3),
        ("start_test", "EDGES_PER_CYCLE", 3),
        ("lod_test_by", "EDGES_PER_CYCLE", 3),
        ("start_divide", "DIVIDE_BITS", 1),
        ("start_divide", "DIVIDE_BITS", 2),
        ("start_setup", "SETUP_BITS", 1),
        ("child_test", "BOXES_PER_CYCLE", 4),
        ("child_test", "BOXES_PER_CYCLE", 1),
        ("divide_step", "BITS", 2),
        ("divide_multiples", "BITS", 2),
        ("hit_divide", "DIVIDE_BITS", 1),
        ("hit_divide", "DIVIDE_BITS", 2),
        ("ray_setup", "SETUP_BITS", 1),
        ("ray_setup", "SETUP_BITS", 2),
        ("setup_copies", "COPIES", 3),
        ("divide_copies", "COPIES", 2),
        ("divide_step", "BITS", 3),
        ("divide_multiples", "BITS", 3),
        ("traversal_unit", "EDGES_PER_CYCLE", 3),
        ("traversal_unit", "CONTEXTS", 1),
        ("traversal_unit", "WATCH", 1),
        ("traversal_unit", "MEMORY_PARITY", 1),
        ("traversal_unit", "CLOCK_GATES", 1),
        ("axi_read_adapter", "DATA_W", 128),
        ("axi_read_adapter", "DATA_W", 64),
        ("axi_read_adapter", "DATA_W", 32),
        ("axi_read_adapter", "ADDRESS_W", 32),
        ("axi_read_adapter", "READS", 7),
        ("axi_read_adapter", "READS", 2),
    ] {
        tops.push((top.to_owned(), vec![(parameter, value)]));
    }
    tops
}

fn clean_by_itself(verilator: &Verilator) {
    let tops = tops();
    let lint = |(top, parameters): &(String, Vec<_>)| tb::lint(verilator, top, parameters, &Hardware::default()).err();
    let wrong: Vec<String> = tops.iter().filter_map(lint).map(|error| error.to_string()).collect();
    println!("{} tops linted", tops.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_module_is_clean_by_itself() {
    clean_by_itself(&verilator());
}

#[test]
fn every_module_is_clean_for_the_distributions_verilator() {
    match Verilator::of_distribution().unwrap_or_else(|error| panic!("{error}")) {
        Some(older) => clean_by_itself(&older),
        None => eprintln!("*** the distribution has no Verilator: NOT linted with it ***"),
    }
}

/// Lints the whole design as docs/integration.md has it: the list of files as it is, without the rules that simulations bind.
fn clean_for_an_integrator(verilator: &Verilator) {
    let top = "traversal_unit_axi";
    let words = format!("--lint-only -Wall rtl/lint.vlt -F rtl/files.f --top-module {top}");
    let arguments: Vec<String> = words.split(' ').map(str::to_owned).collect();
    verilator.run(top, &arguments).unwrap_or_else(|error| panic!("verilator {words}: {error}"));
}

#[test]
fn the_list_of_files_is_clean_for_an_integrator() {
    clean_for_an_integrator(&verilator());
    match Verilator::of_distribution().unwrap_or_else(|error| panic!("{error}")) {
        Some(older) => clean_for_an_integrator(&older),
        None => eprintln!("*** the distribution has no Verilator: NOT linted with it ***"),
    }
}

/// Hardware at the ends of what there can be, and the others that tests build.
fn hardwares() -> Vec<Hardware> {
    let smallest = Hardware { levels: 2, bvh_depth: 1, contexts: 1, context_bits: 1, ..Hardware::default() };
    // A stack of a power of two: its length has one bit more than its places.
    let even = Hardware { levels: 5, bvh_depth: 16, contexts: 16, context_bits: 4, ..Hardware::default() };
    OTHERS.into_iter().chain([smallest, even]).collect()
}

/// All of `rtl/`: the unit with everything in it, and of what stands apart two in turns, so that each meets hardware of every kind; `scripts/nightly` takes all.
#[test]
fn every_module_is_clean_in_other_hardware() {
    let mut wrong = Vec::new();
    let mut linted = 0;
    let apart = ["box_test32", "start_setup", "start_test", "start_divide", "tree_deciders", "node_deciders", "lod_test_by"];
    let taken = if is_nightly() { apart.len() } else { 2 };
    for (number, hardware) in hardwares().into_iter().enumerate() {
        hardware.validate().unwrap_or_else(|error| panic!("{error}"));
        for top in ["traversal_unit_axi"].into_iter().chain(apart.into_iter().cycle().skip(2 * number).take(taken)) {
            wrong.extend(tb::lint(&verilator(), top, &[], &hardware).err().map(|error| format!("{hardware:?}: {error}")));
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
    let [formal, rules] = ["formal", "rules"].map(|folder| tb::rtl().join(folder));
    let mut compared = 0;
    for folder in [tb::rtl(), formal, rules] {
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
    for options in [
        &[][..],
        &["--top", "traversal_unit", "-GEDGES_PER_CYCLE=3"],
        &["--top", "traversal_unit", "-GCONTEXTS=1", "-GWATCH=1", "-GMEMORY_PARITY=1", "-GCLOCK_GATES=1"],
    ] {
        tb::elaborate(options, &Hardware::default()).unwrap_or_else(|error| panic!("{options:?}: {error}"));
    }
}

#[test]
fn verible_finds_nothing() {
    let paths = |folder: PathBuf| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "sv")).collect()
    };
    let rtl = [paths(tb::rtl()), paths(tb::rtl().join("rules"))].concat();
    tb::verible(&rtl, "").unwrap_or_else(|error| panic!("{error}"));
    // Files of properties and stubs bear the names of what they are about.
    let formal = paths(tb::rtl().join("formal"));
    tb::verible(&formal, "-module-filename").unwrap_or_else(|error| panic!("{error}"));
    println!("{} files", rtl.len() + formal.len());
    assert!(rtl.len() >= 40 && formal.len() >= 20);
    // It looks: a file that is called otherwise is found.
    assert!(tb::verible(&formal, "").is_err_and(|error| error.to_string().contains("module-filename")));
}

#[test]
fn yosys_finds_nothing() {
    for parameters in
        [&[("CONTEXTS", 1)][..], &[("CONTEXTS", 2), ("EDGES_PER_CYCLE", 3), ("WATCH", 1), ("MEMORY_PARITY", 1), ("CLOCK_GATES", 1)]]
    {
        tb::yosys("traversal_unit", parameters, &Hardware::default()).unwrap_or_else(|error| panic!("{parameters:?}: {error}"));
    }
    for parameters in [&[][..], &[("DATA_W", 32), ("ADDRESS_W", 32), ("READS", 7)]] {
        tb::yosys("axi_read_adapter", parameters, &Hardware::default()).unwrap_or_else(|error| panic!("{parameters:?}: {error}"));
    }
    for parameters in [&[("BOXES_PER_CYCLE", 4)][..], &[("BOXES_PER_CYCLE", 1)]] {
        tb::yosys("child_test", parameters, &Hardware::default()).unwrap_or_else(|error| panic!("{parameters:?}: {error}"));
    }
}
