//! What is said of an error that pixels or rays have.

use serde::{Deserialize, Serialize};

/// Mean, median, 99th percentile and largest of an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorSpread {
    /// Mean.
    pub mean: f64,
    /// Half are below.
    pub median: f64,
    /// 99 of 100 are below.
    pub percentile_99: f64,
    /// Largest.
    pub maximum: f64,
}

impl ErrorSpread {
    /// Of these errors; none if there are none. Those that are not finite do not count.
    pub fn of(errors: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut errors: Vec<f64> = errors.into_iter().filter(|error| error.is_finite()).collect();
        // In their order: the sum is the same for every run.
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        let maximum = errors.iter().copied().reduce(f64::max)?;
        let mut below = |percent: usize| {
            let at = (errors.len() * percent / 100).min(errors.len() - 1);
            *errors.select_nth_unstable_by(at, f64::total_cmp).1
        };
        Some(Self { mean, median: below(50), percentile_99: below(99), maximum })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_hundred_and_of_none() {
        let errors = (0..100).map(|k| f64::from(k * 37 % 100));
        assert_eq!(
            ErrorSpread::of(errors.chain([f64::NAN])),
            Some(ErrorSpread { mean: 49.5, median: 50.0, percentile_99: 99.0, maximum: 99.0 })
        );
        assert_eq!(ErrorSpread::of([]), None);
        assert_eq!(ErrorSpread::of([2.0]).unwrap().percentile_99, 2.0);
    }
}
