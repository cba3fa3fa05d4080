//! What rays meet: triangles, and planes that stand for many.

use super::tree::Tree;
use crate::block::start_test::Below;
use crate::block::tri_test;
use crate::format::encode_normal;
use crate::method::{AllHits, ClosestHit, Departure, HitSink, Landing, SurfaceHit, TriangleId};
use crate::num::{COORD_LIMIT, Point, RayT, START_BITS, Start, U};
use crate::rays::ModelRay;
use glam::DVec3;

/// A plane that was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneHit {
    /// Where along the ray.
    pub t: RayT,
    /// Number of the R-LOD.
    pub rlod: u32,
    /// From the side of its normal.
    pub front: bool,
}

/// Receives triangles, and planes of R-LODs.
pub trait PlaneSink: HitSink {
    /// The plane of an R-LOD was met.
    fn plane(&mut self, hit: PlaneHit);
}

/// Keeps the closest, a triangle before a plane where both are met at once.
pub struct Nearest {
    triangle: ClosestHit,
    plane: Option<PlaneHit>,
    range: [RayT; 2],
    any: bool,
}

impl Nearest {
    /// Nothing yet, of the steps of t of `ray`; any hit serves if `any`.
    pub fn of(ray: &ModelRay, any: bool) -> Self {
        Self { triangle: ClosestHit::of(0, ray, any), plane: None, range: ray.range, any }
    }

    /// The closest triangle, whatever planes were met.
    pub fn triangle(&self) -> &ClosestHit {
        &self.triangle
    }

    /// The plane, if that is the closest.
    fn nearest_plane(&self) -> Option<PlaneHit> {
        self.plane.filter(|plane| !self.triangle.found() || plane.t < self.triangle.t_max())
    }

    /// The hit in the world; triangles and R-LODs by their numbers in `tree`'s surface.
    pub fn surface(&self, tree: &Tree, ray: &ModelRay) -> Option<SurfaceHit> {
        match self.nearest_plane() {
            Some(plane) => Some(on_plane(tree, ray, plane)),
            None => self.triangle.surface(ray),
        }
    }

    /// The same, with where rays start that leave it; of a triangle as `departure` says.
    pub fn landing(
        &self,
        tree: &Tree,
        ray: &ModelRay,
        from: Option<&Start>,
        departure: impl FnOnce(&crate::method::Hit, &[Point; 3]) -> Departure,
    ) -> Option<Landing> {
        let Some(plane) = self.nearest_plane() else { return self.triangle.landing(ray, departure) };
        Some(Landing { surface: on_plane(tree, ray, plane), departure: leaving(tree, ray, from, plane) })
    }
}

impl HitSink for Nearest {
    #[inline(always)]
    fn t_max(&self) -> RayT {
        self.plane.map_or(RayT::MAX, |plane| plane.t).min(self.triangle.t_max())
    }

    #[inline(always)]
    fn offer(&mut self, id: TriangleId, corners: &[Point; 3], test: &tri_test::Out, below: &Below) {
        self.triangle.offer(id, corners, test, below);
    }

    fn found(&self) -> bool {
        self.triangle.found() || self.plane.is_some()
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        self.any && self.found()
    }
}

impl PlaneSink for Nearest {
    #[inline(always)]
    fn plane(&mut self, hit: PlaneHit) {
        if hit.t >= self.range[0] && hit.t <= self.range[1] && self.plane.is_none_or(|plane| hit.t < plane.t) {
            self.plane = Some(hit);
        }
    }
}

/// Keeps every hit: a triangle once, however many leaves name it.
pub struct Every {
    triangles: AllHits,
    planes: Vec<PlaneHit>,
    seen: Vec<u32>,
    range: [RayT; 2],
}

impl Every {
    /// Nothing yet, of the steps of t of `ray`.
    pub fn of(ray: &ModelRay) -> Self {
        Self { triangles: AllHits::of(0, ray), planes: Vec::new(), seen: Vec::new(), range: ray.range }
    }

