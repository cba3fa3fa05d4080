//! `simulate`, `sweep` and `compare` end to end, as a user types them.

use lodray::machine::Machine;
use lodray_test_support::program::{Desk, FAILS, USAGE};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

const SHOT: &str = "simulate a.lod --size 40x24 --distance 2.5";

/// A folder with a scene, to run the program in.
fn with_scene() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 3 --base 32 --seed 2 -o a.lod");
    desk
}

/// The number at a path such as `/l1/hits`.
fn at(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no number {pointer}"))
}

fn count(value: &Value, pointer: &str) -> u64 {
    value.pointer(pointer).and_then(Value::as_u64).unwrap_or_else(|| panic!("no count {pointer}"))
}

fn sum<'a>(values: impl IntoIterator<Item = &'a Value>, key: &str) -> u64 {
    values.into_iter().map(|value| value[key].as_u64().unwrap()).sum()
}

fn near(a: f64, b: f64, what: &str) {
    assert!((a - b).abs() <= 1e-9 * a.abs().max(b.abs()), "{what}: {a} is not {b}");
}

/// What must hold in every result.
fn conserved(r: &Value) {
    for level in ["l1", "l2"] {
        let of = |key: &str| count(r, &format!("/{level}/{key}"));
        assert_eq!(of("requests"), of("hits") + of("misses") + of("merges"), "{level}");
        assert_eq!(of("fills"), of("misses"), "{level}");
        near(at(r, &format!("/{level}/hit_rate")), of("hits") as f64 / of("requests") as f64, level);
    }
    assert_eq!(count(r, "/l1/misses"), count(r, "/l2/requests"));
    assert_eq!(count(r, "/l2/misses"), count(r, "/dram/reads"));
    assert_eq!(count(r, "/dram/bytes"), 32 * count(r, "/dram/reads"));
    assert_eq!(
        count(r, "/dram/reads"),
        ["row_hits", "row_misses", "row_conflicts"].iter().map(|k| count(r, &format!("/dram/{k}"))).sum::<u64>()
    );
    assert_eq!(count(r, "/dram/reads"), sum(r["dram"]["channels"].as_array().unwrap(), "reads"));
    let kinds = r["traffic"]["kinds"].as_array().unwrap();
    for (kind, whole) in [("l1", "/l1/requests"), ("l2", "/l2/requests"), ("dram", "/dram/reads")] {
        assert_eq!(sum(kinds, kind), count(r, whole), "{whole}");
    }
    let waits: f64 = ["memory", "compute", "idle"].iter().map(|k| at(r, &format!("/waits/{k}"))).sum();
    near(waits, 1.0, "shares of context cycles");
    let parts: f64 = ["l1", "l2", "dram", "compute", "leakage"].iter().map(|k| at(r, &format!("/energy/{k}/total"))).sum();
    near(parts, at(r, "/energy/total"), "energy");
    let dram: f64 = r["energy"]["dram"]["parts"].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).sum();
    near(dram, at(r, "/energy/dram/total"), "DRAM energy");
    let limits = r["roofline"]["limits"].as_object().unwrap();
    // Of the memory, and where there are units of each block that has something to do: what it does begins at most as often as it may.
    let done = |block: &Value| block["operations"].as_u64().is_some_and(|count| count > 0);
    let blocks = r["units"]["blocks"].as_object();
    assert_eq!(limits.len(), 12 + blocks.map_or(0, |blocks| blocks.values().filter(|block| done(block)).count()));
    for (name, block) in blocks.into_iter().flatten().filter(|(_, block)| done(block)) {
        let each = at(&limits[name], "/cycles") * at(r, "/units/units") / at(block, "/operations");
        assert!(each >= 1.0 && (each - each.round()).abs() < 1e-9, "{name}: {each} cycles an operation");
    }
    for (part, bound) in limits {
        let share = at(bound, "/share");
        assert!((share > 0.0 || part.ends_with("queues")) && share <= 1.0, "{part} alone needs {share} of the frame");
        assert!(share <= at(&limits[r["roofline"]["largest"].as_str().unwrap()], "/share"));
    }
    // Every cycle of every context has one cause.
    let stalls: u64 = r["stalls"]["cycles"].as_object().unwrap().values().map(|v| v.as_u64().unwrap()).sum();
    assert_eq!(stalls, count(r, "/stalls/context_cycles"));
    assert_eq!(stalls, count(r, "/waits/context_cycles"));
    let stalled = |names: &[&str]| names.iter().filter_map(|name| r["stalls"]["cycles"][name].as_u64()).sum::<u64>() as f64;
    near(stalled(&["idle"]) / stalls as f64, at(r, "/waits/idle"), "idle");
    for (of, whole) in [("rays", "/rays"), ("l1_misses", "/l1/misses"), ("l2_misses", "/l2/misses")] {
        let steps = r["latencies"][of]["steps"].as_array().unwrap();
        assert_eq!(steps.iter().map(|step| step[1].as_u64().unwrap()).sum::<u64>(), count(r, whole), "{of}");
        assert!(count(r, &format!("/latencies/{of}/median")) <= count(r, &format!("/latencies/{of}/largest")));
    }
    assert_eq!(count(r, "/dram/activates"), count(r, "/dram/row_misses") + count(r, "/dram/row_conflicts"));

    let intervals = r["intervals"].as_array().unwrap();
    for (key, whole) in [
        ("cycles", "/cycles"),
        ("rays", "/rays"),
        ("l1_requests", "/l1/requests"),
        ("l1_misses", "/l1/misses"),
        ("l2_requests", "/l2/requests"),
        ("l2_misses", "/l2/misses"),
        ("dram_bytes", "/dram/bytes"),
        ("row_hits", "/dram/row_hits"),
    ] {
        assert_eq!(sum(intervals, key), count(r, whole), "{key}");
    }
    if let Some(watts) = r["energy"]["average_watts"].as_f64() {
        let parts = ["l1", "l2", "dram", "compute", "leakage"];
        let energy = |i: &Value| parts.iter().map(|k| i["watts"][k].as_f64().unwrap()).sum::<f64>() * at(i, "/cycles");
        let cycles = at(r, "/cycles");
        near(intervals.iter().map(energy).sum::<f64>() / cycles, watts, "power");
    }
}

