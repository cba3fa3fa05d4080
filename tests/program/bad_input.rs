//! Bad input: one clear error that names the file or option, a non-zero exit code, and nothing written or lost.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

/// Failures, and wrong usage.
const FAILS: i32 = 1;
const USAGE: i32 = 2;

fn lodray(folder: &Path, args: &str) -> Output {
    assert_cmd::cargo::cargo_bin_cmd!("lodray").current_dir(folder).args(args.split_whitespace()).output().unwrap()
}

/// A folder with good and bad files.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let make = |args: &str| assert!(lodray(folder.path(), args).status.success(), "{args}");
    make("generate sphere --levels 2 --base 8 -o good.lod");
    make("generate terrain --levels 1 --base 8 -o open.lod");
    let write = |name: &str, content: &[u8]| fs::write(folder.path().join(name), content).unwrap();
    let good = fs::read(folder.path().join("good.lod")).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 0x10;
    write("flipped.lod", &flipped);
    // Of the layout before this one: whatever else is in it is not looked at.
    let mut old = good.clone();
    old[8] = 1;
    write("old.lod", &old);
    write("cut.lod", &good[..500]);
    write("cut20.lod", &good[..20]);
    write("long.lod", &[&good[..], &[0; 64]].concat());
    write("text.lod", b"this is not a scene\n");
    write("empty.lod", b"");
    write("good.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("nan.obj", b"v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n");
    write("index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    write("word.obj", b"v 0 0 0\nv 1 zero 0\n");
    write("flat.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    write("empty.obj", b"");
    write("empty.ply", b"");
    write("cut.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n");
    for name in ["folder", "folder.obj", "taken/image.png", "table/table.txt"] {
        fs::create_dir_all(folder.path().join(name)).unwrap();
    }
    folder
}

/// Every file below `folder` with its contents; folders with none.
fn contents(folder: &Path) -> Vec<(PathBuf, Option<Vec<u8>>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(contents(&path));
            found.push((path, None));
        } else {
            let bytes = fs::read(&path).unwrap();
            found.push((path, Some(bytes)));
        }
    }
    found.sort();
    found
}

/// Runs every row of (arguments, exit code, what the error says) and checks that nothing on disk has changed.
fn refuse(rows: &[(&str, i32, &str)]) {
    let folder = folder();
    let before = contents(folder.path());
    for &(args, code, fragment) in rows {
        let output = lodray(folder.path(), args);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{args}: {error}");
        assert!(error.starts_with("error: ") && error.contains(fragment), "{args}: no '{fragment}' in: {error}");
        assert!(!error.contains("panicked"), "{args}: {error}");
        assert!(code == USAGE || error.lines().count() == 1, "{args}: more than one line: {error}");
        assert!(error.matches("os error").count() <= 1, "{args}: says it twice: {error}");
        assert!(output.stdout.is_empty(), "{args}: figures of a failure");
        assert!(contents(folder.path()) == before, "{args}: files have changed");
    }
}

#[test]
fn scenes() {
    let files = [
        ("missing.lod", "missing.lod: cannot open: No such file"),
        ("folder", "folder: magic: not a lodray scene file"),
        ("empty.lod", "empty.lod: magic: not a lodray scene file"),
        ("text.lod", "text.lod: magic: not a lodray scene file"),
        ("good.obj", "good.obj: this is a mesh, not a scene: `lodray build good.obj -o good.lod` makes one"),
        ("cut.lod", "cut.lod: file length: file is truncated: 500 bytes"),
        ("cut20.lod", "cut20.lod: header: file is truncated at 20 bytes"),
        ("long.lod", "long.lod: file length"),
        ("flipped.lod", "flipped.lod: section"),
        (
            "old.lod",
            "old.lod: version: 1 is older than 5, the only one that this program reads; make the scene again with build or generate",
        ),
    ];
    let commands = ["info", "verify", "crack", "lines --size 8x8", "render --size 8x8 -o new", "export -o new.obj"];
    let rows: Vec<(String, &str)> = commands.iter().flat_map(|c| files.map(|(file, says)| (format!("{c} {file}"), says))).collect();
    refuse(&rows.iter().map(|(args, says)| (args.as_str(), FAILS, *says)).collect::<Vec<_>>());
}

