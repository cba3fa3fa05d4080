//! Where a result turns away from the original, as somebody sees it who has both surfaces and nothing else.
//!
//! A triangle is **flipped** if what is nearest to its middle on the original faces the other way. An edge is **folded** if its two triangles
//! turn back by more than 150 degrees; it is a **new** fold if the
//! original does not face both ways there, within the largest error.

use super::super::distance::Vec3;
use super::super::lattice::{self, LatticePoint};
use super::project::Point;
use super::source::Source;
use super::split::{Forest, side_point};
use super::topology::Topology;

/// Cosine of the angle between the normals of two triangles from which their edge is folded: 150 degrees.
const FOLDED: f64 = -0.866_025_403_784_438_6;

/// A triangle lies on the original if some of that, no further than the largest error, turns from it by less than this cosine: 60 degrees.
const ALIKE: f64 = 0.5;

/// Triangles of the original are equally near if their distances differ by less than this part, or by this in units of the box.
const SAME: f64 = 1e-6;

/// Edges of the original that fold.
pub(super) fn folds_of(source: &Source) -> u64 {
    let mut uses = Vec::with_capacity(3 * source.wedges.len());
    for (t, [a, b, c]) in source.triangles().into_iter().enumerate() {
        uses.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), t, a < b)));
    }
    uses.sort_unstable();
    let folds = |run: &&[(u32, u32, usize, bool)]| match run {
        [s, t] => s.3 != t.3 && source.face_normal[s.2].dot(source.face_normal[t.2]) < FOLDED,
        _ => false,
    };
    uses.chunk_by(|s, t| (s.0, s.1) == (t.0, t.1)).filter(folds).count() as u64
}

/// A folded edge: its middle and half its length, and the unit normals of its two triangles.
pub(super) struct Fold {
    middle: Vec3,
    half: f64,
    normals: [Vec3; 2],
}

impl Fold {
    fn new([a, b]: [Vec3; 2], normals: [Vec3; 2]) -> Fold {
        Fold { middle: (a + b) / 2.0, half: (b - a).length() / 2.0, normals }
    }
}

/// A tree's folded edges; an edge between two trees counts for the first.
pub(super) fn folded(topology: &Topology, forest: &Forest, tree: usize) -> Vec<Fold> {
    let (levels, m) = (forest.levels, 1u32 << forest.levels);
    let at = |t: usize, p: LatticePoint| forest.positions[t * lattice::len(levels) + lattice::index(levels, p)];
    let normal = |t: usize, [a, b, c]: [LatticePoint; 3]| (at(t, b) - at(t, a)).cross(at(t, c) - at(t, a)).normalize_or_zero();
    let up = |i, j| [(i, j), (i + 1, j), (i, j + 1)];
    let mut found = Vec::new();
    if topology.own[tree].is_none() {
        // Each inner edge has a triangle that points down, between three that point up.
        for j in 0..m.saturating_sub(1) {
            for i in 0..m - 1 - j {
                let [a, b, c] = [(i, j + 1), (i + 1, j), (i + 1, j + 1)];
                let down = normal(tree, [a, b, c]);
                for (other, ends) in [(up(i, j), [a, b]), (up(i, j + 1), [a, c]), (up(i + 1, j), [b, c])] {
                    let normals = [down, normal(tree, other)];
                    if normals[0].dot(normals[1]) < FOLDED {
                        found.push(Fold::new(ends.map(|p| at(tree, p)), normals));
                    }
                }
            }
        }
    }
    for &(edge, _) in &topology.sides[tree] {
        let [one, other] = topology.edges[edge as usize].uses[..] else { continue };
        let forward = |(t, k): (u32, usize)| topology.sides[t as usize][k].1;
        // Two that are wound differently fold for no reason of ours.
        if one.0 as usize != tree || forward(one) == forward(other) {
            continue;
        }
        for s in 0..m {
            let ends = |(t, k)| [s, s + 1].map(|s| side_point(m, k, forward((t, k)), s));
            let beside = |(t, k): (u32, usize)| {
                let [p, q] = ends((t, k));
                normal(t as usize, up(p.0.min(q.0), p.1.min(q.1)))
            };
            let normals = [beside(one), beside(other)];
            if normals[0].dot(normals[1]) < FOLDED {
                found.push(Fold::new(ends(one).map(|p| at(tree, p)), normals));
            }
        }
    }
    found
}

/// Where folds are new, with a largest error of `near`.
pub(super) fn new_folds(source: &Source, folds: &[Fold], near: f64) -> Vec<Vec3> {
    let lies = |fold: &Fold, normal: Vec3| {
        let alike = |t: u32| source.face_normal[t as usize].dot(normal) > ALIKE;
        source.target.closest(fold.middle, near.max(fold.half), alike).is_some()
    };
    folds.iter().filter(|fold| !fold.normals.iter().all(|&normal| lies(fold, normal))).map(|fold| fold.middle).collect()
}

/// Cosine of the angle between a triangle and what is nearest to its middle on the original: below 0 it is flipped. 1 if it has no area.
pub(super) fn facing(source: &Source, corners: [Point; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| p.position);
    let Some(normal) = (b - a).cross(c - a).try_normalize() else { return 1.0 };
    let middle = (a + b + c) / 3.0;
    let guess = corners.into_iter().find_map(|p| source.target.distance_to(p.triangle?, middle));
    let Some(hit) = source.target.near(middle, guess.unwrap_or(f64::INFINITY)) else { return 1.0 };
    let cosine = |t: u32| source.face_normal[t as usize].dot(normal);
    let nearest = cosine(hit.triangle);
    if nearest >= 0.0 {
        return nearest;
    }
    // On an edge, or where two sheets lie on each other, more than one is nearest.
    let reach = (hit.point - middle).length() * (1.0 + SAME) + SAME * SAME;
    source.target.closest(middle, reach, |t| cosine(t) >= 0.0).map_or(nearest, |hit| cosine(hit.triangle))
}
