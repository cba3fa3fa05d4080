//! Results of every kind, read from their files.

use crate::cli::bars::Bars;
use crate::cli::folder::{Input, Record};
use crate::cli::output::{busy, read_text, remark};
use anyhow::{Context, ensure};
use lodray::report::error_time::{ErrorTime, KIND};
use lodray::report::page::{DocumentFacts, Documents, PICTURE_BYTES, RunInput, embed, ledger};
use lodray::study::{fault_at, results};
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// What the files hold, with the records of the runs that made them.
pub fn documents(paths: &[&Path]) -> anyhow::Result<Documents> {
    let mut all = Documents::default();
    let mut files: Vec<PathBuf> = Vec::new();
    for path in paths {
        add(&mut all, &mut files, path)?;
        let Some(name) = path.file_name().map(|name| name.to_string_lossy().into_owned()) else { continue };
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        // A record that is none is no reason to have no page.
        if let Some(record) = Record::read(folder).ok().flatten().filter(|record| record.files.contains(&name)) {
            let run = record.into();
            if !all.runs.contains(&run) {
                all.runs.push(run);
            }
        }
    }
    // Where two files have the same name, show their folders too.
    let names: Vec<_> = all.documents.iter().map(|document| document.name.clone()).collect();
    for (document, path) in all.documents.iter_mut().zip(paths) {
        if let Some(folder) = path.parent().and_then(Path::file_name)
            && names.iter().filter(|name| **name == document.name).count() > 1
        {
            document.name = format!("{}/{}", folder.to_string_lossy(), document.name);
        }
    }
    if let Some(document) = &all.error_time {
        if document.program.contains(" and ") {
            remark(&format!("results of several versions stand side by side: {}", document.program))?;
        }
        let pictures: Vec<_> = document.pictures.iter().cloned().zip(files).collect();
        all.pictures = busy("pictures", || embed(&pictures, PICTURE_BYTES))?;
    }
    Ok(all)
}

/// Adds what a file holds; `files` are those of the pictures.
fn add(all: &mut Documents, files: &mut Vec<PathBuf>, path: &Path) -> anyhow::Result<()> {
    let shown = path.display();
    let text = read_text(path)?;
    let kind = if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("md")) {
        let tables = ledger(&text);
        ensure!(!tables.is_empty(), "{shown}: there is no table in it");
        all.ledger.extend(tables);
        "claims"
    } else {
        match Kind::of(&text) {
            Kind::ErrorTime => {
                let document: ErrorTime = parsed(&text, path, "no result of error-time")?;
                document.check().map_err(|why| anyhow::anyhow!("{shown}: {why}"))?;
                let folder = path.parent().unwrap_or(Path::new(""));
                for (_, file) in document.picture_files(folder) {
                    ensure!(file.is_file(), "{shown}: there is no picture {}", file.display());
                    files.push(file);
                }
                all.error_time = Some(match all.error_time.take() {
                    Some(before) => before.join(document).map_err(|why| anyhow::anyhow!("{shown}: {why}"))?,
                    None => document,
                });
                "error against cost"
            }
            Kind::Stability => {
                all.stability.push(parsed(&text, path, "no report of stability")?);
                "stability"
            }
            Kind::Results => {
                let found = results(&text, &shown.to_string(), &Bars).with_context(|| format!("{shown}: not results of a simulation"))?;
                all.simulations.extend(found.into_iter().flatten());
                "simulations"
            }
        }
    };
    let RunInput { name, bytes, xxh3 } = Input::read(path)?.into();
    let name = Path::new(&name).file_name().map_or(name.clone(), |name| name.to_string_lossy().into_owned());
    all.documents.push(DocumentFacts { kind: kind.to_owned(), name, bytes, xxh3: xxh3.unwrap_or_default() });
    Ok(())
}

fn parsed<T: DeserializeOwned>(text: &str, path: &Path, not: &str) -> anyhow::Result<T> {
    serde_json::from_str(text).map_err(|error| anyhow::anyhow!("{}: {not}: {}", path.display(), fault_at(&error)))
}

/// What a JSON file holds.
enum Kind {
    ErrorTime,
    Stability,
    /// Of simulations; what is none of these is refused as such.
    Results,
}

impl Kind {
    fn of(text: &str) -> Self {
        let value: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
        match value.get("kind").and_then(|kind| kind.as_str()) {
            Some(KIND) => Self::ErrorTime,
            _ if value.get("widths_checked").is_some() => Self::Stability,
            _ => Self::Results,
        }
    }
}
