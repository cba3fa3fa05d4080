//! One run, one folder: what runs leave in their folders, what they replace there, and what they never touch.

use lodray::format::temporary_beside;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const RENDER: &str = "render a.lod --size 8x8";
const SIMULATE: &str = "simulate a.lod --size 8x8 --machine packet";
/// What a killed run leaves.
const STAGING: &str = ".lodray-run.tmp";

/// A folder with a scene, to run the program in.
struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        desk.run("generate terrain --levels 2 --base 8 -o a.lod");
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn command(&self, args: &str) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("lodray"));
        command.current_dir(self.0.path()).args(args.split_whitespace()).env("LODRAY_CACHE", "none");
        command
    }

    fn run(&self, args: &str) -> String {
        let output = self.command(args).output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{args}: {output:?}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs, and expects one line of error and `folder` as it was.
    fn refused(&self, args: &str, folder: &str, says: &str) {
        let before = self.files(folder);
        let output = self.command(args).output().unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{args}: {err}");
        assert!(err.starts_with("error: ") && err.contains(says) && err.lines().count() == 1, "{args}: no '{says}' in {err}");
        assert!(output.stdout.is_empty() && self.files(folder) == before, "{args}: {:?}", self.names(folder));
    }

    /// All files in `folder`; folders have no contents.
    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.path(folder)).unwrap().map(Result::unwrap);
        let bytes = |path: PathBuf| if path.is_dir() { Vec::new() } else { fs::read(path).unwrap() };
        entries.map(|entry| (entry.file_name().into_string().unwrap(), bytes(entry.path()))).collect()
    }

    fn names(&self, folder: &str) -> Vec<String> {
        self.files(folder).into_keys().collect()
    }

    fn record(&self, folder: &str) -> Value {
        serde_json::from_slice(&fs::read(self.path(folder).join("run.json")).unwrap()).unwrap()
    }
}

