//! The method as a plain recursion in exact arithmetic, with every rounding that `docs/numbers.md` states and no other.
//!
//! A node of level n < N serves if its three edge states are 0, a node of level N always; otherwise its three inserted vertices
//! are moved towards their edges' midpoints and its four children are visited. Every triangle that serves is tested; the closest hit is
//! the least (t, id). Boxes only spare work: see `cull`.

use super::{
    cull::{Bounds, Boxes},
    fine, hit_map, lod,
    paths::{self, Leg},
    predicates::{self, Fractions, Meeting, Vector},
    ties::Ties,
};
use crate::{
    mesh::{
        Hierarchy,
        lattice::{self, LatticePoint},
    },
    num::Ray,
};
use std::borrow::Cow;
use std::cell::RefCell;

/// The closest hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExactHit {
    /// Ray parameter in steps of 2^-32, 35 bits.
    pub t: u64,
    /// Base triangle.
    pub tree: u32,
    /// Level of the node that was hit.
    pub level: u32,
    /// The node on its level.
    pub node: u32,
    /// Barycentrics on that node's triangle, 2^31 = 1.
    pub bary: [u32; 3],
    /// The full-resolution triangle within the tree, 0 to 4^N - 1.
    pub full_node: u32,
    /// Barycentrics on the full-resolution triangle, 2^31 = 1.
    pub full_bary: [u32; 3],
    /// The determinant was negative: the ray runs against the normal (p1 - p0) x (p2 - p0).
    pub front: bool,
}

impl ExactHit {
    /// The order of hits: smaller t; of equal t the front before the back; then the smaller first full-resolution triangle.
    fn order(&self, levels: u32) -> (u64, u8, u64) {
        let side = if self.front { 0 } else { 1 };
        (self.t, side, (u64::from(self.tree) << (2 * levels)) + (u64::from(self.node) << (2 * (levels - self.level))))
    }
}

/// How often a ray crosses the surface, by the sign of the determinant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Crossings {
    /// Crossings with a negative determinant.
    pub front: u32,
    /// Crossings with a positive determinant.
    pub back: u32,
}

/// A triangle that serves, with its morphed corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Served {
    /// Base triangle.
    pub tree: u32,
    /// Level of the node.
    pub level: u32,
    /// The node on its level.
    pub node: u32,
    /// Corners in units.
    pub corners: [Vector; 3],
}

/// The exact traverser of one model.
pub struct Exact<'a> {
    model: Cow<'a, Hierarchy>,
    boxes: Option<Boxes>,
}

impl Exact<'static> {
    /// The same as [`Exact::new`], for whoever has no place to keep the model in.
    pub fn owning(model: Hierarchy) -> Self {
        Self { boxes: Some(Boxes::new(&model)), model: Cow::Owned(model) }
    }
}

impl<'a> Exact<'a> {
    /// For a valid model: points on their levels' grids and bounds that hold.
    pub fn new(model: &'a Hierarchy) -> Self {
        Self { model: Cow::Borrowed(model), boxes: Some(Boxes::new(model)) }
    }

    /// The same without boxes: every triangle of the surface is tested.
    pub fn without_culling(model: &'a Hierarchy) -> Self {
        Self { model: Cow::Borrowed(model), boxes: None }
    }

    /// The closest hit on the surface that the ray's cone asks for.
    pub fn trace(&self, ray: &Ray) -> Option<ExactHit> {
        self.closest(ray, true).map(|(hit, _)| hit)
    }

    /// The closest hit of `ray` on the surface that `packet` asks for, rays of which it is one: each edge is as open as the ray that wants it the most open has it.
    pub fn trace_in_packet(&self, ray: &Ray, packet: &[Ray]) -> Option<ExactHit> {
        let others: Vec<_> = packet.iter().map(viewer).collect();
        self.closest_of(&Walk { others: &others, ..self.walk(ray, true) }).map(|(hit, _)| hit)
    }

