//! Energies by geometry: the rows of CACTI, which of them a machine takes, and what is said where there is none.

use super::model;
use crate::machine::Machine;
use crate::sim::energy::cacti::{self, CactiRow};
use crate::sim::energy::{CacheTable, EnergyCounts, EnergyModel, EnergyUnit, Geometry, Level, files};
use std::fs;
use std::path::Path;

const CSV: &str = include_str!("../../../../machines/energy/cacti22.csv");

fn rows() -> Vec<CactiRow> {
    cacti::rows(CSV, "cacti22.csv").unwrap()
}

/// The shipped machine with some values changed.
fn changed(name: &str, changes: &[(&str, &str)]) -> Machine {
    let mut machine = Machine::shipped(name).unwrap();
    machine.set_all(changes).unwrap();
    machine
}

fn refused(machine: &Machine) -> String {
    EnergyModel::new(machine).unwrap_err().to_string()
}

#[test]
fn the_rows_are_those_of_the_tool() {
    let rows = rows();
    assert_eq!(rows.len(), 164);
    let geometry = |bytes, ways, banks| Geometry { bytes, ways, banks, line_bytes: 32 };
    let row = |level, of| *rows.iter().find(|row| row.level == level && row.geometry == of).unwrap();
    let paper = row(Level::L1, geometry(16 << 10, 2, 4));
    assert_eq!((paper.read_pj, paper.write_pj, paper.leakage_mw_per_bank), (14.6395, 15.3466, 2.4667));
    assert_eq!((paper.access_ns, paper.cycle_ns), (0.283_709, 0.165_65));
    let public = row(Level::L1, geometry(32 << 10, 4, 8));
    assert_eq!((public.read_pj, public.write_pj, public.leakage_mw_per_bank), (27.3165, 27.3473, 3.18625));
    assert!(rows.iter().all(|row| row.geometry.line_bytes == 32 && row.read_pj > 0.0 && row.leakage_mw_per_bank > 0.0));
}

#[test]
fn a_row_becomes_energies_of_an_access_and_leakage_of_all_banks() {
    let rows = rows();
    let row = rows.iter().find(|row| row.level == Level::L2 && row.geometry.bytes == 2 << 20 && row.geometry.banks == 32).unwrap();
    let energy = super::super::CacheEnergy::of_cacti(row);
    assert_eq!((energy.geometry, energy.read, energy.fill), (row.geometry, row.read_pj, row.write_pj));
    assert_eq!(energy.leakage_mw_per_bank, row.leakage_mw_per_bank);
    assert_eq!(energy.leakage_mw(), 32.0 * 29.0936);
    // One access a line, whatever the banks; every group has an L1 of its own, the machine one L2.
    let report = model("haydel2023").report(&EnergyCounts { cycles: 2_000_000, l2_reads: 1, l1_fills: 1, ..Default::default() }, &[]);
    assert_eq!((report.l2_read, report.l1_fill), (94.0184, 15.3466));
    assert!(super::close(report.l1_leakage, 64.0 * 4.0 * 2.4667 * 1e6) && super::close(report.l2_leakage, 32.0 * 29.0936 * 1e6));
}

#[test]
fn every_machine_takes_the_rows_of_its_own_geometry() {
    for name in Machine::all_shipped() {
        let machine = Machine::shipped(name).unwrap();
        let model = model(name);
        for (level, energy) in [(Level::L1, model.l1), (Level::L2, model.l2)] {
            let geometry = Geometry::from(level.of(&machine));
            assert_eq!(energy.geometry, geometry, "{name} {level}");
            let row = rows().into_iter().find(|row| row.level == level && row.geometry == geometry);
            let tool = row.map(|row| (row.read_pj, row.write_pj, row.leakage_mw_per_bank));
            let own = (energy.read, energy.fill, energy.leakage_mw_per_bank);
            // The figures that are not the tool's: the authors' for the paper's figures, and for an L1 that the tool cannot make; relative ones.
            match (name, level) {
                ("haydel2023-ddr3", _) => assert!(tool.is_some_and(|tool| tool != own)),
                ("turing2018", Level::L1) => assert!(tool.is_none()),
                ("packet", _) => assert_eq!(model.unit, EnergyUnit::L1Accesses),
                _ => assert_eq!(tool, Some(own), "{name} {level}"),
            }
        }
    }
}

#[test]
fn another_geometry_is_another_row() {
    for (bytes, read) in [("8192", 13.8304), ("32768", 15.7115), ("65536", 17.7865)] {
        assert_eq!(EnergyModel::new(&changed("haydel2023", &[("l1.bytes", bytes)])).unwrap().l1.read, read);
    }
    for (key, value, read) in [("l2.bytes", "524288", 65.6864), ("l2.banks", "16", 93.3949), ("l2.ways", "8", 125.846)] {
        assert_eq!(EnergyModel::new(&changed("haydel2023", &[(key, value)])).unwrap().l2.read, read);
    }
    // What is not geometry changes nothing.
    let same = changed("haydel2023", &[("l1.mshrs", "9"), ("l1.latency_cycles", "3"), ("l2.queue", "7")]);
    assert_eq!(EnergyModel::new(&same).unwrap(), model("haydel2023"));
}

