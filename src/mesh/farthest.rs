//! The largest distance of one surface from another, over all its points.
//!
//! Triangles are cut into smaller and smaller parts. Of each a distance and a bound are known: distances change by no more than one moves, and
//! from a single triangle of the other surface, which is no closer than the whole of it, they are largest at a corner. Parts whose bound is
//! little above the largest distance found need not be cut further.

use super::distance::{Target, Vec3, closest_barycentrics};
use rayon::prelude::*;

/// The largest distance is narrowed down to this part of itself, ...
const TOLERANCE: f64 = 0.02;
/// ... or until this many closest points were looked for.
const MOST_PARTS: usize = 1 << 22;

/// The point of a surface that is furthest from another.
#[derive(Clone, Debug, Default)]
pub(super) struct Farthest {
    /// The largest distance found.
    pub found: f64,
    /// Where, and on which triangle.
    pub at: Vec3,
    pub triangle: u32,
    /// There is no larger one than this.
    pub bound: f64,
    /// Triangles, and points on them, that were found to be too far away.
    pub beyond: Vec<(u32, Vec3)>,
}

/// Vertices of a surface.
pub(super) struct Vertices<'a> {
    pub positions: &'a [Vec3],
    /// Those of each triangle, in the order of its corners.
    pub triangles: Vec<[u32; 3]>,
}

/// The largest distance of any point of `own` from `other`, narrowed down to a part of itself, but not further than to `least`.
///
/// It is not narrowed down any further once one above `most` is found, and `bound` then says nothing. `hints` has a triangle of `other` near each
/// of `own`, `u32::MAX` where none is known, or is empty. `vertices` are those of `own`: they are looked at whatever happens.
pub(super) fn farthest(own: &Target, other: &Target, hints: &[u32], vertices: Option<&Vertices>, [least, most]: [f64; 2]) -> Farthest {
    let mut far = Farthest::default();
    let mut known = Vec::new();
    if let Some(vertices) = vertices {
        let distances: Vec<f64> = vertices.positions.par_iter().map(|&p| other.distance(p, most)).collect();
        known = vertices.triangles.iter().map(|triangle| triangle.map(|v| distances[v as usize])).collect();
        for (t, (triangle, known)) in vertices.triangles.iter().zip(&known).enumerate() {
            for (&v, &found) in triangle.iter().zip(known) {
                if found > far.found {
                    far = Farthest { found, at: vertices.positions[v as usize], triangle: t as u32, ..far };
                }
            }
        }
    }
    let whole = |t: usize| {
        let hint = hints.get(t).copied().unwrap_or(u32::MAX);
        Part { triangle: t as u32, corners: own.corners[t], known: known.get(t).copied().unwrap_or([f64::INFINITY; 3]), hint }
    };
    let mut enough = ((1.0 + TOLERANCE) * far.found).max(least);
    let mut looked = 0;
    let mut seen =
        if far.found > most { (0.0, Vec::new()) } else { look((0..own.corners.len()).into_par_iter().map(whole), other, enough) };
    while far.found <= most {
        let (near, open) = &seen;
        looked += open.len();
        for (part, seen) in open {
            if seen.distance > far.found {
                far = Farthest { found: seen.distance, at: seen.at, triangle: part.triangle, ..far };
            }
            if seen.distance > most {
                far.beyond.push((part.triangle, seen.at));
            }
        }
        if far.found > most {
            return far;
        }
        enough = ((1.0 + TOLERANCE) * far.found).max(least);
        let done = |bound: f64| bound <= enough || looked >= MOST_PARTS;
        far.bound = open.iter().map(|(_, seen)| seen.bound).filter(|&b| done(b)).fold(far.bound.max(*near), f64::max);
        let parts: Vec<Part> = open.iter().filter(|(_, s)| !done(s.bound)).flat_map(|(part, seen)| part.cut(seen.hint)).collect();
        if parts.is_empty() {
            break;
        }
        seen = look(parts.into_par_iter(), other, enough);
    }
    far.bound = far.bound.max(far.found);
    far
}

/// The largest bound of the parts that are within `enough` for sure, and what was seen of the others, in order.
fn look(parts: impl ParallelIterator<Item = Part>, other: &Target, enough: f64) -> (f64, Vec<(Part, Seen)>) {
    let add = |(near, mut open): (f64, Vec<_>), part: Part| {
        let seen = part.look(other, enough);
        if !seen.asked {
            return (seen.bound.max(near), open);
        }
        open.push((part, seen));
        (near, open)
    };
    let join = |a: (f64, Vec<_>), mut b: (f64, Vec<_>)| {
        let mut open = a.1;
        open.append(&mut b.1);
        (a.0.max(b.0), open)
    };
    parts.fold(|| (0.0, Vec::new()), add).reduce(|| (0.0, Vec::new()), join)
}

