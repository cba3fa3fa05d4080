//! The files of a simulation.

use super::plots;
use crate::cli::output::write_file;
use lodray::report::result::{IntervalResult, SimResult};
use std::path::Path;

const RESULT: &str = "result.json";
const ENERGY: &str = "energy.svg";
/// What each machine has for itself.
const INTERVALS: &str = "intervals.csv";
const POWER: &str = "power.svg";
const TRAFFIC: &str = "traffic.svg";

/// Their names.
pub struct Files {
    /// Before the names of each machine's files.
    prefixes: Vec<String>,
}

impl Files {
    /// The files of runs on machines of these labels; with one machine names have no label.
    pub fn new(labels: &[&str]) -> Self {
        let prefixes = match labels {
            [_] => vec![String::new()],
            several => several.iter().map(|label| format!("{label}-")).collect(),
        };
        Self { prefixes }
    }

    /// All names.
    pub fn names(&self) -> Vec<String> {
        let own = self.prefixes.iter().flat_map(|prefix| [INTERVALS, POWER, TRAFFIC].map(|name| format!("{prefix}{name}")));
        own.chain([RESULT, ENERGY].map(str::to_owned)).collect()
    }

    /// Writes them into `folder`; says which plots there are not, and why.
    pub fn write(&self, folder: &Path, results: &[SimResult]) -> anyhow::Result<Vec<String>> {
        let save = |name: &str, text: &str| write_file(&folder.join(name), text);
        let mut notes = Vec::new();
        let mut plot = |name: &str, lacks: Option<&str>, draw: &dyn Fn() -> anyhow::Result<String>| match lacks {
            Some(why) => {
                notes.push(format!("no {name}: {why}"));
                Ok(())
            }
            None => save(name, &draw()?),
        };
        let json = match results {
            [one] => serde_json::to_string_pretty(one),
            several => serde_json::to_string_pretty(several),
        };
        save(RESULT, &(json? + "\n"))?;
        plot(ENERGY, no_energy(results), &|| plots::energy(results))?;
        for (prefix, result) in self.prefixes.iter().zip(results) {
            save(&format!("{prefix}{INTERVALS}"), &intervals_csv(&result.intervals))?;
            plot(&format!("{prefix}{POWER}"), no_power(result), &|| plots::power(result))?;
            plot(&format!("{prefix}{TRAFFIC}"), no_traffic(result), &|| plots::traffic(result))?;
        }
        Ok(notes)
    }
}

const NOTHING_READ: &str = "the frame reads nothing, as no ray meets the model's box";

/// Why there is no plot of energies, if so.
fn no_energy(results: &[SimResult]) -> Option<&'static str> {
    results.iter().all(|r| r.l1.requests == 0).then_some(NOTHING_READ)
}

/// Why there is no plot of power over time, if so.
fn no_power(r: &SimResult) -> Option<&'static str> {
    let relative = r.energy.average_watts.is_none().then_some("the machine's energies are relative, so it has no power in watts");
    no_traffic(r).or(relative)
}

/// Why there is no plot of anything over time, if so.
fn no_traffic(r: &SimResult) -> Option<&'static str> {
    match r.intervals.len() {
        _ if r.l1.requests == 0 => Some(NOTHING_READ),
        0 | 1 => Some("the frame is too short to show anything over time: it is one interval"),
        _ => None,
    }
}

fn intervals_csv(intervals: &[IntervalResult]) -> String {
    let mut text = "end_cycle,cycles,rays,l1_requests,l1_misses,l2_requests,l2_misses,dram_bytes,row_hits,row_misses,l1_watts,l2_watts,dram_watts,compute_watts,leakage_watts,\
l1_registers,l1_queue,l2_registers,l2_queue,dram_queue,limit,limit_share\n"
        .to_owned();
    for i in intervals {
        let counts =
            [i.end, i.cycles, i.rays, i.l1_requests, i.l1_misses, i.l2_requests, i.l2_misses, i.dram_bytes, i.row_hits, i.row_misses];
        let watts =
            i.watts.map_or_else(|| ",,,,".to_owned(), |w| [w.l1, w.l2, w.dram, w.compute, w.leakage].map(|w| w.to_string()).join(","));
        let counts = counts.map(|c| c.to_string()).join(",");
        let occupancy = [i.l1_registers, i.l1_queue, i.l2_registers, i.l2_queue, i.dram_queue].map(|mean| mean.to_string()).join(",");
        text += &format!("{counts},{watts},{occupancy},{},{}\n", i.limit, i.limit_share);
    }
    text
}
