//! `error-time`: what an error costs, for every method: errors against simulated time, energy and traffic.

mod costs;
mod draw;
mod host;
mod less;
mod measure;
mod names;
mod options;
mod plan;
mod row;
mod sizes;
mod stage;

use super::folder::RunFolder;
use super::input::is_found;
use super::output::{busy, check_normals, check_target, print_line, progress, remark, write_file};
use super::report::{save, this_run, titled};
use super::sweep::SceneJobs;
use crate::cli::bars::Bars;
use lodray::format::Scene;
use lodray::hardware::unit_gates;
use lodray::method::{find, lod};
use lodray::report::diagram::{csv, diagrams, latex, left_out_csv};
use lodray::report::error_time::{
    ErrorTime, KIND, LeftOut, MethodEntry, Options, SceneEntry, SizeCosts, USUAL_COSTS, USUAL_ERRORS, VERSION, equal_errors, verdict_text,
    verdicts,
};
use lodray::report::page::{Documents, PICTURE_BYTES, embed};
use lodray::report::results_version;
use lodray::study::JobLines;
use lodray::study::count;
use measure::Bench;
use names::plain;
use plan::Plan;
use row::{Measured, ViewRow};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use xxhash_rust::xxh3::xxh3_64;

pub use options::Args;

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
    builds: &'a [row::BuildTime],
    settings: &'a [row::HostTime],
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let plan = args.plan()?;
    let inputs: Vec<_> = plan.jobs.files.iter().map(PathBuf::as_path).collect();
    let mut folder = RunFolder::open(&args.out, [DOCUMENT, TABLE, LATEX, LEFT_OUT, HOST, VERDICT, PAGE], &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;
    let lines = args.out.join(LINES);
    check_target(&lines, &inputs)?;
    folder.continues(LINES)?;
    let mut rows = JobLines::open(&lines, &Bars)?;
    folder.keep(LINES)?;
    folder.keep_aside(&lines)?;
    let done = rows.done();
    let mut keys = Vec::new();
    let bar = progress(plan.views() as u64, "views");
    for scene in &plan.jobs.scenes {
        let views = scene.views.iter().enumerate();
        // Sizes of the frame are compared at one view: a near one, where they matter most.
        let sized = (scene.views.len().max(1) - 1) / 3;
        let found = is_found(Path::new(&scene.path()), &args.input);
        let key = |view, k| plan.key(scene, view, k == sized, found);
        let views: Vec<_> = views.map(|(k, view)| Ok((k, view, key(view, k)?))).collect::<anyhow::Result<_>>()?;
        keys.extend(views.iter().map(|(_, _, key)| key.clone()));
        let left: Vec<_> = views.into_iter().filter(|(_, _, key)| !done.contains(key)).collect();
        if left.is_empty() {
            continue;
        }
        let failure =
            |key: &String, error: &anyhow::Error| ViewRow { key: key.clone(), measured: None, error: Some(crate::one_line(error)) };
        let open = || {
            let made = scene.open()?;
            check_normals(&made, "a picture")?;
            args.with_input(made, &scene.path())
        };
        let made = match open() {
            Ok(made) => made,
            Err(error) => {
                left.iter().try_for_each(|(_, _, key)| rows.add(failure(key, &error)))?;
                continue;
            }
        };
        let bench = Bench::new(&plan, &made, (entry(scene, &made), scene.path()), &cache)?;
        for (k, view, key) in &left {
            let prefix = format!("{}-{k}", plain(&scene.name));
            let row = match bench.view(view, &args.out, &prefix, *k == sized) {
                Ok(measured) => ViewRow { key: key.clone(), measured: Some(measured), error: None },
                Err(error) => failure(key, &error),
            };
            rows.add(row)?;
            bar.inc(1);
            bar.println(format!("{}: view {} of {} is done", scene.name, k + 1, scene.views.len()));
        }
    }
    bar.finish_and_clear();
    let measured: Vec<&Measured> = rows.of(&keys).filter_map(|row| row.measured.as_ref()).collect();
    for picture in measured.iter().flat_map(|measured| &measured.pictures) {
        folder.keep(&picture.file)?;
    }
    let document = document(&plan, &measured);
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
    Ok(if failed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn entry(jobs: &SceneJobs, scene: &Scene) -> SceneEntry {
    SceneEntry {
        name: jobs.name.clone(),
        file: jobs.file_name(),
        hash: format!("{:016x}", xxh3_64(scene.bytes())),
        levels: scene.levels(),
        base_triangles: scene.trees() as u64,
        finest_triangles: scene.finest_triangles(),
        bounds: scene.meta().bounds.name().to_owned(),
        input_triangles: scene.input().map(Scene::finest_triangles),
    }
}

/// All views in one document, their scenes and machines numbered.
fn document(plan: &Plan, measured: &[&Measured]) -> ErrorTime {
    let mut scenes: Vec<SceneEntry> = Vec::new();
    let (mut views, mut points, mut pictures, mut traces) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (number, of) in measured.iter().enumerate() {
        let scene = scenes.iter().position(|scene| *scene == of.scene).unwrap_or_else(|| {
            scenes.push(of.scene.clone());
            scenes.len() - 1
        });
        let mut view = of.view.clone();
        view.scene = scene;
        views.push(view);
        points.extend(of.points.iter().cloned().map(|mut point| {
            point.view = number;
            point
        }));
        pictures.extend(of.pictures.iter().cloned().map(|mut picture| {
            picture.view = number;
            picture
        }));
        traces.extend(of.traces.iter().cloned().map(|mut grid| {
            grid.view = number;
            grid
        }));
    }
    let left_out = measured.iter().enumerate().flat_map(|(number, of)| {
        of.left_out.iter().cloned().map(move |mut left| {
            left.point.view = number;
            left
        })
    });
    let mut left_out: Vec<LeftOut> = left_out.collect();
    let sizes = measured.iter().enumerate().flat_map(|(view, of)| of.sizes.iter().cloned().map(move |size| SizeCosts { view, ..size }));
    let mut sizes: Vec<SizeCosts> = sizes.collect();
    let machines = plan.machines();
    // A target is a machine with a way to compute; the same machine is listed once.
    for point in &mut points {
        let unit = find(&point.method).and_then(|method| method.unit);
        for costs in &mut point.costs {
            costs.machine = plan.machine_of(costs.machine, &machines);
            costs.unit_gates =
                unit.zip(machines.get(costs.machine)).and_then(|(unit, machine)| unit_gates(unit, &machine.description.units.config()));
        }
    }
    for costs in left_out.iter_mut().map(|left| &mut left.point.costs).chain(sizes.iter_mut().map(|size| &mut size.costs)).flatten() {
        costs.machine = plan.machine_of(costs.machine, &machines);
    }
    let method = |chosen: &lodray::study::Chosen| MethodEntry {
        name: chosen.method.name.to_owned(),
        knob: chosen.method.error.map(|error| error.knob.name.to_owned()),
        in_steps: chosen.method.error.is_some_and(|error| error.in_steps),
        help: chosen.method.help.to_owned(),
    };
    let is_measured = |chosen: &lodray::study::Chosen| points.iter().any(|point| point.method == chosen.method.name);
    let mut document = ErrorTime {
        kind: KIND.to_owned(),
        version: VERSION,
        program: format!("lodray {}", results_version()),
        options: Options {
            error_size: plan.measure.error_size,
            samples: plan.sides.iter().map(|side| side * side).collect(),
            shading: plan.measure.shading.name().to_owned(),
            pixels_per_degree: plan.measure.pixels_per_degree,
            nearest_stride: plan.measure.stride,
        },
        scenes,
        machines,
        // Those over the input are of no scene that was generated.
        methods: plan.jobs.methods.iter().filter(|chosen| is_measured(chosen)).map(method).collect(),
        views,
        points,
        equal_error: Vec::new(),
        pictures,
        traces,
        sizes,
        left_out,
    };
    document.equal_error = equal_errors(&document, lod::METHOD.name);
    document
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
    let pictures = busy("pictures of the page", || embed(&document.pictures, folder, PICTURE_BYTES))?;
    let documents = Documents { error_time: Some(document), pictures, runs: vec![this_run(inputs)?], ..Documents::default() };
    save(path, &titled(documents)).map(drop)
}
