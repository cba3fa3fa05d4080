//! Lists of jobs with mistakes, results that were damaged, and charts, as a user meets them.

use lodray_test_support::program::Desk;
use std::fs;

/// A folder with a scene, to run the program in.
fn with_scene() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 2 --base 8 --seed 2 -o a.lod");
    desk
}

/// Names of the charts of a sweep, in order.
fn charts(desk: &Desk, folder: &str) -> Vec<String> {
    desk.files(folder).into_keys().filter(|name| name.ends_with(".svg")).collect()
}

/// Three lines.
const HEAD: &str = "size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\", \"bvh\"]\n";
/// Two lines each.
const SCENE: &str = "[[scene]]\nfile = \"a.lod\"\n";
const MACHINE: &str = "[[machine]]\nname = \"packet\"\n";
/// Two lines, for changes of its caches: one with energies for many.
const CACHES: &str = "[[machine]]\nname = \"haydel2023\"\n";

#[test]
fn a_mistake_is_named_with_its_place_before_anything_runs() {
    let desk = with_scene();
    desk.write("not.lod", "this is no scene");
    desk.write("empty.lod", "");
    desk.write("ball.OBJ", "v 0 0 0\n");
    desk.write("slow.toml", "name = \"slow\"\n");
    let machine = |set: &str| format!("{HEAD}{SCENE}{MACHINE}set = {{ {set} }}\n");
    let scene = |text: &str| format!("{HEAD}{SCENE}{text}\n{MACHINE}");
    let views =
        |distances, directions| format!("distances = [{}]\ndirections = [{}]", "2, ".repeat(distances), "[1, 0, 0], ".repeat(directions));
    let file = |name: &str| format!("{HEAD}[[scene]]\nfile = \"{name}\"\n{MACHINE}");
    for (list, wanted) in [
        // What is missing, and where.
        (format!("distances = [2]\nmethods = [\"lod\"]\n{SCENE}{MACHINE}"), "line 1: size is missing"),
        (format!("size = \"8x8\"\ndistances = [2]\n{SCENE}{MACHINE}"), "line 1: methods is missing"),
        (format!("size = \"8x8\"\nmethods = [\"lod\"]\n{SCENE}{MACHINE}"), "line 3: scene: distances or eyes is missing"),
        (format!("{HEAD}{SCENE}{MACHINE}[[machine]]\nset = {{ \"l1.banks\" = 2 }}\n"), "line 8: machine: name is missing"),
        (format!("{HEAD}{MACHINE}"), "[[scene]] is missing"),
        (format!("{HEAD}{SCENE}"), "[[machine]] is missing"),
        (format!("{HEAD}[[scene]]\nname = \"x\"\n{MACHINE}"), "line 4: scene: needs either file or generate"),
        (String::new(), "line 1: methods is missing"),
        // What is too much, twice, or of another kind.
        (format!("{HEAD}speed = 3\n{SCENE}{MACHINE}"), "line 4: unknown field `speed`"),
        (scene("colour = 1"), "line 6: unknown field `colour`"),
        (scene("levels = 1"), "line 6: scene: levels goes with generate"),
        (scene("bounds = \"total\""), "line 6: scene: bounds goes with generate"),
        (scene("vertices = \"exact\""), "line 6: scene: vertices goes with generate"),
        (format!("{HEAD}bounds = \"sum\"\n{SCENE}{MACHINE}"), "line 4: unknown variant `sum`, expected `largest` or `total`"),
        (
            format!("{HEAD}vertices = \"half\"\n{SCENE}{MACHINE}"),
            "line 4: unknown variant `half`, expected one of `exact`, `compact`, `short`",
        ),
        (scene("generate = \"wall\""), "line 5: scene: has both file and generate"),
        (scene("eyes = [[0, 1, 2]]\ndistances = [3]"), "line 7: scene: eyes are in place of distances"),
        (format!("{HEAD}{SCENE}{SCENE}{MACHINE}"), "line 6: scene: there is another of the name \"a\""),
        (format!("{HEAD}{SCENE}{MACHINE}{MACHINE}"), "a job is there twice: a, 2 radii"),
        (format!("size = \"8x8\"\nmethods = [\"lod\", \"lod\"]\n{SCENE}{MACHINE}"), "line 2: methods: lod is there twice"),
        (format!("size = \"8x8\"\nmethods = [\"ray\"]\n{SCENE}{MACHINE}"), "line 2: unknown variant `ray`"),
        (format!("size = \"8x8\"\nmethods = []\n{SCENE}{MACHINE}"), "line 2: methods must not be empty"),
        (format!("size = 8\nmethods = [\"lod\"]\n{SCENE}{MACHINE}"), "line 1: invalid type"),
        (format!("{HEAD}[scene]\nfile = \"a.lod\"\n{MACHINE}"), "line 4: invalid type: map, expected a sequence; [[scene]] and"),
        (format!("{HEAD}{SCENE}{MACHINE}x = = 3\n"), "line 8: "),
        // Values out of range.
        (format!("{HEAD}leaf_size = 3\n{SCENE}{MACHINE}"), "line 4: leaf_size must be 1, 2, 4, 8 or 16, but is 3"),
        (format!("{HEAD}deltas = [1, \"fine\"]\n{SCENE}{MACHINE}"), "line 4: deltas: 'fine' is not a quality"),
        (format!("{HEAD}deltas = [nan]\n{SCENE}{MACHINE}"), "line 4: deltas: 'NaN' is not a quality"),
        (scene("distances = [1, -1]"), "line 6: distances: '-1' is not a distance"),
        (scene("distances = [inf]"), "line 6: distances: 'inf' is not a distance"),
        (scene("size = \"0x5\""), "line 6: size: width and height must be 1 to 65536"),
        (scene("size = \"wide\""), "line 6: size: 'wide' is not a size"),
        (scene("eyes = []"), "line 6: eyes must not be empty"),
        (scene("fov = 180"), "line 4: scene a: fov must be between 0 and 180 degrees"),
        (scene("eyes = [[0, 1, nan]]"), "line 6: eyes: '0,1,NaN' is not three numbers"),
        (scene("eyes = [[0, 1, 2], [0, 1, 1e300]]"), "line 6: eyes: each coordinate must be from -1e100 to 1e100"),
        (scene("directions = [[-1e300, 0, 0]]"), "line 6: directions: each coordinate must be from -1e100 to 1e100"),
        (scene("target = [0, inf, 0]"), "line 6: target: each coordinate must be from -1e100 to 1e100"),
        (scene("up = [0, 0, 0]"), "line 6: up: a direction has a length: one coordinate must be 1e-100 or more, or -1e-100 or less"),
        (scene("up = [0, 0, -1e300]"), "line 6: up: each coordinate must be from -1e100 to 1e100"),
        (
            format!("{HEAD}[[scene]]\ngenerate = \"wall\"\nseed = -1\n{MACHINE}"),
            "line 6: invalid value: integer `-1`, expected a whole number from 0 to 18446744073709551615",
        ),
        (
            format!("{HEAD}[[scene]]\ngenerate = \"wall\"\nbase = -1\n{MACHINE}"),
            "line 6: invalid value: integer `-1`, expected a whole number from 0 to 4294967295",
        ),
        (scene("target = [1, 2, 3]\neyes = [[1, 2, 3]]"), "line 4: scene a: eye must be different from target"),
        (format!("{HEAD}[[scene]]\ngenerate = \"terrain\"\nlevels = 11\n{MACHINE}"), "line 4: scene: 11 levels are too many"),
        (format!("{HEAD}[[scene]]\ngenerate = \"sphere\"\nroughness = 2\n{MACHINE}"), "line 4: scene: roughness 2 is not between"),
        // Few words that stand for many jobs.
        (
            machine(&["l1.bytes", "l2.bytes", "dram.channels"].map(|key| format!("\"{key}\" = [{}]", "1, ".repeat(17))).join(", ")),
            "line 8: machine packet: set: more than 4096 combinations of values",
        ),
        (scene(&views(3000, 400)), "line 6: scene: more than 1048576 jobs: share them among several lists"),
        (
            format!("{HEAD}deltas = {:?}\n{SCENE}{}\n{MACHINE}", (1..=16).collect::<Vec<u32>>(), views(1000, 70)),
            "jobs.toml: more than 1048576 jobs: share them among several lists",
        ),
        (format!("{HEAD}{SCENE}{} = 1\n{MACHINE}", "x".repeat(100_000)), "line 6: unknown field `xxx"),
        // Files.
        (file("missing.lod"), "line 5: scene: missing.lod: cannot open"),
        (file("not.lod"), "line 5: scene: not.lod: magic: not a lodray scene file"),
        (file("empty.lod"), "line 5: scene: empty.lod: magic: not a lodray scene file"),
        (file("ball.OBJ"), "line 5: scene: ball.OBJ: this is a mesh, not a scene: `lodray build ball.OBJ -o ball.lod` makes one of it"),
        // Machines and what they name.
        (format!("{HEAD}{SCENE}[[machine]]\nname = \"nope\"\n"), "line 7: machine nope: there is no machine nope"),
        (format!("{HEAD}{SCENE}[[machine]]\nname = \"none.toml\"\n"), "line 7: machine none.toml: none.toml: "),
        (format!("{HEAD}{SCENE}[[machine]]\nname = \"slow.toml\"\n"), "line 7: machine slow.toml: slow.toml: "),
        (machine("\"l9.x\" = 1"), "line 8: machine packet: set l9.x = 1"),
        (machine("\"l1.bytes\" = [32768, 5]"), "line 8: machine packet: set l1.bytes = 5: l1.bytes must be"),
        (machine("\"l1.bytes\" = []"), "line 8: machine packet: set: l1.bytes has no value"),
        (machine("\"l1.bytes\" = true"), "must be a number, a text, or a list of such"),
        (machine("\"dram.device\" = \"dram/none.toml\""), "line 8: machine packet: no dram/none.toml"),
        (machine("\"dram.mapping\" = \"row\""), "line 8: machine packet: "),
        (machine("\"energy.caches\" = \"none\""), "line 8: machine packet: no energy/none.toml"),
        // The last job's machine is looked at before the first job runs.
        (
            machine("\"l1.bytes\" = [32768, 16384]"),
            "line 8: machine packet: Haydel 2023, packets: energy/relative.toml has no energies for l1 of 16384 bytes, 4-way, 1 bank, 32-byte lines; \
             nearest: 32768 bytes, 4-way, 1 bank, 32-byte lines",
        ),
        (machine("\"cores.groups\" = 4096, \"cores.per_group\" = 4096"), "rays in flight of the machine are more than"),
    ] {
        desk.write("jobs.toml", &list);
        let (code, out, err) = desk.run_on(0, "sweep jobs.toml -o out");
        assert!(code == 1 && err.starts_with("error: jobs.toml: ") && err.contains(wanted), "no '{wanted}' in: {err}");
        assert_eq!(err.matches("os error").count().max(1), 1, "said twice: {err}");
        assert!(out.is_empty() && err.lines().count() == 1 && err.len() < 2000 && !desk.path("out").exists(), "{out}{err}");
    }
    let (code, _, err) = desk.run_on(0, "sweep none.toml -o out");
    assert!(code == 1 && err.contains("cannot read none.toml"), "{err}");
}

