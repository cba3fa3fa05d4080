//! What may be chosen of methods, by name.

use std::collections::BTreeMap;
use thiserror::Error;

/// Something that may be chosen.
pub struct Knob {
    /// Its name: that of the option, without dashes.
    pub name: &'static str,
    /// What stands for its value in help.
    pub value_name: &'static str,
    /// One line about it.
    pub help: &'static str,
    /// Its value if nothing is chosen; none if the method then chooses.
    pub default: Option<&'static str>,
    /// Its values with a line about each, if they are words.
    pub words: &'static [(&'static str, &'static str)],
    /// It is asked for with the rays of a frame only: what is made for a scene does not depend on it.
    pub of_frame: bool,
    /// Refuses other values than its own, and says why.
    pub allows: fn(&str) -> Result<(), String>,
}

/// A value that is none of a knob's.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{name}: {why}")]
pub struct KnobError {
    /// The knob's name.
    pub name: &'static str,
    /// What is wrong.
    pub why: String,
}

impl Knob {
    /// Refuses a value that is none of its own.
    ///
    /// # Errors
    /// What its values are.
    pub fn check(&self, value: &str) -> Result<(), KnobError> {
        (self.allows)(value).map_err(|why| KnobError { name: self.name, why })
    }
}

/// A knob by which a method trades error for cost.
#[derive(Clone, Copy)]
pub struct ErrorKnob {
    /// The knob.
    pub knob: &'static Knob,
    /// Values that show the whole of it, from coarse to fine.
    pub values: fn() -> Vec<f64>,
    /// There is nothing between these values.
    pub in_steps: bool,
}

/// The sweep of a quality that a method follows gradually: octaves from 1/16 to 64.
pub fn octaves() -> Vec<f64> {
    (-4..=6).map(f64::from).map(f64::exp2).collect()
}

/// Chosen values, by name; knobs that are not among them have their defaults.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Knobs(BTreeMap<&'static str, String>);

impl Knobs {
    /// Chooses a value.
    ///
    /// # Errors
    /// It is none of the knob's.
    pub fn set(&mut self, knob: &'static Knob, value: &str) -> Result<(), KnobError> {
        knob.check(value)?;
        self.0.insert(knob.name, value.to_owned());
        Ok(())
    }

    /// The same in one go.
    ///
    /// # Errors
    /// As [`Self::set`].
    pub fn with(mut self, knob: &'static Knob, value: &str) -> Result<Self, KnobError> {
        self.set(knob, value)?;
        Ok(self)
    }

    /// All but this knob's.
    #[must_use]
    pub fn without(mut self, knob: &Knob) -> Self {
        self.0.remove(knob.name);
        self
    }

    /// Those that what is made for a scene depends on, of a method's.
    #[must_use]
    pub fn of_scene(mut self, of: &[&Knob]) -> Self {
        let of_frame = |name: &str| of.iter().any(|knob| knob.name == name && knob.of_frame);
        self.0.retain(|name, _| !of_frame(name));
        self
    }

    /// The value of a knob: the chosen one, or its default.
    pub fn get(&self, knob: &Knob) -> Option<&str> {
        self.0.get(knob.name).map(String::as_str).or(knob.default)
    }
}

/// Quality of the level of detail.
pub static DELTA: Knob = Knob {
    name: "delta",
    value_name: "DELTA",
    help: "Quality of methods with level of detail: 1 tolerates a pixel (docs/error-bound.md: what is seen is off by about 1.5 at most), 0 is the base mesh, inf full detail",
    default: Some("1"),
    words: &[],
    of_frame: true,
    allows: |value| quality(value).map(drop),
};

/// How large something may be on screen where a coarser one stands for it.
pub static PIXELS: Knob = Knob {
    name: "pixels",
    value_name: "PIXELS",
    help: "Clusters: a group is replaced if the diagonal of its box is at most so many pixels (default 24 of cluster-paper, unless --error is given); R-LODs: a plane serves if its error is below that of so many pixels (default 4 of rlod)",
    default: None,
    words: &[],
    of_frame: false,
    allows: allows_pixels,
};

/// A number of pixels that was chosen.
pub(super) fn pixels(value: &str) -> Option<f64> {
    value.parse().ok().filter(|pixels: &f64| *pixels >= 0.0)
}

pub(super) fn allows_pixels(value: &str) -> Result<(), String> {
    pixels(value).map(drop).ok_or_else(|| format!("'{value}' is not a number of pixels: 0 (full detail) to inf (the coarsest)"))
}

/// A quality: a number that is not negative, or `inf`.
///
/// # Errors
/// What a quality is.
pub fn quality(value: &str) -> Result<f64, String> {
    match value.parse::<f64>() {
        Ok(v) if v >= 0.0 => Ok(v),
        _ => Err(format!("'{value}' is not a quality: 0 (base mesh) to inf (full detail), 1 the usual")),
    }
}

impl Knobs {
    /// The chosen quality.
    pub fn delta(&self) -> f64 {
        // Checked when it was chosen.
        self.get(&DELTA).and_then(|value| quality(value).ok()).unwrap_or(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_checked_when_chosen() {
        let knobs = Knobs::default();
        assert_eq!((knobs.get(&DELTA), knobs.delta()), (Some("1"), 1.0));
        assert_eq!(knobs.clone().with(&DELTA, "inf").unwrap().delta(), f64::INFINITY);
        let refused = knobs.with(&DELTA, "-1").unwrap_err().to_string();
        assert!(refused.starts_with("delta: '-1' is not a quality"), "{refused}");
        assert!(quality("inf").is_ok() && quality("-1").is_err() && quality("nan").is_err());
    }
}
