//! docs/exactness.md names what checks each of its lemmas: all of it exists and asserts something, and no lemma goes without. Each rounding of the numbers
//! is called by a test that asserts.

use lodray_test_support::rust::{body, calls, code, without_tests};
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
                let text = code(&read(place));
                assert!(body(&text, name).is_some(), "{title}: {place} has no test {name}");
                assert!(asserts(&text, name), "{title}: {place}: {name} asserts nothing");
            }
        }
    }
}

/// Whether function `name` of `text` asserts: itself, or in a function of the same text that it calls, however deep.
fn asserts(text: &str, name: &str) -> bool {
    fn reach<'a>(text: &'a str, name: &'a str, seen: &mut BTreeSet<&'a str>) -> bool {
        let Some(body) = body(text, name).filter(|_| seen.insert(name)) else { return false };
        let is_assertion = |call: &str| {
            let name = call.strip_prefix("prop_").unwrap_or(call);
            ["assert!", "assert_eq!", "assert_ne!", "panic!"].contains(&name)
        };
        calls(body).any(|call| is_assertion(call) || reach(text, call, seen))
    }
    reach(text, name, &mut BTreeSet::new())
}

#[test]
fn each_rounding_is_called_by_a_test_that_asserts() {
    let mut count = 0;
    for file in ["src/num/round.rs", "src/num/displacement.rs", "src/num/step.rs"] {
        let text = code(&read(file));
        let program = without_tests(&text);
        let names = |text: &str, before: &str| -> BTreeSet<String> {
            text.match_indices(before)
                .map(|(at, _)| text[at + before.len()..].chars().take_while(|&c| c == '_' || c.is_alphanumeric()).collect())
                .collect()
        };
        let roundings: BTreeSet<String> = names(&program, "\npub fn ").union(&names(&program, "\npub const fn ")).cloned().collect();
        count += roundings.len();
        let tests: Vec<String> =
            names(&text, "fn ").difference(&names(&program, "fn ")).filter(|name| asserts(&text, name)).cloned().collect();
        let called: BTreeSet<&str> = tests.iter().flat_map(|test| calls(body(&text, test).unwrap_or_default())).collect();
        let left: Vec<_> = roundings.iter().filter(|name| !called.contains(name.as_str())).collect();
        assert!(left.is_empty(), "no test of {file} that asserts calls {left:?}");
    }
    assert!(count >= 12, "{count}");
}

#[test]
fn a_test_that_asserts_nothing_is_seen() {
    let text = code(
        r#"
        fn empty() {}
        fn silent() { let wrong = 1 + 1; helper_without(wrong); println!("assert!(true)"); }
        fn commented() { /* assert!(false); */ // assert_eq!(1, 2)
        }
        fn direct(x in 0u32..4) { prop_assert_eq!(x, x); }
        fn indirect() { for _ in 0..3 { Bench::new().outer::<u8>(1); } }
        fn by_helper<'a, T: Fn(&'a str)>(f: T) -> Vec<[u8; 2]> { (0..4).map(|k| middle(k)).collect() }
        fn middle(k: u32) { inner(k, '}') }
        fn inner(k: u32, _: char) { assert_ne!(k, 7, "{}", '{'); }
        fn helper_without(_: u32) { helper_without(1) }
        fn panics() { let Some(_) = None::<u8> else { panic!("none") }; }
        fn assert_like() { let assert = 3; assertion(assert); }
        fn declared(k: u32);
        "#,
    );
    for (name, wanted) in [
        ("empty", false),
        ("silent", false),
        ("commented", false),
        ("direct", true),
        ("indirect", false),
        ("by_helper", true),
        ("middle", true),
        ("inner", true),
        ("helper_without", false),
        ("panics", true),
        ("assert_like", false),
        ("declared", false),
        ("missing", false),
    ] {
        assert_eq!(asserts(&text, name), wanted, "{name}");
    }
    assert_eq!(body(&text, "empty"), Some("{}"));
    assert!(body(&text, "declared").is_none() && body(&text, "missing").is_none());
}

#[test]
fn every_property_has_its_place() {
    let text = read("docs/exactness.md");
    let named: BTreeSet<String> = checks(&text).filter(|(place, _)| *place == "prove").map(|(_, name)| name.to_owned()).collect();
    let left: Vec<_> = properties().difference(&named).cloned().collect();
    assert!(left.is_empty(), "no lemma names {left:?}");
}
