//! What the others cost over ours, by the size of the frame: each method as it is if nothing is chosen.

use super::canvas::short;
use super::distance::{DistanceChart, Line, Spot};
use super::fault::DiagramFault;
use crate::method::lod;
use crate::report::error_time::{Costs, ErrorTime, SizeCosts};

/// A cost of a frame.
#[derive(Clone, Copy)]
pub(super) struct Measure {
    /// In file names.
    pub id: &'static str,
    name: &'static str,
    of: fn(&Costs) -> f64,
}

/// Time, energy and traffic.
pub(super) const MEASURES: [Measure; 3] = [
    Measure { id: "time", name: "Time", of: |costs| costs.milliseconds },
    Measure { id: "energy", name: "Energy", of: |costs| costs.energy.total },
    Measure { id: "dram-lines", name: "DRAM lines", of: |costs| costs.dram_lines as f64 },
];

/// The diagram of a scene on a machine; none without two sizes.
pub(super) fn by_size(
    document: &ErrorTime,
    scene: usize,
    (machine, compute): (usize, &str),
    measure: &Measure,
) -> Result<Option<String>, DiagramFault> {
    let of = |size: &SizeCosts| {
        let costs = size.costs.iter().find(|costs| costs.machine == machine && costs.compute == compute)?;
        Some((measure.of)(costs))
    };
    let here: Vec<&SizeCosts> = document.sizes.iter().filter(|size| document.views[size.view].scene == scene).collect();
    let ours = |size: &SizeCosts| here.iter().find(|own| own.method == lod::METHOD.name && own.size == size.size).and_then(|own| of(own));
    let mut lines: Vec<Line> = Vec::new();
    for &size in here.iter().filter(|size| size.method != lod::METHOD.name) {
        let (Some(theirs), Some(ours)) = (of(size), ours(size).filter(|ours| *ours > 0.0)) else { continue };
        let at = lines.iter().position(|line| line.method == size.method).unwrap_or_else(|| {
            lines.push(Line { method: size.method.clone(), name: size.method.clone(), spots: Vec::new() });
            lines.len() - 1
        });
        lines[at].spots.push(Spot { x: f64::from(size.size[0]), y: theirs / ours, gain: Some(theirs / ours) });
    }
    if lines.iter().all(|line| line.spots.len() < 2) {
        return Ok(None);
    }
    let mut sizes: Vec<String> = Vec::new();
    for size in &here {
        let words = format!("{}x{}", size.size[0], size.size[1]);
        if !sizes.contains(&words) {
            sizes.push(words);
        }
    }
    let distance = here.first().map_or(0.0, |size| document.views[size.view].distance);
    DistanceChart {
        title: format!("{} over ours, by the size of the frame", measure.name),
        subtitle: format!(
            "{} from {} radii, {}; each method by its default; {}, compute {compute}",
            document.scenes[scene].name,
            short(distance),
            sizes.join(", "),
            document.machines[machine].title(),
        ),
        x: "columns of the frame".to_owned(),
        y: "cost over ours: above 1 ours is cheaper".to_owned(),
        lines,
    }
    .svg()
}
