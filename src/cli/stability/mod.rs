//! `stability`: stiff and extreme cases, judged ray by ray.

mod plots;
mod table;

use super::args::{MAX_RAYS, seed, whole};
use super::folder::{Overrule, RunFolder, one_run};
use super::output::{busy, explain, open, print_json, print_table, progress, remark, write_file};
use super::report::PageArgs;
use super::shard::{Planned, ShardArgs, Study};
use anyhow::{Context, ensure};
use lodray::lab::{CASES, Case, FILE_CASES, Figures, Hunt, LabLine, LabPlan, Model, WIDTHS_CHECKED};
use lodray::report::page::Documents;
use lodray::study::JobLines;
use lodray::study::shards::{Part, gathered};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use xxhash_rust::xxh3::xxh3_64;

/// Rays of the usual run, which takes about a minute, and of the long one.
const USUAL: u64 = 12_000_000;
const LONG: u64 = 1_000_000_000;
/// Steps of the hunt for each so many rays.
const RAYS_PER_STEP: u64 = 200;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file: runs the families of rays on it instead of the built-in cases
    scene: Option<PathBuf>,
    /// Rays over all cases (default 12 million: about a minute on two cores; docs/stability.md shows what 100 million give)
    #[arg(long, value_parser = whole::<u64>(1..=MAX_RAYS), allow_negative_numbers = true, conflicts_with = "long")]
    rays: Option<u64>,
    /// 1,000 million rays: an hour or more
    #[arg(long)]
    long: bool,
    /// Only this case; may be repeated
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,
    /// Steps of the hunt for counterexamples, 0 for none (default: one for each 200 rays; none with --case)
    #[arg(long, value_name = "STEPS", value_parser = whole::<u64>(0..=MAX_RAYS), allow_negative_numbers = true)]
    hunt: Option<u64>,
    /// Seed
    #[arg(long, default_value_t = 1, value_parser = seed(), allow_negative_numbers = true)]
    seed: u64,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
    /// Folder for the table, the figures, plots of error growth, and the rays that the hunt found
    #[arg(short, long, value_name = "FOLDER", long_help = one_run("Folder for the table, the figures, plots of error growth, and the rays that the hunt found"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    overrule: Overrule,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    shard: ShardArgs,
}

/// Files of `-o`.
const TABLE: &str = "stability.md";
const JSON: &str = "stability.json";
const FOUND: &str = "found.json";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let plan = plan(args)?;
    let Some(share) = args.shard.share()? else { return results(args, || measured(&plan)) };
    let out = args.out.as_ref().context("--shard: needs a folder for the results (-o)")?;
    ensure!(!args.json && !args.page.is_wanted(), "--shard: figures are of all shards: lodray merge writes them");
    let study = Study { out, lines: None, overrule: &args.overrule, pieces: plan.pieces() };
    let work = |part: Part<'_>, rows: &mut JobLines<LabLine>, _: &Path| {
        quietly(|| plan.measure(part, &|_, _| (), |line| -> anyhow::Result<()> { Ok(rows.add(line)?) }))
    };
    args.shard.run(share, &study, work, |_| None)
}

/// Puts the shards of a run together.
pub fn merge(args: &Args) -> anyhow::Result<ExitCode> {
    let plan = plan(args)?;
    let keys = plan.keys();
    let out = args.out.as_deref().unwrap_or(Path::new(""));
    let lines = gathered(out, None, &keys)?;
    results(args, || Ok(plan.figures(lines.in_order(&keys))))
}

/// What shards of a run would do.
pub fn planned(args: &Args) -> anyhow::Result<Planned> {
    let out = args.out.as_ref().context("a folder for the results (-o) is missing")?;
    Planned::new(&args.shard, out, args.scene.iter().cloned().collect(), plan(args)?.pieces())
}

