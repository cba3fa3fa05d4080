//! docs/exactness.md names what checks each of its lemmas: all of it exists, and no lemma goes without.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

fn read(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// What stands between back quotes and has `::` in it.
fn checks(text: &str) -> impl Iterator<Item = (&str, &str)> {
    text.split('`')
        .skip(1)
        .step_by(2)
        .filter_map(|quoted| quoted.split_once("::"))
        .filter(|(_, name)| name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'))
}

fn properties() -> BTreeSet<String> {
    let table: toml::Table = read("rtl/formal/properties.toml").parse().expect("TOML");
    let list = table["property"].as_array().expect("properties");
    list.iter().map(|property| property["name"].as_str().expect("a name").to_owned()).collect()
}

#[test]
fn every_lemma_names_checks_that_exist() {
    let text = read("docs/exactness.md");
    let properties = properties();
    let lemmas: Vec<&str> = text.split("\n### ").skip(1).collect();
    assert!(lemmas.len() >= 14, "{}", lemmas.len());
    for lemma in lemmas {
        let title = lemma.lines().next().unwrap_or_default();
        let found: Vec<_> = checks(lemma).collect();
        assert!(!found.is_empty(), "{title} names no check");
        for (place, name) in found {
            if place == "prove" {
                assert!(properties.contains(name), "{title}: there is no property {name}");
            } else {
                assert!(read(place).contains(&format!("fn {name}(")), "{title}: {place} has no test {name}");
            }
        }
    }
}

#[test]
fn every_property_has_its_place() {
    let text = read("docs/exactness.md");
    let named: BTreeSet<String> = checks(&text).filter(|(place, _)| *place == "prove").map(|(_, name)| name.to_owned()).collect();
    let left: Vec<_> = properties().difference(&named).cloned().collect();
    assert!(left.is_empty(), "no lemma names {left:?}");
}
