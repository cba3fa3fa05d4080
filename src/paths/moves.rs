//! How a model moves from the first frame of a sequence to the last.

use super::checked::{Checked, FINITE, PLACE};
use super::pose::Pose;
use glam::{DMat3, DVec3};
use serde::Deserialize;

/// A way, and a turn about the model's own origin on it; both evenly in time.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MovesTable {
    /// From where it stands first to where it stands last.
    #[serde(default)]
    pub by: [f64; 3],
    /// It turns about this axis; about none by default.
    pub turn: Option<[f64; 3]>,
    /// By so many degrees in all.
    #[serde(default = "full_turn")]
    pub degrees: f64,
}

fn full_turn() -> f64 {
    360.0
}

impl MovesTable {
    /// Where a model is at a time from 0 to 1. At time 0, the first frame, it stands at `first`.
    pub(super) fn at(&self, first: &Pose, time: f64) -> Pose {
        let angle = (time * self.degrees).to_radians();
        let turn = self.turn.map_or(DMat3::IDENTITY, |axis| DMat3::from_axis_angle(DVec3::from_array(axis).normalize(), angle));
        first.about(first.origin(), &Pose::turned(turn, 1.0, self.by.map(|v| time * v)))
    }

    /// Whether it can be, under its key.
    pub(super) fn check(&self, to: &mut Checked, key: &str) {
        to.triple(&format!("{key}.by"), self.by, PLACE);
        if let Some(axis) = self.turn {
            to.direction(&format!("{key}.turn"), axis);
        }
        to.number(&format!("{key}.degrees"), self.degrees, FINITE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_goes_its_way_and_turns_about_its_origin() {
        let first = Pose::new([10.0, 20.0, 30.0], 0.5, [1.0, 2.0, 3.0]);
        let moves = MovesTable { by: [4.0, 0.0, -2.0], turn: Some([0.0, 3.0, 0.0]), degrees: 180.0 };
        for p in [DVec3::ZERO, DVec3::new(1.0, -2.0, 0.5)] {
            assert!((moves.at(&first, 0.0).out(p) - first.out(p)).length() < 1e-12);
            let own = first.out(p) - first.origin();
            let half = first.origin() + DVec3::new(2.0, 0.0, -1.0) + DMat3::from_rotation_y(std::f64::consts::FRAC_PI_2) * own;
            assert!((moves.at(&first, 0.5).out(p) - half).length() < 1e-12);
            let last = first.origin() + DVec3::new(4.0, 0.0, -2.0) + DVec3::new(-own.x, own.y, -own.z);
            assert!((moves.at(&first, 1.0).out(p) - last).length() < 1e-12);
        }
    }
}
