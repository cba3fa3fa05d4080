use super::{Machine, MachineError};
use crate::block::EdgesPerCycle;
use crate::hardware::Hardware;
use crate::sim::energy;
use std::fs;
use std::path::Path;

fn shipped(name: &str) -> Machine {
    Machine::shipped(name).unwrap()
}

/// The shipped text of Haydel 2023, the last occurrence of `from` in it replaced.
fn broken(from: &str, to: &str) -> Result<Machine, MachineError> {
    let text = include_str!("../../machines/haydel2023.toml");
    let place = text.rfind(from).unwrap_or_else(|| panic!("{from:?} is not in the file"));
    let text = format!("{}{to}{}", &text[..place], &text[place + from.len()..]);
    Machine::parse(&text, "broken.toml", Default::default())
}

#[test]
fn the_papers_machines_have_the_papers_figures() {
    for name in ["haydel2023", "haydel2023-mshr4", "haydel2023-ddr3"] {
        let m = shipped(name);
        assert_eq!((m.cores.groups, m.cores.per_group, m.cores.total(), m.cores.clock_mhz), (64, 16, 1024, 2000));
        assert_eq!((m.l1.bytes, m.l1.ways, m.l1.banks, m.l1.latency_cycles, m.l1.line_bytes), (16 << 10, 2, 4, 1, 32));
        assert_eq!((m.l2.bytes, m.l2.ways, m.l2.banks, m.l2.latency_cycles, m.l2.line_bytes), (2 << 20, 4, 32, 4, 32));
        assert_eq!((m.l1.lines(), m.l1.sets_per_bank(), m.l2.lines(), m.l2.sets_per_bank()), (512, 64, 65_536, 512));
        assert_eq!(m.dram.channels, 8);
    }
    // One is the other with the registers of the authors' simulator and another mapping.
    let (ours, mut theirs) = (shipped("haydel2023"), shipped("haydel2023-mshr4"));
    assert_eq!((ours.l1.mshrs, ours.l2.mshrs, theirs.l1.mshrs, theirs.l2.mshrs), (16, 64, 4, 4));
    assert_ne!(ours.dram.mapping, theirs.dram.mapping);
    (theirs.name, theirs.l1, theirs.l2, theirs.dram) = (ours.name.clone(), ours.l1.clone(), ours.l2.clone(), ours.dram.clone());
    assert_eq!(theirs, ours);
    assert_eq!(ours.dram.device, "dram/gddr5.toml");
    assert_eq!(shipped("haydel2023").energy.caches, "cacti22");
    assert_eq!(shipped("haydel2023-ddr3").dram.device, "dram/ddr3-scaled.toml");
    assert_eq!(shipped("haydel2023-ddr3").energy.caches, "cacti22-older");
}

#[test]
fn the_other_machines_have_their_figures() {
    let public = shipped("haydel2023-public");
    assert_eq!((public.cores.groups, public.cores.per_group, public.cores.clock_mhz), (64, 64, 2000));
    assert_eq!((public.l1.bytes, public.l1.ways, public.l1.banks, public.l1.mshrs, public.l1.latency_cycles), (32 << 10, 4, 8, 4, 1));
    assert_eq!((public.l2.bytes, public.l2.ways, public.l2.banks, public.l2.mshrs, public.l2.latency_cycles), (2 << 20, 4, 32, 8, 3));
    assert_eq!(public.dram.device, "dram/ddr3-scaled.toml");

    let packet = shipped("packet");
    assert_eq!((packet.cores.total(), packet.l1.bytes, packet.l2.bytes), (1, 32 << 10, 256 << 10));
    assert_eq!((packet.energy.caches.as_str(), packet.energy.blocks), ("relative", None));

    let gpu = shipped("turing2018");
    assert_eq!((gpu.cores.groups, gpu.cores.per_group, gpu.cores.clock_mhz, gpu.units.contexts), (46, 64, 1515, 64));
    assert_eq!((gpu.l1.bytes, gpu.l1.ways, gpu.l1.banks * gpu.l1.mshrs, gpu.l1.latency_cycles), (64 << 10, 32, 256, 20));
    assert_eq!((gpu.l2.bytes, gpu.l2.ways, gpu.l2.banks * gpu.l2.mshrs, gpu.l2.latency_cycles), (8 * (512 << 10), 16, 8 * 192, 160));
    assert_eq!((gpu.dram.device.as_str(), gpu.dram.channels), ("dram/gddr6.toml", 16));
}

