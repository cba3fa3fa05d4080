mod geometry;

use super::{BlockTable, CacheTable, EnergyCounts, EnergyModel, EnergyReport, EnergyUnit, Level, Operation};
use crate::block::child_prisms::ChildPrisms;
use crate::block::child_test::ChildTest;
use crate::block::hit_divide::HitDivide;
use crate::block::lod_test::LodTest;
use crate::block::ray_setup::RaySetup;
use crate::block::tri_test::TriTest;
use crate::block::{Block, BoxesPerCycle, EdgesPerCycle};
use crate::hardware::Hardware;
use crate::machine::Machine;
use crate::method::{bvh, lod};

const CACHES: &str = include_str!("../../../../machines/energy/cacti22-older.toml");
const RELATIVE: &str = include_str!("../../../../machines/energy/relative.toml");
const BLOCKS: &str = include_str!("../../../../machines/energy/blocks22.toml");

fn model(machine: &str) -> EnergyModel {
    EnergyModel::new(&Machine::shipped(machine).unwrap()).unwrap()
}

/// All edges and boxes at once.
const WIDE: Hardware = Hardware {
    edges_per_cycle: EdgesPerCycle::Three,
    lod_edges_per_cycle: EdgesPerCycle::Three,
    boxes_per_cycle: BoxesPerCycle::Four,
    ..Hardware::DEFAULT
};
/// One box, which the default has two of.
const SECONDARY: Hardware = Hardware { secondary: true, ..Hardware::DEFAULT };
const ONE_BOX: Hardware = Hardware { boxes_per_cycle: BoxesPerCycle::One, ..Hardware::DEFAULT };

/// Equal to within 1 / 10^9.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * b.abs()
}

#[test]
fn the_tables_have_the_published_figures() {
    let table = |name: &str| {
        let mut machine = Machine::shipped("haydel2023").unwrap();
        machine.set("energy.caches", name).unwrap();
        let t = EnergyModel::new(&machine).unwrap();
        [t.l1.read, t.l1.leakage_mw_per_bank, t.l2.read, t.l2.leakage_mw_per_bank]
    };
    assert_eq!(table("cacti22"), [14.6395, 2.4667, 94.0184, 29.0936]);
    assert_eq!(table("cacti22-older"), [46.4909, 3.11185, 240.039, 30.6609]);
    let relative = CacheTable::parse(RELATIVE, "relative").unwrap();
    let read = |level| relative.level(level)[0].read;
    assert_eq!((read(Level::L1), read(Level::L2), relative.dram_line), (1.0, 1.5, Some(40.0)));
}

/// The authors' newer figures (26.7189 pJ and 3.18625 mW of their L1, 94.0184 pJ and 29.0936 mW of their L2) are those of their geometries but for a read of
/// their L1.
#[test]
fn the_authors_newer_figures_are_the_rows_of_their_machine() {
    let public = model("haydel2023-public");
    assert_eq!([public.l1.leakage_mw_per_bank, public.l2.read, public.l2.leakage_mw_per_bank], [3.18625, 94.0184, 29.0936]);
    assert!((1.02..1.03).contains(&(public.l1.read / 26.7189)));
}

/// Four rows of a table in the authors' repository: accesses of L1 and L2, cycles, and the energies of L1 and L2 in microjoules.
#[test]
fn published_counts_give_the_published_energies() {
    let rows = [
        (306_906_451, 53_679_267, 9_458_528, 18_036.0, 17_525.0),
        (242_085_316, 38_204_781, 6_894_094, 14_001.0, 12_553.0),
        (60_148_586, 7_883_407, 1_952_160, 3_574.0, 2_850.0),
        (6_876_151, 462_426, 347_750, 458.0, 282.0),
    ];
    let model = model("haydel2023-ddr3");
    for (l1_reads, l2_reads, cycles, l1_uj, l2_uj) in rows {
        let fills = l2_reads; // which that table does not count
        let counts = EnergyCounts { cycles, l1_reads, l2_reads, l1_fills: fills, ..Default::default() };
        let report = model.report(&counts, &[]);
        assert!((report.l1() * 1e-6 - l1_uj).abs() < 1.0, "L1: {} against {l1_uj}", report.l1() * 1e-6);
        assert!((report.l2() * 1e-6 - l2_uj).abs() < 1.0, "L2: {} against {l2_uj}", report.l2() * 1e-6);
    }
}

