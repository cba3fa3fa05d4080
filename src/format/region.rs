//! Rays that a scene was pruned for, by where they start.

use super::JobView;
use serde::{Deserialize, Serialize};

/// All rays that start in a box, whatever their directions, of these cones and qualities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JobRegion {
    /// The highest quality, in digits that give the `f64` back; `inf` is full detail.
    pub delta: String,
    /// Lower corner of the box, in the world.
    pub lo: [f64; 3],
    /// Upper corner.
    pub hi: [f64; 3],
    /// The least tangent of the half angle of a cone.
    pub cone: f64,
}

/// A ray that is none of a region's: in what it differs, and what it has there.
pub type Beyond = (&'static str, String);

impl JobRegion {
    /// The highest quality; none if the text is no number.
    pub fn quality(&self) -> Option<f64> {
        self.delta.parse().ok()
    }

    /// The field that makes a region of nothing, or of no number, and what it must be.
    pub fn wrong(&self) -> Option<(&'static str, &'static str)> {
        let corners = self.lo.iter().zip(self.hi);
        if self.quality().is_none_or(|delta| delta.is_nan() || delta < 0.0) {
            Some(("delta", "a number from 0 on, or inf"))
        } else if !corners.into_iter().all(|(lo, hi)| lo.is_finite() && hi.is_finite() && *lo <= hi) {
            Some(("lo and hi", "finite numbers, lo the lower ones"))
        } else if !(self.cone >= 0.0 && self.cone.is_finite()) {
            Some(("cone", "a finite number from 0 on"))
        } else {
            None
        }
    }

    /// What of a ray's quality, origin and cone (the tangent of its half angle) is not the region's, if anything is.
    pub fn beyond(&self, delta: f64, origin: [f64; 3], cone: f64) -> Option<Beyond> {
        let inside = (0..3).all(|k| origin[k] >= self.lo[k] && origin[k] <= self.hi[k]);
        if !self.quality().is_some_and(|most| delta <= most) {
            Some(("delta", delta.to_string()))
        } else if !inside {
            Some(("origin", format!("{origin:?}")))
        } else if cone >= self.cone {
            None
        } else {
            Some(("cone", cone.to_string()))
        }
    }
}

/// The rays that a scene was pruned for, or will be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Job {
    /// Those of cameras.
    pub views: Vec<JobView>,
    /// Those that start in boxes.
    pub regions: Vec<JobRegion>,
    /// Nothing of what is hit is shaded: no normals are needed.
    pub unshaded: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn region() -> JobRegion {
        JobRegion { delta: "2".into(), lo: [-1.0, 0.0, 0.0], hi: [1.0, 0.0, 5.0], cone: 0.25 }
    }

    #[test]
    fn each_field_counts() {
        let of = |delta, origin, cone| region().beyond(delta, origin, cone).map(|(field, _)| field);
        assert_eq!(of(2.0, [1.0, 0.0, 0.0], 0.25), None);
        assert_eq!(of(0.0, [0.0, 0.0, 4.0], 9.0), None);
        assert_eq!(of(2.1, [0.0; 3], 0.25), Some("delta"));
        assert_eq!(of(f64::NAN, [0.0; 3], 0.25), Some("delta"));
        assert_eq!(of(2.0, [0.0, 1e-9, 0.0], 0.25), Some("origin"));
        assert_eq!(of(2.0, [f64::NAN, 0.0, 0.0], 0.25), Some("origin"));
        assert_eq!(of(2.0, [0.0; 3], 0.24), Some("cone"));
        assert_eq!(of(2.0, [0.0; 3], f64::NAN), Some("cone"));
        let any = JobRegion { delta: "inf".into(), ..region() };
        assert_eq!(any.beyond(f64::INFINITY, [0.0; 3], 1.0), None);
    }

    #[test]
    fn regions_that_cannot_be() {
        let wrong = |region: JobRegion| region.wrong().map(|(field, _)| field);
        assert_eq!((wrong(region()), wrong(JobRegion { delta: "inf".into(), cone: 0.0, ..region() })), (None, None));
        for delta in ["one", "-1", "NaN"] {
            assert_eq!(wrong(JobRegion { delta: delta.into(), ..region() }), Some("delta"));
        }
        assert_eq!(wrong(JobRegion { lo: [1.1, 0.0, 0.0], ..region() }), Some("lo and hi"));
        assert_eq!(wrong(JobRegion { hi: [f64::INFINITY; 3], ..region() }), Some("lo and hi"));
        assert_eq!(wrong(JobRegion { cone: -0.1, ..region() }), Some("cone"));
    }
}
