//! Paths: rays that leave the surface where the one before hit it, again and again, judged like all others.
//!
//! **Balance** (closed models, cones that do not grow): two rays that leave one point of a triangle to the same side see the same winding number, whatever their directions: a
//! ray that met its own triangle, slipped under it, or missed or doubled what lies a unit away would see another one. (If the point lies on a second triangle, the directions may part there.)
//! **Golden**: the closest hit in every field, the number of crossings, and where the next ray starts, against the exact traverser with the rule of prior rays in its own words.

use super::judge::{Judge, Tally, guarded, plain};
use super::model::Model;
use super::rays::{Bounce, Cones, Shot, legal, pick, scaled, some_cone};
use crate::golden::Leg;
use crate::lab::crack::{self, Closedness};
use crate::mesh::lattice;
use crate::method::leave::side;
use crate::method::{ClosestHit, Crossings, Departure};
use crate::num::{Direction, Point, Random, Ray};
use crate::step::NoSteps;
use std::cmp::Ordering;

/// The most rays of a path, its first included.
pub const DEPTH: usize = 8;

/// Exact, as far as `f64` goes, normal of a triangle.
fn normal(corners: &[Point; 3]) -> [f64; 3] {
    let [a, b, c] = corners.map(|p| p.get().map(|c| c as f64));
    let (e, f): ([f64; 3], [f64; 3]) = (std::array::from_fn(|k| b[k] - a[k]), std::array::from_fn(|k| c[k] - a[k]));
    std::array::from_fn(|k| e[(k + 1) % 3] * f[(k + 2) % 3] - e[(k + 2) % 3] * f[(k + 1) % 3])
}

fn direction(v: [i64; 3]) -> Direction {
    let [x, y, z] = v;
    Direction::new(x, y, z)
}

fn negated(d: Direction) -> Direction {
    direction(d.get().map(|c| -c))
}

fn anywhere(random: &mut Random) -> Direction {
    direction(scaled(crack::direction(random)))
}

/// Where the path goes on from `from`, which a ray along `before` has hit.
fn onward(model: &Model, bounce: Bounce, before: Direction, from: &Departure, random: &mut Random) -> Direction {
    let d = match bounce {
        Bounce::Through => return before,
        Bounce::Diffuse => anywhere(random),
        Bounce::Mirror => {
            let (n, d) = (normal(&from.corners), before.get().map(|c| c as f64));
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let twice = 2.0 * dot(n, d) / dot(n, n).max(1.0);
            direction(scaled([0, 1, 2].map(|k| (d[k] - twice * n[k]).round() as i64)))
        }
        Bounce::Grazing => {
            let [a, b, c] = from.corners.map(Point::get);
            let (i, j) = (random.signed(), random.signed());
            let along = [0, 1, 2].map(|k| (i * (b[k] - a[k]) as f64 + j * (c[k] - a[k]) as f64).round() as i64);
            let mut d = if along == [0; 3] { scaled(crack::direction(random)) } else { scaled(along) };
            d[random.below(3) as usize] += random.within(1);
            direction(legal(d))
        }
        Bounce::Vertex => {
            let h = &model.hierarchy;
            // Of the model anywhere, or of the tree that was hit and those beside it in memory.
            let near = from.prior.map_or(0, |prior| u64::from(prior.tree)) + random.below(3);
            let tree = if random.below(2) == 0 { near.min(h.triangles.len() as u64 - 1) } else { random.below(h.triangles.len() as u64) };
            let points = h.tree(tree as usize);
            let level = random.below(u64::from(h.levels) + 1) as u32;
            let corners =
                lattice::node(h.levels, level, random.below(1 << (2 * level)) as u32).map(|p| points[lattice::index(h.levels, p)]);
            let (p, q) = (pick(&corners, random), pick(&corners, random));
            let x = from.start.point.get();
            let to = [0, 1, 2].map(|k| (i64::from(p[k]) + i64::from(q[k])).div_euclid(2) - x[k]);
            direction(if to == [0; 3] { scaled(crack::direction(random)) } else { scaled(to) })
        }
    };
    // To the side that the ray came from.
    let came = side(&from.corners, before).reverse();
    if side(&from.corners, d) == came.reverse() { negated(d) } else { d }
}

