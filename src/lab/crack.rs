//! Watertightness, measured: rays aimed exactly at, and within one unit of, the vertices and edges of a closed model, at every kind of cone, so
//! that neighbouring edges take unequal states. A ray that starts and ends outside crosses a closed oriented surface as often in as out; a
//! miss or a double hit breaks that balance.

use crate::mesh::{Hierarchy, lattice};
use crate::method::Crossings;
use crate::method::lod::{LodImage, LodTraverser};
use crate::num::{Cone, DIRECTION_SCALE, Point, Random, Ray, Vec3};
use crate::rays::ModelSpace;
use crate::step::NoSteps;
use rayon::prelude::*;
use serde::Serialize;

/// Where rays are aimed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// Exactly through a vertex of some level.
    Vertex,
    /// Exactly through the midpoint of an edge of some level.
    Midpoint,
    /// Exactly through another point of an edge (a dyadic fraction).
    Edge,
    /// One unit beside a vertex in some coordinates.
    NearVertex,
    /// One unit beside an edge.
    NearEdge,
}

pub(crate) const TARGETS: [Target; 5] = [Target::Vertex, Target::Midpoint, Target::Edge, Target::NearVertex, Target::NearEdge];

/// Counts of one kind of target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Row {
    /// Where the rays were aimed.
    pub target: Target,
    /// Rays shot.
    pub rays: u64,
    /// Rays that crossed the surface at all.
    pub crossing: u64,
    /// Rays with an axis-parallel direction or in a coordinate plane.
    pub axis_parallel: u64,
    /// Rays that met triangles of two or more levels.
    pub mixed_levels: u64,
    /// Rays that crossed an odd number of faces: a miss or a double hit.
    pub odd: u64,
    /// Rays with an even number of crossings but not as many front as back faces.
    pub unbalanced: u64,
}

/// What was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrackReport {
    /// Orientation is consistent, so that front and back are compared too, not parity alone.
    pub oriented: bool,
    /// By target.
    pub rows: Vec<Row>,
    /// The first breach: seed of the ray within the run.
    pub first_breach: Option<u64>,
}

impl CrackReport {
    /// Rays shot.
    pub fn rays(&self) -> u64 {
        self.rows.iter().map(|r| r.rays).sum()
    }

    /// Misses and double hits.
    pub fn breaches(&self) -> u64 {
        self.rows.iter().map(|r| r.odd + r.unbalanced).sum()
    }
}

/// How base triangles meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Closedness {
    /// Each edge as often one way as the other.
    Oriented,
    /// Each edge an even number of times.
    Even,
    /// Some edge an odd number of times.
    Open,
}

/// How the base triangles of a hierarchy meet.
pub fn closedness(triangles: &[[u32; 3]]) -> Closedness {
    let mut edges: Vec<(u32, u32, i8)> = Vec::with_capacity(3 * triangles.len());
    for t in triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            edges.push((a.min(b), a.max(b), if a < b { 1 } else { -1 }));
        }
    }
    edges.sort_unstable();
    let (mut oriented, mut even) = (true, true);
    for group in edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        even &= group.len() % 2 == 0;
        oriented &= group.iter().map(|e| i64::from(e.2)).sum::<i64>() == 0;
    }
    match (even, oriented) {
        (true, true) => Closedness::Oriented,
        (true, false) => Closedness::Even,
        (false, _) => Closedness::Open,
    }
}

/// Shoots `rays` rays at a closed model; `oriented` says that its edges balance (see [`closedness`]).
///
/// `progress` is told how many rays were shot since its last call, from any thread.
pub fn measure(
    hierarchy: &Hierarchy,
    image: &LodImage<'_>,
    space: &ModelSpace,
    oriented: bool,
    rays: u64,
    seed: u64,
    progress: &(dyn Fn(u64) + Sync),
) -> CrackReport {
    const BATCH: u64 = 4096;
    let zero = || {
        (TARGETS.map(|target| Row { target, rays: 0, crossing: 0, axis_parallel: 0, mixed_levels: 0, odd: 0, unbalanced: 0 }), None::<u64>)
    };
    let (rows, first_breach) = (0..rays.div_ceil(BATCH))
        .into_par_iter()
        .map_init(
            || LodTraverser::new(*image),
            |traverser, batch| {
                let (mut rows, mut first) = zero();
                let end = rays.min((batch + 1) * BATCH);
                for number in batch * BATCH..end {
                    let mut random = Random::of(seed, number);
                    let target = random.below(TARGETS.len() as u64) as usize;
                    let ray = aim(hierarchy, space, TARGETS[target], &mut random);
                    let mut sink = LevelCrossings::default();
                    traverser.trace(&ray, &mut NoSteps, &mut sink);
                    let row = &mut rows[target];
                    let Crossings { front, back } = sink.crossings;
                    row.rays += 1;
                    row.crossing += u64::from(front + back > 0);
                    row.mixed_levels += u64::from(sink.levels.count_ones() > 1);
                    row.axis_parallel += u64::from(ray.direction.get().contains(&0));
                    let odd = (front + back) % 2 == 1;
                    let unbalanced = !odd && oriented && front != back;
                    row.odd += u64::from(odd);
                    row.unbalanced += u64::from(unbalanced);
                    if odd || unbalanced {
                        first.get_or_insert(number);
                    }
                }
                progress(end - batch * BATCH);
                (rows, first)
            },
        )
        .reduce(zero, |(mut a, first_a), (b, first_b)| {
            for (a, b) in a.iter_mut().zip(b) {
                a.rays += b.rays;
                a.crossing += b.crossing;
                a.axis_parallel += b.axis_parallel;
                a.mixed_levels += b.mixed_levels;
                a.odd += b.odd;
                a.unbalanced += b.unbalanced;
            }
            (a, first_a.into_iter().chain(first_b).min())
        });
    CrackReport { oriented, rows: rows.to_vec(), first_breach }
}

