//! Hits: what a traversal returns, and what it does with each triangle that the ray meets.

use super::prior::Prior;
use crate::block::Block;
use crate::block::bary_map::{self, BaryMap, NodeIndex};
use crate::block::hit_divide::{self, HitDivide};
use crate::block::hit_select::{self, FullId, HitSelect};
use crate::block::start_test::Below;
use crate::block::tri_test::{self, EdgeFunction, TNumerator};
use crate::format::encode_normal;
use crate::num::{BARY_ONE, Bary, Point, RayT, Start, T_NEAR_TO_T_SHIFT, TNear, U, wire_struct};
use crate::rays::ModelRay;
use glam::DVec3;

wire_struct! {
    /// The hit record.
    pub struct Hit {
        /// Ray parameter in steps of 2^-32 of the direction.
        t: RayT,
        /// The front face was met.
        front: bool,
        /// Base triangle.
        tree: U<28>,
        /// Level of the triangle that was met, 0 to N.
        level: U<4>,
        /// Its node on that level.
        node: NodeIndex,
        /// Weight of its p0, 2^31 = 1.
        b0: Bary,
        /// Weight of its p1.
        b1: Bary,
        /// Weight of its p2.
        b2: Bary,
        /// Node on level N: the full-resolution triangle is `tree * 4^N + full_node`.
        full_node: NodeIndex,
        /// Weight of the full-resolution triangle's corner 0.
        full_b0: Bary,
        /// Weight of corner 1.
        full_b1: Bary,
        /// Weight of corner 2.
        full_b2: Bary,
    }
}

/// Which triangle of a hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct TriangleId {
    /// Base triangle.
    pub tree: u32,
    /// Level.
    pub level: u32,
    /// Node on that level.
    pub node: u32,
}

/// Receives every triangle that a ray meets.
pub trait HitSink {
    /// Nothing beyond this t is wanted.
    fn t_max(&self) -> RayT;
    /// Triangle `id` with these corners, as they were tested, was met; `test.hit` is true, and `below` what its numerators have below whole numbers.
    fn offer(&mut self, id: TriangleId, corners: &[Point; 3], test: &tri_test::Out, below: &Below);
    /// Something was met that counts.
    fn found(&self) -> bool;
    /// Nothing more is wanted.
    #[inline(always)]
    fn is_done(&self) -> bool {
        false
    }
}

impl<H: HitSink + ?Sized> HitSink for &mut H {
    #[inline(always)]
    fn t_max(&self) -> RayT {
        (**self).t_max()
    }
    #[inline(always)]
    fn offer(&mut self, id: TriangleId, corners: &[Point; 3], test: &tri_test::Out, below: &Below) {
        (**self).offer(id, corners, test, below);
    }
    #[inline(always)]
    fn found(&self) -> bool {
        (**self).found()
    }
    #[inline(always)]
    fn is_done(&self) -> bool {
        (**self).is_done()
    }
}

/// True if a box entered at `t_near` cannot hold a hit that beats one at `t`.
#[inline(always)]
pub fn is_beyond(t_near: TNear, t: RayT) -> bool {
    t_near.get() << T_NEAR_TO_T_SHIFT > t.get()
}

/// Keeps the closest hit: smaller t, at equal t a front face before a back face, then smaller id; or, if any serves, the closest of the first triangles tested together of which one is met.
#[derive(Clone, Debug)]
pub struct ClosestHit {
    levels: u32,
    /// Steps of t that count.
    range: [RayT; 2],
    any: bool,
    t: RayT,
    id: FullId,
    best: Option<Met>,
}

/// A triangle that was met, with all that its hit is worked out from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Met {
    pub id: TriangleId,
    pub corners: [Point; 3],
    pub test: tri_test::Out,
    pub below: Below,
}

impl Met {
    /// Where along the ray.
    #[inline(always)]
    pub fn t(test: &tri_test::Out, below: &Below) -> RayT {
        HitDivide::with(&hit_divide::In { numerator: test.t_num, denominator: test.det }, below.t).quotient
    }

