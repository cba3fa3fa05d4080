//! `lodray trace`: waveform, save files and text of one ray, and what it refuses.

use lodray::hardware::State;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Output;

fn lodray(folder: &Path, args: &str) -> Output {
    assert_cmd::cargo::cargo_bin_cmd!("lodray").current_dir(folder).args(args.split_whitespace()).output().unwrap()
}

/// A folder with a scene.
fn desk() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    assert!(lodray(folder.path(), "generate sphere --levels 3 --base 32 -o a.lod").status.success());
    folder
}

fn succeed(folder: &Path, args: &str) -> String {
    let Output { status, stdout, stderr } = lodray(folder, args);
    let [out, err] = [stdout, stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(status.success() && err.is_empty(), "{args}: {err}");
    out
}

/// Runs, expects failure with one line that holds `words`, and nothing written.
fn fail(folder: &Path, args: &str, words: &str) {
    let names = || fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect::<BTreeSet<_>>();
    let before = names();
    let output = lodray(folder, args);
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(!output.status.success() && output.stdout.is_empty(), "{args}");
    assert!(err.starts_with("error: ") && err.contains(words), "{args}: {err}");
    assert_eq!(names(), before, "{args}");
}

#[test]
fn waveform_and_save_files_stand_side_by_side() {
    let folder = desk();
    let desk = folder.path();
    let said = succeed(desk, "trace a.lod --pixel 24,24 --size 48x48 --distance 3 -o ray.vcd");
    assert!(said.starts_with("hit after ") && said.contains("memory lines; waveform in ray.vcd"), "{said}");
    let vcd = fs::read(desk.join("ray.vcd")).unwrap();
    let header = vcd::Parser::new(&vcd[..]).parse_header().unwrap();
    let state = header.find_var(&["traversal_unit", "g_context[0]", "u_context", "state_q"]).expect("the state");
    assert_eq!((state.size, header.timescale), (5, Some((1, vcd::TimescaleUnit::NS))));
    assert!(header.find_var(&["traversal_unit", "u_lod_test", "out_o", "refine"]).is_some());
    // States by name, beside their numbers.
    let names = states(&vcd);
    assert!(names.starts_with(&["IDLE", "SETUP", "SETUP_WAIT", "VISIT", "FETCH"].map(String::from)), "{names:?}");
    assert!(names.ends_with(&["DONE", "IDLE"].map(String::from)), "{names:?}");

    let text = |name: &str| fs::read_to_string(desk.join(name)).unwrap();
    let gtkw = text("ray.gtkw");
    // GTKWave looks from the folder that it was started in: names are whole paths.
    let whole = |name: &str| fs::canonicalize(desk).unwrap().join(name).display().to_string();
    for words in
        [&format!("[dumpfile] \"{}\"", whole("ray.vcd"))[..], "@28\ntraversal_unit.g_context[0].u_context.state\n", "-Level_of_detail\n"]
    {
        assert!(gtkw.contains(words), "{words}");
    }
    assert!(text("ray.sucl").contains("variable_add traversal_unit.g_context[0].u_context.lod_q.s0\n"));
    assert_eq!(fs::read_dir(desk).unwrap().count(), 4, "left-over files");

    // The same bytes again, over the old ones.
    succeed(desk, "trace a.lod --pixel 24,24 --size 48x48 --distance 3 -o ray.vcd");
    assert_eq!(fs::read(desk.join("ray.vcd")).unwrap(), vcd);
}

/// Names that a waveform's context goes through, each change once.
fn states(vcd: &[u8]) -> Vec<String> {
    let header = vcd::Parser::new(vcd).parse_header().unwrap();
    let name = header.find_var(&["traversal_unit", "g_context[0]", "u_context", "state"]).expect("the state's name");
    assert_eq!(name.var_type, vcd::VarType::String);
    vcd::Parser::new(vcd)
        .filter_map(|command| match command.unwrap() {
            vcd::Command::ChangeString(id, text) if id == name.code => Some(text),
            _ => None,
        })
        .collect()
}

#[test]
fn the_diagram_of_states_has_every_way_that_rays_take() {
    let text = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/traversal-unit.md")).unwrap();
    let diagram = text.split("stateDiagram-v2\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the diagram");
    let drawn: BTreeSet<(String, String)> = diagram
        .lines()
        .filter_map(|line| line.split(':').next()?.trim().split_once(" --> "))
        .map(|(from, to)| (from.to_owned(), to.to_owned()))
        .collect();
    let named: BTreeSet<&str> = drawn.iter().flat_map(|(from, to)| [from.as_str(), to]).filter(|&name| name != "[*]").collect();
    let all: BTreeSet<&str> = State::ALL.iter().map(|state| state.name()).collect();
    assert_eq!(named, all);

    let folder = desk();
    let desk = folder.path();
    let mut taken = BTreeSet::new();
    for pixel in ["24,24", "14,14", "20,28", "30,18"] {
        for delta in ["1", "inf"] {
            succeed(desk, &format!("trace a.lod --pixel {pixel} --size 48x48 --distance 3 --delta {delta} -o ray.vcd"));
            let names = states(&fs::read(desk.join("ray.vcd")).unwrap());
            taken.extend(names.windows(2).map(|two| (two[0].clone(), two[1].clone())));
        }
    }
    assert!(taken.is_subset(&drawn), "not drawn: {:?}", taken.difference(&drawn).collect::<Vec<_>>());
    // What only rays with others, trees without splits, or hardware with less, take.
    let rest: Vec<String> = drawn.difference(&taken).map(|(from, to)| format!("{from} {to}")).collect();
    assert_eq!(
        rest,
        ["DECIDE DECIDE_WAIT", "DECIDE_WAIT LOD", "FETCH DECIDE", "FETCH TRI", "LOD FETCH", "LOD TRI", "SUM DONE", "[*] IDLE"],
        "ways that none of these rays took"
    );
}

#[test]
fn steps_as_text() {
    let folder = desk();
    let desk = folder.path();
    let steps = succeed(desk, "trace a.lod --pixel 24,24 --size 48x48 --distance 3 --text");
    for words in [
        "visit quad-BVH node 0\n",
        "read line 0x0 (bvh_node 0)\n",
        "visit tree ",
        "level 0 node 0: edge states ",
        "triangle level ",
        "hit: t ",
    ] {
        assert!(steps.contains(words), "{words}: {steps}");
    }
    assert_eq!(steps, succeed(desk, "trace a.lod --pixel 24,24 --size 48x48 --distance 3 -o -"));
    assert_eq!(fs::read_dir(desk).unwrap().count(), 1, "files were written");

    // Quality 0 is the base mesh; a slower memory only takes longer.
    let base = succeed(desk, "trace a.lod --pixel 24,24 --size 48x48 --distance 3 --delta 0 --text");
    assert!(base.contains("level 0 node 0: edge states 0 0 0 of 256: serves\n") && !base.contains("refine"), "{base}");
    let slow = succeed(desk, "trace a.lod --pixel 24,24 --size 48x48 --distance 3 --memory-latency 200 --text");
    let without_cycles =
        |text: &str| text.lines().skip(2).filter_map(|line| Some(line.split_at_checked(8)?.1.to_owned())).collect::<Vec<_>>();
    let ([a, b], lines) = ([&steps, &slow].map(|text| without_cycles(text)), steps.lines().count());
    assert_eq!(a[..lines - 3], b[..lines - 3]);
    assert_ne!(steps, slow);
}

#[test]
fn ports_are_those_of_a_unit_over_the_scenes_file() {
    use lodray::format::Scene;
    use lodray::hardware::ports::{HitOut, RayIn, SceneConfig};
    use lodray::num::Wire;
    let folder = desk();
    let desk = folder.path();
    let view = "--pixel 24,24 --size 48x48 --distance 3";
    assert_eq!(succeed(desk, &format!("trace a.lod {view} --ports ray.json")), "ports in ray.json\n");
    let ports: serde_json::Value = serde_json::from_slice(&fs::read(desk.join("ray.json")).unwrap()).unwrap();
    let words = |port: &str, width: u32| {
        let digits = ports[port]["bits"].as_str().and_then(|bits| bits.strip_prefix("0x")).expect("hexadecimal");
        assert_eq!((ports[port]["width"].as_u64(), digits.len()), (Some(u64::from(width)), width.div_ceil(4) as usize), "{port}");
        let chunks = digits.as_bytes().rchunks(16).map(|chunk| std::str::from_utf8(chunk).unwrap());
        chunks.map(|chunk| u64::from_str_radix(chunk, 16).unwrap()).collect::<Vec<_>>()
    };
    // The lines that scene_i points at are the sections of the file.
    let config = SceneConfig::from_words(&words("scene_i", SceneConfig::WIDTH));
    let scene = Scene::open(&desk.join("a.lod")).unwrap();
    let at = |first: u64, bytes: usize| &scene.bytes()[32 * first as usize..][..bytes];
    for (first, section) in [
        (config.nodes, bytes_of(scene.nodes().as_flattened())),
        (config.records, bytes_of(scene.records().as_flattened())),
        (config.splits, bytes_of(scene.splits().as_flattened())),
        (config.vertices, bytes_of(scene.vertices().as_flattened())),
    ] {
        assert!(!section.is_empty() && at(first.get(), section.len()) == section);
    }
    assert_eq!((config.levels.get(), config.compact), (3, true));
    // What it met and what it read are what the text says.
    let steps = succeed(desk, &format!("trace a.lod {view} --text"));
    let (ray, hit) = (RayIn::from_words(&words("in_i", RayIn::WIDTH)), HitOut::from_words(&words("out_o", HitOut::WIDTH)));
    assert!(steps.starts_with(&format!("ray from {:?} along {:?}", ray.ray.origin.get(), ray.ray.direction.get())), "{steps}");
    assert!(hit.found && steps.contains(&format!("hit: t {}", hit.hit.t)), "{steps}");
    assert!(steps.ends_with(&format!(" {} memory lines\n", ports["lines"])), "{steps}");

    // Beside the waveform, and beside the text.
    succeed(desk, &format!("trace a.lod {view} -o ray.vcd --ports again.json"));
    assert!(succeed(desk, &format!("trace a.lod {view} -o - --ports again.json")).ends_with(&steps));
    assert_eq!(fs::read(desk.join("again.json")).unwrap(), fs::read(desk.join("ray.json")).unwrap());
    fail(desk, &format!("trace a.lod {view} --ports a.lod"), "it is the input file");
    fail(desk, &format!("trace a.lod {view} -o new.vcd --ports new.sucl"), "it is a file of the waveform");
    fail(desk, &format!("trace a.lod {view} -o new.vcd --ports ./new.vcd"), "it is a file of the waveform");
    fail(desk, &format!("trace a.lod {view} --plan ray.json --ports ray.json"), "it is the input file");
}

/// As they lie in memory.
fn bytes_of(words: &[u64]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

#[test]
fn a_plans_unit_takes_the_same_steps() {
    let folder = desk();
    let desk = folder.path();
    let list = |distance: f64| {
        format!(
            "size = \"48x48\"\nmethods = [\"lod\"]\ndistances = [{distance}]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"haydel2023\"\n"
        )
    };
    fs::write(desk.join("jobs.toml"), list(3.0)).unwrap();
    assert!(lodray(desk, "plan --job jobs.toml -o plan.toml").status.success());
    assert!(lodray(desk, "prune a.lod --plan plan.toml -o small.lod").status.success());
    let view = "--pixel 24,24 --size 48x48 --distance 3";
    let whole = succeed(desk, &format!("trace a.lod {view} --text"));
    // Numbers of lines follow from where trees begin, cycles from the unit: it maps hits in as few steps as there are levels. All else is the same.
    let steps = |text: &str| {
        let lines = text.lines().skip(2).filter(|line| !line.contains("read line"));
        lines.filter_map(|line| Some(line.split_at_checked(8)?.1.to_owned())).collect::<Vec<_>>()
    };
    let cycles = |text: &str| text.lines().last().and_then(|line| line.split(' ').next()?.parse::<u32>().ok()).expect("cycles");
    for scene in ["a.lod", "small.lod"] {
        let own = succeed(desk, &format!("trace {scene} {view} --plan plan.toml --text"));
        let ([most, less], last) =
            ([&whole, &own].map(|text| steps(text)), whole.lines().filter(|line| !line.contains("read line")).count() - 3);
        assert_eq!(most[..last], less[..last], "{scene}");
        assert!(cycles(&own) < cycles(&whole), "{scene}");
    }
    succeed(desk, &format!("trace small.lod {view} --plan plan.toml -o ray.vcd"));
    // A ray of full detail goes deeper than those of a coarse job.
    fs::write(desk.join("jobs.toml"), list(40.0)).unwrap();
    assert!(lodray(desk, "plan --job jobs.toml -o far.toml").status.success());
    fail(desk, &format!("trace a.lod {view} --plan far.toml --text"), "does not fit the plan: ");
    fail(desk, &format!("trace a.lod {view} --plan none.toml --text"), "cannot read none.toml");
}

#[test]
fn what_cannot_be_traced_is_refused() {
    let folder = desk();
    let desk = folder.path();
    fail(
        desk,
        "trace a.lod --pixel 48,3 --size 48x48 -o ray.vcd",
        "--pixel 48,3: outside of the picture of 48x48 pixels, the last of which is 47,47",
    );
    fail(desk, "trace a.lod --pixel 0,0 --size 48x48 --distance 20 -o ray.vcd", "the ray of pixel 0,0 misses the model's box");
    fail(desk, "trace a.lod --pixel 1 --size 48x48 -o ray.vcd", "'1' is not a pixel such as 320,200");
    fail(desk, "trace a.lod --pixel 24,-1 -o ray.vcd", "'24,-1' is not a pixel");
    fail(desk, "trace a.lod --pixel 24,24 --size 48x48", "--out");
    fail(desk, "trace a.lod --pixel 24,24 --size 48x48 --memory-latency 0 --text", "--memory-latency");
    fail(desk, "trace a.lod --pixel 24,24 --size 48x48 -o a.lod", "it is the input file");
    fail(desk, "trace a.lod --pixel 24,24 --size 48x48 -o none/ray.vcd", "folder none does not exist");
    fail(desk, "trace a.lod --pixel 24,24 --size 48x48 -o ray.gtkw", "use .vcd");
    fail(desk, "trace b.lod --pixel 24,24 -o ray.vcd", "b.lod: cannot open");
}
