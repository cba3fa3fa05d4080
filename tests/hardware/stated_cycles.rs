//! What the documents say of a block's cycles is what the table of rtl/README.md says, which `tests/hardware/mirror.rs` holds against Rust and RTL.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Latency and interval by block.
fn table() -> BTreeMap<String, [u32; 2]> {
    let readme = fs::read_to_string(root().join("rtl/README.md")).expect("rtl/README.md");
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [name, _, latency, interval] = cells[..] else { return None };
        let name = name.strip_prefix('`')?.strip_suffix('`')?;
        Some((name.to_owned(), [latency.parse().ok()?, interval.parse().ok()?]))
    };
    readme.lines().filter_map(row).collect()
}

/// Cycles that `text` states of blocks: "`block`", a few words, "N cycles".
fn stated(text: &str) -> Vec<(&str, u32)> {
    let parts: Vec<&str> = text.split('`').collect();
    let mut all = Vec::new();
    for pair in parts[1..].chunks_exact(2) {
        let (name, behind) = (pair[0], pair[1].split(['.', ',', ';', '|', '\n']).next().unwrap_or_default());
        let words: Vec<&str> = behind.split_whitespace().collect();
        let numbers = words.windows(2).filter(|two| two[1].trim_end_matches(')').trim_end_matches('s') == "cycle");
        all.extend(numbers.filter_map(|two| Some((name, two[0].trim_start_matches('(').parse().ok()?))));
    }
    all
}

fn documents() -> Vec<PathBuf> {
    let mut all = vec![root().join("README.md")];
    for folder in ["docs", "scripts/paper", "rtl", "tb"] {
        let entries = fs::read_dir(root().join(folder)).expect("a folder").map(|entry| entry.expect("an entry").path());
        all.extend(entries.filter(|path| path.extension().is_some_and(|ending| ending == "md")));
    }
    all
}

#[test]
fn cycles_of_blocks_are_those_of_the_table() {
    let table = table();
    assert_eq!(table.len(), 26, "{table:?}");
    let mut compared = 0;
    for path in documents() {
        let text = fs::read_to_string(&path).expect("a text");
        for (name, cycles) in stated(&text) {
            let Some(timing) = table.get(name) else { continue };
            assert!(timing.contains(&cycles), "{}: `{name}` takes {timing:?} cycles (latency, interval), not {cycles}", path.display());
            compared += 1;
        }
    }
    assert!(compared >= 4, "only {compared} places state cycles");
}

#[test]
fn statements_are_found() {
    let text = "`a` divides for 27 cycles, and `b` (3 cycles) and `c` 22; `d` one. In 5 cycles `e`\ntakes 7 cycles; `f` waits 1 cycle";
    assert_eq!(stated(text), [("a", 27), ("b", 3), ("f", 1)]);
}
