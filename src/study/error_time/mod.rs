//! What an error costs, for every method: errors against simulated time, energy and traffic.

mod costs;
mod document;
mod draw;
mod host;
mod less;
mod measure;
mod names;
mod plan;
mod row;
mod sizes;
mod stage;

pub use document::document;
pub use less::in_machine;
pub use plan::{ErrorTimePlan, Measure};
pub use row::{BuildTime, HostTime, Measured, ViewRow};

use super::error::{StudyError, one_line};
use super::job_lines::JobLines;
use super::jobs::SceneJobs;
use super::means::Means;
use crate::format::Scene;
use crate::report::error_time::SceneEntry;
use measure::Bench;
use names::plain;
use std::error::Error;
use std::path::Path;
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
    let done = rows.done();
    let mut keys = Vec::new();
    let bar = means.progress.begin("views", Some(plan.views() as u64));
    for scene in &plan.jobs.scenes {
        let views = scene.views.iter().enumerate();
        // Sizes of the frame are compared at one view: a near one, where they matter most.
        let sized = (scene.views.len().max(1) - 1) / 3;
        let found = is_input_found(scene);
        let key = |view, k| plan.key(scene, view, k == sized, found);
        let views: Vec<_> = views.map(|(k, view)| Ok((k, view, key(view, k)?))).collect::<Result<_, StudyError>>()?;
        keys.extend(views.iter().map(|(_, _, key)| key.clone()));
        let left: Vec<_> = views.into_iter().filter(|(_, _, key)| !done.contains(key)).collect();
        if left.is_empty() {
            continue;
        }
        let failure = |key: &String, error: &dyn Error| ViewRow { key: key.clone(), measured: None, error: Some(one_line(error)) };
        let made = match (means.open)(scene) {
            Ok(made) => made,
            Err(error) => {
                left.iter().try_for_each(|(_, _, key)| rows.add(failure(key, &*error)))?;
                continue;
            }
        };
        let bench = Bench::new(plan, &made, (entry(scene, &made), scene.path()), (means.cache, means.progress))?;
        for (k, view, key) in &left {
            let prefix = format!("{}-{k}", plain(&scene.name));
            let row = match bench.view(view, folder, &prefix, *k == sized) {
                Ok(measured) => ViewRow { key: key.clone(), measured: Some(measured), error: None },
                Err(error) => failure(key, &error),
            };
            rows.add(row)?;
            bar.step(1);
            bar.say(&format!("{}: view {} of {} is done", scene.name, k + 1, scene.views.len()));
        }
    }
    Ok(keys)
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