#[test]
fn a_run_has_consistent_figures() {
    let desk = with_scene();
    for (method, machine) in
        [("lod", "haydel2023"), ("bvh", "turing2018"), ("bvh32", "haydel2023-public"), ("bvh6", "haydel2023"), ("lod", "packet")]
    {
        let r = desk.json(&format!("{SHOT} --method {method} --machine {machine}"));
        assert_eq!(count(&r, "/rays"), 960);
        assert!((100..960).contains(&count(&r, "/hits")));
        assert_eq!((&r["setup"]["method"]["name"], &r["setup"]["machine"]["label"]), (&method.into(), &machine.into()));
        assert_eq!((&r["setup"]["view"]["distance"], &r["setup"]["compute"]), (&2.5.into(), &"free".into()));
        assert_eq!(r["traffic"]["l0_share_of_l1"].is_f64(), method == "lod");
        assert_eq!(r["energy"]["unit"], if machine == "packet" { "L1 accesses" } else { "uJ" });
        assert_eq!(r["energy"]["average_watts"].is_null(), machine == "packet");
        near(at(&r, "/frames_per_second") * at(&r, "/milliseconds"), 1e3, "frames per second");
        conserved(&r);
    }
    let text = desk.run(SHOT);
    for word in [
        "accesses/ray",
        "hit rate",
        "row conflicts",
        "for DRAM",
        "rays wait for",
        "alone needs",
        "latency",
        "mean W",
        "split",
        "read the L0 part",
    ] {
        assert!(text.contains(word), "no {word} in:\n{text}");
    }
    // A BVH shows all detail at any quality; the level of detail reads less at lower quality.
    let requests = |delta: &str| count(&desk.json(&format!("{SHOT} --delta {delta}")), "/l1/requests");
    assert!(requests("0") < requests("1") && requests("1") < requests("inf"));
}