#[test]
fn meshes() {
    refuse(&[
        ("build missing.obj -o new.lod", FAILS, "missing.obj: No such file"),
        ("build folder.obj -o new.lod", FAILS, "folder.obj: is a directory"),
        ("build folder -o new.lod", FAILS, "folder: is a directory"),
        ("build good.lod -o new.lod", FAILS, "good.lod: unknown kind of mesh file, the name must end in .obj, .ply, .gltf, .glb or .stl"),
        ("build - -o new.lod", USAGE, "--format"),
        ("build - --format obj -o new.lod", FAILS, "stdin: line 1: the file is empty"),
        ("build good.obj --format ply -o new.lod", FAILS, "good.obj: header, line 1: this is not a PLY file"),
        ("build good.obj --format gltf -o new.lod", FAILS, "good.obj: JSON, line 1"),
        ("build good.obj --format dae -o new.lod", USAGE, "'dae' for '--format"),
        ("build empty.obj -o new.lod", FAILS, "empty.obj: line 1: the file is empty"),
        ("build empty.ply -o new.lod", FAILS, "empty.ply: line 1: the file is empty"),
        ("build nan.obj -o new.lod", FAILS, "nan.obj: line 2: v: nan is not finite"),
        ("build index.obj -o new.lod", FAILS, "index.obj: line 4: vertex index 9 is out of range"),
        ("build word.obj -o new.lod", FAILS, "word.obj: line 2"),
        ("build flat.obj -o new.lod", FAILS, "flat.obj: "),
        ("build cut.ply -o new.lod", FAILS, "cut.ply: "),
        ("build good.obj --levels 11 -o new.lod", USAGE, "'11' for '--levels"),
        ("build good.obj --levels -1 -o new.lod", USAGE, "'-1' for '--levels"),
        ("build good.obj --base 0 -o new.lod", USAGE, "'0' for '--base"),
        ("build good.obj --base -5 -o new.lod", USAGE, "'-5' for '--base"),
        ("build good.obj", USAGE, "--out"),
    ]);
}

#[test]
fn targets() {
    let mut rows = vec![
        ("generate sphere --levels 1 -o none/new.lod", FAILS, "cannot write none/new.lod: folder none does not exist"),
        ("generate sphere --levels 1 -o folder", FAILS, "cannot write folder: it is a folder"),
        ("generate sphere --levels 1 -o good.obj/new.lod", FAILS, "cannot write good.obj/new.lod: folder good.obj does not exist"),
        ("build good.obj -o good.obj", FAILS, "cannot write good.obj: it is the input file"),
        ("build good.obj -o folder/../good.obj", FAILS, "it is the input file"),
        ("build nan.obj -o good.lod", FAILS, "nan.obj: line 2"),
        ("export good.lod -o good.lod", FAILS, "cannot write good.lod: it is the input file"),
        ("export good.lod -o folder", FAILS, "cannot write folder: it is a folder"),
        ("export flipped.lod -o good.obj", FAILS, "flipped.lod: section"),
        ("render good.lod --size 8x8 -o good.obj", FAILS, "cannot make folder good.obj"),
        ("render good.lod --size 8x8 -o good.obj/new", FAILS, "cannot make folder good.obj/new"),
        ("render good.lod --size 8x8 -o good.lod", FAILS, "cannot make folder good.lod"),
        ("render good.lod --size 8x8 -o taken", FAILS, "cannot write taken/image.png: it is a folder"),
        ("demo -o good.obj", FAILS, "cannot make folder good.obj"),
        ("demo -o table", FAILS, "cannot write table/table.txt: it is a folder"),
    ];
    if cfg!(target_os = "linux") {
        // Not even root makes files there, and devices are not files to replace.
        rows.push(("generate sphere --levels 1 -o /proc/new.lod", FAILS, "cannot write /proc/new.lod: "));
        rows.push(("generate sphere --levels 1 -o /dev/null", FAILS, "cannot write /dev/null: it is not an ordinary file"));
        rows.push(("render good.lod --size 8x8 -o /proc", FAILS, "cannot write /proc/image.png: "));
    }
    refuse(&rows);
}

