//! Diagrams as files, SVG and PNG, and tables as CSV and LaTeX: what the page shows, for documents.
//!
//! The same figures give the same bytes: SVG needs no fonts to be made, and PNG is drawn with one that is here.

mod canvas;
mod distance;
mod fault;
mod less;
mod marks;
mod raster;
mod size;
mod table;
mod winners;
mod work;

pub use distance::{DistanceChart, Line, Spot, gain};
pub use fault::DiagramFault;
pub use raster::png;
pub use table::{csv, latex, left_out_csv};

use super::error_time::{CostMeasure, ErrorMeasure, ErrorTime, USUAL_ERRORS, verdicts};
use super::{plain_name, plain_names};
use rayon::prelude::*;

/// File name and contents.
pub type Files = Vec<(String, Vec<u8>)>;

/// Diagrams of a document: the map of winners for each machine; for each scene and machine every error of `errors` against every cost of `costs`, small multiples by distance, costs and errors by
/// distance, and costs by the frame's size, each as SVG and as PNG. What nobody measured has no diagram.
///
/// # Errors
/// A diagram that cannot be drawn.
pub fn diagrams(document: &ErrorTime, errors: &[ErrorMeasure], costs: &[CostMeasure]) -> Result<Files, DiagramFault> {
    let mut drawings: Vec<(String, String)> = Vec::new();
    let targets = document.targets();
    let machines = plain_names(document.machines.iter().map(|machine| machine.label.as_str()));
    let scenes = plain_names(document.scenes.iter().map(|scene| scene.name.as_str()));
    let suffix = |machine: usize, compute: &str| {
        if targets.len() == 1 { String::new() } else { format!("-{}-{compute}", machines[machine]) }
    };
    for verdict in verdicts(document) {
        drawings.push((plain_name(&format!("winners{}", suffix(verdict.machine, &verdict.compute))), winners::winners(&verdict)?));
    }
    for (scene, name) in scenes.iter().enumerate() {
        for (machine, compute) in &targets {
            let (machine, compute) = (*machine, compute.as_str());
            let of = work::Of { document, scene, machine, compute };
            let suffix = suffix(machine, compute);
            let mut add = |file: String, svg: Option<String>| drawings.extend(svg.map(|svg| (plain_name(&format!("{file}{suffix}")), svg)));
            for error in errors {
                for cost in costs {
                    add(format!("{}-{}-{}", name, error.id, cost.id), of.work(error, cost)?);
                }
                add(format!("{}-distance-{}", name, error.id), of.errors_by_distance(error)?);
            }
            for cost in costs {
                add(format!("{}-distance-{}", name, cost.id), of.costs_by_distance(cost)?);
            }
            for measure in &size::MEASURES {
                add(format!("{}-size-{}", name, measure.id), size::by_size(document, scene, (machine, compute), measure)?);
            }
            for measure in &less::MEASURES {
                add(
                    format!("{}-left-out-{}", name, measure.id),
                    less::less(document, scene, (machine, compute), measure, &USUAL_ERRORS[1])?,
                );
            }
        }
    }
    let files = drawings.into_par_iter().map(|(name, svg)| {
        let raster = png(&svg, 2.0)?;
        Ok([(format!("{name}.svg"), svg.into_bytes()), (format!("{name}.png"), raster)])
    });
    Ok(files.collect::<Result<Vec<_>, DiagramFault>>()?.into_iter().flatten().collect())
}
