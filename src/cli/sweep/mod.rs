//! `sweep`: scenes, views and methods on machines, from a list of jobs.

mod charts;
mod check;
mod jobs;
mod labels;
mod list;
mod rows;

use super::cache::{Cache, CacheArgs};
use super::folder::{Overrule, RunFolder, one_run};
use super::job;
use super::job_lines::{JobLines, keep_aside};
use super::method::Chosen;
use super::output::{check_normals, check_target, print_line, remark, write_file};
use super::pass::{Outcome, Pass, PassRays, Target};
use super::pictures::{Shot, shoot};
use super::render::compare_shots;
use super::report::PageArgs;
use anyhow::Context;
use lodray::format::Scene;
use lodray::method::{Method, reference};
use lodray::rays::{Camera, ModelSpace};
use lodray::report::page::{Documents, ImageFigures, Simulation};
use std::collections::HashSet;
use std::path::PathBuf;
use std::process::ExitCode;

pub use jobs::{Jobs, Origin, SceneJobs, ViewJob};
pub use list::ListText;
pub use rows::Row;
use rows::csv;

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
    #[command(flatten)]
    overrule: Overrule,
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
    cache: &'a Cache,
    rows: JobLines<Row>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let jobs = Jobs::of_views(&args.jobs)?;
    let inputs: Vec<_> = std::iter::once(&args.jobs).chain(&jobs.files).map(PathBuf::as_path).collect();
    args.page.check(&inputs)?;
    let mut folder = RunFolder::open(&args.out, [TABLE], &inputs, &args.overrule)?;
    let cache = Cache::new(&args.cache, Some(&args.out))?;
    let lines = args.out.join(LINES);
    check_target(&lines, &inputs)?;
    let rows = JobLines::open(&lines)?;
    folder.keep(LINES)?;
    keep_aside(&mut folder, &lines)?;
    let done = rows.done();
    let mut sweep = Sweep { jobs: &jobs, cache: &cache, rows };
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
    let jobs = |n: usize| format!("{n} {}", if n == 1 { "job" } else { "jobs" });
    remark(&format!("{}, {before} of them done before, {} failed; results in {}", jobs(keys.len()), failed.len(), args.out.display()))?;
    let others = done.len() - before;
    if others > 0 {
        remark(&format!("{LINES} has results of {} more, which are not in the list", jobs(others)))?;
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
        let made = match scene.open() {
            Ok(made) => made,
            Err(error) => return groups.iter().try_for_each(|group| self.failed(scene, group, &error)),
        };
        let mut workshop =
            Workshop { jobs: self.jobs, cache: self.cache, space: ModelSpace::of(&made), scene: &made, built: Vec::new(), truth: None };
        for group in groups {
            match workshop.group(group) {
                Err(error) => self.failed(scene, group, &error)?,
                Ok(rows) => {
                    for row in rows {
                        self.rows.add(Row { scene: scene.name.clone(), ..row })?;
                    }
                }
            }
        }
        Ok(())
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

/// A view, and its picture.
type LastShot = Option<(ViewJob, Shot)>;

/// A scene and what was made of it.
struct Workshop<'a> {
    jobs: &'a Jobs,
    cache: &'a Cache,
    scene: &'a Scene,
    space: ModelSpace,
    /// Methods by all that what they need depends on, which is not their quality.
    built: Vec<(Chosen, Box<dyn Method + 'a>)>,
    /// The reference, and its picture of the last view.
    truth: Option<(Box<dyn Method + 'a>, LastShot)>,
}

impl Workshop<'_> {
    fn group(&mut self, group: &Group<'_>) -> anyhow::Result<Vec<Row>> {
        let camera = group.view.camera(&self.space)?;
        job::check(self.scene, &camera, group.chosen.delta())?;
        if self.jobs.error {
            check_normals(self.scene, "the error of a picture")?;
        }
        let at = self.made(group.chosen)?;
        let image = if self.jobs.error { Some(self.image_error(group.view, at, group.chosen.delta(), &camera)?) } else { None };
        let pass = Pass {
            scene: self.scene,
            space: &self.space,
            chosen: group.chosen,
            method: &*self.built[at].1,
            rays: PassRays::Camera(camera),
        };
        let targets: Vec<_> = group.jobs.iter().map(|(_, target)| target.clone()).collect();
        let row = |(result, (key, _)): (Outcome, &(String, Target))| match result {
            Err(error) => failure(key, &error),
            Ok((mut result, _)) => {
                if !self.jobs.intervals {
                    result.intervals = Vec::new();
                }
                Row { key: key.clone(), scene: String::new(), result: Some(result), image, error: None }
            }
        };
        Ok(pass.run(&targets)?.into_iter().zip(&group.jobs).map(row).collect())
    }

    /// Where the method is that was made for these choices, now or before.
    fn made(&mut self, chosen: &Chosen) -> anyhow::Result<usize> {
        let key = Chosen { knobs: chosen.knobs.clone().of_scene(chosen.method.knobs), ..*chosen };
        if let Some(at) = self.built.iter().position(|(of, _)| *of == key) {
            return Ok(at);
        }
        let (method, _) = chosen.make(self.scene, self.cache)?;
        self.built.push((key, method));
        Ok(self.built.len() - 1)
    }

    fn image_error(&mut self, view: &ViewJob, at: usize, delta: f64, camera: &Camera) -> anyhow::Result<ImageFigures> {
        if self.truth.is_none() {
            self.truth = Some((Chosen::plain(&reference::METHOD).make(self.scene, self.cache)?.0, None));
        }
        let (reference, last) = self.truth.as_mut().context("no reference")?;
        if last.as_ref().is_none_or(|(of, _)| of != view) {
            *last = Some((view.clone(), shoot(&**reference, self.scene, &self.space, camera, delta, "full resolution")));
        }
        let (_, truth) = last.as_ref().context("no picture of the reference")?;
        let shot = shoot(&*self.built[at].1, self.scene, &self.space, camera, delta, "picture");
        let error = compare_shots(&shot, truth, self.scene, camera);
        Ok(ImageFigures {
            rmse: error.image.rmse,
            psnr_db: error.image.psnr_db,
            geometry_pixels_mean: error.geometry_pixels.map(|off| off.mean),
        })
    }
}
