//! `cluster`: what runs the shards of a command on an engine that is there already, Slurm or Snakemake. (The method `cluster` is level of detail, and another thing.)

mod slurm;
mod snakemake;
mod words;

use super::args::whole;
use super::folder::{Overrule, RunFolder, one_run};
use super::names::{Named, named};
use super::output::{remark, warn, write_file};
use super::shard::{MOST, Planned};
use anyhow::{Context, ensure};
use lodray::study::count;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use words::quoted;

#[derive(clap::Args)]
pub struct Args {
    /// Engine that runs the shards
    #[arg(value_parser = named::<Engine>())]
    engine: Engine,
    /// Folder for the files that the engine reads
    #[arg(short, long, value_name = "FOLDER", long_help = one_run("Folder for the files that the engine reads: paths in them are relative, so use them from the folder in which this is run"))]
    out: PathBuf,
    /// How many shards the jobs are split into
    #[arg(long, value_name = "N", value_parser = whole::<usize>(1..=MOST as u64), allow_hyphen_values = true)]
    shards: usize,
    /// Threads of a shard: what the engine gives each one
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = whole::<usize>(1..=super::common::MAX_THREADS), allow_hyphen_values = true)]
    cpus: usize,
    /// Memory of a shard in MB: docs/scale.md says what jobs take
    #[arg(long, value_name = "MB", default_value_t = 4000, value_parser = whole::<u64>(100..=100_000_000), allow_hyphen_values = true)]
    memory: u64,
    /// Minutes after which the engine ends a shard
    #[arg(long, value_name = "MINUTES", default_value_t = 240, value_parser = whole::<u64>(1..=1_000_000), allow_hyphen_values = true)]
    minutes: u64,
    /// The program, as the nodes find it
    #[arg(long, value_name = "PATH", default_value = "lodray")]
    program: String,
    /// Slurm: one more option of sbatch for shards and merge, such as --sbatch=--partition=long; may be repeated
    #[arg(long, value_name = "OPTION", value_parser = option, allow_hyphen_values = true)]
    sbatch: Vec<String>,
    #[command(flatten)]
    overrule: Overrule,
    /// Command whose jobs are split: sweep, error-time or stability with its arguments, after --
    #[arg(last = true, required = true, value_name = "RUN")]
    run: Vec<OsString>,
}

/// Engines that files are written for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Engine {
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
struct Plan<'a> {
    args: &'a Args,
    /// Their folder, quoted for a shell where it needs that.
    folder: String,
    /// The program and its command with its arguments, likewise.
    program: String,
    command: String,
    /// Folder of the results.
    results: String,
    inputs: Vec<String>,
}

fn option(text: &str) -> Result<String, String> {
    let is_one = text.starts_with('-') && !text.contains(['\n', '\r']);
    if is_one { Ok(text.to_owned()) } else { Err(format!("'{text}' is not an option such as --partition=long")) }
}

/// Writes the files. `planned` says what shards of a command line would do.
pub fn run(args: &Args, planned: impl Fn(&[OsString]) -> anyhow::Result<Planned>) -> anyhow::Result<ExitCode> {
    let run = planned(&args.run)?;
    ensure!(!run.is_shard, "--shard: the files name each shard; leave it out of the command");
    let has_threads = args.run.iter().any(|word| word.to_string_lossy().split('=').next() == Some("--threads"));
    ensure!(!has_threads, "--threads: a shard has as many as --cpus says; leave it out of the command");
    ensure!(args.engine == Engine::Slurm || args.sbatch.is_empty(), "--sbatch: is for slurm");
    if let Some(costs) = &run.costs {
        let is_own = same_file::is_same_file(costs, &run.out).unwrap_or(false);
        ensure!(!is_own, "--costs: {} is the folder that the run writes to", costs.display());
    }
    let plan = Plan {
        args,
        folder: text(&args.out)?,
        program: quoted(&args.program),
        command: args.run.iter().map(|word| Ok(quoted(&text(Path::new(word))?))).collect::<anyhow::Result<Vec<_>>>()?.join(" "),
        results: quoted(&text(&run.out)?),
        inputs: run.inputs.iter().map(|input| text(input)).collect::<anyhow::Result<_>>()?,
    };
    let files = match args.engine {
        Engine::Slurm => slurm::files(&plan),
        Engine::Snakemake => snakemake::files(&plan),
    };
    let inputs: Vec<_> = run.inputs.iter().map(PathBuf::as_path).collect();
    let folder = RunFolder::open(&args.out, files.iter().map(|(name, _)| *name), &inputs, &args.overrule)?;
    files.iter().try_for_each(|(name, text)| write_file(&folder.staging().join(name), text))?;
    folder.finish()?;
    let (jobs, pieces) = (run.jobs(), run.pieces());
    if args.shards > pieces {
        warn(&format!(
            "note: {}, but no more than {pieces} can have anything to do: jobs of one view and method are not split",
            count(args.shards, "shard")
        ));
    }
    let how = match args.engine {
        Engine::Slurm => format!("sh {}", quoted(&format!("{}/submit", plan.folder))),
        Engine::Snakemake => format!("snakemake -s {} --cores {}", quoted(&format!("{}/Snakefile", plan.folder)), args.cpus),
    };
    remark(&format!(
        "{} in {}, the longest {:.2} of the mean; {how}",
        count(jobs, "job"),
        count(args.shards, "shard"),
        run.longest(args.shards)
    ))?;
    Ok(ExitCode::SUCCESS)
}

/// A path as text, which files of engines are.
fn text(path: &Path) -> anyhow::Result<String> {
    let text = path.to_str().with_context(|| format!("{}: is not UTF-8, and cannot stand in a file", path.display()))?;
    ensure!(!text.contains(['\n', '\r']), "{text:?}: a name with a new line in it cannot stand in these files");
    Ok(text.to_owned())
}
