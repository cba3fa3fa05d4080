//! `sweep`: scenes, views and methods on machines, from a list of jobs.

mod charts;
mod check;
mod jobs;
mod labels;
mod list;

use super::args::whole;
use super::cache::CacheArgs;
use super::common::MAX_THREADS;
use super::folder::{Overrule, RunFolder, one_run};
use super::input::{InputArgs, with_input};
use super::job;
use super::output::{check_normals, check_target, print_line, remark, write_file};
use super::pictures::{Shot, shoot};
use super::render::compare_shots;
use super::report::PageArgs;
use crate::cli::bars::Bars;
use lodray::format::Scene;
use lodray::method::{Method, reference};
use lodray::rays::{Camera, ModelSpace};
use lodray::report::page::{Documents, ImageFigures, Simulation};
use lodray::scene::{Outcome, Pass, PassRays, Target};
use lodray::study::Cache;
use lodray::study::Chosen;
use lodray::study::JobLines;
use lodray::study::count;
use lodray::study::in_order;
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};

pub use jobs::{Jobs, Origin, SceneJobs, ViewJob};
pub use list::ListText;
use lodray::study::{Row, csv};

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
}

/// Jobs that share a functional pass: their keys and targets.
struct Group<'a> {
    view: &'a ViewJob,
    chosen: &'a Chosen,
    jobs: Vec<(String, Target)>,
}

