//! Scenes that were pruned for a job: its rays alone may be traced on them.

use crate::format::{JobRegion, Meta, Scene};
use crate::picture::Shading;
use crate::rays::{Camera, RayFile, RaySource};
use thiserror::Error;

/// What a pruned scene does not serve.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PrunedError {
    /// A camera that is none of the job's.
    #[error("scene {scene} was pruned for a job, which has no such view: {field} is {value} (lodray info lists its views)")]
    View {
        /// The scene.
        scene: String,
        /// What of the camera differs from the view that is most alike.
        field: &'static str,
        /// That view's value.
        value: String,
    },
    /// A camera beyond the job's regions.
    #[error(
        "scene {scene} was pruned for rays from a region: {field} is {value}{} (lodray info lists both)",
        if *.has_views { ", and it is none of its views" } else { "" }
    )]
    Region {
        /// The scene.
        scene: String,
        /// What of the camera is beyond the first region.
        field: &'static str,
        /// Its value.
        value: String,
        /// The job has views too.
        has_views: bool,
    },
    /// A ray of a file beyond the job's regions.
    #[error("scene {scene} was pruned for rays from a region: ray {ray}: {field} is {value} (lodray info lists it)")]
    Ray {
        /// The scene.
        scene: String,
        /// The ray's number.
        ray: u64,
        /// What of it is beyond the first region.
        field: &'static str,
        /// Its value.
        value: String,
    },
    /// Rays of a file, where the job has none.
    #[error("scene {scene} was pruned for a job: rays: those of its views alone, not those of a file")]
    File {
        /// The scene.
        scene: String,
    },
    /// Shading by facets.
    #[error("scene {scene} was pruned for a job: --shading facets needs the full resolution; full, level and weighted do not")]
    Facets {
        /// The scene.
        scene: String,
    },
    /// Anything that needs normals, where they are gone.
    #[error("scene {scene} was pruned without its normals, and {what} needs them: rays can be simulated on it")]
    Normals {
        /// The scene.
        scene: String,
        /// What needs them.
        what: &'static str,
    },
    /// Rays of any kind.
    #[error("job: the scene was pruned for the rays of a job, and is not there for anything else (lodray info lists them)")]
    Whole,
}

/// Refuses rays of lod on a scene that was pruned for others: a camera's at a quality.
///
/// # Errors
/// The camera is none of the job's.
pub fn check(scene: &Scene, camera: &Camera, delta: f64) -> Result<(), PrunedError> {
    let Meta { name, job, regions, .. } = scene.meta();
    let beyond = |region: &JobRegion| region.beyond(delta, camera.eye.to_array(), camera.tan_theta);
    if scene.meta().is_whole() || regions.iter().any(|region| beyond(region).is_none()) {
        return Ok(());
    }
    let asked = camera.job_view(delta);
    // Of the view that is most alike.
    let nearest = job.iter().map(|view| view.differences(&asked)).min_by_key(Vec::len);
    let (scene, beside) = (name.clone(), regions.first().and_then(beyond));
    match (nearest.and_then(|differences| differences.into_iter().next()), beside) {
        (None, _) if !job.is_empty() => Ok(()),
        (Some((field, value)), None) => Err(PrunedError::View { scene, field, value }),
        (_, Some((field, value))) => Err(PrunedError::Region { scene, field, value, has_views: !job.is_empty() }),
        (None, None) => Ok(()),
    }
}

/// Refuses rays of a file likewise.
///
/// # Errors
/// The first ray that is none of the job's.
pub fn check_rays(scene: &Scene, rays: &RayFile, delta: f64) -> Result<(), PrunedError> {
    let Meta { name, regions, .. } = scene.meta();
    if scene.meta().is_whole() {
        return Ok(());
    }
    let Some(first) = regions.first() else { return Err(PrunedError::File { scene: name.clone() }) };
    let mut wrong = None;
    for batch in 0..rays.batches() {
        rays.batch(batch, &mut |number, query| {
            let beyond = |region: &JobRegion| region.beyond(delta, query.origin, query.tan_theta);
            if wrong.is_none() && regions.iter().all(|region| beyond(region).is_some()) {
                wrong = beyond(first).map(|beyond| (number, beyond));
            }
        });
    }
    match wrong {
        Some((ray, (field, value))) => Err(PrunedError::Ray { scene: name.clone(), ray, field, value }),
        None => Ok(()),
    }
}

/// Refuses a shading that needs the full resolution on a scene that has less of it.
///
/// # Errors
/// It is one.
pub fn check_shading(scene: &Scene, shading: Shading) -> Result<(), PrunedError> {
    if !scene.meta().is_whole() && shading == Shading::Facets {
        return Err(PrunedError::Facets { scene: scene.meta().name.clone() });
    }
    Ok(())
}

/// Refuses a scene that was pruned, for what may trace any rays.
///
/// # Errors
/// It was.
pub fn check_whole(scene: &Scene) -> Result<(), PrunedError> {
    if scene.meta().is_whole() { Ok(()) } else { Err(PrunedError::Whole) }
}

/// Refuses a scene without normals, for what needs them.
///
/// # Errors
/// It has none.
pub fn check_normals(scene: &Scene, what: &'static str) -> Result<(), PrunedError> {
    if scene.meta().without_normals {
        return Err(PrunedError::Normals { scene: scene.meta().name.clone(), what });
    }
    Ok(())
}
