//! Sweeps: each view of each scene, with each method, on each machine.

use super::cache::Cache;
use super::chosen::Chosen;
use super::error::{StudyError, one_line};
use super::job_lines::JobLines;
use super::jobs::{Jobs, SceneJobs, ViewJob};
use super::means::Means;
use super::pass::simulate;
use super::progress::Progress;
use super::pruned::{self, check_normals};
use super::rows::Row;
use super::shards::{Part, Piece, Pieces, Spent, opening, rays};
use super::shot::Shot;
use super::workers::in_order;
use crate::format::Scene;
use crate::method::{Method, reference};
use crate::rays::{Camera, ModelSpace};
use crate::report::page::ImageFigures;
use crate::scene::{Outcome, Pass, PassRays, Target};
use std::collections::HashSet;
use std::error::Error;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Jobs that share a functional pass: their keys and targets.
struct Group<'a> {
    view: &'a ViewJob,
    chosen: &'a Chosen,
    jobs: Vec<(String, Target)>,
}

/// What is left to do.
struct Sweep<'a> {
    jobs: &'a Jobs,
    means: &'a Means<'a>,
    at_once: usize,
    rows: &'a mut JobLines<Row>,
    part: Part<'a>,
}

/// Runs the jobs that `rows` has not yet, `at_once` frames at once, and adds a row for each, in their order. Gives the names of all jobs: [`JobLines::of`] finds their
/// rows, and [`csv`](super::csv) makes a table of them.
///
/// # Errors
/// A row cannot be written, or a file of a machine cannot be read. What fails of a job is a row of its own.
pub fn sweep(jobs: &Jobs, rows: &mut JobLines<Row>, at_once: usize, means: &Means<'_>) -> Result<Vec<String>, StudyError> {
    sweep_part(jobs, Part::ALL, rows, at_once, means)
}

/// The same of some of the jobs: the others are left out, but their names are given as well.
///
/// # Errors
/// As [`sweep`].
pub fn sweep_part(
    jobs: &Jobs,
    part: Part<'_>,
    rows: &mut JobLines<Row>,
    at_once: usize,
    means: &Means<'_>,
) -> Result<Vec<String>, StudyError> {
    let done = rows.done();
    let mut sweep = Sweep { jobs, means, at_once, rows, part };
    let mut keys = Vec::new();
    for scene in &jobs.scenes {
        let groups = sweep.groups(scene, &done, &mut keys)?;
        sweep.scene(scene, &groups)?;
    }
    Ok(keys)
}

/// The jobs in pieces that are not split any further, in their order, and what opening each scene takes: jobs that share a pass of rays are one piece.
///
/// # Errors
/// As [`Jobs::key`].
pub fn sweep_pieces(jobs: &Jobs) -> Result<Pieces, StudyError> {
    let mut pieces = Vec::new();
    // A picture and its reference, which no machine replays, take about as long as the frame's own rays.
    let times = if jobs.error { 2 } else { 1 };
    for (scene, of) in jobs.scenes.iter().enumerate() {
        for view in &of.views {
            let estimate = rays(view.size.map(u64::from).iter().product(), times, &jobs.targets);
            for chosen in &jobs.methods {
                let keys = jobs.targets.iter().map(|target| jobs.key(of, view, chosen, target)).collect::<Result<_, _>>()?;
                pieces.push(Piece { scene, keys, estimate });
            }
        }
    }
    let openings = jobs.scenes.iter().map(|scene| opening(scene, jobs.methods.iter().map(|chosen| chosen.method)));
    Ok(Pieces { all: pieces, openings: openings.collect() })
}

