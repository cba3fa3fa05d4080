//! The cache of full-resolution BVHs: never more than a shortcut.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// A folder with a scene that is large enough for the cache, to run the program in.
struct Desk(tempfile::TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        desk.run("none", "generate terrain --levels 4 --base 512 -o a.lod");
        desk.run("none", "generate terrain --levels 2 --base 512 -o small.lod");
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Exit code, standard output and standard error, `LODRAY_CACHE` being `cache`.
    fn try_run(&self, cache: &str, args: &str) -> (i32, String, String) {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("lodray");
        command.current_dir(self.0.path()).args(args.split_whitespace()).env("LODRAY_CACHE", cache);
        let output = command.output().unwrap();
        let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        (output.status.code().unwrap(), out, err)
    }

    /// Runs, expects success and silence on standard error.
    fn run(&self, cache: &str, args: &str) -> String {
        let (code, out, err) = self.try_run(cache, args);
        assert_eq!((code, err.as_str()), (0, ""), "{args}: {out}");
        out
    }

    /// All files below `folder` with their contents.
    fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.path(folder)).unwrap().map(|e| e.unwrap());
        entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
    }
}

/// What a command printed, but for how long it took and whether it built anything.
fn figures(printed: &str) -> serde_json::Value {
    let mut document: serde_json::Value = serde_json::from_str(printed).unwrap();
    if let Some(fields) = document.as_object_mut() {
        fields.retain(|name, _| name != "seconds" && name != "cached");
    }
    document
}

const SHOT: &str = "simulate a.lod --method bvh --size 24x16 --json";

#[test]
fn results_are_the_same_with_and_without() {
    let desk = Desk::new();
    for (k, args) in [
        "render a.lod --method bvh --size 40x30 --json -o out",
        "render a.lod --method bvh32 --leaf-layout packed --leaf-size 2 --size 40x30 --json -o out",
        "render a.lod --method bvh --leaf-layout indexed --leaf-size 1 --size 40x30 --json -o out",
        "render a.lod --method bvh6 --size 40x30 --json -o out",
        SHOT,
        "lines a.lod --size 24x16 --distances 1,4 --all --json",
    ]
    .into_iter()
    .enumerate()
    {
        let cache = format!("cache{k}");
        let plain = figures(&desk.run("none", args));
        let pictures = desk.path("out").exists().then(|| desk.files("out"));
        assert!(!desk.path("none").exists());
        for round in 0..2 {
            assert_eq!(figures(&desk.run(&cache, args)), plain, "{args}: {round}");
            assert_eq!(desk.path("out").exists().then(|| desk.files("out")), pictures);
        }
        // Six trees of boxes in frames serve nine layouts, and so do six of 16-bit boxes, and six of 32-bit boxes, and six of nodes of six children; of leaf blocks there are three each.
        assert_eq!(desk.files(&cache).len(), if args.starts_with("lines") { 36 } else { 1 }, "{args}");
    }
}

#[test]
fn trees_are_kept_under_what_they_depend_on() {
    let desk = Desk::new();
    let count = |args: &str, wanted: usize| {
        desk.run("cache", args);
        assert_eq!(desk.files("cache").len(), wanted, "{args}");
    };
    count(SHOT, 1);
    count("render a.lod --method bvh --size 9x9 --leaf-layout line -o out", 2);
    count("render a.lod --method bvh --size 9x9 --leaf-layout packed -o out", 2); // the same tree
    count("render a.lod --method bvh --size 9x9 --leaf-layout indexed -o out", 3);
    count("render a.lod --method bvh32 --size 9x9 -o out", 4);
    count("render a.lod --method bvh --size 9x9 --leaf-size 2 -o out", 5);
    count("render a.lod --method bvh --size 9x9 --node-order treelets -o out", 6);
    count("render a.lod --method bvh6 --size 9x9 -o out", 7);
    // Another name and other colours are the same geometry; another seed is not.
    fs::copy(desk.path("a.lod"), desk.path("b.lod")).unwrap();
    count("render b.lod --method bvh --size 9x9 -o out", 7);
    desk.run("none", "generate terrain --levels 4 --base 512 --seed 5 -o c.lod");
    count("render c.lod --method bvh --size 9x9 -o out", 8);
    // Too small to be worth it, or without a tree.
    count("render small.lod --method bvh --size 9x9 -o out", 8);
    count("render a.lod --size 9x9 -o out", 8);
    // The option goes before the environment.
    desk.run("cache", &format!("{SHOT} --cache other"));
    assert_eq!((desk.files("cache").len(), desk.files("other").len()), (8, 1));
}

