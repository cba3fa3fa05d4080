//! The files of shards: a folder within that of the results, in which each shard has files of its own.
//!
//! `03-of-20.part.jsonl` has the lines of a shard that is under way, or was killed, and goes on with them; `03-of-20.jsonl` is the same file once the shard is done.
//! `03-of-20.lock` is locked by whoever does the shard, and `03-of-20.seconds.jsonl` says what took how long.

use super::part::Spent;
use super::took::Took;
use crate::study::job_lines::{JobLine, JobLines, LinesError, is_of_this_version};
use crate::study::progress::Progress;
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::HashSet;
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The folder of shards, within that of the results.
pub const FOLDER: &str = "shards";
pub(super) const LINES: &str = ".jsonl";
const PART: &str = ".part.jsonl";
pub(super) const SECONDS: &str = ".seconds.jsonl";
/// Lines that were set aside.
const ASIDE: [&str; 2] = [".bad.jsonl", ".old.jsonl"];

/// Which shard, from 1, of how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Share {
    /// Which one, from 1.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl Share {
    /// What its files' names begin with: numbers of as many digits, so that lists of files are in order.
    pub(super) fn stem(self) -> String {
        let digits = self.of.to_string().len();
        format!("{:0digits$}-of-{}", self.number, self.of)
    }

    pub(super) fn of_stem(stem: &str) -> Option<Self> {
        let (number, of) = stem.split_once("-of-")?;
        let share = Self { number: number.parse().ok()?, of: of.parse().ok()? };
        (share.stem() == stem && (1..=share.of).contains(&share.number)).then_some(share)
    }
}

/// A shard that this process alone does.
pub struct Shard {
    folder: PathBuf,
    share: Share,
    seconds: Option<File>,
    _lock: File,
}

impl Shard {
    /// Makes the files' folder within `out`. If another process does the same shard, this waits until that has ended, however it does: what is left is done then.
    ///
    /// # Errors
    /// A file cannot be written or locked.
    pub fn open(out: &Path, share: Share, progress: &dyn Progress) -> Result<Self, LinesError> {
        let folder = out.join(FOLDER);
        let wrong = |path: &Path| {
            let path = path.to_owned();
            move |source| LinesError::Write { path, source }
        };
        fs::create_dir_all(&folder).map_err(wrong(&folder))?;
        let path = folder.join(share.stem() + ".lock");
        let lock = OpenOptions::new().create(true).truncate(false).write(true).open(&path).map_err(wrong(&path))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                progress.note(&format!("note: another run does shard {share}; this one waits for its end"));
                lock.lock().map_err(wrong(&path))?;
            }
            // Without locks a shard that is begun twice at once would mix its lines.
            Err(TryLockError::Error(source)) => return Err(LinesError::Lock { path, source }),
        }
        Ok(Self { folder, share, seconds: None, _lock: lock })
    }

    /// The folder of all shards, also for what a shard makes beside its lines.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn path(&self, ending: &str) -> PathBuf {
        self.folder.join(self.share.stem() + ending)
    }

    /// Jobs that have a result, of any shard, however the jobs were split, or in the file of lines `whole`, if there is one, of a run that did them all.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn done(&self, whole: Option<&Path>) -> Result<HashSet<String>, LinesError> {
        let mut done = HashSet::new();
        if let Some(whole) = whole.filter(|whole| whole.exists()) {
            read_done(whole, &mut done).map_err(|source| LinesError::Read { path: whole.to_owned(), source })?;
        }
        each_file(&self.folder, |path| read_done(path, &mut done))?;
        Ok(done)
    }

    /// Its lines, to be added to. What is there stays, but for jobs that failed: those are done again.
    ///
    /// # Errors
    /// A file cannot be read or written.
    pub fn lines<L: JobLine>(&mut self, progress: &dyn Progress) -> Result<JobLines<L>, LinesError> {
        let (part, whole) = (self.path(PART), self.path(LINES));
        match fs::rename(&whole, &part) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(LinesError::Write { path: part, source: error }),
            _ => {}
        }
        // How long jobs took is worth less than their results: no run ends for it.
        self.seconds = OpenOptions::new().create(true).append(true).open(self.path(SECONDS)).ok();
        JobLines::open(&part, progress)
    }

    /// Notes what took how long.
    pub fn took(&self, what: Spent<'_>, time: Duration) {
        let line = serde_json::to_string(&Took::new(what, time)).map(|line| line + "\n");
        if let (Some(mut file), Ok(line)) = (self.seconds.as_ref(), line) {
            let _ = file.write_all(line.as_bytes());
        }
    }

    /// Whether the shard was done before.
    pub fn is_finished(&self) -> bool {
        self.path(LINES).exists()
    }

    /// The shard is done: its file gets its name.
    ///
    /// # Errors
    /// It cannot be renamed.
    pub fn finish<L>(self, lines: JobLines<L>) -> Result<(), LinesError> {
        drop(lines);
        let path = self.path(LINES);
        fs::rename(self.path(PART), &path).map_err(|source| LinesError::Write { path, source })
    }
}

