//! Families of rays: where a ray of the lab starts and what it is aimed at. The n-th ray of a seed is the same on any number of threads.

use super::model::Model;
use crate::lab::crack::{self, TARGETS};
use crate::mesh::lattice;
use crate::num::{BOX_SHIFT, Cone, DIRECTION_SCALE, Point, Random, Ray, Vec3};
use crate::rays::{ModelRay, Query, cone};
use serde::Serialize;

/// A family of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Aim {
    /// Exactly at, and within one unit of, vertices, midpoints and other points of edges (the five targets of `crack`).
    Edges,
    /// Along an edge: exactly where its direction is a small multiple of whole steps, else as near as a direction can be.
    AlongEdge,
    /// In the plane of a triangle through one of its corners, exactly or as near, and a unit of direction off it.
    Grazing,
    /// Along an axis, through a vertex or one unit beside it.
    AxisParallel,
    /// In a plane that bounds 16-bit boxes, or through its crossing with a vertex's coordinates.
    BoxFace,
    /// From inside the model's box.
    Inside,
    /// From a vertex, a point of an edge, or a rounded point of a triangle.
    OnSurface,
    /// From a camera that looks at a vertex.
    View,
    /// A path: what leaves, one after the other, where the first of these families hits.
    Leaving(&'static [Aim], &'static [Bounce]),
}

/// How the rays of a path go on from a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bounce {
    /// To the side that the ray came from, anywhere.
    Diffuse,
    /// As a mirror would.
    Mirror,
    /// In the plane of the triangle, as nearly as a direction can be, or a unit of direction off.
    Grazing,
    /// At a vertex, or a midpoint of an edge, of the model: often one of the triangle's own neighbours.
    Vertex,
    /// Through the surface: on the same way, to the other side.
    Through,
}

/// All of them.
pub const BOUNCES: [Bounce; 5] = [Bounce::Diffuse, Bounce::Mirror, Bounce::Grazing, Bounce::Vertex, Bounce::Through];

/// Cones of the rays that no camera makes.
#[derive(Clone, Copy, Debug)]
pub enum Cones {
    /// So that the tolerance at the target is near the bound of some edge: neighbours take unequal states.
    Mixed,
    /// One of these, as (delta, radius at the origin in units, tangent of the half angle).
    Listed(&'static [(f64, f64, f64)]),
}

/// Cameras of a case.
#[derive(Clone, Copy, Debug)]
pub struct Views {
    /// Distances of the eye from its target in bounding radii.
    pub distances: &'static [f64],
    /// Qualities.
    pub deltas: &'static [f64],
    /// Tangents of the cones' half angles.
    pub tangents: &'static [f64],
}

/// Half a pixel of a picture of 1024 rows taken with the default lens.
pub const PIXEL: f64 = 12.0 / 35.0 / 1024.0;

impl Default for Views {
    fn default() -> Self {
        Self { distances: &[1.2, 2.5, 20.0], deltas: &[0.25, 1.0, 8.0], tangents: &[PIXEL] }
    }
}

/// A ray to shoot.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// The integer ray.
    pub ray: Ray,
    /// What it was in the world, for a ray of a camera.
    pub view: Option<(Query, ModelRay)>,
    /// Another direction from the same origin, for a ray from inside.
    pub other: Option<[i64; 3]>,
}

pub(super) fn pick<T: Copy>(from: &[T], random: &mut Random) -> T {
    from[random.below(from.len() as u64) as usize]
}

/// Corners of a random node of a random level.
fn triangle(model: &Model, random: &mut Random) -> [[i64; 3]; 3] {
    let h = &model.hierarchy;
    let points = h.tree(random.below(h.triangles.len() as u64) as usize);
    let level = random.below(u64::from(h.levels) + 1) as u32;
    let node = random.below(1 << (2 * level)) as u32;
    lattice::node(h.levels, level, node).map(|c| points[lattice::index(h.levels, c)].map(i64::from))
}

fn sub(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// `d` divided by the greatest common divisor of its components, if it is then short enough for [`crack::from_outside`].
fn short(d: [i64; 3]) -> Option<[i64; 3]> {
    let gcd = |mut a: i64, mut b: i64| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a.abs()
    };
    let g = gcd(gcd(d[0], d[1]), d[2]);
    let step = d.map(|c| if g == 0 { 0 } else { c / g });
    // At 4096 the longest whole multiple still has 0.99 of the direction's full length.
    (g > 0 && step.iter().all(|c| c.abs() <= 4096)).then_some(step)
}

