//! After a split: second places for vertices beside the surface or in triangles that face away from it.
//!
//! A vertex looks at the triangles around it and tries the surface near itself and near their middle. It moves only if that turns the
//! triangles further towards the surface or, if none needs that, brings it onto the surface. One vertex moves at a time, in a fixed order.
//! Vertices of the base mesh move too, but nothing on a feature line or on a triangle of the original's own does.

use super::super::distance::Vec3;
use super::super::lattice::{self, LatticePoint};
use super::folds;
use super::project::{Method, Point};
use super::split::{Splitter, side_point, triangles};
use rayon::prelude::*;

/// Passes over the vertices in question after each split, and as many with smoothing.
const PASSES: usize = 16;

/// Passes over the vertices of finest triangles that are bent away from the original.
const STRAIGHTEN: usize = 8;

/// Those are bent that turn from it by more than this cosine: 60 degrees.
const STRAIGHT: f64 = 0.5;

/// A triangle faces the surface if the cosine between its normal and the sum of those at its corners is at least this.
const FACING: f64 = 0.3;

/// How far the surface is looked for, in mean lengths of the edges around.
const REACH: f64 = 6.0;

/// A move must gain this much in cosines, or the passes would go on for nothing.
const LEAST: f64 = 1e-3;

/// A vertex that may move, by a key that is the same in all trees that share it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    Vertex(u32),
    Tree(u32, LatticePoint),
    Edge(u32, u32),
}

/// The two other corners of a triangle around a vertex.
type Wing = [Point; 2];

