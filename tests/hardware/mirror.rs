//! The modules of `rtl/` against Rust: files, ports, stated timings. What `lod_pkg.sv` states is printed from Rust (`package.rs`).

use lodray::block::tri_test::TriTest;
use lodray::block::{self, Block, Timing};
use lodray_test_support::sv::Module;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

struct BlockTwin {
    name: &'static str,
    timing: Timing,
}

/// The block whose output this one has: mostly itself.
fn out_of(block: &str) -> &str {
    match block {
        "box_test32" | "prism_test" => "box_test",
        "child_prisms" => "child_test",
        "lod_test_by" => "lod_test",
        "start_setup" => "ray_setup",
        "start_divide" => "hit_divide",
        itself => itself,
    }
}

fn blocks() -> Vec<BlockTwin> {
    macro_rules! twins {
        ($($name:ty),+ $(,)?) => { vec![$(BlockTwin { name: <$name>::NAME, timing: <$name>::TIMING }),+] };
    }
    twins!(
        block::bary_map::BaryMap,
        block::bound_decode::BoundDecode,
        block::box_decode::BoxDecode,
        block::box_decode8::BoxDecode8,
        block::box_test::BoxTest,
        block::box_test32::BoxTest32,
        block::child_boxes::ChildBoxes,
        block::child_prisms::ChildPrisms,
        block::child_sort::ChildSort,
        block::child_sort6::ChildSort6,
        block::child_test::ChildTest,
        block::hit_divide::HitDivide,
        block::hit_select::HitSelect,
        block::lod_test::LodTest,
        block::lod_test_by::LodTestBy,
        block::node_address::NodeAddress,
        block::node_deciders::NodeDeciders,
        block::prism_frame::PrismFrame,
        block::prism_test::PrismTest,
        block::ray_setup::RaySetup,
        block::start_divide::StartDivide,
        block::start_setup::StartSetup,
        block::start_test::StartTest,
        block::tessellate::Tessellate,
        block::tree_deciders::TreeDeciders,
        TriTest,
    )
}

fn read(path: &PathBuf) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Names of the files of a folder with this ending.
fn files(folder: PathBuf, ending: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    entries.filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(ending).map(str::to_owned)).collect()
}

fn modules() -> BTreeMap<String, Module> {
    let mut names = files(tb::rtl(), ".sv");
    names.remove("lod_pkg");
    let module = |name: String| {
        let module = Module::parse(&read(&tb::rtl().join(format!("{name}.sv")))).unwrap_or_else(|error| panic!("{name}.sv: {error}"));
        (name, module)
    };
    names.into_iter().map(module).collect()
}

#[test]
fn every_block_has_a_file_of_its_name_on_both_sides() {
    let blocks = blocks();
    let listed: BTreeSet<String> = blocks.iter().map(|block| block.name.to_owned()).collect();
    let mut rust = files(tb::root().join("src/block"), ".rs");
    rust.remove("mod");
    // A list of the blocks, and the forms that they have; none themselves.
    assert!(rust.remove("operation") && rust.remove("form"));
    assert_eq!(rust, listed, "files of src/block against the blocks compared here");

    // In rtl/ a block is what takes a struct with its own name.
    let modules = modules();
    let is_block =
        |(name, module): &(&String, &Module)| module.port("in_i").is_some_and(|port| port.kind == format!("lod_pkg::{name}_in_t"));
    let rtl: BTreeSet<String> = modules.iter().filter(is_block).map(|(name, _)| name.clone()).collect();
    assert_eq!(rtl, listed, "files of rtl/ against the blocks compared here");
    println!("{} blocks compared", listed.len());
}

#[test]
fn blocks_have_the_ports_of_blocks() {
    let blocks = blocks();
    let modules = modules();
    for BlockTwin { name, .. } in &blocks {
        let module = &modules[*name];
        let out = out_of(name);
        let ports = [
            ("input", "logic".to_owned(), "clk_i"),
            ("input", "logic".to_owned(), "rst_ni"),
            ("input", "logic".to_owned(), "valid_i"),
            ("output", "logic".to_owned(), "ready_o"),
            ("input", format!("lod_pkg::{name}_in_t"), "in_i"),
            ("input", "logic[TAG_W-1:0]".to_owned(), "tag_i"),
            ("output", "logic".to_owned(), "valid_o"),
            ("input", "logic".to_owned(), "ready_i"),
            ("output", format!("lod_pkg::{out}_out_t"), "out_o"),
            ("output", "logic[TAG_W-1:0]".to_owned(), "tag_o"),
        ];
        let got: Vec<_> = module.ports.iter().map(|port| (port.direction.as_str(), port.kind.clone(), port.name.as_str())).collect();
        assert_eq!(got, ports, "ports of {name}");
        assert_eq!(module.parameters.first(), Some(&("TAG_W".to_owned(), "8".to_owned())), "first parameter of {name}");
    }
    println!("ports of {} blocks compared", blocks.len());
}

#[test]
fn the_unit_has_the_ports_of_the_cycle_model() {
    let modules = modules();
    let unit = &modules["traversal_unit"];
    let typed: Vec<_> =
        unit.ports.iter().filter(|port| port.kind != "logic").map(|port| (port.name.as_str(), port.kind.as_str())).collect();
    assert_eq!(
        typed,
        [
            ("scene_i", "lod_pkg::scene_config_t"),
            ("memory_test_i", "lod_pkg::memory_test_t"),
            ("view_context_i", "logic[5:0]"),
            ("view_o", "lod_pkg::context_view_t"),
            ("counters_o", "lod_pkg::unit_counters_t"),
            ("in_i", "lod_pkg::ray_in_t"),
            ("secondary_i", "lod_pkg::secondary_in_t"),
            ("out_o", "lod_pkg::hit_out_t"),
            ("corners_o", "lod_pkg::corners_t"),
            ("mem_o", "lod_pkg::memory_request_t"),
            ("mem_i", "lod_pkg::memory_answer_t"),
        ]
    );
    let names: Vec<_> = unit.parameters.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["CONTEXTS", "EDGES_PER_CYCLE", "WATCH", "MEMORY_PARITY", "CLOCK_GATES"]);
}

#[test]
fn names_of_modules_and_ports_follow_the_convention() {
    let modules = modules();
    let mut compared = 0;
    for (file, module) in &modules {
        assert_eq!(file, &module.name, "a file bears the name of its module");
        for port in &module.ports {
            let right = match port.direction.as_str() {
                "input" => port.name.ends_with("_i") || port.name == "rst_ni",
                _ => port.name.ends_with("_o"),
            };
            assert!(right, "{file}: the {} {}", port.direction, port.name);
            compared += 1;
        }
    }
    println!("{compared} ports of {} modules looked at", modules.len());
    assert!(modules.len() >= 20 && compared >= 200, "too little was found in rtl/");
}

#[test]
fn the_readme_states_the_timings() {
    let readme = std::fs::read_to_string(tb::root().join("rtl/README.md")).expect("rtl/README.md");
    for block in blocks() {
        let start = format!("| `{}` |", block.name);
        let row =
            readme.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("rtl/README.md has no row for {}", block.name));
        let stated = format!("| {} | {} |", block.timing.latency, block.timing.interval);
        assert!(row.ends_with(&stated), "rtl/README.md says of {}: {row}; it should end with {stated}", block.name);
    }
}
