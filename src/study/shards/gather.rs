//! The lines of all shards together.

use super::folder::{FOLDER, Share, each_file, read_done, share_of};
use crate::study::job_lines::{JobLine, JobLines, LinesError};
use crate::study::words::count;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Jobs that no shard has done yet, or lines that cannot be read.
#[derive(Debug, Error)]
pub enum NotDone {
    /// Some are left.
    #[error("{}: {} {} not done yet{}; the first is {first}", folder.display(), count(*left, "job"), if *left == 1 { "is" } else { "are" }, in_words(shards))]
    Left {
        /// Of the shards.
        folder: PathBuf,
        /// How many.
        left: usize,
        /// The name of the first.
        first: String,
        /// Shards that have not ended.
        shards: Vec<Share>,
    },
    /// A file cannot be read.
    #[error(transparent)]
    Lines(#[from] LinesError),
}

/// The shards that have to be run, if that is known: the first few.
fn in_words(shards: &[Share]) -> String {
    const FEW: usize = 8;
    let named: Vec<_> = shards.iter().take(FEW).map(ToString::to_string).collect();
    match shards.len() {
        0 => String::new(),
        n if n > FEW => format!(" (run shards {} and {} more)", named.join(", "), n - FEW),
        1 => format!(" (run shard {})", named.join(", ")),
        _ => format!(" (run shards {})", named.join(", ")),
    }
}

/// Lines of shards.
#[derive(Debug)]
pub struct Gathered<L>(HashMap<String, L>);

/// The lines of the jobs `keys` from the shards of `out`. Jobs that have a result in `whole`, the lines of a run that did them all, if there are such, need none. A job that failed has a line
/// as well, unless another shard had a result of it.
///
/// # Errors
/// A job has no line, or a file cannot be read.
pub fn gathered<L: JobLine>(out: &Path, whole: Option<&Path>, keys: &[String]) -> Result<Gathered<L>, NotDone> {
    let folder = out.join(FOLDER);
    let mut done = HashSet::new();
    if let Some(whole) = whole.filter(|whole| whole.exists()) {
        read_done(whole, &mut done).map_err(|source| LinesError::Read { path: whole.to_owned(), source })?;
    }
    let wanted: HashSet<&str> = keys.iter().filter(|key| !done.contains(*key)).map(String::as_str).collect();
    let mut lines: HashMap<String, L> = HashMap::new();
    let files = each_file(&folder, |path| {
        for line in fs::read(path)?.split(|&byte| byte == b'\n') {
            // What is none stands for nothing: its job is missing, and told.
            let Ok(line) = serde_json::from_slice::<L>(line) else { continue };
            let is_better = lines.get(line.key()).is_none_or(|before| line.has_result() && !before.has_result());
            if wanted.contains(line.key()) && is_better {
                lines.insert(line.key().to_owned(), line);
            }
        }
        Ok(())
    })?;
    let left: Vec<&String> = keys.iter().filter(|key| wanted.contains(key.as_str()) && !lines.contains_key(*key)).collect();
    match left.first() {
        None => Ok(Gathered(lines)),
        Some(&first) => Err(NotDone::Left { folder, left: left.len(), first: first.clone(), shards: unfinished(&files) }),
    }
}

impl<L: JobLine> Gathered<L> {
    /// All of them, in no order.
    pub fn lines(&self) -> impl Iterator<Item = &L> {
        self.0.values()
    }

    /// All of them, in the order of `keys`.
    pub fn in_order(mut self, keys: &[String]) -> Vec<L> {
        keys.iter().filter_map(|key| self.0.remove(key)).collect()
    }

    /// Adds them to the lines of one run, in the order of `keys`, where those are not there yet: as if the run had done them all itself.
    ///
    /// # Errors
    /// They cannot be written.
    pub fn add_to(mut self, rows: &mut JobLines<L>, keys: &[String]) -> Result<(), LinesError> {
        let done = rows.done();
        let new = keys.iter().filter(|key| !done.contains(*key)).filter_map(|key| self.0.remove(key)).collect();
        rows.add_all(new)
    }
}

/// Shards that have not ended, of each split of which there are files.
fn unfinished(files: &[PathBuf]) -> Vec<Share> {
    let mut ended: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (Share { number, of }, is_done) in files.iter().filter_map(|path| share_of(path)) {
        let of = ended.entry(of).or_default();
        if is_done {
            of.insert(number);
        }
    }
    let left = |(of, ended): (usize, BTreeSet<usize>)| {
        (1..=of).filter(move |number| !ended.contains(number)).map(move |number| Share { number, of })
    };
    ended.into_iter().flat_map(left).collect()
}