    /// All its crossings of that surface.
    pub fn crossings_in_packet(&self, ray: &Ray, packet: &[Ray]) -> Crossings {
        let others: Vec<_> = packet.iter().map(viewer).collect();
        count(&Walk { others: &others, ..self.walk(ray, true) })
    }

    /// The same as [`Self::trace`] among hits from the first to the last of these steps of t.
    pub fn trace_between(&self, ray: &Ray, range: [u64; 2]) -> Option<ExactHit> {
        self.closest_between(&self.walk(ray, true), range).map(|(hit, _)| hit)
    }

    /// The same as [`Self::trace`] with the hit's distance and barycentrics before they were rounded.
    pub fn trace_exactly(&self, ray: &Ray) -> Option<(ExactHit, Fractions)> {
        self.closest(ray, true)
    }

    /// The closest hit of `ray` where it leaves the surface at the end of `before`, the rays of a path so far; its origin is that point's, rounded down.
    pub fn trace_after(&self, before: &[Leg], ray: &Ray) -> Option<ExactHit> {
        self.closest_of(&self.walk_after(before, ray)).map(|(hit, _)| hit)
    }

    /// All its crossings.
    pub fn crossings_after(&self, before: &[Leg], ray: &Ray) -> Crossings {
        count(&self.walk_after(before, ray))
    }

    /// Another triangle of its surface than the one it leaves, in another plane, holds the point that `ray` starts from.
    pub fn starts_on_another(&self, before: &[Leg], ray: &Ray) -> bool {
        let Some(last) = before.last() else { return false };
        let walk = Walk { boxes: None, ..self.walk_after(before, ray) };
        let mut found = false;
        walk.trees(&mut |tree| walk.tree(tree, &mut |at| found |= fine::holds_another(last.start, last.corners, at.corners)));
        found
    }

    /// The leg of a path that `ray` makes with its hit, to be added to those before it.
    pub fn leg(&self, before: &[Leg], ray: &Ray, hit: &ExactHit) -> Leg {
        let walk = self.walk_after(before, ray);
        let corners = walk.corners(hit);
        Leg { viewer: viewer(ray), tree: hit.tree, base: walk.base(hit.tree), corners, start: fine::inside(corners, hit.bary) }
    }

    /// How near this ray comes to deciding otherwise anywhere (see [`Ties`]).
    pub fn ties(&self, ray: &Ray) -> Ties {
        let watch = RefCell::new(Ties::default());
        let mut met = Vec::new();
        Walk { watch: Some(&watch), ..self.walk(ray, true) }.run(&mut |_, hit| met.push(hit.fractions()));
        watch.into_inner().with_hits(&met)
    }

    /// The closest hit on the full-resolution surface.
    pub fn trace_full(&self, ray: &Ray) -> Option<ExactHit> {
        self.closest(ray, false).map(|(hit, _)| hit)
    }

    /// All crossings of the surface that the ray's cone asks for.
    pub fn crossings(&self, ray: &Ray) -> Crossings {
        count(&self.walk(ray, true))
    }

    /// The whole surface that the ray's cone asks for, in tree order.
    pub fn surface(&self, ray: &Ray) -> Vec<Served> {
        let mut surface = Vec::new();
        let walk = Walk { boxes: None, ..self.walk(ray, true) };
        for tree in 0..self.model.triangles.len() as u32 {
            walk.tree(tree, &mut |served| surface.push(served));
        }
        surface
    }

    /// The ray's origin lies on the surface that its cone asks for: in a triangle, on an edge or at a vertex.
    pub fn starts_on_surface(&self, ray: &Ray) -> bool {
        let x = ray.origin.get();
        self.surface(ray).iter().any(|served| {
            let [a, b, c] = served.corners.map(|p| predicates::sub(p, x));
            predicates::holds_origin(a, b, c)
        })
    }