#[test]
fn caches_by_hand() {
    let counts =
        EnergyCounts { cycles: 2_000_000, l1_reads: 10, l1_fills: 3, l2_reads: 4, l2_fills: 1, dram_lines: 7, ..Default::default() };
    let dram = [("background", 100.0), ("read", 23.0)];
    let report = model("haydel2023").report(&counts, &dram);
    // 2,000,000 cycles at 2 GHz are 1 ms: 1 mW is 10^6 pJ. 64 x 4 banks of L1, 32 of L2.
    let expected = EnergyReport {
        unit: EnergyUnit::Picojoules,
        l1_read: 146.395,
        l1_fill: 46.0398,
        l1_leakage: 256.0 * 2.4667 * 1e6,
        l2_read: 376.0736,
        l2_fill: 98.8725,
        l2_leakage: 32.0 * 29.0936 * 1e6,
        compute: vec![],
        unit_leakage: 0.0,
        unit_clock: 0.0,
        dram: dram.to_vec(),
    };
    let parts = |r: &EnergyReport| [r.l1_read, r.l1_fill, r.l1_leakage, r.l2_read, r.l2_fill, r.l2_leakage];
    assert!(parts(&report).into_iter().zip(parts(&expected)).all(|(a, b)| close(a, b)), "{report:?}");
    assert_eq!((&report.compute, report.unit_leakage, report.unit_clock, &report.dram), (&vec![], 0.0, 0.0, &expected.dram));
    assert!(close(report.l1(), parts(&expected)[..3].iter().sum()));
    assert!(close(report.total_without_dram(), parts(&expected).iter().sum()));
    assert_eq!(report.dram(), 123.0);
    assert!(close(report.total(), report.total_without_dram() + 123.0));
}

#[test]
fn relative_energies_price_lines_and_nothing_else() {
    let mut counts =
        EnergyCounts { cycles: 1000, l1_reads: 100, l1_fills: 9, l2_reads: 10, l2_fills: 5, dram_lines: 2, ..Default::default() };
    counts.unit = lod::METHOD.unit;
    counts.operations.add(Operation::LodTest, 5);
    let report = model("packet").report(&counts, &[("background", 1e9)]);
    assert_eq!(report.unit, EnergyUnit::L1Accesses);
    assert_eq!((report.l1(), report.l2(), report.dram(), report.compute()), (100.0, 15.0, 80.0, 0.0));
    assert_eq!(report.total(), 195.0);
}

#[test]
fn operations_by_hand() {
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    // tessellate: 9 products of 33 x 10 bits; 1515 bits added; 2031 selected; 5667 registers.
    let tessellate = (9.0 * 330.0 * 3.1 / 1024.0 + 1515.0 * 0.1 / 32.0) * 0.268 + (2031.0 * 0.018 / 32.0 + 5667.0 * 0.0090) * 0.309;
    assert!(close(table.operation_pj(Operation::Tessellate, &Hardware::DEFAULT), tessellate));
    // hit_divide: its 536 registers are written in each of 13 cycles, 12 of which compare 7 multiples of 103 bits; three multiples of 99 bits, and 96 compared before.
    let hit_divide = 9045.0 * 0.1 / 32.0 * 0.268 + (8400.0 * 0.018 / 32.0 + 536.0 * 13.0 * 0.0090) * 0.309;
    assert!(close(table.operation_pj(Operation::HitDivide, &Hardware::DEFAULT), hit_divide));
    // With a bit a cycle 246 registers in each of 36, 35 of which compare 100 bits.
    let slow = 3596.0 * 0.1 / 32.0 * 0.268 + (3465.0 * 0.018 / 32.0 + 246.0 * 36.0 * 0.0090) * 0.309;
    assert!(close(table.operation_pj(Operation::HitDivide, &Hardware { divide_bits: 1, ..Hardware::default() }), slow));
    let mut counts = EnergyCounts::default();
    counts.operations.add(Operation::Tessellate, 2);
    counts.operations.add(Operation::Tessellate, 1);
    counts.operations.add(Operation::HitDivide, 5);
    let report = model("haydel2023").report(&counts, &[]);
    assert_eq!(report.compute.iter().map(|part| part.0).collect::<Vec<_>>(), ["tessellate", "hit_divide"]);
    // The machine's units are the default's.
    assert!(close(report.compute[0].1, 3.0 * tessellate) && close(report.compute[1].1, 5.0 * hit_divide));
    assert!(close(report.total(), 3.0 * tessellate + 5.0 * hit_divide));
}

