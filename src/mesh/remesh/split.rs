//! Levels of 1-to-4 splits over the base mesh, each tree in its own lattice.
//!
//! A point on a base edge is computed once and copied into every tree that shares the edge, so that it is the same there bit for bit.

use super::super::distance::Vec3;
use super::super::lattice::{self, LatticePoint};
use super::project::{Method, Point, insert};
use super::report::RemeshReport;
use super::source::Source;
use super::topology::{Edge, Topology};
use rayon::prelude::*;

/// Rounds of falling back at folded triangles. Points on feature lines stay until the others have had their turn, and then go last.
const ROUNDS: usize = 10;
const ROUNDS_BEFORE_LINES: usize = 3;

/// A child whose normal turns further from its parent's than this (cosine) is folded, ...
const FOLDED: f64 = 0.1;
/// ... and so is one that is smaller than this part of its parent (a flat split makes it a quarter).
const CRUSHED: f64 = 0.01;

/// Lattices of all trees, in one piece.
pub(super) struct Forest {
    pub levels: u32,
    pub positions: Vec<Vec3>,
    /// For each tree the middles of finest triangles that face away from the original.
    pub flipped: Vec<Vec<Vec3>>,
    points: Vec<Point>,
}

/// Corners of all triangles of a lattice of `m` steps whose triangles have sides of `step`.
pub(super) fn triangles(m: u32, step: u32) -> impl Iterator<Item = [LatticePoint; 3]> {
    (0..m).step_by(step as usize).flat_map(move |j| {
        (0..m - j).step_by(step as usize).flat_map(move |i| {
            let up = [(i, j), (i + step, j), (i, j + step)];
            let down = [(i, j + step), (i + step, j), (i + step, j + step)];
            [Some(up), (i + j + 2 * step <= m).then_some(down)].into_iter().flatten()
        })
    })
}

/// For a point inserted with half step `h`: the ends of its edge, and the third vertices of the triangles to the left and right of it.
fn stencil(m: u32, (i, j): LatticePoint, h: u32) -> (LatticePoint, LatticePoint, [Option<LatticePoint>; 2]) {
    let (x, y, h, m) = (i64::from(i), i64::from(j), i64::from(h), i64::from(m));
    let at = |dx: i64, dy: i64| (x + dx * h, y + dy * h);
    let [a, b, c, d] = match ((i / h as u32).is_multiple_of(2), (j / h as u32).is_multiple_of(2)) {
        (false, true) => [at(-1, 0), at(1, 0), at(-1, 2), at(1, -2)],
        (true, false) => [at(0, -1), at(0, 1), at(-2, 1), at(2, -1)],
        _ => [at(1, -1), at(-1, 1), at(-1, -1), at(1, 1)],
    };
    let inside = |(x, y): (i64, i64)| (x >= 0 && y >= 0 && x + y <= m).then_some((x as u32, y as u32));
    ((a.0 as u32, a.1 as u32), (b.0 as u32, b.1 as u32), [inside(c), inside(d)])
}

/// The middle of an edge of the original, or of one inside a triangle of it.
fn own_point(a: Point, b: Point) -> Point {
    Point { normal: (a.normal + b.normal).normalize_or_zero(), ..Point::plain((a.position + b.position) / 2.0, Method::Own) }
}

/// The point `s` steps along side `k` of a tree, counted from the edge's smaller end.
pub(super) fn side_point(m: u32, k: usize, forward: bool, s: u32) -> LatticePoint {
    let s = if forward { s } else { m - s };
    match k {
        0 => (m - s, s),
        1 => (0, m - s),
        _ => (s, 0),
    }
}

pub(super) fn split(source: &Source, topology: &Topology, levels: u32, progress: &dyn Fn(&str, u64, u64)) -> Forest {
    let len = lattice::len(levels);
    let mut points = vec![Point::default(); topology.triangles.len() * len];
    for (t, tree) in points.chunks_exact_mut(len).enumerate() {
        for (k, corner) in lattice::root(levels).into_iter().enumerate() {
            let wedge = topology.wedges[t][k] as usize;
            let position = source.positions[source.wedge_vertex[wedge] as usize];
            tree[lattice::index(levels, corner)] = Point { normal: source.wedge_normal[wedge], ..Point::plain(position, Method::Corner) };
        }
    }
    let splitter = |h| Splitter { source, topology, levels, len, m: 1 << levels, h };
    splitter(1 << levels).settle(&mut points);
    for level in 0..levels {
        progress("levels", level.into(), levels.into());
        let splitter = splitter(1 << (levels - level - 1));
        splitter.insert_all(&mut points);
        splitter.unfold(&mut points);
        splitter.settle(&mut points);
    }
    let flipped = splitter(1).straighten(&mut points);
    progress("levels", levels.into(), levels.into());
    let positions = points.par_iter().map(|p| p.position).collect();
    Forest { levels, positions, flipped, points }
}

