//! The record of a run: what was asked for, of what, and which files it made.

use crate::cli::common::Invocation;
use crate::cli::output::write_file;
use anyhow::{Context, anyhow};
use lodray::report::is_file_name;
use lodray::report::page::{RunFacts, RunInput};
use lodray::study::fault_at;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;
use xxhash_rust::xxh3::Xxh3Default;

/// The record's own file.
pub const NAME: &str = "run.json";

/// Of the run to which a folder belongs. The same run gives the same bytes: there is no time in it, and no place.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// Version of the program.
    lodray: String,
    /// Subcommand.
    pub command: String,
    /// Its arguments as given, without those that no file depends on: where they go, what is shown meanwhile, threads.
    arguments: Vec<String>,
    /// Files that were read.
    inputs: Vec<Input>,
    /// What is to be said of the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Files of this folder that belong to the run.
    pub files: BTreeSet<String>,
    /// The run is under way, or was killed: not all of the files are its own, or are there.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unfinished: bool,
}

/// A file that a run has read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    name: String,
    bytes: u64,
    /// 64 bits, hexadecimal; none of a pipe, which can be read but once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    xxh3: Option<String>,
}

impl Input {
    /// The file at `path`, of that name.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let name = path.display().to_string();
        if !std::fs::metadata(path).with_context(|| format!("cannot read {name}"))?.is_file() {
            return Ok(Self { name, bytes: 0, xxh3: None });
        }
        let mut hash = Xxh3Default::new();
        let copied = File::open(path).and_then(|mut file| std::io::copy(&mut file, &mut hash));
        let bytes = copied.with_context(|| format!("cannot read {name}"))?;
        Ok(Self { name, bytes, xxh3: Some(format!("{:016x}", hash.digest())) })
    }
}

impl From<Input> for RunInput {
    fn from(Input { name, bytes, xxh3 }: Input) -> Self {
        Self { name, bytes, xxh3 }
    }
}

impl From<Record> for RunFacts {
    fn from(record: Record) -> Self {
        let Record { lodray, command, arguments, inputs, notes, .. } = record;
        Self { lodray, command, arguments, inputs: inputs.into_iter().map(RunInput::from).collect(), notes }
    }
}

impl Record {
    /// Of a run that has made nothing yet.
    pub fn new(invocation: Invocation, inputs: Vec<Input>) -> Self {
        let Invocation { command, arguments } = invocation;
        let lodray = env!("CARGO_PKG_VERSION").to_owned();
        Self { lodray, command, arguments, inputs, notes: Vec::new(), files: BTreeSet::new(), unfinished: false }
    }

    /// The record in `folder`, if there is one.
    ///
    /// # Errors
    /// There is a file of that name, and it is none.
    pub fn read(folder: &Path) -> anyhow::Result<Option<Self>> {
        let path = folder.join(NAME);
        let text = match std::fs::read_to_string(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            other => other.with_context(|| format!("cannot read {}", path.display()))?,
        };
        let record: Self =
            serde_json::from_str(&text).map_err(|error| anyhow!("{} is not the record of a run: {}", path.display(), fault_at(&error)))?;
        // Files are removed by these names.
        if let Some(name) = record.files.iter().find(|name| !is_own(name)) {
            anyhow::bail!("{} is not the record of a run: '{name}' is not the name of a file in its folder", path.display());
        }
        Ok(Some(record))
    }

    /// Puts it into `folder`.
    pub fn write(&self, folder: &Path) -> anyhow::Result<()> {
        write_file(&folder.join(NAME), serde_json::to_string_pretty(self)? + "\n")
    }
}

/// Whether a name is that of a file beside the record.
fn is_own(name: &str) -> bool {
    is_file_name(name) && name != NAME
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain() {
        for good in ["image.png", "a b.svg", ".hidden", "..."] {
            assert!(is_own(good), "{good}");
        }
        for bad in ["", ".", "..", "../a", "a/b", "/a", "a/", "./a", "a\\b", "C:a", "run.json"] {
            assert!(!is_own(bad), "{bad}");
        }
    }

    #[test]
    fn records_come_back() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Record::read(folder.path()).unwrap().is_none());
        std::fs::write(folder.path().join("a.lod"), b"abc").unwrap();
        let input = Input::read(&folder.path().join("a.lod")).unwrap();
        // XXH3 of "abc" as its reference implementation gives it.
        assert_eq!((input.bytes, input.xxh3.as_deref()), (3, Some("78af5f94892f3950")));
        let mut record = Record::new(Invocation { command: "render".to_owned(), arguments: vec!["a.lod".to_owned()] }, vec![input]);
        record.files.insert("image.png".to_owned());
        record.write(folder.path()).unwrap();
        assert_eq!(Record::read(folder.path()).unwrap(), Some(record.clone()));
        for bad in ["../image.png", "/etc/passwd"] {
            record.files = BTreeSet::from([bad.to_owned()]);
            record.write(folder.path()).unwrap();
            assert!(Record::read(folder.path()).unwrap_err().to_string().contains(bad));
        }
    }
}
