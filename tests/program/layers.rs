//! The house stands: no floor of `src/` uses one above it, and no files use each other in a circle.
//!
//! A file uses another if it names an item that the other defines, by whatever imports and re-exports the name comes (`lodray_test_support::house`). So a part that names an
//! item of its folder's `mod.rs` uses that, and a `mod.rs` uses the parts whose items its own code names; one that only shows them (`pub use part::Item`) does not.
//! A circle is a set of files each of which uses all others, directly or by way of others, and likewise a set of parts of one folder, each file or folder in it as a whole.
//! What methods and fields belong to is not known here: only names count.
//!
//! What counts is the program's own code; tests within a file may look up. The lists of exceptions can only shrink: one that is no longer needed fails too.

use lodray_test_support::house::{House, is_within};
use lodray_test_support::rust::code;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The floors, lowest first: each a module with all below it, but for those that have a line of their own.
const FLOORS: [&str; 25] = [
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
    "study",
    "lab",
];

/// Arrows upward: who, and the floor that it uses.
const UPWARD: [(&str, &str); 0] = [];

/// What stands apart, and all that it may use.
const APART: (&str, [&str; 2]) = ("golden", ["num", "mesh"]);

/// Files that use each other in a circle.
const CIRCLES: [&[&str]; 0] = [];

/// Parts of folders that do, but stand in the list of floors one by one.
const CIRCLES_OF_PARTS: [(&str, &[&str]); 1] = [("", &["machine", "sim"])];

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
    let names: Vec<_> =
        parts.iter().map(|part| part.to_string_lossy().into_owned()).filter(|part| part != "mod" && part != "lib").collect();
    names.join("::")
}

/// All of `src/` but tests: library and program are one crate here, whose root is the empty name.
fn read() -> House {
    let mut all = Vec::new();
    files(&source(), &mut all);
    let text = |file: &PathBuf| (module(file), fs::read_to_string(file).expect("a text"));
    let is_test = |name: &String| name.split("::").any(|part| part == "tests");
    House::new(&all.iter().map(text).filter(|(name, _)| !is_test(name)).collect())
}

/// Arrows between modules of the library.
fn library(house: &House) -> impl Iterator<Item = (&str, &str)> {
    let is_program = |name: &str| name == "main" || is_within(name, "cli");
    house.arrows().filter(move |(from, _)| !is_program(from))
}

/// Arrows upward: who, and the floor.
fn upward<'a>(arrows: impl Iterator<Item = (&'a str, &'a str)>, floors: &[&'a str]) -> BTreeSet<(&'a str, &'a str)> {
    let ups = arrows.filter_map(|(from, to)| {
        let (low, high) = (floor(floors, from), floor(floors, to));
        (high > low).then(|| (from, floors[high]))
    });
    ups.collect()
}

/// The floor of a module: the longest line of the list that names it or what it is in.
fn floor(floors: &[&str], module: &str) -> usize {
    let lines = floors.iter().enumerate().filter(|(_, line)| is_within(module, line));
    lines.max_by_key(|(_, line)| line.len()).unwrap_or_else(|| panic!("{module} has no place in the list of floors")).0
}

#[test]
fn no_floor_uses_one_above() {
    let house = read();
    let count = library(&house).count();
    println!("{count} arrows between files of the library, {} files in all", house.files());
    assert!(count > 400 && house.files() > 400, "{count} arrows, {} files", house.files());
    assert_eq!(upward(library(&house), &FLOORS), BTreeSet::from(UPWARD));
}

