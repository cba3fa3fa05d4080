//! `merge`: the results of all shards of a run, as one run of all jobs would have written them.

use super::common::Invocation;
use super::shard::recorded;
use std::ffi::OsString;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Args {
    /// Folder of the run, as given to its shards (-o): the results go there
    out: PathBuf,
    /// Write even to a folder that holds a run of another command, or files of these names that no run has made
    #[arg(long)]
    force: bool,
}

/// The run whose shards are to be merged, as its command line: this process finishes it, from the folder in which the shards were run.
pub fn finished(args: &Args) -> anyhow::Result<Vec<OsString>> {
    let run = recorded(&args.out)?;
    let Invocation { command, arguments } = run.clone();
    run.finish();
    let mut words: Vec<OsString> = ["lodray".into(), command.into(), "-o".into(), args.out.clone().into()].into();
    words.extend(args.force.then(|| "--force".into()));
    words.extend(arguments.into_iter().map(OsString::from));
    Ok(words)
}