#[test]
fn lines_that_are_no_results_are_set_aside_and_their_jobs_done_again() {
    let desk = with_scene();
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{CACHES}set = {{ \"l1.bytes\" = [16384, 32768] }}\n"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    let lines = desk.text("out/results.jsonl");
    let [a, b, c, d]: [&str; 4] = lines.lines().collect::<Vec<_>>().try_into().unwrap();
    let cut = &c[..c.len() / 2];
    for (damaged, done, bad, why) in [
        (format!("{a}\nrubbish\n{b}\n{d}\n"), 3, "rubbish\n".to_owned(), "line 2 is no result: it is not JSON (column 1)"),
        (format!("{a}\n{cut}{d}\n{b}\n"), 2, format!("{cut}{d}\n"), "line 2 is no result: "),
        (format!("{a}\n{b}\n{cut}"), 2, format!("{cut}\n"), "line 3 is no result: it ends too early"),
        (format!("{a}\n\0\0\0\0\n[1]\n{{}}\n"), 1, "\0\0\0\0\n[1]\n{}\n".to_owned(), "line 2 (and 2 more) is no result: it is not JSON"),
        (
            format!("{a}\n{{\"key\": 1}}\n{b}\n"),
            2,
            "{\"key\": 1}\n".to_owned(),
            "line 2 is no result: a value is not of the kind or in the range",
        ),
    ] {
        desk.write("out/results.jsonl", &damaged);
        let _ = fs::remove_file(desk.path("out/results.bad.jsonl"));
        let (code, out, err) = desk.run_on(0, "sweep jobs.toml -o out");
        assert_eq!((code, err.lines().count()), (0, 1), "{out}{err}");
        assert!(err.starts_with("warning: out/results.jsonl: line ") && err.contains(why) && !err.contains("expected"), "{err}");
        assert!(err.contains("set aside in out/results.bad.jsonl"), "{err}");
        assert!(out.contains(&format!("4 jobs, {done} of them done before, 0 failed")), "{out}");
        assert_eq!(desk.text("out/results.bad.jsonl"), bad);
        let sorted = |text: &str| {
            let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
            lines.sort();
            lines
        };
        assert_eq!(sorted(&desk.text("out/results.jsonl")), sorted(&lines));
        assert!(desk.text("out/run.json").contains("\"results.bad.jsonl\""), "not in the record");
        // Told once.
        assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").2, "");
        assert!(desk.text("out/run.json").contains("\"results.bad.jsonl\""), "no longer in the record");
    }
    // What is set aside later stands behind what was before.
    desk.write("out/results.jsonl", &format!("{a}\nmore\n"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    assert!(desk.text("out/results.bad.jsonl").ends_with("}\nmore\n"));
    // Another run that takes the folder removes it.
    let (code, _, err) = desk.run_on(0, "render a.lod --size 8x8 -o out --force");
    assert!(code == 0 && !desk.path("out/results.bad.jsonl").exists(), "{err}");
}

#[test]
fn jobs_that_are_no_longer_listed_stay_in_the_lines_only() {
    let desk = with_scene();
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{MACHINE}"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    desk.write("jobs.toml", &format!("size = \"16x16\"\ndistances = [2]\nmethods = [\"bvh\"]\n{SCENE}{MACHINE}"));
    let (code, out, err) = desk.run_on(0, "sweep jobs.toml -o out");
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    let said =
        "1 job, 1 of them done before, 0 failed; results in out\nresults.jsonl has results of 1 job more, which are not in the list\n";
    assert_eq!(out, said);
    assert_eq!((desk.text("out/results.jsonl").lines().count(), desk.text("out/results.csv").lines().count()), (2, 2));
}

/// Figures of two versions never stand in one table.
#[test]
fn results_of_another_version_are_set_aside_and_their_jobs_done_again() {
    let desk = with_scene();
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{MACHINE}"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    let (lines, table) = (desk.text("out/results.jsonl"), desk.text("out/results.csv"));
    let [a, b]: [&str; 2] = lines.lines().collect::<Vec<_>>().try_into().unwrap();
    let version = format!(" {}\",\"scene\"", lodray::report::results_version());
    assert!(a.contains(&version) && b.contains(&version), "{version}: {a}");
    for (old, said) in [(" 0.0.1-00000000\",\"scene\"", "1 result is"), ("\",\"scene\"", "1 result is")] {
        let other = a.replace(&version, old).replacen("\"cycles\":", "\"cycles\":9", 1);
        desk.write("out/results.jsonl", &format!("{other}\n{b}\n"));
        let _ = fs::remove_file(desk.path("out/results.old.jsonl"));
        let (code, out, err) = desk.run_on(0, "sweep jobs.toml -o out");
        assert_eq!((code, err.lines().count()), (0, 1), "{out}{err}");
        let note = format!("note: out/results.jsonl: {said} another version's of the program; set aside in out/results.old.jsonl, ");
        assert!(err.starts_with(&note), "{err}");
        assert!(out.contains("2 jobs, 1 of them done before, 0 failed"), "{out}");
        assert_eq!(desk.text("out/results.old.jsonl"), format!("{other}\n"));
        assert_eq!((desk.text("out/results.jsonl"), desk.text("out/results.csv")), (format!("{b}\n{a}\n"), table.clone()));
        assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").2, "");
    }
    let both = lines.replace(&version, " 0.0.1-00000000\",\"scene\"");
    desk.write("out/results.jsonl", &both);
    let (code, out, err) = desk.run_on(0, "sweep jobs.toml -o out");
    assert!(code == 0 && err.starts_with("note: out/results.jsonl: 2 results are another version's"), "{err}");
    assert!(out.contains("2 jobs, 0 of them done before, 0 failed"), "{out}");
}

#[test]
fn bars_are_told_apart_and_every_chart_has_several() {
    let desk = with_scene();
    // One bar: no chart.
    desk.write("one.toml", &format!("size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\"]\n{SCENE}{MACHINE}"));
    assert_eq!(desk.run_on(0, "sweep one.toml -o one").0, 0);
    assert_eq!(charts(&desk, "one"), Vec::<String>::new());
    // Qualities.
    desk.write("deltas.toml", &format!("{HEAD}deltas = [1, 4, \"inf\"]\n{SCENE}{MACHINE}"));
    assert_eq!(desk.run_on(0, "sweep deltas.toml -o deltas").0, 0);
    assert_eq!(charts(&desk, "deltas"), ["energy-a-packet-compute-free.svg", "time-a-packet-compute-free.svg"]);
    let chart = desk.text("deltas/time-a-packet-compute-free.svg");
    for label in ["lod δ1", "lod δ4", "lod δ∞", "bvh", "2 radii", "time, µs"] {
        assert_eq!(chart.matches(&format!("\n{label}\n")).count(), 1, "{label}: {chart}");
    }
    // Machines: only what was changed.
    let set = "set = { \"l1.bytes\" = [16384, 32768] }\n";
    desk.write("set.toml", &format!("size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\"]\n{SCENE}{CACHES}{set}{CACHES}"));
    assert_eq!(desk.run_on(0, "sweep set.toml -o set").0, 0);
    assert_eq!(charts(&desk, "set"), ["energy-a-haydel2023.svg", "time-a-haydel2023.svg"]);
    let chart = desk.text("set/time-a-haydel2023.svg");
    for label in ["l1.bytes=16384", "l1.bytes=32768", "unchanged"] {
        assert_eq!(chart.matches(&format!("\n{label}\n")).count(), 1, "{label}: {chart}");
    }
    // Views of the same distance.
    let views = "directions = [[1, 0, 0], [0, 0, 1]]\n";
    desk.write("views.toml", &format!("{HEAD}{SCENE}{views}{MACHINE}"));
    assert_eq!(desk.run_on(0, "sweep views.toml -o views").0, 0);
    let chart = desk.text("views/time-a-packet-compute-free.svg");
    let eyes: Vec<_> = chart.lines().filter(|line| line.starts_with("eye ")).collect();
    assert!(eyes.len() == 2 && eyes[0] != eyes[1], "{eyes:?}");
}

#[test]
fn distances_are_lines_with_the_gain_at_each_point() {
    let desk = with_scene();
    desk.write("jobs.toml", &format!("size = \"16x16\"\ndistances = [0.5, 2, 4]\nmethods = [\"lod\", \"bvh\"]\n{SCENE}{CACHES}"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    assert_eq!(charts(&desk, "out"), ["energy-a-haydel2023-compute-free.svg", "time-a-haydel2023-compute-free.svg"]);
    let lines = desk.text("out/results.jsonl");
    let cycles: Vec<f64> =
        lines.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["result"]["cycles"].as_f64().unwrap()).collect();
    let chart = desk.text("out/time-a-haydel2023-compute-free.svg");
    for pair in cycles.chunks(2) {
        let gain = lodray::report::diagram::gain(pair[1] / pair[0]);
        assert!(chart.lines().any(|line| line == gain), "{gain}: {chart}");
    }
    for words in ["lod", "bvh", "0.5", "4", "distance of the eye, bounding radii"] {
        assert!(chart.lines().any(|line| line == words), "{words}");
    }
}

/// No two ticks of an axis read the same, and none has lost all its digits.
#[test]
fn ticks_differ() {
    let desk = with_scene();
    desk.write("jobs.toml", &format!("{HEAD}deltas = [0, 1]\n{SCENE}{MACHINE}[[machine]]\nname = \"turing2018\"\n"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    let charts = charts(&desk, "out");
    assert_eq!(charts.len(), 4);
    for chart in charts {
        let text = desk.text(&format!("out/{chart}"));
        let ticks: Vec<f64> = text.lines().filter_map(|line| line.parse().ok()).collect();
        assert!(ticks.len() > 3 && ticks.windows(2).all(|pair| pair[0] < pair[1]), "{chart}: {ticks:?}");
        assert!(ticks.iter().all(|tick| *tick < 1100.0), "{chart}: {ticks:?}");
    }
}

#[test]
fn jobs_of_different_bounds_are_different_jobs() {
    let desk = with_scene();
    let generated =
        |name: &str, bounds: &str| format!("[[scene]]\nname = \"{name}\"\ngenerate = \"terrain\"\nlevels = 3\nbase = 8\n{bounds}\n");
    let head = "size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\"]\n";
    let run = |head: String| {
        let scenes = generated("a", "") + &generated("b", "bounds = \"total\"");
        desk.write("jobs.toml", &format!("{head}{scenes}{MACHINE}"));
        desk.run("sweep jobs.toml -o out")
    };
    assert!(run(format!("{head}bounds = \"largest\"\n")).contains("2 jobs, 0 of them done before"));
    // A scene's own word counts before the list's.
    assert!(run(format!("{head}bounds = \"total\"\n")).contains("2 jobs, 1 of them done before"));
    let text = fs::read_to_string(desk.path("out/results.jsonl")).unwrap();
    let rows: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let said: Vec<_> = rows.iter().map(|row| (row["scene"].as_str(), row["result"]["setup"]["scene"]["bounds"].as_str())).collect();
    assert_eq!(said, [(Some("a"), None), (Some("b"), Some("total")), (Some("a"), Some("total"))]);
    let cycles: Vec<_> = rows.iter().map(|row| row["result"]["cycles"].as_u64()).collect();
    assert!(cycles[1] == cycles[2] && cycles[0] != cycles[1], "{cycles:?}");
}

#[test]
fn any_number_of_frames_at_once_gives_the_same_bytes() {
    let desk = with_scene();
    let list = |distances: &str| {
        format!(
            "size = \"24x24\"\ndistances = {distances}\nmethods = [\"lod\", \"bvh\", \"discrete\"]\nerror = true\nintervals = true\n{SCENE}{MACHINE}{CACHES}"
        )
    };
    desk.write("jobs.toml", &list("[1.2, 2, 4, 9]"));
    let sweep = |options: &str, folder: &str| {
        desk.run(&format!("sweep jobs.toml -o {folder} {options}"));
        desk.files(folder)
    };
    let one = sweep("--at-once 1 --threads 1", "one");
    assert_eq!(one["results.jsonl"].split(|&byte| byte == b'\n').filter(|line| !line.is_empty()).count(), 24);
    assert_eq!(sweep("--at-once 2", "two"), one);
    assert_eq!(sweep("--at-once 1024 --threads 5", "all"), one);
    assert_eq!(sweep("", "some"), one);
    // One that was ended and goes on, in the order of the list as far as it went.
    desk.write("jobs.toml", &list("[1.2, 2]"));
    sweep("--at-once 3", "rest");
    desk.write("jobs.toml", &list("[1.2, 2, 4, 9]"));
    assert_eq!(sweep("--at-once 3", "rest")["results.jsonl"], one["results.jsonl"]);
    let (code, text) = desk.hear("sweep jobs.toml -o no --at-once 0");
    assert!(code != 0 && text.contains("'0' is not a whole number from 1 to 1024"), "{text}");
}

#[test]
fn a_last_line_that_was_cut_is_left_out_of_pages_and_comparisons() {
    let desk = with_scene();
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{CACHES}set = {{ \"l1.bytes\" = [16384, 32768] }}\n"));
    assert_eq!(desk.run_on(0, "sweep jobs.toml -o out").0, 0);
    let lines = desk.text("out/results.jsonl");
    let [a, b, ..]: [&str; 4] = lines.lines().collect::<Vec<_>>().try_into().unwrap();
    let cut = &b[..b.len() / 2];
    desk.write("cut.jsonl", &format!("{a}\n{b}\n{cut}"));
    for command in ["report cut.jsonl -o page.html", "compare cut.jsonl:1 cut.jsonl:2"] {
        let (code, out, err) = desk.run_on(0, command);
        assert!(code == 0 && !out.is_empty(), "{command}: {err}");
        assert!(err.lines().all(|line| line.starts_with("warning: cut.jsonl: line 3, column ") && line.ends_with("is left out")), "{err}");
        assert!(!err.is_empty(), "{command}");
    }
    // Whole but wrong, in the middle, or alone, it is an error.
    for damaged in [format!("{a}\n{cut}\n"), format!("{a}\n{cut}\n{b}"), cut.to_owned()] {
        desk.write("cut.jsonl", &damaged);
        desk.refused("report cut.jsonl -o page.html", 1, &["cut.jsonl: not results of a simulation: line "]);
    }
}
