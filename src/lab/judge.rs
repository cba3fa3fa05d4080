//! What one ray shows: misses and double hits by balance, differences from the golden traverser, errors against exact arithmetic.
//!
//! **Balance** (closed models, every ray). Each crossing counts +1 inwards and -1 outwards (parity where triangles are not turned alike). A ray from outside the
//! model's box has sum 0. From inside, the sum is the origin's winding number, whatever the direction: two directions must agree, if
//! the tolerance does not depend on direction and the origin is not on the surface.
//! **Golden** (a sample, or all): the closest hit in every field and the number of crossings equal those of the exact traverser, which
//! shares no code with the blocks.

use super::error::{bary_error, pixels_off, t_error};
use super::model::Model;
use super::rays::Shot;
use crate::block::start_test::Below;
use crate::block::tri_test;
use crate::golden::{Crossings, Exact};
use crate::lab::crack::Closedness;
use crate::method::lod::{LodImage, LodTraverser};
use crate::method::{ClosestHit, Hit, HitSink, TriangleId};
use crate::num::{Direction, Point, Ray, RayT};
use crate::step::NoSteps;
use serde::{Deserialize, Serialize};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Stated widths and plain integers are checked at run time in this build, so that an overflow is seen where it happens.
pub const WIDTHS_CHECKED: bool = cfg!(debug_assertions);

/// Rays of a packet.
pub(super) const LANES: u64 = 32;

/// What rays have shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tally {
    /// Rays tried.
    pub rays: u64,
    /// Rays whose crossings were balanced.
    pub balanced: u64,
    /// Rays compared with the golden traverser.
    pub compared: u64,
    /// Rays that crossed the surface.
    pub crossing: u64,
    /// Rays that crossed it on two or more levels.
    pub mixed_levels: u64,
    /// Crossings that are missing.
    pub misses: u64,
    /// Crossings that are too many.
    pub doubles: u64,
    /// Hits that differ from the golden traverser's in any field.
    pub different: u64,
    /// Rays on which a value did not fit its stated width; counted where [`WIDTHS_CHECKED`].
    pub overflows: u64,
    /// Paths that ended where two prior rays are not enough: not a breach, and none on surfaces whose edges have at most two triangles.
    pub crowded: u64,
    /// Closest hits at the end of t's range.
    pub saturated: u64,
    /// Worst error of t, in steps of 2^-32.
    pub t_ulp: f64,
    /// Worst error of a barycentric, in steps of 2^-31.
    pub bary_ulp: f64,
    /// The same on the full-resolution triangle: each level between doubles it.
    pub full_bary_ulp: f64,
    /// Worst displacement of a camera's hit, in pixels.
    pub pixels: f64,
    /// The first ray with a breach: its number within the case.
    pub first_breach: Option<u64>,
}

impl Tally {
    /// Misses, double hits, differences and overflows.
    pub fn breaches(&self) -> u64 {
        self.misses + self.doubles + self.different + self.overflows
    }

    /// Both together, in either order.
    pub fn with(self, b: &Self) -> Self {
        Self {
            rays: self.rays + b.rays,
            balanced: self.balanced + b.balanced,
            compared: self.compared + b.compared,
            crossing: self.crossing + b.crossing,
            mixed_levels: self.mixed_levels + b.mixed_levels,
            misses: self.misses + b.misses,
            doubles: self.doubles + b.doubles,
            different: self.different + b.different,
            overflows: self.overflows + b.overflows,
            crowded: self.crowded + b.crowded,
            saturated: self.saturated + b.saturated,
            t_ulp: self.t_ulp.max(b.t_ulp),
            bary_ulp: self.bary_ulp.max(b.bary_ulp),
            full_bary_ulp: self.full_bary_ulp.max(b.full_bary_ulp),
            pixels: self.pixels.max(b.pixels),
            first_breach: self.first_breach.into_iter().chain(b.first_breach).min(),
        }
    }
}

impl Tally {
    /// Counts what is missing of the crossings that the golden traverser has, and what is too much.
    fn crossed(&mut self, seen: &Seen, wanted: Crossings) {
        for (found, wanted) in [(seen.front, wanted.front), (seen.back, wanted.back)] {
            self.misses += u64::from(wanted.saturating_sub(found));
            self.doubles += u64::from(found.saturating_sub(wanted));
        }
    }
}

/// All crossings of a ray.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    front: u32,
    back: u32,
    /// Set of the levels met.
    levels: u32,
}

impl Seen {
    fn winding(&self) -> i64 {
        i64::from(self.front) - i64::from(self.back)
    }
}

