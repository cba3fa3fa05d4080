//! `--ease`: the same frame again with each of what rays wait for in units turned off.

use lodray::block::tessellate::Tessellate;
use lodray::block::{Block, Operation};
use lodray::hardware::Eased;
use lodray::report::result::SimResult;
use lodray::scene::{Outcome, SimulateError, Target};

/// Each target, and behind it the same with each eased.
pub fn targets(all: &[Target]) -> Vec<Target> {
    let eased = |target: &Target| {
        let with = |(_, eased)| {
            let mut target = target.clone();
            target.machine.description.units.eased = eased;
            target
        };
        std::iter::once(target.clone()).chain(Eased::each().map(with)).collect::<Vec<_>>()
    };
    all.iter().flat_map(eased).collect()
}

/// The outcomes of targets, each with what those behind it took.
pub fn joined(outcomes: Vec<Outcome>) -> Vec<Outcome> {
    let mut outcomes = outcomes.into_iter();
    let mut all = Vec::new();
    while let Some(first) = outcomes.next() {
        let others: Result<Vec<_>, _> =
            Eased::each().zip(outcomes.by_ref()).map(|((name, _), other)| Ok::<_, SimulateError>((name, other?.0.cycles))).collect();
        all.push(first.and_then(|(result, wave)| Ok((with(result, others?), wave))));
    }
    all
}

/// A result with the cycles of others, by what they eased: only of what the frame asks for.
fn with(mut result: SimResult, others: Vec<(String, u64)>) -> SimResult {
    let hardware = result.setup.machine.description.units.config();
    let Some(units) = &mut result.units else { return result };
    for (name, cycles) in others {
        // Units for rays from a surface have other blocks in these places.
        let block = Operation::ALL.iter().find(|operation| operation.name() == name).map(|&operation| hardware.block(operation).name());
        let works = |block: &str| units.blocks.get(block).is_some_and(|block| block.operations > 0);
        let block = if name == "split_lines" { Some(Tessellate::NAME) } else { block };
        if block.is_none_or(works) {
            units.eased.insert(name, cycles);
        }
    }
    result
}
