//! How long rays and misses took, one by one.

use crate::sim::replay::{Histogram, Latencies};
use serde::{Deserialize, Serialize};

/// Latencies in cycles of the cores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LatencyResult {
    /// Of rays, from their start to their end.
    pub rays: Distribution,
    /// Of misses of the L1s, from the look-up to the line.
    pub l1_misses: Distribution,
    /// The same of the L2.
    pub l2_misses: Distribution,
}

/// A distribution in steps of a quarter of an octave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Distribution {
    /// How many there are.
    pub count: u64,
    /// The steps in which half of them, nine tenths, 99 % and all of them lie: their least cycles.
    pub median: u64,
    #[expect(missing_docs, reason = "above")]
    pub percentile_90: u64,
    #[expect(missing_docs, reason = "above")]
    pub percentile_99: u64,
    #[expect(missing_docs, reason = "above")]
    pub largest: u64,
    /// Each step that has some: its least cycles, and how many.
    pub steps: Vec<[u64; 2]>,
}

impl From<&Latencies> for LatencyResult {
    fn from(of: &Latencies) -> Self {
        Self { rays: (&of.rays).into(), l1_misses: (&of.l1_misses).into(), l2_misses: (&of.l2_misses).into() }
    }
}

impl From<&Histogram> for Distribution {
    fn from(of: &Histogram) -> Self {
        let steps: Vec<[u64; 2]> = of.steps().map(|(least, count)| [least, count]).collect();
        let count: u64 = steps.iter().map(|step| step[1]).sum();
        let within = |percent: u64| {
            let wanted = (count * percent).div_ceil(100);
            let mut below = 0;
            let step = steps.iter().find(|step| {
                below += step[1];
                below >= wanted
            });
            step.map_or(0, |step| step[0])
        };
        let [median, percentile_90, percentile_99, largest] = [50, 90, 99, 100].map(within);
        Self { count, median, percentile_90, percentile_99, largest, steps }
    }
}
