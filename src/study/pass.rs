//! Frames on machines.

use super::progress::Progress;
use crate::scene::{Outcome, Pass, Target};

/// Traces the rays of a pass once and replays them on every target, in their order.
pub fn simulate(pass: &Pass<'_>, targets: &[Target], progress: &dyn Progress) -> Vec<Outcome> {
    let bar = progress.begin("simulating", Some(pass.rays.source().batches() as u64));
    pass.run(targets, &mut |traced| bar.step(traced.batches.len() as u64))
}
