//! Paths on a machine, at every number of bounces.

use crate::cli::output::progress;
use anyhow::Context;
use lodray::paths::{PathFrame, Paths};
use lodray::report::result::{MachineFacts, MethodFacts, RayFileFacts, SceneFacts, Setup, SimResult};
use lodray::run::{self, Compute, Frame, Job, simulate};
use lodray::study::Chosen;
use serde::Serialize;

/// What so many bounces cost, and what the last of them adds.
#[derive(Serialize)]
pub struct Bounces {
    pub bounces: u32,
    pub rays: u64,
    pub cycles: u64,
    pub milliseconds: f64,
    /// In `energy_unit`.
    pub energy: f64,
    pub energy_unit: String,
    pub dram_bytes: u64,
    pub added_rays: u64,
    pub added_milliseconds: f64,
    pub added_energy: f64,
}

/// The simulator's results for 0 bounces, 1, and so on to those of `paths`.
pub fn run(
    paths: &Paths<'_>,
    chosen: &Chosen,
    models: &SceneFacts,
    machine: &MachineFacts,
    compute: Compute,
    file: &str,
) -> anyhow::Result<Vec<SimResult>> {
    run::check(&machine.description, compute)?;
    let result = |depth| {
        let paths = Paths { depth, ..*paths };
        let frame = PathFrame::new(&paths).with_context(|| format!("--machine: {file}"))?;
        let job = Job { machine: machine.description.clone(), compute, window: None };
        let bar = progress(frame.batches() as u64, "simulating");
        let mut rays = 0;
        let mut runs = simulate(&frame, &[job], &mut |traced| {
            let batches = traced.batches.iter().filter(|batch| !batch.is_work());
            rays += batches.map(|batch| batch.rays() as u64).sum::<u64>();
            bar.inc(traced.batches.len() as u64);
        });
        bar.finish_and_clear();
        let run = runs.remove(0)?;
        let own = &paths.world.instances()[0];
        let map = *frame.map();
        let setup = Setup {
            scene: models.clone(),
            method: MethodFacts::new(chosen.method, &chosen.knobs, &own.method.choices(own.sight()), map.bytes()),
            view: None,
            frames: None,
            rays: Some(RayFileFacts { file: file.to_owned(), count: rays }),
            compute,
            machine: machine.clone(),
        };
        Ok(SimResult::new(setup, chosen.method, &map, &run)?)
    };
    (0..=paths.depth).map(result).collect()
}

/// Totals and their differences.
pub fn bounces(results: &[SimResult]) -> Vec<Bounces> {
    let figures = |own: &SimResult| (own.rays, own.milliseconds, own.energy.total);
    let mut before = (0, 0.0, 0.0);
    let row = |(bounces, own): (u32, &SimResult)| {
        let (rays, milliseconds, energy) = figures(own);
        let row = Bounces {
            bounces,
            rays,
            cycles: own.cycles,
            milliseconds,
            energy,
            energy_unit: own.energy.unit.clone(),
            dram_bytes: own.dram.bytes,
            added_rays: rays - before.0,
            added_milliseconds: milliseconds - before.1,
            added_energy: energy - before.2,
        };
        before = (rays, milliseconds, energy);
        row
    };
    (0..).zip(results).map(row).collect()
}
