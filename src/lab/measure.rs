//! Everything that the lab measures, in parts that any computer can do: cases by batches of rays, the hunt by climbs, the curves. Parts of one seed add up to the same
//! figures wherever they are cut.

use super::cases::Case;
use super::growth::{Growth, growth, rays as growth_rays};
use super::hunt::{Hunt, climbs, hunt_climbs};
use super::judge::WIDTHS_CHECKED;
use super::model::Model;
use super::stiff::Scale;
use super::suite::{Report, Row, batches, shares, shoot_batches};
use crate::format::SceneError;
use crate::num::MAX_LEVELS;
use crate::report::results_version;
use crate::study::JobLine;
use crate::study::shards::{Opening, Part, Piece, Pieces, Spent};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::time::Instant;
use xxhash_rust::xxh3::xxh3_64;

/// Batches of one part: a million rays, which take some seconds.
const BATCHES: u64 = 512;
/// Climbs of one part.
const CLIMBS: u64 = 128;

// Nanoseconds, about: of a ray where a case has the largest share, of a climb, of all curves, of a case's models.
const RAY: u64 = 10_000;
const CLIMB: u64 = 200_000_000;
const CURVES: u64 = 20_000_000_000;
const MODELS: u64 = 1_000_000_000;

/// Everything measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// The cases.
    #[serde(flatten)]
    pub report: Report,
    /// The hunt, if there was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hunt: Option<Hunt>,
    /// How errors grow, if that was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub growth: Option<Growth>,
}

/// What is to be measured.
pub struct LabPlan<'a> {
    /// Cases, in the order of the table.
    pub cases: Vec<&'a Case>,
    /// Rays over all of them.
    pub rays: u64,
    /// A model to shoot at in place of the cases' own, and a checksum of its file.
    pub given: Option<(Model, u64)>,
    /// Steps of the hunt; 0 for none.
    pub steps: u64,
    /// How errors grow is measured too.
    pub curves: bool,
    /// Seed of everything.
    pub seed: u64,
}

/// What one part gave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LabLine {
    key: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    row: Option<Row>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hunt: Option<Hunt>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    growth: Option<Growth>,
}

impl JobLine for LabLine {
    fn key(&self) -> &str {
        &self.key
    }

    fn has_result(&self) -> bool {
        true
    }
}

/// A part of the work.
enum Work {
    /// Batches of a case.
    Case(usize, Range<u64>),
    /// Climbs.
    Hunt(Range<u64>),
    Growth,
}

/// A range in pieces of at most so much.
fn pieces(all: u64, most: u64) -> impl Iterator<Item = Range<u64>> {
    (0..all.div_ceil(most)).map(move |k| k * most..all.min((k + 1) * most))
}