#[test]
fn numbers() {
    refuse(&[
        ("paint good.lod", USAGE, "'paint'"),
        ("generate blob -o new.lod", USAGE, "'blob'"),
        ("generate sphere", USAGE, "--out"),
        ("generate sphere --levels 11 -o new.lod", USAGE, "'11' for '--levels"),
        ("generate sphere --levels -1 -o new.lod", USAGE, "'-1' for '--levels"),
        ("generate sphere --levels two -o new.lod", USAGE, "'two' for '--levels"),
        ("generate sphere --base 0 -o new.lod", USAGE, "'0' for '--base"),
        ("generate sphere --base 4000000000 -o new.lod", USAGE, "'4000000000' for '--base"),
        ("generate sphere --base 134217728 --levels 10 -o new.lod", FAILS, ""),
        ("generate sphere --seed -1 -o new.lod", USAGE, "'-1' for '--seed"),
        ("generate sphere --vertices round -o new.lod", USAGE, "'round' for '--vertices"),
        ("generate sphere --roughness nan -o new.lod", USAGE, "'nan' for '--roughness"),
        ("generate sphere --roughness -0.1 -o new.lod", USAGE, "'-0.1' for '--roughness"),
        ("generate sphere --roughness 2 -o new.lod", USAGE, "'2' for '--roughness"),
        ("generate sphere good.obj -o new.lod", USAGE, "unexpected argument 'good.obj'"),
        ("build --subdivide loop -o new.lod", USAGE, "MESH"),
        ("build missing.obj --subdivide loop -o new.lod", FAILS, "missing.obj: No such file"),
        ("build nan.obj --subdivide loop -o new.lod", FAILS, "nan.obj: line 2: v: nan is not finite"),
        ("build good.lod --subdivide loop -o new.lod", FAILS, "good.lod: unknown kind of mesh file"),
        ("build - --subdivide loop -o new.lod", USAGE, "--format"),
        ("build good.obj --subdivide loop -o good.obj", FAILS, "it is the input file"),
        ("build good.obj --subdivide loop --levels 11 -o new.lod", USAGE, "'11' for '--levels"),
        ("build good.obj --subdivide loop --base 8 -o new.lod", USAGE, "--base"),
        ("build good.obj --subdivide round -o new.lod", USAGE, "'round' for '--subdivide"),
        ("build good.obj --subdivide loop --levels 8 --coordinate-zeros 9 -o new.lod", FAILS, "good.obj: "),
        ("build good.obj --displace missing.png --amount 1 -o new.lod", FAILS, "missing.png: No such file"),
        ("build good.obj --displace good.obj --amount 1 -o new.lod", FAILS, "good.obj: The image format could not be determined"),
        ("build good.obj --displace good.obj -o new.lod", USAGE, "--amount"),
        ("build good.obj --amount 1 -o new.lod", USAGE, "--displace"),
        ("build good.obj --displace good.obj --amount inf -o new.lod", USAGE, "'inf' for '--amount"),
        ("build good.obj --displace good.obj --amount 1 --max-error 1 -o new.lod", USAGE, "--max-error"),
        ("render good.lod -o new --delta -1", USAGE, "'-1' for '--delta"),
        ("render good.lod -o new --delta -inf", USAGE, "'-inf' for '--delta"),
        ("render good.lod -o new --delta nan", USAGE, "'nan' for '--delta"),
        ("render good.lod -o new --delta fine", USAGE, "'fine' for '--delta"),
        ("render good.lod -o new --fov 0", USAGE, "'0' for '--fov"),
        ("render good.lod -o new --fov 180", USAGE, "'180' for '--fov"),
        ("render good.lod -o new --fov -30", USAGE, "'-30' for '--fov"),
        ("render good.lod -o new --fov nan", USAGE, "'nan' for '--fov"),
        ("render good.lod -o new --size 0x0", USAGE, "'0x0' for '--size"),
        ("render good.lod -o new --size 70000x2", USAGE, "'70000x2' for '--size"),
        ("render good.lod -o new --size 65536x65536", USAGE, "'65536x65536' for '--size"),
        ("render good.lod -o new --size a", USAGE, "'a' for '--size"),
        ("render good.lod -o new --size -8x8", USAGE, "'-8x8' for '--size"),
        ("render good.lod -o new --distance 0", USAGE, "'0' for '--distance"),
        ("render good.lod -o new --distance -2", USAGE, "'-2' for '--distance"),
        ("render good.lod -o new --distance nan", USAGE, "'nan' for '--distance"),
        ("render good.lod -o new --distance 1e300", USAGE, "'1e300' for '--distance"),
        ("render good.lod -o new --eye 1,2", USAGE, "'1,2' for '--eye"),
        ("render good.lod -o new --eye nan,0,0", USAGE, "'nan,0,0' for '--eye"),
        ("render good.lod -o new --target 1e300,0,0", USAGE, "'1e300,0,0' for '--target"),
        ("render good.lod -o new --eye 1,1,1 --target 1,1,1", FAILS, "--eye must be different from --target"),
        ("render good.lod -o new --up 0,0,0", USAGE, "'0,0,0' for '--up"),
        ("render good.lod -o new --method magic", USAGE, "'magic' for '--method"),
        ("render good.lod -o new --leaf-size 3", USAGE, "'3' for '--leaf-size"),
        ("render good.lod -o new --leaf-layout flat", USAGE, "'flat' for '--leaf-layout"),
        ("lines good.lod --distances 2,0", USAGE, "'0' for '--distances"),
        ("lines good.lod --distances -3", USAGE, "'-3' for '--distances"),
        ("lines good.lod --distances ,", USAGE, "'' for '--distances"),
        ("lines good.lod --distances 2 --distance 3", USAGE, "'--distance"),
        ("lines good.lod --delta nan", USAGE, "'nan' for '--delta"),
        ("crack good.lod --rays 0", USAGE, "'0' for '--rays"),
        ("crack good.lod --rays -1", USAGE, "'-1' for '--rays"),
        ("crack good.lod --rays many", USAGE, "'many' for '--rays"),
        ("crack open.lod", FAILS, "open.lod: the model has open borders"),
        ("export good.lod -o new.obj --level 3", FAILS, "--level 3 is beyond good.lod's finest level 2"),
        ("export good.lod -o new.obj --level -1", USAGE, "'-1' for '--level"),
    ]);
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_printed_is_an_error_but_not_for_a_closed_pipe() {
    use std::process::{Command, Stdio};
    for args in ["help", "help simulate", "--version", "unit", "unit --json"] {
        let run = |out: Stdio| {
            let mut command = Command::new(assert_cmd::cargo::cargo_bin!("lodray"));
            command.args(args.split_whitespace()).stdout(out).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap()
        };
        let full = run(fs::File::options().write(true).open("/dev/full").unwrap().into());
        let said = String::from_utf8(full.stderr).unwrap();
        assert_eq!(full.status.code(), Some(FAILS), "{args}: {said}");
        assert!(said.starts_with("error: cannot write to standard output: ") && said.lines().count() == 1, "{args}: {said}");
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let closed = run(writer.into());
        assert!(closed.status.success() && closed.stderr.is_empty(), "{args}");
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_no_scene() {
    let folder = tempfile::tempdir().unwrap();
    let made = std::process::Command::new("mkfifo").arg(folder.path().join("x.lod")).status();
    assert!(made.is_ok_and(|status| status.success()));
    let said = lodray(folder.path(), "info x.lod");
    let words = String::from_utf8(said.stderr).unwrap();
    assert!(said.status.code() == Some(FAILS) && words.contains("x.lod: magic: not a lodray scene file"), "{words}");
}
