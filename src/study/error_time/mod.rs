//! What an error costs, for every method: errors against simulated time, energy and traffic.

mod costs;
mod document;
mod draw;
mod host;
mod less;
mod measure;
mod plan;
mod row;
mod sizes;
mod stage;

pub use document::document;
pub use less::in_machine;
pub use plan::{ErrorTimePlan, Measure, least_converged};
pub use row::{BuildTime, HostTime, Measured, ViewRow};

use super::error::{StudyError, one_line};
use super::job_lines::JobLines;
use super::jobs::SceneJobs;
use super::means::Means;
use super::shards::{Part, Piece, Pieces, Spent, opening, rays};
use crate::format::Scene;
use crate::report::error_time::SceneEntry;
use crate::report::plain_names;
use measure::Bench;
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use xxhash_rust::xxh3::xxh3_64;

/// Measures the views of `plan` that `rows` has not yet, and adds a row for each; pictures go to `folder`. `is_input_found` says whether the mesh that a scene was
/// built from is at hand, which errors are against then. Gives the names of all views of the plan, in its order: [`JobLines::of`] finds their rows, and
/// [`document()`] makes one of them.
///
/// # Errors
/// A row cannot be written, or what the methods of a scene need cannot be built. What fails of a view is a row of its own.
pub fn error_time(
    plan: &ErrorTimePlan,
    rows: &mut JobLines<ViewRow>,
    folder: &Path,
    is_input_found: &dyn Fn(&SceneJobs) -> bool,
    means: &Means<'_>,
) -> Result<Vec<String>, StudyError> {
    error_time_part(plan, Part::ALL, rows, folder, is_input_found, means)
}

/// The same of some of the views: the others are left out, but their names are given as well.
///
/// # Errors
/// As [`error_time`].
pub fn error_time_part(
    plan: &ErrorTimePlan,
    part: Part<'_>,
    rows: &mut JobLines<ViewRow>,
    folder: &Path,
    is_input_found: &dyn Fn(&SceneJobs) -> bool,
    means: &Means<'_>,
) -> Result<Vec<String>, StudyError> {
    let done = rows.done();
    let mut keys = Vec::new();
    let bar = means.progress.begin("views", Some(part.keys.map_or(plan.views(), std::collections::HashSet::len) as u64));
    let files = plain_names(plan.jobs.scenes.iter().map(|scene| scene.name.as_str()));
    for (scene, file) in plan.jobs.scenes.iter().zip(&files) {
        let names = view_keys(plan, scene, is_input_found(scene))?;
        let sized = sized(scene);
        keys.extend(names.iter().cloned());
        let views = scene.views.iter().enumerate().zip(names).map(|((k, view), key)| (k, view, key));
        let left: Vec<_> = views.filter(|(_, _, key)| !done.contains(key) && part.has(key)).collect();
        if left.is_empty() {
            continue;
        }
        let failure = |key: &String, error: &dyn Error| ViewRow { key: key.clone(), measured: None, error: Some(one_line(error)) };
        let begun = Instant::now();
        let opened = (means.open)(scene);
        let made = match opened {
            Ok(made) => made,
            Err(error) => {
                left.iter().try_for_each(|(_, _, key)| rows.add(failure(key, &*error)))?;
                continue;
            }
        };
        let bench = Bench::new(plan, &made, (entry(scene, &made), scene.path()), (means.cache, means.progress))?;
        (part.spent)(Spent::Opening(&scene.name), begun.elapsed());
        for (k, view, key) in &left {
            let begun = Instant::now();
            let prefix = format!("{file}-{k}");
            let row = match bench.view(view, folder, &prefix, *k == sized) {
                Ok(measured) => ViewRow { key: key.clone(), measured: Some(measured), error: None },
                Err(error) => failure(key, &error),
            };
            rows.add(row)?;
            (part.spent)(Spent::Job(key), begun.elapsed());
            bar.step(1);
            bar.say(&format!("{}: view {} of {} is done", scene.name, k + 1, scene.views.len()));
        }
    }
    Ok(keys)
}

/// The views of a plan as pieces of work, in their order, and what opening each scene takes.
///
/// # Errors
/// As [`Jobs::key`](super::Jobs::key).
pub fn error_time_pieces(plan: &ErrorTimePlan, is_input_found: &dyn Fn(&SceneJobs) -> bool) -> Result<Pieces, StudyError> {
    // Each setting is drawn with all its samples and traced for machines, and compared.
    let samples = plan.sides.iter().map(|&side| u64::from(side * side)).sum::<u64>() + 1;
    let mut pieces = Vec::new();
    for (scene, of) in plan.jobs.scenes.iter().enumerate() {
        for (view, key) in of.views.iter().zip(view_keys(plan, of, is_input_found(of))?) {
            let estimate = rays(view.size.map(u64::from).iter().product(), samples, &plan.jobs.targets);
            pieces.push(Piece { scene, keys: vec![key], estimate });
        }
    }
    let openings = plan.jobs.scenes.iter().map(|scene| opening(scene, plan.jobs.methods.iter().map(|chosen| chosen.method)));
    Ok(Pieces { all: pieces, openings: openings.collect() })
}

/// The view of a scene at which sizes of the frame are compared: a near one, where they matter most.
fn sized(scene: &SceneJobs) -> usize {
    (scene.views.len().max(1) - 1) / 3
}

/// The names of a scene's views.
fn view_keys(plan: &ErrorTimePlan, scene: &SceneJobs, found: bool) -> Result<Vec<String>, StudyError> {
    let sized = sized(scene);
    scene.views.iter().enumerate().map(|(k, view)| plan.key(scene, view, k == sized, found)).collect()
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