/// One level's split.
pub(super) struct Splitter<'a> {
    pub source: &'a Source,
    pub topology: &'a Topology,
    pub levels: u32,
    pub len: usize,
    /// Lattice steps per side, and half the length of the sides that are split.
    pub m: u32,
    pub h: u32,
}

impl Splitter<'_> {
    pub fn index(&self, p: LatticePoint) -> usize {
        lattice::index(self.levels, p)
    }

    fn insert_all(&self, points: &mut [Point]) {
        let on_edges: Vec<Vec<Point>> = (self.topology.edges.par_iter())
            .map(|edge| {
                let start = if edge.line.is_some() { Method::Line } else { Method::Ray };
                self.steps().map(|s| self.edge_point(points, edge, s, start)).collect()
            })
            .collect();
        points.par_chunks_exact_mut(self.len).enumerate().for_each(|(t, tree)| {
            for (k, &(edge, forward)) in self.topology.sides[t].iter().enumerate() {
                for (s, &point) in self.steps().zip(&on_edges[edge as usize]) {
                    tree[self.index(side_point(self.m, k, forward, s))] = point;
                }
            }
            for j in (0..self.m).step_by(self.h as usize) {
                for i in (0..self.m - j).step_by(self.h as usize) {
                    let old = (i / self.h).is_multiple_of(2) && (j / self.h).is_multiple_of(2);
                    if !old && self.is_inner((i, j)) {
                        tree[self.index((i, j))] = self.inner_point(t, tree, (i, j), Method::Ray);
                    }
                }
            }
        });
    }

    /// Places of the points that this level inserts on a base edge.
    fn steps(&self) -> impl Iterator<Item = u32> {
        (self.h..self.m).step_by(2 * self.h as usize)
    }

    pub fn is_inner(&self, (i, j): LatticePoint) -> bool {
        i > 0 && j > 0 && i + j < self.m
    }

    fn inner_point(&self, t: usize, tree: &[Point], p: LatticePoint, method: Method) -> Point {
        let (a, b, _) = stencil(self.m, p, self.h);
        let (a, b) = (tree[self.index(a)], tree[self.index(b)]);
        if self.topology.own[t].is_some() {
            return own_point(a, b);
        }
        let direction = self.face_normals(tree, p) + a.normal + b.normal;
        insert(self.source, a, b, direction, Some(self.topology.patches[t]), method)
    }

    /// Sum of the unit normals of the tree's triangles beside the edge that is split at `p`.
    fn face_normals(&self, tree: &[Point], p: LatticePoint) -> Vec3 {
        let (a, b, [left, right]) = stencil(self.m, p, self.h);
        let at = |p| tree[self.index(p)].position;
        let normal = |a, b, c| (at(b) - at(a)).cross(at(c) - at(a)).normalize_or_zero();
        left.map_or(Vec3::ZERO, |c| normal(a, b, c)) + right.map_or(Vec3::ZERO, |d| normal(b, a, d))
    }

    fn edge_point(&self, points: &[Point], edge: &Edge, s: u32, method: Method) -> Point {
        let mut direction = Vec3::ZERO;
        for &(t, k) in &edge.uses {
            let forward = self.topology.sides[t as usize][k].1;
            direction += self.face_normals(self.tree(points, t), side_point(self.m, k, forward, s));
        }
        let (t, k) = edge.uses[0];
        let (tree, forward) = (self.tree(points, t), self.topology.sides[t as usize][k].1);
        let [a, b] = [s - self.h, s + self.h].map(|s| tree[self.index(side_point(self.m, k, forward, s))]);
        let middle = (a.position + b.position) / 2.0;
        match (&edge.line, method) {
            _ if edge.own && edge.smooth => own_point(a, b),
            _ if edge.own => Point::plain(middle, Method::Own),
            (Some(_), Method::Midpoint) => Point::plain(middle, method),
            (Some(line), _) => {
                let point = Point::plain(line.at(f64::from(s) / f64::from(self.m)), Method::Line);
                if method == Method::Half { point.halfway(middle) } else { point }
            }
            _ if edge.smooth => insert(self.source, a, b, direction + a.normal + b.normal, Some(self.topology.patches[t as usize]), method),
            _ => Point { normal: Vec3::ZERO, triangle: None, ..insert(self.source, a, b, direction, None, method) },
        }
    }

    fn tree<'p>(&self, points: &'p [Point], t: u32) -> &'p [Point] {
        &points[t as usize * self.len..][..self.len]
    }

    /// Finds children that turn away from their parents and moves their inserted vertices to the next best place, until there are none.
    fn unfold(&self, points: &mut [Point]) {
        let mut dirty = vec![true; self.topology.triangles.len()];
        for round in 0..ROUNDS {
            let lines = round >= ROUNDS_BEFORE_LINES;
            let folded: Vec<Vec<LatticePoint>> = (points.par_chunks_exact(self.len).zip(&dirty))
                .map(|(tree, &dirty)| if dirty { self.folded(tree, lines) } else { Vec::new() })
                .collect();
            let mut on_edges = Vec::new();
            for (t, folded) in folded.iter().enumerate() {
                dirty[t] = !folded.is_empty();
                on_edges.extend(folded.iter().filter(|&&p| !self.is_inner(p)).map(|&p| self.edge_place(t, p)));
            }
            on_edges.sort_unstable();
            on_edges.dedup();
            if folded.iter().all(Vec::is_empty) {
                break;
            }
            (points.par_chunks_exact_mut(self.len).zip(&folded).enumerate()).for_each(|(t, (tree, folded))| {
                for &p in folded.iter().filter(|&&p| self.is_inner(p)) {
                    let method = tree[self.index(p)].method.next();
                    tree[self.index(p)] = self.inner_point(t, tree, p, method);
                }
            });
            for (e, s) in on_edges {
                let edge = &self.topology.edges[e as usize];
                let (t, k) = edge.uses[0];
                let place = |t: u32, k: usize| {
                    let forward = self.topology.sides[t as usize][k].1;
                    t as usize * self.len + self.index(side_point(self.m, k, forward, s))
                };
                let point = self.edge_point(points, edge, s, points[place(t, k)].method.next());
                for &(t, k) in &edge.uses {
                    points[place(t, k)] = point;
                    dirty[t as usize] = true;
                }
            }
        }
    }

    /// Inserted vertices of folded children that have another place to go, each once.
    fn folded(&self, tree: &[Point], lines: bool) -> Vec<LatticePoint> {
        let at = |p| tree[self.index(p)].position;
        let normal = |[a, b, c]: [LatticePoint; 3]| (at(b) - at(a)).cross(at(c) - at(a));
        let mut found = Vec::new();
        for parent in triangles(self.m, 2 * self.h) {
            let whole = normal(parent);
            for k in 0..4 {
                let child = lattice::child(parent, k);
                let part = normal(child);
                let (size, whole_size) = (part.length(), whole.length());
                if part.dot(whole) < FOLDED * size * whole_size || size < CRUSHED * whole_size {
                    found.extend(child.into_iter().filter(|p| !parent.contains(p)));
                }
            }
        }
        let movable = |p: &LatticePoint| match tree[self.index(*p)].method {
            Method::Midpoint | Method::Own => false,
            Method::Line => lines,
            _ => true,
        };
        found.retain(movable);
        found.sort_unstable();
        found.dedup();
        found
    }

    /// The base edge that a point on the border of a tree is on, and how far from its smaller end.
    pub fn edge_place(&self, t: usize, (i, j): LatticePoint) -> (u32, u32) {
        let (k, s) = if j == 0 {
            (2, i)
        } else if i == 0 {
            (1, self.m - j)
        } else {
            (0, j)
        };
        let (edge, forward) = self.topology.sides[t][k];
        (edge, if forward { s } else { self.m - s })
    }
}

