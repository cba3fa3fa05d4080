//! The files of a simulation.

use super::plots;
use anyhow::Context;
use lodray::format::write_and_rename;
use lodray::report::result::{IntervalResult, SimResult};
use std::path::{Path, PathBuf};

const RESULT: &str = "result.json";
const ENERGY: &str = "energy.svg";
/// What each machine has for itself.
const INTERVALS: &str = "intervals.csv";
const POWER: &str = "power.svg";
const TRAFFIC: &str = "traffic.svg";

/// Where they go.
pub struct Files {
    folder: PathBuf,
    /// Before the names of each machine's files.
    prefixes: Vec<String>,
}

impl Files {
    /// The files in `folder` of runs on machines of these labels; with one machine names have no label.
    pub fn new(folder: &Path, labels: &[&str]) -> Self {
        let prefixes = match labels {
            [_] => vec![String::new()],
            several => several.iter().map(|label| format!("{label}-")).collect(),
        };
        Self { folder: folder.to_owned(), prefixes }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// All names.
    pub fn names(&self) -> Vec<String> {
        let own = self.prefixes.iter().flat_map(|prefix| [INTERVALS, POWER, TRAFFIC].map(|name| format!("{prefix}{name}")));
        own.chain([RESULT, ENERGY].map(str::to_owned)).collect()
    }

    /// Writes them all.
    pub fn write(&self, results: &[SimResult]) -> anyhow::Result<()> {
        let json = match results {
            [one] => serde_json::to_string_pretty(one),
            several => serde_json::to_string_pretty(several),
        };
        self.save(RESULT, &(json? + "\n"))?;
        self.save(ENERGY, &plots::energy(results)?)?;
        for (prefix, result) in self.prefixes.iter().zip(results) {
            self.save(&format!("{prefix}{INTERVALS}"), &intervals_csv(&result.intervals))?;
            for (name, plot) in [(POWER, plots::power(result)?), (TRAFFIC, plots::traffic(result)?)] {
                plot.map_or(Ok(()), |plot| self.save(&format!("{prefix}{name}"), &plot))?;
            }
        }
        Ok(())
    }

    fn save(&self, name: &str, text: &str) -> anyhow::Result<()> {
        let path = self.folder.join(name);
        write_and_rename(&path, |out| out.write_all(text.as_bytes())).with_context(|| format!("cannot write {}", path.display()))
    }
}

fn intervals_csv(intervals: &[IntervalResult]) -> String {
    let mut text = "end_cycle,cycles,rays,l1_requests,l1_misses,l2_requests,l2_misses,dram_bytes,row_hits,row_misses,l1_watts,l2_watts,dram_watts,compute_watts,leakage_watts\n"
        .to_owned();
    for i in intervals {
        let counts =
            [i.end, i.cycles, i.rays, i.l1_requests, i.l1_misses, i.l2_requests, i.l2_misses, i.dram_bytes, i.row_hits, i.row_misses];
        let watts =
            i.watts.map_or_else(|| ",,,,".to_owned(), |w| [w.l1, w.l2, w.dram, w.compute, w.leakage].map(|w| w.to_string()).join(","));
        text += &format!("{},{watts}\n", counts.map(|c| c.to_string()).join(","));
    }
    text
}
