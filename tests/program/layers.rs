//! The house stands: no floor of `src/` uses one above it, and no two files of a folder use each other.
//!
//! What counts is the program's own code; tests within a file may look up. The lists of exceptions can only shrink: one that is no longer needed fails too.

use lodray_test_support::rust::{code, paths, without_tests};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The floors, lowest first: each a module with all below it, but for those that have a line of their own.
const FLOORS: [&str; 24] = [
    "num",
    "block",
    "mesh",
    "format",
    "golden",
    "bvh",
    "step",
    "rays",
    "method",
    "hardware",
    "sim::dram",
    "machine",
    "sim::energy",
    "sim::unit",
    "sim::timing",
    "sim::replay",
    "sim",
    "run",
    "plan",
    "picture",
    "paths",
    "report",
    "scene",
    "lab",
];

/// Arrows upward: who, and the floor that it uses.
const UPWARD: [(&str, &str); 0] = [];

/// What stands apart, and all that it may use.
const APART: (&str, [&str; 2]) = ("golden", ["num", "mesh"]);

/// Files that use each other.
const CIRCLES: [(&str, &str); 0] = [];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All Rust files below `folder`.
fn files(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, all);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            all.push(path);
        }
    }
}

/// A file's module: `format/audit/mod.rs` is `format::audit`.
fn module(file: &Path) -> String {
    let parts = file.strip_prefix(source()).expect("a file of src").with_extension("");
    let names: Vec<_> = parts.iter().map(|part| part.to_string_lossy().into_owned()).filter(|part| part != "mod").collect();
    names.join("::")
}

/// The library's modules, and those that each of them uses.
struct House {
    uses: BTreeMap<String, BTreeSet<String>>,
}

impl House {
    fn new(texts: &BTreeMap<String, String>) -> Self {
        let names: BTreeSet<&str> = texts.keys().map(String::as_str).collect();
        let uses = texts.iter().map(|(name, text)| {
            let text = without_tests(&code(text));
            let used = paths(&text).iter().filter_map(|path| resolved(name, path, &names)).filter(|used| used != name).collect();
            (name.clone(), used)
        });
        Self { uses: uses.collect() }
    }

    fn read() -> Self {
        let mut all = Vec::new();
        files(&source(), &mut all);
        let text = |file: &PathBuf| (module(file), fs::read_to_string(file).expect("a text"));
        let of_library = |name: &String| !["lib", "main", "cli"].contains(&name.split("::").next().unwrap_or_default());
        let is_test = |name: &String| name.split("::").any(|part| part == "tests");
        Self::new(&all.iter().map(text).filter(|(name, _)| of_library(name) && !is_test(name)).collect())
    }

    fn arrows(&self) -> impl Iterator<Item = (&str, &str)> {
        self.uses.iter().flat_map(|(from, used)| used.iter().map(|to| (from.as_str(), to.as_str())))
    }

    /// Arrows upward: who, and the floor.
    fn upward<'a>(&'a self, floors: &'a [&str]) -> BTreeSet<(&'a str, &'a str)> {
        let ups = self.arrows().filter_map(|(from, to)| {
            let (low, high) = (floor(floors, from), floor(floors, to));
            (high > low).then(|| (from, floors[high]))
        });
        ups.collect()
    }

    /// Pairs of files that use each other.
    fn circles(&self) -> BTreeSet<(&str, &str)> {
        self.arrows().filter(|&(from, to)| from < to && self.uses[to].contains(from)).collect()
    }
}

/// The module that a path of `name` leads into; `None` if that is the crate itself.
fn resolved(name: &str, path: &[&str], names: &BTreeSet<&str>) -> Option<String> {
    let mut at: Vec<&str> = if path[0] == "crate" { Vec::new() } else { name.split("::").collect() };
    for part in path {
        match *part {
            "crate" | "self" => (),
            "super" => _ = at.pop(),
            part => at.push(part),
        }
    }
    // An item of a module, or of one that it shows.
    while !at.is_empty() && !names.contains(at.join("::").as_str()) {
        at.pop();
    }
    (!at.is_empty()).then(|| at.join("::"))
}

