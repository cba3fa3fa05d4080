//! A net of polygons, the net of quads that Catmull and Clark's rules split it into, and the points of the limit surface that its vertices go to.
//!
//! Weights (Catmull and Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes", 1978): a point in each face, the mean of its corners; a point on each edge, the
//! mean of its ends and of the points of its two faces; a vertex of n faces goes to (F + 2 R + (n - 3) v) / n, F the mean of the points of these faces, R that of the middles of
//! its edges. Its limit in a net of quads is (n^2 v + 4 E + D) / (n (n + 5)), E the sum of its neighbours, D that of the corners opposite it in its faces (Halstead, Kass and DeRose, 1993).
//! Along curves both are those of a cubic B-spline, as with Loop's rules. Sums are taken in the order of edges and faces, by one thread.

use super::{Rule, add, rules};

type Point = [f64; 3];

/// The vertices, edges and faces of one level.
pub struct Net {
    pub positions: Vec<Point>,
    rules: Vec<Rule>,
    /// Corners of faces, one face after the other; of quads those of a grid's follow each other as [`Self::grid`] says.
    corners: Vec<u32>,
    /// Edges beside them: from the corner to the next of its face.
    sides: Vec<u32>,
    /// Where each face begins, and where the last ends.
    begins: Vec<u32>,
    /// Ends of edges. First those of more than two faces, then those of one, then all others.
    edges: Vec<[u32; 2]>,
    /// How many edges have more than two faces.
    forks: usize,
    /// How many have not two: they are on curves.
    curves: usize,
}

