//! `unit` as typed.

use lodray::hardware::Hardware;
use lodray::machine::Machine;
use lodray_test_support::program::{Desk, FAILS, USAGE};

fn desk() -> Desk {
    Desk::new(assert_cmd::cargo::cargo_bin!("lodray"))
}

#[test]
fn a_machine_s_unit_is_shown_as_it_is_simulated() {
    let desk = desk();
    let own = desk.json("unit --machine turing2018");
    assert_eq!(
        (own["machine"].as_str(), own["units"].as_u64(), own["unit"]["contexts"].as_u64()),
        (Some("turing2018"), Some(46), Some(64))
    );
    let blocks = own["unit"]["blocks"].as_array().unwrap();
    assert!(blocks.contains(&"setup_copies".into()) && !blocks.contains(&"ray_setup".into()), "{blocks:?}");
    let table = desk.run("unit --machine turing2018 --set units.setup_copies=1");
    assert!(table.starts_with("a unit of turing2018 units.setup_copies=1 has ") && table.contains("all 46 have"), "{table}");
    let row =
        |name: &str| table.lines().find(|line| line.starts_with(name)).unwrap().split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(
        (&row("ray_setup")[1..3], &row("hit_divide")[1..3]),
        (&["1".to_owned(), "11".into()][..], &["2".to_owned(), "7".into()][..])
    );
    // The area of results.
    desk.run("generate sphere --levels 2 -o a.lod --quiet");
    let result = desk.json("simulate a.lod --size 8x8 --machine turing2018 --compute units --quiet");
    assert_eq!(result["units"]["gate_equivalents"], own["unit"]["gates"]);
}

#[test]
fn its_rtl_is_that_of_the_changed_machine() {
    let desk = desk();
    desk.run("unit --set units.contexts=32 --set units.lod_edges_per_cycle=3 --package lod_pkg.sv --quiet");
    let mut machine = Machine::shipped("haydel2023").unwrap();
    machine.set_all(&[("units.contexts", "32"), ("units.lod_edges_per_cycle", "3")]).unwrap();
    let text = desk.text("lod_pkg.sv");
    assert_eq!(text, machine.units.config().package());
    assert!(text.contains("CONTEXTS = 32;") && text.contains("SETUP_COPIES = 3;") && text != Hardware::DEFAULT.package());
    // A machine of one's own, which stays as it is.
    let own = include_str!("../../machines/haydel2023.toml").replace("contexts = 16", "contexts = 32");
    desk.write("mine.toml", &own.replace("lod_edges_per_cycle = 1", "lod_edges_per_cycle = 3"));
    desk.run("unit --machine mine.toml --package other.sv --quiet");
    assert_eq!(desk.text("other.sv"), text);
    desk.refused("unit --machine mine.toml --package mine.toml", FAILS, &["mine.toml"]);
    desk.refused("unit --machine none", FAILS, &["there is no machine none"]);
    desk.refused("unit --set units.contexts=65", FAILS, &["--set", "units.contexts must be 1 to 64"]);
    desk.refused("unit --set units", USAGE, &["units"]);
}