#[test]
fn a_record_says_what_was_run() {
    let desk = Desk::new();
    desk.run(&format!("{RENDER} -o one --compare"));
    let record = desk.record("one");
    let bytes = fs::read(desk.path("a.lod")).unwrap();
    let expected = serde_json::json!({
        "lodray": env!("CARGO_PKG_VERSION"),
        "command": "render",
        "arguments": ["a.lod", "--size", "8x8", "--compare"],
        "inputs": [{ "name": "a.lod", "bytes": bytes.len(), "xxh3": format!("{:016x}", xxhash_rust::xxh3::xxh3_64(&bytes)) }],
        "files": ["error.png", "image.png", "levels.png", "normals.png", "sheet.png"],
    });
    assert_eq!(record, expected);
    // The same bytes wherever the folder is, with any number of threads, and the second time.
    desk.run(&format!("--threads 1 {RENDER} --out=far/two --compare --quiet"));
    desk.run(&format!("{RENDER} --json --threads 3 -o one --compare"));
    assert!(desk.files("one") == desk.files("far/two"));

    desk.write("own/mine.toml", include_str!("../../machines/haydel2023.toml"));
    desk.write("own/energy/cacti22.toml", include_str!("../../machines/energy/cacti22.toml"));
    desk.write("own/energy/cacti22.csv", include_str!("../../machines/energy/cacti22.csv"));
    desk.run("simulate a.lod --size 8x8 --machine own/mine.toml,packet -o sim");
    let inputs = desk.record("sim")["inputs"].clone();
    let names: Vec<_> = inputs.as_array().unwrap().iter().map(|input| input["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["a.lod", "own/mine.toml", "own/energy/cacti22.toml", "own/energy/cacti22.csv"]);
    desk.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    desk.run(&format!("{RENDER} --compare --mesh mesh.obj -o original"));
    assert_eq!(desk.record("original")["inputs"][1]["name"], "mesh.obj");
    desk.run("stability a.lod --rays 500 --hunt 20 -o lab");
    assert_eq!(desk.record("lab")["files"], serde_json::json!(["found.json", "stability.json", "stability.md"]));
}

#[test]
fn a_later_run_replaces_an_earlier_one_and_nothing_else() {
    let desk = Desk::new();
    desk.write("out/notes.txt", "mine");
    desk.write("out/sub/image.png", "mine");
    desk.run(&format!("{RENDER} -o out --compare"));
    assert_eq!(desk.names("out"), ["error.png", "image.png", "levels.png", "normals.png", "notes.txt", "run.json", "sheet.png", "sub"]);
    desk.run(&format!("{RENDER} -o out --distance 3"));
    assert_eq!(desk.names("out"), ["image.png", "levels.png", "normals.png", "notes.txt", "run.json", "sheet.png", "sub"]);
    desk.run(&format!("{RENDER} -o alone --distance 3"));
    let (both, alone) = (desk.files("out"), desk.files("alone"));
    assert!(alone.iter().all(|(name, bytes)| both[name] == *bytes));
    assert_eq!(both["notes.txt"], b"mine");
    assert_eq!(fs::read(desk.path("out/sub/image.png")).unwrap(), b"mine");
    // A file that has gone meanwhile is no harm.
    fs::remove_file(desk.path("out/normals.png")).unwrap();
    desk.run(&format!("{SIMULATE} -o out --force"));
    assert!(!desk.names("out").contains(&"image.png".to_owned()));
}

#[test]
fn a_run_of_another_command_is_refused_unless_forced() {
    let desk = Desk::new();
    desk.write("out/notes.txt", "mine");
    desk.run(&format!("{SIMULATE} -o out"));
    desk.write(
        "jobs.toml",
        "size = \"8x8\"\ndistances = [2]\nmethods = [\"lod\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n",
    );
    for (args, command) in
        [(RENDER, "render"), ("demo", "demo"), ("stability --case flat --rays 10", "stability"), ("sweep jobs.toml", "sweep")]
    {
        desk.refused(&format!("{args} -o out"), "out", &format!("out holds a run of `simulate`, and `{command}` does not mix with it"));
    }
    // Forced, and failed: the old run is still whole.
    desk.refused("simulate a.lod --size 8x8 --vcd a.vcd --window 900000:900001 -o out", "out", "begins beyond the frame's end");
    desk.refused("render a.lod --size 8x8 --eye 0,5,0 --target 0,0,0 --up y -o out --force", "out", "nor along the view direction");
    desk.run(&format!("{RENDER} -o out --force"));
    assert_eq!(desk.names("out"), ["image.png", "levels.png", "normals.png", "notes.txt", "run.json", "sheet.png"]);
    assert_eq!(desk.record("out")["command"], "render");
    desk.run("sweep jobs.toml -o out --force");
    assert_eq!(desk.names("out"), ["notes.txt", "results.csv", "results.jsonl", "run.json"]);
    assert_eq!(desk.record("out")["files"], serde_json::json!(["results.csv", "results.jsonl"]));
    assert!(!desk.path("out/image.png").exists() && desk.path("out/notes.txt").exists());
}

#[test]
fn files_that_no_record_lists_are_not_overwritten() {
    let desk = Desk::new();
    desk.write("out/levels.png", "mine");
    desk.refused(&format!("{RENDER} -o out"), "out", "out/levels.png is there, and no run.json says that a run has made it");
    desk.run(&format!("{RENDER} -o out --force"));
    assert_ne!(fs::read(desk.path("out/levels.png")).unwrap(), b"mine");
    // Also beside a record.
    desk.write("out/error.png", "mine");
    desk.refused(&format!("{RENDER} --compare -o out"), "out", "out/error.png is there");
    desk.run(&format!("{RENDER} -o out"));
    assert_eq!(fs::read(desk.path("out/error.png")).unwrap(), b"mine");
}

#[test]
fn what_a_mesh_names_is_an_input_too() {
    let desk = Desk::new();
    desk.write("my stone.mtl", "newmtl red\nKd 1 0 0\n");
    desk.write("a.obj", "mtllib my stone.mtl\nmtllib none.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let numbers = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    fs::write(desk.path("the points.bin"), numbers.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let gltf = serde_json::json!({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "the%20points.bin"}],
    });
    desk.write("a.gltf", &gltf.to_string());
    for (mesh, named) in [("a.obj", "my stone.mtl"), ("a.gltf", "the points.bin")] {
        let output = desk.command(&format!("render {mesh} --method original --size 8x8 -o out --force")).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), said.contains("mtllib none.mtl: ")), (Some(0), mesh == "a.obj"), "{said}");
        let inputs: Vec<_> = desk.record("out")["inputs"].as_array().unwrap().iter().map(|input| input["name"].clone()).collect();
        assert_eq!(inputs, [mesh, named]);
    }
}

