//! No number is true in one place only: every struct, width, latency, limit, state and port list of `rtl/` against Rust.

use lodray::block::tri_test::{EdgeFunction, TNumerator, TriTest};
use lodray::block::{self, Block, Timing};
use lodray::format::{BvhNode, Displacements, L0Record, SplitRecord, VertexData};
use lodray::hardware::ports::{Corners, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use lodray::hardware::{Fetch, MAX_CONTEXTS, RayError, State};
use lodray::method::{self, Entry, Hit};
use lodray::num::{self, Box16, Field, Layout, Wire};
use lodray_test_support::sv::{Module, Package, Shape};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Structs that only the RTL has: they pass between two of its modules.
const RTL_ONLY: [&str; 5] = ["queued_hit_t", "kept_point_t", "kept_direction_t", "kept_axis_t", "kept_setup_t"];

struct BlockTwin {
    name: &'static str,
    timing: Timing,
}

/// The Rust side of a packed struct.
struct StructTwin {
    name: String,
    width: u32,
    fields: &'static [Field],
}

fn twin<T: Wire>(name: impl Into<String>) -> StructTwin {
    StructTwin { name: name.into(), width: T::WIDTH, fields: T::FIELDS }
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

fn add<B: Block>(blocks: &mut Vec<BlockTwin>, structs: &mut Vec<StructTwin>) {
    blocks.push(BlockTwin { name: B::NAME, timing: B::TIMING });
    structs.push(twin::<B::In>(format!("{}_in_t", B::NAME)));
    if out_of(B::NAME) == B::NAME {
        structs.push(twin::<B::Out>(format!("{}_out_t", B::NAME)));
    }
}

fn rust_side() -> (Vec<BlockTwin>, Vec<StructTwin>) {
    let mut structs = vec![
        twin::<num::Point>("point_t"),
        twin::<num::Direction>("direction_t"),
        twin::<num::Vec3<28>>("stored_point_t"),
        twin::<num::Vec3<22>>("stored_corner_t"),
        twin::<num::Displacement>("displacement_t"),
        twin::<num::Vec3<11>>("local_t"),
        twin::<num::Vec3<16>>("code3_t"),
        twin::<num::Vec3<63>>("moment_t"),
        twin::<num::BoundScale>("bound_scale_t"),
        twin::<num::Cone>("cone_t"),
        twin::<num::Ray>("ray_t"),
        twin::<num::Start>("start_t"),
        twin::<block::start_test::Below>("below_t"),
        twin::<block::prism_frame::Frame>("frame_t"),
        twin::<Box16>("box16_t"),
        twin::<block::ray_setup::Reciprocal>("reciprocal_t"),
        twin::<block::ray_setup::Axis>("axis_t"),
        twin::<SplitRecord>("split_record_t"),
        twin::<BvhNode>("bvh_node_t"),
        twin::<VertexData>("vertex_data_t"),
        twin::<Displacements>("displacements_t"),
        twin::<L0Record>("l0_record_t"),
        twin::<Entry>("stack_entry_t"),
        twin::<Hit>("hit_t"),
        twin::<SceneConfig>("scene_config_t"),
        twin::<RayIn>("ray_in_t"),
        twin::<SecondaryIn>("secondary_in_t"),
        twin::<Corners>("corners_t"),
        twin::<HitOut>("hit_out_t"),
        twin::<MemoryRequest>("memory_request_t"),
        twin::<MemoryAnswer>("memory_answer_t"),
    ];
    let mut blocks = Vec::new();
    macro_rules! blocks {
        ($($name:ty),+ $(,)?) => { $(add::<$name>(&mut blocks, &mut structs);)+ };
    }
    blocks!(
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
    );
    (blocks, structs)
}

/// Named numbers that both sides have.
fn numbers() -> Vec<(&'static str, u64)> {
    let width = |name, width: u32| (name, u64::from(width));
    vec![
        width("RAY_T_W", num::RayT::WIDTH),
        width("T_NEAR_W", num::TNear::WIDTH),
        width("BARY_W", num::Bary::WIDTH),
        width("EDGE_STATE_W", num::EdgeState::WIDTH),
        width("DECIDER_W", block::tree_deciders::Decider::WIDTH),
        width("BOUND_CODE_W", num::BoundCode::WIDTH),
        width("BOUND_W", block::bound_decode::Bound::WIDTH),
        width("LINE_ADDRESS_W", num::LineAddress::WIDTH),
        width("NODE_INDEX_W", block::bary_map::NodeIndex::WIDTH),
        width("FULL_ID_W", block::hit_select::FullId::WIDTH),
        width("EDGE_FUNCTION_W", EdgeFunction::WIDTH),
        width("T_NUMERATOR_W", TNumerator::WIDTH),
        width("MAX_LEVELS", num::MAX_LEVELS),
        width("MAX_BVH_DEPTH", num::MAX_BVH_DEPTH),
        width("BOX_SHIFT", num::BOX_SHIFT),
        width("T_NEAR_TO_T_SHIFT", num::T_NEAR_TO_T_SHIFT),
        width("LOD_TEST_3_LATENCY", block::lod_test::LodTest::THREE_EDGES.latency),
        width("TRI_TEST_3_LATENCY", TriTest::THREE_EDGES.latency),
        width("LOD_TEST_1_LATENCY", block::lod_test::LodTest::ONE_EDGE.latency),
        width("LOD_TEST_1_INTERVAL", block::lod_test::LodTest::ONE_EDGE.interval),
        width("LOD_TEST_BY_3_LATENCY", block::lod_test_by::LodTestBy::THREE_EDGES.latency),
        width("LOD_TEST_BY_1_LATENCY", block::lod_test_by::LodTestBy::ONE_EDGE.latency),
        width("LOD_TEST_BY_1_INTERVAL", block::lod_test_by::LodTestBy::ONE_EDGE.interval),
        width("START_TEST_3_LATENCY", block::start_test::StartTest::THREE_EDGES.latency),
        width("START_TEST_1_LATENCY", block::start_test::StartTest::ONE_EDGE.latency),
        width("START_TEST_1_INTERVAL", block::start_test::StartTest::ONE_EDGE.interval),
        width("FRACTION_W", num::START_BITS),
        width("TRI_TEST_1_LATENCY", TriTest::ONE_EDGE.latency),
        width("TRI_TEST_1_INTERVAL", TriTest::ONE_EDGE.interval),
        ("S_ONE", num::S_ONE),
        ("STACK_ENTRIES", method::STACK_ENTRIES as u64),
        ("MAX_CONTEXTS", MAX_CONTEXTS as u64),
        ("ENTRY_BVH_NODE", Entry::BVH_NODE),
        ("ENTRY_TREE", Entry::TREE),
        ("ENTRY_TREE_NODE", Entry::TREE_NODE),
    ]
}

fn read(path: &PathBuf) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn package() -> Package {
    Package::parse(&read(&tb::rtl().join("lod_pkg.sv"))).unwrap_or_else(|error| panic!("lod_pkg.sv: {error}"))
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

/// Prints what was compared; fails on any difference, and if too little was compared.
fn conclude(what: &str, compared: usize, least: usize, wrong: &[String]) {
    println!("{compared} {what} compared");
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong.join("\n"));
    assert!(compared >= least, "only {compared} {what} were compared, there should be {least} or more");
}

/// Compares a struct's fields with Rust's, nested ones too; returns how many.
fn compare(package: &Package, path: &str, name: &str, fields: &[Field], wrong: &mut Vec<String>) -> usize {
    let Some(twins) = package.structs.get(name) else {
        wrong.push(format!("{path}: no struct {name} in the package"));
        return 0;
    };
    if !fields.iter().map(|field| field.name).eq(twins.iter().map(|twin| twin.name.as_str())) {
        let names = |list: Vec<&str>| list.join(", ");
        let rust = names(fields.iter().map(|field| field.name).collect());
        let rtl = names(twins.iter().map(|twin| twin.name.as_str()).collect());
        wrong.push(format!("{path}: the fields are {rust} in Rust and {rtl} in the RTL"));
        return 0;
    }
    let mut compared = 0;
    for (field, twin) in fields.iter().zip(twins) {
        compared += 1;
        let path = format!("{path}.{}", field.name);
        match package.width(&twin.shape) {
            Ok(width) if width == u64::from(field.width) => {}
            width => wrong.push(format!("{path}: {} bits in Rust, {width:?} in the RTL", field.width)),
        }
        let same = match (&twin.shape, field.layout) {
            (Shape::Named(name), Layout::Struct(inner)) => {
                compared += compare(package, &path, name, inner, wrong);
                true
            }
            (Shape::Logic { signed, sizes }, Layout::Unsigned | Layout::Signed) => {
                *signed == (field.layout == Layout::Signed) && sizes.len() <= 1
            }
            (Shape::Logic { signed: false, sizes }, Layout::Array(elements)) => {
                sizes[..] == [u64::from(elements)] || sizes[..] == [u64::from(elements), u64::from(field.width / elements)]
            }
            _ => false,
        };
        if !same {
            wrong.push(format!("{path}: {:?} in Rust, {:?} in the RTL", field.layout, twin.shape));
        }
    }
    compared
}

#[test]
fn structs_have_the_same_fields_in_the_same_order() {
    let package = package();
    let (_, structs) = rust_side();
    let mut wrong = Vec::new();
    let mut compared = 0;
    for twin in &structs {
        compared += compare(&package, &twin.name, &twin.name, twin.fields, &mut wrong);
        let constant = twin.name.trim_end_matches("_t").to_uppercase() + "_W";
        if package.params.get(&constant) != Some(&u64::from(twin.width)) {
            wrong.push(format!("{constant}: {} in Rust, {:?} in the RTL", twin.width, package.params.get(&constant)));
        }
    }
    let known: BTreeSet<&str> = structs.iter().map(|twin| twin.name.as_str()).chain(RTL_ONLY).collect();
    assert_eq!(known.len(), structs.len() + RTL_ONLY.len(), "a struct is listed twice");
    wrong.extend(package.structs.keys().filter(|name| !known.contains(name.as_str())).map(|name| format!("{name}: no twin in Rust")));
    wrong.extend(RTL_ONLY.iter().filter(|name| !package.structs.contains_key(**name)).map(|name| format!("{name}: gone from the RTL")));
    conclude("fields", compared, 400, &wrong);
}

#[test]
fn widths_limits_and_timings_are_the_same() {
    let package = package();
    let (blocks, _) = rust_side();
    let mut wrong = Vec::new();
    let mut expected: Vec<(String, u64)> = numbers().into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    for BlockTwin { name, timing } in &blocks {
        let name = name.to_uppercase();
        expected.push((format!("{name}_LATENCY"), u64::from(timing.latency)));
        let interval = format!("{name}_INTERVAL");
        if timing.interval != 1 {
            expected.push((interval, u64::from(timing.interval)));
        } else if package.params.contains_key(&interval) {
            wrong.push(format!("{interval}: stated, though it is 1 in Rust"));
        }
    }
    for (name, value) in &expected {
        match package.params.get(name) {
            Some(rtl) if rtl == value => {}
            rtl => wrong.push(format!("{name}: {value} in Rust, {rtl:?} in the RTL")),
        }
    }
    conclude("numbers", expected.len(), numbers().len() + blocks.len(), &wrong);
}

#[test]
fn states_have_the_same_names_and_numbers() {
    let package = package();
    let states: Vec<(String, u64)> = State::ALL.iter().map(|&state| (state.name().to_owned(), state as u64)).collect();
    let fetches = [Fetch::Node, Fetch::Record, Fetch::Split].map(|fetch| (format!("{fetch:?}").to_uppercase(), fetch as u64));
    assert_eq!(package.enums["context_state_t"].1, states);
    assert_eq!(package.enums["fetch_t"].1, fetches);
    let errors = RayError::ALL.map(|error| (error.named().0.to_owned(), error as u64));
    assert_eq!(package.enums["ray_error_t"].1, [&[("ERROR_NONE".to_owned(), 0)], &errors[..]].concat());
    assert_eq!(package.enums.len(), 3, "an enum without a twin");
    println!("{} states compared", states.len() + fetches.len() + errors.len());
}

#[test]
fn every_block_has_a_file_of_its_name_on_both_sides() {
    let (blocks, _) = rust_side();
    let listed: BTreeSet<String> = blocks.iter().map(|block| block.name.to_owned()).collect();
    let mut rust = files(tb::root().join("src/block"), ".rs");
    rust.remove("mod");
    // A list of the blocks, none itself.
    assert!(rust.remove("operation"));
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
    let (blocks, _) = rust_side();
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
            ("in_i", "lod_pkg::ray_in_t"),
            ("secondary_i", "lod_pkg::secondary_in_t"),
            ("out_o", "lod_pkg::hit_out_t"),
            ("corners_o", "lod_pkg::corners_t"),
            ("mem_o", "lod_pkg::memory_request_t"),
            ("mem_i", "lod_pkg::memory_answer_t"),
        ]
    );
    let names: Vec<_> = unit.parameters.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["CONTEXTS", "EDGES_PER_CYCLE"]);
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
    for block in rust_side().0 {
        let start = format!("| `{}` |", block.name);
        let row =
            readme.lines().find(|line| line.starts_with(&start)).unwrap_or_else(|| panic!("rtl/README.md has no row for {}", block.name));
        let stated = format!("| {} | {} |", block.timing.latency, block.timing.interval);
        assert!(row.ends_with(&stated), "rtl/README.md says of {}: {row}; it should end with {stated}", block.name);
    }
}
