//! One page that shows results: it fetches nothing, and every figure in it is one of the documents it was made of.
//!
//! `web` has its parts: a shell, a style, and scripts, which stand in the page one behind the other; `vendor` the chart library that they use. The figures stand in
//! the page as JSON, deflated, in base64; pictures as JPEG in base64.

mod documents;
mod ledger;
mod pictures;
mod stability;

pub use documents::{DocumentFacts, Documents, ImageFigures, RunFacts, RunInput, Simulation};
pub use ledger::{Ledger, ledger};
pub use pictures::{Embedded, PICTURE_BYTES, PictureFault, embed};
pub use stability::{Hunted, StabilityCase, StabilityReport, StabilityTally};

use super::error_time::{COSTS, ERRORS, ErrorTime, verdicts};
use super::palette;
use crate::method::METHODS;
use crate::picture::{HOTTEST, level_colour};
use crate::step::NodeShape;
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Write};
use xxhash_rust::xxh3::xxh3_64;

const SHELL: &str = include_str!("web/shell.html");
const STYLE: &str = include_str!("web/style.css");
/// In the order in which they stand in the page.
const SCRIPTS: [&str; 12] = [
    include_str!("web/base.js"),
    include_str!("web/points.js"),
    include_str!("web/chart.js"),
    include_str!("web/work.js"),
    include_str!("web/limits.js"),
    include_str!("web/distance.js"),
    include_str!("web/verdict.js"),
    include_str!("web/machine.js"),
    include_str!("web/frames.js"),
    include_str!("web/pictures.js"),
    include_str!("web/tables.js"),
    include_str!("web/main.js"),
];
/// The chart library, with the texts of its licences.
const VENDOR: [[&str; 2]; 2] = [
    [include_str!("vendor/d3.LICENSE"), include_str!("vendor/d3.min.js")],
    [include_str!("vendor/plot.LICENSE"), include_str!("vendor/plot.umd.min.js")],
];

/// Names of levels that a legend can have.
const LEVELS: u32 = 11;

/// The page.
///
/// # Errors
/// A document that is no JSON: one with numbers that are not finite.
pub fn page(documents: &Documents) -> io::Result<String> {
    let mut blocks = block("data", &data(documents)?)?;
    let traces = documents.error_time.as_ref().map_or(&[][..], |document| &document.traces);
    if !traces.is_empty() {
        blocks += &block("traces", &serde_json::to_value(traces)?)?;
    }
    for picture in &documents.pictures {
        blocks += &format!("<script type=\"text/plain\" id=\"{}\">{}</script>\n", picture.id, BASE64.encode(&picture.jpeg));
    }
    let vendor = VENDOR.map(|[licence, script]| format!("/*\n{}\n*/\n{}", licence.trim(), script.trim())).join("\n");
    // The larger parts last: what they hold is not looked through for names of others.
    let parts = [
        ("program", escaped(&program())),
        ("template", template()),
        ("title", escaped(&documents.title)),
        ("style", STYLE.trim().to_owned()),
        ("vendor", vendor),
        ("scripts", SCRIPTS.concat()),
        ("blocks", blocks),
    ];
    Ok(filled(SHELL, &parts))
}

/// Checksum of everything in a page but its figures: 64 bits, hexadecimal. Pages of one template look alike.
pub fn template() -> String {
    let colours = METHODS.iter().map(|method| format!("{:?}", palette::of(method.name))).collect::<String>();
    let colours = format!("{colours}{:?}{:?}", palette::PARTS, palette::SECTIONS);
    let parts = [SHELL, STYLE, &colours].into_iter().chain(SCRIPTS).chain(VENDOR.into_iter().flatten());
    format!("{:016x}", xxh3_64(parts.collect::<String>().as_bytes()))
}

/// `shell` with its `{{names}}` replaced; what is put in is taken as it is.
fn filled(shell: &str, parts: &[(&str, String)]) -> String {
    let mut text = String::with_capacity(shell.len() + parts.iter().map(|part| part.1.len()).sum::<usize>());
    let mut rest = shell;
    while let Some((before, after)) = rest.split_once("{{") {
        let Some((name, after)) = after.split_once("}}") else { break };
        text += before;
        text += parts.iter().find(|part| part.0 == name).map_or("", |part| part.1.as_str());
        rest = after;
    }
    text + rest
}