#[test]
fn a_record_that_is_none_removes_nothing() {
    let desk = Desk::new();
    desk.write("out/keep.txt", "mine");
    desk.write("keep.txt", "mine");
    let absolute = desk.path("keep.txt").display().to_string();
    let record = |name: &str| {
        let record = serde_json::json!({ "lodray": "0.1.0", "command": "render", "arguments": [], "inputs": [], "files": [name] });
        desk.write("out/run.json", &record.to_string());
    };
    for name in ["../keep.txt", &absolute, "sub/../../keep.txt", "", ".", ".."] {
        record(name);
        desk.refused(&format!("{RENDER} -o out"), "out", "out/run.json is not the record of a run: '");
        desk.run(&format!("{RENDER} -o out --force"));
        assert!(desk.path("keep.txt").exists() && desk.path("out/keep.txt").exists(), "{name}");
        for file in ["image.png", "levels.png", "normals.png"] {
            fs::remove_file(desk.path("out").join(file)).unwrap();
        }
    }
    for (text, why) in [
        ("", "line 1, column 0: it ends too early"),
        ("{}", "line 1, column 2: the field lodray is missing"),
        ("[1]", "line 1, column 2: a value is not of the kind"),
        ("no JSON", "line 1, column 2: it is not JSON"),
        ("{\"lodray\": 1}", "line 1, column 12: a value is not of the kind"),
    ] {
        desk.write("out/run.json", text);
        desk.refused(&format!("{RENDER} -o out"), "out", &format!("out/run.json is not the record of a run: {why}"));
    }
}

#[test]
fn what_killed_runs_left_is_removed_and_nothing_of_live_ones() {
    let desk = Desk::new();
    let plant = || {
        desk.write("out/.lodray-x8Fq2a.tmp", "half a file");
        desk.write(&format!("out/{STAGING}/image.png"), "half a file");
        desk.write(&format!("out/{STAGING}/lock"), "");
    };
    fs::create_dir(desk.path("out")).unwrap();
    let live = temporary_beside(&desk.path("out/other.lod")).unwrap();
    let live_name = live.path().file_name().unwrap().to_str().unwrap().to_owned();
    desk.write("out/.lodray-mine", "mine");
    for (args, makes) in [
        ("generate terrain --levels 1 --base 8 -o out/b.lod", "b.lod"),
        ("export a.lod --level 0 -o out/a.obj", "a.obj"),
        ("trace a.lod --pixel 4,4 --size 8x8 -o out/a.vcd", "a.vcd"),
        (&format!("{RENDER} -o out"), "image.png"),
        (&format!("{SIMULATE} -o out --force"), "result.json"),
    ] {
        plant();
        desk.run(args);
        let names = desk.names("out");
        let hidden: Vec<_> = names.iter().filter(|name| name.starts_with('.')).cloned().collect();
        let mut kept = vec![live_name.clone(), ".lodray-mine".to_owned()];
        kept.sort_unstable();
        assert_eq!(hidden, kept, "{args}");
        assert!(names.iter().any(|name| name == makes), "{args}: {names:?}");
    }
    drop(live);
    assert!(!desk.names("out").contains(&live_name));
}

