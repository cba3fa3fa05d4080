//! What methods cost where their error is the same, and the front of what no other setting beats in both.

use super::document::{EqualCost, EqualError, ErrorTime, Point};
use super::measure::{COSTS, CostMeasure, ERRORS, ErrorMeasure};

/// Why a method has no cost at an error: all its settings are further off.
pub const NOT_REACHED: &str = "not reached";
/// Why its cost is that of its coarsest setting: all that were measured are nearer than the error asked for.
pub const ALWAYS_BELOW: &str = "always below";

/// Errors at which methods are compared, and the levels: pixels, and FLIP.
const LEVELS: [(&str, [f64; 4]); 5] =
    [("surface-p99", PIXELS), ("surface-mean", PIXELS), ("hit-p99", PIXELS), ("flip-mean", FLIP), ("viewed-flip-mean", FLIP)];
const PIXELS: [f64; 4] = [0.25, 0.5, 1.0, 2.0];
const FLIP: [f64; 4] = [0.01, 0.02, 0.05, 0.1];

/// Costs by which they are.
const COMPARED: [&str; 4] = ["time", "energy", "dram-lines", "l1-requests"];

/// A setting of a method: error and cost.
pub type Pair = [f64; 2];

/// What a method costs at an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// The cost; absent if no setting is near enough.
    pub cost: Option<f64>,
    /// Which setting has it; absent where it lies between two.
    pub setting: Option<usize>,
    /// What is to be said of it.
    pub why: Option<&'static str>,
}

/// The least cost at which a method's error is at most `level`. A knob whose values are `in_steps` has nothing between them: the cost is that of the cheapest
/// setting that is near enough. Of any other it is interpolated between neighbours of the sweep where the error passes the level, on logarithmic scales,
/// never outside of what was measured.
pub fn cost_at(sweep: &[Pair], level: f64, in_steps: bool) -> Reached {
    let between = |ends: &[Pair]| {
        let [[from, from_cost], [to, to_cost]] = [ends[0], ends[1]];
        let ((low, low_cost), (high, high_cost)) =
            if from <= to { ((from, from_cost), (to, to_cost)) } else { ((to, to_cost), (from, from_cost)) };
        // Nothing lies between an error and none at all on a logarithmic scale.
        (low <= level && level < high && low > 0.0 && low_cost > 0.0 && high_cost > 0.0).then(|| {
            let part = (level / low).ln() / (high / low).ln();
            (low_cost.ln() + part * (high_cost / low_cost).ln()).exp()
        })
    };
    let passes = sweep.windows(2).filter(|_| !in_steps).filter_map(between).map(|cost| (cost, None));
    let measured = sweep.iter().enumerate().filter(|(_, [error, _])| *error <= level).map(|(k, pair)| (pair[1], Some(k)));
    let least = measured.chain(passes).reduce(|a, b| if b.0 < a.0 { b } else { a });
    let why = if least.is_none() {
        Some(NOT_REACHED)
    } else {
        // Of a single setting nothing else can be said.
        (sweep.len() > 1 && sweep.iter().all(|[error, _]| *error <= level)).then_some(ALWAYS_BELOW)
    };
    Reached { cost: least.map(|of| of.0), setting: least.and_then(|of| of.1), why }
}

/// Which of these no other beats in both, or equals in both and stands before.
pub fn front(points: &[Pair]) -> Vec<bool> {
    let beats = |(i, a): (usize, &Pair), (j, b): (usize, &Pair)| a[0] <= b[0] && a[1] <= b[1] && (a != b || i < j);
    points.iter().enumerate().map(|b| !points.iter().enumerate().any(|a| a.0 != b.0 && beats(a, b))).collect()
}

/// Equal-error comparisons of all views, for every error with levels and every cost; `ours` names the method that the others are compared with.
pub fn equal_errors(document: &ErrorTime, ours: &str) -> Vec<EqualError> {
    let with_levels = |(id, levels): &(&str, [f64; 4])| Some((*ERRORS.iter().find(|error| error.id == *id)?, *levels));
    let errors: Vec<(ErrorMeasure, [f64; 4])> = LEVELS.iter().filter_map(with_levels).collect();
    let mut all = Vec::new();
    for view in 0..document.views.len() {
        let of_view: Vec<&Point> = document.points.iter().filter(|point| point.view == view).collect();
        let mut samples: Vec<u32> = of_view.iter().map(|point| point.samples).collect();
        samples.sort_unstable();
        samples.dedup();
        for samples in samples {
            let points: Vec<&Point> = of_view.iter().copied().filter(|point| point.samples == samples).collect();
            // Every point has the same machines.
            for (at, costs) in points.first().map_or(&[][..], |first| &first.costs).iter().enumerate() {
                for (error, levels) in &errors {
                    for cost in COSTS.iter().filter(|cost| COMPARED.contains(&cost.id)) {
                        let key = Key { view, samples, machine: costs.machine, compute: &costs.compute };
                        all.extend(compared(document, ours, &points, at, &key, (error, levels), cost));
                    }
                }
            }
        }
    }
    all
}

/// Where a comparison is made.
struct Key<'a> {
    view: usize,
    samples: u32,
    machine: usize,
    compute: &'a str,
}

