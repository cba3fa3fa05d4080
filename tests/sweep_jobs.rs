//! Lists of jobs with mistakes, results that were damaged, and charts, as a user meets them.

use std::fs;
use std::path::PathBuf;

/// A folder with a scene, to run the program in.
struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        assert_eq!(desk.run("generate terrain --levels 2 --base 8 --seed 2 -o a.lod").0, 0);
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Exit code, standard output and standard error.
    fn run(&self, args: &str) -> (i32, String, String) {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("lodray");
        command.current_dir(self.0.path()).args(args.split_whitespace()).env("LODRAY_CACHE", "none");
        let output = command.output().unwrap();
        let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        assert!(!err.contains("panicked"), "{args}: {err}");
        (output.status.code().unwrap(), out, err)
    }

    /// Names of the charts of a sweep.
    fn charts(&self, folder: &str) -> Vec<String> {
        let names = fs::read_dir(self.path(folder)).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut charts: Vec<_> = names.filter(|name| name.ends_with(".svg")).collect();
        charts.sort();
        charts
    }
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
    let desk = Desk::new();
    desk.write("not.lod", "this is no scene");
    desk.write("empty.lod", "");
    desk.write("ball.OBJ", "v 0 0 0\n");
    desk.write("slow.toml", "name = \"slow\"\n");
    let machine = |set: &str| format!("{HEAD}{SCENE}{MACHINE}set = {{ {set} }}\n");
    let scene = |text: &str| format!("{HEAD}{SCENE}{text}\n{MACHINE}");
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
        (format!("{HEAD}leaf_size = 3\n{SCENE}{MACHINE}"), "line 4: leaf_size must be 1, 2 or 4, but is 3"),
        (format!("{HEAD}deltas = [1, \"fine\"]\n{SCENE}{MACHINE}"), "line 4: deltas: 'fine' is not a quality"),
        (format!("{HEAD}deltas = [nan]\n{SCENE}{MACHINE}"), "line 4: deltas: 'NaN' is not a quality"),
        (scene("distances = [1, -1]"), "line 6: distances: '-1' is not a distance"),
        (scene("distances = [inf]"), "line 6: distances: 'inf' is not a distance"),
        (scene("size = \"0x5\""), "line 6: size: width and height must be 1 to 65536"),
        (scene("size = \"wide\""), "line 6: size: 'wide' is not a size"),
        (scene("eyes = []"), "line 6: eyes must not be empty"),
        (scene("fov = 180"), "line 4: scene a: fov must be between 0 and 180 degrees"),
        (scene("eyes = [[0, 1, nan]]"), "line 4: scene a: eye must be three finite numbers"),
        (scene("target = [1, 2, 3]\neyes = [[1, 2, 3]]"), "line 4: scene a: eye must be different from target"),
        (format!("{HEAD}[[scene]]\ngenerate = \"terrain\"\nlevels = 11\n{MACHINE}"), "line 4: scene: 11 levels are too many"),
        (format!("{HEAD}[[scene]]\ngenerate = \"sphere\"\nroughness = 2\n{MACHINE}"), "line 4: scene: roughness 2 is not between"),
        // Files.
        (file("missing.lod"), "line 5: scene: missing.lod: cannot open"),
        (file("not.lod"), "line 5: scene: not.lod: magic: not a lodray scene file"),
        (file("empty.lod"), "line 5: scene: empty.lod: magic: not a lodray scene file"),
        (file("ball.OBJ"), "line 5: scene: ball.OBJ: this is a mesh, not a scene: `lodray build ball.OBJ -o ball.lod` makes one of it"),
        // Machines and what they name.
        (format!("{HEAD}{SCENE}[[machine]]\nname = \"nope\"\n"), "line 7: machine nope: no nope comes with the program"),
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
        let (code, out, err) = desk.run("sweep jobs.toml -o out");
        assert!(code == 1 && err.starts_with("error: jobs.toml: ") && err.contains(wanted), "no '{wanted}' in: {err}");
        assert_eq!(err.matches("os error").count().max(1), 1, "said twice: {err}");
        assert!(out.is_empty() && err.lines().count() == 1 && !desk.path("out").exists(), "{out}{err}");
    }
    let (code, _, err) = desk.run("sweep none.toml -o out");
    assert!(code == 1 && err.contains("cannot read none.toml"), "{err}");
}