#[test]
fn all_machines_of_the_folder_are_shipped_and_load_alike() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("machines");
    let mut names = Vec::new();
    for entry in fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            let (from_file, from_program) = (Machine::load(&path).unwrap(), shipped(&name));
            assert_eq!((&from_file.cores, &from_file.l1, &from_file.l2), (&from_program.cores, &from_program.l1, &from_program.l2));
            for path in energy::files(&from_file).unwrap() {
                assert_eq!(from_file.read(&path).unwrap().0, from_program.read(&path).unwrap().0);
            }
            names.push(name);
        }
    }
    names.sort();
    let mut known = Machine::all_shipped();
    known.sort();
    assert_eq!(names, known);
    assert_eq!(names.len(), 6);
}

/// A number without a source beside it is a bug of the file.
#[test]
fn every_number_bears_its_source() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("machines");
    let mut numbers = 0;
    for file in Machine::all_shipped()
        .iter()
        .map(|name| format!("{name}.toml"))
        .chain(["cacti22", "cacti22-older", "cacti22-large", "relative", "blocks22"].map(|name| format!("energy/{name}.toml")))
    {
        let text = fs::read_to_string(folder.join(&file)).unwrap();
        let legend: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("# [")?.split_once(']')).map(|(mark, _)| mark).collect();
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let Some((_, value)) = line.split_once(" = ") else { continue };
            if value.starts_with(|c: char| c.is_ascii_digit() || "[{".contains(c)) {
                let comment = value.split_once("# ").unwrap_or_else(|| panic!("{file}: no source: {line}")).1;
                let mark = comment.strip_prefix('[').and_then(|rest| rest.split_once(']')).map(|(mark, _)| mark);
                assert!(comment.starts_with("own") || mark.is_some_and(|mark| legend.contains(&mark)), "{file}: no source: {line}");
                numbers += 1;
            }
        }
    }
    assert!(numbers > 170, "{numbers}");
}

