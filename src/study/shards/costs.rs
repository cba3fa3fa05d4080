//! What jobs took in an earlier run.

use super::folder::{FOLDER, SECONDS, files, name_of};
use super::piece::{Opening, Piece, Pieces};
use super::took::Took;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use thiserror::Error;

/// Costs that cannot be had.
#[derive(Debug, Error)]
pub enum CostsError {
    /// There is no run of shards.
    #[error("{}: there are no times of shards ({FOLDER}/*{SECONDS})", .0.display())]
    None(PathBuf),
    /// A file cannot be read.
    #[error("cannot read {}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Mean of some times.
#[derive(Default)]
struct Mean {
    nanoseconds: u64,
    times: u64,
}

impl Mean {
    fn add(&mut self, seconds: f64) {
        self.nanoseconds += Duration::try_from_secs_f64(seconds).map_or(0, |time| time.as_nanos() as u64);
        self.times += 1;
    }

    fn get(&self) -> u64 {
        self.nanoseconds / self.times.max(1)
    }
}

/// What jobs took in an earlier run, by their names alone: without content and version, which may have changed meanwhile.
#[derive(Default)]
pub struct Costs {
    jobs: HashMap<String, Mean>,
    openings: HashMap<String, Mean>,
}

impl Costs {
    /// Of the run of shards whose results are in this folder.
    ///
    /// # Errors
    /// There is none, or a file of it cannot be read.
    pub fn read(out: &Path) -> Result<Self, CostsError> {
        let mut costs = Self::default();
        let folder = out.join(FOLDER);
        let all = files(&folder, SECONDS).map_err(|source| CostsError::Read { path: folder, source })?;
        for path in &all {
            let bytes = fs::read(path).map_err(|source| CostsError::Read { path: path.clone(), source })?;
            for line in bytes.split(|&byte| byte == b'\n') {
                // A line that was cut, as where a run was killed or a disk was full, stands for nothing.
                let Ok(Took { key, opened, seconds }) = serde_json::from_slice(line) else { continue };
                key.into_iter().for_each(|key| costs.jobs.entry(name_of(&key).to_owned()).or_default().add(seconds));
                opened.into_iter().for_each(|scene| costs.openings.entry(scene).or_default().add(seconds));
            }
        }
        if costs.jobs.is_empty() { Err(CostsError::None(out.to_owned())) } else { Ok(costs) }
    }

    /// Costs of pieces and of openings, in nanoseconds: as measured, or, of jobs that were not, their estimates, stretched as those of the measured ones were wrong.
    pub fn of(&self, pieces: &Pieces) -> (Vec<u64>, Vec<u64>) {
        let Pieces { all, openings } = pieces;
        let measured = |piece: &Piece| -> Option<u64> {
            let each = piece.keys.iter().map(|key| self.jobs.get(name_of(key)).map(Mean::get));
            each.sum()
        };
        let known: Vec<_> = all.iter().map(measured).collect();
        let both = || known.iter().zip(all).filter_map(|(known, piece)| Some(((*known)?, piece.estimate)));
        let sum = |of: fn((u64, u64)) -> u64| both().map(of).map(u128::from).sum::<u128>();
        let (real, guessed) = (sum(|(known, _)| known), sum(|(_, estimate)| estimate));
        let stretched = |estimate: u64| match guessed {
            0 => estimate,
            _ => u64::try_from(u128::from(estimate) * real / guessed).unwrap_or(u64::MAX),
        };
        let costs = known.iter().zip(all).map(|(known, piece)| known.unwrap_or_else(|| stretched(piece.estimate))).collect();
        let opening = |of: &Opening| self.openings.get(&of.name).map_or_else(|| stretched(of.estimate), Mean::get);
        (costs, openings.iter().map(opening).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::shards::Spent;

    #[test]
    fn measured_times_count_and_estimates_are_stretched_to_them() {
        let folder = tempfile::tempdir().unwrap();
        assert!(matches!(Costs::read(folder.path()), Err(CostsError::None(_) | CostsError::Read { .. })));
        fs::create_dir(folder.path().join(FOLDER)).unwrap();
        let line = |what, seconds| serde_json::to_string(&Took::new(what, Duration::from_secs(seconds))).unwrap() + "\n";
        let text = [
            line(Spent::Opening("s"), 7),
            line(Spent::Job("a #0123456789abcdef 0.1.0-old"), 2),
            line(Spent::Job("a #fedcba9876543210 0.1.0-old"), 4),
            "{\"key\": \"cut\n".to_owned(),
            line(Spent::Job("b #0123456789abcdef 0.1.0-old"), 1),
            "{\"key\": \"cut".to_owned(),
        ];
        fs::write(folder.path().join(FOLDER).join(format!("1-of-2{SECONDS}")), text.concat()).unwrap();
        let costs = Costs::read(folder.path()).unwrap();
        let piece = |names: &[&str], estimate| Piece {
            scene: 0,
            keys: names.iter().map(|name| format!("{name} #0000000000000000 0.2.0-new")).collect(),
            estimate,
        };
        let opening = |name: &str, estimate| Opening { name: name.to_owned(), estimate };
        let all = vec![piece(&["a", "b"], 5), piece(&["c"], 20), piece(&["b", "c"], 10), piece(&["b"], 3)];
        let pieces = Pieces { all, openings: vec![opening("s", 1), opening("t", 16)] };
        let second = 1_000_000_000;
        let (jobs, openings) = costs.of(&pieces);
        assert_eq!((jobs, openings), (vec![4 * second, 12_500_000_000, 6_250_000_000, second], vec![7 * second, 10 * second]));
        assert_eq!(Costs::default().of(&pieces), (vec![5, 20, 10, 3], vec![1, 16]));
    }
}
