//! How errors grow with the number of splits and with the distance of the camera.

use super::error::{bary_error, pixels_off};
use super::model::Model;
use super::rays::{Aim, Cones, PIXEL, Shot, Views, shot};
use super::stiff::round_model;
use crate::format::SceneError;
use crate::golden::Exact;
use crate::method::ClosestHit;
use crate::method::lod::{LodImage, LodTraverser};
use crate::num::{MAX_LEVELS, Random};
use crate::step::NoSteps;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Rays of each point of a curve.
const RAYS: u64 = 20_000;
/// Of these, how many are also traced exactly.
const EXACT: u64 = 2_000;
/// Distances of the camera in bounding radii.
const DISTANCES: [f64; 11] = [1e-4, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6];
/// Where the camera is while the number of splits changes.
const NEAR: f64 = 0.01;
/// Splits while the distance changes.
const LEVELS: u32 = 4;

/// Errors of one model from one distance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Splits N.
    pub levels: u32,
    /// Distance in bounding radii.
    pub distance: f64,
    /// Hits.
    pub hits: u64,
    /// Largest and mean distance that rounding to units moved a vertex, in units.
    pub vertex_loss: [f64; 2],
    /// Worst and mean displacement of a hit in pixels of 1024 rows.
    pub pixels: [f64; 2],
    /// Worst error of a barycentric on the triangle that was met, and on the full-resolution triangle, in steps of 2^-31.
    pub bary_ulp: [f64; 2],
}

/// The two curves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// By number of splits, from 0.01 radii.
    pub by_levels: Vec<Point>,
    /// By distance, four splits.
    pub by_distance: Vec<Point>,
}

/// Measures both curves; `most` is the largest number of splits (10 takes some seconds and 1 GB).
///
/// # Errors
/// A model cannot be built.
pub fn growth(most: u32, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Result<Growth, SceneError> {
    let by_levels = (0..=most.min(MAX_LEVELS)).map(|levels| {
        let model = round_model(levels)?;
        Ok(point(&model, NEAR, seed, progress))
    });
    let by_levels = by_levels.collect::<Result<_, SceneError>>()?;
    let model = round_model(LEVELS)?;
    Ok(Growth { by_levels, by_distance: DISTANCES.iter().map(|&distance| point(&model, distance, seed, progress)).collect() })
}

/// Rays that [`growth`] shoots.
pub fn rays(most: u32) -> u64 {
    RAYS * (u64::from(most) + 1 + DISTANCES.len() as u64)
}

fn point(model: &Model, distance: f64, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Point {
    const BATCH: u64 = 1000;
    let golden = Exact::new(&model.hierarchy);
    // Distances are lists of a case: one that lives long enough is found by its value.
    let at = DISTANCES.iter().position(|&d| d == distance).unwrap_or(0);
    let views = Views { distances: &DISTANCES[at..=at], deltas: &[1.0], tangents: &[PIXEL] };
    let batch = |batch: u64| {
        let mut traverser = LodTraverser::new(LodImage::of(&model.scene));
        let (mut hits, mut most, mut sum, mut bary) = (0u64, 0.0f64, 0.0, [0.0f64; 2]);
        for number in batch * BATCH..(batch + 1) * BATCH {
            let mut random = Random::of(seed, number);
            let Some(Shot { ray, view: Some((world, moved)), .. }) = shot(model, Aim::View, Cones::Mixed, &views, &mut random) else {
                continue;
            };
            let mut closest = ClosestHit::new(model.hierarchy.levels);
            traverser.trace(&ray, &mut NoSteps, &mut closest);
            let Some(hit) = closest.record() else { continue };
            // The ray may meet something nearer than what it was aimed at: that is another distance.
            if moved.distance(hit.t.get()) < 0.5 * distance * model.space.radius() {
                continue;
            }
            if let Some(pixels) = pixels_off(model, &world, &moved, &hit) {
                (hits, most, sum) = (hits + 1, most.max(pixels), sum + pixels);
            }
            if number < EXACT
                && let Some((exact, fractions)) = golden.trace_exactly(&ray)
            {
                let error = bary_error(&hit, &fractions);
                bary = [bary[0].max(error), bary[1].max(error * f64::from(1u32 << (model.hierarchy.levels - exact.level)))];
            }
        }
        progress(BATCH);
        (hits, most, sum, bary)
    };
    // Batches in their order, so that sums do not depend on threads.
    let batches: Vec<_> = (0..RAYS / BATCH).into_par_iter().map(batch).collect();
    let (hits, most, sum, bary_ulp) = batches
        .into_iter()
        .fold((0, 0.0f64, 0.0, [0.0f64; 2]), |a, b| (a.0 + b.0, a.1.max(b.1), a.2 + b.2, [a.3[0].max(b.3[0]), a.3[1].max(b.3[1])]));
    let (loss, mean) = model.vertex_loss();
    let pixels = [most, sum / (hits as f64).max(1.0)];
    Point { levels: model.hierarchy.levels, distance, hits, vertex_loss: [loss, mean], pixels, bary_ulp }
}
