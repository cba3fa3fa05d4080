//! `cluster`: what runs the shards of a command on an engine that is there already, Slurm or Snakemake. (The method `cluster` is level of detail, and another thing.)

mod plan;
mod slurm;
mod snakemake;
mod words;

use super::folder::RunFolder;
use super::output::{remark, warn, write_file};
use super::shard::Planned;
use anyhow::{Context, ensure};
use lodray::study::count;
use plan::{Engine, Plan};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use words::quoted;

pub use plan::Args;

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