impl Net {
    /// The net of polygons, each with three corners or more, all distinct.
    pub fn new(positions: Vec<Point>, faces: &[Vec<u32>]) -> Self {
        let mut uses: Vec<(u32, u32, u32)> = Vec::new();
        let (mut corners, mut begins) = (Vec::new(), vec![0]);
        let mut pairs = Vec::new();
        for face in faces {
            let ring = |k: usize| face[k % face.len()];
            for k in 0..face.len() {
                let (a, b, before) = (ring(k), ring(k + 1), ring(k + face.len() - 1));
                uses.push((a.min(b), a.max(b), corners.len() as u32)); // corners are numbered in 32 bits
                pairs.extend([[a, b, before], [a, before, b]]);
                corners.push(a);
            }
            begins.push(corners.len() as u32);
        }
        uses.sort_unstable();
        let groups: Vec<&[(u32, u32, u32)]> = uses.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).collect();
        let kinds = [|count: usize| count > 2, |count| count == 1, |count| count == 2];
        let count = |kind: fn(usize) -> bool| groups.iter().filter(|uses| kind(uses.len())).count();
        let (forks, curves) = (count(kinds[0]), count(kinds[0]) + count(kinds[1]));
        let mut sides = vec![0; corners.len()];
        let mut edges = Vec::with_capacity(groups.len());
        for uses in kinds.iter().flat_map(|kind| groups.iter().filter(|uses| kind(uses.len()))) {
            uses.iter().for_each(|of| sides[of.2 as usize] = edges.len() as u32);
            edges.push([uses[0].0, uses[0].1]);
        }
        let rules = rules(positions.len(), pairs, &edges, curves);
        Self { positions, rules, corners, sides, begins, edges, forks, curves }
    }

    /// Corners of each face.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        self.begins.windows(2).map(|of| &self.corners[of[0] as usize..of[1] as usize])
    }

    /// The quads that one split makes of it: vertices keep their numbers, those on edges follow in the order of edges, and those in faces in that of faces. A face of n corners
    /// becomes n quads; child k of a quad keeps the quad's own corner k, and its corners stand as the quad's do.
    pub fn split(&self) -> Self {
        let centres: Vec<Point> = self
            .faces()
            .map(|face| {
                let mut sum = [0.0; 3];
                face.iter().for_each(|&v| add(&mut sum, self.positions[v as usize]));
                sum.map(|c| c / face.len() as f64)
            })
            .collect();
        let mut beside = vec![[0.0; 3]; self.edges.len()];
        let mut around = vec![([0.0; 3], 0_u32); self.positions.len()];
        for (own, centre) in self.begins.windows(2).zip(&centres) {
            for at in own[0] as usize..own[1] as usize {
                add(&mut beside[self.sides[at] as usize], *centre);
                let (sum, count) = &mut around[self.corners[at] as usize];
                add(sum, *centre);
                *count += 1;
            }
        }
        let ends = self.sums_of_neighbours();
        let old = self.positions.iter().zip(&self.rules).zip(around.iter().zip(&ends)).map(|((&v, &rule), (&(faces, n), &ends))| {
            let n = f64::from(n);
            std::array::from_fn(|k| match rule {
                // F + 2 R: R is half the vertex and half the mean of its neighbours.
                Rule::Smooth => (faces[k] / n + ends[k] / n + (n - 2.0) * v[k]) / n,
                Rule::Curve => (ends[k] + 6.0 * v[k]) / 8.0,
                Rule::Fixed => v[k],
            })
        });
        let mut positions: Vec<Point> = old.collect();
        let first = positions.len() as u32;
        positions.extend(self.edges.iter().zip(&beside).enumerate().map(|(edge, (ends, beside))| {
            let [a, b] = ends.map(|v| self.positions[v as usize]);
            std::array::from_fn(|k| if edge < self.curves { 0.5 * (a[k] + b[k]) } else { 0.25 * (a[k] + b[k] + beside[k]) })
        }));
        let inside = positions.len() as u32;
        positions.extend(centres);
        let mut rules = self.rules.clone();
        rules.extend((0..self.edges.len()).map(|edge| if edge < self.curves { Rule::Curve } else { Rule::Smooth }));
        rules.resize(positions.len(), Rule::Smooth);

        // Halves of an edge stand side by side, that of its first end first; behind all halves stand the edges inside of faces, one from each side's middle.
        let mut edges = Vec::with_capacity(2 * self.edges.len() + self.corners.len());
        edges.extend(self.edges.iter().zip(first..).flat_map(|(&[a, b], q)| [[a, q], [b, q]]));
        let inner = edges.len() as u32;
        let mut corners = Vec::with_capacity(4 * self.corners.len());
        let mut sides = Vec::with_capacity(4 * self.corners.len());
        for (own, centre) in self.begins.windows(2).zip(inside..) {
            let (begin, count) = (own[0] as usize, (own[1] - own[0]) as usize);
            edges.extend((0..count).map(|k| [first + self.sides[begin + k], centre]));
            for k in 0..count {
                let before = (k + count - 1) % count;
                let p = self.corners[begin + k];
                let [side, last] = [k, before].map(|k| self.sides[begin + k]);
                let half = |side: u32| 2 * side + u32::from(self.edges[side as usize][1] == p);
                let inner = |k: usize| inner + (begin + k) as u32;
                let mut quad = [p, first + side, centre, first + last];
                let mut round = [half(side), inner(k), inner(before), half(last)];
                if count == 4 {
                    quad.rotate_right(k);
                    round.rotate_right(k);
                }
                corners.extend(quad);
                sides.extend(round);
            }
        }
        let begins = (0..=corners.len() as u32).step_by(4).collect();
        Self { positions, rules, corners, sides, begins, edges, forks: 2 * self.forks, curves: 2 * self.curves }
    }

    /// Where on the limit surface each vertex of a net of quads goes.
    pub fn limit(&self) -> Vec<Point> {
        let ends = self.sums_of_neighbours();
        let mut opposite = vec![([0.0; 3], 0_u32); self.positions.len()];
        for face in self.faces() {
            for (k, &v) in face.iter().enumerate() {
                let (sum, count) = &mut opposite[v as usize];
                add(sum, self.positions[face[(k + 2) % face.len()] as usize]);
                *count += 1;
            }
        }
        let moved = |own: usize| {
            let (v, ends, (opposite, n)) = (self.positions[own], ends[own], opposite[own]);
            let n = f64::from(n);
            std::array::from_fn(|k| match self.rules[own] {
                Rule::Smooth => (n * n * v[k] + 4.0 * ends[k] + opposite[k]) / (n * (n + 5.0)),
                Rule::Curve => (ends[k] + 4.0 * v[k]) / 6.0,
                Rule::Fixed => v[k],
            })
        };
        (0..self.positions.len()).map(moved).collect()
    }

    /// Of each vertex the sum of its neighbours: of one on a curve those along it.
    fn sums_of_neighbours(&self) -> Vec<Point> {
        let mut sums = vec![[0.0; 3]; self.positions.len()];
        for (edge, &[a, b]) in self.edges.iter().enumerate() {
            for (v, other) in [(a, b), (b, a)] {
                if self.rules[v as usize] == Rule::Smooth || edge < self.curves {
                    add(&mut sums[v as usize], self.positions[other as usize]);
                }
            }
        }
        sums
    }

    /// Whether each vertex lies on an edge of more than two faces.
    pub fn is_on_fork(&self) -> Vec<bool> {
        let mut on = vec![false; self.positions.len()];
        self.edges[..self.forks].iter().flatten().for_each(|&v| on[v as usize] = true);
        on
    }

    /// The vertices of quad `of` after it was split `levels` times, this net being the result: row by row, those along its first side first.
    pub fn grid(&self, of: usize, levels: u32) -> Vec<u32> {
        let (quads, row) = (1_usize << (2 * levels), (1 << levels) + 1);
        let mut grid = vec![0; row * row];
        for k in 0..quads {
            // Children go around: of digit d, the corner d of the quad before.
            let (mut x, mut y) = (0, 0);
            for level in (0..levels).rev() {
                let digit = k >> (2 * level) & 3;
                (x, y) = (2 * x + usize::from(digit == 1 || digit == 2), 2 * y + (digit >> 1));
            }
            let corners = &self.corners[4 * (of * quads + k)..][..4];
            for (&v, (dx, dy)) in corners.iter().zip([(0, 0), (1, 0), (1, 1), (0, 1)]) {
                grid[(y + dy) * row + x + dx] = v;
            }
        }
        grid
    }
}
