//! Edges of the base mesh, and the feature lines that they stand for.

use super::super::distance::Vec3;
use super::source::Source;
use std::collections::HashMap;

/// The base mesh, its edges and where its pieces come from.
pub(super) struct Topology {
    /// Vertex of the original of each base vertex.
    pub vertices: Vec<u32>,
    pub triangles: Vec<[u32; 3]>,
    /// Wedges of the original at each triangle's corners.
    pub wedges: Vec<[u32; 3]>,
    /// Patch of the original that each triangle stands for.
    pub patches: Vec<u32>,
    /// A triangle of the original near each one's middle.
    pub faces: Vec<u32>,
    pub edges: Vec<Edge>,
    /// For each triangle the edges opposite its vertices, and whether each runs there from its smaller to its larger vertex.
    pub sides: Vec<[(u32, bool); 3]>,
    /// For each base vertex its triangles and which of their corners it is.
    pub around: Vec<Vec<(u32, usize)>>,
    /// True for base vertices with smooth edges only, and no triangle of the original's own around them.
    pub movable: Vec<bool>,
    /// For each triangle that of the original that it is, if it is one.
    pub own: Vec<Option<u32>>,
}

/// An edge of the base mesh.
pub(super) struct Edge {
    /// Base vertices, smaller first.
    pub ends: [u32; 2],
    /// Triangles and which of their edges (0 to 2) this is.
    pub uses: Vec<(u32, usize)>,
    /// Two triangles, wound alike, with no crease between them.
    pub smooth: bool,
    /// It is an edge of a triangle of the original's own, and so of the original.
    pub own: bool,
    /// The feature line from the smaller end to the larger, if there is one.
    pub line: Option<Polyline>,
}

/// Points and the length up to each.
pub(super) struct Polyline {
    points: Vec<Vec3>,
    lengths: Vec<f64>,
}

impl Polyline {
    fn new(points: Vec<Vec3>) -> Polyline {
        let mut sum = 0.0;
        let steps = points.windows(2).map(|w| {
            sum += (w[1] - w[0]).length();
            sum
        });
        let lengths = std::iter::once(0.0).chain(steps).collect();
        Polyline { points, lengths }
    }

    /// The point at `fraction` (0 to 1) of the length.
    pub fn at(&self, fraction: f64) -> Vec3 {
        let last = self.points.len() - 1;
        let place = fraction * self.lengths[last];
        let k = self.lengths.partition_point(|&l| l <= place).clamp(1, last);
        let (from, to) = (self.lengths[k - 1], self.lengths[k]);
        let t = if to > from { (place - from) / (to - from) } else { 0.0 };
        self.points[k - 1].lerp(self.points[k], t.clamp(0.0, 1.0))
    }
}

impl Topology {
    /// Of base triangles as wedges of the original; `slots` gives for each a triangle of the original of the same patch, and the very one if
    /// it is one.
    pub fn new(source: &Source, base: Vec<[u32; 3]>, slots: &[u32]) -> Topology {
        let mut number = HashMap::new();
        let mut vertices = Vec::new();
        let mut id = |wedge: u32| {
            let v = source.wedge_vertex[wedge as usize];
            *number.entry(v).or_insert_with(|| {
                vertices.push(v);
                vertices.len() as u32 - 1
            })
        };
        let triangles: Vec<[u32; 3]> = base.iter().map(|t| t.map(&mut id)).collect();

        let own: Vec<Option<u32>> =
            base.iter().zip(slots).map(|(wedges, &t)| (source.wedges[t as usize] == *wedges).then_some(t)).collect();

        let mut uses = Vec::with_capacity(3 * triangles.len());
        for (tri, t) in triangles.iter().zip(0u32..) {
            for k in 0..3 {
                let (a, b) = (tri[(k + 1) % 3], tri[(k + 2) % 3]);
                uses.push((a.min(b), a.max(b), t, k));
            }
        }
        uses.sort_unstable();
        let mut in_base = vec![false; source.positions.len()];
        vertices.iter().for_each(|&v| in_base[v as usize] = true);
        let mut sides = vec![[(0, true); 3]; triangles.len()];
        let mut edges = Vec::new();
        for run in uses.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let ends = [run[0].0, run[0].1];
            for &(_, _, t, k) in run {
                sides[t as usize][k] = (edges.len() as u32, triangles[t as usize][(k + 1) % 3] == ends[0]);
            }
            // Wedges at the two ends, as each triangle sees them.
            let seen = |&(_, _, t, k): &(u32, u32, u32, usize)| {
                let (a, b) = (base[t as usize][(k + 1) % 3], base[t as usize][(k + 2) % 3]);
                let forward = triangles[t as usize][(k + 1) % 3] == ends[0];
                (if forward { [a, b] } else { [b, a] }, forward)
            };
            let smooth = matches!(run, [s, t] if seen(s).0 == seen(t).0 && seen(s).1 != seen(t).1);
            let line = if smooth { None } else { walk(source, &in_base, ends.map(|v| vertices[v as usize])) };
            let own = run.iter().any(|u| own[u.2 as usize].is_some());
            edges.push(Edge { ends, uses: run.iter().map(|u| (u.2, u.3)).collect(), smooth, own, line });
        }

        let mut around = vec![Vec::new(); vertices.len()];
        for (tri, t) in triangles.iter().zip(0u32..) {
            (0..3).for_each(|k| around[tri[k] as usize].push((t, k)));
        }
        let mut movable: Vec<bool> = vertices.iter().map(|&v| source.feature[v as usize].is_empty()).collect();
        for edge in edges.iter().filter(|e: &&Edge| !e.smooth || e.own) {
            edge.ends.into_iter().for_each(|v| movable[v as usize] = false);
        }

        let patches: Vec<u32> = slots.iter().map(|&t| source.patch[t as usize]).collect();
        let faces = triangles
            .iter()
            .zip(&patches)
            .map(|(t, &patch)| {
                let middle = t.iter().map(|&v| source.positions[vertices[v as usize] as usize]).sum::<Vec3>() / 3.0;
                let accept = |f: u32| source.patch[f as usize] == patch;
                source.target.closest(middle, 1e9, accept).map_or(0, |hit| hit.triangle)
            })
            .collect();
        Topology { vertices, triangles, wedges: base, patches, faces, edges, sides, around, movable, own }
    }

    /// These triangles and all that share a vertex with one, in order.
    pub fn with_neighbours(&self, triangles: &[usize]) -> Vec<usize> {
        let around = |&t: &usize| self.triangles[t].into_iter().flat_map(|v| &self.around[v as usize]).map(|&(t, _)| t as usize);
        let mut all: Vec<usize> = triangles.iter().flat_map(around).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// Follows the original's feature lines from one vertex to the other, not through another base vertex; the shortest way if there are more.
fn walk(source: &Source, in_base: &[bool], [from, to]: [u32; 2]) -> Option<Polyline> {
    let position = |v: &u32| source.positions[*v as usize];
    let mut best: Option<Polyline> = None;
    for &first in &source.feature[from as usize] {
        let (mut before, mut here) = (from, first);
        let mut way = vec![from, first];
        while here != to && !in_base[here as usize] && way.len() <= source.positions.len() {
            let [a, b] = source.feature[here as usize][..] else { break };
            (before, here) = (here, if a == before { b } else { a });
            way.push(here);
        }
        if here == to {
            let line = Polyline::new(way.iter().map(position).collect());
            if best.as_ref().is_none_or(|b| line.lengths.last() < b.lengths.last()) {
                best = Some(line);
            }
        }
    }
    best
}
