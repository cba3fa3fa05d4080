//! The least traversal units of a machine that keep a share of the frame rate that its memory allows, found by the simulator.
//!
//! What the memory allows is the frame with compute free. Where even the machine's own units do not keep the share of it, they are the measure themselves.
//! More contexts, units, or edges, boxes and bits in a cycle make a frame shorter, but not always: more rays at a time share the same caches. Blocks do less in a cycle as long as
//! that serves, what saves most first; contexts and units are halved as if more of them were always faster. So there may be smaller units that would do; those that are found
//! were simulated in every frame, and so were those with one context less.

use crate::hardware::{Hardware, unit_gates};
use crate::machine::{Machine, Units};
use crate::method::lod;
use crate::run::{Compute, HeldFrame, Job};
use crate::sim::replay::ReplayError;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What keeps a share of the frame rate, on which machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Speed {
    /// The machine.
    pub machine: String,
    /// The share that is to be kept in every frame.
    pub share: f64,
    /// Frames simulated: each view with each quality.
    pub frames: usize,
    /// Those whose measure is not the memory but the machine's own units, which do not keep the share of it.
    pub frames_of_units: usize,
    /// The least share of its measure that a frame keeps.
    pub kept: f64,
    /// The least share of the frame rate that the memory allows.
    pub kept_of_memory: f64,
    /// The units that keep it, by the keys of machines.
    pub units: Units,
    /// The machine's own.
    pub own: Units,
}

impl Speed {
    /// The units of the fewest gate equivalents, in all else as `hardware` is, that keep `share` in every one of `frames`. A group has no more of them, and they no
    /// more contexts and no more edges, boxes and bits in a cycle, than in the machine.
    ///
    /// # Errors
    /// The machine is impossible or too large, or nothing happens any more while rays are under way.
    pub fn found(frames: &[HeldFrame], machine: &Machine, name: &str, share: f64, hardware: &Hardware) -> Result<Self, ReplayError> {
        let free = cycles(frames, machine, Compute::Free)?;
        let full = cycles(frames, machine, Compute::Units)?;
        let measures: Vec<u64> = free.iter().zip(&full).map(|(&free, &full)| if rate(free, full) < share { full } else { free }).collect();
        // What is tried is a unit of the plan: only what the machine's keys say is the machine's.
        let own = Found { units: Units { like: None, ..machine.units.clone() }, cycles: full };
        let mut search = Search { frames, machine: machine.clone(), measures: &measures, share, hardware, tried: vec![own.clone()] };
        let Found { units, cycles } = search.least(own)?;
        Ok(Self {
            machine: name.to_owned(),
            share,
            frames: frames.len(),
            frames_of_units: free.iter().zip(&measures).filter(|(free, measure)| free != measure).count(),
            kept: worst(&measures, &cycles),
            kept_of_memory: worst(&free, &cycles),
            units,
            own: machine.units.clone(),
        })
    }

    /// Gate equivalents of the units of a group, in all else as `hardware` is.
    pub fn gates(units: &Units, hardware: &Hardware) -> f64 {
        let unit = lod::METHOD.unit.and_then(|unit| unit_gates(unit, &hardware.as_fast_as(&units.config())));
        f64::from(units.per_group) * unit.expect("each of its blocks was measured, as the test of areas holds")
    }
}

/// Cycles of each frame.
fn cycles(frames: &[HeldFrame], machine: &Machine, compute: Compute) -> Result<Vec<u64>, ReplayError> {
    let job = Job { machine: machine.clone(), compute, window: None };
    frames.par_iter().map(|frame| Ok(frame.run(&job)?.cycles)).collect()
}

/// The frame rate of a frame of so many cycles as a share of its measure's; a frame in which nothing is done is as fast as any.
fn rate(measure: u64, cycles: u64) -> f64 {
    if cycles == 0 { 1.0 } else { measure as f64 / cycles as f64 }
}

/// The least share of all frames.
fn worst(measures: &[u64], cycles: &[u64]) -> f64 {
    measures.iter().zip(cycles).map(|(&measure, &cycles)| rate(measure, cycles)).fold(f64::INFINITY, f64::min)
}

/// Units, and the cycles that the frames take with them.
#[derive(Clone)]
struct Found {
    units: Units,
    cycles: Vec<u64>,
}

