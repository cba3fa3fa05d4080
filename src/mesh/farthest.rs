//! The largest distance of one surface from another, over all its points.
//!
//! Triangles are cut into smaller and smaller parts. Of each a distance and a bound are known: distances change by no more than one moves, and
//! from a single triangle of the other surface, which is no closer than the whole of it, they are largest at a corner. Parts whose bound is
//! little above the largest distance found need not be cut further.

use super::distance::{Target, Vec3, closest_barycentrics};
use rayon::prelude::*;

/// The largest distance is narrowed down to this part of itself, ...
const TOLERANCE: f64 = 0.02;
/// ... or as far as this many closest points go.
const MOST_PARTS: usize = 1 << 22;

/// The point of a surface that is furthest from another.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Farthest {
    /// The largest distance found.
    pub found: f64,
    /// Where, and on which triangle.
    pub at: Vec3,
    pub triangle: u32,
    /// There is no larger one than this.
    pub bound: f64,
}

/// The largest distance of any point of `own` from `other`, narrowed down to a part of itself, but not further than to `least`.
///
/// `hints` has a triangle of `other` near each of `own`, `u32::MAX` where none is known, or is empty. `vertices` are points of `own` with
/// their triangles that are looked at whatever happens.
pub(super) fn farthest(own: &Target, other: &Target, hints: &[u32], vertices: &[(u32, Vec3)], least: f64) -> Farthest {
    let found: Vec<f64> = vertices.par_iter().map(|v| other.distance(v.1)).collect();
    let mut far = Farthest::default();
    for (&(triangle, at), found) in vertices.iter().zip(found) {
        if found > far.found {
            far = Farthest { found, at, triangle, ..far };
        }
    }
    let hint = |t: usize| hints.get(t).copied().unwrap_or(u32::MAX);
    let whole = |(t, &corners): (usize, &[Vec3; 3])| Part { triangle: t as u32, corners, hint: hint(t) };
    let mut parts: Vec<Part> = own.corners.iter().enumerate().map(whole).collect();
    let mut looked = 0;
    while !parts.is_empty() {
        let enough = ((1.0 + TOLERANCE) * far.found).max(least);
        let seen: Vec<Seen> = parts.par_iter().map(|part| part.look(other, enough)).collect();
        looked += seen.iter().filter(|s| s.asked).count();
        for (part, seen) in parts.iter().zip(&seen) {
            if seen.distance > far.found {
                far = Farthest { found: seen.distance, at: seen.at, triangle: part.triangle, ..far };
            }
        }
        let enough = ((1.0 + TOLERANCE) * far.found).max(least);
        let done = |bound: f64| bound <= enough || looked >= MOST_PARTS;
        far.bound = seen.iter().map(|s| s.bound).filter(|&b| done(b)).fold(far.bound, f64::max);
        parts = parts.iter().zip(&seen).filter(|(_, s)| !done(s.bound)).flat_map(|(part, seen)| part.cut(seen.hint)).collect();
    }
    far.bound = far.bound.max(far.found);
    far
}

/// A part of a triangle.
struct Part {
    triangle: u32,
    corners: [Vec3; 3],
    /// A triangle of the other surface that is near.
    hint: u32,
}

/// What looking at a part gives: a distance, where it is, and a bound of all of the part's.
struct Seen {
    distance: f64,
    at: Vec3,
    bound: f64,
    hint: u32,
    /// The closest point had to be looked for.
    asked: bool,
}

impl Part {
    /// No more than that all of it is within `enough`, if that is so.
    fn look(&self, other: &Target, enough: f64) -> Seen {
        let at = self.corners.iter().sum::<Vec3>() / 3.0;
        let bound = self.reach(other, self.hint);
        if bound <= enough {
            return Seen { distance: 0.0, at, bound, hint: self.hint, asked: false };
        }
        let Some(hit) = other.closest(at, f64::MAX.sqrt(), |_| true) else {
            return Seen { distance: 0.0, at, bound: 0.0, hint: self.hint, asked: true };
        };
        let distance = (hit.point - at).length();
        let radius = self.corners.iter().map(|&p| (p - at).length_squared()).fold(0.0, f64::max).sqrt();
        let bound = bound.min(self.reach(other, hit.triangle)).min(distance + radius).max(distance);
        Seen { distance, at, bound, hint: hit.triangle, asked: true }
    }

    /// The largest distance of its corners from one triangle.
    fn reach(&self, other: &Target, triangle: u32) -> f64 {
        let Some(&[a, b, c]) = other.corners.get(triangle as usize) else { return f64::INFINITY };
        let far = |&p: &Vec3| {
            let w = closest_barycentrics(p, a, b, c);
            (a * w[0] + b * w[1] + c * w[2] - p).length_squared()
        };
        self.corners.iter().map(far).fold(0.0, f64::max).sqrt()
    }

    fn cut(&self, hint: u32) -> [Part; 4] {
        let [a, b, c] = self.corners;
        let [p, q, r] = [(b + c) / 2.0, (c + a) / 2.0, (a + b) / 2.0];
        [[a, r, q], [r, b, p], [q, p, c], [p, q, r]].map(|corners| Part { triangle: self.triangle, corners, hint })
    }
}
