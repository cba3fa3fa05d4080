//! `error-time`: what an error costs, for every method: errors against simulated time, energy and traffic.

mod options;

use super::bars::Bars;
use super::folder::RunFolder;
use super::input::is_found;
use super::output::{busy, check_target, print_line, remark, write_file};
use super::report::{save, this_run, titled};
use super::shard::{Planned, Study};
use super::sweep::open_scene;
use anyhow::Context;
use lodray::picture::Shading;
use lodray::report::diagram::{csv, diagrams, latex, left_out_csv};
use lodray::report::error_time::{ErrorTime, USUAL_COSTS, USUAL_ERRORS, verdict_text, verdicts};
use lodray::report::is_file_name;
use lodray::report::page::{Documents, PICTURE_BYTES, embed};
use lodray::study::pruned::check_normals;
use lodray::study::shards::{FOLDER, Part, Pieces, gathered};
use lodray::study::{
    BuildTime, ErrorTimePlan, HostTime, JobLines, Means, Measured, SceneJobs, ViewRow, count, document, error_time_part, error_time_pieces,
};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

pub use options::Args;

/// Methods whose triangles stand for no known triangles of full resolution.
const OWN_TRIANGLES: [&str; 3] = ["cluster", "cluster-paper", "rlod"];
/// Views that are done, for a run that goes on.
const LINES: &str = "views.jsonl";
const DOCUMENT: &str = "error-time.json";
const TABLE: &str = "error-time.csv";
/// What was left out, if that was asked for.
const LEFT_OUT: &str = "left-out.csv";
const LATEX: &str = "error-time.tex";
const HOST: &str = "host-times.json";
/// Which method is the cheapest at each view.
const VERDICT: &str = "verdict.txt";
const PAGE: &str = "report.html";

/// Times on the host, by view.
#[derive(Serialize)]
struct HostTimes<'a> {
    scene: &'a str,
    distance: f64,
    builds: &'a [BuildTime],
    settings: &'a [HostTime],
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let plan = args.plan()?;
    let Some(share) = args.shard.share()? else {
        return results(args, &plan, |rows| work(args, &plan, Part::ALL, rows, &args.out));
    };
    let study = Study { out: &args.out, lines: Some(args.out.join(LINES)), overrule: &args.overrule, pieces: pieces(args, &plan)? };
    let work = |part: Part<'_>, rows: &mut JobLines<ViewRow>, folder: &Path| work(args, &plan, part, rows, folder).map(drop);
    args.shard.run(share, &study, work, |row: &ViewRow| row.error.as_ref())
}

/// Puts the shards of a run together.
pub fn merge(args: &Args) -> anyhow::Result<ExitCode> {
    let plan = args.plan()?;
    let keys: Vec<String> = pieces(args, &plan)?.all.into_iter().flat_map(|piece| piece.keys).collect();
    let lines = gathered::<ViewRow>(&args.out, Some(&args.out.join(LINES)), &keys)?;
    results(args, &plan, |rows| {
        for picture in lines.lines().filter_map(|row| row.measured.as_ref()).flat_map(|measured| &measured.pictures) {
            anyhow::ensure!(is_file_name(&picture.file), "{}: '{}' is no name of a picture", args.out.join(FOLDER).display(), picture.file);
            let (from, to) = (args.out.join(FOLDER).join(&picture.file), args.out.join(&picture.file));
            let bytes = std::fs::read(&from).with_context(|| format!("cannot read {}", from.display()))?;
            write_file(&to, bytes)?;
        }
        lines.add_to(rows, &keys)?;
        Ok(keys)
    })
}

/// What shards of a run would do.
pub fn planned(args: &Args) -> anyhow::Result<Planned> {
    let plan = args.plan()?;
    Planned::new(&args.shard, &args.out, plan.jobs.files.iter().cloned().collect(), pieces(args, &plan)?)
}

fn pieces(args: &Args, plan: &ErrorTimePlan) -> anyhow::Result<Pieces> {
    Ok(error_time_pieces(plan, &|scene| has_input(args, scene))?)
}

/// Whether the mesh that a scene was built from is at hand.
fn has_input(args: &Args, scene: &SceneJobs) -> bool {
    is_found(Path::new(&scene.path()), &args.input)
}

