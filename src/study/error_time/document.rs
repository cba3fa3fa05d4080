//! All views in one document.

use super::plan::ErrorTimePlan;
use super::row::Measured;
use crate::hardware::unit_gates;
use crate::method::{find, lod};
use crate::report::error_time::{ErrorTime, KIND, LeftOut, MethodEntry, Options, SceneEntry, SizeCosts, VERSION, equal_errors};
use crate::report::results_version;
use crate::study::Chosen;

/// All views in one document, their scenes and machines numbered.
pub fn document(plan: &ErrorTimePlan, measured: &[&Measured]) -> ErrorTime {
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
    let method = |chosen: &Chosen| MethodEntry {
        name: chosen.method.name.to_owned(),
        knob: chosen.method.error.map(|error| error.knob.name.to_owned()),
        in_steps: chosen.method.error.is_some_and(|error| error.in_steps),
        help: chosen.method.help.to_owned(),
    };
    let is_measured = |chosen: &Chosen| points.iter().any(|point| point.method == chosen.method.name);
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