#[test]
fn files_are_the_same_at_any_number_of_threads() {
    let desk = with_scene();
    let runs = [1, 2, 8].map(|threads| {
        let out = format!("out{threads}");
        let (code, json, err) = desk.run_on(threads, &format!("{SHOT} --machine haydel2023,turing2018 --json -o {out}"));
        assert_eq!((code, err.as_str()), (0, ""));
        let mut names: Vec<_> = fs::read_dir(desk.path(&out)).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        let texts: Vec<_> = names.iter().map(|name| desk.text(&format!("{out}/{name}"))).collect();
        assert!(texts.iter().all(|text| !text.is_empty()));
        // On the faster machine the frame is a single interval, so nothing is to be seen over time.
        let plots: Vec<_> = names.iter().filter(|name| name.ends_with(".svg")).collect();
        assert_eq!(plots, ["energy.svg", "turing2018-power.svg", "turing2018-traffic.svg"]);
        assert!(desk.text(&format!("{out}/run.json")).contains("no haydel2023-power.svg: the frame is too short"));
        let intervals = desk.text(&format!("{out}/turing2018-intervals.csv"));
        assert!(intervals.lines().next().unwrap().ends_with(",dram_queue,limit,limit_share"), "{intervals}");
        assert!(intervals.lines().all(|line| line.split(',').count() == 22), "{intervals}");
        assert_eq!(json, desk.text(&format!("{out}/result.json")));
        (json, names, texts)
    });
    assert!(runs[0] == runs[1] && runs[0] == runs[2], "runs differ");
}

#[test]
fn several_machines_at_once_are_one_at_a_time() {
    let desk = with_scene();
    let own = include_str!("../../machines/haydel2023.toml").replace("name = \"Haydel 2023\"", "name = \"Mine\"");
    desk.write("mine.toml", &own);
    let together = desk.json(&format!("{SHOT} --machine haydel2023 --machine mine.toml,packet --set l1.bytes=32768"));
    for (k, machine) in ["haydel2023", "mine.toml", "packet"].into_iter().enumerate() {
        let alone = desk.json(&format!("{SHOT} --machine {machine} --set l1.bytes=32768"));
        assert_eq!(together[k], alone, "{machine}");
        assert_eq!(alone["setup"]["machine"]["description"]["l1"]["bytes"], 32768);
        assert_eq!(alone["setup"]["machine"]["set"][0], "l1.bytes=32768");
    }
    assert_eq!((&together[0]["cycles"], &together[0]["energy"]), (&together[1]["cycles"], &together[1]["energy"]));
    assert_eq!(together[1]["setup"]["machine"]["description"]["name"], "Mine");
    // Only together are these possible, with energies of their own.
    let geometry = "geometry = { bytes = 24576, ways = 3, banks = 4, line_bytes = 32 }\nread = 1\nfill = 1\nleakage_mw_per_bank = 1\n";
    fs::create_dir(desk.path("energy")).unwrap();
    desk.write("energy/three.toml", &format!("name = \"three\"\nunit = \"pJ\"\nrows = \"cacti22.csv\"\n[[l1]]\n{geometry}"));
    let three = format!("{SHOT} --machine mine.toml --set l1.ways=3 --set l1.bytes=24576");
    let r = desk.json(&format!("{three} --set energy.caches=three"));
    assert_eq!(r["setup"]["machine"]["description"]["l1"]["ways"], 3);
    let none =
        "--machine mine.toml: Mine: energy/cacti22.toml has no energies for l1 of 24576 bytes, 3-way, 4 banks, 32-byte lines; nearest: ";
    desk.refused(&format!("{three} -o three"), FAILS, &[none]);
    assert!(!desk.path("three").exists());
}

