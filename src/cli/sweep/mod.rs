//! `sweep`: scenes, views and methods on machines, from a list of jobs.

mod charts;
mod check;
mod labels;
mod list;

use super::args::whole;
use super::bars::Bars;
use super::cache::CacheArgs;
use super::common::MAX_THREADS;
use super::folder::{Overrule, RunFolder, one_run};
use super::input::{InputArgs, is_found, with_input};
use super::output::{check_target, print_line, remark, write_file};
use super::report::PageArgs;
use super::shard::{Planned, ShardArgs, Study};
use anyhow::ensure;
use lodray::method::Over;
use lodray::report::page::{Documents, Simulation};
use lodray::study::shards::{Part, gathered};
use lodray::study::{JobLines, Jobs, Means, Row, SceneJobs, count, csv, sweep_part, sweep_pieces};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub use check::{open_scene, read_jobs, read_views};
pub use list::ListText;

const LINES: &str = "results.jsonl";
const TABLE: &str = "results.csv";
const FOLDER: &str = "Folder for the results, one line of JSON for each job, their table, and charts (SVG) that set views, methods and machines side by side; a sweep \
started again goes on with the results that are there, if they are of the same version of the program (others are set aside in results.old.jsonl). Lines of jobs that are no longer in the list stay, \
for when they are again, but are in neither table nor charts; lines that are no results are set aside in results.bad.jsonl";

#[derive(clap::Args)]
pub struct Args {
    /// List of jobs (TOML): docs/jobs-example.toml shows every key
    jobs: PathBuf,
    /// Folder for the results, one line of JSON for each job, their table, and charts (SVG) that set views, methods and machines side by side
    #[arg(short, long, long_help = one_run(FOLDER))]
    out: PathBuf,
    /// Frames simulated at once, 1 to 1024 (default: as many as there are threads, over the machines that share a frame's rays); each holds some of
    /// its steps in memory, at most 150 MB and mostly far less. Results are the same, in the same order, with any number
    #[arg(long, value_name = "N", value_parser = whole::<usize>(1..=MAX_THREADS), allow_hyphen_values = true)]
    at_once: Option<usize>,
    #[command(flatten)]
    overrule: Overrule,
    #[command(flatten)]
    input: InputArgs,
    #[command(flatten)]
    cache: CacheArgs,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    shard: ShardArgs,
}

/// The jobs of the list; each says whether methods that take either surface are over the mesh that its scene was built from.
fn listed(args: &Args) -> anyhow::Result<Jobs> {
    let mut jobs = read_views(&args.jobs)?;
    if jobs.methods.iter().any(|chosen| chosen.method.over == Over::Either) {
        jobs.scenes.iter_mut().for_each(|scene| scene.has_mesh = is_found(Path::new(&scene.path()), &args.input));
    }
    Ok(jobs)
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let jobs = listed(args)?;
    let Some(share) = args.shard.share()? else {
        return results(args, &jobs, |rows| work(args, &jobs, Part::ALL, rows));
    };
    ensure!(!args.page.is_wanted(), "--report: a page is of all shards: lodray report makes it of what lodray merge writes");
    let study = Study { out: &args.out, lines: Some(args.out.join(LINES)), overrule: &args.overrule, pieces: sweep_pieces(&jobs)? };
    args.shard.run(share, &study, |part, rows, _| work(args, &jobs, part, rows).map(drop), |row: &Row| row.error.as_ref())
}

/// Puts the shards of a run together.
pub fn merge(args: &Args) -> anyhow::Result<ExitCode> {
    let jobs = listed(args)?;
    let keys = jobs.keys()?;
    let lines = gathered(&args.out, Some(&args.out.join(LINES)), &keys)?;
    results(args, &jobs, |rows| {
        lines.add_to(rows, &keys)?;
        Ok(keys)
    })
}

/// What shards of a run would do.
pub fn planned(args: &Args) -> anyhow::Result<Planned> {
    let jobs = listed(args)?;
    let inputs = std::iter::once(&args.jobs).chain(&jobs.files).cloned().collect();
    Planned::new(&args.shard, &args.out, inputs, sweep_pieces(&jobs)?)
}

/// Does the jobs of a part that `rows` has not yet. Gives the names of all jobs.
fn work(args: &Args, jobs: &Jobs, part: Part<'_>, rows: &mut JobLines<Row>) -> anyhow::Result<Vec<String>> {
    let cache = args.cache.cache(Some(&args.out))?;
    // Each machine's replay is a thread's work.
    let at_once = args.at_once.unwrap_or_else(|| rayon::current_num_threads().div_ceil(jobs.targets.len().max(1)));
    let opened = |scene: &SceneJobs| {
        let made = open_scene(scene)?;
        Ok(with_input(made, Path::new(&scene.path()), &args.input, &jobs.methods)?)
    };
    Ok(sweep_part(jobs, part, rows, at_once, &Means { cache: &cache, open: &opened, progress: &Bars })?)
}

/// The results of all jobs, once `fill` has added the lines that are not there yet and told the names of all.
fn results(args: &Args, jobs: &Jobs, fill: impl FnOnce(&mut JobLines<Row>) -> anyhow::Result<Vec<String>>) -> anyhow::Result<ExitCode> {
    let inputs: Vec<_> = std::iter::once(&args.jobs).chain(&jobs.files).map(PathBuf::as_path).collect();
    args.page.check(&inputs)?;
    let mut folder = RunFolder::open(&args.out, [TABLE], &inputs, &args.overrule)?;
    folder.spares(args.page.file())?;
    // Refused before there is a file of lines.
    args.cache.cache(Some(&args.out))?;
    let lines = args.out.join(LINES);
    check_target(&lines, &inputs)?;
    folder.continues(LINES)?;
    let mut rows = JobLines::open(&lines, &Bars)?;
    folder.keep(LINES)?;
    folder.keep_aside(&lines)?;
    let done = rows.done();
    let keys = fill(&mut rows)?;
    write_file(&folder.staging().join(TABLE), csv(rows.of(&keys)))?;
    for (name, chart) in charts::charts(rows.of(&keys))? {
        write_file(&folder.staging().join(name), chart)?;
    }
    folder.finish()?;
    let simulation = |row: &Row| {
        let (scene, image) = (Some(row.scene.clone()), row.image);
        row.result.clone().map(|result| Simulation { scene, result, image })
    };
    let simulations = rows.of(&keys).filter_map(simulation).collect();
    args.page.write(Documents { simulations, ..Documents::default() }, &inputs)?;
    let failed: Vec<_> = rows.of(&keys).filter(|row| row.error.is_some()).collect();
    let before = keys.iter().filter(|key| done.contains(*key)).count();
    remark(&format!(
        "{}, {before} of them done before, {} failed; results in {}",
        count(keys.len(), "job"),
        failed.len(),
        args.out.display()
    ))?;
    let others = done.len() - before;
    if others > 0 {
        remark(&format!("{LINES} has results of {} more, which are not in the list", count(others, "job")))?;
    }
    for row in &failed {
        print_line(&format!("failed: {}: {}", row.key, row.error.as_deref().unwrap_or_default()))?;
    }
    Ok(if failed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