fn compared(
    document: &ErrorTime,
    ours: &str,
    points: &[&Point],
    at: usize,
    key: &Key<'_>,
    (error, levels): (&ErrorMeasure, &[f64]),
    cost: &CostMeasure,
) -> Vec<EqualError> {
    let pair = |point: &Point| Some([(error.of)(point)?, (cost.of)(point, point.costs.get(at)?)?]);
    let sweep = |method: &str| -> Vec<(&Point, Pair)> {
        let of = points.iter().filter(|point| point.method == method);
        of.filter_map(|&point| Some((point, pair(point)?))).collect()
    };
    let reached = |sweep: &[(&Point, Pair)], level: f64, in_steps: bool| {
        let reached = cost_at(&sweep.iter().map(|of| of.1).collect::<Vec<_>>(), level, in_steps);
        (reached, reached.setting.map(|k| sweep[k].0.setting.clone()))
    };
    let steps = |name: &str| document.methods.iter().any(|method| method.name == name && method.in_steps);
    let own = sweep(ours);
    let others: Vec<_> = document.methods.iter().filter(|m| m.name != ours).map(|m| (&m.name, sweep(&m.name))).collect();
    let at_level = |&level: &f64| {
        let (mine, setting) = reached(&own, level, steps(ours));
        let over = |theirs: Option<f64>| theirs.zip(mine.cost).filter(|(_, mine)| *mine > 0.0).map(|(theirs, mine)| theirs / mine);
        let other = |(method, sweep): &(&String, Vec<(&Point, Pair)>)| {
            let (theirs, setting) = reached(sweep, level, steps(method));
            let why = theirs.why.map(str::to_owned);
            EqualCost { method: (*method).clone(), setting, cost: theirs.cost, ratio: over(theirs.cost), why }
        };
        let rule = |(method, sweep): &(&String, Vec<(&Point, Pair)>)| {
            let (point, [error, cost]) = sweep.iter().find(|(point, _)| point.is_default && steps(method))?;
            let why = (*error > level).then(|| format!("{NOT_REACHED}: its error is {error:.3}"));
            Some(EqualCost {
                method: (*method).clone(),
                setting: Some(point.setting.clone()),
                cost: Some(*cost),
                ratio: over(Some(*cost)),
                why,
            })
        };
        EqualError {
            view: key.view,
            samples: key.samples,
            error: error.id.to_owned(),
            level,
            cost: cost.id.to_owned(),
            machine: key.machine,
            compute: key.compute.to_owned(),
            ours: mine.cost,
            setting,
            why: mine.why.map(str::to_owned),
            methods: others.iter().map(other).collect(),
            own_rule: others.iter().filter_map(rule).collect(),
        }
    };
    if own.is_empty() { Vec::new() } else { levels.iter().map(at_level).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_are_interpolated_on_logarithmic_scales_and_only_inside() {
        let cost_at = |sweep: &[Pair], level| cost_at(sweep, level, false);
        let at = |cost, setting, why| Reached { cost, setting, why };
        let sweep = [[4.0, 1.0], [1.0, 4.0], [0.25, 16.0]];
        let near = |of: Reached, cost: f64| (of.cost.unwrap() - cost).abs() < 1e-12 && of.why.is_none();
        assert!(near(cost_at(&sweep, 2.0), 2.0) && near(cost_at(&sweep, 0.5), 8.0) && near(cost_at(&sweep, 1.0), 4.0));
        assert_eq!((cost_at(&sweep, 2.0).setting, cost_at(&sweep, 1.0).setting), (None, Some(1)));
        assert!(near(cost_at(&sweep, 0.25), 16.0));
        assert_eq!(cost_at(&sweep, 0.2), at(None, None, Some(NOT_REACHED)));
        assert_eq!(cost_at(&sweep, 5.0), at(Some(1.0), Some(0), Some(ALWAYS_BELOW)));
        // The least of what is near enough, whatever the sweep does in between; a full resolution is always near enough.
        let folded = [[4.0, 1.0], [1.0, 9.0], [2.0, 1.5]];
        assert!(near(cost_at(&folded, 2.0), 1.5));
        assert_eq!(cost_at(&[[0.0, 7.0]], 0.5), at(Some(7.0), Some(0), None));
        // From an error to none there is nothing in between.
        assert_eq!(cost_at(&[[4.0, 1.0], [0.0, 9.0]], 1.0), at(Some(9.0), Some(1), None));
        assert_eq!(cost_at(&[], 1.0), at(None, None, Some(NOT_REACHED)));
    }

    #[test]
    fn between_steps_there_is_nothing() {
        let sweep = [[4.0, 1.0], [1.0, 4.0], [0.25, 16.0], [0.0, 12.0]];
        for (level, cost, setting) in [(3.99, 4.0, 1), (1.0, 4.0, 1), (0.99, 12.0, 3), (0.3, 12.0, 3), (0.0, 12.0, 3)] {
            assert_eq!(cost_at(&sweep, level, true), Reached { cost: Some(cost), setting: Some(setting), why: None });
        }
        assert_eq!(cost_at(&sweep[..2], 0.5, true), Reached { cost: None, setting: None, why: Some(NOT_REACHED) });
    }

    #[test]
    fn a_front_has_what_nothing_beats() {
        assert_eq!(
            front(&[[1.0, 4.0], [2.0, 2.0], [2.0, 3.0], [4.0, 1.0], [4.0, 1.0], [5.0, 1.0]]),
            [true, true, false, true, false, false]
        );
    }
}
