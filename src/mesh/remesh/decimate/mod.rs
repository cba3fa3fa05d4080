//! The base mesh: vertices of the original are removed one after the other, about in the order of their quadric errors, as long as the original still lies
//! over what is left like a field of heights.
//!
//! A vertex is removed by pulling it along an edge into a neighbour, which stays where it is, so that base vertices are vertices of the
//! original. Each triangle of the mesh in the making knows which triangles of the original lie over it. A removal is legal if
//!
//! - the surface stays as it is connected, and feature lines are shortened only along themselves;
//! - no triangle turns away from the original at its corners;
//! - every triangle of the original that changes hands faces the same way as the triangle that gets it, and is not far from it.
//!
//! So thin parts keep the vertices that hold them apart: a horn without its tip would have triangles of both its sides over one triangle.

mod legal;
mod quadric;
mod state;

use super::super::distance::Vec3;
use super::source::Source;
use legal::Changed;
use quadric::{Cost, Quadric};
pub(super) use state::Goal;
use state::{Known, Mesh, other};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// Triangles of the original known over each triangle, at most, ...
const MOST_OVER: usize = 8;
/// ... and over all, as soon as that is more: enough to tell how the original faces.
const MOST_OVER_ALL: usize = 1 << 15;

/// On the way to a base mesh it is remembered where it has this many triangles, and each time that it has half as many: the first time counts
/// as half way.
const HALF_WAY: usize = 1 << 13;
/// So many times.
const STAGES: usize = 4;

/// Weight of the square of the length of what a removal pulls, beside the quadric error: it decides where the surface is flat.
const SHORT: f64 = 1e-4;

/// Weight of planes through feature lines in the quadrics of their vertices.
const LINE_WEIGHT: f64 = 1.0;

/// What became of the original.
pub(super) struct Decimated {
    /// Base triangles as wedges of the original.
    pub wedges: Vec<[u32; 3]>,
    /// For each base triangle one of the original, of the same patch, and the very one if it is one.
    pub slots: Vec<u32>,
    /// For each base triangle those of the original that lie over it, or some of them.
    over: Vec<Vec<u32>>,
    /// When each vertex of the original was removed, counted from 1; 0 for those that are left.
    pub removed: Vec<u32>,
    /// Removals up to this one are remembered: to keep what they removed costs more.
    pub half_way: u32,
}

impl Decimated {
    /// Triangles of the original that lie over a base triangle, or some of them, and its slot.
    pub fn over(&self, triangle: usize) -> impl Iterator<Item = u32> {
        self.over[triangle].iter().copied().chain([self.slots[triangle]])
    }
}

/// Makes one base mesh after the other, each keeping more than the last.
pub(super) struct Decimator<'a> {
    source: &'a Source,
    /// The mesh on its way, at [`HALF_WAY`] and at each half of that: removals up to there are the same as long as what they removed need not be
    /// kept.
    stages: Vec<Mesh<'a>>,
}

