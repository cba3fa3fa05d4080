//! Which removals are legal: connections, feature lines and shapes stay, and what lies over the triangles changed lies over the new ones like a
//! field of heights.

use super::super::super::distance::{Vec3, closest_barycentrics};
use super::state::{Goal, Mesh, other};

/// Least quality of a new triangle (1 is equilateral, 0 has no area), unless one is no better now.
const LEAST_QUALITY: f64 = 0.3;

/// Cosine of the largest angle between a triangle and the original's normals at its corners, in sum.
const CORNERS: f64 = 0.2;

/// Cosine of the largest bend of a feature line at a removed vertex, between its neighbours on the line.
const LINE_BEND: f64 = 0.3;

/// A triangle over which fewer middles lie is looked at from its own.
const FEW: usize = 4;

/// A triangle that a removal would change, with its new corners.
pub(super) struct Changed {
    pub triangle: u32,
    pub corners: [Vec3; 3],
    pub normal: Vec3,
    /// Square of the largest distance of what lies over it.
    pub reach: f64,
}

impl Mesh<'_> {
    /// What pulling `u` into `v` changes, and what of the original then lies over each triangle changed; none if it is not legal.
    pub fn check(&self, u: u32, v: u32, goal: &Goal) -> Option<(Vec<Changed>, Vec<Vec<u32>>)> {
        self.check_line(u, v)?;
        self.check_connections(u, v)?;
        let changed = self.check_shapes(u, v, goal)?;
        let shares = self.check_over(u, &changed, goal)?;
        Some((changed, shares))
    }

    fn check_line(&self, u: u32, v: u32) -> Option<()> {
        let [a, b] = self.lines[u as usize][..] else { return Some(()) };
        let other = if a == v { b } else { a };
        // Two vertices have but one line between them.
        let free = other != v && !self.lines[other as usize].contains(&v);
        let (before, after) = (self.at(u) - self.at(other), self.at(v) - self.at(u));
        (free && before.dot(after) >= LINE_BEND * before.length() * after.length()).then_some(())
    }

    /// The surface stays as it is connected: only the triangles at the edge go, no two become one, and every wedge finds its continuation.
    fn check_connections(&self, u: u32, v: u32) -> Option<()> {
        let (near, far) = (self.neighbours(u), self.neighbours(v));
        let common = near.iter().filter(|w| far.binary_search(w).is_ok()).count();
        let mut at_edge = 0;
        for &t in &self.around[u as usize] {
            let tri = self.triangles[t as usize];
            if tri.contains(&v) {
                at_edge += 1;
            } else if far.binary_search(&other(tri, u)[0]).is_ok() && far.binary_search(&other(tri, u)[1]).is_ok() {
                // The same three corners once more?
                let [a, b] = other(tri, u);
                let there = |&s: &u32| self.triangles[s as usize].contains(&a) && self.triangles[s as usize].contains(&b);
                if self.around[v as usize].iter().any(there) {
                    return None;
                }
            }
            self.continuation(t, u, v)?;
        }
        (at_edge > 0 && common == at_edge).then_some(())
    }

    /// The wedge of `v` that continues the wedge that triangle `t` has at `u`.
    pub fn continuation(&self, t: u32, u: u32, v: u32) -> Option<u32> {
        let wedge = |t: u32, v: u32| {
            let k = self.triangles[t as usize].iter().position(|&w| w == v)?;
            Some(self.wedges[t as usize][k])
        };
        let own = wedge(t, u)?;
        self.around[u as usize].iter().filter(|&&s| wedge(s, u) == Some(own)).find_map(|&s| wedge(s, v))
    }

    fn check_shapes(&self, u: u32, v: u32, goal: &Goal) -> Option<Vec<Changed>> {
        let mut changed = Vec::with_capacity(6);
        for &t in &self.around[u as usize] {
            let tri = self.triangles[t as usize];
            if tri.contains(&v) {
                continue;
            }
            let old = tri.map(|w| self.at(w));
            let corners = tri.map(|w| self.at(if w == u { v } else { w }));
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let (quality, side) = quality(corners, normal.length());
            let before = (old[1] - old[0]).cross(old[2] - old[0]).length();
            if quality < LEAST_QUALITY && quality <= self::quality(old, before).0 || normal == Vec3::ZERO {
                return None;
            }
            let (reach, normal) = (goal.distance * goal.distance * side, normal.normalize_or_zero());
            if self.faces_corners(t, u, v, normal) < goal.facing.min(CORNERS) {
                return None;
            }
            changed.push(Changed { triangle: t, corners, normal, reach });
        }
        Some(changed)
    }

    /// Cosine between a normal and the sum of the original's normals at the corners of triangle `t`, once `u` is pulled into `v`.
    fn faces_corners(&self, t: u32, u: u32, v: u32, normal: Vec3) -> f64 {
        let wedge = |(w, wedge): (u32, u32)| if w == u { self.continuation(t, u, v).unwrap_or(wedge) } else { wedge };
        let corners = self.triangles[t as usize].into_iter().zip(self.wedges[t as usize]);
        let sum: Vec3 = corners.map(|c| self.source.wedge_normal[wedge(c) as usize]).sum();
        // Where they cancel out there is no saying.
        sum.try_normalize().map_or(1.0, |sum| sum.dot(normal))
    }

    /// Gives every triangle of the original over those around `u` to the closest of the new ones of its patch.
    fn check_over(&self, u: u32, changed: &[Changed], goal: &Goal) -> Option<Vec<Vec<u32>>> {
        let mut shares = vec![Vec::new(); changed.len()];
        for &t in &self.around[u as usize] {
            // Most stay where they are.
            let first = changed.iter().position(|c| c.triangle == t).unwrap_or(0);
            for &item in &self.over[t as usize] {
                let (middle, normal) = (self.middles[item as usize], self.source.face_normal[item as usize]);
                let fits = |c: &Changed, far: f64| far <= c.reach && (normal == Vec3::ZERO || normal.dot(c.normal) >= goal.facing);
                let mut best = (f64::INFINITY, usize::MAX);
                for k in (first..changed.len()).chain(0..first) {
                    let c = &changed[k];
                    if self.source.patch[c.triangle as usize] != self.source.patch[item as usize] {
                        continue;
                    }
                    let [p, q, r] = c.corners;
                    let w = closest_barycentrics(middle, p, q, r);
                    let far = (p * w[0] + q * w[1] + r * w[2] - middle).length_squared();
                    if far < best.0 {
                        best = (far, k);
                        // Right over this one: hardly over another, and that would not be closer but in a fold.
                        if w[0] > 0.0 && w[1] > 0.0 && w[2] > 0.0 && fits(c, far) {
                            break;
                        }
                    }
                }
                if !fits(changed.get(best.1)?, best.0) {
                    return None;
                }
                shares[best.1].push(item);
            }
        }
        let bare = changed.iter().zip(&shares).filter(|(_, share)| share.len() < FEW);
        bare.into_iter().all(|(c, _)| self.lies_under(u, c, goal)).then_some(shares)
    }

    /// A triangle over which no middle lies may still have some of the original over it, or be a fold.
    fn lies_under(&self, u: u32, c: &Changed, goal: &Goal) -> bool {
        let middle = c.corners.iter().sum::<Vec3>() / 3.0;
        let patch = self.source.patch[c.triangle as usize];
        let mut best = (f64::INFINITY, Vec3::ZERO);
        for &item in self.around[u as usize].iter().flat_map(|&t| &self.over[t as usize]) {
            if self.source.patch[item as usize] != patch {
                continue;
            }
            let [p, q, r] = self.source.wedges[item as usize].map(|w| self.at(self.source.wedge_vertex[w as usize]));
            let w = closest_barycentrics(middle, p, q, r);
            let far = (p * w[0] + q * w[1] + r * w[2] - middle).length_squared();
            if far < best.0 {
                best = (far, self.source.face_normal[item as usize]);
            }
        }
        best.0 <= c.reach && (best.1 == Vec3::ZERO || best.1.dot(c.normal) >= goal.facing)
    }
}

/// 1 for an equilateral triangle, 0 for one without area; and the square of the longest side.
fn quality([a, b, c]: [Vec3; 3], twice_area: f64) -> (f64, f64) {
    let sides = [(b - a).length_squared(), (c - b).length_squared(), (a - c).length_squared()];
    let sum: f64 = sides.iter().sum();
    let longest = sides.into_iter().fold(0.0, f64::max);
    (if sum > 0.0 { 2.0 * 3f64.sqrt() * twice_area / sum } else { 0.0 }, longest)
}
