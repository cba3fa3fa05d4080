//! Where an inserted vertex goes.

use super::super::distance::{Hit, Vec3};
use super::source::Source;

/// How a lattice point got its place, in the order in which the ways are tried.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Method {
    /// A vertex of the original.
    #[default]
    Corner,
    /// In a triangle, or on an edge, that is the original's own.
    Own,
    /// On a feature line, by arc length.
    Line,
    /// Along the interpolated normal.
    Ray,
    /// The closest point that faces the same way.
    Closest,
    /// Between the closest point (or the feature line) and the midpoint.
    Half,
    /// The middle of the edge.
    Midpoint,
}

impl Method {
    /// What to try when this one folds the surface.
    pub fn next(self) -> Method {
        match self {
            Method::Ray => Method::Closest,
            Method::Closest | Method::Line => Method::Half,
            Method::Own => Method::Own,
            Method::Corner | Method::Half | Method::Midpoint => Method::Midpoint,
        }
    }
}

/// A lattice point's place.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    pub position: Vec3,
    /// Unit normal of the original surface, or zero on a feature line, where there is more than one.
    pub normal: Vec3,
    pub method: Method,
    /// The triangle of the original that it stands for a point of, if that is known, ...
    pub triangle: Option<u32>,
    /// ... and that point's barycentrics.
    pub barycentrics: [f32; 3],
}

impl Point {
    /// Where `hit` is.
    pub fn on(source: &Source, hit: &Hit, method: Method) -> Point {
        let barycentrics = hit.barycentrics.map(|w| w as f32);
        Point { position: hit.point, normal: source.normal(hit), method, triangle: Some(hit.triangle), barycentrics }
    }

    /// A point between this one and `other`, which stands for what this one stands for.
    pub fn halfway(self, other: Vec3) -> Point {
        Point { position: (self.position + other) / 2.0, method: Method::Half, ..self }
    }

    /// A place of no known origin.
    pub fn plain(position: Vec3, method: Method) -> Point {
        Point { position, method, ..Point::default() }
    }
}

/// Cosine of the largest angle between the interpolated normal and the surface that it may meet.
const FACING: f64 = 0.25;

/// How far a vertex may go, in lengths of its edge.
const REACH: f64 = 1.0;

/// A line that goes further than this, in lengths of its edge, may have slipped past the surface beside it.
const DOUBTFUL: f64 = 0.2;

/// A vertex inserted on the edge from `a` to `b`, by `method` or the next that finds a place; `direction` is the sum of normals around.
pub(super) fn insert(source: &Source, a: Point, b: Point, direction: Vec3, patch: Option<u32>, method: Method) -> Point {
    let middle = (a.position + b.position) / 2.0;
    let length = (b.position - a.position).length();
    let midpoint = Point { normal: (a.normal + b.normal).normalize_or_zero(), ..Point::plain(middle, Method::Midpoint) };
    let Some(direction) = direction.try_normalize() else { return midpoint };
    if method >= Method::Midpoint {
        return midpoint;
    }
    let accept = |t: u32| patch.is_none_or(|p| source.patch[t as usize] == p) && source.face_normal[t as usize].dot(direction) > FACING;
    let ray = (method == Method::Ray).then(|| source.target.line(middle, direction, REACH * length, accept)).flatten();
    let far = |point: Vec3| (point - middle).length();
    if let Some(hit) = ray
        && far(hit.point) <= DOUBTFUL * length
    {
        return Point::on(source, &hit, Method::Ray);
    }
    let closest = source.target.closest(middle, REACH * length, accept);
    match (ray, closest) {
        (Some(ray), Some(closest)) if far(ray.point) <= 2.0 * far(closest.point) => Point::on(source, &ray, Method::Ray),
        (_, Some(closest)) if method == Method::Half => Point::on(source, &closest, method).halfway(middle),
        (_, Some(closest)) => Point::on(source, &closest, Method::Closest),
        _ => midpoint,
    }
}