impl Judge<'_> {
    /// Shoots ray `number` and those that leave where it hits, one after the other, at most eight in all.
    pub fn follow(&mut self, number: u64, shot: &Shot, bounces: &[Bounce], cones: Cones, random: &mut Random) -> Tally {
        let first = self.shoot(number, shot);
        first.with(&guarded(number, || self.onwards(number, shot, bounces, cones, random)))
    }

    /// The same without the first.
    fn onwards(&mut self, number: u64, shot: &Shot, bounces: &[Bounce], cones: Cones, random: &mut Random) -> Tally {
        let mut tally = Tally::default();
        let compares = number.is_multiple_of(self.every);
        let (mut rays, mut legs, mut from) = (vec![shot.ray], Vec::new(), None::<Departure>);
        let bounce = pick(bounces, random);
        while rays.len() < DEPTH {
            let last = rays[rays.len() - 1];
            let Some(departure) = self.departure(&last, from.as_ref()) else { break };
            if departure.crowded {
                tally.crowded += 1;
                break;
            }
            if compares {
                self.lengthen(&mut legs, &last);
                if legs.last().map(Leg::start) != Some(departure.start) {
                    tally.different += 1;
                }
            }
            let ray = Ray {
                origin: departure.start.point,
                direction: onward(self.model, bounce, last.direction, &departure, random),
                cone: some_cone(self.model, cones, random),
            };
            tally = tally.with(&self.leave(&rays, compares.then_some(legs.as_slice()), &ray, &departure, random));
            rays.push(ray);
            from = Some(departure);
        }
        tally
    }

    /// Where the next ray of a path starts.
    fn departure(&mut self, ray: &Ray, from: Option<&Departure>) -> Option<Departure> {
        let mut closest = ClosestHit::new(self.model.hierarchy.levels);
        self.crossed(ray, from, &mut closest);
        Some(self.traverser().departure(ray, from, &closest.record()?, &closest.corners()?))
    }

    fn crossed(&mut self, ray: &Ray, from: Option<&Departure>, sink: &mut impl crate::method::HitSink) {
        match from {
            Some(from) => self.traverser().trace_from(ray, from, &mut NoSteps, sink),
            None => self.traverser().trace(ray, &mut NoSteps, sink),
        }
    }

    fn counted(&mut self, ray: &Ray, from: &Departure) -> Crossings {
        let mut crossings = Crossings::default();
        self.crossed(ray, Some(from), &mut crossings);
        crossings
    }

    /// The golden path by one ray more.
    fn lengthen(&self, legs: &mut Vec<Leg>, ray: &Ray) {
        if let Some(hit) = self.golden.trace_after(legs, ray) {
            legs.push(self.golden.leg(legs, ray, &hit));
        }
    }

    /// Judges a ray that leaves the surface after `rays`; `legs` are they with their golden hits, if that is known.
    fn leave(&mut self, rays: &[Ray], legs: Option<&[Leg]>, ray: &Ray, from: &Departure, random: &mut Random) -> Tally {
        let mut tally = Tally { rays: 1, ..Tally::default() };
        let seen = self.counted(ray, from);
        tally.crossing = u64::from(seen.front + seen.back > 0);
        let apart = self.parted(ray, from, &seen, random);
        tally.balanced = u64::from(apart.is_some());
        let mut unbalanced = apart.is_some_and(|by| by != 0);
        if !unbalanced && legs.is_none() {
            return tally;
        }
        let mut own = Vec::new();
        let legs = legs.unwrap_or_else(|| {
            rays.iter().for_each(|ray| self.lengthen(&mut own, ray));
            &own
        });
        // Asked only where it matters: it looks at the whole surface.
        unbalanced = unbalanced && !self.golden.starts_on_another(legs, ray);
        tally.compared = 1;
        let wanted = self.golden.crossings_after(legs, ray);
        for (found, wanted) in [(seen.front, wanted.front), (seen.back, wanted.back)] {
            tally.misses += u64::from(wanted.saturating_sub(found));
            tally.doubles += u64::from(found.saturating_sub(wanted));
        }
        let mut closest = ClosestHit::new(self.model.hierarchy.levels);
        self.crossed(ray, Some(from), &mut closest);
        tally.different = u64::from(closest.record().as_ref().map(plain) != self.golden.trace_after(legs, ray));
        if unbalanced && tally.misses + tally.doubles == 0 {
            tally.misses = 1;
        }
        tally
    }

    /// How far the winding numbers of `ray` and of another one to the same side are apart; `None` if they need not be one.
    fn parted(&mut self, ray: &Ray, from: &Departure, seen: &Crossings, random: &mut Random) -> Option<i64> {
        let closed = self.model.closed;
        if closed == Closedness::Open || ray.cone.slope.get() != 0 {
            return None;
        }
        let other = anywhere(random);
        let [one, two] = [ray.direction, other].map(|d| side(&from.corners, d));
        if one == Ordering::Equal || two == Ordering::Equal {
            return None;
        }
        let direction = if one == two { other } else { negated(other) };
        let winding = |seen: &Crossings| i64::from(seen.front) - i64::from(seen.back);
        let apart = winding(seen) - winding(&self.counted(&Ray { direction, ..*ray }, from));
        Some(if closed == Closedness::Oriented { apart } else { apart % 2 })
    }
}