/// Name and version of the program.
fn program() -> String {
    format!("lodray {}", super::version::results_version())
}

/// What the scripts read.
fn data(documents: &Documents) -> io::Result<Value> {
    let error_time =
        documents.error_time.as_ref().map(|document| ErrorTime { traces: Vec::new(), pictures: Vec::new(), ..document.clone() });
    let mut names: BTreeSet<&str> = METHODS.iter().map(|method| method.name).chain(["full"]).collect();
    names.extend(error_time.iter().flat_map(|document| document.points.iter().map(|point| point.method.as_str())));
    names.extend(documents.simulations.iter().map(|simulation| simulation.result.setup.method.name.as_str()));
    let methods: BTreeMap<_, _> = names.into_iter().map(|name| (name, palette::of(name))).collect();
    let parts = palette::PARTS.map(|(name, light, dark)| json!({ "name": name, "light": light, "dark": dark }));
    let sections = palette::SECTIONS.map(|(name, light, dark)| json!({ "name": name, "light": light, "dark": dark }));
    let things: BTreeMap<_, _> = palette::things().map(|(name, part, hatch)| (name, json!([palette::PARTS[part].0, hatch]))).collect();
    let levels: Vec<_> = (0..LEVELS).map(|level| level_colour(level, 0.7).0).collect();
    Ok(json!({
        "title": documents.title,
        "program": program(),
        "palette": { "methods": methods, "parts": parts, "sections": sections, "things": things, "levels": levels, "hottest": HOTTEST },
        "measures": measures(),
        "shapes": shapes(),
        "verdicts": error_time.as_ref().map_or_else(Vec::new, verdicts),
        "error_time": serde_json::to_value(&error_time)?,
        "simulations": serde_json::to_value(&documents.simulations)?,
        "stability": serde_json::to_value(&documents.stability)?,
        "ledger": serde_json::to_value(&documents.ledger)?,
        "runs": serde_json::to_value(&documents.runs)?,
        "documents": serde_json::to_value(&documents.documents)?,
        "pictures": serde_json::to_value(&documents.pictures)?,
    }))
}

/// Kinds of nodes by their letters: children, and what bounds them.
fn shapes() -> BTreeMap<char, Value> {
    NodeShape::ALL.map(NodeShape::facts).map(|facts| (facts.letter, json!([facts.children, facts.words]))).into()
}

/// What errors and costs of equal-error tables are called.
fn measures() -> BTreeMap<&'static str, &'static str> {
    ERRORS.iter().map(|error| (error.id, error.name)).chain(COSTS.iter().map(|cost| (cost.id, cost.name))).collect()
}

/// A block of the page that no browser runs: JSON, deflated, in base64.
fn block(id: &str, value: &impl Serialize) -> io::Result<String> {
    let mut deflate = ZlibEncoder::new(Vec::new(), Compression::best());
    deflate.write_all(&serde_json::to_vec(value)?)?;
    Ok(format!("<script type=\"text/plain\" id=\"{id}\">{}</script>\n", BASE64.encode(deflate.finish()?)))
}

/// Text in HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_in_is_taken_as_it_is() {
        let parts = [("a", "{{b}}".to_owned()), ("b", "x".to_owned())];
        assert_eq!(filled("1 {{a}} 2 {{b}} 3 {{none}}.", &parts), "1 {{b}} 2 x 3 .");
    }

    #[test]
    fn titles_are_text() {
        let page = page(&Documents { title: "a<b>&\"c\"</title>".to_owned(), ..Documents::default() }).unwrap();
        assert!(page.contains("<title>a&lt;b&gt;&amp;&quot;c&quot;&lt;/title&gt;</title>"));
        // One that ends a script would end it.
        for script in SCRIPTS.iter().chain(VENDOR.iter().flatten()) {
            assert!(!script.contains("</script") && !script.contains("<!--"));
        }
    }
}