#[test]
fn a_geometry_without_a_row_is_refused_and_the_nearest_are_named() {
    let error = refused(&changed("haydel2023", &[("l1.ways", "32")]));
    let expected = "Haydel 2023: energy/cacti22.toml has no energies for l1 of 16384 bytes, 32-way, 4 banks, 32-byte lines; nearest: \
                    16384 bytes, 4-way, 4 banks, 32-byte lines; ";
    assert!(error.starts_with(expected), "{error}");
    assert_eq!(error.matches("32-byte lines").count(), 5, "{error}");
    let error = refused(&changed("haydel2023", &[("l2.banks", "128")]));
    assert!(
        error.contains("for l2 of 2097152 bytes, 4-way, 128 banks") && error.contains("nearest: 2097152 bytes, 4-way, 64 banks"),
        "{error}"
    );
    // Tables for one machine are for that one.
    for (machine, change) in [
        ("haydel2023-ddr3", ("l1.bytes", "32768")),
        ("haydel2023-ddr3", ("l2.bytes", "4194304")),
        ("haydel2023-public", ("energy.caches", "cacti22-older")),
        ("packet", ("l1.bytes", "16384")),
        ("packet", ("l2.ways", "4")),
        ("turing2018", ("l1.bytes", "32768")),
        ("turing2018", ("energy.caches", "cacti22")),
    ] {
        let error = refused(&changed(machine, &[change]));
        assert!(error.contains("has no energies for l") && error.contains("; nearest: "), "{error}");
    }
}

#[test]
fn the_nearest_geometry_takes_the_fewest_doublings() {
    let of = |bytes, ways, banks| Geometry { bytes, ways, banks, line_bytes: 32 };
    let a = of(16 << 10, 2, 4);
    assert_eq!(a.doublings_to(&a), 0.0);
    assert_eq!(a.doublings_to(&of(32 << 10, 2, 4)), 1.0);
    assert_eq!(of(32 << 10, 2, 4).doublings_to(&a), 1.0);
    assert_eq!(a.doublings_to(&of(4 << 10, 4, 1)), 2.0 + 1.0 + 2.0);
    assert_eq!(a.doublings_to(&Geometry { line_bytes: 128, ..a }), 2.0);
}

#[test]
fn a_broken_row_names_file_line_and_field() {
    let head = CSV.lines().next().unwrap();
    let line = "l1,16384,2,4,32,14.6,15.3,2.4,0.28,0.16";
    let cases = [
        (format!("{head}\n{line}\n{}", line.replace("l1", "l3")), "line 3: level must be l1 or l2, but is l3"),
        (format!("{head}\n{}", line.replace("16384", "0")), "line 2: bytes must be a whole number above 0, but is 0"),
        (format!("{head}\n{}", line.replace(",2,", ",two,")), "line 2: ways must be a whole number above 0, but is two"),
        (format!("{head}\n{}", line.replace(",4,", ",,")), "line 2: banks must be a whole number above 0, but is "),
        (format!("{head}\n{}", line.replace("14.6", "-14.6")), "line 2: read_pj must be a number and not negative, but is -14.6"),
        (format!("{head}\n{}", line.replace("2.4", "nan")), "line 2: leakage_mw_per_bank must be a number and not negative, but is nan"),
        (format!("{head}\n{}", line.replace("0.16", "inf")), "line 2: cycle_ns must be"),
        (format!("{head}\n{line},7"), "line 2: the row must have 10 values, but is 11"),
        (format!("{head}\n{line}\n\n"), "line 3: the row must have 10 values, but is 1"),
        (head.replace("_pj", "_nj"), "line 1: the head must be level,bytes,"),
        (String::new(), "line 1: the head must be level,bytes,"),
    ];
    for (text, expected) in cases {
        let error = cacti::rows(&text, "mine.csv").expect_err(expected).to_string();
        assert!(error.starts_with("mine.csv: ") && error.contains(expected), "{error}");
    }
    assert_eq!(cacti::rows(&CSV.replace('\n', "\r\n"), "mine.csv").unwrap(), rows());
}