#[test]
fn units_leak_and_are_clocked_for_the_whole_frame_where_there_are_any() {
    let mut counts = EnergyCounts { cycles: 2_000_000, ..Default::default() };
    let none = model("haydel2023").report(&counts, &[]);
    assert_eq!((none.unit_leakage, none.unit_clock), (0.0, 0.0));
    counts.unit = lod::METHOD.unit;
    let report = model("haydel2023").report(&counts, &[]);
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    // 1 ms, 64 units of 16 contexts.
    let unit = lod::METHOD.unit.unwrap();
    let [sixteen, seventeen] = [16, 17].map(|contexts| Hardware { contexts, ..Hardware::default() });
    let own = Machine::shipped("haydel2023").unwrap().units.config();
    assert_eq!(own.contexts, 16);
    assert!(close(report.unit_leakage, 64.0 * table.unit_leakage_mw(unit, &own) * 1e6));
    assert!(close(report.unit_clock, 64.0 * table.unit_clock_pj(unit, &own) * 2e6));
    // Registers of the blocks of a unit, and 16 contexts: one bit in 32 is clocked, each leaks.
    let registers: f64 = 1465.0 + 119.0 + 13837.0 + 5016.0 + 5667.0 + 12171.0 + 536.0 + 296.0 + 1286.0 + 16.0 * 21702.0;
    assert!(close(table.unit_clock_pj(unit, &sixteen), registers / 32.0 * 0.0079 * 0.309));
    let logic = table.unit_leakage_mw(unit, &sixteen) - registers * 0.000074;
    assert!((2.0..8.0).contains(&logic), "{logic} mW");
    assert!(close(table.unit_leakage_mw(unit, &seventeen) - table.unit_leakage_mw(unit, &sixteen), 21702.0 * 0.000074));
    assert!(close(report.compute(), report.unit_leakage + report.unit_clock));
}

#[test]
fn a_unit_leaks_and_is_clocked_by_the_blocks_that_its_method_needs() {
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    let clock = |registers: f64| registers / 32.0 * 0.0079 * 0.309;
    let sixteen = Hardware { contexts: 16, ..Hardware::default() };
    let kept = |operation: Operation| f64::from(operation.parts(&sixteen.form()).registers.kept);
    let [narrow, wide, levels] = [&bvh::METHOD, &bvh::METHOD_WIDE, &lod::METHOD].map(|method| method.unit.unwrap());
    // No trees, levels or maps: neither blocks nor a context's registers for them.
    let shared = 1465.0 + 119.0 + 12171.0 + 536.0 + 296.0 + 16.0 * 6260.0;
    let order = 164.0;
    // Two boxes at a time.
    let bvh = shared + 2.0 * (258.0 + kept(Operation::BoxTest)) + order;
    assert!(close(table.unit_clock_pj(narrow, &sixteen), clock(bvh)));
    let bvh32 = shared + 2.0 * kept(Operation::BoxTest32) + order;
    assert!(close(table.unit_clock_pj(wide, &sixteen), clock(bvh32)));
    let logic = |unit, registers: f64| table.unit_leakage_mw(unit, &sixteen) - registers * 0.000074;
    let products = 2.0 * (13_140.0 - 6816.0) * 0.0483 / 1024.0;
    let sums = 2.0 * (825.0 - 957.0 - 138.0) * 0.00238 / 32.0;
    let selections = 2.0 * (852.0 - 897.0 - 480.0) * 0.00061 / 32.0;
    assert!(close(logic(wide, bvh32) - logic(narrow, bvh), products + sums + selections));
    assert!(table.unit_leakage_mw(narrow, &sixteen) < table.unit_leakage_mw(levels, &sixteen));
    let leakage =
        |unit| model("haydel2023").report(&EnergyCounts { cycles: 2_000_000, unit: Some(unit), ..Default::default() }, &[]).unit_leakage;
    let own = Machine::shipped("haydel2023").unwrap().units.config();
    assert!(close(leakage(wide), 64.0 * table.unit_leakage_mw(wide, &own) * 1e6));
}