#[test]
fn wrong_words_are_one_clear_error() {
    let desk = with_scene();
    desk.write("bad.toml", "name = \"x\"\n");
    for (args, code, fragment) in [
        ("--machine nope", FAILS, "--machine nope: there is no machine nope; there are: haydel2023, haydel2023-ddr3,"),
        ("--machine none/nope.toml", FAILS, "none/nope.toml: No such file"),
        ("--machine bad.toml", FAILS, "bad.toml: TOML parse error at line 1, column 1: missing field `cores`"),
        ("--machine packet,packet", FAILS, "packet is given twice"),
        ("--set l1.bites=3", FAILS, "--set l1.bites = 3: unknown field `bites`, expected one of `bytes`"),
        ("--set l1=3", FAILS, "a table, not a value; its values are"),
        ("--set l1.bytes=-3", FAILS, "the value must be an integer, 0 or more"),
        ("--set speed.x=3", FAILS, "the machine has no [speed]; it has cores, crossbar, dram"),
        ("--set l1.bytes=many", FAILS, "the value must be an integer"),
        ("--set l1.bytes=3", FAILS, "l1.bytes = 3: l1.bytes must be"),
        ("--set l1.bytes", USAGE, "'l1.bytes' is not a change such as"),
        ("--set dram.device=dram/none.toml", FAILS, "none.toml"),
        ("--method reference", USAGE, "'reference' for '--method"),
        ("--compute soon", USAGE, "'soon' for '--compute"),
        ("--vcd a.vcd", USAGE, "--window"),
        ("--vcd a.vcd --window 9:3", USAGE, "'9:3' is not a stretch of cycles"),
        ("--vcd a.lod --window 1:2", FAILS, "a.lod"),
        ("--vcd a.vcd --window 9000000:9000001", FAILS, "--window 9000000:9000001: begins beyond the frame's end; its cycles are 0 to "),
        ("--vcd a.vcd --window 9000000:9000001 -o new/out", FAILS, "begins beyond the frame's end"),
        ("--threads 0", USAGE, "'0' is not a whole number from 1 to 1024"),
        ("--delta -1", USAGE, "'-1' for '--delta"),
        ("--rlod-every 7", USAGE, "--rlod-every: lod has no such knob; rlod has one"),
        ("--method bvh --delta 1", USAGE, "--delta: bvh has no such knob; "),
        ("-o a.lod", FAILS, "cannot make folder a.lod"),
    ] {
        desk.refused(&format!("{SHOT} {args}"), code, &[fragment]);
    }
    assert!(!desk.path("a.vcd").exists() && !desk.path("new").exists(), "written in spite of the refusal");
    desk.run(&format!("{SHOT} -o out"));
    for file in ["out/result.json", "./out/run.json"] {
        desk.refused(&format!("{SHOT} -o out --report {file}"), FAILS, &[&format!("cannot write {file}: it is a file of the run")]);
    }
    desk.refused("simulate none.lod", FAILS, &["none.lod: cannot open"]);
    desk.refused("compare a.json b.json", FAILS, &["cannot read a.json"]);
    desk.refused("compare a.lod a.lod", FAILS, &["a.lod"]);
}

#[test]
fn units_take_their_time_and_nothing_else_changes() {
    let desk = with_scene();
    for method in ["lod", "bvh", "bvh6", "bvh32", "discrete"] {
        let [free, units] = ["free", "units"].map(|compute| desk.json(&format!("{SHOT} --method {method} --compute {compute}")));
        for same in ["/rays", "/hits", "/l1/requests", "/operations"] {
            assert_eq!(free.pointer(same), units.pointer(same), "{method} {same}");
        }
        assert!(count(&units, "/cycles") > count(&free, "/cycles"), "{method}");
        conserved(&free);
        conserved(&units);
        // Fewer boxes a cycle: the same rays, and nodes as many cycles apart as they have passes.
        let one_box = desk.json(&format!("{SHOT} --method {method} --compute units --set units.boxes_per_cycle=1"));
        conserved(&one_box);
        assert_ne!(count(&one_box, "/cycles"), count(&units, "/cycles"), "{method}");
        assert_eq!((&one_box["hits"], &one_box["operations"]), (&units["hits"], &units["operations"]), "{method}");
        let of = |pointer| at(&one_box, pointer);
        let each = of("/roofline/limits/child_test/cycles") * of("/units/units") / of("/units/blocks/child_test/operations");
        near(each, if method == "bvh6" { 6.0 } else { 4.0 }, method);
        assert!(free["units"].is_null());
        near(units["units"]["states"].as_object().unwrap().values().map(|v| v.as_f64().unwrap()).sum(), 1.0, "states");
        let blocks = if method == "lod" { ["lod_test", "tessellate"] } else { ["child_test", "tri_test"] };
        for block in blocks {
            assert!(units["units"]["blocks"][block]["operations"].as_u64().unwrap() > 0, "{method} {block}");
        }
    }
}

