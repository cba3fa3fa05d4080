//! Rays that end early, on the cycle model alone: every error, and any mischief for millions of cycles. `LODRAY_CYCLES` asks for that many cycles.

use lodray::hardware::{Hardware, RayError};
use lodray::sim::unit::TraversalUnit;
use lodray_test_support::early::{each_error, each_moment, each_rest};
use lodray_test_support::hardware::OTHERS;
use lodray_test_support::hostile::{Hostile, Stage};
use lodray_test_support::models::Rng;

#[test]
fn every_error_is_told_and_the_next_ray_is_right() {
    each_error(|config, scene| TraversalUnit::new(config, *scene));
}

#[test]
fn flushes_and_resets_at_every_moment() {
    each_moment(|config, scene| TraversalUnit::new(config, *scene), 1);
}

#[test]
fn an_epoch_does_not_come_again_while_a_line_of_it_may() {
    each_rest(|config, scene| TraversalUnit::new(config, *scene));
}

#[test]
fn nothing_that_memory_does_hangs_the_unit_or_another_ray() {
    let wanted = std::env::var("LODRAY_CYCLES").map_or(2_000_000, |text| text.replace('_', "").parse().expect("LODRAY_CYCLES: a number"));
    let hardware = [Hardware { contexts: 8, ..Hardware::default() }, Hardware::one_context(), Hardware::default()];
    let hardware: Vec<Hardware> = hardware.into_iter().chain(OTHERS).collect();
    let (mut errors, mut stray, mut forgotten) = ([0; 8], 0, 0);
    for (seed, config) in (0..).zip(&hardware) {
        for lawful in [true, false] {
            let mut rng = Rng(seed);
            let stages: Vec<Stage> = (0..3).map(|_| Stage::random(config, &mut rng)).collect();
            let mut around = Hostile::new(*config, &stages, lawful, seed);
            let mut unit = TraversalUnit::new(*config, around.scene());
            around.run(&mut unit, wanted / (2 * hardware.len() as u64));
            println!("{:?}; {config:?}", around.tally);
            assert!(around.tally.clean > 0, "no ray was left alone; {config:?}");
            errors.iter_mut().zip(around.tally.errors).for_each(|(all, of_run)| *all += of_run);
            (stray, forgotten) = (stray + around.tally.stray, forgotten + around.tally.forgotten);
        }
    }
    // All that can happen did, but for a full stack, which no random memory leads to.
    let stack = RayError::Stack as usize;
    let missing: Vec<usize> = (1..8).filter(|&code| code != stack && errors[code] == 0).collect();
    assert!(
        missing.is_empty() && stray > 0 && forgotten > 0,
        "no error of codes {missing:?}; {stray} stray lines, {forgotten} rays forgotten"
    );
}
