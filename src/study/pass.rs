//! Frames on machines.

use super::progress::Progress;
use crate::scene::{Outcome, Pass, Target, WorldPass};
use crate::step::MapError;

/// Traces the rays of a pass once and replays them on every target, in their order.
pub fn simulate(pass: &Pass<'_>, targets: &[Target], progress: &dyn Progress) -> Vec<Outcome> {
    let bar = progress.begin("simulating", Some(pass.rays.source().batches() as u64));
    pass.run(targets, &mut |traced| bar.step(traced.batches.len() as u64))
}

/// The same through several models.
///
/// # Errors
/// They have more lines than can be numbered.
pub fn simulate_models(pass: &WorldPass<'_>, targets: &[Target], progress: &dyn Progress) -> Result<Vec<Outcome>, MapError> {
    let bar = progress.begin("simulating", Some(pass.rays.source().batches() as u64));
    pass.run(targets, &mut |traced| bar.step(traced.batches.len() as u64))
}