#[test]
fn lines_that_are_no_results_are_set_aside_and_their_jobs_done_again() {
    let desk = Desk::new();
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{CACHES}set = {{ \"l1.bytes\" = [16384, 32768] }}\n"));
    assert_eq!(desk.run("sweep jobs.toml -o out").0, 0);
    let lines = desk.text("out/results.jsonl");
    let [a, b, c, d]: [&str; 4] = lines.lines().collect::<Vec<_>>().try_into().unwrap();
    let cut = &c[..c.len() / 2];
    for (damaged, done, bad) in [
        (format!("{a}\nrubbish\n{b}\n{d}\n"), 3, "rubbish\n".to_owned()),
        (format!("{a}\n{cut}{d}\n{b}\n"), 2, format!("{cut}{d}\n")),
        (format!("{a}\n{b}\n{cut}"), 2, format!("{cut}\n")),
        (format!("{a}\n\0\0\0\0\n[1]\n{{}}\n"), 1, "\0\0\0\0\n[1]\n{}\n".to_owned()),
    ] {
        desk.write("out/results.jsonl", &damaged);
        let _ = fs::remove_file(desk.path("out/results.bad.jsonl"));
        let (code, out, err) = desk.run("sweep jobs.toml -o out");
        assert_eq!((code, err.lines().count()), (0, 1), "{out}{err}");
        assert!(err.starts_with("warning: out/results.jsonl: line ") && err.contains("set aside in out/results.bad.jsonl"), "{err}");
        assert!(out.contains(&format!("4 jobs, {done} of them done before, 0 failed")), "{out}");
        assert_eq!(desk.text("out/results.bad.jsonl"), bad);
        let sorted = |text: &str| {
            let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
            lines.sort();
            lines
        };
        assert_eq!(sorted(&desk.text("out/results.jsonl")), sorted(&lines));
        // Told once.
        assert_eq!(desk.run("sweep jobs.toml -o out").2, "");
    }
    // What is set aside later stands behind what was before.
    desk.write("out/results.jsonl", &format!("{a}\nmore\n"));
    assert_eq!(desk.run("sweep jobs.toml -o out").0, 0);
    assert!(desk.text("out/results.bad.jsonl").ends_with("{}\nmore\n"));
}

/// Figures of two versions never stand in one table.
#[test]
fn results_of_another_version_are_set_aside_and_their_jobs_done_again() {
    let desk = Desk::new();
    desk.write("jobs.toml", &format!("{HEAD}{SCENE}{MACHINE}"));
    assert_eq!(desk.run("sweep jobs.toml -o out").0, 0);
    let (lines, table) = (desk.text("out/results.jsonl"), desk.text("out/results.csv"));
    let [a, b]: [&str; 2] = lines.lines().collect::<Vec<_>>().try_into().unwrap();
    let version = format!(" {}\",\"scene\"", lodray::report::results_version());
    assert!(a.contains(&version) && b.contains(&version), "{version}: {a}");
    for (old, said) in [(" 0.0.1-00000000\",\"scene\"", "1 result is"), ("\",\"scene\"", "1 result is")] {
        let other = a.replace(&version, old).replace("\"cycles\":", "\"cycles\":9");
        desk.write("out/results.jsonl", &format!("{other}\n{b}\n"));
        let _ = fs::remove_file(desk.path("out/results.old.jsonl"));
        let (code, out, err) = desk.run("sweep jobs.toml -o out");
        assert_eq!((code, err.lines().count()), (0, 1), "{out}{err}");
        let note = format!("note: out/results.jsonl: {said} another version's of the program; set aside in out/results.old.jsonl, ");
        assert!(err.starts_with(&note), "{err}");
        assert!(out.contains("2 jobs, 1 of them done before, 0 failed"), "{out}");
        assert_eq!(desk.text("out/results.old.jsonl"), format!("{other}\n"));
        assert_eq!((desk.text("out/results.jsonl"), desk.text("out/results.csv")), (format!("{b}\n{a}\n"), table.clone()));
        assert_eq!(desk.run("sweep jobs.toml -o out").2, "");
    }
    let both = lines.replace(&version, " 0.0.1-00000000\",\"scene\"");
    desk.write("out/results.jsonl", &both);
    let (code, out, err) = desk.run("sweep jobs.toml -o out");
    assert!(code == 0 && err.starts_with("note: out/results.jsonl: 2 results are another version's"), "{err}");
    assert!(out.contains("2 jobs, 0 of them done before, 0 failed"), "{out}");
}