/// The files of a folder whose names end so, in order; none of a folder that is not there.
pub(super) fn files(folder: &Path, ending: &str) -> io::Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        other => other?,
    };
    let mut all = entries.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
    all.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(ending)));
    all.sort_unstable();
    Ok(all)
}

/// Reads the files of lines of all shards, done or not. If one is renamed meanwhile, because its shard has just ended, all are read again.
pub(super) fn each_file(folder: &Path, mut read: impl FnMut(&Path) -> io::Result<()>) -> Result<Vec<PathBuf>, LinesError> {
    let wrong = |path: &Path, source| LinesError::Read { path: path.to_owned(), source };
    let mut tries = 0;
    'again: loop {
        tries += 1;
        let mut all = files(folder, LINES).map_err(|source| wrong(folder, source))?;
        all.retain(|path| share_of(path).is_some());
        for path in &all {
            match read(path) {
                // A link that leads nowhere is no file that was renamed.
                Err(error) if error.kind() == ErrorKind::NotFound && tries < 100 => continue 'again,
                other => other.map_err(|source| wrong(path, source))?,
            }
        }
        return Ok(all);
    }
}

/// Whose lines a file has, and whether that shard is done.
pub(super) fn share_of(path: &Path) -> Option<(Share, bool)> {
    let name = path.file_name()?.to_str()?;
    if name.ends_with(SECONDS) || ASIDE.iter().any(|ending| name.ends_with(ending)) {
        return None;
    }
    let (stem, is_done) = match name.strip_suffix(PART) {
        Some(stem) => (stem, false),
        None => (name.strip_suffix(LINES)?, true),
    };
    Some((Share::of_stem(stem)?, is_done))
}

/// A line of any study, of which only this is wanted.
#[derive(Deserialize)]
struct Known {
    key: String,
    #[serde(default)]
    error: Option<IgnoredAny>,
}

/// Adds the jobs of a file that have a result; a line that is none, as where another shard is just writing one, stands for nothing.
pub(super) fn read_done(path: &Path, done: &mut HashSet<String>) -> io::Result<()> {
    for line in BufReader::new(File::open(path)?).split(b'\n') {
        if let Ok(Known { key, error: None }) = serde_json::from_slice(&line?)
            && is_of_this_version(&key)
        {
            done.insert(key);
        }
    }
    Ok(())
}

/// A job's name without what changes with content and version.
pub(super) fn name_of(key: &str) -> &str {
    key.rsplit_once(" #").map_or(key, |(name, _)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_say_whose_they_are() {
        let share = Share { number: 3, of: 20 };
        assert_eq!((share.to_string(), share.stem()), ("3/20".to_owned(), "03-of-20".to_owned()));
        let of = |name: &str| share_of(Path::new(name));
        assert_eq!([of("a/03-of-20.jsonl"), of("03-of-20.part.jsonl")], [Some((share, true)), Some((share, false))]);
        for other in [
            "3-of-20.jsonl",
            "21-of-20.jsonl",
            "00-of-20.jsonl",
            "03-of-20.seconds.jsonl",
            "03-of-20.part.bad.jsonl",
            "03-of-20.lock",
            "x.jsonl",
        ] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}