/// The ray along `d` (not 0) through `p` from outside the box, exactly if `d` allows; else rounded, of full length.
fn through(model: &Model, p: [i64; 3], d: [i64; 3]) -> ([i64; 3], [i64; 3]) {
    match short(d) {
        Some(step) => crack::from_outside(&model.space, p, step),
        None => {
            let direction = scaled(d);
            // Back until outside, by the first face that is reached.
            let unit = direction.map(|c| c as f64 / f64::from(DIRECTION_SCALE));
            let space = &model.space;
            let way = (0..3).filter(|&k| unit[k] != 0.0).map(|k| {
                let wall = if unit[k] > 0.0 { i64::from(space.lo[k]) - 32 } else { i64::from(space.hi[k]) + 32 };
                (p[k] - wall).abs() as f64 / unit[k].abs()
            });
            let way = way.fold(f64::INFINITY, f64::min);
            (std::array::from_fn(|k| p[k] - (unit[k] * way).round() as i64), direction)
        }
    }
}

/// `d` (not 0) at the direction's full length, rounded.
pub(super) fn scaled(d: [i64; 3]) -> [i64; 3] {
    let length = d.iter().map(|&c| (c as f64).powi(2)).sum::<f64>().sqrt();
    d.map(|c| (c as f64 / length * f64::from(DIRECTION_SCALE)).round() as i64)
}

fn along_axis(random: &mut Random) -> (usize, [i64; 3]) {
    let k = random.below(3) as usize;
    let mut d = [0; 3];
    d[k] = if random.below(2) == 0 { 1 } else { -1 };
    (k, d)
}

/// The `random` ray of a family; `None` if it missed the model's box or has no direction.
pub fn shot(model: &Model, aim: Aim, cones: Cones, views: &Views, random: &mut Random) -> Option<Shot> {
    if aim == Aim::View {
        let (world, ray) = view(model, views, random)?;
        return Some(Shot { ray: ray.ray, view: Some((world, ray)), other: None });
    }
    let mut other = None;
    let mut aimed = None;
    let (origin, direction) = match aim {
        Aim::Edges => {
            let ray = crack::aim(&model.hierarchy, &model.space, pick(&TARGETS, random), random);
            aimed = Some(ray.cone);
            (ray.origin.get(), ray.direction.get())
        }
        Aim::AlongEdge => {
            let t = triangle(model, random);
            let k = random.below(3) as usize;
            let along = sub(t[(k + 1) % 3], t[k]);
            through(model, t[k], if along == [0; 3] { along_axis(random).1 } else { along })
        }
        Aim::Grazing => grazing(model, random),
        Aim::AxisParallel => {
            let mut p = pick(&triangle(model, random), random);
            let (k, d) = along_axis(random);
            if random.below(2) == 0 {
                p[(k + 1) % 3] += random.within(1);
                p[(k + 2) % 3] += random.within(1);
            }
            crack::from_outside(&model.space, p, d)
        }
        Aim::BoxFace => box_face(model, random),
        Aim::Inside => {
            let (lo, hi) = (model.space.lo, model.space.hi);
            let near = pick(&triangle(model, random), random);
            let spread = 1u64 << random.below(31);
            let anywhere = random.below(2) == 0;
            let origin = std::array::from_fn(|k| {
                let (lo, hi) = (i64::from(lo[k]), i64::from(hi[k]));
                if anywhere {
                    lo + random.below((hi - lo).cast_unsigned() + 1).cast_signed()
                } else {
                    (near[k] + random.within(spread)).clamp(lo, hi)
                }
            });
            other = Some(scaled(crack::direction(random)));
            (origin, scaled(crack::direction(random)))
        }
        Aim::OnSurface => {
            let [a, b, c] = triangle(model, random);
            let (i, j) = match random.below(3) {
                0 => (0, 0),
                1 => (random.below(17).cast_signed(), 0),
                _ => (random.below(9).cast_signed(), random.below(9).cast_signed()),
            };
            let p = std::array::from_fn(|k| a[k] + ((b[k] - a[k]) * i + (c[k] - a[k]) * j) / 16);
            (p, scaled(crack::direction(random)))
        }
        Aim::View => return None,
        Aim::Leaving(first, _) => return shot(model, pick(first, random), cones, views, random),
    };
    let ray_cone = match cones {
        // A tolerance that does not grow: then the surface is one for all directions from the origin.
        Cones::Mixed if aim == Aim::Inside => constant(crack::cone(&model.hierarchy, 1, random)),
        Cones::Mixed if aimed.is_some() => aimed.unwrap_or_default(),
        cones => any_cone(model, cones, random),
    };
    let ray = Ray {
        origin: Point::new(origin[0], origin[1], origin[2]),
        direction: Vec3::new(direction[0], direction[1], direction[2]),
        cone: ray_cone,
    };
    Some(Shot { ray, view: None, other })
}