    fn walk(&self, ray: &Ray, lod: bool) -> Walk<'_> {
        Walk { model: &self.model, boxes: self.boxes.as_ref(), viewer: viewer(ray), others: &[], before: &[], only: None, lod, watch: None }
    }

    fn walk_after<'b>(&'b self, before: &'b [Leg], ray: &Ray) -> Walk<'b> {
        Walk { before, ..self.walk(ray, true) }
    }

    fn closest(&self, ray: &Ray, lod: bool) -> Option<(ExactHit, Fractions)> {
        self.closest_of(&self.walk(ray, lod))
    }

    fn closest_of(&self, walk: &Walk<'_>) -> Option<(ExactHit, Fractions)> {
        self.closest_between(walk, [0, u64::MAX])
    }

    fn closest_between(&self, walk: &Walk<'_>, [first, last]: [u64; 2]) -> Option<(ExactHit, Fractions)> {
        let levels = self.model.levels;
        let mut best: Option<(ExactHit, Fractions)> = None;
        walk.run(&mut |at, met| {
            let bary = met.bary();
            let (full_node, full_bary) = hit_map::descend(at.node, bary, levels - at.level);
            let Served { tree, level, node, .. } = at;
            let hit = ExactHit { t: met.t(), tree, level, node, bary, full_node, full_bary, front: met.front };
            if hit.t < first || hit.t > last {
                return;
            }
            if best.is_none_or(|(b, _)| hit.order(levels) < b.order(levels)) {
                best = Some((hit, met.fractions()));
            }
        });
        best
    }
}

fn viewer(ray: &Ray) -> lod::Viewer {
    lod::Viewer { origin: ray.origin.get(), direction: ray.direction.get(), cone: ray.cone }
}

/// Parts of a lattice point's base corners, in 2^-N.
fn weights(levels: u32, (i, j): LatticePoint) -> [u32; 3] {
    [(1 << levels) - i - j, i, j]
}

fn count(walk: &Walk<'_>) -> Crossings {
    let mut count = Crossings::default();
    walk.run(&mut |_, met| if met.front { count.front += 1 } else { count.back += 1 });
    count
}

/// One ray's recursion.
struct Walk<'a> {
    model: &'a Hierarchy,
    boxes: Option<&'a Boxes>,
    viewer: lod::Viewer,
    /// The rays that decide with it, if it is one of a packet.
    others: &'a [lod::Viewer],
    /// The rays before it, if it leaves the surface.
    before: &'a [Leg],
    /// Only what leads to this node, a level and its number there.
    only: Option<(u32, u32)>,
    /// False: full resolution everywhere.
    lod: bool,
    /// Where near ties are noted.
    watch: Option<&'a RefCell<Ties>>,
}