#[test]
fn a_table_of_ones_own_lies_beside_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    fs::create_dir(folder.path().join("energy")).unwrap();
    let text = include_str!("../../../../machines/haydel2023.toml").replace("\"cacti22\"", "\"mine\"");
    write("mine.toml", &text.replace("bytes = 16384", "bytes = 24576").replace("ways = 2 ", "ways = 3 "));
    let head = "name = \"mine\"\nunit = \"pJ\"\nrows = \"cacti22.csv\"\n";
    let own = "[[l1]]\ngeometry = { bytes = 24576, ways = 3, banks = 4, line_bytes = 32 }\nread = 7\nfill = 8\nleakage_mw_per_bank = 9\n";
    write("energy/mine.toml", &format!("{head}{own}"));
    let machine = Machine::load(&folder.path().join("mine.toml")).unwrap();
    let model = EnergyModel::new(&machine).unwrap();
    assert_eq!((model.l1.read, model.l1.fill, model.l1.leakage_mw(), model.l2.read), (7.0, 8.0, 36.0, 94.0184));
    assert_eq!(files(&machine).unwrap(), ["energy/mine.toml", "energy/cacti22.csv", "energy/blocks22.toml"]);
    write("energy/mine.toml", &format!("{head}{own}{own}"));
    let error = refused(&machine);
    assert!(error.contains("mine.toml: l1 must have one row of a geometry, but is there twice for 24576 bytes, 3-way"), "{error}");
    write("energy/mine.toml", &format!("{}{own}", head.replace("rows = \"cacti22.csv\"\n", "")));
    let error = refused(&machine);
    assert!(error.contains("mine.toml: l2 must have a row, but is absent"), "{error}");
    write("energy/mine.toml", &format!("{}{own}", head.replace("cacti22.csv", "none.csv")));
    let error = refused(&machine);
    assert!(error.contains("none.csv"), "{error}");
    write("energy/mine.toml", &format!("{head}{own}"));
    write("energy/cacti22.csv", "level\n");
    let error = refused(&machine);
    assert!(error.contains("cacti22.csv: line 1: the head must be"), "{error}");
}

/// Every machine and change of the lists of jobs that come with the project.
#[test]
fn every_list_of_jobs_has_its_rows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let lists = fs::read_dir(root.join("scripts/paper")).unwrap().map(|file| file.unwrap().path());
    let lists = lists.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let mut checked = 0;
    for path in lists.chain([root.join("docs/jobs-example.toml")]) {
        let list: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
        for entry in list["machine"].as_array().unwrap() {
            let name = entry["name"].as_str().unwrap();
            // A file: scripts/figures makes it, from haydel2023.
            let mut variants = vec![Machine::shipped(if name.ends_with(".toml") { "haydel2023" } else { name }).unwrap()];
            for (key, values) in entry.get("set").and_then(toml::Value::as_table).into_iter().flatten() {
                let values = values.as_array().cloned().unwrap_or_else(|| vec![values.clone()]);
                let text = |value: &toml::Value| value.as_str().map_or_else(|| value.as_integer().unwrap().to_string(), str::to_owned);
                let with = |machine: &Machine| {
                    let one = |value: &toml::Value| {
                        let mut machine = machine.clone();
                        machine.set(key, &text(value)).unwrap();
                        machine
                    };
                    values.iter().map(one).collect::<Vec<_>>()
                };
                variants = variants.iter().flat_map(with).collect();
            }
            for machine in variants {
                EnergyModel::new(&machine).unwrap_or_else(|why| panic!("{}: {name}: {why}", path.display()));
                checked += 1;
            }
        }
    }
    assert!(checked > 50, "{checked}");
}

/// `docs/energy.md` says of each machine what CACTI's times are in cycles of its clock.
#[test]
fn the_documented_times_are_the_rows() {
    let documented = include_str!("../../../../docs/energy.md");
    for (name, level) in
        ["haydel2023", "haydel2023-ddr3", "haydel2023-public", "turing2018"].iter().flat_map(|n| Level::BOTH.map(|l| (*n, l)))
    {
        let machine = Machine::shipped(name).unwrap();
        let cache = level.of(&machine);
        let Some(row) = rows().into_iter().find(|row| row.level == level && row.geometry == Geometry::from(cache)) else { continue };
        let mhz = machine.cores.clock_mhz;
        let (access, interval) = (row.access_cycles(mhz), row.interval_cycles(mhz));
        let CactiRow { access_ns, cycle_ns, .. } = row;
        let (level, latency) = (level.to_string().to_uppercase(), cache.latency_cycles);
        let line = format!("| `{name}` | {level} | {access_ns} | {access} | {latency} | {cycle_ns} | {interval} | 1 |");
        assert!(documented.contains(&line), "{line}");
    }
}

#[test]
fn tables_are_read_whole() {
    for name in ["cacti22", "cacti22-large"] {
        let machine = changed("haydel2023", &[("energy.caches", name)]);
        let table = CacheTable::of(&machine).unwrap();
        let count: usize = Level::BOTH.iter().map(|&level| table.level(level).len()).sum();
        assert_eq!(count, 164 + usize::from(name == "cacti22-large"));
    }
}