/// Measures the views of a part that `rows` has not yet; pictures go to `folder`. Gives the names of all views.
fn work(args: &Args, plan: &ErrorTimePlan, part: Part<'_>, rows: &mut JobLines<ViewRow>, folder: &Path) -> anyhow::Result<Vec<String>> {
    let cache = args.cache.cache(Some(&args.out))?;
    let opened = |scene: &SceneJobs| {
        let made = open_scene(scene)?;
        check_normals(&made, "a picture")?;
        Ok(args.with_input(made, &scene.path())?)
    };
    let means = Means { cache: &cache, open: &opened, progress: &Bars };
    Ok(error_time_part(plan, part, rows, folder, &|scene| has_input(args, scene), &means)?)
}

/// The figures of all views, once `fill` has added the lines that are not there yet and told the names of all.
fn results(
    args: &Args,
    plan: &ErrorTimePlan,
    fill: impl FnOnce(&mut JobLines<ViewRow>) -> anyhow::Result<Vec<String>>,
) -> anyhow::Result<ExitCode> {
    let inputs: Vec<_> = plan.jobs.files.iter().map(PathBuf::as_path).collect();
    let mut folder = RunFolder::open(&args.out, [DOCUMENT, TABLE, LATEX, LEFT_OUT, HOST, VERDICT, PAGE], &inputs, &args.overrule)?;
    // Refused before there is a file of lines.
    args.cache.cache(Some(&args.out))?;
    let lines = args.out.join(LINES);
    check_target(&lines, &inputs)?;
    folder.continues(LINES)?;
    let mut rows = JobLines::open(&lines, &Bars)?;
    folder.keep(LINES)?;
    folder.keep_aside(&lines)?;
    let keys = fill(&mut rows)?;
    let measured: Vec<&Measured> = rows.of(&keys).filter_map(|row| row.measured.as_ref()).collect();
    for picture in measured.iter().flat_map(|measured| &measured.pictures) {
        folder.keep(&picture.file)?;
    }
    let document = document(plan, &measured);
    write(folder.staging(), &document, &measured)?;
    let verdict = verdict_text(&verdicts(&document));
    write_file(&folder.staging().join(VERDICT), &verdict)?;
    page(&folder.staging().join(PAGE), document, &args.out, &inputs)?;
    folder.finish()?;
    let failed: Vec<_> = rows.of(&keys).filter_map(|row| Some((&row.key, row.error.as_ref()?))).collect();
    remark(&format!("{}, {} failed; figures in {}", count(keys.len(), "view"), failed.len(), args.out.display()))?;
    for (key, why) in &failed {
        print_line(&format!("failed: {key}: {why}"))?;
    }
    if !verdict.is_empty() {
        remark(verdict.trim_end())?;
    }
    if plan.measure.shading == Shading::Facets && plan.jobs.methods.iter().any(|chosen| OWN_TRIANGLES.contains(&chosen.method.name)) {
        remark(
            "pictures of clusters and R-LODs have one normal a hit, all others those of the facets below it: --shading full gives each one",
        )?;
    }
    Ok(if failed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn write(folder: &Path, document: &ErrorTime, measured: &[&Measured]) -> anyhow::Result<()> {
    write_file(&folder.join(DOCUMENT), serde_json::to_string(document)? + "\n")?;
    write_file(&folder.join(TABLE), csv(document))?;
    write_file(&folder.join(LATEX), latex(document))?;
    if !document.left_out.is_empty() {
        write_file(&folder.join(LEFT_OUT), left_out_csv(document))?;
    }
    let drawn = busy("diagrams", || diagrams(document, &USUAL_ERRORS, &USUAL_COSTS))?;
    drawn.iter().try_for_each(|(name, bytes)| write_file(&folder.join(name), bytes))?;
    let times = measured.iter().filter(|of| !of.host.is_empty());
    let times = times.map(|of| HostTimes { scene: &of.scene.name, distance: of.view.distance, builds: &of.builds, settings: &of.host });
    let times: Vec<_> = times.collect();
    write_file(&folder.join(HOST), serde_json::to_string_pretty(&times)? + "\n")
}

/// The page, with the pictures in `folder`.
fn page(path: &Path, document: ErrorTime, folder: &Path, inputs: &[&Path]) -> anyhow::Result<()> {
    let pictures = busy("pictures of the page", || embed(&document.picture_files(folder), PICTURE_BYTES))?;
    let documents = Documents { error_time: Some(document), pictures, runs: vec![this_run(inputs)?], ..Documents::default() };
    save(path, &titled(documents)).map(drop)
}
