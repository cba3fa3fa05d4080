//! A net of triangles, the net that Loop's rules split it into, and the points of the limit surface that its vertices go to.
//!
//! Weights (Loop, "Smooth subdivision surfaces based on triangles", 1987): a new vertex on edge (a, b) between the triangles (a, b, c) and (b, a, d) is 3/8 (a + b) + 1/8 (c + d); a
//! vertex v of n neighbours goes to (1 - n beta) v + beta times their sum, beta = (5/8 - (3/8 + cos(2 pi / n) / 4)^2) / n. Its limit is (1 - n chi) v + chi times their sum,
//! chi = 1 / (n + 3 / (8 beta)). Along curves (Hoppe and others, "Piecewise smooth surface reconstruction", 1994) both are those of a cubic B-spline: (a + b) / 2 and (a + 6 v + b) / 8, in
//! the limit (a + 4 v + b) / 6. Sums are taken in the order of edges and triangles, by one thread: results do not depend on how many there are.

use super::super::SharedEdges;
use super::{Rule, add, rules};
use std::f64::consts::TAU;

type Point = [f64; 3];

/// The vertices, edges and triangles of one level.
pub struct Net {
    pub positions: Vec<Point>,
    rules: Vec<Rule>,
    /// Indices of corners; children follow each other in the order of the hierarchy.
    pub triangles: Vec<[u32; 3]>,
    /// Of each triangle its edges, number k opposite corner k.
    sides: Vec<[u32; 3]>,
    /// Ends of edges. First those of more than two triangles, then those of one, then all others.
    edges: Vec<[u32; 2]>,
    /// How many edges have more than two triangles.
    forks: usize,
    /// How many have not two: they are on curves.
    curves: usize,
}

impl Net {
    /// The net of a clean mesh.
    pub fn new(positions: &[Point], triangles: &[[u32; 3]]) -> Self {
        let shared = SharedEdges::new(triangles);
        let is_fork = |uses: usize| uses > 2;
        let groups = [is_fork, |uses| uses == 1, |uses| uses == 2];
        let forks = shared.edges().filter(|uses| is_fork(uses.len())).count();
        let curves = shared.edges().filter(|uses| uses.len() != 2).count();
        let mut sides = vec![[0; 3]; triangles.len()];
        let mut edges = Vec::new();
        for uses in groups.iter().flat_map(|belongs| shared.edges().filter(|uses| belongs(uses.len()))) {
            uses.iter().for_each(|of| sides[of.tree as usize][usize::from(of.side)] = edges.len() as u32); // three for each triangle at most
            edges.push(uses[0].ends);
        }
        // Of each vertex every pair of neighbours that it makes a triangle with, both ways.
        let pairs = triangles.iter().flat_map(|&[a, b, c]| [[a, b, c], [a, c, b], [b, c, a], [b, a, c], [c, a, b], [c, b, a]]).collect();
        let rules = rules(positions.len(), pairs, &edges, curves);
        Self { positions: positions.to_vec(), rules, triangles: triangles.to_vec(), sides, edges, forks, curves }
    }

    /// The net that one split makes of it: vertices keep their numbers, and those on edges follow in the order of edges.
    pub fn split(&self) -> Self {
        let first = self.positions.len() as u32;
        let mut positions = self.weighted(loop_weight, 1.0 / 8.0);
        let mut opposite = vec![[0.0; 3]; self.edges.len()];
        for (triangle, sides) in self.triangles.iter().zip(&self.sides) {
            for (&corner, &side) in triangle.iter().zip(sides) {
                add(&mut opposite[side as usize], self.positions[corner as usize]);
            }
        }
        positions.extend(self.edges.iter().zip(&opposite).enumerate().map(|(edge, (ends, opposite))| {
            let [a, b] = ends.map(|v| self.positions[v as usize]);
            let by = |ends: f64, others: f64| std::array::from_fn(|k| ends * (a[k] + b[k]) + others * opposite[k]);
            if edge < self.curves { by(0.5, 0.0) } else { by(3.0 / 8.0, 1.0 / 8.0) }
        }));
        let mut rules = self.rules.clone();
        rules.extend((0..self.edges.len()).map(|edge| if edge < self.curves { Rule::Curve } else { Rule::Smooth }));

        // Halves of an edge stand side by side, that of its first end first; behind all halves stand three edges inside each triangle, number k along side k.
        let mut edges = Vec::with_capacity(2 * self.edges.len() + 3 * self.triangles.len());
        edges.extend(self.edges.iter().zip(first..).flat_map(|(&[a, b], q)| [[a, q], [b, q]]));
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        let mut sides = Vec::with_capacity(4 * self.triangles.len());
        for (&[p0, p1, p2], s) in self.triangles.iter().zip(&self.sides) {
            let [q0, q1, q2] = s.map(|side| first + side);
            let half = |k: usize, end: u32| 2 * s[k] + u32::from(self.edges[s[k] as usize][1] == end);
            let inner = edges.len() as u32;
            let [i0, i1, i2] = [inner, inner + 1, inner + 2];
            edges.extend([[q1, q2], [q2, q0], [q0, q1]]);
            triangles.extend([[p0, q2, q1], [q2, p1, q0], [q1, q0, p2], [q0, q1, q2]]);
            sides.extend([[i0, half(1, p0), half(2, p0)], [half(0, p1), i1, half(2, p1)], [half(0, p2), half(1, p2), i2], [i0, i1, i2]]);
        }
        Self { positions, rules, triangles, sides, edges, forks: 2 * self.forks, curves: 2 * self.curves }
    }

    /// Where on the limit surface each vertex goes.
    pub fn limit(&self) -> Vec<Point> {
        self.weighted(|n| 1.0 / (f64::from(n) + 3.0 / (8.0 * loop_weight(n))), 1.0 / 6.0)
    }

    /// Whether each vertex lies on an edge of more than two triangles.
    pub fn is_on_fork(&self) -> Vec<bool> {
        let mut on = vec![false; self.positions.len()];
        self.edges[..self.forks].iter().flatten().for_each(|&v| on[v as usize] = true);
        on
    }

    /// Each vertex and its neighbours: those of a fan of n weigh `smooth(n)` each, those along a curve `curve`, and the vertex the rest.
    fn weighted(&self, smooth: impl Fn(u32) -> f64, curve: f64) -> Vec<Point> {
        let mut around = vec![([0.0; 3], 0_u32); self.positions.len()];
        for (edge, &[a, b]) in self.edges.iter().enumerate() {
            for (v, other) in [(a, b), (b, a)] {
                if self.rules[v as usize] == Rule::Smooth || edge < self.curves {
                    let (sum, count) = &mut around[v as usize];
                    add(sum, self.positions[other as usize]);
                    *count += 1;
                }
            }
        }
        let moved = |((&at, &rule), &(sum, count)): ((&Point, &Rule), &(Point, u32))| {
            let weight = match rule {
                Rule::Smooth => smooth(count),
                Rule::Curve => curve,
                Rule::Fixed => return at,
            };
            std::array::from_fn(|k| (1.0 - f64::from(count) * weight) * at[k] + weight * sum[k])
        };
        self.positions.iter().zip(&self.rules).zip(&around).map(moved).collect()
    }
}

/// Loop's weight of each of `n` neighbours, 3 or more.
fn loop_weight(n: u32) -> f64 {
    let n = f64::from(n);
    (5.0 / 8.0 - (3.0 / 8.0 + (TAU / n).cos() / 4.0).powi(2)) / n
}