impl LabPlan<'_> {
    /// Rays of each case.
    fn shares(&self) -> Vec<u64> {
        shares(&self.cases, self.rays)
    }

    /// Rays and steps of all parts together: what progress is told at the end.
    pub fn total(&self) -> u64 {
        self.shares().iter().sum::<u64>() + self.steps + if self.curves { growth_rays(MAX_LEVELS) } else { 0 }
    }

    /// All parts in order, with their names.
    fn works(&self) -> Vec<(String, Work)> {
        let inputs = (self.given.as_ref().map(|(_, content)| *content), WIDTHS_CHECKED, self.seed);
        let hash = xxh3_64(format!("{inputs:?}").as_bytes());
        let key = |what: String| format!("{what}, seed {} #{hash:016x} {}", self.seed, results_version());
        let mut works = Vec::new();
        for (at, (case, rays)) in self.cases.iter().zip(self.shares()).enumerate() {
            let name = |part: &Range<u64>| key(format!("{}, batches {} to {} of {rays} rays", case.name, part.start, part.end));
            works.extend(pieces(batches(rays), BATCHES).map(|part| (name(&part), Work::Case(at, part))));
        }
        let name = |part: &Range<u64>| key(format!("hunt, climbs {} to {} of {} steps", part.start, part.end, self.steps));
        works.extend(pieces(climbs(self.steps), CLIMBS).map(|part| (name(&part), Work::Hunt(part))));
        works.extend(self.curves.then(|| (key("growth".to_owned()), Work::Growth)));
        works
    }

    /// The names of all parts, in order.
    pub fn keys(&self) -> Vec<String> {
        self.works().into_iter().map(|(key, _)| key).collect()
    }

    /// The parts as pieces of work, and what building the models of each case takes.
    pub fn pieces(&self) -> Pieces {
        let piece = |(key, work): (String, Work)| {
            let (scene, estimate) = match work {
                // A case whose rays take long has a small share of them.
                Work::Case(at, part) => (at, (part.end - part.start) * 2048 * RAY * 32 / self.cases[at].share.max(1)),
                Work::Hunt(part) => (self.cases.len(), (part.end - part.start) * CLIMB),
                Work::Growth => (self.cases.len(), CURVES),
            };
            Piece { scene, keys: vec![key], estimate }
        };
        let estimate = if self.given.is_some() { 0 } else { MODELS };
        let openings = self.cases.iter().map(|case| Opening { name: case.name.to_owned(), estimate });
        let nothing = Opening { name: "hunt and growth".to_owned(), estimate: 0 };
        Pieces { all: self.works().into_iter().map(piece).collect(), openings: openings.chain([nothing]).collect() }
    }

    /// Measures the parts of `part`, in order, and gives each line to `take`. `progress` is told what is measured, and how many rays and steps were done since its last
    /// call, from any thread.
    ///
    /// # Errors
    /// A model cannot be built, or those of `take`.
    pub fn measure<E: From<SceneError>>(
        &self,
        part: Part<'_>,
        progress: &(dyn Fn(&str, u64) + Sync),
        mut take: impl FnMut(LabLine) -> Result<(), E>,
    ) -> Result<(), E> {
        let rays = self.shares();
        let given = self.given.as_ref().map(|(model, _)| model);
        // Of the last case: its parts follow each other.
        let mut models: Option<(usize, Vec<Model>)> = None;
        for (key, work) in self.works().into_iter().filter(|(key, _)| part.has(key)) {
            if let (Work::Case(at, _), None) = (&work, given)
                && models.as_ref().is_none_or(|(of, _)| of != at)
            {
                let case = self.cases[*at];
                progress(case.name, 0);
                let begun = Instant::now();
                drop(models.take());
                models = Some((*at, (case.models)(Scale::Full)?));
                (part.spent)(Spent::Opening(case.name), begun.elapsed());
            }
            let begun = Instant::now();
            let mut line = LabLine { key, row: None, hunt: None, growth: None };
            match work {
                Work::Case(at, batches) => {
                    let case = self.cases[at];
                    let own = models.as_ref().map_or(&[][..], |(_, models)| models);
                    let models = given.map_or(own, std::slice::from_ref);
                    line.row = Some(shoot_batches(case, models, rays[at], batches, self.seed, &|n| progress(case.name, n)));
                }
                Work::Hunt(climbs) => {
                    line.hunt = Some(hunt_climbs(given, self.steps, climbs, self.seed, &|n| progress("hunt", n))?);
                }
                Work::Growth => line.growth = Some(growth(MAX_LEVELS, self.seed, &|n| progress("growth", n))?),
            }
            let key = line.key.clone();
            take(line)?;
            (part.spent)(Spent::Job(&key), begun.elapsed());
        }
        Ok(())
    }

    /// The figures of all parts' lines.
    pub fn figures(&self, lines: impl IntoIterator<Item = LabLine>) -> Figures {
        let mut figures = Figures { report: Report::new(self.seed), hunt: None, growth: None };
        let mut rows: Vec<Option<Row>> = vec![None; self.cases.len()];
        for LabLine { row, hunt, growth, .. } in lines {
            if let Some(row) = row
                && let Some(at) = self.cases.iter().position(|case| case.name == row.case)
            {
                rows[at] = Some(match rows[at].take() {
                    Some(before) => before.with(&row),
                    None => row,
                });
            }
            if let Some(hunt) = hunt {
                figures.hunt = Some(figures.hunt.take().unwrap_or_default().with(hunt));
            }
            figures.growth = figures.growth.take().or(growth);
        }
        figures.report.rows = rows.into_iter().flatten().collect();
        figures
    }
}
