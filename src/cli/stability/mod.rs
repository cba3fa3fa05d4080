//! `stability`: stiff and extreme cases, judged ray by ray.

mod plots;
mod table;

use super::args::{MAX_RAYS, seed, whole};
use super::folder::{Overrule, RunFolder, one_run};
use super::output::{busy, explain, open, print_json, print_table, progress, remark, write_file};
use super::report::PageArgs;
use lodray::lab::growth::{Growth, growth, rays as growth_rays};
use lodray::lab::hunt::{Hunt, hunt};
use lodray::lab::{CASES, Case, FILE_CASES, Model, Report, Scale, WIDTHS_CHECKED, suite};
use lodray::num::MAX_LEVELS;
use lodray::report::page::Documents;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

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
}

/// Everything measured.
#[derive(Serialize)]
struct Figures {
    #[serde(flatten)]
    report: Report,
    #[serde(skip_serializing_if = "Option::is_none")]
    hunt: Option<Hunt>,
    #[serde(skip_serializing_if = "Option::is_none")]
    growth: Option<Growth>,
}

/// Files of `-o`.
const TABLE: &str = "stability.md";
const JSON: &str = "stability.json";
const FOUND: &str = "found.json";

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let all = if args.scene.is_some() { FILE_CASES } else { CASES };
    let cases = chosen(all, &args.cases)?;
    let given = args.scene.as_deref().map(model).transpose()?;
    // Curves are drawn of built-in models only.
    let charts = if args.scene.is_none() { &[plots::LEVELS, plots::DISTANCE][..] } else { &[] };
    let names = [TABLE, JSON, FOUND].into_iter().chain(charts.iter().copied());
    let inputs: Vec<_> = args.scene.as_deref().into_iter().collect();
    args.page.check(&inputs)?;
    let folder = args.out.as_ref().map(|out| RunFolder::open(out, names, &inputs, &args.overrule)).transpose()?;
    let rays = args.rays.unwrap_or(if args.long { LONG } else { USUAL });
    let usual_steps = if args.cases.is_empty() { rays / RAYS_PER_STEP } else { 0 };
    let steps = args.hunt.unwrap_or(usual_steps);

    let figures = quietly(|| measure(args, &cases, given.as_slice(), rays, steps))?;
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
fn chosen<'a>(all: &'a [Case], names: &[String]) -> anyhow::Result<Vec<&'a Case>> {
    for name in names {
        let known = || all.iter().map(|case| case.name).collect::<Vec<_>>().join(", ");
        anyhow::ensure!(all.iter().any(|case| case.name == name), "--case {name}: there is no such case; there are {}", known());
    }
    Ok(all.iter().filter(|case| names.is_empty() || names.iter().any(|name| name == case.name)).collect())
}

fn model(path: &Path) -> anyhow::Result<Model> {
    let scene = open(path)?;
    Ok(busy("decoding", || Model::of_scene(path.display().to_string(), scene)))
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

fn measure(args: &Args, cases: &[&Case], given: &[Model], rays: u64, steps: u64) -> anyhow::Result<Figures> {
    let shares = suite::shares(cases, rays);
    // Curves are drawn of built-in models only.
    let curves = args.out.is_some() && given.is_empty();
    let bar = progress(shares.iter().sum::<u64>() + steps + if curves { growth_rays(MAX_LEVELS) } else { 0 }, "");
    let mut report = Report::new(args.seed);
    for (case, rays) in cases.iter().zip(shares) {
        bar.set_message(case.name);
        report.rows.push(match given {
            [] => suite::run(case, Scale::Full, rays, args.seed, &|n| bar.inc(n))?,
            models => suite::shoot(case, models, rays, args.seed, &|n| bar.inc(n)),
        });
    }
    bar.set_message("hunt");
    let hunt = if steps > 0 { Some(hunt(given.first(), steps, args.seed, &|n| bar.inc(n))?) } else { None };
    bar.set_message("growth");
    let growth = if curves { Some(growth(MAX_LEVELS, args.seed, &|n| bar.inc(n))?) } else { None };
    bar.finish_and_clear();
    Ok(Figures { report, hunt, growth })
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