impl<'a> Sweep<'a> {
    /// What a scene's jobs are that are not done; all keys are added to `keys`.
    fn groups(&self, scene: &'a SceneJobs, done: &HashSet<String>, keys: &mut Vec<String>) -> Result<Vec<Group<'a>>, StudyError> {
        let mut groups = Vec::new();
        for view in &scene.views {
            for chosen in &self.jobs.methods {
                let mut jobs = Vec::new();
                for target in &self.jobs.targets {
                    let key = self.jobs.key(scene, view, chosen, target)?;
                    if !done.contains(&key) && self.part.has(&key) {
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
    fn scene(&mut self, scene: &SceneJobs, groups: &[Group<'_>]) -> Result<(), StudyError> {
        if groups.is_empty() {
            return Ok(());
        }
        let begun = Instant::now();
        let opened = (self.means.open)(scene);
        (self.part.spent)(Spent::Opening(&scene.name), begun.elapsed());
        let made = match opened {
            Ok(made) => made,
            Err(error) => return groups.iter().try_for_each(|group| self.failed(scene, group, &*error)),
        };
        let workshop = Workshop {
            jobs: self.jobs,
            cache: self.means.cache,
            progress: self.means.progress,
            space: ModelSpace::of(&made),
            scene: &made,
            built: Mutex::default(),
            truth: Mutex::default(),
        };
        let work = |group: &Group<'_>| {
            let begun = Instant::now();
            (workshop.group(group), begun.elapsed())
        };
        in_order(groups, self.at_once, work, |group, (rows, time)| {
            match rows {
                Err(error) => self.failed(scene, group, &error)?,
                Ok(rows) => rows.into_iter().try_for_each(|row| self.rows.add(Row { scene: scene.name.clone(), ..row }))?,
            }
            // They share one pass of rays: which of them took how much of it is no question.
            let each = time / group.jobs.len().max(1) as u32;
            group.jobs.iter().for_each(|(key, _)| (self.part.spent)(Spent::Job(key), each));
            Ok(())
        })
    }

    fn failed(&mut self, scene: &SceneJobs, group: &Group<'_>, error: &dyn Error) -> Result<(), StudyError> {
        for (key, _) in &group.jobs {
            self.rows.add(Row { scene: scene.name.clone(), ..failure(key, error) })?;
        }
        Ok(())
    }
}

fn failure(key: &str, error: &dyn Error) -> Row {
    Row { key: key.to_owned(), scene: String::new(), result: None, image: None, error: Some(one_line(error)) }
}

/// A scene and what was made of it, for several groups at once.
struct Workshop<'a> {
    jobs: &'a Jobs,
    cache: &'a Cache,
    progress: &'a dyn Progress,
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
    fn group(&self, group: &Group<'_>) -> Result<Vec<Row>, StudyError> {
        let camera = group.view.camera(&self.space)?;
        pruned::check(self.scene, &camera, group.chosen.delta())?;
        if self.jobs.error {
            check_normals(self.scene, "the error of a picture")?;
            if group.chosen.method.of_input() {
                return Err(StudyError::OtherTriangles(group.chosen.method.name));
            }
        }
        let method = self.made(group.chosen)?;
        let image = if self.jobs.error { Some(self.image_error(group, &*method, &camera)?) } else { None };
        let pass = Pass {
            scene: self.scene,
            space: &self.space,
            registered: group.chosen.method,
            knobs: &group.chosen.knobs,
            method: &*method,
            rays: PassRays::Camera(group.view.frame(&self.space)?),
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
        Ok(simulate(&pass, &targets, self.progress).into_iter().zip(&group.jobs).map(row).collect())
    }

    /// The method that is made for these choices, now or before.
    fn made(&self, chosen: &Chosen) -> Result<Arc<dyn Method>, StudyError> {
        let key = Chosen { knobs: chosen.knobs.clone().of_scene(chosen.method.knobs), ..*chosen };
        let mut built = self.built.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, method)) = built.iter().find(|(of, _)| *of == key) {
            return Ok(Arc::clone(method));
        }
        let method: Arc<dyn Method> = Arc::from(chosen.make(self.scene, self.cache, self.progress)?.0);
        built.push((key, Arc::clone(&method)));
        Ok(method)
    }

    fn image_error(&self, group: &Group<'_>, method: &dyn Method, camera: &Camera) -> Result<ImageFigures, StudyError> {
        let (view, delta) = (group.view, group.chosen.delta());
        let mut truth = self.truth.lock().unwrap_or_else(PoisonError::into_inner);
        let Truth { reference, last } = &mut *truth;
        let reference = match reference {
            Some(reference) => reference,
            None => reference.insert(Chosen::plain(&reference::METHOD).make(self.scene, self.cache, self.progress)?.0),
        };
        let full = match last {
            Some((of, full)) if *of == *view => full,
            _ => {
                &last
                    .insert((
                        view.clone(),
                        Shot::plain(&**reference, self.scene, &self.space, camera, delta, ("full resolution", self.progress)),
                    ))
                    .1
            }
        };
        let shot = Shot::plain(method, self.scene, &self.space, camera, delta, ("picture", self.progress));
        let error = shot.compared(full, self.scene, camera);
        Ok(ImageFigures {
            rmse: error.image.rmse,
            psnr_db: error.image.psnr_db,
            geometry_pixels_mean: error.geometry_pixels.map(|off| off.mean),
        })
    }
}