    /// Adds them to `hits` in the world, nearest first.
    pub fn surfaces(self, tree: &Tree, ray: &ModelRay, hits: &mut Vec<SurfaceHit>) {
        let first = hits.len();
        self.triangles.surfaces(ray, hits);
        if !self.planes.is_empty() {
            hits.extend(self.planes.into_iter().map(|plane| on_plane(tree, ray, plane)));
            hits[first..].sort_by(|a, b| a.distance.total_cmp(&b.distance));
        }
    }
}

impl HitSink for Every {
    fn t_max(&self) -> RayT {
        self.range[1]
    }

    fn offer(&mut self, id: TriangleId, corners: &[Point; 3], test: &tri_test::Out, below: &Below) {
        if !self.seen.contains(&id.tree) {
            self.seen.push(id.tree);
            self.triangles.offer(id, corners, test, below);
        }
    }

    fn found(&self) -> bool {
        self.triangles.found() || !self.planes.is_empty()
    }
}

impl PlaneSink for Every {
    fn plane(&mut self, hit: PlaneHit) {
        if hit.t >= self.range[0] && hit.t <= self.range[1] {
            self.planes.push(hit);
        }
    }
}

/// A hit on the plane of an R-LOD in the world: its triangle is the one behind all others in the surface that stands for that R-LOD.
fn on_plane(tree: &Tree, ray: &ModelRay, PlaneHit { t, rlod, front }: PlaneHit) -> SurfaceHit {
    let [x, y, z, _] = tree.rlods[rlod as usize].plane;
    SurfaceHit {
        distance: ray.distance(t.get()),
        tree: tree.triangles.len() as u32 + rlod, // at most 2^28 and 2^27
        full_bary: [1.0 / 3.0; 3],
        bary: [1.0 / 3.0; 3],
        front,
        plane: encode_normal([x, y, z]).unwrap_or(SurfaceHit::NO_PLANE),
        ..SurfaceHit::default()
    }
}

/// Units from a start to the corners of the triangle that stands for its plane.
const REACH: f64 = 65_536.0;

/// Where rays start that leave the plane of an R-LOD: nothing as near counts as that is off by (paper section 4.3, "Secondary rays").
fn leaving(tree: &Tree, ray: &ModelRay, from: Option<&Start>, PlaneHit { t, rlod, .. }: PlaneHit) -> Departure {
    let rlod = &tree.rlods[rlod as usize];
    let fraction = from.map_or([0; 3], |from| from.fraction.map(|f| f.get().cast_signed()));
    let (origin, direction) = (ray.ray.origin.get(), ray.ray.direction.get());
    // Steps of t are 2^-32 of the direction, those of starts 2^-31 of a unit: below 2^66, and within the model's box but for rounding.
    let limit = i128::from(COORD_LIMIT) << START_BITS;
    let fixed: [i128; 3] = std::array::from_fn(|k| {
        let along = (i128::from(t.get()) * i128::from(direction[k])) >> (32 - START_BITS);
        ((i128::from(origin[k]) << START_BITS) + i128::from(fraction[k]) + along).clamp(-limit, limit)
    });
    let low = (1i128 << START_BITS) - 1;
    let whole = fixed.map(|c| (c >> START_BITS) as i64);
    let point = Point::new(whole[0], whole[1], whole[2]);
    let start = Start { point, fraction: fixed.map(|c| U::new((c & low) as u64)) };

    let [x, y, z, _] = rlod.plane;
    let normal = DVec3::new(x.into(), y.into(), z.into());
    let (u, v) = normal.normalize().any_orthonormal_pair();
    let at = DVec3::from_array(whole.map(|c| c as f64));
    let corner = |across: f64, along: f64| {
        let limit = f64::from(COORD_LIMIT);
        let [x, y, z] = (at + (u * across + v * along) * REACH).round().to_array().map(|c| c.clamp(-limit, limit) as i64);
        Point::new(x, y, z)
    };
    let corners = [corner(-1.0, -1.0), corner(2.0, -1.0), corner(-1.0, 2.0)];
    // 32 bits hold any radius of a model.
    Departure { start, corners, prior: None, crowded: false, clear: rlod.radius.ceil() as u32 }
}
