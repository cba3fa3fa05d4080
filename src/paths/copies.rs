//! Copies of a model in a grid.

use super::checked::{Checked, PLACE, SHARE, one};
use super::pose::Pose;
use crate::num::Random;
use glam::{DMat3, DVec3};
use serde::Deserialize;

/// A grid of copies of a model, each of which may stand a little elsewhere and be turned.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct CopiesTable {
    /// How many along x, y and z; at most [`MOST_COPIES`] in all.
    pub count: [u32; 3],
    /// From one to the next along each axis.
    pub step: [f64; 3],
    /// Each is moved at random by at most such a part of a step along each axis.
    #[serde(default)]
    pub jitter: f64,
    /// Each is turned at random about this axis; about none by default.
    pub turn: Option<[f64; 3]>,
    /// Each is scaled at random down to such a part.
    #[serde(default = "one")]
    pub least: f64,
    /// Seed of all that is random.
    #[serde(default)]
    pub seed: u64,
}

/// Most copies of a model.
pub const MOST_COPIES: u64 = 1 << 20;

impl CopiesTable {
    /// Where they stand, the first copy of the grid being the model's own place but for what is random.
    pub(super) fn poses(self) -> impl Iterator<Item = Pose> {
        let [along, up, deep] = self.count;
        let grid = (0..deep).flat_map(move |z| (0..up).flat_map(move |y| (0..along).map(move |x| [x, y, z])));
        grid.zip(0..).map(move |(cell, number)| {
            let mut random = Random::of(self.seed, number);
            // From 0 to 1.
            let mut part = || (random.next() >> 11) as f64 / (1u64 << 53) as f64;
            let moved = [0, 1, 2].map(|k: usize| self.step[k] * (f64::from(cell[k]) + self.jitter * (2.0 * part() - 1.0)));
            let scale = 1.0 - (1.0 - self.least) * part();
            let turn = self.turn.map_or(DMat3::IDENTITY, |axis| {
                DMat3::from_axis_angle(DVec3::from_array(axis).normalize(), part() * std::f64::consts::TAU)
            });
            Pose::turned(turn, scale, moved)
        })
    }

    /// Whether it can be, under its key.
    pub(super) fn check(&self, to: &mut Checked, key: &str) {
        let Self { count, step, jitter, turn, least, .. } = *self;
        let key = |name: &str| format!("{key}.{name}");
        let all = count.iter().map(|&n| u64::from(n)).fold(1, u64::saturating_mul);
        if all == 0 || all > MOST_COPIES {
            to.fail(key("count"), format!("must be from 1 to {MOST_COPIES} in all, but is {count:?}"));
        }
        to.triple(&key("step"), step, PLACE);
        to.number(&key("jitter"), jitter, SHARE);
        to.number(&key("least"), least, ("must be above 0 and at most 1", |v| v > 0.0 && v <= 1.0));
        if let Some(axis) = turn {
            to.direction(&key("turn"), axis);
        }
    }
}
