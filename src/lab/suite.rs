//! Runs cases: rays in parallel, tallies in order.

use super::cases::Case;
use super::judge::{Judge, LANES, Tally, WIDTHS_CHECKED};
use super::model::Model;
use super::placed::placed;
use super::rays::{Aim, beside, shot};
use super::stiff::Scale;
use crate::format::SceneError;
use crate::golden::Exact;
use crate::lab::crack::Closedness;
use crate::num::Random;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Rays of one batch: all of one model.
const BATCH: u64 = 2048;

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the case.
    pub case: String,
    /// What is hard about it.
    pub about: String,
    /// Models.
    pub models: u64,
    /// What its rays have shown.
    #[serde(flatten)]
    pub tally: Tally,
    /// Largest distance that rounding to units moved a vertex, in units.
    pub vertex_loss: f64,
}

impl Row {
    /// Two parts of a case together, in either order.
    pub fn with(self, b: &Self) -> Self {
        Self { tally: self.tally.with(&b.tally), vertex_loss: self.vertex_loss.max(b.vertex_loss), ..self }
    }
}

/// The whole table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Seed of all rays.
    pub seed: u64,
    /// Overflows were looked for on every ray.
    pub widths_checked: bool,
    /// By case.
    pub rows: Vec<Row>,
}

impl Report {
    /// An empty report.
    pub fn new(seed: u64) -> Self {
        Self { seed, widths_checked: WIDTHS_CHECKED, rows: Vec::new() }
    }

    /// All rows together.
    pub fn total(&self) -> Tally {
        self.rows.iter().fold(Tally::default(), |sum, row| sum.with(&row.tally))
    }
}

/// Rays of each case: at least `rays` together, and at least one each.
pub fn shares(cases: &[&Case], rays: u64) -> Vec<u64> {
    let all: u64 = cases.iter().map(|case| case.share).sum();
    let share = |case: &&Case| (u128::from(rays) * u128::from(case.share)).div_ceil(u128::from(all.max(1)));
    cases.iter().map(|case| share(case) as u64).collect() // at most `rays`
}

/// Builds a case's models and shoots `rays` rays at them. `progress` is told how many were shot since its last call, from any thread.
///
/// # Errors
/// A model cannot be built.
pub fn run(case: &Case, scale: Scale, rays: u64, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Result<Row, SceneError> {
    let models = (case.models)(scale)?;
    Ok(shoot(case, &models, rays, seed, progress))
}

/// Shoots `rays` rays of a case at these models, in turn.
pub fn shoot(case: &Case, models: &[Model], rays: u64, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Row {
    shoot_batches(case, models, rays, 0..batches(rays), seed, progress)
}

/// How many batches so many rays are.
pub fn batches(rays: u64) -> u64 {
    rays.div_ceil(BATCH)
}

/// The same of some batches of these rays: parts, put together by [`Row::with`], are the whole.
pub fn shoot_batches(case: &Case, models: &[Model], rays: u64, batches: Range<u64>, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Row {
    let golden: Vec<Exact<'_>> = models.par_iter().map(|m| Exact::new(&m.hierarchy)).collect();
    // A case of its own stream: the same seed does not draw the same rays in all.
    let seed = case.name.bytes().fold(seed, |seed, c| Random::of(seed, u64::from(c)).next());
    let batch_of = |batch: u64| {
        let at = (batch % models.len() as u64) as usize;
        let model = &models[at];
        let every = if model.closed == Closedness::Open { 1 } else { case.every };
        let mut judge = Judge::new(model, &golden[at], every);
        let end = rays.min((batch + 1) * BATCH);
        let mut sum = Tally::default();
        let drawn = |number: u64| {
            let mut random = Random::of(seed, number);
            let aim = case.aims[random.below(case.aims.len() as u64) as usize];
            let shot = shot(model, aim, case.cones, &case.views, &mut random);
            (aim, if case.is_placed { shot.and_then(|shot| placed(model, &shot, &mut random)) } else { shot }, random)
        };
        let mut number = batch * BATCH;
        while number < end {
            let count = if case.is_packed { end.min(number + LANES) - number } else { 1 };
            if case.is_packed {
                // A pencil, or rays each from elsewhere.
                let mut random = Random::of(seed, !number);
                let first = drawn(number).1.filter(|_| random.below(2) == 0);
                let shots = (number..number + count).filter_map(|own| match &first {
                    Some(first) => Some(beside(model, first, &mut random)),
                    None => drawn(own).1,
                });
                let shots: Vec<_> = shots.collect();
                sum = sum.with(&judge.shoot_together(number / LANES, &shots));
                sum.rays += count - shots.len() as u64;
            } else {
                match drawn(number) {
                    (Aim::Leaving(_, bounces), Some(shot), mut random) => {
                        sum = sum.with(&judge.follow(number, &shot, bounces, case.cones, &mut random));
                    }
                    (_, Some(shot), _) => sum = sum.with(&judge.shoot(number, &shot)),
                    (_, None, _) => sum.rays += 1, // it misses the model's box, and so the model
                }
            }
            number += count;
        }
        progress(end - batch * BATCH);
        sum
    };
    let tally = batches.into_par_iter().map(batch_of).reduce(Tally::default, |a, b| a.with(&b));
    let vertex_loss = models.iter().map(|m| m.vertex_loss().0).fold(0.0, f64::max);
    Row { case: case.name.to_owned(), about: case.about.to_owned(), models: models.len() as u64, tally, vertex_loss }
}
