//! Closest points and line hits on a set of triangles, and from them the two-sided distance between two meshes.

use super::clean::is_degenerate;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The vector type of the geometry library, so that nothing has to be converted.
pub(super) type Vec3 = parry3d_f64::math::Vector;

/// Means are taken over at most this many samples of each kind (vertices, centroids, random points); more are thinned evenly.
const MAX_SAMPLES: usize = 30_000;

/// Mean and largest distance, in percent of the diagonal of the original's bounding box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Distance {
    /// Mean over samples.
    pub mean: f64,
    /// No point of the surface is further than this: a bound, narrowed down until it is little above what was found in either direction, but not
    /// below four tenths of the limit, or of the default limit if that is less.
    pub max: f64,
    /// The largest that was looked at, of the original all vertices included. What is within the bound for sure is not looked at.
    #[serde(default)]
    pub found: f64,
}

/// Distances between a remeshed surface and its original, both ways.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TwoSidedDistance {
    /// From the new surface to the original.
    pub to_original: Distance,
    /// From the original to the new surface.
    pub from_original: Distance,
}

/// A point found on a [`Target`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub triangle: u32,
    pub barycentrics: [f64; 3],
    pub point: Vec3,
}

/// Triangles to project on.
pub(super) struct Target {
    pub corners: Vec<[Vec3; 3]>,
    /// This many triangles in a row, which should lie together, make one leaf of the tree of boxes.
    group: usize,
    bvh: Bvh,
    /// Boxes of [`BLOCK`] triangles in a row, if leaves are larger than that.
    blocks: Vec<Aabb>,
}

/// Triangles of a leaf that are left out together if their box is too far away.
const BLOCK: usize = 4;

impl Target {
    pub fn new(corners: Vec<[Vec3; 3]>) -> Target {
        Target::grouped(corners, 1)
    }

    /// Leaves of `group` triangles: some, or a multiple of [`BLOCK`].
    pub fn grouped(corners: Vec<[Vec3; 3]>, group: usize) -> Target {
        let bounds = |c: &[[Vec3; 3]]| {
            let points = || c.iter().flatten().copied();
            Aabb::new(points().fold(Vec3::INFINITY, Vec3::min), points().fold(Vec3::NEG_INFINITY, Vec3::max))
        };
        debug_assert!(group <= BLOCK || group.is_multiple_of(BLOCK));
        let boxes: Vec<Aabb> = corners.par_chunks(group).map(bounds).collect();
        let blocks = if group > BLOCK { corners.par_chunks(BLOCK).map(bounds).collect() } else { Vec::new() };
        Target { bvh: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), corners, group, blocks }
    }

    /// What is best in a leaf by `one`, leaving out blocks that are `far` beyond that or `most`.
    fn best_of(
        &self,
        leaf: u32,
        most: f64,
        far: impl Fn(Vec3, Vec3) -> f64,
        one: impl Fn(u32) -> Option<(f64, Hit)>,
    ) -> Option<(f64, Hit)> {
        let first = leaf as usize * self.group;
        let end = (first + self.group).min(self.corners.len());
        let mut best: Option<(f64, Hit)> = None;
        for block in (first..end).step_by(BLOCK) {
            let most = best.as_ref().map_or(most, |b| b.0);
            if self.blocks.get(block / BLOCK).is_some_and(|b| far(b.mins, b.maxs) > most) {
                continue;
            }
            for found in (block..end.min(block + BLOCK)).filter_map(|t| one(t as u32)) {
                if best.as_ref().is_none_or(|b| found.0 < b.0) {
                    best = Some(found);
                }
            }
        }
        best
    }

    /// The closest point within `reach` on a triangle that `accept` takes.
    pub fn closest(&self, p: Vec3, reach: f64, accept: impl Fn(u32) -> bool) -> Option<Hit> {
        let far = |low: Vec3, high: Vec3| (low - p).max(p - high).max(Vec3::ZERO).length_squared();
        let one = |triangle: u32| {
            if !accept(triangle) {
                return None;
            }
            let [a, b, c] = self.corners[triangle as usize];
            let w = closest_barycentrics(p, a, b, c);
            let point = a * w[0] + b * w[1] + c * w[2];
            Some(((point - p).length_squared(), Hit { triangle, barycentrics: w, point }))
        };
        let node = |node: &BvhNode, _| far(node.mins(), node.maxs());
        // Squared, and a point exactly at the limit counts.
        let (_, (_, hit)) = self.bvh.find_best((reach * reach).next_up(), node, |leaf, most| self.best_of(leaf, most, far, one))?;
        Some(hit)
    }

    /// The nearest point, to either side, in which the line through `p` along the unit vector `direction` meets a triangle that `accept`
    /// takes, no further than `reach`.
    pub fn line(&self, p: Vec3, direction: Vec3, reach: f64, accept: impl Fn(u32) -> bool) -> Option<Hit> {
        let inverse = direction.recip();
        let far = |low: Vec3, high: Vec3| {
            let (low, high) = (low - p, high - p);
            let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
            for k in 0..3 {
                if direction[k].abs() > f64::MIN_POSITIVE.sqrt() {
                    let (a, b) = (low[k] * inverse[k], high[k] * inverse[k]);
                    enter = enter.max(a.min(b));
                    leave = leave.min(a.max(b));
                } else if low[k] > 0.0 || high[k] < 0.0 {
                    return f64::MAX;
                }
            }
            // A hair wider, for boxes of no thickness.
            let slack = 1e-12 * (1.0 + enter.abs().min(leave.abs()));
            if enter > leave + slack { f64::MAX } else { enter.max(-leave).max(0.0) }
        };
        let one = |triangle: u32| {
            let (t, w) = line_hit(p, direction, self.corners[triangle as usize])?;
            if !accept(triangle) {
                return None;
            }
            Some((t.abs(), Hit { triangle, barycentrics: w, point: p + direction * t }))
        };
        let node = |node: &BvhNode, _| far(node.mins(), node.maxs());
        let (_, (_, hit)) = self.bvh.find_best(reach, node, |leaf, most| self.best_of(leaf, most, far, one))?;
        Some(hit)
    }

    /// Where the closest point of one triangle is on it.
    pub fn closest_on(&self, triangle: u32, p: Vec3) -> Option<(u32, [f64; 3])> {
        let [a, b, c] = *self.corners.get(triangle as usize)?;
        Some((triangle, closest_barycentrics(p, a, b, c)))
    }

    /// How far one triangle is.
    pub fn distance_to(&self, triangle: u32, p: Vec3) -> Option<f64> {
        let (_, w) = self.closest_on(triangle, p)?;
        let corners = self.corners[triangle as usize];
        Some(((0..3).map(|k| corners[k] * w[k]).sum::<Vec3>() - p).length())
    }

    /// How many triangles have no area.
    pub fn degenerate(&self) -> u64 {
        self.corners.par_iter().filter(|c| is_degenerate(c.map(|p| p.to_array()))).count() as u64
    }

    /// The closest point, which is looked for within `guess` first: quicker if that is close.
    pub fn near(&self, p: Vec3, guess: f64) -> Option<Hit> {
        const ANYWHERE: f64 = 1e150;
        // A little further, as it comes rounded.
        let near = if guess < ANYWHERE { self.closest(p, guess * (1.0 + 1e-12), |_| true) } else { None };
        near.or_else(|| self.closest(p, ANYWHERE, |_| true))
    }

    /// How far the closest point is; looked for as in [`Self::near`].
    pub fn distance(&self, p: Vec3, guess: f64) -> f64 {
        self.near(p, guess).map_or(0.0, |hit| (hit.point - p).length())
    }
}

