//! Finds what can be mutated in Rust files, and writes files that hold many mutants at once, one of which the environment variable `LODRAY_MUTANT` chooses
//! when the program runs: one build for all. `scripts/mutate --rust` draws them and runs the tests.
//!
//! `mutants list FILE...` prints every site as a line of JSON. `mutants write ROOT` reads chosen sites as JSON, `{"FILE": [[number of the site, number of the
//! mutant], ...]}`, and rewrites these files below ROOT.

mod find;
mod rewrite;
mod rules;
mod site;

use anyhow::{Context, Result, bail};
use serde::Serialize;
use site::Site;
use std::collections::BTreeMap;
use std::path::Path;
use std::{fs, io};

/// A site as it is printed.
#[derive(Serialize)]
struct Listed<'a> {
    file: &'a str,
    /// Its number in the file.
    site: usize,
    line: usize,
    rule: &'static str,
    /// What is replaced, without numbers: sites that are alike.
    alike: &'a str,
    /// Its first line as it is, and as mutated.
    before: String,
    after: String,
}

fn read(path: &Path) -> Result<(String, Vec<Site>)> {
    let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let sites = find::sites(&text).with_context(|| path.display().to_string())?;
    Ok((text, sites))
}

fn list(files: &[String]) -> Result<()> {
    for file in files {
        let (text, sites) = read(Path::new(file))?;
        for (number, site) in sites.iter().enumerate() {
            let (before, after) = site.lines(&text);
            let listed = Listed { file, site: number, line: site.line(&text), rule: site.rule, alike: site.alike(&text), before, after };
            println!("{}", serde_json::to_string(&listed)?);
        }
    }
    Ok(())
}

fn write(root: &Path) -> Result<()> {
    let chosen: BTreeMap<String, Vec<(usize, u32)>> = serde_json::from_reader(io::stdin())?;
    for (file, numbers) in chosen {
        let path = root.join(&file);
        let (text, sites) = read(&path)?;
        let mut mutants = Vec::new();
        for (number, mutant) in numbers {
            let site = sites.get(number).with_context(|| format!("{file} has no site {number}"))?;
            mutants.push((mutant, site.clone()));
        }
        fs::write(&path, rewrite::rewritten(&text, &mutants)).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.split_first() {
        Some((command, files)) if command == "list" => list(files),
        Some((command, [root])) if command == "write" => write(Path::new(root)),
        _ => bail!("usage: mutants list FILE... | mutants write ROOT"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_golden_traverser_are_programs_with_all_their_mutants_in_them() {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../src");
        let mut count = 0;
        for folder in ["block", "golden"] {
            for entry in fs::read_dir(source.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                if path.is_file() {
                    let (text, sites) = read(&path).unwrap();
                    count += sites.len();
                    let all: Vec<_> = (1..).zip(sites).collect();
                    syn::parse_file(&rewrite::rewritten(&text, &all)).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                }
            }
        }
        assert!(count > 1000, "{count}");
    }
}
