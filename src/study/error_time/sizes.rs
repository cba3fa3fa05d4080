//! What frames of several sizes cost.

use super::costs::{costs, simulated};
use super::measure::Bench;
use crate::report::error_time::SizeCosts;
use crate::study::{StudyError, ViewJob, at_once};

/// Sizes of the frame at which methods are compared, where they are no larger than the view's own, which is the last.
const SIZES: [[u32; 2]; 5] = [[128, 128], [256, 256], [512, 512], [1024, 1024], [1920, 1080]];

/// Those of [`SIZES`] with fewer pixels than `own`, and `own`.
fn sizes(own: [u32; 2]) -> Vec<[u32; 2]> {
    let pixels = |[width, height]: [u32; 2]| u64::from(width) * u64::from(height);
    SIZES.into_iter().filter(|&size| pixels(size) < pixels(own)).chain([own]).collect()
}

impl Bench<'_> {
    /// What each method costs as it is if nothing is chosen, at several sizes of a view's frame.
    pub(super) fn sizes(&self, view: &ViewJob) -> Result<Vec<SizeCosts>, StudyError> {
        let mut all = Vec::new();
        for size in sizes(view.size) {
            let frame = ViewJob { size, ..view.clone() }.frame(&self.space)?;
            let defaults = self.defaults(&frame);
            let results = at_once(&defaults, |(at, setting)| simulated(&self.stage(*at, setting), &frame, None));
            for ((_, setting), results) in defaults.iter().zip(results) {
                all.push(SizeCosts {
                    view: 0,
                    size,
                    method: setting.chosen.method.name.to_owned(),
                    setting: setting.words.clone(),
                    costs: results?.iter().enumerate().map(|(machine, result)| costs(machine, result)).collect(),
                });
            }
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::sizes;

    #[test]
    fn no_size_is_larger_than_the_named_one() {
        assert_eq!(sizes([1920, 1080]), [[128, 128], [256, 256], [512, 512], [1024, 1024], [1920, 1080]]);
        assert_eq!(sizes([512, 512]), [[128, 128], [256, 256], [512, 512]]);
        assert_eq!(sizes([1000, 100]), [[128, 128], [256, 256], [1000, 100]]);
        assert_eq!(sizes([48, 48]), [[48, 48]]);
    }
}
