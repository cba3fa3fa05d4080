//! The rays that a scene was pruned for.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The rays of a camera at a quality: all that they follow from, so that equal views have equal rays to the bit.
///
/// The ray of sample (x, y) goes from `eye` along `forward + u right - v above`, (u, v) = (x, y) + `shift` + 1/2 - `size` / 2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobView {
    /// Columns and rows of samples.
    pub size: [u32; 2],
    /// Quality, in digits that give the `f64` back; `inf` is full detail.
    pub delta: String,
    /// Where all rays begin, in the world.
    pub eye: [f64; 3],
    /// Where the camera looks, of length 1.
    pub forward: [f64; 3],
    /// To the next sample on the right, in a picture plane at distance 1.
    pub right: [f64; 3],
    /// To the next sample above.
    pub above: [f64; 3],
    /// Where the picture's rays begin, in samples to the right and down.
    pub shift: [f64; 2],
    /// Tangent of the half angle of every cone.
    pub cone: f64,
}

impl JobView {
    /// The quality; none if the text is no number.
    pub fn quality(&self) -> Option<f64> {
        self.delta.parse().ok()
    }

    /// The field that no camera can have, and what it must be.
    pub fn wrong(&self) -> Option<(&'static str, &'static str)> {
        let finite = |v: &[f64]| v.iter().all(|c| c.is_finite());
        let [forward, right, above] = [self.forward, self.right, self.above].map(DVec3::from_array);
        // Directions as cameras make them are rounded to 53 bits.
        let across = |step: DVec3| step.length() > 0.0 && step.normalize().dot(forward).abs() < 1e-9;
        if self.size.contains(&0) {
            Some(("size", "two numbers from 1 on"))
        } else if self.quality().is_none_or(|delta| delta.is_nan() || delta < 0.0) {
            Some(("delta", "a number from 0 on, or inf"))
        } else if !finite(&self.eye) {
            Some(("eye", "three finite numbers"))
        } else if !(finite(&self.forward) && (forward.length() - 1.0).abs() < 1e-9) {
            Some(("forward", "a direction of length 1"))
        } else if !(finite(&self.right) && across(right)) {
            Some(("right", "a step at right angles to forward"))
        } else if !(finite(&self.above) && across(above) && above.normalize().dot(right.normalize()).abs() < 1e-9) {
            Some(("above", "a step at right angles to forward and right"))
        } else if !finite(&self.shift) {
            Some(("shift", "two finite numbers"))
        } else if !(self.cone >= 0.0 && self.cone.is_finite()) {
            Some(("cone", "a finite number from 0 on"))
        } else {
            None
        }
    }

    /// The fields in which the other differs, each with what it has there, the one that is easiest to understand first.
    pub fn differences(&self, other: &Self) -> Vec<(&'static str, String)> {
        let fields = |v: &Self| {
            [
                ("delta", v.delta.clone()),
                ("size", format!("{}x{}", v.size[0], v.size[1])),
                ("eye", format!("{:?}", v.eye)),
                ("forward", format!("{:?}", v.forward)),
                ("cone", v.cone.to_string()),
                ("right", format!("{:?}", v.right)),
                ("above", format!("{:?}", v.above)),
                ("shift", format!("{:?}", v.shift)),
            ]
        };
        let differ = fields(self).into_iter().zip(fields(other)).filter(|(own, other)| own.1 != other.1);
        differ.map(|(_, other)| other).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_field_counts() {
        let view = JobView {
            size: [4, 3],
            delta: "1".into(),
            eye: [0.1, 0.2, 0.3],
            forward: [0.0, 0.0, -1.0],
            right: [0.01, 0.0, 0.0],
            above: [0.0, 0.01, 0.0],
            shift: [0.0; 2],
            cone: 0.005,
        };
        let text = serde_json::to_value(&view).unwrap();
        assert_eq!(serde_json::from_value::<JobView>(text.clone()).unwrap(), view);
        for (field, value) in text.as_object().unwrap() {
            let mut other = text.clone();
            other[field] = match value {
                serde_json::Value::Array(_) => [&[serde_json::json!(9)][..], &value.as_array().unwrap()[1..]].concat().into(),
                serde_json::Value::String(_) => "inf".into(),
                _ => serde_json::json!(9.0),
            };
            let other: JobView = serde_json::from_value(other).unwrap();
            assert!(other != view);
            let named: Vec<_> = view.differences(&other).into_iter().map(|(name, _)| name).collect();
            assert_eq!(named, [field]);
        }
        assert_eq!((view.quality(), JobView { delta: "inf".into(), ..view }.quality()), (Some(1.0), Some(f64::INFINITY)));
    }
}