/// The script adds up every part of the energy again, from counts, prices and the machines' own tables; and sees a figure that is off.
#[test]
fn every_picojoule_can_be_added_up_again() {
    let desk = with_scene();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/energy.py");
    let run = |files: &[&str]| {
        let out = Command::new("python3").arg(&script).args(files).current_dir(desk.folder()).output().unwrap();
        (out.status.code().unwrap(), String::from_utf8(out.stdout).unwrap(), String::from_utf8(out.stderr).unwrap())
    };
    let machines = Machine::all_shipped().join(",");
    desk.write("lod.json", &desk.run(&format!("{SHOT} --machine {machines} --json")));
    desk.write("bvh.json", &desk.run(&format!("{SHOT} --method bvh32 --compute units --machine haydel2023 --json")));
    desk.write("units.json", &desk.run(&format!("{SHOT} --compute units --machine turing2018 --set units.per_group=2 --json")));
    for method in ["bvh6", "discrete"] {
        desk.write(&format!("{method}.json"), &desk.run(&format!("{SHOT} --method {method} --compute units --json")));
    }
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{MACHINE}"));
    desk.run("sweep jobs.toml -o out");
    let files = ["lod.json", "bvh.json", "units.json", "bvh6.json", "discrete.json", "out/results.jsonl"];
    let (code, out, err) = run(&files);
    let results = Machine::all_shipped().len() + 8;
    assert_eq!((code, out.trim(), err.as_str()), (0, format!("{results} results, every part again: 0 differ").as_str(), ""));
    let mut wrong: Value = serde_json::from_str(&desk.text("units.json")).unwrap();
    wrong["dram"]["activates"] = (count(&wrong, "/dram/activates") + 1).into();
    desk.write("wrong.json", &wrong.to_string());
    let (code, _, err) = run(&["wrong.json"]);
    assert_eq!(code, 1, "{err}");
    assert!(err.contains("wrong.json: dram.activate is ") && err.contains("wrong.json: total is "), "{err}");
    assert_eq!(run(&["jobs.toml"]).0, 1);
}

/// What makes a cause of stalls smaller, in the machine.
fn easing(cause: &str, machine: &Value) -> Vec<String> {
    let twice = |keys: &[&str]| {
        keys.iter()
            .map(|key| format!("{key}={}", 2 * machine.pointer(&format!("/{}", key.replace('.', "/"))).unwrap().as_u64().unwrap()))
            .collect()
    };
    match cause {
        "l1_queue" | "l1_turn" => twice(&["l1.banks", "l1.bytes"]),
        "l1_mshr" => twice(&["l1.mshrs", "l1.targets"]),
        "l1_look_up" => vec!["l1.latency_cycles=1".to_owned()],
        "crossbar_request" | "crossbar_answer" => twice(&["crossbar.per_group", "crossbar.per_bank"]),
        "l2_queue" | "l2_turn" => twice(&["l2.banks", "l2.bytes"]),
        "l2_mshr" => twice(&["l2.mshrs", "l2.targets"]),
        "l2_look_up" => vec!["l2.latency_cycles=1".to_owned()],
        "dram_queue" | "dram_bank" | "dram_conflict" | "dram_activate" | "dram_opening" | "dram_bus" | "dram_access" => {
            twice(&["dram.channels"])
        }
        _ => twice(&["units.per_group"]),
    }
}

/// What rays wait for most, eased in the machine, makes the frame shorter: so it was what they waited for.
#[test]
fn the_largest_cause_eased_shortens_the_frame() {
    let desk = with_scene();
    let mut causes = BTreeSet::new();
    for machine in ["haydel2023", "turing2018"] {
        for way in [
            "--method lod",
            "--method bvh",
            "--method lod --compute units",
            "--method bvh --set dram.channels=1",
            "--method lod --set l1.mshrs=1",
        ] {
            let shot = format!("simulate a.lod --size 192x128 --distance 1.5 --machine {machine} {way}");
            let before = desk.json(&shot);
            let cause = before["stalls"]["largest"].as_str().unwrap().to_owned();
            let sets: String =
                easing(&cause, &before["setup"]["machine"]["description"]).iter().map(|set| format!(" --set {set}")).collect();
            let (whole, eased) = (count(&before, "/cycles"), count(&desk.json(&(shot + &sets)), "/cycles"));
            println!(
                "{machine} {way}: {cause} {:.1} %, {whole} cycles;{sets}: {:.3}",
                100.0 * at(&before, "/stalls/largest_share"),
                eased as f64 / whole as f64
            );
            assert!(eased < whole, "{machine} {way}: {cause} eased by{sets} leaves {eased} of {whole} cycles");
            causes.insert(cause);
        }
    }
    assert!(causes.len() >= 3, "{causes:?}");
}