/// What is left to do.
struct Sweep<'a> {
    jobs: &'a Jobs,
    input: &'a InputArgs,
    cache: &'a Cache,
    at_once: usize,
    rows: JobLines<Row>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let jobs = Jobs::of_views(&args.jobs)?;
    let inputs: Vec<_> = std::iter::once(&args.jobs).chain(&jobs.files).map(PathBuf::as_path).collect();
    args.page.check(&inputs)?;
    let mut folder = RunFolder::open(&args.out, [TABLE], &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;
    let lines = args.out.join(LINES);
    check_target(&lines, &inputs)?;
    folder.continues(LINES)?;
    let rows = JobLines::open(&lines, &Bars)?;
    folder.keep(LINES)?;
    folder.keep_aside(&lines)?;
    let done = rows.done();
    // Each machine's replay is a thread's work.
    let at_once = args.at_once.unwrap_or_else(|| rayon::current_num_threads().div_ceil(jobs.targets.len().max(1)));
    let mut sweep = Sweep { jobs: &jobs, input: &args.input, cache: &cache, at_once, rows };
    let mut keys = Vec::new();
    for scene in &jobs.scenes {
        let groups = sweep.groups(scene, &done, &mut keys)?;
        sweep.scene(scene, &groups)?;
    }
    write_file(&folder.staging().join(TABLE), csv(sweep.rows.of(&keys)))?;
    for (name, chart) in charts::charts(sweep.rows.of(&keys))? {
        write_file(&folder.staging().join(name), chart)?;
    }
    folder.finish()?;
    let simulation = |row: &Row| {
        let (scene, image) = (Some(row.scene.clone()), row.image);
        row.result.clone().map(|result| Simulation { scene, result, image })
    };
    let simulations = sweep.rows.of(&keys).filter_map(simulation).collect();
    args.page.write(Documents { simulations, ..Documents::default() }, &inputs)?;
    let failed: Vec<_> = sweep.rows.of(&keys).filter(|row| row.error.is_some()).collect();
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

impl<'a> Sweep<'a> {
    /// What a scene's jobs are that are not done; all keys are added to `keys`.
    fn groups(&self, scene: &'a SceneJobs, done: &HashSet<String>, keys: &mut Vec<String>) -> anyhow::Result<Vec<Group<'a>>> {
        let mut groups = Vec::new();
        for view in &scene.views {
            for chosen in &self.jobs.methods {
                let mut jobs = Vec::new();
                for target in &self.jobs.targets {
                    let key = self.jobs.key(scene, view, chosen, target)?;
                    if !done.contains(&key) {
                        jobs.push((key.clone(), target.clone()));
                    }
                    keys.push(key);
                }
                if !jobs.is_empty() {
                    groups.push(Group { view, chosen, jobs });
                }
            }
        }
        Ok(groups)
    }

    /// Runs a scene's jobs. What fails becomes a line; only lines that cannot be written end the sweep.
    fn scene(&mut self, scene: &SceneJobs, groups: &[Group<'_>]) -> anyhow::Result<()> {
        if groups.is_empty() {
            return Ok(());
        }
        let opened = scene.open().and_then(|made| with_input(made, Path::new(&scene.path()), self.input, &self.jobs.methods));
        let made = match opened {
            Ok(made) => made,
            Err(error) => return groups.iter().try_for_each(|group| self.failed(scene, group, &error)),
        };
        let workshop = Workshop {
            jobs: self.jobs,
            cache: self.cache,
            space: ModelSpace::of(&made),
            scene: &made,
            built: Mutex::default(),
            truth: Mutex::default(),
        };
        let work = |group: &Group<'_>| workshop.group(group);
        in_order(groups, self.at_once, work, |group, rows| match rows {
            Err(error) => self.failed(scene, group, &error),
            Ok(rows) => rows.into_iter().try_for_each(|row| Ok(self.rows.add(Row { scene: scene.name.clone(), ..row })?)),
        })
    }

    fn failed(&mut self, scene: &SceneJobs, group: &Group<'_>, error: &anyhow::Error) -> anyhow::Result<()> {
        for (key, _) in &group.jobs {
            self.rows.add(Row { scene: scene.name.clone(), ..failure(key, error) })?;
        }
        Ok(())
    }
}

fn failure(key: &str, error: &anyhow::Error) -> Row {
    Row { key: key.to_owned(), scene: String::new(), result: None, image: None, error: Some(crate::one_line(error)) }
}

/// A scene and what was made of it, for several groups at once.
struct Workshop<'a> {
    jobs: &'a Jobs,
    cache: &'a Cache,
    scene: &'a Scene,
    space: ModelSpace,
    /// Methods by all that what they need depends on, which is not their quality. Who makes one keeps the others waiting: all threads are at it.
    built: Mutex<Vec<(Chosen, Arc<dyn Method>)>>,
    /// Pictures are taken one after the other, each by all threads.
    truth: Mutex<Truth>,
}

/// The reference, and its picture of the last view.
#[derive(Default)]
struct Truth {
    reference: Option<Box<dyn Method>>,
    last: Option<(ViewJob, Shot)>,
}

impl Workshop<'_> {
    fn group(&self, group: &Group<'_>) -> anyhow::Result<Vec<Row>> {
        let camera = group.view.camera(&self.space)?;
        job::check(self.scene, &camera, group.chosen.delta())?;
        if self.jobs.error {
            check_normals(self.scene, "the error of a picture")?;
            let name = group.chosen.method.name;
            anyhow::ensure!(
                !group.chosen.method.of_input,
                "error: a sweep has no errors of {name}, whose triangles are not the scene's: error-time has"
            );
        }
        let method = self.made(group.chosen)?;
        let image = if self.jobs.error { Some(self.image_error(group, &*method, &camera)?) } else { None };
        let pass = Pass {
            scene: self.scene,
            space: &self.space,
            registered: group.chosen.method,
            knobs: &group.chosen.knobs,
            method: &*method,
            rays: PassRays::Camera(camera),
        };
        let targets: Vec<_> = group.jobs.iter().map(|(_, target)| target.clone()).collect();
        let row = |(result, (key, _)): (Outcome, &(String, Target))| match result {
            Err(error) => failure(key, &error.into()),
            Ok((mut result, _)) => {
                if !self.jobs.intervals {
                    result.intervals = Vec::new();
                }
                Row { key: key.clone(), scene: String::new(), result: Some(result), image, error: None }
            }
        };
        Ok(lodray::study::simulate(&pass, &targets, &Bars).into_iter().zip(&group.jobs).map(row).collect())
    }

    /// The method that is made for these choices, now or before.
    fn made(&self, chosen: &Chosen) -> anyhow::Result<Arc<dyn Method>> {
        let key = Chosen { knobs: chosen.knobs.clone().of_scene(chosen.method.knobs), ..*chosen };
        let mut built = self.built.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, method)) = built.iter().find(|(of, _)| *of == key) {
            return Ok(Arc::clone(method));
        }
        let method: Arc<dyn Method> = Arc::from(chosen.make(self.scene, self.cache, &Bars)?.0);
        built.push((key, Arc::clone(&method)));
        Ok(method)
    }

    fn image_error(&self, group: &Group<'_>, method: &dyn Method, camera: &Camera) -> anyhow::Result<ImageFigures> {
        let (view, delta) = (group.view, group.chosen.delta());
        let mut truth = self.truth.lock().unwrap_or_else(PoisonError::into_inner);
        let Truth { reference, last } = &mut *truth;
        let reference = match reference {
            Some(reference) => reference,
            None => reference.insert(Chosen::plain(&reference::METHOD).make(self.scene, self.cache, &Bars)?.0),
        };
        let full = match last {
            Some((of, full)) if *of == *view => full,
            _ => &last.insert((view.clone(), shoot(&**reference, self.scene, &self.space, camera, delta, "full resolution"))).1,
        };
        let shot = shoot(method, self.scene, &self.space, camera, delta, "picture");
        let error = compare_shots(&shot, full, self.scene, camera);
        Ok(ImageFigures {
            rmse: error.image.rmse,
            psnr_db: error.image.psnr_db,
            geometry_pixels_mean: error.geometry_pixels.map(|off| off.mean),
        })
    }
}