#[test]
fn what_stands_apart_uses_little() {
    let house = read();
    let (apart, allowed) = APART;
    let strange: Vec<_> = library(&house)
        .filter(|(from, to)| is_within(from, apart) && ![apart, allowed[0], allowed[1]].iter().any(|a| is_within(to, a)))
        .collect();
    assert!(strange.is_empty(), "{strange:?}");
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let house = read();
    assert_eq!(house.circles(), CIRCLES.iter().map(|set| set.to_vec()).collect());
    assert_eq!(house.circles_of_parts(), CIRCLES_OF_PARTS.iter().map(|(folder, set)| ((*folder).to_owned(), set.to_vec())).collect());
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
    const JOINED: [&str; 6] = ["hits", "hardware", "simulator", "models", "fuzz", "program"];
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
    ("exr", &["mesh::displace::open_exr", "paths::open_exr"]),
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

/// A house of modules and their texts.
fn house<const N: usize>(texts: [(&str, &str); N]) -> House {
    House::new(&texts.map(|(name, text)| (name.to_owned(), text.to_owned())).into())
}

#[test]
fn arrows_are_seen_wherever_they_stand() {
    let house = house([
        ("", "pub mod low; pub mod middle; pub mod high;"),
        ("low", "// use crate::high;\nconst TEXT: &str = \"crate::high::f\"; pub mod part; pub mod other; pub struct Own;"),
        (
            "low::part",
            "use super::other::Thing;\npub struct A; pub struct More;\nfn f<'a>(x: &'a Thing) -> char { '\"' }\n#[cfg(test)]\nmod tests { use crate::high::In; }",
        ),
        ("low::other", "pub struct Thing(super::part::More); fn g(part: u32) -> u32 { assert_eq!(part, crate::high::deep::ITEM.x); part }"),
        (
            "middle",
            "pub(in crate::high) struct S; use crate::{low::{self, part::{A}}, high::deep::*};\nuse std::fmt; fn g(a: A) { low::other::Thing; Item { a } }",
        ),
        ("high", "pub mod deep; wire! { pub struct In { x: u32 } } pub(crate) fn f() -> crate::low::Own { super::middle::S }"),
        (
            "high::deep",
            "/* crate::low */ pub struct Item; pub static ITEM: Item = Item; use super::super::low::other::Thing as o; #[serde(with = \"super::f\")] struct T;",
        ),
    ]);
    let arrows: Vec<_> = house.arrows().collect();
    let wanted = [
        ("high", "low"),
        ("high", "middle"),
        ("high::deep", "high"),
        ("high::deep", "low::other"),
        ("low::other", "high::deep"),
        ("low::other", "low::part"),
        ("low::part", "low::other"),
        ("middle", "high::deep"),
        ("middle", "low::other"),
        ("middle", "low::part"),
    ];
    assert_eq!(arrows, wanted);
    let up = |floors: &[&'static str]| upward(house.arrows(), floors);
    assert_eq!(up(&["low", "middle", "high"]), BTreeSet::from([("low::other", "high"), ("middle", "high")]));
}

#[test]
fn circles_of_any_length_are_found_through_what_others_show() {
    // Each shows what the next defines, and names it by the folder that shows it again.
    let two = house([
        ("", "pub mod a; pub mod b; pub use a::A as Shown; pub use b::*;"),
        ("a", "pub struct A(crate::B);"),
        ("b", "pub struct B; fn f(_: super::Shown) {}"),
    ]);
    assert_eq!(two.circles(), BTreeSet::from([vec!["a", "b"]]));
    let three = house([
        ("folder", "mod a; mod b; mod c; pub use a::A; pub use b::B; pub use c::C;"),
        ("folder::a", "use super::B; pub struct A(B);"),
        ("folder::b", "pub struct B(super::C);"),
        ("folder::c", "pub enum C { None } fn f() -> usize { size_of::<super::A>() }"),
    ]);
    assert_eq!(three.circles(), BTreeSet::from([vec!["folder::a", "folder::b", "folder::c"]]));
    // A folder's own file and a part of it.
    let part = house([("folder", "mod part; pub struct Own; fn f() { part::g() }"), ("folder::part", "pub fn g() { super::Own; }")]);
    assert_eq!(part.circles(), BTreeSet::from([vec!["folder", "folder::part"]]));
    let shows = house([("folder", "mod part; pub struct Own; pub use part::g;"), ("folder::part", "pub fn g() { super::Own; }")]);
    assert_eq!(shows.circles(), BTreeSet::new());
    // Two folders, though no two of their files.
    let folders = house([
        ("", "mod a; mod b;"),
        ("a", "pub mod low; pub mod high;"),
        ("a::low", "pub struct A;"),
        ("a::high", "use crate::b::B; fn f(_: B) {}"),
        ("b", "use super::a::low::A; pub struct B(A);"),
    ]);
    assert_eq!((folders.circles(), folders.circles_of_parts()), (BTreeSet::new(), BTreeSet::from([(String::new(), vec!["a", "b"])])));
}