#[cfg(unix)]
#[test]
fn a_sound_file_is_read_and_any_other_made_again() {
    use std::os::unix::fs::MetadataExt;
    let desk = Desk::new();
    let plain = desk.run("cache", SHOT);
    let (name, sound) = desk.files("cache").pop_first().unwrap();
    let path = desk.path("cache").join(&name);
    let file = || fs::metadata(&path).unwrap().ino();
    let before = file();
    assert_eq!(desk.run("cache", SHOT), plain);
    assert_eq!(file(), before, "written again");
    let with = |at: usize, byte: u8| {
        let mut bytes = sound.clone();
        bytes[at] ^= byte;
        bytes
    };
    let half = sound[..sound.len() / 2].to_vec();
    let longer = [sound.as_slice(), b"x"].concat();
    for damaged in [
        vec![],
        b"LODRAYBV".to_vec(),
        half,
        longer,
        with(0, 1),
        with(8, 1),
        with(40, 255),
        with(46, 255),
        with(100, 4),
        with(sound.len() - 1, 128),
    ] {
        fs::write(&path, &damaged).unwrap();
        assert_eq!(desk.run("cache", SHOT), plain);
        assert!(fs::read(&path).unwrap() == sound, "{} bytes are left as they were", damaged.len());
    }
    // The tree of another scene under this one's name.
    desk.run("none", "generate terrain --levels 4 --base 512 --seed 5 -o c.lod");
    desk.run("other", &SHOT.replace("a.lod", "c.lod"));
    let (_, foreign) = desk.files("other").pop_first().unwrap();
    assert!(foreign.len().abs_diff(sound.len()) < 100_000);
    fs::write(&path, &foreign).unwrap();
    assert_eq!(desk.run("cache", SHOT), plain);
    // Gone, with its folder.
    fs::remove_dir_all(desk.path("cache")).unwrap();
    assert_eq!(desk.run("cache", SHOT), plain);
    // A folder where the file should be: the run does without, and says so.
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    let (code, out, err) = desk.try_run("cache", SHOT);
    assert_eq!((code, out, err.lines().count()), (0, plain, 1), "{err}");
    assert!(err.starts_with("warning: the BVH is not kept: cannot write cache/"), "{err}");
}

#[test]
fn a_folder_that_cannot_be_is_refused() {
    let desk = Desk::new();
    fs::write(desk.path("file"), "").unwrap();
    for command in [SHOT, "lines a.lod", "render a.lod --method bvh -o out", "sweep jobs.toml -o out"] {
        if command.starts_with("sweep") {
            let list =
                "size = \"8x8\"\ndistances = [2]\nmethods = [\"bvh\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n";
            fs::write(desk.path("jobs.toml"), list).unwrap();
        }
        let (code, _, err) = desk.try_run("none", &format!("{command} --cache file/below"));
        assert!(code == 1 && err.starts_with("error: --cache: cannot make folder file/below: "), "{command}: {err}");
    }
}

#[test]
fn a_cache_within_the_runs_own_folder_is_refused() {
    let desk = Desk::new();
    fs::create_dir(desk.path("there")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("there", desk.path("link")).unwrap();
    let list = "size = \"8x8\"\ndistances = [2]\nmethods = [\"bvh\"]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"packet\"\n";
    fs::write(desk.path("jobs.toml"), list).unwrap();
    for command in ["render a.lod --method bvh --size 8x8", "simulate a.lod --method bvh --size 8x8", "sweep jobs.toml"] {
        for (cache, out) in [("out", "out"), ("./out/deep/er", "out"), ("there/../out", "./out"), ("link/cache", "there")] {
            if cfg!(not(unix)) && cache.starts_with("link") {
                continue;
            }
            let (code, _, err) = desk.try_run("none", &format!("{command} -o {out} --cache {cache}"));
            let says = format!("error: --cache: {cache} is within {out}, which holds what this run makes\n");
            assert_eq!((code, err), (1, says), "{command}");
            assert!(!desk.path("out").exists() && fs::read_dir(desk.path("there")).unwrap().next().is_none(), "{command}");
        }
    }
    // Beside it, or around it, is well.
    desk.run("none", "render a.lod --method bvh --size 8x8 -o kept/out --cache kept");
}