impl HitSink for Seen {
    #[inline(always)]
    fn t_max(&self) -> RayT {
        RayT::MAX
    }
    #[inline(always)]
    fn offer(&mut self, id: TriangleId, _: &[Point; 3], test: &tri_test::Out, _: &Below) {
        if test.front {
            self.front += 1;
        } else {
            self.back += 1;
        }
        self.levels |= 1 << id.level;
    }
    #[inline(always)]
    fn found(&self) -> bool {
        self.front + self.back > 0
    }
}

/// Judges the rays of one model; one for each thread.
pub struct Judge<'a> {
    pub(super) model: &'a Model,
    pub(super) golden: &'a Exact<'a>,
    /// With boxes and with prisms around trees' nodes: what rays meet is the same.
    traversers: [LodTraverser<'a>; 2],
    /// Which of them has the ray.
    turn: usize,
    /// Every how many rays the golden traverser is asked.
    pub(super) every: u64,
}

impl<'a> Judge<'a> {
    /// A judge that compares every `every`-th ray with `golden`, the exact traverser of the same model.
    pub fn new(model: &'a Model, golden: &'a Exact<'a>, every: u64) -> Self {
        let image = LodImage::of(&model.scene);
        let traversers = [image, image.bounded_by(&model.prisms)].map(LodTraverser::new);
        Self { model, golden, traversers, turn: 0, every }
    }