struct Search<'a> {
    frames: &'a [HeldFrame],
    machine: Machine,
    measures: &'a [u64],
    share: f64,
    hardware: &'a Hardware,
    /// All that were simulated.
    tried: Vec<Found>,
}

impl Search<'_> {
    /// These units, if they serve.
    fn serving(&mut self, units: Units) -> Result<Option<Found>, ReplayError> {
        let found = match self.tried.iter().find(|tried| tried.units == units) {
            Some(tried) => tried.clone(),
            None => {
                self.machine.units = units.clone();
                let found = Found { units, cycles: cycles(self.frames, &self.machine, Compute::Units)? };
                self.tried.push(found.clone());
                found
            }
        };
        Ok((worst(self.measures, &found.cycles) >= self.share).then_some(found))
    }

    /// The same units of blocks that do less in a cycle, as long as they serve: first what saves most.
    fn narrowed(&mut self, own: Found) -> Result<Found, ReplayError> {
        let hardware = self.hardware;
        let mut best = own;
        'less: loop {
            let full = Speed::gates(&best.units, hardware);
            let mut less: Vec<(f64, Units)> = narrower(&best.units).map(|units| (Speed::gates(&units, hardware), units)).collect();
            less.retain(|(gates, _)| *gates < full);
            less.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (_, units) in less {
                if let Some(found) = self.serving(units)? {
                    best = found;
                    continue 'less;
                }
            }
            return Ok(best);
        }
    }

    /// The cheapest that serve, beginning with the machine's own, which do.
    fn least(&mut self, own: Found) -> Result<Found, ReplayError> {
        let hardware = self.hardware;
        let gates = |units: &Units| Speed::gates(units, hardware);
        let narrow = self.narrowed(own.clone())?;
        let mut best = own.clone();
        for all in [narrow, own] {
            let full = all.units.clone();
            let of = |per_group, contexts| Units { per_group, contexts, ..full.clone() };
            // So few of all contexts that fewer units have no chance.
            let few = halved(all, |found| found.units.per_group, |per_group| self.serving(of(per_group, full.contexts)))?.units.per_group;
            // More of fewer contexts each can be cheaper.
            for per_group in few..=full.per_group {
                let best_gates = gates(&best.units);
                let Some(cheaper) = (1..=full.contexts).rev().find(|&contexts| gates(&of(per_group, contexts)) < best_gates) else { break };
                if let Some(found) = self.serving(of(per_group, cheaper))? {
                    best = halved(found, |found| found.units.contexts, |contexts| self.serving(of(per_group, contexts)))?;
                }
            }
        }
        Ok(best)
    }
}

/// Units each of which does less in a cycle in one of its blocks, by one step.
fn narrower(units: &Units) -> impl Iterator<Item = Units> {
    let edges = |count| (count > 1).then_some(1);
    let less = [
        edges(units.edges_per_cycle).map(|edges_per_cycle| Units { edges_per_cycle, ..units.clone() }),
        edges(units.lod_edges_per_cycle).map(|lod_edges_per_cycle| Units { lod_edges_per_cycle, ..units.clone() }),
        (units.boxes_per_cycle > 1).then(|| Units { boxes_per_cycle: units.boxes_per_cycle / 2, ..units.clone() }),
        (units.divide_bits > 1).then(|| Units { divide_bits: units.divide_bits - 1, ..units.clone() }),
        (units.setup_bits > 1).then(|| Units { setup_bits: units.setup_bits - 1, ..units.clone() }),
        (units.setup_copies > 1).then(|| Units { setup_copies: units.setup_copies - 1, ..units.clone() }),
        (units.divide_copies > 1).then(|| Units { divide_copies: units.divide_copies - 1, ..units.clone() }),
    ];
    less.into_iter().flatten()
}

/// What serves with the least number, where all numbers above one that serves are taken to serve; `found` is the first that does.
fn halved(
    mut found: Found,
    number: impl Fn(&Found) -> u32,
    mut serving: impl FnMut(u32) -> Result<Option<Found>, ReplayError>,
) -> Result<Found, ReplayError> {
    let mut too_few = 0;
    while number(&found) - too_few > 1 {
        let middle = too_few + (number(&found) - too_few) / 2;
        match serving(middle)? {
            Some(less) => found = less,
            None => too_few = middle,
        }
    }
    Ok(found)
}