/// A ray of a pencil: its origin some units off another's, at a model's box or outside of it.
pub(super) fn beside(model: &Model, first: &Shot, random: &mut Random) -> Shot {
    let spread = 1u64 << random.below(17);
    let (lo, hi) = (model.space.lo, model.space.hi);
    let off = first.ray.origin.get();
    let origin: [i64; 3] = std::array::from_fn(|k| {
        let moved = off[k] + random.within(spread);
        // Not across a face: whoever starts outside of the box stays there.
        match off[k] {
            v if v < i64::from(lo[k]) => moved.min(i64::from(lo[k]) - 1),
            v if v > i64::from(hi[k]) => moved.max(i64::from(hi[k]) + 1),
            _ => moved,
        }
        .clamp(1 - (1 << 31), (1 << 31) - 1)
    });
    Shot { ray: Ray { origin: Point::new(origin[0], origin[1], origin[2]), ..first.ray }, view: None, other: None }
}

fn any_cone(model: &Model, cones: Cones, random: &mut Random) -> Cone {
    match cones {
        Cones::Mixed => {
            let away = (0..3).map(|k| i64::from(model.space.hi[k]) - i64::from(model.space.lo[k])).max().unwrap_or(0);
            crack::cone(&model.hierarchy, away.cast_unsigned().max(1), random)
        }
        Cones::Listed(list) => {
            let (delta, radius, tangent) = pick(list, random);
            cone(delta, radius, tangent)
        }
    }
}

/// A cone for a ray that leaves the surface: one of the case's, but for one in four it does not grow, so that the surface is one for all directions.
pub(super) fn some_cone(model: &Model, cones: Cones, random: &mut Random) -> Cone {
    let any = any_cone(model, cones, random);
    if random.below(4) == 0 { any } else { constant(crack::cone(&model.hierarchy, 1 << random.below(31), random)) }
}

/// `d` itself, or shorter by half, so that it keeps to the length that the blocks are made for.
pub(super) fn legal(d: [i64; 3]) -> [i64; 3] {
    let is_legal = d.iter().map(|c| c * c).sum::<i64>() < i64::from(DIRECTION_SCALE + 1).pow(2);
    if is_legal { d } else { d.map(|c| c / 2) }
}

fn constant(c: Cone) -> Cone {
    Cone { slope: Default::default(), ..c }
}

/// Through a corner of a triangle along a vector of its plane, half of the time one unit of direction off.
fn grazing(model: &Model, random: &mut Random) -> ([i64; 3], [i64; 3]) {
    let [a, b, c] = triangle(model, random);
    let (i, j) = (random.within(3), random.within(3));
    // In steps of the edges' own divisors, where those are small, the combination stays short.
    let whole = |d| short(d).unwrap_or(d);
    let (e, f) = (whole(sub(b, a)), whole(sub(c, a)));
    let d = std::array::from_fn(|k| i * e[k] + j * f[k]);
    let d = if d == [0; 3] { along_axis(random).1 } else { d };
    let (origin, direction) = through(model, a, d);
    let mut off = direction;
    off[random.below(3) as usize] += random.within(1);
    // As long as it stays within the length that the blocks are made for.
    (origin, if legal(off) == off && random.below(2) == 0 { off } else { direction })
}

/// A ray that moves within a plane of box codes, or crosses it at a vertex's other two coordinates.
fn box_face(model: &Model, random: &mut Random) -> ([i64; 3], [i64; 3]) {
    let mut p = pick(&triangle(model, random), random);
    let k = random.below(3) as usize;
    let step = 1i64 << BOX_SHIFT;
    let up = random.below(2).cast_signed();
    let off = if random.below(4) == 0 { random.within(1) } else { 0 };
    // Not beyond the model's box: on the way back from there an origin would leave 32 bits.
    let (lo, hi) = (i64::from(model.space.lo[k]), i64::from(model.space.hi[k]));
    p[k] = ((p[k].div_euclid(step) + up) * step + off).clamp(lo, hi);
    let mut d = crack::direction(random);
    if random.below(2) == 0 {
        d[k] = 0;
    }
    if d == [0; 3] {
        d[(k + 1) % 3] = 1;
    }
    crack::from_outside(&model.space, p, d)
}

/// A ray of a camera at one of the case's distances from a vertex, towards that vertex and a few pixels beside it.
fn view(model: &Model, views: &Views, random: &mut Random) -> Option<(Query, ModelRay)> {
    let h = &model.hierarchy;
    let target = h.to_world(h.points[random.below(h.points.len() as u64) as usize]);
    let away = pick(views.distances, random) * model.space.radius();
    let from = crack::direction(random).map(|c| c as f64);
    let length = from.iter().map(|c| c * c).sum::<f64>().sqrt();
    let origin: [f64; 3] = std::array::from_fn(|k| target[k] + from[k] / length * away);
    // Beyond a few radii a pixel is larger than the model.
    let aside = (8.0 * PIXEL * away).min(0.1 * model.space.radius());
    let direction = std::array::from_fn(|k| target[k] - origin[k] + aside * random.signed());
    let world = Query::new(origin, direction).with_cone(0.0, pick(views.tangents, random));
    let ray = model.space.enter(&world, pick(views.deltas, random))?;
    Some((world, ray))
}
