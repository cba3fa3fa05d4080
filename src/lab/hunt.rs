//! The hunt: rays and models that climb towards ties and rounding borders, each step judged by balance and by the golden traverser.
//!
//! A climb starts from a ray of some family at a small model and takes single moves: a unit or a power of two of them in a component of origin or
//! direction, or in the cone; now and then a vertex moves by a step of its grid. A move that does not lead away from its goal is kept. Climbs
//! are independent of each other: the same seed hunts the same on any number of threads.

use super::cases::hunting_case;
use super::found::Found;
use super::goal::{GOALS, Goal};
use super::judge::{Judge, Tally};
use super::model::Model;
use super::rays::{Aim, Shot, shot};
use super::stiff::adversary;
use crate::format::SceneError;
use crate::golden::Exact;
use crate::mesh::{Hierarchy, lattice};
use crate::num::{COORD_LIMIT, Cone, DIRECTION_SCALE, Point, Random, Ray, U, Vec3};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Steps of a climb, and of these with one model.
const CLIMB: u64 = 1024;
const SAME_MODEL: u64 = 256;

/// What a hunt came to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hunt {
    /// Climbs begun.
    pub climbs: u64,
    /// What their rays have shown, each compared with the golden traverser.
    #[serde(flatten)]
    pub tally: Tally,
    /// The nearest that each goal was approached; the rays of breaches before them.
    pub found: Vec<Found>,
}

impl Hunt {
    /// Misses, double hits, differences and overflows.
    pub fn breaches(&self) -> u64 {
        self.tally.breaches()
    }

    /// Two parts of a hunt together, in either order.
    pub fn with(self, b: Self) -> Self {
        Self { climbs: self.climbs + b.climbs, tally: self.tally.with(&b.tally), found: keep(self.found.into_iter().chain(b.found)) }
    }
}

/// Where a climb stands.
struct Climb {
    goal: Goal,
    random: Random,
    shot: Shot,
    distance: f64,
    tally: Tally,
    best: Option<Found>,
    breaches: Vec<Found>,
}

impl Climb {
    /// Climbs `steps` steps at one model.
    fn at(&mut self, model: &Model, steps: u64, number: u64) {
        let golden = Exact::new(&model.hierarchy);
        let mut judge = Judge::new(model, &golden, 1);
        let mut ties = golden.ties(&self.shot.ray);
        self.distance = self.goal.distance(&ties);
        for _ in 0..steps {
            // The border of an LOD decision can be stepped onto: the tolerance is linear in the cone's offset.
            let jump = (self.goal == Goal::Lod && self.random.below(8) == 0).then_some(ties.lod).flatten();
            let next = match jump {
                Some(by) => onto_border(&self.shot.ray, by, &mut self.random),
                None => moved(&self.shot.ray, &mut self.random),
            };
            let Some(ray) = next else {
                self.tally.rays += 1;
                continue;
            };
            let next = Shot { ray, view: None, ..self.shot };
            let shown = judge.shoot(number, &next);
            self.tally = self.tally.with(&shown);
            if shown.breaches() > 0 && self.breaches.len() < 4 {
                self.breaches.push(Found::new(None, 0.0, &model.hierarchy, &ray));
            }
            let found = golden.ties(&ray);
            let distance = self.goal.distance(&found);
            if distance <= self.distance {
                (self.shot, self.distance, ties) = (next, distance, found);
            }
        }
        if self.distance.is_finite() && self.best.as_ref().is_none_or(|best| self.distance < best.value) {
            self.best = Some(Found::new(Some(self.goal), self.distance, &model.hierarchy, &self.shot.ray));
        }
    }
}

/// Hunts for `steps` steps at small models of its own, or at `given`. `progress` is told of steps made since its last call, from any thread.
///
/// # Errors
/// A model cannot be built.
pub fn hunt(given: Option<&Model>, steps: u64, seed: u64, progress: &(dyn Fn(u64) + Sync)) -> Result<Hunt, SceneError> {
    hunt_climbs(given, steps, 0..climbs(steps), seed, progress)
}

/// How many climbs so many steps are.
pub fn climbs(steps: u64) -> u64 {
    steps.div_ceil(CLIMB)
}

