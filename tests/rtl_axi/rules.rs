//! Each rule of the adapter's ports alone rejects a master, a slave or surroundings that break it, and all of them pass what is right.

use crate::bus::{Beat, Bus, Memory, SMOOTH, input};
use lodray::hardware::ports::MemoryRequest;
use lodray::num::U;
use lodray_test_support::models::Rng;
use std::path::Path;
use std::sync::Arc;
use tb::{Build, Model, Sim};

/// What is wrong with the master: where the text of the adapter is changed, so that input `fault_i` breaks it.
const MASTER: [(&str, &str); 7] = [
    (
        "    .clk_i, .rst_ni,\n    .valid_i(mem_valid_i && some_free)",
        "    .clk_i, .rst_ni((rst_ni || fault_i[0]) && !(fault_i[1] && axi_arvalid_o && !axi_arready_i)),\n    .valid_i(mem_valid_i && some_free)",
    ),
    ("{number_q, LINE_SHIFT'(0)}", "{number_q ^ NUMBER_W'(fault_i[2] && !axi_arready_i), LINE_SHIFT'(fault_i[4])}"),
    ("8'(BEATS - 1)", "fault_i[3] ? 8'd255 : 8'(BEATS - 1)"),
    ("3'($clog2(DATA_W / 8))", "3'($clog2(DATA_W / 8)) - 3'(fault_i[7])"),
    ("2'b01;", "{fault_i[8], 1'b1};"),
    (".data_i({place, number})", ".data_i({(place | {ID_W{fault_i[5]}}) & {ID_W{!fault_i[6]}}, number})"),
    (
        "  input  logic                     rst_ni,\n",
        "  input  logic                     rst_ni,\n  input logic [8:0] fault_i,\n  input logic [15:0] rules_i,\n",
    ),
];

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// Of the master: a bit of `fault_i`.
    Master(u32),
    BeatOfNoRequest,
    LastEarly,
    LastNotMarked,
    BaseNotALine,
    BaseMoved,
    BehindTheBus,
}

/// Each rule by its words, and what breaks it.
const RULES: [(&str, &[Fault]); 12] = [
    ("ar: a request in the first cycle after reset", &[Fault::Master(0)]),
    ("ar: a request was withdrawn or changed before it was taken", &[Fault::Master(1), Fault::Master(2)]),
    ("ar: a burst across 4 KB", &[Fault::Master(3)]),
    ("ar: a burst that is not one line of full beats", &[Fault::Master(3), Fault::Master(7), Fault::Master(8)]),
    ("ar: a burst that does not begin where a line does", &[Fault::Master(4)]),
    ("ar: an id that there is not", &[Fault::Master(5)]),
    ("ar: an id that beats are due for", &[Fault::Master(6)]),
    ("r: a beat without a request", &[Fault::BeatOfNoRequest]),
    ("r: the last beat is not marked, or another is", &[Fault::LastEarly, Fault::LastNotMarked]),
    ("base_i: not a multiple of 32", &[Fault::BaseNotALine]),
    ("base_i: it changed beside a request", &[Fault::BaseMoved]),
    ("mem_i: a line behind the last address of the bus", &[Fault::BehindTheBus]),
];

/// The part of a text between two others.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split_once(from).and_then(|(_, rest)| rest.split_once(to)).unwrap_or_else(|| panic!("no {from} .. {to}")).0
}

