//! Shards of a study: the options of the commands that can be split, and how a shard is run.

mod planned;
mod record;

use super::bars::Bars;
use super::common::Invocation;
use super::folder::{Overrule, earlier};
use super::output::{print_line, remark};
use anyhow::ensure;
use lodray::study::shards::{Costs, FOLDER, Part, Pieces, Shard, Share, shares};
use lodray::study::{JobLine, JobLines, count};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub use planned::Planned;
pub use record::recorded;

/// Most shards: more than any scheduler takes at once.
pub const MOST: usize = 100_000;

#[derive(clap::Args)]
#[command(next_help_heading = "Shards")]
pub struct ShardArgs {
    /// Do only this shard of the jobs, such as 3/20: the third of twenty that take about as long
    ///
    /// Its results go to `shards` in the folder; once all shards are done, `lodray merge FOLDER` writes what a run of all jobs would have written. A shard that is
    /// started again goes on where it was, and does nothing that any shard has finished; a shard that is started twice at once waits for the first.
    #[arg(long, value_name = "K/N", value_parser = share, allow_hyphen_values = true)]
    shard: Option<Share>,
    /// Weigh jobs by what they took in an earlier run of shards, whose results are in this folder (default: by estimates, of rays and machines). All shards of a run
    /// must be given the same
    #[arg(long, value_name = "FOLDER")]
    costs: Option<PathBuf>,
}

/// A study of which a shard is run.
pub struct Study<'a> {
    /// Folder of its results.
    pub out: &'a Path,
    /// File of lines of a whole run, if it has one.
    pub lines: Option<PathBuf>,
    pub overrule: &'a Overrule,
    pub pieces: Pieces,
}

fn share(text: &str) -> Result<Share, String> {
    let parts = text.split_once('/').and_then(|(number, of)| Some(Share { number: number.parse().ok()?, of: of.parse().ok()? }));
    parts
        .filter(|share| (1..=MOST).contains(&share.of) && (1..=share.of).contains(&share.number))
        .ok_or_else(|| format!("'{text}' is not a shard such as 3/20: K from 1 to N, and N at most {MOST}"))
}

impl ShardArgs {
    /// The shard that is wanted, if it is not all.
    pub fn share(&self) -> anyhow::Result<Option<Share>> {
        ensure!(self.shard.is_some() || self.costs.is_none(), "--costs: goes with --shard");
        Ok(self.shard)
    }

    /// Costs of pieces and of openings, in nanoseconds.
    fn costs(&self, pieces: &Pieces) -> anyhow::Result<(Vec<u64>, Vec<u64>)> {
        let costs = self.costs.as_deref().map(Costs::read).transpose()?.unwrap_or_default();
        Ok(costs.of(pieces))
    }

    /// Runs a shard of a study: `work` does the jobs of a part, adds their lines, and may put other files into a folder. `failed` says why a line's job failed.
    pub fn run<L: JobLine>(
        &self,
        share: Share,
        study: &Study<'_>,
        work: impl FnOnce(Part<'_>, &mut JobLines<L>, &Path) -> anyhow::Result<()>,
        failed: impl Fn(&L) -> Option<&String>,
    ) -> anyhow::Result<ExitCode> {
        let invocation = Invocation::of_process();
        earlier(study.out, &invocation.command, study.overrule)?;
        if let Some(costs) = &self.costs {
            let is_own = same_file::is_same_file(costs, study.out).unwrap_or(false);
            ensure!(
                !is_own,
                "--costs: {} is the folder that this run writes to: its shards would be split another way each time",
                costs.display()
            );
        }
        let (costs, openings) = self.costs(&study.pieces)?;
        let of = shares(&study.pieces.all, &costs, &openings, share.of).of;
        let mine = study.pieces.all.iter().zip(of).filter(|(_, of)| of + 1 == share.number);
        let mine: Vec<String> = mine.flat_map(|(piece, _)| piece.keys.iter().cloned()).collect();
        let mut shard = Shard::open(study.out, share, &Bars)?;
        record::write(shard.folder(), &invocation)?;
        let done = shard.done(study.lines.as_deref())?;
        let left: HashSet<String> = mine.iter().filter(|key| !done.contains(*key)).cloned().collect();
        let mut why = Vec::new();
        if !left.is_empty() || !shard.is_finished() {
            let mut rows = shard.lines::<L>(&Bars)?;
            let folder = shard.folder().to_owned();
            work(Part { keys: Some(&left), spent: &|what, time| shard.took(what, time) }, &mut rows, &folder)?;
            why.extend(rows.of(&mine).filter_map(|row| Some(format!("failed: {}: {}", row.key(), failed(row)?))));
            shard.finish(rows)?;
        }
        remark(&format!(
            "shard {share}: {}, {} of them done before, {} failed; results in {}",
            count(mine.len(), "job"),
            mine.len() - left.len(),
            why.len(),
            study.out.join(FOLDER).display()
        ))?;
        why.iter().try_for_each(|line| print_line(line))?;
        Ok(if why.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_numbered_from_one() {
        assert_eq!(share("3/20"), Ok(Share { number: 3, of: 20 }));
        assert_eq!(share("1/1"), Ok(Share { number: 1, of: 1 }));
        for bad in ["0/2", "3/2", "1/0", "1", "a/b", "-1/2", "1/2/3", "1/100001", ""] {
            assert!(share(bad).is_err(), "{bad}");
        }
    }
}