#[test]
fn one_run_at_a_time_and_a_killed_one_leaves_the_folder_as_it_was() {
    let desk = Desk::new();
    desk.run("stability --case flat --rays 500 -o out");
    let before = desk.files("out");
    let mut long = desk.command("stability --case million --rays 1000000000 -o out");
    let mut running = long.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    while !desk.path("out").join(STAGING).join("lock").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it does not begin");
        std::thread::sleep(Duration::from_millis(5));
    }
    let short = "stability --case open --rays 500 -o out";
    let output = desk.command(short).output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && err == "error: out: another run is writing to this folder\n", "{err}");
    // Files beside a run's folder are no matter of its own, and do not take it away.
    desk.run("export a.lod -o out/a.obj");
    assert!(desk.path("out").join(STAGING).exists());
    fs::remove_file(desk.path("out/a.obj")).unwrap();
    running.kill().unwrap();
    running.wait().unwrap();
    let mut after = desk.files("out");
    after.remove(STAGING);
    assert!(after == before);
    desk.run(short);
    assert_eq!(desk.names("out"), before.keys().cloned().collect::<Vec<_>>());
    assert_ne!(desk.record("out"), serde_json::from_slice::<Value>(&before["run.json"]).unwrap());
}

#[test]
fn a_sweep_goes_on_in_its_folder() {
    let desk = Desk::new();
    let jobs = |distances: &str| {
        format!(
            "size = \"8x8\"\ndistances = [{distances}]\nmethods = [\"lod\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n"
        )
    };
    desk.write("jobs.toml", &jobs("2, 4"));
    assert!(desk.run("sweep jobs.toml -o out").contains("2 jobs, 0 of them done before"));
    let record = desk.record("out");
    let charts =
        |record: &Value| record["files"].as_array().unwrap().iter().filter(|name| name.as_str().unwrap().ends_with(".svg")).count();
    assert_eq!((charts(&record), record["arguments"].clone()), (2, serde_json::json!(["jobs.toml"])));
    assert_eq!(
        record["inputs"].as_array().unwrap().iter().map(|i| i["name"].as_str().unwrap()).collect::<Vec<_>>(),
        ["jobs.toml", "a.lod"]
    );
    let files = desk.files("out");
    assert!(desk.run("sweep jobs.toml -o out").contains("2 jobs, 2 of them done before"));
    assert!(desk.files("out") == files);
    // Stopped on the way: the record was there before the first result.
    let mut unfinished = record.clone();
    unfinished["unfinished"] = true.into();
    desk.write("out/run.json", &unfinished.to_string());
    fs::remove_file(desk.path("out/results.csv")).unwrap();
    assert!(desk.run("sweep jobs.toml -o out").contains("2 jobs, 2 of them done before"));
    assert!(desk.files("out") == files);
    // One view has no chart; the results of the other stay for later.
    desk.write("jobs.toml", &jobs("2"));
    assert!(desk.run("sweep jobs.toml -o out").contains("1 job, 1 of them done before"));
    assert_eq!(charts(&desk.record("out")), 0);
    assert!(!desk.names("out").iter().any(|name| name.ends_with(".svg")), "{:?}", desk.names("out"));
    desk.refused(&format!("{RENDER} -o out"), "out", "out holds a run of `sweep`, and `render` does not mix with it");
}

#[test]
fn lines_that_no_run_has_made_are_not_taken_over() {
    let desk = Desk::new();
    desk.write(
        "jobs.toml",
        "size = \"8x8\"\ndistances = [2]\nmethods = [\"lod\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n",
    );
    for (args, name) in [("sweep jobs.toml", "results.jsonl"), ("error-time a.lod", "views.jsonl")] {
        let theirs = format!("{name}-of-others/{name}");
        fs::create_dir(desk.path(&format!("{name}-of-others"))).unwrap();
        desk.write(&theirs, "{\"theirs\": 1}\n");
        desk.refused(
            &format!("{args} -o {name}-of-others"),
            &format!("{name}-of-others"),
            "is there, and no run.json says that a run has made it",
        );
        assert_eq!(desk.files(&format!("{name}-of-others"))[name], b"{\"theirs\": 1}\n");
    }
    // With --force they are set aside, and nothing of them is lost.
    let forced = desk.command("sweep jobs.toml -o results.jsonl-of-others --force").output().unwrap();
    assert!(forced.status.success() && forced.stderr.starts_with(b"warning: "), "{forced:?}");
    assert_eq!(desk.files("results.jsonl-of-others")["results.bad.jsonl"], b"{\"theirs\": 1}\n");
}
