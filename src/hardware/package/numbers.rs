//! The numbers of the package, each with what it is.

use crate::block::bary_map::{BaryMap, NodeIndex};
use crate::block::bound_decode::{Bound, BoundDecode};
use crate::block::box_decode::BoxDecode;
use crate::block::box_decode8::BoxDecode8;
use crate::block::box_test::BoxTest;
use crate::block::box_test32::BoxTest32;
use crate::block::child_boxes::ChildBoxes;
use crate::block::child_prisms::ChildPrisms;
use crate::block::child_sort::ChildSort;
use crate::block::child_sort6::ChildSort6;
use crate::block::child_test::ChildTest;
use crate::block::hit_divide::HitDivide;
use crate::block::hit_select::{FullId, HitSelect};
use crate::block::lod_test::LodTest;
use crate::block::lod_test_by::{self, LodTestBy};
use crate::block::node_address::NodeAddress;
use crate::block::node_deciders::NodeDeciders;
use crate::block::prism_frame::PrismFrame;
use crate::block::prism_test::PrismTest;
use crate::block::ray_setup::RaySetup;
use crate::block::start_divide::StartDivide;
use crate::block::start_setup::StartSetup;
use crate::block::start_test::StartTest;
use crate::block::tessellate::Tessellate;
use crate::block::tree_deciders::{Decider, TreeDeciders};
use crate::block::tri_test::{EdgeFunction, TNumerator, TriTest};
use crate::block::{Block, EdgesPerCycle, Form, Operation, parts};
use crate::hardware::Hardware;
use crate::hardware::ports::{AnswerLimit, Behind, Epoch, Owed};
use crate::num::{
    BOX_SHIFT, Bary, BoundCode, COORD_LIMIT, EdgeState, LineAddress, MAX_BOUND_OFFSET, RayT, S_ONE, START_BITS, T_NEAR_TO_T_SHIFT, TNear,
    Wire,
};
use std::fmt::Write;

/// A group of numbers under a heading; their comments stand in one column.
struct Group {
    heading: &'static str,
    numbers: Vec<(String, String, &'static str)>,
}

impl Group {
    fn new(heading: &'static str) -> Self {
        Self { heading, numbers: Vec::new() }
    }

    /// A number, or a formula in numbers before it.
    fn put(mut self, name: &str, value: impl ToString, comment: &'static str) -> Self {
        self.numbers.push((name.to_owned(), value.to_string(), comment));
        self
    }

    /// Latency and, where it is not 1, interval of a block.
    fn timing<B: Block>(self, hardware: &Hardware) -> Self {
        let (name, timing) = (B::NAME.to_uppercase(), hardware.timing::<B>());
        let group = self.put(&format!("{name}_LATENCY"), timing.latency, "");
        if timing.interval == 1 { group } else { group.put(&format!("{name}_INTERVAL"), timing.interval, "") }
    }