/// Crossings, and the set of levels they were on.
#[derive(Default)]
struct LevelCrossings {
    crossings: Crossings,
    levels: u32,
}

impl crate::method::HitSink for LevelCrossings {
    fn t_max(&self) -> crate::num::RayT {
        self.crossings.t_max()
    }
    fn offer(
        &mut self,
        id: crate::method::TriangleId,
        corners: &[Point; 3],
        test: &crate::block::tri_test::Out,
        below: &crate::block::start_test::Below,
    ) {
        self.crossings.offer(id, corners, test, below);
        self.levels |= 1 << id.level;
    }
    fn found(&self) -> bool {
        self.crossings.found()
    }
}

/// A ray from outside the model's box through a target.
pub(crate) fn aim(h: &Hierarchy, space: &ModelSpace, target: Target, random: &mut Random) -> Ray {
    let mut through = target_point(h, target, random);
    if matches!(target, Target::NearVertex | Target::NearEdge) {
        for c in &mut through {
            *c += random.within(1);
        }
    }
    let step = direction(random);
    let (origin, direction) = from_outside(space, through, step);
    let away = (0..3).map(|k| (through[k] - origin[k]).abs()).max().unwrap_or(0).cast_unsigned();
    Ray {
        origin: Point::new(origin[0], origin[1], origin[2]),
        direction: Vec3::new(direction[0], direction[1], direction[2]),
        cone: cone(h, away.max(1), random),
    }
}

/// Origin outside the model's box and direction of a ray along whole multiples of `step`, exactly through the point `through` of the box; `step` is
/// not 0 and its components are below 2^16, so that the origin stays within 32 bits.
pub(crate) fn from_outside(space: &ModelSpace, through: [i64; 3], step: [i64; 3]) -> ([i64; 3], [i64; 3]) {
    // Back along whole steps until outside the box: the ray passes through the point exactly.
    let margin = i64::from(crate::num::BOX_MARGIN) / 2;
    let steps = (0..3)
        .filter(|&k| step[k] != 0)
        .map(|k| {
            let wall = if step[k] > 0 { i64::from(space.lo[k]) - margin } else { i64::from(space.hi[k]) + margin };
            // ceil((through - wall) / step), both with the sign of step.
            let (gap, s) = ((through[k] - wall).abs(), step[k].abs());
            (gap + s - 1) / s
        })
        .min()
        .unwrap_or(0);
    let origin: [i64; 3] = std::array::from_fn(|k| through[k] - steps * step[k]);
    // The longest multiple within the direction's length: rounding would bend the ray off its target.
    let length = step.map(|s| (s * s) as f64).iter().sum::<f64>().sqrt();
    let multiple = (f64::from(DIRECTION_SCALE) / length).floor() as i64; // at most 2^30
    (origin, step.map(|s| s * multiple))
}

/// A primitive direction of components below 2^9, a quarter of them with zeros.
pub(crate) fn direction(random: &mut Random) -> [i64; 3] {
    loop {
        let mut d: [i64; 3] = std::array::from_fn(|_| random.within(500));
        if random.below(4) == 0 {
            d[random.below(3) as usize] = 0;
            if random.below(2) == 0 {
                d[random.below(3) as usize] = 0;
            }
        }
        if d != [0; 3] {
            return d;
        }
    }
}

/// A cone whose tolerance at the target is near the displacement bound of some level, so that edges around take different states.
pub(crate) fn cone(h: &Hierarchy, distance: u64, random: &mut Random) -> Cone {
    if h.bounds.codes.is_empty() || random.below(16) == 0 {
        return Cone::default();
    }
    let code = h.bounds.codes[random.below(h.bounds.codes.len() as u64) as usize];
    let bound = crate::num::bound_decode(h.bounds.scale, code).max(1) as f64;
    let wanted = bound * 2f64.powf(random.within(1 << 20) as f64 / f64::from(1 << 20));
    // Part of it at the origin, part from the slope.
    let part = random.below(1 << 20) as f64 / f64::from(1 << 20) * if random.below(2) == 0 { 0.0 } else { 1.0 };
    crate::rays::cone(2.0, wanted * part, wanted * (1.0 - part) / distance as f64)
}

fn target_point(h: &Hierarchy, target: Target, random: &mut Random) -> [i64; 3] {
    let tree = random.below(h.triangles.len() as u64) as usize;
    let points = h.tree(tree);
    let level = random.below(u64::from(h.levels) + 1) as u32;
    let node = random.below(1 << (2 * level)) as u32;
    let corners = lattice::node(h.levels, level, node);
    let at = |c| points[lattice::index(h.levels, c)].map(i64::from);
    let k = random.below(3) as usize;
    let (a, b) = (at(corners[k]), at(corners[(k + 1) % 3]));
    match target {
        Target::Vertex | Target::NearVertex => a,
        Target::Midpoint => std::array::from_fn(|k| (a[k] + b[k]) >> 1),
        Target::Edge | Target::NearEdge => {
            // Stored coordinates are multiples of 16: sixteenths of the edge are exact.
            let part = 1 + random.below(15).cast_signed();
            std::array::from_fn(|k| a[k] + ((b[k] - a[k]) >> 4) * part)
        }
    }
}