/// Products of 18 x 18 bits as the multipliers of `rtl/` cut them: limbs of 17 bits, the highest up to 18.
#[test]
fn products_are_those_of_the_rtl() {
    let parts = |operation: Operation, hardware: &Hardware| operation.parts(&hardware.form());
    let limbs = |bits: u32| if bits <= 18 { 1 } else { (bits - 1).div_ceil(17) };
    let multipliers = |operation| -> u32 { parts(operation, &WIDE).products.iter().map(|&[n, a, b]| n * limbs(a) * limbs(b)).sum() };
    assert_eq!(multipliers(Operation::BoxTest), 24 + 3);
    assert_eq!(multipliers(Operation::BoxTest32), 48 + 3);
    assert_eq!(multipliers(Operation::ChildTest), 4 * (24 + 3));
    assert_eq!(multipliers(Operation::TriTest), 168);
    for operation in [Operation::TriTest, Operation::LodTest, Operation::ChildTest] {
        assert_eq!(parts(operation, &ONE_BOX).products, parts(operation, &WIDE).products);
    }
    assert_eq!(multipliers(Operation::LodTest), 9 * 4 + 3 * 2);
}

#[test]
fn cycles_of_a_blocks_hardware_are_its_interval() {
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    for operation in Operation::ALL {
        let interval = match operation {
            Operation::RaySetup | Operation::StartSetup => RaySetup::TIMING.interval,
            Operation::HitDivide | Operation::StartDivide => HitDivide::TIMING.interval,
            // Its prisms take turns whatever boxes do.
            Operation::ChildPrisms => ChildPrisms::TIMING.interval,
            _ => 1,
        };
        assert_eq!(operation.timing(&WIDE.form()).interval, interval, "{}", operation.name());
    }
    let intervals = [TriTest::TIMING, LodTest::TIMING, ChildTest::TIMING].map(|timing| timing.interval);
    assert_eq!(intervals, [3, 3, 2]);
    let mut machine = Machine::shipped("haydel2023").unwrap();
    for (operation, key, counts) in [
        (Operation::TriTest, "units.edges_per_cycle", [("1", Hardware::DEFAULT), ("3", WIDE)]),
        (Operation::LodTest, "units.lod_edges_per_cycle", [("1", Hardware::DEFAULT), ("3", WIDE)]),
        (Operation::ChildTest, "units.boxes_per_cycle", [("1", ONE_BOX), ("4", WIDE)]),
    ] {
        let mut one = EnergyCounts::default();
        one.operations.add(operation, 1);
        for (count, hardware) in counts {
            machine.set(key, count).unwrap();
            let report = EnergyModel::new(&machine).unwrap().report(&one, &[]);
            assert!(close(report.compute(), table.operation_pj(operation, &hardware)), "{key} = {count}");
        }
    }
}

/// Of blocks that take turns each leaks and has a clock; an operation takes one of them.
#[test]
fn blocks_in_turns_leak_each() {
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    let unit = lod::METHOD.unit.unwrap();
    let hardware = [1, 2, 3].map(|copies| Hardware { setup_copies: copies, divide_copies: copies, ..Hardware::DEFAULT });
    let costs: [&dyn Fn(&Hardware) -> f64; 2] = [&|of| table.unit_leakage_mw(unit, of), &|of| table.unit_clock_pj(unit, of)];
    for cost in costs {
        let [one, two, three] = [0, 1, 2].map(|k| cost(&hardware[k]));
        assert!(two > one && close(three - two, two - one), "{one}, {two}, {three}");
    }
    for operation in [Operation::RaySetup, Operation::HitDivide] {
        assert!(close(table.operation_pj(operation, &hardware[0]), table.operation_pj(operation, &hardware[2])));
    }
}

/// Registers that an operation passes through in turns are written in each; others once.
#[test]
fn turns_are_charged_where_they_are_taken() {
    let registers = |operation: Operation, hardware: &Hardware| operation.parts(&hardware.form()).registers;
    // The frame and the order of prisms are found once, each is tested in its turn.
    let prisms = registers(Operation::ChildPrisms, &WIDE);
    assert!(prisms.written < 4 * prisms.kept && prisms.written > 2 * prisms.kept);
    for operation in Operation::ALL.into_iter().filter(|&operation| operation != Operation::ChildPrisms) {
        let of = registers(operation, &WIDE);
        let interval = operation.timing(&WIDE.form()).interval;
        assert_eq!(of.written, interval * of.kept, "{}", operation.name());
    }
    // Behind the three edges: the decision, and the outcome.
    let tri = registers(Operation::TriTest, &Hardware::DEFAULT);
    assert!(tri.written < 3 * tri.kept && tri.written > 5 * tri.kept / 2);
    let lod = registers(Operation::LodTest, &Hardware::DEFAULT);
    assert_eq!(3 * lod.kept - lod.written, 2 * (28 + 8 + 1));
    // Boxes and order are found for all four at once; four box tests take as much in turns as side by side, but for what stands beside them.
    let boxes = |operation| f64::from(registers(operation, &Hardware::DEFAULT).kept);
    let tests = 4.0 * boxes(Operation::BoxTest);
    for hardware in [WIDE, Hardware::DEFAULT, ONE_BOX] {
        let around = f64::from(registers(Operation::ChildTest, &hardware).written) - tests;
        assert!((2000.0..7000.0).contains(&around), "{around}");
    }
}