/// Signed distance along the line and barycentrics; hits on the very edge count.
fn line_hit(p: Vec3, direction: Vec3, [a, b, c]: [Vec3; 3]) -> Option<(f64, [f64; 3])> {
    const EDGE: f64 = -1e-9;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let cross = direction.cross(ac);
    let det = ab.dot(cross);
    if det == 0.0 {
        return None;
    }
    let v = ap.dot(cross) / det;
    let other = ap.cross(ab);
    let w = direction.dot(other) / det;
    let t = ac.dot(other) / det;
    (v >= EDGE && w >= EDGE && v + w <= 1.0 - EDGE && t.is_finite()).then_some((t, [1.0 - v - w, v, w]))
}

/// Barycentrics of the closest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
pub(super) fn closest_barycentrics(p: Vec3, a: Vec3, b: Vec3, c: Vec3) -> [f64; 3] {
    // 0 / 0 in a triangle without extent: any point of it will do.
    let ratio = |x: f64, y: f64| if y > 0.0 { x / (x + y) } else { 1.0 };
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = ratio(d1, -d3);
        return [1.0 - v, v, 0.0];
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = ratio(d2, -d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = ratio(d4 - d3, d5 - d6);
        return [0.0, 1.0 - w, w];
    }
    let scale = 1.0 / (va + vb + vc);
    let (v, w) = (vb * scale, vc * scale);
    [1.0 - v - w, v, w]
}

/// Mean distances of `new` from `original` and back, `diagonal` being 100 percent. The samples, and the order in which they are summed, do not
/// depend on the number of threads. `largest` is the largest distance of each, or a bound of it.
pub(super) fn mean_distances(original: &Target, new: &Target, diagonal: f64, largest: [f64; 2]) -> [f64; 2] {
    let mut to = corner_samples(&new.corners);
    to.extend(centroids(&new.corners));
    let mut from = corner_samples(&original.corners);
    from.extend(centroids(&original.corners));
    from.extend(area_samples(&original.corners, MAX_SAMPLES));
    let percent = percent(diagonal);
    [mean(&to, original, percent, largest[0]), mean(&from, new, percent, largest[1])]
}