/// An adapter that can be broken, with each rule behind a bit of `rules_i`; and the rules' words in their order.
fn breakable(folder: &Path) -> (Arc<Model>, Vec<String>) {
    let read = |name: &str| std::fs::read_to_string(tb::rtl().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (adapter, rules) = (read("axi_read_adapter.sv"), read("rules/axi_read_adapter_rules.sv"));

    let (module, bound) = rules.split_once("bind axi_read_adapter axi_read_adapter_rules").expect("its binding");
    let words: Vec<String> =
        module.split("else $error(\"").skip(1).map(|rest| rest.split('"').next().unwrap_or_default().to_owned()).collect();
    let mut parts = module.split("assert (");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for (k, part) in parts.enumerate() {
        text += &format!("assert (!rules_i[{k}] || ({}", part.replacen(") else $error(", ")) else $error(", 1));
    }
    let text = text.replace("module axi_read_adapter_rules", "module breakable_rules").replacen(
        "rst_ni,\n",
        "rst_ni,\n  input logic [15:0] rules_i,\n",
        1,
    );
    let text = text.replace(
        "  logic [SUM_W-1:0] line_end;\n",
        "  logic [SUM_W-1:0] line_end;\n  logic unused_rules;\n  assign unused_rules = ^rules_i;\n",
    );

    let mut broken = adapter.replace("module axi_read_adapter", "module breakable_adapter");
    for (from, to) in MASTER {
        assert_eq!(broken.matches(from).count(), 1, "{from}");
        broken = broken.replacen(from, to, 1);
    }
    let bound = between(bound, "", ";\n").replacen("(\n  .clk_i,", "(\n  .rules_i, .clk_i,", 1);
    let broken = broken.replacen("\nendmodule", &format!("\n  breakable_rules{bound};\n\nendmodule"), 1);

    let files = [("breakable_rules", text), ("breakable_adapter", broken)].map(|(name, text)| {
        let path = folder.join(format!("{name}.sv"));
        std::fs::write(&path, text).unwrap_or_else(|error| panic!("{error}"));
        path
    });
    let build =
        Build::with_files("breakable_adapter", files.to_vec()).parameter("DATA_W", 64).parameter("ADDRESS_W", 32).parameter("READS", 7);
    (build.model().unwrap_or_else(|error| panic!("{error}")), words)
}

/// Whether some traffic with this fault passes the rules of these bits.
fn passes(model: &Arc<Model>, fault: Fault, rules: u64) -> bool {
    const BASE: u64 = 0x4000;
    let mut sim = Sim::new(model, 3);
    let bus = Bus::<2, 3, 32>::new(&sim);
    let (reset, base_i, valid_i) = (input::<bool>(&sim, "rst_ni"), input::<U<32>>(&sim, "base_i"), input::<bool>(&sim, "mem_valid_i"));
    let (mem_i, fault_i, rules_i) =
        (input::<MemoryRequest>(&sim, "mem_i"), input::<U<9>>(&sim, "fault_i"), input::<U<16>>(&sim, "rules_i"));
    let mut rng = Rng(5);
    let fresh = || Memory::new(SMOOTH, 7, |address| address as u32);
    let mut memory = fresh();
    let bit = if let Fault::Master(bit) = fault { 1 << bit } else { 0 };
    sim.poke(fault_i, &U::<9>::new(bit));
    sim.poke(rules_i, &U::<16>::new(rules));
    let resets = |sim: &mut Sim| {
        sim.poke(reset, &false);
        bus.drive(sim, false, None, &mut Rng(1));
        sim.clock();
        sim.poke(reset, &true);
    };
    sim.poke(base_i, &U::<32>::new(BASE));
    sim.poke(valid_i, &false);
    // Whatever a broken register holds leaves it.
    sim.poke(fault_i, &U::<9>::new(0));
    resets(&mut sim);
    sim.poke(fault_i, &U::<9>::new(bit));
    let mut number = 0;
    for cycle in 0..300 {
        if cycle == 150 {
            // With a request at the port that is not taken.
            sim.poke(valid_i, &true);
            bus.drive(&mut sim, false, None, &mut rng);
            (0..2).for_each(|_| sim.clock());
            resets(&mut sim);
            memory = fresh();
        }
        let takes = cycle % 3 == 0;
        let mut beat: Option<Beat<2>> = memory.beat();
        match fault {
            Fault::BeatOfNoRequest if cycle == 0 => beat = Some(Beat { id: 2, data: [U::default(); 2], resp: 0, last: true }),
            Fault::LastEarly => beat = beat.map(|beat| Beat { last: true, ..beat }),
            Fault::LastNotMarked => beat = beat.map(|beat| Beat { last: false, ..beat }),
            _ => (),
        }
        let base = match fault {
            Fault::BaseNotALine => BASE + 8,
            // In a cycle with a request.
            Fault::BaseMoved if cycle >= 101 => 2 * BASE,
            Fault::BehindTheBus => u64::from(u32::MAX) - 31,
            _ => BASE,
        };
        bus.drive(&mut sim, takes, beat, &mut rng);
        sim.poke(base_i, &U::<32>::new(base));
        sim.poke(valid_i, &(cycle % 4 != 0));
        number += u64::from(cycle % 4 == 0);
        sim.poke(mem_i, &MemoryRequest { tag: U::new(number & 255), epoch: U::new(number >> 8 & 255), address: U::new(61 * number) });
        sim.eval();
        if let Some(request) = bus.request(&mut sim).filter(|_| takes) {
            memory.take(request);
        }
        sim.clock();
        if sim.failed() {
            return false;
        }
    }
    true
}

#[test]
fn each_rule_rejects_what_breaks_it() {
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let (model, words) = breakable(folder.path());
    assert_eq!(words, RULES.map(|(words, _)| words), "rules without a fault here");
    assert!(passes(&model, Fault::None, u64::from(u16::MAX)), "what is right was rejected");
    for (k, (words, faults)) in RULES.iter().enumerate() {
        for fault in *faults {
            assert!(!passes(&model, *fault, 1 << k), "{fault:?} passed the rule \"{words}\"");
        }
    }
    // A fault is not seen by all: that of the base breaks no rule of the bus.
    assert!(passes(&model, Fault::BaseMoved, 0x1ff));
}
