//! What is asked for, and what the files of engines say.

use crate::cli::args::whole;
use crate::cli::folder::{Overrule, one_run};
use crate::cli::names::{Named, named};
use crate::cli::shard::MOST;
use std::ffi::OsString;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Args {
    /// Engine that runs the shards
    #[arg(value_parser = named::<Engine>())]
    pub engine: Engine,
    /// Folder for the files that the engine reads
    #[arg(short, long, value_name = "FOLDER", long_help = one_run("Folder for the files that the engine reads: paths in them are relative, so use them from the folder in which this is run"))]
    pub out: PathBuf,
    /// How many shards the jobs are split into
    #[arg(long, value_name = "N", value_parser = whole::<usize>(1..=MOST as u64), allow_hyphen_values = true)]
    pub shards: usize,
    /// Threads of a shard: what the engine gives each one
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = whole::<usize>(1..=crate::cli::common::MAX_THREADS), allow_hyphen_values = true)]
    pub cpus: usize,
    /// Memory of a shard in MB: docs/scale.md says what jobs take
    #[arg(long, value_name = "MB", default_value_t = 4000, value_parser = whole::<u64>(100..=100_000_000), allow_hyphen_values = true)]
    pub memory: u64,
    /// Minutes after which the engine ends a shard
    #[arg(long, value_name = "MINUTES", default_value_t = 240, value_parser = whole::<u64>(1..=1_000_000), allow_hyphen_values = true)]
    pub minutes: u64,
    /// The program, as the nodes find it
    #[arg(long, value_name = "PATH", default_value = "lodray")]
    pub program: String,
    /// Slurm: one more option of sbatch for shards and merge, such as --sbatch=--partition=long; may be repeated
    #[arg(long, value_name = "OPTION", value_parser = option, allow_hyphen_values = true)]
    pub sbatch: Vec<String>,
    #[command(flatten)]
    pub overrule: Overrule,
    /// Command whose jobs are split: sweep, error-time or stability with its arguments, after --
    #[arg(last = true, required = true, value_name = "RUN")]
    pub run: Vec<OsString>,
}

/// Engines that files are written for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Engine {
    Slurm,
    Snakemake,
}

impl Named for Engine {
    const ALL: &'static [Self] = &[Self::Slurm, Self::Snakemake];

    fn name(self) -> &'static str {
        match self {
            Self::Slurm => "slurm",
            Self::Snakemake => "snakemake",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Slurm => "an array of jobs (sbatch), and a job that merges once all have ended: `sh FOLDER/submit` hands them in",
            Self::Snakemake => {
                "a workflow with a job for each shard, on this computer or on Slurm: `snakemake -s FOLDER/Snakefile --cores 2`"
            }
        }
    }
}

/// What the files say.
pub struct Plan<'a> {
    pub args: &'a Args,
    /// Their folder, quoted for a shell where it needs that.
    pub folder: String,
    /// The program and its command with its arguments, likewise.
    pub program: String,
    pub command: String,
    /// Folder of the results.
    pub results: String,
    pub inputs: Vec<String>,
}

fn option(text: &str) -> Result<String, String> {
    let is_one = text.starts_with('-') && !text.contains(['\n', '\r']);
    if is_one { Ok(text.to_owned()) } else { Err(format!("'{text}' is not an option such as --partition=long")) }
}
