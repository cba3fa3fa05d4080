//! What a traversal unit for a scene needs.

use crate::errors::{raised, refused};
use crate::told::beside;
use crate::values::document;
use lodray::format::Scene;
use lodray::hardware::{Hardware, unit_gates};
use lodray::method::lod;
use lodray::plan::{Measure, Plan, Reach, savings};
use lodray::rays::ModelSpace;
use lodray::study::{Progress, ViewJob};
use pyo3::prelude::*;
use serde_json::json;

/// The plan of a scene, for any rays or for views.
pub fn plan<'py>(
    py: Python<'py>,
    scene: &Scene,
    distances: &[f64],
    size: [u32; 2],
    delta: f64,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    if delta.is_nan() || delta < 0.0 {
        return Err(refused(format!("delta: {delta} is no number from 0 on")));
    }
    if !scene.meta().is_whole() {
        return Err(refused("the scene was pruned for a job: a plan is of whole scenes"));
    }
    let (space, name) = (ModelSpace::of(scene), &scene.meta().name);
    let cameras =
        distances.iter().map(|&distance| ViewJob::at(size, distance).camera(&space)).collect::<Result<Vec<_>, _>>().map_err(raised)?;
    let all = beside(py, progress, |told| {
        let work = told.begin("measuring", Some(1 + cameras.len() as u64));
        let (measure, mut plan) = (Measure::of(scene), Plan::new(!cameras.is_empty()));
        work.step(1);
        plan.add(name, &measure.needs());
        let reach = Reach::of(scene);
        let mut needs = None;
        for camera in &cameras {
            let own = measure.rays(camera, delta);
            needs = Some(needs.map_or(own, |needs: lodray::plan::RayNeeds| needs.with(&own)));
            reach.add(camera, delta);
            plan.add_view(name, camera.job_view(delta));
            work.step(1);
        }
        if let Some(mut needs) = needs {
            // What a ray can do in each tree says more than what it can in the whole model.
            needs.deepest_level = needs.deepest_level.min(reach.deepest());
            plan.add_rays(&needs);
        }
        let depths = if cameras.is_empty() { scene.depths() } else { reach.depths() };
        let (data, full) = (measure.data(&depths), Hardware::default());
        let gates = |hardware: &Hardware| lod::METHOD.unit.and_then(|unit| unit_gates(unit, hardware));
        let saved = savings(&plan, &full, Some(&data));
        json!({ "plan": plan, "savings": saved, "data": data, "gates": gates(&plan.hardware(&full)), "full_gates": gates(&full) })
    })?;
    document(py, &all)
}