/// A part of a triangle.
struct Part {
    triangle: u32,
    corners: [Vec3; 3],
    /// Distances at the corners, infinite where they are not known.
    known: [f64; 3],
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
        let [a, b, c] = self.corners;
        let [near_a, near_b, near_c] = self.known;
        let bound = self.reach(other, self.hint).min(near_a.max(near_b).max(near_c) + cover(a, b, c));
        if bound <= enough {
            return Seen { distance: 0.0, at, bound, hint: self.hint, asked: false };
        }
        // What is known already keeps the search short.
        let at_corners = self.corners.iter().zip(self.known).map(|(&p, near)| near + (p - at).length());
        let no_further = at_corners.fold(other.corners.get(self.hint as usize).map_or(f64::INFINITY, |&t| distance_from(at, t)), f64::min);
        let Some(hit) = other.near(at, no_further) else {
            return Seen { distance: 0.0, at, bound: f64::INFINITY, hint: self.hint, asked: true };
        };
        let distance = (hit.point - at).length();
        let radius = self.corners.iter().map(|&p| (p - at).length_squared()).fold(0.0, f64::max).sqrt();
        // Every point is near the middle or one of the corners.
        let thirds = [(b, c, near_b.max(near_c)), (c, a, near_c.max(near_a)), (a, b, near_a.max(near_b))];
        let covered = thirds.into_iter().map(|(p, q, near)| near.max(distance) + cover(at, p, q)).fold(0.0, f64::max);
        let bound = bound.min(self.reach(other, hit.triangle)).min(distance + radius).min(covered).max(distance);
        Seen { distance, at, bound, hint: hit.triangle, asked: true }
    }

    /// The largest distance of its corners from one triangle.
    fn reach(&self, other: &Target, triangle: u32) -> f64 {
        let Some(&of) = other.corners.get(triangle as usize) else { return f64::INFINITY };
        self.corners.iter().map(|&p| distance_from(p, of)).fold(0.0, f64::max)
    }

    fn cut(&self, hint: u32) -> [Part; 4] {
        let [a, b, c] = self.corners;
        let [p, q, r] = [(b + c) / 2.0, (c + a) / 2.0, (a + b) / 2.0];
        let near = |k: usize| std::array::from_fn(|i| if i == k { self.known[i] } else { f64::INFINITY });
        let part = |k, corners| Part { triangle: self.triangle, corners, known: near(k), hint };
        [part(0, [a, r, q]), part(1, [r, b, p]), part(2, [q, p, c]), part(3, [p, q, r])]
    }
}

fn distance_from(p: Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let w = closest_barycentrics(p, a, b, c);
    (a * w[0] + b * w[1] + c * w[2] - p).length()
}

/// The largest distance of any point of a triangle from the nearest of its corners.
fn cover(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    let mut sides = [(b - a).length_squared(), (c - b).length_squared(), (a - c).length_squared()];
    sides.sort_unstable_by(f64::total_cmp);
    let [x, y, z] = sides;
    if x + y > z {
        // Acute: the middle of the circle through the corners.
        let twice_area = (b - a).cross(c - a).length();
        return if twice_area > 0.0 { (x * y * z).sqrt() / (2.0 * twice_area) } else { z.sqrt() };
    }
    // Else where the longest side is as far from the corner opposite as from one of its own.
    let from = |own: f64, other: f64| own * z.sqrt() / (own + z - other);
    if x > 0.0 { from(x, y).max(from(y, x)) } else { z.sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_of_a_triangle_is_covered_and_one_only_just() {
        for k in 0..400u32 {
            let [a, b] = [Vec3::ZERO, Vec3::X];
            let c = Vec3::new(f64::from(k % 20) / 10.0 - 0.5, f64::from(k / 20) / 15.0 + 0.01, 0.3);
            let reach = cover(a, b, c);
            let mut most = 0.0f64;
            for (i, j) in (0..=100).flat_map(|i| (0..=100 - i).map(move |j| (i, j))) {
                let (v, w) = (f64::from(i) / 100.0, f64::from(j) / 100.0);
                let p = a * (1.0 - v - w) + b * v + c * w;
                most = most.max([a, b, c].iter().map(|&q| (q - p).length()).fold(f64::INFINITY, f64::min));
            }
            assert!(most <= reach * (1.0 + 1e-12) && reach - most < 0.02, "{c:?}: {most} {reach}");
        }
        assert_eq!(cover(Vec3::X, Vec3::X, Vec3::X), 0.0);
        assert!(cover(Vec3::ZERO, Vec3::ZERO, Vec3::X) >= 0.5);
        assert!(cover(Vec3::ZERO, Vec3::X, Vec3::X * 0.5) >= 0.25);
    }
}