    /// The hit record, in a hierarchy of `levels` splits: divides and maps.
    fn record(&self, levels: u32, t: RayT) -> Hit {
        let Self { id, test, below, .. } = self;
        let weight = |edge: EdgeFunction, low| {
            // An edge function is at most det: the quotient is at most 2^32 before its last bit is dropped.
            let numerator = TNumerator::new(edge.get());
            HitDivide::with(&hit_divide::In { numerator, denominator: test.det }, low).quotient.get() >> 1
        };
        let (b1, b2) = (weight(test.v, below.v), weight(test.w, below.w));
        // Both were rounded down and v + w <= det.
        let [b0, b1, b2] = [BARY_ONE - b1 - b2, b1, b2].map(Bary::new);
        let node = U::new(u64::from(id.node));
        let full = BaryMap::eval(&bary_map::In { levels: U::new(u64::from(levels - id.level)), node, b0, b1, b2 });
        Hit {
            t,
            front: test.front,
            tree: U::new(u64::from(id.tree)),
            level: U::new(u64::from(id.level)),
            node,
            b0,
            b1,
            b2,
            full_node: full.node,
            full_b0: full.b0,
            full_b1: full.b1,
            full_b2: full.b2,
        }
    }

    /// The same in the world.
    pub fn surface(&self, levels: u32, t: RayT, ray: &ModelRay) -> SurfaceHit {
        SurfaceHit::new(ray, &self.record(levels, t), plane(self.corners.map(|p| p.get().map(|c| c as f64))))
    }
}

impl ClosestHit {
    /// Nothing yet, in a hierarchy of `levels` splits.
    pub fn new(levels: u32) -> Self {
        Self { levels, range: [RayT::ZERO, RayT::MAX], any: false, t: RayT::MAX, id: FullId::ZERO, best: None }
    }

    /// The same where only the steps of t of `ray` count; any hit serves if `any`.
    pub fn of(levels: u32, ray: &ModelRay, any: bool) -> Self {
        Self { range: ray.range, any, t: ray.range[1], ..Self::new(levels) }
    }

    /// Corners of the triangle of the hit, as it was tested.
    pub fn corners(&self) -> Option<[Point; 3]> {
        self.best.as_ref().map(|met| met.corners)
    }

    /// The hit record: divides and maps.
    pub fn record(&self) -> Option<Hit> {
        Some(self.best.as_ref()?.record(self.levels, self.t))
    }

    /// The same in the world, with what pictures need beyond it. `ray` is the one that was traced.
    pub fn surface(&self, ray: &ModelRay) -> Option<SurfaceHit> {
        Some(self.best.as_ref()?.surface(self.levels, self.t, ray))
    }
}

/// Code of the normal of a triangle with these corners, as [`SurfaceHit::plane`].
pub(super) fn plane(corners: [[f64; 3]; 3]) -> u32 {
    let [p0, p1, p2] = corners.map(DVec3::from_array);
    // Products of coordinates of 32 bits are far below the largest f32.
    encode_normal((p1 - p0).cross(p2 - p0).as_vec3().to_array()).unwrap_or(SurfaceHit::NO_PLANE)
}

impl ClosestHit {
    /// The same, with where rays start that leave it: `departure` of the hit and the corners of its triangle.
    pub fn landing(&self, ray: &ModelRay, departure: impl FnOnce(&Hit, &[Point; 3]) -> Departure) -> Option<Landing> {
        let (hit, corners) = (self.record()?, self.corners()?);
        let surface = SurfaceHit::new(ray, &hit, plane(corners.map(|p| p.get().map(|c| c as f64))));
        Some(Landing { surface, departure: departure(&hit, &corners) })
    }
}

impl HitSink for ClosestHit {
    #[inline(always)]
    fn t_max(&self) -> RayT {
        self.t
    }