    fn print(&self, out: &mut String) {
        let line = |(name, value, _): &(String, String, &str)| format!("  localparam int unsigned {name} = {value};");
        let longest = self.numbers.iter().filter(|number| !number.2.is_empty()).map(|number| line(number).len()).max().unwrap_or(0);
        let _ = write!(out, "\n  // {}\n", self.heading);
        for number in &self.numbers {
            let _ = match number.2 {
                "" => writeln!(out, "{}", line(number)),
                comment => writeln!(out, "{:longest$}  // {comment}", line(number)),
            };
        }
    }
}

/// Prints all numbers but the structs' widths.
pub(super) fn print(hardware: &Hardware, out: &mut String) {
    let (edges, lod_edges) = (hardware.edges_per_cycle.count(), hardware.lod_edges_per_cycle.count());
    let of_hardware = Group::new(
        "This hardware: `Hardware` in Rust, which prints this file. All that follows from these is made smaller or larger with them.",
    )
    .put("MAX_LEVELS", hardware.levels, "splits N of a model")
    .put("STORED_LEVELS", hardware.stored_levels(), "of a tree at most: below, there are triangles")
    .put("MAX_BVH_DEPTH", hardware.bvh_depth, "quad-BVH nodes on a path from the root to a tree")
    .put("CONTEXTS", hardware.contexts, "rays under way in a traversal unit, if its parameter does not say otherwise")
    .put("CONTEXT_W", hardware.context_bits, "bits of a context's number")
    .put("EDGES_PER_CYCLE", edges, "edge functions that tri_test evaluates in a cycle, if its parameter does not say otherwise")
    .put("LOD_EDGES_PER_CYCLE", lod_edges, "edges of a triangle that lod_test takes in a cycle, likewise")
    .put(
        "DIVIDE_BITS",
        hardware.divide_bits,
        "bits of a quotient that hit_divide finds in a cycle, if its parameter does not say otherwise",
    )
    .put("SETUP_BITS", hardware.setup_bits, "of each reciprocal that ray_setup finds, likewise")
    .put("SETUP_COPIES", hardware.setup_copies, "ray_setup blocks that take turns")
    .put("DIVIDE_COPIES", hardware.divide_copies, "hit_divide blocks, likewise")
    .put(
        "BOXES_PER_CYCLE",
        hardware.boxes_per_cycle.count(),
        "boxes that child_test tests in a cycle, if its parameter does not say otherwise",
    )
    .put(
        "LINK_REGISTERS",
        hardware.link_registers,
        "between contexts and blocks: 0, 1 for operands, or 2 for results and answers of memory too",
    )
    .put("INDEX_W", hardware.index_bits, "of the number of a quad-BVH node, of a tree and its place, and of a node, where it is kept")
    .put(
        "LOD_TEST",
        u32::from(hardware.chooses_levels()),
        "levels of detail are chosen, and triangles morphed: 1, or 0 if all rays are of full detail or of none",
    )
    .put("START_RADIUS", u32::from(hardware.start_radius), "cones can have a radius where their rays start")
    .put("HIT_MAPPING", u32::from(hardware.hit_mapping), "hits can be above the finest level")
    .put("COMPACT_VERTICES", u32::from(hardware.compact_vertices), "inserted vertices can be displacements, and L0 records of one line")
    .put("EXACT_VERTICES", u32::from(hardware.exact_vertices), "they can be stored as they are, and L0 records have two lines")
    .put("COORDINATE_ZEROS", hardware.coordinate_zeros, "zero bits at the bottom of every coordinate, which it leaves out")
    .put("DIRECTION_ZEROS", hardware.direction_zeros, "of every component of a direction")
    .put(
        "SECONDARY",
        u32::from(hardware.secondary),
        "rays can start on a surface, count hits of a range of t only, and end at any of them",
    );
    let form = hardware.form();
    let [edge_stages, t_stages] = form.edge_product_stages();
    let edges_at = |edges_per_cycle| TriTest::timing(&Form { edges_per_cycle, ..form });
    let (three, one) = (edges_at(EdgesPerCycle::Three), edges_at(EdgesPerCycle::One));
    let lod_edges_at = |lod_edges_per_cycle| LodTest::timing(&Form { lod_edges_per_cycle, ..form });
    let (lod_three, lod_one) = (lod_edges_at(EdgesPerCycle::Three), lod_edges_at(EdgesPerCycle::One));
    let widths = Group::new("Widths (docs/numbers.md).")
        .put("RAY_T_W", RayT::WIDTH, "t in steps of 2^-32")
        .put("T_NEAR_W", TNear::WIDTH, "t_near in steps of 2^16 units")
        .put("BARY_W", Bary::WIDTH, "2^31 = 1")
        .put("EDGE_STATE_W", EdgeState::WIDTH, "256 = 1")
        .put("DISTANCE_W", parts::DISTANCE, "l = (p - x).d / 2^30, signed: 64 - 30 bits")
        .put("TOLERANCE_W", parts::TOLERANCE, "D, clamped to this width")
        .put("BOUND_CODE_W", BoundCode::WIDTH, "")
        .put("BOUND_W", Bound::WIDTH, "|q - m| < 2^32.8")
        .put("LINE_ADDRESS_W", LineAddress::WIDTH, "2 TiB of 32-byte lines")
        .put("EPOCH_W", Epoch::WIDTH, "of the number of a context's ray, which its lines come back with")
        .put("BEHIND_W", Behind::WIDTH, "of the number of rays that a context takes while it is owed lines, and of ticks in an age")
        .put("OWED_W", Owed::WIDTH, "of the number of lines that a context has asked for and that have not come")
        .put("ANSWER_LIMIT_W", AnswerLimit::WIDTH, "of the cycles after which a line may be late")
        .put("NODE_INDEX_W", NodeIndex::WIDTH, "of a node at the ports: 4^10 nodes on the last level that there can be")
        .put("FULL_ID_W", FullId::WIDTH, "28 bits of tree, 2 of each of ten levels")
        .put("COORDINATE_W", form.coordinate(), "a coordinate without the bits that are always 0")
        .put("COMPONENT_W", form.component(), "a component of a direction, likewise")
        .put("RELATIVE_W", form.relative(), "difference of two coordinates")
        .put("NORMAL_W", form.normal(), "component of p x q: two products of two differences")
        .put("EDGE_FUNCTION_W", EdgeFunction::WIDTH, "|p x q| |d| < 2^96")
        .put("EDGE_ZEROS", "2 * COORDINATE_ZEROS + DIRECTION_ZEROS", "at the bottom of an edge function")
        .put("SIGNED_EDGE_W", "EDGE_FUNCTION_W + 1 - EDGE_ZEROS", "")
        .put("T_NUMERATOR_W", TNumerator::WIDTH, "|a| |b| |c| < 2^98.4")
        .put("SIGNED_T_NUMERATOR_W", "T_NUMERATOR_W + 1 - 3 * COORDINATE_ZEROS", "");
    let widths = widths
        .put("DECIDER_W", Decider::WIDTH, "of who decides about an edge: 0 the ray itself, 1 and 2 its viewers")
        .put("FRACTION_W", START_BITS, "of the fraction of an exact start, in each coordinate")
        .put("WHOLE_RELATIVE_W", Form::FULL.relative(), "difference of two coordinates with all their bits")
        .put("WHOLE_NORMAL_W", Form::FULL.normal(), "component of p x q of such")
        .put("EXACT_NORMAL_W", parts::EXACT_NORMAL, "of an exact start: |p x q| < 2^65.6 in steps of 2^-31")
        .put("EXACT_EDGE_W", "EDGE_FUNCTION_W + FRACTION_W + 1", "its product with d, likewise")
        .put("EXACT_T_W", "T_NUMERATOR_W + FRACTION_W + 1", "and a.(b x c)");
    let sizes = Group::new("Sizes.")
        .put("COORD_LIMIT", COORD_LIMIT, "of a coordinate in magnitude")
        .put("MAX_BOUND_OFFSET", MAX_BOUND_OFFSET, "of a scale of displacement bounds")
        .put("SCENE_LEVELS", hardware.scene_levels(), "the most splits N of a scene: where hits cannot be mapped, those that are stored")
        .put("MAX_CONTEXTS", 1u32 << hardware.context_bits, "that CONTEXT_W can number")
        .put(
            "STACK_ENTRIES",
            hardware.stack_entries(),
            match hardware.fewer_stack_entries {
                None => "3 (MAX_BVH_DEPTH + STORED_LEVELS) + 1: each level leaves at most three siblings waiting",
                Some(_) => "as many as can wait in the scenes that it is for",
            },
        )
        .put("KEPT_ENTRY_W", hardware.entry(), "of a stack entry, where it is kept")
        .put("SPLIT_TRIANGLES", hardware.split_triangles(), "of a context: one of each level that splits into nodes")
        .put("NODE_W", 2 * hardware.levels, "of a node within its level: two bits of each level")
        .put("KEPT_NODE_W", hardware.node_bits(), "where it is kept: two bits of each stored level");
    let scales =
        Group::new("Scales.").put("BOX_SHIFT", BOX_SHIFT, "").put("T_NEAR_TO_T_SHIFT", T_NEAR_TO_T_SHIFT, "").put("S_ONE", S_ONE, "");
    let cycles = Group::new(
        "Cycles from an input taken to its output offered, and (where not 1) from one input taken to the next: `Block::timing` in Rust.",
    )
    .timing::<BaryMap>(hardware)
    .timing::<BoundDecode>(hardware)
    .timing::<BoxDecode>(hardware)
    .timing::<BoxDecode8>(hardware)
    .timing::<BoxTest>(hardware)
    .timing::<BoxTest32>(hardware)
    .timing::<ChildBoxes>(hardware)
    .timing::<ChildSort>(hardware)
    .timing::<ChildSort6>(hardware)
    .timing::<HitDivide>(hardware)
    .timing::<HitSelect>(hardware)
    .timing::<LodTest>(hardware)
    .put("LOD_TEST_1_LATENCY", lod_one.latency, "of the form with one edge a cycle")
    .put("LOD_TEST_1_INTERVAL", lod_one.interval, "")
    .put("LOD_TEST_3_LATENCY", lod_three.latency, "of the form with three")
    .timing::<LodTestBy>(hardware)
    .put("LOD_TEST_BY_1_LATENCY", LodTestBy::ONE_EDGE.latency, "of the form with one edge a cycle")
    .put("LOD_TEST_BY_1_INTERVAL", LodTestBy::ONE_EDGE.interval, "")
    .put("LOD_TEST_BY_3_LATENCY", LodTestBy::THREE_EDGES.latency, "of the form with three")
    .timing::<NodeAddress>(hardware)
    .timing::<NodeDeciders>(hardware)
    .timing::<PrismFrame>(hardware)
    .timing::<PrismTest>(hardware)
    .timing::<RaySetup>(hardware)
    .timing::<StartDivide>(hardware)
    .timing::<StartSetup>(hardware)
    .timing::<StartTest>(hardware)
    .put("START_TEST_1_LATENCY", StartTest::ONE_EDGE.latency, "of the form with one edge a cycle")
    .put("START_TEST_1_INTERVAL", StartTest::ONE_EDGE.interval, "")
    .put("START_TEST_3_LATENCY", StartTest::THREE_EDGES.latency, "of the form with three")
    .timing::<Tessellate>(hardware)
    .timing::<TreeDeciders>(hardware)
    .timing::<TriTest>(hardware)
    .put("TRI_TEST_1_LATENCY", one.latency, "of the form with one edge a cycle")
    .put("TRI_TEST_1_INTERVAL", one.interval, "")
    .put("TRI_TEST_3_LATENCY", three.latency, "of the form with three")
    .timing::<ChildTest>(hardware)
    .timing::<ChildPrisms>(hardware)
    .put("SETUP_INTERVAL", hardware.interval(Operation::RaySetup), "of all copies of ray_setup or start_setup together")
    .put("DIVIDE_INTERVAL", hardware.interval(Operation::HitDivide), "of all copies of hit_divide or start_divide together");
    let parts = Group::new("Cycles of parts of blocks.")
        .put("ENTRY_DISTANCE_LATENCY", parts::ENTRY_DISTANCE_LATENCY, "of the box tests")
        .put("EDGE_PRODUCT_STAGES", parts::EDGE_PRODUCT_STAGES, "registers of the products of a cross product")
        .put("EDGE_DOT_STAGES", edge_stages, "of those with a direction")
        .put("T_DOT_STAGES", t_stages, "of those of t, which take as long")
        .put("EDGE_FUNCTION_LATENCY", form.edge_function_latency(), "of tri_test")
        .put("TRI_DECIDE_LATENCY", parts::TRI_DECIDE_LATENCY, "of tri_test and start_test")
        .put("START_PRODUCT_STAGES", parts::START_PRODUCT_STAGES, "registers of the products of exact numbers")
        .put("START_EDGE_LATENCY", parts::START_EDGE_LATENCY, "of start_test")
        .put("CONE_TOLERANCE_LATENCY", parts::CONE_TOLERANCE_LATENCY, "of lod_test")
        .put("EDGE_OPENING_LATENCY", parts::EDGE_OPENING_LATENCY, "of lod_test")
        .put("LOD_EDGE_BY_LATENCY", lod_test_by::EDGE_LATENCY, "of lod_test_by")
        .put(
            "MULTIPLIER_LIMB_W",
            parts::LIMB,
            "a factor of multiplier is cut into limbs of so many bits, the highest signed with up to one more",
        );
    for group in [of_hardware, widths, sizes, scales, cycles, parts] {
        group.print(out);
    }
}