/// The same of some climbs of these steps: parts, put together by [`Hunt::with`], are the whole.
///
/// # Errors
/// A model cannot be built.
pub fn hunt_climbs(
    given: Option<&Model>,
    steps: u64,
    climbs: Range<u64>,
    seed: u64,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Hunt, SceneError> {
    let climb = |number: u64| -> Result<Climb, SceneError> {
        let mut random = Random::of(seed ^ 0x4855_4e54, number); // a stream apart from the cases'
        let made = if given.is_none() { Some(adversary(&mut random)?) } else { None };
        let case = hunting_case();
        let goal = GOALS[(number % GOALS.len() as u64) as usize];
        let mut model = made;
        let start = given.or(model.as_ref());
        let mut first = None;
        for _ in 0..16 {
            let aim = case.aims[random.below(case.aims.len() as u64) as usize];
            let Some(start) = start else { break };
            first = shot(start, aim, case.cones, &case.views, &mut random);
            if first.is_some() && aim != Aim::View {
                break;
            }
        }
        if let Some(shot) = first.as_mut().filter(|_| matches!(goal, Goal::Edge | Goal::Zeros) && random.below(2) == 0) {
            // Full detail: then what the ray was aimed at lies on the surface exactly.
            shot.ray.cone = Cone::default();
        }
        let mut climb = Climb {
            goal,
            random,
            shot: first.unwrap_or(Shot { ray: Ray::default(), view: None, other: None }),
            distance: f64::INFINITY,
            tally: Tally::default(),
            best: None,
            breaches: Vec::new(),
        };
        let mut left = CLIMB.min(steps - number * CLIMB);
        while left > 0 && first.is_some() {
            let now = left.min(SAME_MODEL);
            match (given, &mut model) {
                (Some(given), _) => climb.at(given, now, number),
                (None, Some(own)) => {
                    climb.at(own, now, number);
                    *own = Model::of_hierarchy("moved", vertex_moved(&own.hierarchy, &mut climb.random))?;
                }
                (None, None) => {}
            }
            left -= now;
            progress(now);
        }
        Ok(climb)
    };
    // Folded in the order of climbs within each piece; what is kept does not depend on how they are cut.
    let add = |hunt: Hunt, climb: Climb| Hunt {
        climbs: hunt.climbs + 1,
        tally: hunt.tally.with(&climb.tally),
        found: keep(hunt.found.into_iter().chain(climb.breaches).chain(climb.best)),
    };
    climbs
        .into_par_iter()
        .map(climb)
        .try_fold(Hunt::default, |hunt, climb| Ok(add(hunt, climb?)))
        .try_reduce(Hunt::default, |a, b| Ok(a.with(b)))
}

/// Up to sixteen breaches, and the three nearest of each goal; ties go to the smaller record, so that the order of joining does not matter.
fn keep(found: impl Iterator<Item = Found>) -> Vec<Found> {
    let mut all: Vec<Found> = found.collect();
    all.sort_by(|a, b| {
        a.goal.map(|g| g as u32).cmp(&b.goal.map(|g| g as u32)).then(a.value.total_cmp(&b.value)).then_with(|| a.key().cmp(&b.key()))
    });
    all.dedup();
    let mut kept: Vec<Found> = Vec::new();
    for one in all {
        let most = if one.goal.is_some() { 3 } else { 16 };
        if kept.iter().filter(|k| k.goal == one.goal).count() < most {
            kept.push(one);
        }
    }
    kept
}

/// One move of a ray; `None` if it would leave what is legal.
fn moved(ray: &Ray, random: &mut Random) -> Option<Ray> {
    // Small moves more often than large ones.
    let bits = random.below(31).min(random.below(31)).min(random.below(31));
    let by = if random.below(2) == 0 { 1i64 << bits } else { -(1i64 << bits) };
    let k = random.below(3) as usize;
    let (mut origin, mut direction, mut cone) = (ray.origin.get(), ray.direction.get(), ray.cone);
    match random.below(8) {
        0..=2 => origin[k] += by,
        3..=5 => direction[k] += by,
        6 => {
            let offset = U::<53>::checked(cone.offset.get().checked_add_signed(by << random.below(20))?)?;
            cone = Cone { offset, ..cone };
        }
        _ => {
            let slope = U::<18>::checked(cone.slope.get().checked_add_signed(by)?)?;
            cone = Cone { slope, ..cone };
        }
    }
    let fits = |v: [i64; 3], most: i64| v.iter().all(|c| c.abs() <= most);
    let length = direction.iter().map(|&c| (c as f64).powi(2)).sum::<f64>().sqrt();
    let full = f64::from(DIRECTION_SCALE);
    let legal = fits(origin, i64::from(i32::MAX)) && fits(direction, i64::from(DIRECTION_SCALE)) && length <= full && length >= 0.99 * full;
    legal.then(|| Ray {
        origin: Point::new(origin[0], origin[1], origin[2]),
        direction: Vec3::new(direction[0], direction[1], direction[2]),
        cone,
    })
}

/// The ray with its tolerance changed by `by`, and perhaps by one less or more; `None` if the cone cannot hold that.
fn onto_border(ray: &Ray, by: u128, random: &mut Random) -> Option<Ray> {
    let by = i64::try_from(by).ok()? + random.within(1);
    let by = if random.below(2) == 0 { by } else { -by };
    let offset = U::<53>::checked(ray.cone.offset.get().checked_add_signed(by)?)?;
    Some(Ray { cone: Cone { offset, ..ray.cone }, ..*ray })
}

/// One vertex, wherever it is stored, moved by a step of its grid in one coordinate. (Where a compact one's displacement has longer steps, that moves it by one of
/// them or not at all.)
fn vertex_moved(h: &Hierarchy, random: &mut Random) -> Hierarchy {
    let mut h = h.clone();
    let per_tree = lattice::len(h.levels);
    let from = h.points[random.below(h.points.len() as u64) as usize];
    let m = 1u32 << h.levels;
    let levels: Vec<u32> = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j))).map(|p| lattice::level_of(h.levels, p)).collect();
    // All points in that place move, by the grid of the coarsest of them: then shared ones stay shared.
    let coarsest = h.points.iter().enumerate().filter(|(_, p)| **p == from).map(|(at, _)| levels[at % per_tree]).min().unwrap_or(0);
    let step = 1i32 << h.vertices.zero_bits(h.levels, coarsest, h.zeros);
    let k = random.below(3) as usize;
    let to = from[k] + if random.below(2) == 0 { step } else { -step };
    if to.abs() <= COORD_LIMIT {
        h.points.iter_mut().filter(|p| **p == from).for_each(|p| p[k] = to);
    }
    h
}