#[test]
fn bars_are_told_apart_and_every_chart_has_several() {
    let desk = Desk::new();
    // One bar: no chart.
    desk.write("one.toml", &format!("size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\"]\n{SCENE}{MACHINE}"));
    assert_eq!(desk.run("sweep one.toml -o one").0, 0);
    assert_eq!(desk.charts("one"), Vec::<String>::new());
    // Qualities.
    desk.write("deltas.toml", &format!("{HEAD}deltas = [1, 4, \"inf\"]\n{SCENE}{MACHINE}"));
    assert_eq!(desk.run("sweep deltas.toml -o deltas").0, 0);
    assert_eq!(desk.charts("deltas"), ["energy-a-packet-compute-free.svg", "time-a-packet-compute-free.svg"]);
    let chart = desk.text("deltas/time-a-packet-compute-free.svg");
    for label in ["lod δ1", "lod δ4", "lod δ∞", "bvh", "2 radii", "time, µs"] {
        assert_eq!(chart.matches(&format!("\n{label}\n")).count(), 1, "{label}: {chart}");
    }
    // Machines: only what was changed.
    let set = "set = { \"l1.bytes\" = [16384, 32768] }\n";
    desk.write("set.toml", &format!("size = \"16x16\"\ndistances = [2]\nmethods = [\"lod\"]\n{SCENE}{CACHES}{set}{CACHES}"));
    assert_eq!(desk.run("sweep set.toml -o set").0, 0);
    assert_eq!(desk.charts("set"), ["energy-a-haydel2023.svg", "time-a-haydel2023.svg"]);
    let chart = desk.text("set/time-a-haydel2023.svg");
    for label in ["l1.bytes=16384", "l1.bytes=32768", "unchanged"] {
        assert_eq!(chart.matches(&format!("\n{label}\n")).count(), 1, "{label}: {chart}");
    }
    // Views of the same distance.
    let views = "directions = [[1, 0, 0], [0, 0, 1]]\n";
    desk.write("views.toml", &format!("{HEAD}{SCENE}{views}{MACHINE}"));
    assert_eq!(desk.run("sweep views.toml -o views").0, 0);
    let chart = desk.text("views/time-a-packet-compute-free.svg");
    let eyes: Vec<_> = chart.lines().filter(|line| line.starts_with("eye ")).collect();
    assert!(eyes.len() == 2 && eyes[0] != eyes[1], "{eyes:?}");
}

/// No two ticks of an axis read the same, and none has lost all its digits.
#[test]
fn ticks_differ() {
    let desk = Desk::new();
    desk.write("jobs.toml", &format!("{HEAD}deltas = [0, 1]\n{SCENE}{MACHINE}[[machine]]\nname = \"turing2018\"\n"));
    assert_eq!(desk.run("sweep jobs.toml -o out").0, 0);
    let charts = desk.charts("out");
    assert_eq!(charts.len(), 4);
    for chart in charts {
        let text = desk.text(&format!("out/{chart}"));
        let ticks: Vec<f64> = text.lines().filter_map(|line| line.parse().ok()).collect();
        assert!(ticks.len() > 3 && ticks.windows(2).all(|pair| pair[0] < pair[1]), "{chart}: {ticks:?}");
        assert!(ticks.iter().all(|tick| *tick < 1100.0), "{chart}: {ticks:?}");
    }
}
