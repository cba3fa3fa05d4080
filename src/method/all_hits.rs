//! Every hit along a ray.

use super::hit::Met;
use super::{HitSink, SurfaceHit, TriangleId};
use crate::block::start_test::Below;
use crate::block::tri_test;
use crate::num::{Point, RayT};
use crate::rays::ModelRay;

/// Keeps every hit whose step of t counts: of a closed surface each crossing once, also where the ray goes through an edge or a vertex.
#[derive(Clone, Debug)]
pub struct AllHits {
    levels: u32,
    range: [RayT; 2],
    hits: Vec<(RayT, Met)>,
}

impl AllHits {
    /// Nothing yet, in a hierarchy of `levels` splits, of the steps of t of `ray`.
    pub fn of(levels: u32, ray: &ModelRay) -> Self {
        Self { levels, range: ray.range, hits: Vec::new() }
    }

    /// Adds them to `hits` in the world, in the order in which [`ClosestHit`](super::ClosestHit) prefers them: by t, at equal t fronts before backs, then by their triangles.
    /// `ray` is the one that was traced.
    pub fn surfaces(mut self, ray: &ModelRay, hits: &mut Vec<SurfaceHit>) {
        let finest = |id: TriangleId| u64::from(id.node) << (2 * (self.levels - id.level));
        self.hits.sort_by_key(|(t, met)| (*t, !met.test.front, met.id.tree, finest(met.id)));
        hits.extend(self.hits.iter().map(|(t, met)| met.surface(self.levels, *t, ray)));
    }
}

impl HitSink for AllHits {
    #[inline(always)]
    fn t_max(&self) -> RayT {
        self.range[1]
    }

    #[inline(always)]
    fn offer(&mut self, id: TriangleId, corners: &[Point; 3], test: &tri_test::Out, below: &Below) {
        let t = Met::t(test, below);
        if t >= self.range[0] && t <= self.range[1] {
            self.hits.push((t, Met { id, corners: *corners, test: *test, below: *below }));
        }
    }

    fn found(&self) -> bool {
        !self.hits.is_empty()
    }
}
