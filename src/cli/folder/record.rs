//! The record of a run: what was asked for, of what, and which files it made.

use crate::cli::common::Invocation;
use crate::cli::output::write_file;
use anyhow::{Context, anyhow};
use lodray::report::page::{RunFacts, RunInput};
use lodray::study::fault_at;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Component, Path};
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
    /// 64 bits, hexadecimal.
    xxh3: String,
}

impl Input {
    /// The file at `path`, of that name.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let mut hash = Xxh3Default::new();
        let copied = File::open(path).and_then(|mut file| std::io::copy(&mut file, &mut hash));
        let bytes = copied.with_context(|| format!("cannot read {}", path.display()))?;
        Ok(Self { name: path.display().to_string(), bytes, xxh3: format!("{:016x}", hash.digest()) })
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
        if let Some(name) = record.files.iter().find(|name| !is_plain(name)) {
            anyhow::bail!("{} is not the record of a run: '{name}' is not the name of a file in its folder", path.display());
        }
        Ok(Some(record))
    }

    /// Puts it into `folder`.
    pub fn write(&self, folder: &Path) -> anyhow::Result<()> {
        write_file(&folder.join(NAME), serde_json::to_string_pretty(self)? + "\n")
    }
}

/// Whether a name is that of a file beside the record, on every system.
fn is_plain(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    let is_one = matches!((parts.next(), parts.next()), (Some(Component::Normal(part)), None) if part == name);
    is_one && !name.contains(['/', '\\', ':', '\0']) && name != NAME
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain() {
        for good in ["image.png", "a b.svg", ".hidden", "..."] {
            assert!(is_plain(good), "{good}");
        }
        for bad in ["", ".", "..", "../a", "a/b", "/a", "a/", "./a", "a\\b", "C:a", "run.json"] {
            assert!(!is_plain(bad), "{bad}");
        }
    }

    #[test]
    fn records_come_back() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Record::read(folder.path()).unwrap().is_none());
        std::fs::write(folder.path().join("a.lod"), b"abc").unwrap();
        let input = Input::read(&folder.path().join("a.lod")).unwrap();
        // XXH3 of "abc" as its reference implementation gives it.
        assert_eq!((input.bytes, input.xxh3.as_str()), (3, "78af5f94892f3950"));
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