impl Forest {
    /// The triangle of the original and the barycentrics of the point that a lattice point stands for, if they are known.
    pub fn origin(&self, i: usize) -> Option<(u32, [f64; 3])> {
        let point = &self.points[i];
        Some((point.triangle?, point.barycentrics.map(f64::from)))
    }

    /// Points of tree `t` that were left beside the surface.
    pub fn strays(&self, t: usize) -> impl Iterator<Item = Vec3> {
        let len = lattice::len(self.levels);
        self.points[t * len..][..len].iter().filter(|p| matches!(p.method, Method::Half | Method::Midpoint)).map(|p| p.position)
    }

    /// Counts the ways in which points were placed, those on shared edges once.
    pub fn count_methods(&self, topology: &Topology, report: &mut RemeshReport) {
        let (m, len) = (1u32 << self.levels, lattice::len(self.levels));
        let mut count = |method| match method {
            Method::Corner => {}
            Method::Own => report.on_own_triangles += 1,
            Method::Line => report.on_feature_lines += 1,
            Method::Ray => report.projected_by_ray += 1,
            Method::Closest => report.by_closest_point += 1,
            Method::Half | Method::Midpoint => report.midpoints_kept += 1,
        };
        for tree in self.points.chunks_exact(len) {
            for j in 1..m {
                (1..m - j).for_each(|i| count(tree[lattice::index(self.levels, (i, j))].method));
            }
        }
        for edge in &topology.edges {
            let (t, k) = edge.uses[0];
            let tree = &self.points[t as usize * len..][..len];
            (1..m).for_each(|s| count(tree[lattice::index(self.levels, side_point(m, k, true, s))].method));
        }
    }
}
