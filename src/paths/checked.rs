//! Values of descriptions under their keys, and the rules that they follow.

/// What a number must be.
pub(super) type Rule = (&'static str, fn(f64) -> bool);

pub(super) const FINITE: Rule = ("must be a finite number", f64::is_finite);
/// Far beyond any scene, and so near that squares, and squares of squares, of distances stay numbers.
pub(super) const PLACE: Rule = ("must be from -1e12 to 1e12", |v| v.abs() <= 1e12);
pub(super) const SCALE: Rule = ("must be from 1e-12 to 1e12", |v| (1e-12..=1e12).contains(&v));
/// Light that goes through 64 bounces and into 32-bit floats, and comes from a point as near as a millionth, stays a number.
pub(super) const LIGHT: Rule = ("must be from 0 to 1e15", |v| (0.0..=1e15).contains(&v));
pub(super) const EXPOSURE: Rule = ("must be from -100 to 100", |v| v.abs() <= 100.0);
pub(super) const NOT_NEGATIVE: Rule = ("must be at least 0 and finite", |v| v >= 0.0 && v.is_finite());
pub(super) const SHARE: Rule = ("must be from 0 to 1", |v| (0.0..=1.0).contains(&v));
pub(super) const ROUGHNESS: Rule = ("must be above 0 and at most 1", |v| v > 0.0 && v <= 1.0);
pub(super) const INDEX: Rule = ("must be from 1.05 to 4", |v| (1.05..=4.0).contains(&v));
pub(super) const VIEW: Rule = ("must be above 0 and below 180 degrees", |v| v > 0.0 && v < 180.0);
pub(super) const HALF_ANGLE: Rule = ("must be above 0 and below 90 degrees", |v| v > 0.0 && v < 90.0);

/// What is not scaled.
pub(super) fn one() -> f64 {
    1.0
}

/// Looks at values under their keys, and keeps the first that breaks its rule.
#[derive(Default)]
pub(super) struct Checked(pub(super) Option<(String, String)>);

impl Checked {
    pub(super) fn fail(&mut self, key: impl Into<String>, rule: impl Into<String>) {
        self.0.get_or_insert((key.into(), rule.into()));
    }

    pub(super) fn number(&mut self, key: &str, value: f64, (rule, holds): Rule) {
        if !holds(value) {
            self.fail(key, format!("{rule}, but is {value}"));
        }
    }

    pub(super) fn triple(&mut self, key: &str, values: [f64; 3], rule: Rule) {
        for (k, value) in values.into_iter().enumerate() {
            self.number(&format!("{key}[{k}]"), value, rule);
        }
    }

    /// A direction of any length.
    pub(super) fn direction(&mut self, key: &str, v: [f64; 3]) {
        self.triple(key, v, FINITE);
        if v == [0.0; 3] {
            self.fail(key, "must not be zero");
        }
    }

    pub(super) fn whole(&mut self, key: &str, value: u32, least: u32, most: u32) {
        if !(least..=most).contains(&value) {
            self.fail(key, format!("must be from {least} to {most}, but is {value}"));
        }
    }
}
