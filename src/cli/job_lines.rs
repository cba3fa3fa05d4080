//! What was done of a list of jobs: one line of JSON for each, so that a run that is started again goes on.

use super::folder::RunFolder;
use super::json::fault;
use super::output::{count, warn, write_file};
use anyhow::Context;
use lodray::report::results_version;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::{HashMap, HashSet};
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// A job's line.
pub trait JobLine: Serialize + DeserializeOwned {
    /// Which job: a name that ends with the version of the program's results.
    fn key(&self) -> &str;

    /// The job was done; one that failed is done again.
    fn has_result(&self) -> bool;
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
    pub fn open(path: &Path) -> anyhow::Result<Self> {
        let shown = path.display();
        let [bad_file, old_file] = aside(path);
        let bytes = if path.exists() { std::fs::read(path).with_context(|| format!("cannot read {shown}"))? } else { Vec::new() };
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
            warn(&format!(
                "warning: {shown}: line {number}{others} is no result: {} (column {}); set aside in {}, its job is done again",
                fault(why),
                why.column(),
                bad_file.display()
            ));
        }
        if !old.is_empty() {
            let verb = if old.len() > 1 { "are" } else { "is" };
            set_aside(&old_file, old.iter().copied())?;
            warn(&format!(
                "note: {shown}: {} {verb} another version's of the program; set aside in {}, their jobs are done again",
                count(old.len(), "result"),
                old_file.display()
            ));
        }
        if dropped || !bad.is_empty() || !old.is_empty() {
            let lines = rows.iter().map(|row| Ok(serde_json::to_string(row)? + "\n")).collect::<anyhow::Result<String>>()?;
            write_file(path, lines)?;
        }
        let file = OpenOptions::new().create(true).append(true).open(path).with_context(|| format!("cannot write {shown}"))?;
        Ok(Self { path: path.to_owned(), file, lines: rows })
    }

    /// The jobs that are done.
    pub fn done(&self) -> HashSet<String> {
        self.lines.iter().map(|line| line.key().to_owned()).collect()
    }

    /// Adds a line, whole, in one write.
    pub fn add(&mut self, line: L) -> anyhow::Result<()> {
        let text = serde_json::to_string(&line)? + "\n";
        let write = self.file.write_all(text.as_bytes()).and_then(|()| self.file.sync_data());
        write.with_context(|| format!("cannot write {}", self.path.display()))?;
        self.lines.push(line);
        Ok(())
    }

    /// Those of `keys`, in their order.
    pub fn of<'a>(&'a self, keys: &'a [String]) -> impl Iterator<Item = &'a L> {
        let by_key: HashMap<_, _> = self.lines.iter().map(|line| (line.key(), line)).collect();
        keys.iter().filter_map(move |key| by_key.get(key.as_str()).copied())
    }
}

/// Whether a job's result, by the job's name, is this version's of the program.
fn is_of_this_version(key: &str) -> bool {
    key.rsplit_once(' ').is_some_and(|(_, version)| version == results_version())
}

/// The files beside a file of lines that have what were none, and those of other versions of the program: `results.bad.jsonl` and `results.old.jsonl`
/// beside `results.jsonl`.
fn aside(path: &Path) -> [PathBuf; 2] {
    ["bad.jsonl", "old.jsonl"].map(|ending| path.with_extension(ending))
}

/// Lists those of `path` that there are among the files of a run's folder.
pub fn keep_aside(folder: &mut RunFolder, path: &Path) -> anyhow::Result<()> {
    let names = aside(path).into_iter().filter(|file| file.exists());
    names.filter_map(|file| file.file_name().map(|name| name.to_string_lossy().into_owned())).try_for_each(|name| folder.keep(&name))
}

/// Keeps lines in a file, behind those of before.
fn set_aside<'a>(aside: &Path, lines: impl Iterator<Item = &'a [u8]>) -> anyhow::Result<()> {
    let mut bytes =
        if aside.exists() { std::fs::read(aside).with_context(|| format!("cannot read {}", aside.display()))? } else { Vec::new() };
    for line in lines {
        bytes.extend_from_slice(line);
        bytes.push(b'\n');
    }
    write_file(aside, &bytes)
}
