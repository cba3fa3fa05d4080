//! What was done of a list of jobs: one line of JSON for each, so that a run that is started again goes on.

use super::fault::fault;
use super::progress::Progress;
use super::words::count;
use crate::format::write_and_rename;
use crate::report::results_version;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A job's line.
pub trait JobLine: Serialize + DeserializeOwned {
    /// Which job: a name that ends with the version of the program's results.
    fn key(&self) -> &str;

    /// The job was done; one that failed is done again.
    fn has_result(&self) -> bool;
}

/// Lines that cannot be kept.
#[derive(Debug, Error)]
pub enum LinesError {
    /// The file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It cannot be written.
    #[error("cannot write {}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It cannot be locked: two runs at once would mix their lines.
    #[error("cannot lock {}", path.display())]
    Lock {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A line that JSON cannot say.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
}

/// The file of lines.
pub struct JobLines<L> {
    path: PathBuf,
    file: File,
    lines: Vec<L>,
}

impl<L: JobLine> JobLines<L> {
    /// Opens the file, or makes it. Lines that are none of a job's, whole, or results of another version of the program, are set aside in files beside it;
    /// what they stood for is done again, and so are jobs that failed.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn open(path: &Path, progress: &dyn Progress) -> Result<Self, LinesError> {
        let shown = path.display();
        let [bad_file, old_file] = aside(path);
        let bytes = if path.exists() { read(path)? } else { Vec::new() };
        let mut rows = Vec::new();
        let (mut bad, mut old) = (Vec::new(), Vec::new());
        let mut dropped = !bytes.is_empty() && !bytes.ends_with(b"\n");
        for (number, line) in (1..).zip(bytes.split(|&byte| byte == b'\n')).filter(|(_, line)| !line.trim_ascii().is_empty()) {
            match serde_json::from_slice::<L>(line) {
                Ok(row) if row.has_result() && is_of_this_version(row.key()) => rows.push(row),
                Ok(row) if row.has_result() => old.push(line),
                Ok(_) => dropped = true,
                Err(why) => bad.push((number, line, why)),
            }
        }
        if let Some((number, _, why)) = bad.first() {
            let others = if bad.len() > 1 { format!(" (and {} more)", bad.len() - 1) } else { String::new() };
            set_aside(&bad_file, bad.iter().map(|of| of.1))?;
            progress.note(&format!(
                "warning: {shown}: line {number}{others} is no result: {} (column {}); set aside in {}, its job is done again",
                fault(why),
                why.column(),
                bad_file.display()
            ));
        }
        if !old.is_empty() {
            let verb = if old.len() > 1 { "are" } else { "is" };
            set_aside(&old_file, old.iter().copied())?;
            progress.note(&format!(
                "note: {shown}: {} {verb} another version's of the program; set aside in {}, their jobs are done again",
                count(old.len(), "result"),
                old_file.display()
            ));
        }
        if dropped || !bad.is_empty() || !old.is_empty() {
            let lines = rows.iter().map(|row| Ok(serde_json::to_string(row)? + "\n")).collect::<Result<String, serde_json::Error>>()?;
            write(path, lines.as_bytes())?;
        }
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.map_err(|source| LinesError::Write { path: path.to_owned(), source })?;
        Ok(Self { path: path.to_owned(), file, lines: rows })
    }

    /// The jobs that are done.
    pub fn done(&self) -> HashSet<String> {
        self.lines.iter().map(|line| line.key().to_owned()).collect()
    }

    /// Adds a line, whole, in one write.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(&mut self, line: L) -> Result<(), LinesError> {
        self.add_all(vec![line])
    }

    /// Adds lines, all in one write.
    ///
    /// # Errors
    /// The file cannot be written; it has none of them then, also where a disk was full in the middle of one.
    pub fn add_all(&mut self, lines: Vec<L>) -> Result<(), LinesError> {
        let text = lines.iter().map(|line| Ok(serde_json::to_string(line)? + "\n")).collect::<Result<String, serde_json::Error>>()?;
        let before = self.file.metadata().map(|of| of.len());
        let write = self.file.write_all(text.as_bytes()).and_then(|()| self.file.sync_data());
        if let Err(source) = write {
            if let Ok(before) = before {
                // What cannot be cut off is set aside by the next run.
                let _ = self.file.set_len(before);
            }
            return Err(LinesError::Write { path: self.path.clone(), source });
        }
        self.lines.extend(lines);
        Ok(())
    }

    /// Those of `keys`, in their order.
    pub fn of<'a>(&'a self, keys: &'a [String]) -> impl Iterator<Item = &'a L> {
        let by_key: HashMap<_, _> = self.lines.iter().map(|line| (line.key(), line)).collect();
        keys.iter().filter_map(move |key| by_key.get(key.as_str()).copied())
    }
}

/// Whether a job's result, by the job's name, is this version's of the program.
pub(super) fn is_of_this_version(key: &str) -> bool {
    key.rsplit_once(' ').is_some_and(|(_, version)| version == results_version())
}

/// The files beside a file of lines that have what were none, and those of other versions of the program: `results.bad.jsonl` and `results.old.jsonl`
/// beside `results.jsonl`.
pub fn aside(path: &Path) -> [PathBuf; 2] {
    ["bad.jsonl", "old.jsonl"].map(|ending| path.with_extension(ending))
}

/// Keeps lines in a file, behind those of before.
fn set_aside<'a>(aside: &Path, lines: impl Iterator<Item = &'a [u8]>) -> Result<(), LinesError> {
    let mut bytes = if aside.exists() { read(aside)? } else { Vec::new() };
    for line in lines {
        bytes.extend_from_slice(line);
        bytes.push(b'\n');
    }
    write(aside, &bytes)
}

fn read(path: &Path) -> Result<Vec<u8>, LinesError> {
    std::fs::read(path).map_err(|source| LinesError::Read { path: path.to_owned(), source })
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), LinesError> {
    write_and_rename(path, |out| out.write_all(bytes)).map_err(|source| LinesError::Write { path: path.to_owned(), source })
}