    /// The traverser of this ray.
    pub(super) fn traverser(&mut self) -> &mut LodTraverser<'a> {
        &mut self.traversers[self.turn]
    }

    /// Shoots and judges ray `number`.
    pub fn shoot(&mut self, number: u64, shot: &Shot) -> Tally {
        self.turn = self.turn_of(number);
        guarded(number, || {
            let mut tally = Tally { rays: 1, ..Tally::default() };
            self.judge(number, shot, &mut tally);
            tally
        })
    }

    /// Shoots and judges the rays of packet `number`, at most 32, which go together.
    pub fn shoot_together(&mut self, number: u64, shots: &[Shot]) -> Tally {
        self.turn = self.turn_of(number);
        let tally = guarded(number * LANES, || {
            let rays: Vec<Ray> = shots.iter().map(|shot| shot.ray).collect();
            let all = self.traverser().trace_packet(&rays, &mut NoSteps, rays.iter().map(|_| Seen::default()));
            let balance: Vec<_> = shots.iter().zip(&all).map(|(shot, seen)| self.balance(shot, seen)).collect();
            let is_off = balance.iter().any(|off| off.unwrap_or(0) != 0);
            let levels = self.model.hierarchy.levels;
            let hits = (is_off || number.is_multiple_of(self.every))
                .then(|| self.traverser().trace_packet(&rays, &mut NoSteps, rays.iter().map(|_| ClosestHit::new(levels))));
            let mut sum = Tally::default();
            for (k, (seen, off)) in all.iter().zip(balance).enumerate() {
                let mut tally = Tally {
                    crossing: u64::from(seen.front + seen.back > 0),
                    mixed_levels: u64::from(seen.levels.count_ones() > 1),
                    balanced: u64::from(off.is_some()),
                    compared: u64::from(hits.is_some()),
                    ..Tally::default()
                };
                if let Some(hits) = &hits {
                    tally.crossed(seen, self.golden.crossings_in_packet(&rays[k], &rays));
                    let wanted = self.golden.trace_in_packet(&rays[k], &rays);
                    tally.different = u64::from(hits[k].record().as_ref().map(plain) != wanted);
                }
                if off.unwrap_or(0) != 0 && tally.misses + tally.doubles == 0 {
                    tally.misses = 1;
                }
                sum = sum.with(&tally);
            }
            sum
        });
        Tally { rays: shots.len() as u64, ..tally }
    }

    /// The traverser for ray or packet `number`: of those that are compared with the golden traverser and of all others, every other one.
    fn turn_of(&self, number: u64) -> usize {
        ((number / self.every.max(2)) ^ number) as usize & 1
    }

    /// Whether it starts outside of the model's box.
    fn is_outside(&self, ray: &Ray) -> bool {
        let (origin, lo, hi) = (ray.origin.get(), self.model.space.lo, self.model.space.hi);
        (0..3).any(|k| origin[k] < i64::from(lo[k]) || origin[k] > i64::from(hi[k]))
    }

    /// How far from balance it is that so many more crossings go in than out; `None` if they need not balance.
    fn off(&self, more: i64) -> Option<u32> {
        let more = more.unsigned_abs() as u32; // counts of 32 bits
        match self.model.closed {
            Closedness::Open => None,
            Closedness::Oriented => Some(more),
            Closedness::Even => Some(more % 2),
        }
    }

    /// How far the crossings of a ray from outside are from balance; `None` if it starts within the box, or they need not balance.
    fn balance(&self, shot: &Shot, seen: &Seen) -> Option<u32> {
        if self.is_outside(&shot.ray) { self.off(seen.winding()) } else { None }
    }

    fn judge(&mut self, number: u64, shot: &Shot, tally: &mut Tally) {
        let seen = self.seen(&shot.ray);
        tally.crossing = u64::from(seen.front + seen.back > 0);
        tally.mixed_levels = u64::from(seen.levels.count_ones() > 1);
        let off = self.imbalance(shot, &seen);
        tally.balanced = u64::from(off.is_some());
        let unbalanced = off.unwrap_or(0) != 0;
        if unbalanced || number.is_multiple_of(self.every) {
            self.compare(shot, &seen, tally);
            if unbalanced && tally.misses + tally.doubles == 0 {
                // Both traversers agree on it: a breach of the method, not of the blocks. One crossing is missing at least.
                tally.misses = 1;
            }
        }
    }

    fn seen(&mut self, ray: &Ray) -> Seen {
        let mut seen = Seen::default();
        self.traverser().trace(ray, &mut NoSteps, &mut seen);
        seen
    }

    /// How far the crossings are from balance; `None` if they need not balance.
    fn imbalance(&mut self, shot: &Shot, seen: &Seen) -> Option<u32> {
        if self.model.closed == Closedness::Open || self.is_outside(&shot.ray) {
            return self.balance(shot, seen);
        }
        let [x, y, z] = shot.other.filter(|_| shot.ray.cone.slope.get() == 0)?;
        let other = self.seen(&Ray { direction: Direction::new(x, y, z), ..shot.ray });
        let difference = seen.winding() - other.winding();
        // On an edge or vertex a ray may meet none of the triangles around: only the exact surface can tell.
        if difference != 0 && self.golden.starts_on_surface(&shot.ray) {
            return None;
        }
        self.off(difference)
    }

    fn compare(&mut self, shot: &Shot, seen: &Seen, tally: &mut Tally) {
        tally.compared = 1;
        tally.crossed(seen, self.golden.crossings(&shot.ray));
        let mut closest = ClosestHit::new(self.model.hierarchy.levels);
        self.traverser().trace(&shot.ray, &mut NoSteps, &mut closest);
        let hit = closest.record();
        let exact = self.golden.trace_exactly(&shot.ray);
        let (Some(hit), Some((golden, fractions))) = (hit, exact) else {
            tally.different = u64::from(hit.is_some() || exact.is_some());
            return;
        };
        tally.different = u64::from(plain(&hit) != golden);
        tally.saturated = u64::from(hit.t == RayT::MAX);
        if tally.saturated == 0 {
            tally.t_ulp = t_error(&hit, &fractions);
        }
        tally.bary_ulp = bary_error(&hit, &fractions);
        // Each level doubles weights exactly, and so their error.
        tally.full_bary_ulp = tally.bary_ulp * f64::from(1u32 << (self.model.hierarchy.levels - golden.level));
        if let Some((world, ray)) = &shot.view {
            tally.pixels = pixels_off(self.model, world, ray, &hit).unwrap_or(0.0);
        }
    }
}

/// What judging ray `number` shows; where widths are checked a value outside its own counts as an overflow.
pub(super) fn guarded(number: u64, judge: impl FnOnce() -> Tally) -> Tally {
    let tally = if WIDTHS_CHECKED {
        // A value outside its width panics; the traverser starts anew with each ray.
        catch_unwind(AssertUnwindSafe(judge)).unwrap_or(Tally { rays: 1, overflows: 1, ..Tally::default() })
    } else {
        judge()
    };
    Tally { first_breach: (tally.breaches() > 0).then_some(number), ..tally }
}

/// A hit record in the golden traverser's words.
pub(super) fn plain(hit: &Hit) -> crate::golden::ExactHit {
    let narrow = |v: u64| v as u32; // fields of at most 32 bits
    crate::golden::ExactHit {
        t: hit.t.get(),
        tree: narrow(hit.tree.get()),
        level: narrow(hit.level.get()),
        node: narrow(hit.node.get()),
        bary: [hit.b0, hit.b1, hit.b2].map(|b| narrow(b.get())),
        full_node: narrow(hit.full_node.get()),
        full_bary: [hit.full_b0, hit.full_b1, hit.full_b2].map(|b| narrow(b.get())),
        front: hit.front,
    }
}
