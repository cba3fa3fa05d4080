//! Rays from where rays hit, on models: what a traverser, a unit and its timing are given, and what must come of it.

use crate::models::{Rng, any_cone};
use crate::plain::plain;
use lodray::golden::{Exact, Leg};
use lodray::hardware::Hardware;
use lodray::hardware::ports::{Corners, HitOut, SecondaryIn};
use lodray::mesh::Hierarchy;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, Departure};
use lodray::num::{Direction, Point, Ray, RayT, U};
use lodray::rays::ModelRay;
use lodray::step::{Batch, NoSteps, Recorder, StepSink};

/// A ray of a path, or one that is to be stopped by anything within a range.
pub struct Bounce {
    pub ray: Ray,
    pub from: Option<Departure>,
    /// The rays before it, as the golden traverser has them.
    pub before: Vec<Leg>,
    pub range: [RayT; 2],
    pub any: bool,
}

const LENGTH: f64 = ((1 << 30) - 1) as f64;

/// A direction as long as directions are.
pub fn scaled(v: [f64; 3]) -> [i64; 3] {
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| (c / length * LENGTH).round() as i64)
}

/// A direction from a triangle: anywhere, along its plane or nearly, along an axis, or at another point.
pub fn leaving(rng: &mut Rng, corners: &[Point; 3], from: Point, at: [i64; 3]) -> Direction {
    let [a, b, c] = corners.map(|p| p.get().map(|v| v as f64));
    let e: [f64; 3] = std::array::from_fn(|k| (b[k] - a[k]) * rng.signed() + (c[k] - a[k]) * rng.signed());
    let mut d = match rng.below(6) {
        0 if e.iter().any(|&c| c != 0.0) => {
            let mut d = scaled(e);
            d[rng.below(3) as usize] += rng.below(5) as i64 - 2;
            d
        }
        1 => {
            let mut d = [0; 3];
            d[rng.below(3) as usize] = if rng.below(2) == 0 { 1 << 29 } else { -(1 << 29) };
            d
        }
        2 | 3 => {
            let x = from.get();
            let d: [f64; 3] = std::array::from_fn(|k| (at[k] - x[k]) as f64);
            if d == [0.0; 3] { [1 << 29, 0, 0] } else { scaled(d) }
        }
        _ => scaled([rng.signed(), rng.signed(), rng.signed() + 1e-9]),
    };
    d = d.map(|c| c.clamp(-((1 << 30) - 1), (1 << 30) - 1));
    if d.iter().map(|c| c * c).sum::<i64>() > 1 << 60 {
        d = d.map(|c| c / 2);
    }
    Direction::new(d[0], d[1], d[2])
}

impl Bounce {
    /// A primary ray.
    pub fn primary(ray: Ray) -> Self {
        Self { ray, from: None, before: Vec::new(), range: [RayT::ZERO, RayT::MAX], any: false }
    }

    /// As a unit takes it.
    pub fn secondary(&self) -> SecondaryIn {
        SecondaryIn::of(self.from.as_ref(), self.range, self.any)
    }

    /// What it meets by the blocks.
    pub fn trace(&self, traverser: &mut LodTraverser<'_>, steps: &mut impl StepSink) -> ClosestHit {
        let ray = ModelRay { ray: self.ray, start: 0.0, step: 1.0, range: self.range };
        let mut closest = ClosestHit::of(traverser.levels(), &ray, self.any);
        match &self.from {
            Some(from) => traverser.trace_from(&self.ray, from, steps, &mut closest),
            None => traverser.trace(&self.ray, steps, &mut closest),
        }
        closest
    }

    /// A unit's hit is that of the blocks and, as far as all t or the nearer ones count, the golden traverser's.
    pub fn check(&self, traverser: &mut LodTraverser<'_>, golden: &Exact<'_>, out: &HitOut, corners: &Corners, what: &str) {
        let closest = self.trace(traverser, &mut NoSteps);
        let hit = out.found.then_some(out.hit);
        let of_hit = out.found.then_some([corners.p0, corners.p1, corners.p2]);
        assert_eq!((out.error(), hit, of_hit), (None, closest.record(), closest.corners()), "{what}: {:?} {:?}", self.ray, self.from);
        let wanted = golden.trace_after(&self.before, &self.ray);
        let [t_min, t_max] = self.range.map(U::get);
        match wanted {
            Some(wanted) if wanted.t >= t_min && wanted.t <= t_max => {
                assert!(out.found, "{what}: {:?}", self.ray);
                assert!(self.any || plain(&out.hit) == wanted, "{what}: {:?}", self.ray);
            }
            Some(wanted) if wanted.t < t_min => (),
            _ => assert!(!out.found, "{what}: {:?}", self.ray),
        }
    }
}

/// The steps of rays in `image`.
pub fn steps_of_bounces(image: LodImage<'_>, bounces: &[Bounce]) -> Batch {
    let mut recorder = Recorder::default();
    let mut traverser = LodTraverser::new(image);
    bounces.iter().for_each(|bounce| {
        bounce.trace(&mut traverser, &mut recorder);
    });
    recorder.batch()
}

/// What follows on these rays in `h`, for such hardware: from each hit of a path one ray that goes on, and one for which only some hits count. Paths at whose start three rays would have to decide end.
pub fn next(hardware: &Hardware, h: &Hierarchy, traverser: &mut LodTraverser<'_>, bounces: &[Bounce], rng: &mut Rng) -> Vec<Bounce> {
    let golden = &Exact::new(h);
    let mut all = Vec::new();
    for bounce in bounces.iter().filter(|bounce| bounce.range == [RayT::ZERO, RayT::MAX] && !bounce.any) {
        let closest = bounce.trace(traverser, &mut NoSteps);
        let Some((hit, corners)) = closest.record().zip(closest.corners()) else { continue };
        let from = traverser.departure(&bounce.ray, bounce.from.as_ref(), &hit, &corners);
        let leg = golden.leg(&bounce.before, &bounce.ray, &plain(&hit));
        assert_eq!(leg.start(), from.start, "{:?}", bounce.ray);
        if from.crowded {
            continue;
        }
        let before: Vec<Leg> = bounce.before.iter().cloned().chain([leg]).collect();
        for number in 0..2 {
            let at = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
            let direction = leaving(rng, &corners, from.start.point, at);
            // Where no ray decides for another, all of a path are of one detail.
            let cone = if hardware.chooses_levels() { any_cone(rng) } else { bounce.ray.cone };
            let mut ray = Ray { origin: from.start.point, direction, cone };
            if !hardware.start_radius {
                ray.cone.offset = U::ZERO;
            }
            let mut next = Bounce { from: Some(from), before: before.clone(), ..Bounce::primary(ray) };
            if number == 1 {
                // At the first hit, a step before or behind it, or anywhere.
                let t = golden.trace_after(&before, &ray).map_or(rng.below(1 << 33), |hit| hit.t);
                let near = RayT::saturating((t + rng.below(3)).saturating_sub(1));
                next.range = match rng.below(4) {
                    0 => [near, RayT::MAX],
                    1 => [RayT::ZERO, near],
                    2 => [RayT::saturating(rng.below(t + 1)), RayT::saturating(t + rng.below(1 << 30))],
                    _ => [RayT::ZERO, RayT::MAX],
                };
                next.any = rng.below(2) == 0 || next.range == [RayT::ZERO, RayT::MAX];
            }
            all.push(next);
        }
    }
    all
}
