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

/// The least cost at which a method's error is at most `level`, interpolated between neighbours of its sweep where the error passes it, on
/// logarithmic scales, never outside of what was measured; and what is to be said of it.
pub fn cost_at(sweep: &[Pair], level: f64) -> (Option<f64>, Option<&'static str>) {
    let passes = sweep.windows(2).filter_map(|ends| {
        let [[from, from_cost], [to, to_cost]] = [ends[0], ends[1]];
        let ((low, low_cost), (high, high_cost)) =
            if from <= to { ((from, from_cost), (to, to_cost)) } else { ((to, to_cost), (from, from_cost)) };
        // Nothing lies between an error and none at all on a logarithmic scale.
        (low <= level && level < high && low > 0.0 && low_cost > 0.0 && high_cost > 0.0).then(|| {
            let part = (level / low).ln() / (high / low).ln();
            (low_cost.ln() + part * (high_cost / low_cost).ln()).exp()
        })
    });
    let measured = sweep.iter().filter(|[error, _]| *error <= level).map(|pair| pair[1]);
    let least = passes.chain(measured).reduce(f64::min);
    let said = if least.is_none() {
        Some(NOT_REACHED)
    } else {
        // Of a single setting nothing else can be said.
        (sweep.len() > 1 && sweep.iter().all(|[error, _]| *error <= level)).then_some(ALWAYS_BELOW)
    };
    (least, said)
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
    let sweep = |method: &str| -> Vec<Pair> {
        let of = points.iter().filter(|point| point.method == method);
        of.filter_map(|point| Some([(error.of)(point)?, (cost.of)(point, point.costs.get(at)?)?])).collect()
    };
    let own = sweep(ours);
    let others: Vec<_> = document.methods.iter().filter(|m| m.name != ours).map(|m| (&m.name, sweep(&m.name))).collect();
    let at_level = |&level: &f64| {
        let (mine, said) = cost_at(&own, level);
        let other = |(method, sweep): &(&String, Vec<Pair>)| {
            let (theirs, said) = cost_at(sweep, level);
            let ratio = theirs.zip(mine).filter(|(_, mine)| *mine > 0.0).map(|(theirs, mine)| theirs / mine);
            EqualCost { method: (*method).clone(), cost: theirs, ratio, why: said.map(str::to_owned) }
        };
        EqualError {
            view: key.view,
            samples: key.samples,
            error: error.id.to_owned(),
            level,
            cost: cost.id.to_owned(),
            machine: key.machine,
            compute: key.compute.to_owned(),
            ours: mine,
            why: said.map(str::to_owned),
            methods: others.iter().map(other).collect(),
        }
    };
    if own.is_empty() { Vec::new() } else { levels.iter().map(at_level).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_are_interpolated_on_logarithmic_scales_and_only_inside() {
        let sweep = [[4.0, 1.0], [1.0, 4.0], [0.25, 16.0]];
        let near = |(cost, said): (Option<f64>, Option<&str>), of: f64| (cost.unwrap() - of).abs() < 1e-12 && said.is_none();
        assert!(near(cost_at(&sweep, 2.0), 2.0) && near(cost_at(&sweep, 0.5), 8.0) && near(cost_at(&sweep, 1.0), 4.0));
        assert!(near(cost_at(&sweep, 0.25), 16.0));
        assert_eq!(cost_at(&sweep, 0.2), (None, Some(NOT_REACHED)));
        assert_eq!(cost_at(&sweep, 5.0), (Some(1.0), Some(ALWAYS_BELOW)));
        // The least of what is near enough, whatever the sweep does in between; a full resolution is always near enough.
        let folded = [[4.0, 1.0], [1.0, 9.0], [2.0, 1.5]];
        assert!(near(cost_at(&folded, 2.0), 1.5));
        assert_eq!(cost_at(&[[0.0, 7.0]], 0.5), (Some(7.0), None));
        // From an error to none there is nothing in between.
        assert_eq!(cost_at(&[[4.0, 1.0], [0.0, 9.0]], 1.0), (Some(9.0), None));
        assert_eq!(cost_at(&[], 1.0), (None, Some(NOT_REACHED)));
    }

    #[test]
    fn a_front_has_what_nothing_beats() {
        assert_eq!(
            front(&[[1.0, 4.0], [2.0, 2.0], [2.0, 3.0], [4.0, 1.0], [4.0, 1.0], [5.0, 1.0]]),
            [true, true, false, true, false, false]
        );
    }
}