#[test]
fn a_waveform_of_the_machine_is_written() {
    let desk = with_scene();
    desk.run(&format!("{SHOT} --vcd a.vcd --window 100:200"));
    let text = desk.text("a.vcd");
    for name in ["l1_hits", "l1_stores", "l2_write_backs", "dram_reads", "group_0", "l1_misses_under_way", "l2_queued"] {
        assert!(text.contains(name), "{name}");
    }
    // What is beyond the end is left out, and that is said.
    let (code, _, err) = desk.run_on(0, &format!("{SHOT} --vcd a.vcd --window 100:9000000"));
    assert_eq!((code, err.lines().count()), (0, 1), "{err}");
    assert!(err.starts_with("note: --window 100:9000000 ends beyond the frame's end; the waveform has cycles 100 to "), "{err}");
    assert!(desk.text("a.vcd").len() > text.len());
    assert_eq!(desk.run(&format!("{SHOT} --vcd a.vcd --window 100:9000000 --json --quiet")), desk.run(&format!("{SHOT} --json")));
    // Cycles are counted from 0: the last is one less than there are.
    let cycles = count(&desk.json(SHOT), "/cycles");
    desk.run(&format!("{SHOT} --vcd a.vcd --window {}:{}", cycles - 1, cycles - 1));
    desk.refused(
        &format!("{SHOT} --vcd a.vcd --window {cycles}:{cycles}"),
        FAILS,
        &["begins beyond the frame's end; its cycles are 0 to "],
    );
}