fn plan(args: &Args) -> anyhow::Result<LabPlan<'static>> {
    let cases = chosen(if args.scene.is_some() { FILE_CASES } else { CASES }, &args.cases)?;
    let given = args.scene.as_deref().map(model).transpose()?;
    let rays = args.rays.unwrap_or(if args.long { LONG } else { USUAL });
    let usual_steps = if args.cases.is_empty() { rays / RAYS_PER_STEP } else { 0 };
    // Curves are drawn of built-in models only.
    let curves = args.out.is_some() && given.is_none();
    Ok(LabPlan { cases, rays, given, steps: args.hunt.unwrap_or(usual_steps), curves, seed: args.seed })
}

/// Measures everything.
fn measured(plan: &LabPlan<'_>) -> anyhow::Result<Figures> {
    let bar = progress(plan.total(), "");
    let told = |what: &str, n: u64| {
        bar.set_message(what.to_owned());
        bar.inc(n);
    };
    let mut lines = Vec::new();
    quietly(|| {
        plan.measure(Part::ALL, &told, |line| -> anyhow::Result<()> {
            lines.push(line);
            Ok(())
        })
    })?;
    bar.finish_and_clear();
    Ok(plan.figures(lines))
}

/// Writes and prints all figures.
fn results(args: &Args, figures: impl FnOnce() -> anyhow::Result<Figures>) -> anyhow::Result<ExitCode> {
    let charts = if args.scene.is_none() { &[plots::LEVELS, plots::DISTANCE][..] } else { &[] };
    let names = [TABLE, JSON, FOUND].into_iter().chain(charts.iter().copied());
    let inputs: Vec<_> = args.scene.as_deref().into_iter().collect();
    args.page.check(&inputs)?;
    let folder = args.out.as_ref().map(|out| RunFolder::open(out, names, &inputs, &args.overrule)).transpose()?;
    let figures = figures()?;
    let breaches = figures.report.total().breaches() + figures.hunt.as_ref().map_or(0, Hunt::breaches);
    if let Some(folder) = folder {
        write(folder.staging(), &figures)?;
        folder.finish()?;
    }
    if args.json {
        print_json(&figures)?;
    } else {
        print_table(&table::text(&figures.report, figures.hunt.as_ref(), args.seed))?;
        explain("stability")?;
        if let Some(out) = &args.out {
            remark(&format!("table, figures and plots in {}", out.display()))?;
        }
    }
    let page = Documents { stability: vec![serde_json::from_value(serde_json::to_value(&figures)?)?], ..Documents::default() };
    args.page.write(page, &inputs)?;
    Ok(if breaches == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The cases of these names, or all.
fn chosen(all: &'static [Case], names: &[String]) -> anyhow::Result<Vec<&'static Case>> {
    for name in names {
        let known = || all.iter().map(|case| case.name).collect::<Vec<_>>().join(", ");
        anyhow::ensure!(all.iter().any(|case| case.name == name), "--case {name}: there is no such case; there are {}", known());
    }
    Ok(all.iter().filter(|case| names.is_empty() || names.iter().any(|name| name == case.name)).collect())
}

/// The model of a scene's file, and the file's checksum.
fn model(path: &Path) -> anyhow::Result<(Model, u64)> {
    let scene = open(path)?;
    let content = xxh3_64(scene.bytes());
    Ok((busy("decoding", || Model::of_scene(path.display().to_string(), scene)), content))
}

/// Does `work` without the messages of panics: a value that does not fit its width is one, and is counted.
fn quietly<T>(work: impl FnOnce() -> T) -> T {
    if !WIDTHS_CHECKED {
        return work();
    }
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let done = work();
    std::panic::set_hook(usual);
    done
}

fn write(out: &Path, figures: &Figures) -> anyhow::Result<()> {
    let put = |name: &str, text: &str| write_file(&out.join(name), text);
    put(TABLE, &table::markdown(&figures.report, figures.hunt.as_ref()))?;
    put(JSON, &(serde_json::to_string_pretty(figures)? + "\n"))?;
    if let Some(hunt) = &figures.hunt {
        put(FOUND, &(serde_json::to_string(&hunt.found)? + "\n"))?;
    }
    if let Some(growth) = &figures.growth {
        put(plots::LEVELS, &plots::by_levels(growth)?)?;
        put(plots::DISTANCE, &plots::by_distance(growth)?)?;
    }
    Ok(())
}
