//! Rays that end early: every error, and any mischief of memory, flushes, resets and scenes, on model and RTL side by side, equal on every port in every cycle.
//! `LODRAY_CYCLES` asks for that many cycles in place of a few hundred thousand.

use crate::{SideBySide, configs, cycles_or, others};
use lodray::hardware::Hardware;
use lodray::hardware::ports::SceneConfig;
use lodray::sim::unit::environment::UnitPort;
use lodray::sim::unit::{Inputs, TraversalUnit};
use lodray_test_support::early::{each_error, each_moment, each_rest};
use lodray_test_support::hostile::{Exposed, Hostile, Stage};
use lodray_test_support::models::Rng;

impl Exposed for SideBySide {
    fn reset(&mut self) {
        self.model.reset();
        self.rtl.reset();
        self.cycle += 1;
    }
    fn set_scene(&mut self, scene: &SceneConfig) {
        self.model.set_scene(*scene);
        self.rtl.scene(scene);
        // It stands still from the cycle before a ray is taken.
        self.tick(&Inputs::default());
    }
    fn model(&self) -> &TraversalUnit {
        &self.model
    }
}

impl Drop for SideBySide {
    fn drop(&mut self) {
        assert!(std::thread::panicking() || self.any_answer || !self.rtl.sim.failed(), "{}: an assertion of the RTL failed", self.what);
    }
}

#[test]
fn every_error_is_told_and_the_next_ray_is_right() {
    each_error(|config, scene| SideBySide::new(config, scene, 1, "every error".to_owned()));
}

#[test]
fn flushes_and_resets_at_any_moment() {
    each_moment(|config, scene| SideBySide::new(config, scene, 1, "every moment".to_owned()), 29);
}

#[test]
fn an_epoch_does_not_come_again_while_a_line_of_it_may() {
    each_rest(|config, scene| SideBySide::new(config, scene, 1, "rest".to_owned()));
}

fn mischief(lawful: bool, cycles: u64) {
    let seed = tb::seed(1).unwrap_or_else(|error| panic!("{error}"));
    let hardware: Vec<Hardware> = configs().iter().chain(others()).copied().collect();
    for (seed, config) in (seed..).zip(&hardware) {
        let mut rng = Rng(seed);
        let stages: Vec<Stage> = (0..3).map(|_| Stage::random(config, &mut rng)).collect();
        let mut around = Hostile::new(*config, &stages, lawful, seed);
        let mut both = SideBySide::new(*config, &around.scene(), seed, format!("seed {seed}, {config:?}"));
        both.any_answer = !lawful;
        around.run(&mut both, cycles / hardware.len() as u64);
        println!("{:?}; {config:?}", around.tally);
        assert!(around.tally.clean > 0, "no ray was left alone; {config:?}");
    }
}

#[test]
fn whatever_memory_does() {
    mischief(true, cycles_or(300_000));
}

#[test]
fn whatever_tags_answers_have() {
    mischief(false, cycles_or(300_000) / 2);
}