#[test]
fn operations_are_counted_under_their_own_number() {
    for (number, operation) in Operation::ALL.into_iter().enumerate() {
        assert_eq!(operation as usize, number);
        let mut counts = EnergyCounts::default();
        counts.operations.add(operation, 1 + number as u64);
        assert_eq!(counts.operations.get(operation), 1 + number as u64);
        assert_eq!(counts.operations.iter().filter(|of| of.1 > 0).collect::<Vec<_>>(), [(operation, 1 + number as u64)]);
    }
    let of_primary_rays = &Operation::ALL[..=Operation::BaryMap as usize];
    assert_eq!(lod::METHOD.unit.unwrap().blocks, [of_primary_rays, &[Operation::TreeDeciders]].concat());
}

#[test]
fn a_broken_cache_table_names_file_and_key() {
    let cases = [
        (CACHES, "read = 46.4909", "read = -1", "l1.read must be a number and not negative, but is -1"),
        (CACHES, "read = 240.039", "read = nan", "l2.read must be a number and not negative, but is NaN"),
        (CACHES, "fill = 0", "fill = inf", "l1.fill must be"),
        (CACHES, "fill = 0                                                              ", "fill = inf", "l2.fill must be"),
        (CACHES, "= 3.11185", "= -3.11185", "l1.leakage_mw_per_bank must be"),
        (CACHES, "[[l1]]", "dram_line = 1\n[[l1]]", "dram_line must be absent where energies are in pJ"),
        (CACHES, "\"pJ\"", "\"nJ\"", "nJ"),
        (CACHES, "[[l1]]", "[[l1]]\nwrite = 1", "`write`"),
        (CACHES, "[[l1]]", "rows = \"../a.csv\"\n[[l1]]", "rows must be the name of a file beside the table, with .csv, but is"),
        (CACHES, "[[l1]]", "rows = \"a.toml\"\n[[l1]]", "rows must be the name of a file"),
        (CACHES, "ways = 2,", "", "`ways`"),
        (RELATIVE, "[[l1]]", "rows = \"cacti22.csv\"\n[[l1]]", "rows must be absent where energies are relative"),
        (RELATIVE, "dram_line = 40", "", "dram_line must be given where energies are relative"),
        (RELATIVE, "dram_line = 40", "dram_line = -40", "dram_line must be a number"),
        (RELATIVE, "leakage_mw_per_bank = 0", "leakage_mw_per_bank = 1", "l1.leakage_mw_per_bank must be 0 where"),
    ];
    for (text, from, to, expected) in cases {
        assert!(text.contains(from), "{from}");
        let error = CacheTable::parse(&text.replacen(from, to, 1), "broken.toml").expect_err(to).to_string();
        assert!(error.starts_with("broken.toml: ") && error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn a_broken_block_table_names_file_and_key() {
    let cases = [
        ("add_32_pj = 0.1", "add_32_pj = -0.1", "operations.add_32_pj must be a number and not negative, but is -0.1"),
        ("leakage = 1.0", "leakage = nan", "scale.leakage must be"),
        ("registers_per_clock_gate = 32", "registers_per_clock_gate = 0", "unit.registers_per_clock_gate must be at least 1"),
        ("select_32_pj = 0.018", "select_16_pj = 0.018", "`select_16_pj`"),
        ("clock_pj = 0.0079", "", "`clock_pj`"),
        ("add_32_mw = 0.00238", "add_32_mw = []", "invalid type"),
        // What a block is made of is not the table's to say.
        ("[unit]", "[blocks.lod_test]\nregisters = 1\n[unit]", "`blocks`"),
    ];
    for (from, to, expected) in cases {
        assert!(BLOCKS.contains(from), "{from}");
        let error = BlockTable::parse(&BLOCKS.replacen(from, to, 1), "broken.toml").expect_err(to).to_string();
        assert!(error.starts_with("broken.toml: ") && error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn tables_that_do_not_go_together_or_are_nowhere() {
    let mut machine = Machine::shipped("haydel2023").unwrap();
    machine.set("energy.caches", "relative").unwrap();
    let error = EnergyModel::new(&machine).unwrap_err().to_string();
    assert!(error.contains("energy.blocks must be absent where energies are relative"), "{error}");
    machine.set("energy.caches", "cacti99").unwrap();
    let error = EnergyModel::new(&machine).unwrap_err().to_string();
    assert!(error.contains("energy/cacti99.toml") && error.contains("energy/cacti22-older.toml"), "{error}");
}

#[test]
fn the_documented_energies_are_the_tables() {
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    let documented = include_str!("../../../../docs/energy.md");
    let pj = |name: &str| {
        let row = documented.lines().find(|line| line.starts_with(&format!("| `{name}` |"))).unwrap_or_else(|| panic!("no row for {name}"));
        row.trim_end_matches(" |").rsplit(" | ").next().unwrap().to_owned()
    };
    // The hardware that has them: one or the other.
    let of = |operation| if Hardware::DEFAULT.has(operation) { Hardware::DEFAULT } else { SECONDARY };
    let default = Operation::ALL.map(|operation| (operation.name(), operation, of(operation)));
    let further = [
        ("tri_test-EDGES_PER_CYCLE=3", Operation::TriTest, WIDE),
        ("lod_test-EDGES_PER_CYCLE=3", Operation::LodTest, WIDE),
        ("child_test-BOXES_PER_CYCLE=4", Operation::ChildTest, WIDE),
        ("child_test-BOXES_PER_CYCLE=1", Operation::ChildTest, ONE_BOX),
    ];
    let said = default.into_iter().chain(further).map(|(name, operation, of)| (name, format!("{:.1}", table.operation_pj(operation, &of))));
    let wrong: Vec<_> = said.filter(|(name, all)| pj(name) != *all).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_documented_units_are_the_tables() {
    let table = BlockTable::parse(BLOCKS, "blocks22").unwrap();
    let documented = include_str!("../../../../docs/energy.md");
    let units = [&lod::METHOD, &bvh::METHOD, &bvh::METHOD_WIDE, &bvh::METHOD_SIX].map(|method| method.unit.unwrap());
    let sixteen = Hardware { contexts: 16, ..Hardware::default() };
    let copies = Hardware { setup_copies: 3, divide_copies: 2, ..sixteen };
    assert_eq!(Machine::shipped("haydel2023").unwrap().units.config(), copies);
    for (said_of, hardware) in [("With 16 contexts", sixteen), ("as the units of `haydel2023` have,", copies)] {
        let leaks = units.map(|unit| format!("{:.1}", table.unit_leakage_mw(unit, &hardware)));
        let clocks = units.map(|unit| format!("{:.1}", table.unit_clock_pj(unit, &hardware)));
        let said = |of: &[String; 4]| format!("{}, {}, {} and {}", of[0], of[1], of[2], of[3]);
        let line = format!("{said_of} they leak {} mW and their clocks take {} pJ a cycle.", said(&leaks), said(&clocks));
        assert!(documented.contains(&line), "{line}");
    }
    let pj = |operation| table.operation_pj(operation, &Hardware::DEFAULT);
    let boxes = |of| 4.0 * pj(of) + pj(Operation::ChildSort);
    let [plain, wide] = [boxes(Operation::BoxTest), boxes(Operation::BoxTest32)];
    let local = plain + 4.0 * pj(Operation::BoxDecode);
    let six = 6.0 * (pj(Operation::BoxDecode8) + pj(Operation::BoxTest)) + pj(Operation::ChildSort6);
    let line = format!(
        "A node takes {:.1} pJ of the LOD unit; of a BVH's {local:.1} pJ with boxes in steps, {plain:.1} pJ with codes of 16 bits and {wide:.1} pJ with 32 bits, and {six:.1} pJ with six children.",
        pj(Operation::ChildTest)
    );
    assert!(documented.contains(&line), "{line}");
    let thousands = |bits: u32| format!("{},{:03} |", bits / 1000, bits % 1000);
    for (name, has_levels) in
        [("`lod`", true), ("`bvh`", false), ("`discrete`", false), ("`chunked`", false), ("`bvh32`", false), ("`bvh6`", false)]
    {
        let row = documented.lines().find(|line| line.starts_with(&format!("| {name} |"))).expect("a row");
        assert!(row.ends_with(&thousands(sixteen.context_registers(has_levels).kept)), "{row}");
    }
}