#[test]
fn charts_that_would_be_empty_are_not_drawn() {
    let desk = with_scene();
    let names = |folder: &str| {
        let mut names: Vec<_> =
            fs::read_dir(desk.path(folder)).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    let said = desk.run("simulate a.lod --size 8x8 --eye 0,0,50 --target 0,0,100 -o away");
    assert_eq!(names("away"), ["intervals.csv", "result.json", "run.json"]);
    for plot in ["energy", "power", "traffic"] {
        let note = format!("no {plot}.svg: the frame reads nothing");
        assert!(said.contains(&note) && desk.text("away/run.json").contains(&note), "{said}");
    }
    // Energies without a unit of time.
    let said = desk.run(&format!("{SHOT} --machine packet -o relative"));
    assert_eq!(names("relative"), ["energy.svg", "intervals.csv", "result.json", "run.json", "traffic.svg"]);
    assert!(said.ends_with("no power.svg: the machine's energies are relative, so it has no power in watts\n"), "{said}");
    assert!(!desk.run(&format!("{SHOT} --machine packet -o relative --quiet")).contains("power.svg"));
}

const SCENE: &str = "[[scene]]\nfile = \"a.lod\"\n";
const HEAD: &str = "size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\", \"bvh\"]\n";
const MACHINE: &str = "[[machine]]\nname = \"packet\"\nset = { \"cores.rays_in_flight\" = [1, 2] }\n";

#[test]
fn a_sweep_goes_on_where_it_was() {
    let desk = with_scene();
    desk.write("jobs.toml", include_str!("../../docs/jobs-example.toml"));
    let said = desk.run("sweep jobs.toml -o out");
    assert!(said.contains("36 jobs, 0 of them done before, 0 failed"), "{said}");
    let (lines, table) = (desk.text("out/results.jsonl"), desk.text("out/results.csv"));
    assert_eq!((lines.lines().count(), table.lines().count()), (36, 37));
    // Energy and time of the scene of several views, on three machines.
    let charts: Vec<_> = fs::read_dir(desk.path("out"))
        .unwrap()
        .map(|file| file.unwrap().path())
        .filter(|file| file.extension() == Some("svg".as_ref()))
        .collect();
    assert_eq!(charts.len(), 2 * 2 * 3, "{charts:?}");
    assert!(charts.iter().all(|chart| fs::read_to_string(chart).unwrap().contains("distance of the eye")));
    for line in lines.lines() {
        let row: Value = serde_json::from_str(line).unwrap();
        assert!(row["image"]["rmse"].is_f64() && row["result"]["intervals"].is_null(), "{line}");
    }
    // In the middle of a line, after a whole one, and with nothing lost.
    let ends: Vec<usize> = lines.match_indices('\n').map(|(end, _)| end + 1).collect();
    for (cut, done) in [(ends[10] + 57, 11), (ends[4] - 1, 5), (ends[20], 21), (lines.len(), 36)] {
        fs::write(desk.path("out/results.jsonl"), &lines[..cut]).unwrap();
        let (code, said, err) = desk.run_on(0, "sweep jobs.toml -o out");
        // A line of which some is missing is told; one without its end only is whole again.
        assert_eq!((code, err.contains("is no result")), (0, cut == ends[10] + 57), "{err}");
        assert!(said.contains(&format!("36 jobs, {done} of them done before, 0 failed")), "{said}");
        assert!(desk.text("out/results.jsonl") == lines && desk.text("out/results.csv") == table, "cut at {cut}");
    }
    // Not while another sweep writes there.
    let other = lodray::format::Staging::open(&desk.path("out")).unwrap().unwrap();
    desk.refused("sweep jobs.toml -o out", FAILS, &["out: another run is writing to this folder"]);
    drop(other);
    // One simulation by hand gives the figures of its line.
    desk.write("one.toml", &format!("{HEAD}intervals = true\n{SCENE}{MACHINE}"));
    desk.run("sweep one.toml -o one");
    let row: Value = serde_json::from_str(desk.text("one/results.jsonl").lines().next().unwrap()).unwrap();
    assert_eq!(row["result"], desk.json("simulate a.lod --size 16x16 --distance 2 --machine packet --set cores.rays_in_flight=1"));
}

#[test]
fn a_failed_job_leaves_the_others() {
    let desk = with_scene();
    // Straight down on a terrain's centre, which is known when it is there: no direction is up.
    let down = "[[scene]]\ngenerate = \"terrain\"\nlevels = 2\nbase = 8\neyes = [[0, 5, 0]]\nup = [0, 1, 0]\n";
    desk.write("jobs.toml", &format!("{HEAD}compute = [\"free\", \"units\"]\n{down}{SCENE}{MACHINE}"));
    for _ in 0..2 {
        let (code, out, err) = desk.run_on(0, "sweep jobs.toml -o out");
        assert_eq!((code, err.as_str()), (FAILS, ""));
        // Of two scenes, two methods, two machines and two ways to compute, eight have a result.
        assert!(out.contains("16 jobs") && out.contains("8 failed"), "{out}");
        let rows: Vec<Value> = desk.text("out/results.jsonl").lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(rows.len(), 16);
        assert_eq!(rows.iter().filter(|row| row["result"].is_object()).count(), 8);
        let errors: String = rows.iter().filter_map(|row| row["error"].as_str()).collect();
        assert_eq!(errors.matches("up must be neither 0 nor along the view direction").count(), 8, "{errors}");
        assert!(!errors.contains("--"), "{errors}");
    }
}

#[test]
fn two_results_side_by_side() {
    let desk = with_scene();
    desk.write("lod.json", &desk.run(&format!("{SHOT} --json")));
    desk.write("both.json", &desk.run(&format!("{SHOT} --method bvh --machine turing2018,packet --json")));
    let [lod, both] = ["lod.json", "both.json"].map(|name| serde_json::from_str::<Value>(&desk.text(name)).unwrap());
    let report = desk.json("compare lod.json both.json:1");
    for (name, pointer) in [("milliseconds", "/milliseconds"), ("DRAM accesses", "/dram/reads"), ("energy", "/energy/total")] {
        let figure = report["figures"].as_array().unwrap().iter().find(|figure| figure["name"] == name).unwrap();
        near(at(figure, "/ratio"), at(&both[0], pointer) / at(&lod, pointer), name);
    }
    assert!(desk.run("compare lod.json lod.json").contains("1.000"));
    desk.refused("compare lod.json both.json", FAILS, &["both.json: has 2 results; name one"]);
    desk.refused("compare lod.json both.json:3", FAILS, &["no number 3"]);
    desk.refused("compare lod.json both.json:2", FAILS, &["cannot be compared"]);
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{MACHINE}"));
    desk.run("sweep jobs.toml -o out");
    assert!(desk.run("compare out/results.jsonl:1 out/results.jsonl:3").contains("B / A"));
}

#[test]
fn a_waveform_replaces_no_input() {
    let desk = with_scene();
    let machine = include_str!("../../machines/packet.toml");
    desk.write("m.toml", machine);
    desk.refused("simulate a.lod --size 8x8 --machine m.toml --vcd m.toml --window 0:5", FAILS, &["m.toml"]);
    desk.refused("simulate a.lod --size 8x8 --machine m.toml --vcd a.lod --window 0:5", FAILS, &["a.lod"]);
    assert_eq!(desk.text("m.toml"), machine);
}