#[test]
fn an_impossible_value_names_file_key_and_reason() {
    let cases = [
        ("groups = 64", "groups = 0", "cores.groups must be 1 to 4096, but is 0"),
        ("per_group = 16", "per_group = 0", "cores.per_group must be"),
        ("rays_in_flight = 1", "rays_in_flight = 0", "cores.rays_in_flight must be"),
        ("clock_mhz = 2000", "clock_mhz = 0", "cores.clock_mhz must be 1 to 100000, but is 0"),
        ("clock_mhz = 2000", "clock_mhz = 100001", "cores.clock_mhz must be 1 to 100000, but is 100001"),
        ("ways = 2 ", "ways = 3 ", "l1.bytes must be line_bytes x ways x banks = 384 times a power of two, but is 16384"),
        ("ways = 2 ", "ways = 0 ", "l1.ways must be"),
        ("banks = 4 ", "banks = 3 ", "l1.banks must be a power of two, but is 3"),
        ("banks = 4 ", "banks = 0 ", "l1.banks must be"),
        ("line_bytes = 32", "line_bytes = 64", "l2.line_bytes must be 32, the line that traversal reads, but is 64"),
        ("bytes = 16384", "bytes = 0", "l1.bytes must be 1 to"),
        ("bytes = 16384", "bytes = 128", "l1.bytes must be line_bytes x ways x banks = 256 times"),
        ("bytes = 16384", "bytes = 49152", "l1.bytes must be line_bytes x ways x banks = 256 times"),
        ("bytes = 16384", "bytes = 4194304", "l1.bytes must be at most l2.bytes = 2097152, but is 4194304"),
        ("bytes = 2097152", "bytes = 2147483648", "l2.bytes must be 1 to 1073741824"),
        ("latency_cycles = 4", "latency_cycles = 0", "l2.latency_cycles must be"),
        ("mshrs = 64", "mshrs = 0", "l2.mshrs must be"),
        ("targets = 64", "targets = 0", "l2.targets must be"),
        ("queue = 64         # [A3]", "queue = 0 # [A3]", "l2.queue must be"),
        ("request_cycles = 1", "request_cycles = 0", "crossbar.request_cycles must be"),
        ("answer_cycles = 1", "answer_cycles = 0", "crossbar.answer_cycles must be"),
        ("per_bank = 1", "per_bank = 0", "crossbar.per_bank must be"),
        ("per_group = 1      # [A3]", "per_group = 0 # [A3]", "crossbar.per_group must be"),
        ("per_group = 1           # own", "per_group = 0 # own", "units.per_group must be"),
        ("contexts = 16", "contexts = 65", "units.contexts must be 1 to 64, but is 65"),
        ("\nedges_per_cycle = 1", "\nedges_per_cycle = 2", "units.edges_per_cycle must be 3 or 1, but is 2"),
        ("lod_edges_per_cycle = 1", "lod_edges_per_cycle = 0", "units.lod_edges_per_cycle must be 3 or 1, but is 0"),
        ("divide_bits = 3", "divide_bits = 4", "units.divide_bits must be 1 to 3, but is 4"),
        ("setup_bits = 3", "setup_bits = 0", "units.setup_bits must be 1 to 3, but is 0"),
        ("setup_copies = 3", "setup_copies = 5", "units.setup_copies must be 1 to 4, but is 5"),
        ("divide_copies = 2", "divide_copies = 0", "units.divide_copies must be 1 to 4, but is 0"),
        ("\"dram/gddr5.toml\"", "\"gddr5\"", "dram.device must be a file's path, with .toml, but is \"gddr5\""),
        ("channels = 8", "channels = 6", "dram.channels must be a power of two up to 65536, but is 6"),
        ("queue = 64                 # own", "queue = 0", "dram.queue must be"),
        ("mapping = \"row:rank:group:bank:channel:column\"", "mapping = \"\"", "dram.mapping must not be empty"),
        ("\"cacti22\"", "\"../cacti22\"", "energy.caches must be a name of letters"),
        ("\"blocks22\"", "\"\"", "energy.blocks must be a name of letters"),
        ("\"Haydel 2023\"", "\"\"", "name must not be empty"),
    ];
    for (from, to, expected) in cases {
        let error = broken(from, to).expect_err(to).to_string();
        assert!(error.starts_with("broken.toml: ") && error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn an_unknown_missing_or_mistyped_key_names_file_and_key() {
    let cases = [
        ("groups = 64", "groups = 64\nthreads = 2", "`threads`"),
        ("[units]", "[unit]", "`unit`"),
        ("ways = 2 ", "way = 2 ", "`way`"),
        ("mshrs = 64", "", "`mshrs`"),
        ("queue = 64                 # own", "queue = 64\nwrites = 1", "`writes`"),
        ("groups = 64", "groups = \"many\"", "groups = \"many\""),
        ("groups = 64", "groups = -1", "groups = -1"),
        ("groups = 64", "groups = 64.5", "groups = 64.5"),
        ("[cores]", "[cores", "[cores"),
    ];
    for (from, to, expected) in cases {
        let error = broken(from, to).expect_err(to).to_string();
        assert!(error.starts_with("broken.toml: ") && error.contains(expected), "{to}: {error}");
    }
}

#[test]
fn what_is_not_there_is_named() {
    let error = Machine::load(Path::new("no/such/machine.toml")).unwrap_err().to_string();
    assert!(error.starts_with("no/such/machine.toml: "), "{error}");
    let error = Machine::shipped("cray").unwrap_err().to_string();
    assert!(error.contains("cray.toml") && error.contains("haydel2023.toml") && !error.contains("cacti22"), "{error}");
    let error = shipped("packet").read("energy/cacti7.toml").unwrap_err().to_string();
    assert!(error.contains("energy/cacti7.toml") && error.contains("energy/cacti22.toml") && !error.contains("packet"), "{error}");
}

#[test]
fn files_beside_the_machine_go_before_those_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.toml");
    fs::write(&file, include_str!("../../machines/packet.toml")).unwrap();
    let machine = Machine::load(&file).unwrap();
    assert!(machine.read("energy/relative.toml").unwrap().0.contains("dram_line = 40"));
    fs::create_dir(folder.path().join("energy")).unwrap();
    fs::write(folder.path().join("energy/relative.toml"), "mine").unwrap();
    assert_eq!(machine.read("energy/relative.toml").unwrap().0, "mine");
    let error = machine.read("dram/mine.toml").unwrap_err().to_string();
    assert!(error.starts_with(&folder.path().join("dram/mine.toml").display().to_string()), "{error}");
}

#[test]
fn overrides_change_one_value() {
    let mut machine = shipped("haydel2023");
    for (key, value) in [("l1.bytes", "32768"), ("dram.mapping", "abc"), ("energy.caches", "cacti22-older"), ("name", "mine")] {
        machine.set(key, value).unwrap();
    }
    let mut expected = shipped("haydel2023");
    expected.l1.bytes = 32768;
    expected.dram.mapping = Some("abc".to_owned());
    expected.energy.caches = "cacti22-older".to_owned();
    expected.name = "mine".to_owned();
    assert_eq!(machine, expected);
    let edges = |machine: &Machine| [machine.units.config().edges_per_cycle, machine.units.config().lod_edges_per_cycle];
    machine.set("units.edges_per_cycle", "3").unwrap();
    assert_eq!(edges(&machine), [EdgesPerCycle::Three, EdgesPerCycle::One]);
    machine.set("units.lod_edges_per_cycle", "3").unwrap();
    assert_eq!(edges(&machine), [EdgesPerCycle::Three; 2]);
    assert_eq!(edges(&expected), [EdgesPerCycle::One; 2]);
    assert_eq!(machine.units.config().contexts, 16);
    machine.set("units.divide_bits", "2").unwrap();
    machine.set("units.setup_bits", "1").unwrap();
    machine.set("units.setup_copies", "4").unwrap();
    machine.set("units.divide_copies", "3").unwrap();
    machine.set("units.boxes_per_cycle", "1").unwrap();
    let Hardware { divide_bits, setup_bits, setup_copies, divide_copies, boxes_per_cycle, .. } = machine.units.config();
    assert_eq!([divide_bits, setup_bits, setup_copies, divide_copies, boxes_per_cycle.count()], [2, 1, 4, 3, 1]);
    let Hardware { setup_copies, divide_copies, .. } = expected.units.config();
    assert_eq!([setup_copies, divide_copies], [3, 2]);
    assert_eq!([Hardware::default().setup_copies, Hardware::default().divide_copies], [1, 1]);
    assert!(!machine.units.config().secondary);
    machine.set("units.secondary", "true").unwrap();
    assert!(machine.units.config().secondary);
    let error = machine.set("units.secondary", "yes").unwrap_err().to_string();
    assert!(error.contains("units.secondary") && error.contains("boolean"), "{error}");
    let error = machine.set("units.boxes_per_cycle", "3").unwrap_err().to_string();
    assert!(error.contains("units.boxes_per_cycle must be 4, 2 or 1, but is 3"), "{error}");
}

#[test]
fn a_wrong_override_is_named_and_changes_nothing() {
    let cases = [
        ("l1.byte", "1", "`byte`"),
        ("l3.bytes", "1", "the machine has no [l3]"),
        ("l1.bytes.low", "1", "the machine has no [l1.bytes]"),
        ("l1", "1", "a table, not a value"),
        ("folder", "x", "`folder`"),
        ("", "1", ""),
        ("l1.bytes", "many", "the value must be an integer"),
        ("l1.bytes", "", "the value must be an integer"),
        ("cores.groups", "-1", "-1"),
        ("cores.groups", "0", "cores.groups must be 1 to 4096, but is 0"),
        ("l1.bytes", "4194304", "must be at most l2.bytes"),
        ("l1.banks", "3", "must be a power of two"),
    ];
    let mut machine = shipped("haydel2023");
    for (key, value, expected) in cases {
        let error = machine.set(key, value).expect_err(key).to_string();
        assert!(error.contains(&format!("{key} = {value}")) && error.contains(expected), "{error}");
        assert_eq!(machine, shipped("haydel2023"));
    }
}

#[test]
fn cycles_and_picoseconds_agree() {
    let mut cores = shipped("turing2018").cores;
    assert_eq!([0, 1, 2, 1515, 1_515_000_000].map(|cycle| cores.start_ps(cycle)), [0, 660, 1320, 1_000_000, 1_000_000_000_000]);
    assert_eq!([0, 1, 660, 661, 1_000_000].map(|ps| cores.cycle_at(ps)), [0, 1, 1, 2, 1515]);
    for mhz in [1, 7, 1515, 2000, 100_000] {
        cores.clock_mhz = mhz;
        for cycle in (0..1000).chain((1 << 40)..(1 << 40) + 1000) {
            assert_eq!(cores.cycle_at(cores.start_ps(cycle)), cycle, "{mhz} MHz");
        }
    }
}
