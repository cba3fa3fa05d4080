//! Frames after one another: what each took with the caches as the frames before left them.

use super::energy::unit_of;
use super::intervals::{energy_between, zero};
use super::ratio::ratio;
use crate::method::Computing;
use crate::num::LINE_BYTES;
use crate::sim::energy::EnergyModel;
use crate::sim::replay::FrameRun;
use serde::{Deserialize, Serialize};

/// What a frame took; of several the first finds caches empty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrameResult {
    /// The cycle in which it began.
    pub start: u64,
    /// Cycles from there to its last ray's end, and until lines that had to go are in memory.
    pub cycles: u64,
    /// The part of all this that was work before its rays, where there was any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before: Option<BeforeResult>,
    /// Share of these, at its end, in which fewer than half of the contexts have rays.
    pub stragglers: f64,
    /// Rays shot.
    pub rays: u64,
    /// Requests to the L1s.
    pub l1_requests: u64,
    /// Misses there.
    pub l1_misses: u64,
    /// Misses of the L2.
    pub l2_misses: u64,
    /// Bytes read and written in memory.
    pub dram_bytes: u64,
    /// Energy, in the result's unit.
    pub energy: f64,
}

/// Work before the rays of a frame: they wait until all of it is done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BeforeResult {
    /// Cycles until the rays begin.
    pub cycles: u64,
    /// Requests to the L1s, stores among them.
    pub l1_requests: u64,
    /// Lines written.
    pub stores: u64,
    /// Bytes read and written in memory.
    pub dram_bytes: u64,
    /// Energy, in the result's unit.
    pub energy: f64,
}

/// The mean of some frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WarmFrames {
    /// The first and the last of them, counted from 1.
    pub frames: [u32; 2],
    /// Cycles.
    pub cycles: f64,
    /// Share of the cycles in which fewer than half of the contexts have rays.
    pub stragglers: f64,
    /// Bytes read and written in memory.
    pub dram_bytes: f64,
    /// Energy, in the result's unit.
    pub energy: f64,
}

/// The frames of a run that `of` computes for.
pub(super) fn frames(runs: &[FrameRun], model: &EnergyModel, of: Computing) -> Vec<FrameResult> {
    let zero = zero();
    let (mut frames, mut begin, mut before) = (Vec::new(), &zero, None);
    for run in runs {
        if run.is_before {
            before = Some(run);
            continue;
        }
        let start = before.map_or(run.start, |work| work.start);
        let cycles = run.end.end - start;
        let (counts, energy) = energy_between(begin, &run.end, cycles, model, of);
        let work = |work: &FrameRun| {
            let cycles = run.start - work.start;
            let (counts, energy) = energy_between(begin, &work.end, cycles, model, of);
            BeforeResult {
                cycles,
                l1_requests: counts.l1_reads,
                stores: work.end.counts.l1.stores - begin.counts.l1.stores,
                dram_bytes: counts.dram_lines * LINE_BYTES,
                energy: energy.total() * unit_of(energy.unit).0,
            }
        };
        frames.push(FrameResult {
            start,
            cycles,
            before: before.take().map(work),
            stragglers: ratio((run.end.end - run.half) as f64, cycles as f64),
            rays: run.end.counts.rays - begin.counts.rays,
            l1_requests: counts.l1_reads,
            l1_misses: run.end.counts.l1.misses - begin.counts.l1.misses,
            l2_misses: run.end.counts.l2.misses - begin.counts.l2.misses,
            dram_bytes: counts.dram_lines * LINE_BYTES,
            energy: energy.total() * unit_of(energy.unit).0,
        });
        begin = &run.end;
    }
    frames
}

/// The mean of the second half of some frames; none of a single one.
pub(super) fn warm(frames: &[FrameResult]) -> Option<WarmFrames> {
    let second = &frames[frames.len() / 2..];
    let mean = |of: fn(&FrameResult) -> f64| second.iter().map(of).sum::<f64>() / second.len() as f64;
    let cycles = mean(|frame| frame.cycles as f64);
    (frames.len() > 1).then(|| WarmFrames {
        frames: [frames.len() / 2 + 1, frames.len()].map(|n| n as u32), // a path has at most 2^16
        cycles,
        stragglers: ratio(mean(|frame| frame.stragglers * frame.cycles as f64), cycles),
        dram_bytes: mean(|frame| frame.dram_bytes as f64),
        energy: mean(|frame| frame.energy),
    })
}
