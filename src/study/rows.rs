//! A job's line, and the table of all at the end.

use super::job_lines::JobLine;
use crate::report::page::ImageFigures;
use crate::report::result::SimResult;
use serde::{Deserialize, Serialize};

/// One job's line.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Which job.
    pub key: String,
    /// The scene's name in the list of jobs.
    pub scene: String,
    /// What it gave.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<SimResult>,
    /// How far the picture is from full resolution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub image: Option<ImageFigures>,
    /// Why it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl JobLine for Row {
    fn key(&self) -> &str {
        &self.key
    }

    fn has_result(&self) -> bool {
        self.result.is_some()
    }
}

const HEAD: &str = "scene,distance,eye_x,eye_y,eye_z,width,height,method,delta,leaves,machine,set,compute,cycles,milliseconds,frames_per_second,rays,hits,\
accesses_per_ray,l1_requests,l1_hit_rate,l2_requests,l2_hit_rate,dram_reads,dram_row_hits,dram_bandwidth_share,wait_l1,wait_l2,wait_dram,wait_memory,compute_share,idle,\
energy_unit,energy,energy_l1,energy_l2,energy_dram,energy_compute,energy_leakage,average_watts,bytes_per_ray_l1,bytes_per_ray_l2,bytes_per_ray_dram,\
l0_share_of_l1,roofline,rmse,psnr_db,geometry_pixels_mean,error,key\n";

/// Columns of a result, from `distance` to `roofline`.
const RESULT_COLUMNS: usize = 44;

/// The table of some jobs.
pub fn csv<'a>(rows: impl Iterator<Item = &'a Row>) -> String {
    let optional = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    let mut text = HEAD.to_owned();
    for row in rows {
        let mut cells = vec![row.scene.clone()];
        cells.extend(row.result.as_ref().map_or_else(|| vec![String::new(); RESULT_COLUMNS], result_cells));
        cells.extend(
            [row.image.map(|i| i.rmse), row.image.and_then(|i| i.psnr_db), row.image.and_then(|i| i.geometry_pixels_mean)].map(optional),
        );
        cells.extend([row.error.clone().unwrap_or_default(), row.key.clone()]);
        text += &(cells.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

fn result_cells(r: &SimResult) -> Vec<String> {
    let optional = |value: Option<f64>| value.map_or_else(String::new, |v| v.to_string());
    let (setup, energy, bytes) = (&r.setup, &r.energy, &r.traffic.bytes_per_ray);
    let view = setup.view.as_ref();
    let mut cells = vec![optional(view.and_then(|view| view.distance))];
    cells.extend(view.map_or_else(Default::default, |view| view.eye.map(|v| v.to_string())));
    cells.extend(view.map_or_else(Default::default, |view| view.size.map(|v| v.to_string())));
    cells.extend([setup.method.name.clone(), optional(setup.method.delta), setup.method.leaves.clone().unwrap_or_default()]);
    cells.extend([setup.machine.label.clone(), setup.machine.set.join(" "), setup.compute.name().to_owned()]);
    cells.extend([r.cycles.to_string(), r.milliseconds.to_string(), r.frames_per_second.to_string()]);
    cells.extend([r.rays.to_string(), r.hits.to_string(), r.accesses_per_ray.to_string()]);
    for cache in [&r.l1, &r.l2] {
        cells.extend([cache.requests.to_string(), cache.hit_rate.to_string()]);
    }
    cells.extend([r.dram.reads.to_string(), r.dram.row_hits.to_string(), r.dram.bandwidth_share.to_string()]);
    cells.extend([r.waits.l1, r.waits.l2, r.waits.dram, r.waits.memory, r.waits.compute, r.waits.idle].map(|v| v.to_string()));
    cells.extend([energy.unit.clone(), energy.total.to_string()]);
    cells.extend(energy.split().map(|part| part.1.to_string()));
    cells.push(optional(energy.average_watts));
    cells.extend([bytes.l1, bytes.l2, bytes.dram].map(|v| v.to_string()));
    cells.extend([optional(r.traffic.l0_share_of_l1), r.roofline.largest.clone()]);
    cells
}

/// A cell of a CSV file.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_as_many_cells_as_the_head() {
        let row = Row { key: "k".to_owned(), scene: "s".to_owned(), result: None, image: None, error: Some("e".to_owned()) };
        let text = csv(std::iter::once(&row));
        let commas: Vec<_> = text.lines().map(|line| line.matches(',').count()).collect();
        assert_eq!(commas[0], commas[1]);
        assert_eq!(quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
    }
}
