//! Progress of studies on a terminal.

use super::output::{progress, spinner, warn};
use indicatif::ProgressBar;
use lodray::study::{Progress, Work};

/// Shows bars and spinners on standard error.
pub struct Bars;

struct Bar(ProgressBar);

impl Progress for Bars {
    fn begin(&self, what: &str, steps: Option<u64>) -> Box<dyn Work + '_> {
        Box::new(Bar(steps.map_or_else(|| spinner(what), |steps| progress(steps, what))))
    }

    fn note(&self, line: &str) {
        warn(line);
    }
}

impl Work for Bar {
    fn step(&self, steps: u64) {
        self.0.inc(steps);
    }

    fn say(&self, line: &str) {
        self.0.println(line);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