/// Percent in a unit of length; nothing can be said of a mesh too small to have a diagonal.
pub(super) fn percent(diagonal: f64) -> f64 {
    Some(100.0 / diagonal).filter(|p| p.is_finite()).unwrap_or(0.0)
}

fn mean(samples: &[Vec3], target: &Target, percent: f64, largest: f64) -> f64 {
    let distances: Vec<f64> = samples.par_iter().map(|&p| percent * target.distance(p, largest)).collect();
    distances.iter().sum::<f64>() / distances.len().max(1) as f64
}

fn corner_samples(corners: &[[Vec3; 3]]) -> Vec<Vec3> {
    // A vertex has about six triangles: one corner of each is plenty, in turn.
    let step = corners.len().div_ceil(MAX_SAMPLES).max(1);
    corners.iter().enumerate().step_by(step).map(|(i, c)| c[(i / step) % 3]).collect()
}

fn centroids(corners: &[[Vec3; 3]]) -> impl Iterator<Item = Vec3> {
    corners.iter().step_by(corners.len().div_ceil(MAX_SAMPLES).max(1)).map(|&[a, b, c]| (a + b + c) / 3.0)
}

/// `count` points spread evenly over the area: a low-discrepancy sequence, so the same ones every time.
fn area_samples(corners: &[[Vec3; 3]], count: usize) -> Vec<Vec3> {
    // Powers of the reciprocal of the plastic number.
    const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let mut total = 0.0;
    let sums: Vec<f64> = corners
        .iter()
        .map(|&[a, b, c]| {
            total += (b - a).cross(c - a).length();
            total
        })
        .collect();
    let sample = |k: usize| {
        let place = (k as f64 + 0.5) / count as f64 * total;
        let [a, b, c] = corners[sums.partition_point(|&s| s < place).min(corners.len() - 1)];
        let [mut u, mut v] = STEPS.map(|s| (k as f64 * s).fract());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        a + (b - a) * u + (c - a) * v
    };
    (0..if corners.is_empty() { 0 } else { count }).map(sample).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Triangles of a bumpy sheet, four by four.
    fn sheet() -> Vec<[Vec3; 3]> {
        let at = |i: u32, j: u32| Vec3::new(i.into(), j.into(), f64::from((i * 7 + j * 5) % 4) * 0.3);
        (0..16).flat_map(|k| (0..16).map(move |j| (k, j))).map(|(i, j)| [at(i, j), at(i + 1, j), at(i, j + 1)]).collect()
    }

    #[test]
    fn the_closest_point_is_no_further_than_any_sample() {
        let target = Target::new(sheet());
        for (k, p) in area_samples(&sheet(), 50).into_iter().enumerate() {
            let p = p + Vec3::new(0.3, -0.4, (k % 7) as f64 - 3.0);
            let best = target.distance(p, f64::INFINITY);
            let sampled = area_samples(&sheet(), 5000).into_iter().map(|q| (q - p).length()).fold(f64::MAX, f64::min);
            assert!(best <= sampled && sampled - best < 0.2, "{best} {sampled}");
        }
    }

    #[test]
    fn groups_do_not_change_what_is_found() {
        let (one, many) = (Target::new(sheet()), Target::grouped(sheet(), 16));
        for k in 0..200 {
            let p = Vec3::new(f64::from(k % 19) * 0.9, f64::from(k % 17), f64::from(k % 5) - 2.0);
            assert_eq!(one.distance(p, f64::INFINITY), many.distance(p, 0.1 * f64::from(k % 50)));
            let direction = Vec3::new(0.1, f64::from(k % 3) * 0.2, 1.0).normalize();
            let line = |t: &Target| t.line(p, direction, 9.0, |_| true).map(|hit| (hit.point - p).length());
            assert_eq!(line(&one), line(&many));
        }
    }

    #[test]
    fn a_line_looks_both_ways_and_no_further_than_its_reach() {
        let target = Target::new(vec![[Vec3::ZERO, Vec3::X, Vec3::Y]]);
        for z in [-2.0, 2.0] {
            let p = Vec3::new(0.25, 0.25, z);
            let hit = target.line(p, Vec3::Z, 3.0, |_| true).unwrap();
            assert!((hit.point - Vec3::new(0.25, 0.25, 0.0)).length() < 1e-12);
            assert!(target.line(p, Vec3::Z, 1.9, |_| true).is_none());
            assert!(target.line(p, Vec3::Z, 3.0, |_| false).is_none());
            assert!(target.line(p, Vec3::X, 3.0, |_| true).is_none());
        }
    }
}