impl Splitter<'_> {
    pub fn settle(&self, points: &mut [Point]) {
        self.settle_with(points, false);
        // Smoothing away from the surface spreads to later levels, so it is left for the end.
        if self.h == 1 {
            self.settle_with(points, true);
        }
    }

    fn settle_with(&self, points: &mut [Point], smooth: bool) {
        let mut dirty = vec![true; self.topology.triangles.len()];
        for _ in 0..PASSES {
            let mut places: Vec<Place> = (points.par_chunks_exact(self.len).zip(&dirty).enumerate())
                .filter(|(_, (_, dirty))| **dirty)
                .flat_map_iter(|(t, (tree, _))| self.unsettled(tree).into_iter().map(move |p| (t, p)))
                .filter_map(|(t, p)| self.place(t, p))
                .collect();
            places.par_sort_unstable();
            places.dedup();
            dirty.fill(false);
            for place in places {
                for t in self.move_one(points, place, smooth, &|p, wings| turn_away(p, wings)) {
                    dirty[t as usize] = true;
                }
            }
            if !dirty.contains(&true) {
                break;
            }
        }
    }

    /// Moves vertices of the finest triangles that are bent away from the original; for each tree the middles of those that still face away.
    pub fn straighten(&self, points: &mut [Point]) -> Vec<Vec<Vec3>> {
        let mut flipped = vec![Vec::new(); self.topology.triangles.len()];
        let mut dirty = vec![true; flipped.len()];
        let score = |p: Point, wings: &[Wing]| {
            let away = |&[a, b]: &Wing| match folds::facing(self.source, [p, a, b]) {
                cosine if cosine < 0.0 => 1.0 + STRAIGHT - cosine,
                cosine => (STRAIGHT - cosine).max(0.0),
            };
            wings.iter().map(away).sum()
        };
        for pass in 0..=STRAIGHTEN {
            let trees: Vec<usize> = (0..dirty.len()).filter(|&t| dirty[t]).collect();
            let found: Vec<(Vec<Vec3>, Vec<Place>)> = trees.par_iter().map(|&t| self.turned(points, t)).collect();
            let mut places = Vec::new();
            for (t, (middles, at)) in trees.into_iter().zip(found) {
                flipped[t] = middles;
                places.extend(at);
            }
            if pass == STRAIGHTEN || places.is_empty() {
                break;
            }
            places.sort_unstable();
            places.dedup();
            dirty.fill(false);
            for place in places {
                for t in self.move_one(points, place, true, &score) {
                    dirty[t as usize] = true;
                }
            }
        }
        flipped
    }

    /// The middles of a tree's finest triangles that face away from the original, and what may move of the vertices of bent ones.
    fn turned(&self, points: &[Point], t: usize) -> (Vec<Vec3>, Vec<Place>) {
        // A triangle of the original faces as that does.
        if self.topology.own[t].is_some() {
            return Default::default();
        }
        let tree = &points[t * self.len..][..self.len];
        let (mut middles, mut places) = (Vec::new(), Vec::new());
        for corners in triangles(self.m, 1) {
            let at = corners.map(|p| tree[self.index(p)]);
            let cosine = folds::facing(self.source, at);
            if cosine < 0.0 {
                middles.push(at.map(|p| p.position).iter().sum::<Vec3>() / 3.0);
            }
            if cosine < STRAIGHT {
                places.extend(corners.into_iter().filter_map(|p| self.place(t, p)));
            }
        }
        (middles, places)
    }

    /// Vertices of this level beside the surface or in a triangle that faces away from it.
    fn unsettled(&self, tree: &[Point]) -> Vec<LatticePoint> {
        let mut found = Vec::new();
        for corners in triangles(self.m, self.h) {
            let [a, b, c] = corners.map(|p| tree[self.index(p)]);
            let away = facing(a, [b, c]) < FACING;
            for (p, point) in corners.into_iter().zip([a, b, c]) {
                if away || (is_beside(&point)) {
                    found.push(p);
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    fn place(&self, t: usize, p: LatticePoint) -> Option<Place> {
        if self.is_inner(p) {
            return self.topology.own[t].is_none().then_some(Place::Tree(t as u32, p));
        }
        if let Some(k) = lattice::root(self.levels).iter().position(|&c| c == p) {
            let v = self.topology.triangles[t][k];
            return self.topology.movable[v as usize].then_some(Place::Vertex(v));
        }
        let (edge, s) = self.edge_place(t, p);
        (!self.topology.edges[edge as usize].own).then_some(Place::Edge(edge, s))
    }

    /// The trees of a vertex that was moved; none if it was not.
    fn move_one(&self, points: &mut [Point], place: Place, smooth: bool, turn: &dyn Fn(Point, &[Wing]) -> f64) -> Vec<u32> {
        let spots: Vec<(u32, LatticePoint)> = match place {
            Place::Vertex(v) => {
                let around = &self.topology.around[v as usize];
                around.iter().map(|&(t, k)| (t, lattice::root(self.levels)[k])).collect()
            }
            Place::Tree(t, p) => vec![(t, p)],
            Place::Edge(edge, s) => {
                let uses = &self.topology.edges[edge as usize].uses;
                uses.iter().map(|&(t, k)| (t, side_point(self.m, k, self.topology.sides[t as usize][k].1, s))).collect()
            }
        };
        let index = |(t, p): (u32, LatticePoint)| t as usize * self.len + self.index(p);
        let seen = &*points;
        let wings: Vec<Wing> =
            spots.iter().flat_map(|&(t, p)| self.around(p).map(move |w| w.map(|q| seen[t as usize * self.len + self.index(q)]))).collect();
        let now = points[index(spots[0])];
        let patch = Some(self.topology.patches[spots[0].0 as usize]);
        let choices = match place {
            Place::Edge(edge, s) if !self.topology.edges[edge as usize].smooth => self.along_line(points, edge, s),
            _ => self.choices(now, &wings, patch, smooth),
        };
        let Some(point) = best(now, choices, &wings, turn) else { return Vec::new() };
        spots.iter().for_each(|&spot| points[index(spot)] = point);
        spots.into_iter().map(|spot| spot.0).collect()
    }

    /// Pairs of neighbours that make triangles with `p`, inside the tree.
    fn around(&self, (i, j): LatticePoint) -> impl Iterator<Item = [LatticePoint; 2]> + use<> {
        const RING: [(i64, i64); 6] = [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)];
        let (m, h) = (i64::from(self.m), i64::from(self.h));
        let at = move |(di, dj): (i64, i64)| {
            let (x, y) = (i64::from(i) + di * h, i64::from(j) + dj * h);
            (x >= 0 && y >= 0 && x + y <= m).then_some((x as u32, y as u32))
        };
        (0..6).filter_map(move |k| Some([at(RING[k])?, at(RING[(k + 1) % 6])?]))
    }

    /// On a feature line: straight between the neighbours.
    fn along_line(&self, points: &[Point], edge: u32, s: u32) -> Vec<Point> {
        let (t, k) = self.topology.edges[edge as usize].uses[0];
        let forward = self.topology.sides[t as usize][k].1;
        let at = |s: u32| points[t as usize * self.len + self.index(side_point(self.m, k, forward, s))].position;
        let position = (at(s - self.h) + at(s + self.h)) / 2.0;
        vec![Point::plain(position, Method::Half)]
    }

    /// Places on the surface near the vertex and near the middle of the triangles around, places half way there, and that middle.
    fn choices(&self, now: Point, wings: &[Wing], patch: Option<u32>, smooth: bool) -> Vec<Point> {
        let count = wings.len() as f64;
        let middle = wings.iter().map(|[a, b]| (a.position + b.position) / 2.0).sum::<Vec3>() / count;
        let reach = REACH * wings.iter().map(|[a, b]| (b.position - a.position).length()).sum::<f64>() / count;
        let face = |&[a, b]: &Wing| (a.position - now.position).cross(b.position - now.position).normalize_or_zero();
        let direction = wings.iter().map(|w| face(w) + w[0].normal + w[1].normal).sum::<Vec3>();
        let accept =
            |t: u32| patch.is_none_or(|p| self.source.patch[t as usize] == p) && self.source.face_normal[t as usize].dot(direction) > 0.0;
        let on_surface = |p: Vec3| {
            let hit = self.source.target.closest(p, reach, accept)?;
            Some(Point::on(self.source, &hit, Method::Closest))
        };
        let (near, central) = (on_surface(now.position), on_surface(middle));
        let between = |to: Point| to.halfway(now.position);
        let off = Point { position: middle, method: Method::Midpoint, ..central.or(near).unwrap_or(now) };
        [near, central, near.map(between), central.map(between), smooth.then_some(off)].into_iter().flatten().collect()
    }
}

/// The best of `choices` by how far triangles `turn` away, if it is better than `now`.
fn best(now: Point, choices: Vec<Point>, wings: &[Wing], turn: &dyn Fn(Point, &[Wing]) -> f64) -> Option<Point> {
    let scored = choices.into_iter().map(|c| (c, turn(c, wings)));
    let (best, least) = scored.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let turn_now = turn(now, wings);
    let arrives = is_beside(&now) && !is_beside(&best) && least <= turn_now;
    (arrives || least < turn_now - LEAST).then_some(best)
}

fn is_beside(p: &Point) -> bool {
    matches!(p.method, Method::Half | Method::Midpoint)
}

/// By how much the triangles around a vertex miss facing the surface, in sum.
fn turn_away(p: Point, wings: &[Wing]) -> f64 {
    wings.iter().map(|&w| (FACING - facing(p, w)).max(0.0)).sum()
}

/// Cosine between a triangle's normal and the sum of those of the surface at its corners; 1 if there is no saying.
fn facing(p: Point, [a, b]: Wing) -> f64 {
    let normal = (a.position - p.position).cross(b.position - p.position);
    let surface = p.normal + a.normal + b.normal;
    let size = normal.length() * surface.length();
    if size > 0.0 { normal.dot(surface) / size } else { 1.0 }
}