    #[inline(always)]
    fn offer(&mut self, id: TriangleId, corners: &[Point; 3], test: &tri_test::Out, below: &Below) {
        let t = Met::t(test, below);
        if t < self.range[0] || t > self.range[1] {
            return;
        }
        let select = HitSelect::eval(&hit_select::In {
            levels: U::new(u64::from(self.levels)),
            known: self.best.is_some(),
            best_t: self.t,
            best_front: self.best.as_ref().is_some_and(|met| met.test.front),
            best_id: self.id,
            t,
            front: test.front,
            tree: U::new(u64::from(id.tree)),
            level: U::new(u64::from(id.level)),
            node: U::new(u64::from(id.node)),
        });
        if select.closer {
            (self.t, self.id) = (t, select.id);
            self.best = Some(Met { id, corners: *corners, test: *test, below: *below });
        }
    }

    fn found(&self) -> bool {
        self.best.is_some()
    }

    #[inline(always)]
    fn is_done(&self) -> bool {
        self.any && self.best.is_some()
    }
}

/// Where rays start that leave a surface, and what they need of the rays before them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// The exact point.
    pub start: Start,
    /// Corners of the triangle that was hit, as it was tested.
    pub corners: [Point; 3],
    /// Who decides about the level of detail around it; none where no ray decides, or each ray for itself.
    pub prior: Option<Prior>,
    /// A third ray had decided about an edge there, and was dropped ([`Prior::after`]).
    pub crowded: bool,
    /// Nothing as near as so many units counts for rays from here: by so much what was hit may be off, where it only stands for the surface.
    pub clear: u32,
}

/// What a ray met whose path may go on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// In the world.
    pub surface: SurfaceHit,
    /// For the rays after it.
    pub departure: Departure,
}

/// Counts all crossings of the surface: for a closed surface and a ray that starts outside, `front` equals `back`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Crossings {
    /// Front faces met.
    pub front: u32,
    /// Back faces met.
    pub back: u32,
}

impl HitSink for Crossings {
    #[inline(always)]
    fn t_max(&self) -> RayT {
        RayT::MAX
    }

    #[inline(always)]
    fn offer(&mut self, _: TriangleId, _: &[Point; 3], test: &tri_test::Out, _: &Below) {
        if test.front {
            self.front += 1;
        } else {
            self.back += 1;
        }
    }

    fn found(&self) -> bool {
        self.front + self.back > 0
    }
}

/// Where a ray meets the surface, in the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceHit {
    /// Distance from the ray's origin in world units.
    pub distance: f64,
    /// Base triangle.
    pub tree: u32,
    /// Full-resolution triangle within its tree.
    pub full_node: u32,
    /// Barycentrics on the full-resolution triangle.
    pub full_bary: [f32; 3],
    /// Level of the triangle that was met. (With its byte a pixel that may be empty has 56.)
    pub level: u8,
    /// Its node on that level.
    pub node: u32,
    /// Barycentrics on that triangle.
    pub bary: [f32; 3],
    /// The front face was met.
    pub front: bool,
    /// Normal (p1 - p0) x (p2 - p0) of the triangle that was met, as it was morphed: a code of [`crate::format::decode_normal`], or
    /// [`Self::NO_PLANE`]. A side product for pictures: the hit record of the hardware has none.
    pub plane: u32,
}

impl SurfaceHit {
    /// No normal: a triangle without area. No code has such halves.
    pub const NO_PLANE: u32 = 0x8000_8000;

    /// A hit of the integer ray of a query on a triangle of that `plane`.
    pub fn new(ray: &ModelRay, hit: &Hit, plane: u32) -> Self {
        let weight = |b: Bary| (b.get() as f64 / BARY_ONE as f64) as f32;
        // Field widths are below 32 bits.
        let [tree, full_node, node] = [hit.tree.get(), hit.full_node.get(), hit.node.get()].map(|v| v as u32);
        Self {
            distance: ray.distance(hit.t.get()),
            tree,
            full_node,
            full_bary: [hit.full_b0, hit.full_b1, hit.full_b2].map(weight),
            level: hit.level.get() as u8, // four bits
            node,
            bary: [hit.b0, hit.b1, hit.b2].map(weight),
            front: hit.front,
            plane,
        }
    }
}

/// Frames keep one for each pixel.
const _: () = assert!(size_of::<Option<SurfaceHit>>() == 56);
