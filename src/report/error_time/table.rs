//! The points as a table.

use super::{COSTS, ERRORS, ErrorTime};
use std::fmt::Write;

/// One row for each point, machine and kind of compute.
pub fn csv(document: &ErrorTime) -> String {
    let mut text = "scene,distance,method,setting,samples,bytes,bytes_per_triangle,machine,compute".to_owned();
    let names = ERRORS.iter().map(|error| error.name).chain(COSTS.iter().map(|cost| cost.name));
    for name in names {
        text += ",";
        text += name;
    }
    text += ",energy_unit\n";
    for point in &document.points {
        let Some(view) = document.views.get(point.view) else { continue };
        let scene = document.scenes.get(view.scene).map_or("", |scene| &scene.name);
        for costs in &point.costs {
            let machine = document.machines.get(costs.machine).map_or_else(String::new, |machine| machine.title());
            let cells =
                [scene.to_owned(), view.distance.to_string(), point.method.clone(), point.setting.clone(), point.samples.to_string()];
            let cells =
                cells.into_iter().chain([point.bytes.to_string(), point.bytes_per_triangle.to_string(), machine, costs.compute.clone()]);
            let errors = ERRORS.iter().map(|error| (error.of)(point).map_or_else(String::new, |v| v.to_string()));
            let all = cells.chain(errors).chain(COSTS.iter().map(|cost| (cost.of)(costs).to_string())).chain([costs.energy.unit.clone()]);
            let all: Vec<_> = all.map(|cell| quoted(&cell)).collect();
            // Writing to a text cannot fail.
            let _ = writeln!(text, "{}", all.join(","));
        }
    }
    text
}

/// A cell of a CSV file.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}
