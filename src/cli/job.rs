//! Scenes that were pruned for a job: its rays alone may be traced on them.

use lodray::format::{JobRegion, Meta, Scene};
use lodray::picture::Shading;
use lodray::rays::{Camera, RayFile, RaySource};

/// Refuses rays of lod on a scene that was pruned for others: a camera's at a quality.
pub fn check(scene: &Scene, camera: &Camera, delta: f64) -> anyhow::Result<()> {
    let Meta { name, job, regions, .. } = scene.meta();
    let beyond = |region: &JobRegion| region.beyond(delta, camera.eye.to_array(), camera.tan_theta);
    if scene.meta().is_whole() || regions.iter().any(|region| beyond(region).is_none()) {
        return Ok(());
    }
    let asked = camera.job_view(delta);
    // Of the view that is most alike.
    let nearest = job.iter().map(|view| view.differences(&asked)).min_by_key(Vec::len);
    let beside = regions.first().and_then(beyond);
    match (nearest.as_deref(), beside) {
        (Some([]), _) => Ok(()),
        (Some([(field, value), ..]), None) => {
            anyhow::bail!("scene {name} was pruned for a job, which has no such view: {field} is {value} (lodray info lists its views)")
        }
        (_, Some((field, value))) => {
            let views = if job.is_empty() { "" } else { ", and it is none of its views" };
            anyhow::bail!("scene {name} was pruned for rays from a region: {field} is {value}{views} (lodray info lists both)")
        }
        (None, None) => Ok(()),
    }
}

/// Refuses rays of a file likewise.
pub fn check_rays(scene: &Scene, rays: &RayFile, delta: f64) -> anyhow::Result<()> {
    let Meta { name, regions, .. } = scene.meta();
    if scene.meta().is_whole() {
        return Ok(());
    }
    let Some(first) = regions.first() else {
        anyhow::bail!("scene {name} was pruned for a job: rays: those of its views alone, not those of a file");
    };
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
        Some((number, (field, value))) => {
            anyhow::bail!("scene {name} was pruned for rays from a region: ray {number}: {field} is {value} (lodray info lists it)")
        }
        None => Ok(()),
    }
}

/// Refuses a shading that needs the full resolution on a scene that has less of it.
pub fn check_shading(scene: &Scene, shading: Shading) -> anyhow::Result<()> {
    anyhow::ensure!(
        scene.meta().is_whole() || shading != Shading::Facets,
        "scene {} was pruned for a job: --shading facets needs the full resolution; full, level and weighted do not",
        scene.meta().name
    );
    Ok(())
}
