//! Triangle tests that follow each other.

use super::{Act, Step, StepSink};

/// Most triangle tests of a step: bits of `hits`.
pub const MAX_RUN: u32 = 32;

/// Triangle tests that follow each other, stated in runs of as many as a step can hold.
#[derive(Clone, Copy, Debug, Default)]
pub struct TriangleRun {
    count: u32,
    hits: u32,
}

impl TriangleRun {
    /// Another test, and whether the triangle was met.
    #[inline(always)]
    pub fn add(&mut self, hit: bool, steps: &mut impl StepSink) {
        if self.count == MAX_RUN {
            self.state(steps);
        }
        self.hits |= u32::from(hit) << self.count;
        self.count += 1;
    }

    /// States the tests so far, if there are any.
    #[inline(always)]
    pub fn state(&mut self, steps: &mut impl StepSink) {
        let Self { count, hits } = std::mem::take(self);
        if count > 0 {
            steps.step(Step::of(Act::Triangles { count, hits }));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_any_length_are_stated_whole() {
        struct Kept(Vec<Step>);
        impl StepSink for Kept {
            fn step(&mut self, step: Step) {
                self.0.push(step);
            }
        }
        for tests in [0, 1, 4, 31, 32, 33, 64, 128, 200] {
            let mut kept = Kept(Vec::new());
            let mut run = TriangleRun::default();
            (0..tests).for_each(|k| run.add(k % 3 == 0, &mut kept));
            run.state(&mut kept);
            let hits = kept.0.iter().flat_map(|step| {
                let Act::Triangles { count, hits } = step.act else { panic!("{step:?}") };
                assert!((1..=MAX_RUN).contains(&count));
                (0..count).map(move |k| hits >> k & 1 == 1)
            });
            assert_eq!(hits.collect::<Vec<_>>(), (0..tests).map(|k| k % 3 == 0).collect::<Vec<_>>());
        }
    }
}