fn is_within(module: &str, outer: &str) -> bool {
    module.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// The floor of a module: the longest line of the list that names it or what it is in.
fn floor(floors: &[&str], module: &str) -> usize {
    let lines = floors.iter().enumerate().filter(|(_, line)| is_within(module, line));
    lines.max_by_key(|(_, line)| line.len()).unwrap_or_else(|| panic!("{module} has no place in the list of floors")).0
}

#[test]
fn no_floor_uses_one_above() {
    let house = House::read();
    let count = house.arrows().count();
    println!("{count} arrows between {} files", house.uses.len());
    assert!(count > 400 && house.uses.len() > 150, "{count} arrows of {} files", house.uses.len());
    assert_eq!(house.upward(&FLOORS), BTreeSet::from(UPWARD));
}

#[test]
fn what_stands_apart_uses_little() {
    let house = House::read();
    let (apart, allowed) = APART;
    let strange: Vec<_> = house
        .arrows()
        .filter(|(from, to)| is_within(from, apart) && ![apart, allowed[0], allowed[1]].iter().any(|a| is_within(to, a)))
        .collect();
    assert!(strange.is_empty(), "{strange:?}");
}

#[test]
fn no_two_files_use_each_other() {
    assert_eq!(House::read().circles(), BTreeSet::from(CIRCLES));
}

#[test]
fn a_module_with_parts_is_a_folder_with_its_mod_rs() {
    let mut all = Vec::new();
    ["src", "tb", "tests"].iter().for_each(|folder| files(&Path::new(env!("CARGO_MANIFEST_DIR")).join(folder), &mut all));
    let split: Vec<_> = all.iter().filter(|file| file.with_extension("").is_dir()).collect();
    assert!(split.is_empty() && all.len() > 300, "{split:?} of {}", all.len());
}

#[test]
fn the_key_names_every_test() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    // Targets whose files are tests of their own; the others stand in the key by themselves.
    const JOINED: [&str; 5] = ["hits", "hardware", "simulator", "models", "program"];
    let mut found = BTreeSet::new();
    for entry in fs::read_dir(&tests).expect("a folder") {
        let path = entry.expect("an entry").path();
        let Some(name) = path.file_name().map(|name| name.to_string_lossy().into_owned()).filter(|_| path.join("main.rs").is_file()) else {
            continue;
        };
        if JOINED.contains(&name.as_str()) {
            let main = fs::read_to_string(path.join("main.rs")).expect("a list of modules");
            found.extend(main.lines().filter_map(|line| Some(line.strip_prefix("mod ")?.strip_suffix(';')?.to_owned())));
        }
        found.insert(name);
    }
    let key = fs::read_to_string(tests.join("README.md")).expect("the key");
    let name =
        |line: &str| line.strip_prefix("| `").or_else(|| line.strip_prefix("| **`"))?.split_once('`').map(|(name, _)| name.to_owned());
    assert_eq!(key.lines().filter_map(name).collect::<BTreeSet<_>>(), found);
    assert!(found.len() > 40, "{}", found.len());
}

/// Crates that the library alone does without (features of `Cargo.toml`), and the modules besides the program that may use them.
const OF_FEATURES: [(&str, &[&str]); 11] = [
    ("anstream", &[]),
    ("anyhow", &[]),
    ("clap", &[]),
    ("clap_complete", &[]),
    ("clap_mangen", &[]),
    ("etcetera", &[]),
    ("exr", &["paths::open_exr"]),
    ("indicatif", &[]),
    ("plotters", &["report::diagram"]),
    ("resvg", &["report::diagram"]),
    ("terminal_size", &[]),
];

#[test]
fn the_library_does_without_what_the_program_needs() {
    let mut all = Vec::new();
    files(&source(), &mut all);
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    for (name, modules) in OF_FEATURES {
        let is_path = |word: &str| word.strip_prefix(name).is_some_and(|rest| rest.starts_with("::"));
        let knows = |file: &&PathBuf| {
            let text = code(&fs::read_to_string(file).expect("a text"));
            text.split(|c| !is_word(c)).any(is_path)
        };
        let may = |of: &String| of == "main" || is_within(of, "cli") || modules.iter().any(|module| is_within(of, module));
        let (inside, outside): (Vec<String>, Vec<String>) = all.iter().filter(knows).map(|file| module(file)).partition(may);
        assert!(outside.is_empty(), "{outside:?} use {name}");
        assert!(!inside.is_empty(), "{name} is used nowhere");
    }
}

#[test]
fn arrows_are_seen_wherever_they_stand() {
    let text = |name: &str, text: &str| (name.to_owned(), text.to_owned());
    let house = House::new(&BTreeMap::from([
        text("low", "// use crate::high;\nconst TEXT: &str = \"crate::high\"; mod part;"),
        text(
            "low::part",
            "use super::other::Thing;\nfn f<'a>(x: &'a str) -> char { '\"' }\n#[cfg(test)]\nmod tests { use crate::high::In; }",
        ),
        text("low::other", "pub struct Thing(r#\"crate::high \"#, super::part::More);"),
        text("middle", "pub(in crate::high) struct S; use crate::{low::{self, part::{A, B}}, high::deep::Item};\nuse std::fmt;"),
        text("high", "pub(crate) fn f() -> crate::low::Item { super::middle::g() }"),
        text("high::deep", "/* crate::low */ use super::super::low::other as o;"),
    ]));
    let arrows: Vec<_> = house.arrows().collect();
    let wanted = [
        ("high", "low"),
        ("high", "middle"),
        ("high::deep", "low::other"),
        ("low::other", "low::part"),
        ("low::part", "low::other"),
        ("middle", "high::deep"),
        ("middle", "low"),
        ("middle", "low::part"),
    ];
    assert_eq!(arrows, wanted);
    assert_eq!(house.upward(&["low", "middle", "high"]), BTreeSet::from([("middle", "high")]));
    assert_eq!(house.upward(&["low", "high", "middle", "high::deep"]), BTreeSet::from([("high", "middle"), ("middle", "high::deep")]));
    assert_eq!(house.circles(), BTreeSet::from([("low::other", "low::part")]));
}
