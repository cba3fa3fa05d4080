//! Scenes that were pruned for a job: its rays alone may be traced on them.

use lodray::format::Scene;
use lodray::picture::Shading;
use lodray::rays::Camera;

/// Refuses rays of lod on a scene that was pruned for others: a camera's at a quality, or those of no camera.
pub fn check(scene: &Scene, camera: Option<&Camera>, delta: f64) -> anyhow::Result<()> {
    let (name, job) = (&scene.meta().name, &scene.meta().job);
    let Some(camera) = camera else {
        anyhow::ensure!(job.is_empty(), "scene {name} was pruned for a job: rays: those of its views alone, not those of a file");
        return Ok(());
    };
    let asked = camera.job_view(delta);
    // Of the view that is most alike.
    let nearest = job.iter().map(|view| view.differences(&asked)).min_by_key(Vec::len);
    match nearest.as_deref() {
        Some([(field, value), ..]) => {
            anyhow::bail!("scene {name} was pruned for a job, which has no such view: {field} is {value} (lodray info lists its views)")
        }
        // Whole, or one of the job's.
        _ => Ok(()),
    }
}

/// Refuses a shading that needs the full resolution on a scene that has less of it.
pub fn check_shading(scene: &Scene, shading: Shading) -> anyhow::Result<()> {
    anyhow::ensure!(
        scene.meta().job.is_empty() || shading != Shading::Facets,
        "scene {} was pruned for a job: --shading facets needs the full resolution; full, level and weighted do not",
        scene.meta().name
    );
    Ok(())
}