impl Walk<'_> {
    /// Calls `hit` for every triangle of the surface that the ray meets.
    fn run(&self, hit: &mut impl FnMut(Served, Meeting)) {
        let (x, d) = (self.viewer.origin, self.viewer.direction);
        if let Some(last) = self.before.last() {
            let mut test = |at: Served| {
                // The exact test takes long.
                if Bounds::EMPTY.missed_by(x, 1, d, &at.corners) {
                    return;
                }
                if let Some(met) = fine::meet(last.start, d, at.corners) {
                    hit(at, met);
                }
            };
            return self.trees(&mut |tree| self.tree(tree, &mut test));
        }
        let mut test = |at: Served| {
            let [a, b, c] = at.corners.map(|p| predicates::sub(p, x));
            if let Some(watch) = self.watch {
                watch.borrow_mut().note_edge(predicates::closest_edge(d, a, b, c));
            }
            if let Some(met) = predicates::meet(d, a, b, c) {
                hit(at, met);
            }
        };
        self.trees(&mut |tree| self.tree(tree, &mut test));
    }

    /// Calls `visit` for each tree that the ray may meet.
    fn trees(&self, visit: &mut impl FnMut(u32)) {
        match self.boxes {
            Some(boxes) => boxes.trees(self.viewer.origin, self.slack(), self.viewer.direction, visit),
            None => (0..self.model.triangles.len() as u32).for_each(visit),
        }
    }

    /// By how much the ray's origin may lie beyond that of its viewer.
    fn slack(&self) -> i64 {
        i64::from(!self.before.is_empty())
    }

    /// Corners of a base triangle.
    fn base(&self, tree: u32) -> [Vector; 3] {
        lattice::root(self.model.levels).map(|p| self.point(tree, p))
    }

    /// Corners of the triangle of a hit, as this ray sees it.
    fn corners(&self, hit: &ExactHit) -> [Vector; 3] {
        let mut corners = [[0; 3]; 3];
        let whole = Walk { boxes: None, watch: None, only: Some((hit.level, hit.node)), ..*self };
        whole.tree(hit.tree, &mut |at| {
            if (at.level, at.node) == (hit.level, hit.node) {
                corners = at.corners;
            }
        });
        corners
    }

    /// Calls `serve` for the triangles of one tree.
    fn tree(&self, tree: u32, serve: &mut impl FnMut(Served)) {
        let places = lattice::root(self.model.levels);
        self.node(Served { tree, level: 0, node: 0, corners: places.map(|p| self.point(tree, p)) }, places, serve);
    }

    fn node(&self, at: Served, places: [LatticePoint; 3], serve: &mut impl FnMut(Served)) {
        let Served { tree, level, node, corners: p } = at;
        if self.only.is_some_and(|(to, number)| level <= to && number >> (2 * (to - level)) != node) {
            return;
        }
        if level == self.model.levels {
            return serve(at);
        }
        if self.boxes.is_some_and(|b| b.node(tree, level, node).missed_by(self.viewer.origin, self.slack(), self.viewer.direction, &p)) {
            return;
        }
        let s = self.states(&at, places);
        if s == [0; 3] {
            return serve(at);
        }
        let grid = self.model.levels - level - 1 + self.model.zeros;
        let stored = lattice::midpoints(places).map(|q| self.point(tree, q));
        // Edge i is opposite corner i.
        let q: [Vector; 3] = std::array::from_fn(|i| lod::inserted(p[(i + 1) % 3], p[(i + 2) % 3], stored[i], s[i], grid));
        let children = [[p[0], q[2], q[1]], [q[2], p[1], q[0]], [q[1], q[0], p[2]], q];
        for (k, corners) in (0..4).zip(children) {
            self.node(Served { tree, level: level + 1, node: 4 * node + k, corners }, lattice::child(places, k), serve);
        }
    }

    /// States of the edges (e0, e1, e2) of a node of a level below N.
    fn states(&self, at: &Served, places: [LatticePoint; 3]) -> [i64; 3] {
        if !self.lod {
            return [256; 3];
        }
        let codes = self.model.node_codes(at.tree as usize, at.level, places);
        std::array::from_fn(|i| {
            let bound = lod::displacement(self.model.bounds.scale, codes[i]);
            let viewer = self.decider(at.tree, i, [places[(i + 1) % 3], places[(i + 2) % 3]]);
            if let Some(watch) = self.watch {
                watch.borrow_mut().note_lod(lod::margin(viewer, at.corners[(i + 1) % 3], at.corners[(i + 2) % 3], bound));
            }
            let state = |viewer| lod::state(viewer, at.corners[(i + 1) % 3], at.corners[(i + 2) % 3], bound);
            self.others.iter().map(state).fold(state(viewer), i64::max)
        })
    }

    /// Who decides about edge `i` of a node, between these places.
    fn decider(&self, tree: u32, i: usize, ends: [LatticePoint; 2]) -> &lod::Viewer {
        if self.before.is_empty() {
            return &self.viewer;
        }
        // It lies on base edge i, opposite base corner i, if nothing of that corner is left at its ends.
        let on_base = ends.iter().all(|&end| weights(self.model.levels, end)[i] == 0);
        paths::decider(self.before, &self.viewer, tree, self.base(tree), on_base.then_some(i))
    }

    fn point(&self, tree: u32, at: LatticePoint) -> Vector {
        self.model.tree(tree as usize)[lattice::index(self.model.levels, at)].map(i64::from)
    }
}
