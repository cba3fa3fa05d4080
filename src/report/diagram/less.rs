//! An error against the area of a unit or the bytes of a scene, where less and less is left of both: a line for each distance.

use super::distance::{DistanceChart, Line, Spot};
use super::fault::DiagramFault;
use crate::method::lod;
use crate::report::error_time::{ErrorMeasure, ErrorTime, LeftOut};

/// What there is less of.
#[derive(Clone, Copy)]
pub(super) struct Measure {
    /// In file names.
    pub id: &'static str,
    name: &'static str,
    of: fn(&LeftOut, usize, &str) -> Option<f64>,
}

/// Area and bytes.
pub(super) const MEASURES: [Measure; 2] = [
    Measure {
        id: "gates",
        name: "area of a traversal unit, million gate equivalents",
        of: |left, machine, compute| {
            let costs = left.point.costs.iter().find(|costs| costs.machine == machine && costs.compute == compute)?;
            Some(costs.unit_gates? / 1e6)
        },
    },
    Measure { id: "bytes", name: "bytes for each finest triangle", of: |left, _, _| Some(left.point.bytes_per_triangle) },
];

/// The diagram of a scene on a machine; none if nothing was left out of it.
pub(super) fn less(
    document: &ErrorTime,
    scene: usize,
    (machine, compute): (usize, &str),
    measure: &Measure,
    error: &ErrorMeasure,
) -> Result<Option<String>, DiagramFault> {
    let mut lines: Vec<(usize, Line)> = Vec::new();
    for left in document.left_out.iter().filter(|left| document.views[left.point.view].scene == scene) {
        let view = left.point.view;
        let (Some(x), Some(y)) = ((measure.of)(left, machine, compute), (error.of)(&left.point)) else { continue };
        let at = lines.iter().position(|(of, _)| *of == view).unwrap_or_else(|| {
            let name = format!("from {} radii", document.views[view].distance);
            lines.push((view, Line { method: lod::METHOD.name.to_owned(), name, spots: Vec::new() }));
            lines.len() - 1
        });
        lines[at].1.spots.push(Spot { x, y, gain: None });
    }
    for (_, line) in &mut lines {
        line.spots.sort_by(|a, b| a.x.total_cmp(&b.x));
    }
    let what: Vec<_> = document.left_out.iter().map(|left| left.what.as_str()).fold(Vec::new(), |mut all, what| {
        if !all.contains(&what) {
            all.push(what);
        }
        all
    });
    DistanceChart {
        title: format!("{}, with less in scene and unit", error.name),
        subtitle: format!(
            "{}, {}, delta 1; {}, compute {compute}: {}",
            document.scenes[scene].name,
            document.sizes_in_words(Some(scene)),
            document.machines[machine].title(),
            what.join(", ")
        ),
        x: measure.name.to_owned(),
        y: error.name.to_owned(),
        lines: lines.into_iter().map(|(_, line)| line).collect(),
    }
    .svg()
}