impl<'a> Decimator<'a> {
    pub fn new(source: &'a Source) -> Decimator<'a> {
        Decimator { source, stages: Vec::new() }
    }

    /// Removes vertices, but none of `keep`, until one goal after the other is reached or allows no more.
    pub fn run(&mut self, goals: &[Goal], keep: &[bool]) -> Decimated {
        let least = goals.first().map_or(0, |goal| goal.triangles);
        let kept = |mesh: &Mesh| mesh.count >= least && mesh.removed.iter().zip(keep).all(|(&removed, &keep)| removed == 0 || !keep);
        let valid = self.stages.iter().take_while(|mesh| kept(mesh)).count();
        self.stages.truncate(valid);
        let mut mesh = self.stages.last().cloned().unwrap_or_else(|| Mesh::new(self.source));
        if let Some(first) = goals.first() {
            for stage in self.stages.len()..STAGES {
                let triangles = HALF_WAY >> stage;
                if triangles <= first.triangles {
                    break;
                }
                mesh.run(&Goal { triangles, ..*first }, keep);
                mesh.queue = BinaryHeap::new();
                self.stages.push(mesh.clone());
                if mesh.count > triangles {
                    break;
                }
            }
        }
        // If it does not even come that far, none is dearer than another.
        let half_way = self.stages.first().filter(|mesh| mesh.count <= HALF_WAY).map_or(0, |mesh| mesh.removals);
        goals.iter().for_each(|goal| mesh.run(goal, keep));
        let left: Vec<usize> = (0..mesh.alive.len()).filter(|&t| mesh.alive[t]).collect();
        Decimated {
            wedges: left.iter().map(|&t| mesh.wedges[t]).collect(),
            slots: left.iter().map(|&t| t as u32).collect(),
            over: left.iter().map(|&t| std::mem::take(&mut mesh.over[t])).collect(),
            removed: mesh.removed,
            half_way,
        }
    }
}

/// Where a vertex may be pulled.
enum Freedom {
    /// It stays.
    None,
    /// Along its feature line.
    Line,
    /// Into any neighbour.
    Any,
}

impl<'a> Mesh<'a> {
    fn new(source: &'a Source) -> Mesh<'a> {
        let (vertices, count) = (source.positions.len(), source.wedges.len());
        let triangles: Vec<[u32; 3]> = source.triangles();
        let mut around = vec![Vec::with_capacity(6); vertices];
        let mut quadrics = vec![Quadric::default(); vertices];
        let mut middles = Vec::with_capacity(count);
        for (tri, t) in triangles.iter().zip(0u32..) {
            let [a, b, c] = tri.map(|v| source.positions[v as usize]);
            let plane = Quadric::plane(a, source.face_normal[t as usize], (b - a).cross(c - a).length() / 2.0);
            for &v in tri {
                around[v as usize].push(t);
                quadrics[v as usize].add(&plane);
            }
            middles.push((a + b + c) / 3.0);
        }
        let mut mesh = Mesh {
            source,
            keep: vec![false; vertices],
            triangles,
            wedges: source.wedges.clone(),
            alive: vec![true; count],
            count,
            over: (0..count as u32).map(|t| vec![t]).collect(),
            around,
            lines: source.feature.clone(),
            quadrics,
            own_cost: Vec::new(),
            queue: BinaryHeap::new(),
            known: vec![Known::Nothing; vertices],
            removed: vec![0; vertices],
            removals: 0,
            middles: Arc::new(middles),
        };
        mesh.add_line_quadrics();
        mesh.own_cost = (0..vertices as u32).map(|v| mesh.quadrics[v as usize].at(mesh.at(v))).collect();
        mesh
    }

    /// Planes through feature lines, upright on the triangles beside them.
    fn add_line_quadrics(&mut self) {
        for u in 0..self.lines.len() {
            for &v in self.lines[u].iter().filter(|&&v| v as usize > u) {
                let (a, b) = (self.at(u as u32), self.at(v));
                for &t in self.around[u].iter().filter(|&&t| self.triangles[t as usize].contains(&v)) {
                    let normal = (b - a).cross(self.source.face_normal[t as usize]).normalize_or_zero();
                    let plane = Quadric::plane(a, normal, LINE_WEIGHT * (b - a).length_squared());
                    self.quadrics[u].add(&plane);
                    self.quadrics[v as usize].add(&plane);
                }
            }
        }
    }

    fn at(&self, v: u32) -> Vec3 {
        self.source.positions[v as usize]
    }

    fn run(&mut self, goal: &Goal, keep: &[bool]) {
        self.queue.clear();
        self.known.fill(Known::Nothing);
        self.keep = keep.to_vec();
        for v in 0..self.around.len() as u32 {
            self.push(v);
        }
        while self.count > goal.triangles {
            let Some(Reverse((_, u))) = self.queue.pop() else { break };
            if std::mem::replace(&mut self.known[u as usize], Known::Nothing) == Known::Stale {
                self.push(u);
                continue;
            }
            for (_, v) in self.ways(u) {
                if let Some((changed, shares)) = self.check(u, v, goal) {
                    self.remove(u, v, &changed, shares);
                    break;
                }
            }
        }
    }

    fn push(&mut self, u: u32) {
        let cost = |v: &u32| self.cost(u, *v);
        let best = match self.freedom(u) {
            Freedom::None => return,
            Freedom::Line => self.lines[u as usize].iter().map(cost).fold(f64::INFINITY, f64::min),
            // In each triangle the corner after it: on a border the last neighbour is left out, but then it is on a line.
            Freedom::Any => {
                self.around[u as usize].iter().map(|&t| cost(&other(self.triangles[t as usize], u)[0])).fold(f64::INFINITY, f64::min)
            }
        };
        if best.is_finite() {
            self.queue.push(Reverse((Cost(best), u)));
            self.known[u as usize] = Known::Cost;
        }
    }

    fn freedom(&self, u: u32) -> Freedom {
        match self.source.feature[u as usize].len() {
            _ if self.keep[u as usize] => Freedom::None,
            0 => Freedom::Any,
            2 => Freedom::Line,
            // Where lines end or meet.
            _ => Freedom::None,
        }
    }

    /// Neighbours that `u` may be pulled into, as far as feature lines are concerned, with their costs, cheapest first.
    fn ways(&self, u: u32) -> Vec<(f64, u32)> {
        let to: Vec<u32> = match self.freedom(u) {
            Freedom::None => return Vec::new(),
            Freedom::Line => self.lines[u as usize].clone(),
            Freedom::Any => self.neighbours(u),
        };
        let mut ways: Vec<(f64, u32)> = to.into_iter().map(|v| (self.cost(u, v), v)).collect();
        ways.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        ways
    }

    fn cost(&self, u: u32, v: u32) -> f64 {
        let p = self.at(v);
        let q = &self.quadrics[u as usize];
        // Where the surface is flat, short edges go first, and long thin triangles last.
        let length = (p - self.at(u)).length_squared();
        q.at(p) + self.own_cost[v as usize] + SHORT * length * length
    }

    /// In order, each once.
    fn neighbours(&self, u: u32) -> Vec<u32> {
        let mut all: Vec<u32> = self.around[u as usize].iter().flat_map(|&t| self.triangles[t as usize]).filter(|&v| v != u).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    fn remove(&mut self, u: u32, v: u32, changed: &[Changed], shares: Vec<Vec<u32>>) {
        let new_wedges: Vec<Option<u32>> = changed.iter().map(|c| self.continuation(c.triangle, u, v)).collect();
        let around = std::mem::take(&mut self.around[u as usize]);
        for &t in around.iter().filter(|&&t| self.triangles[t as usize].contains(&v)) {
            self.alive[t as usize] = false;
            self.count -= 1;
            self.over[t as usize] = Vec::new();
            for w in self.triangles[t as usize].into_iter().filter(|&w| w != u) {
                self.around[w as usize].retain(|&s| s != t);
            }
        }
        for ((c, share), wedge) in changed.iter().zip(shares).zip(new_wedges) {
            let t = c.triangle as usize;
            if let (Some(k), Some(wedge)) = (self.triangles[t].iter().position(|&w| w == u), wedge) {
                self.triangles[t][k] = v;
                self.wedges[t][k] = wedge;
            }
            self.over[t] = thinned(share, MOST_OVER.max(MOST_OVER_ALL / self.count.max(1)));
            self.around[v as usize].push(c.triangle);
        }
        if let [a, b] = self.lines[u as usize][..] {
            let other = if a == v { b } else { a };
            for (at, new) in [(v, other), (other, v)] {
                self.lines[at as usize].iter_mut().filter(|w| **w == u).for_each(|w| *w = new);
            }
            self.lines[u as usize].clear();
        }
        let quadric = self.quadrics[u as usize];
        self.quadrics[v as usize].add(&quadric);
        self.own_cost[v as usize] = self.quadrics[v as usize].at(self.at(v));
        self.removals += 1;
        self.removed[u as usize] = self.removals;
        for w in self.neighbours(v).into_iter().chain([v]) {
            match self.known[w as usize] {
                Known::Nothing => self.push(w),
                Known::Cost | Known::Stale => self.known[w as usize] = Known::Stale,
            }
        }
    }
}

/// At most `most` of them, evenly.
fn thinned(mut all: Vec<u32>, most: usize) -> Vec<u32> {
    if all.len() > most {
        let step = all.len() as f64 / most as f64;
        all = (0..most).map(|k| all[(k as f64 * step) as usize]).collect();
    }
    all
}
