//! Seams: open edges whose ends lie a small distance apart.

use super::{Attributes, MeshError, TriangleMesh};
use std::collections::HashMap;

/// Distances at which seams are looked for, in parts of the diagonal of the box.
const TRIED: [f64; 4] = [1e-7, 1e-6, 1e-5, 1e-4];

/// Open edges that would be closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seams {
    /// The distance to weld by, in the mesh's units.
    pub distance: f64,
    /// Open edges that it closes.
    pub closed: usize,
    /// Open edges in all.
    pub open: usize,
}

impl TriangleMesh {
    /// The same with vertices of open edges made one where they are at most `distance` (in the mesh's units) apart; triangles that lose their area by it
    /// are dropped, and all are oriented again. A vertex goes to the place of the first in its group.
    ///
    /// # Errors
    /// If no triangle is left.
    pub fn welded(&self, distance: f64) -> Result<TriangleMesh, MeshError> {
        let first = self.groups(&self.open_edges(), distance);
        let triangles: Vec<[u32; 3]> = self.triangles.iter().map(|t| t.map(|v| first[v as usize])).collect();
        let attributes = Attributes { normals: &self.normals, texture: &self.texture, polygons: &self.polygons };
        let mut mesh = Self::with_attributes(&self.positions, &triangles, attributes, &self.materials, self.colours.clone())?;
        let (before, after) = (&self.report, &mut mesh.report);
        after.welded_vertices = before.welded_vertices + first.iter().zip(0u32..).filter(|&(&f, v)| f != v).count();
        after.unreferenced_vertices = before.unreferenced_vertices;
        (after.vertices_read, after.triangles_read) = (before.vertices_read, before.triangles_read);
        after.degenerate_triangles += before.degenerate_triangles;
        after.duplicate_triangles += before.duplicate_triangles;
        after.turned_triangles = before.turned_triangles;
        mesh.warnings = self.warnings.clone();
        mesh.orient();
        Ok(mesh)
    }

    /// The least distance tried that closes as many open edges as any without a triangle's loss; none if none does.
    pub fn seams(&self) -> Option<Seams> {
        let edges = self.open_edges();
        if edges.is_empty() {
            return None;
        }
        let size = |d: usize| {
            let (least, most) = self.positions.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), p| (l.min(p[d]), m.max(p[d])));
            most - least
        };
        let diagonal = (0..3).map(|d| size(d).powi(2)).sum::<f64>().sqrt();
        let mut best: Option<Seams> = None;
        for part in TRIED {
            let exact = part * diagonal;
            // One digit is easier to type.
            let distance = format!("{exact:.0e}").parse().unwrap_or(exact);
            let first = self.groups(&edges, distance);
            let ends = |&(a, b): &(u32, u32)| (first[a as usize], first[b as usize]);
            if edges.iter().map(ends).any(|(a, b)| a == b) {
                break;
            }
            let mut uses: HashMap<(u32, u32), u32> = HashMap::new();
            edges.iter().map(ends).for_each(|(a, b)| *uses.entry((a.min(b), a.max(b))).or_default() += 1);
            let closed = uses.values().filter(|&&n| n == 2).sum::<u32>() as usize;
            if closed > best.map_or(0, |b| b.closed) {
                best = Some(Seams { distance, closed, open: edges.len() });
            }
        }
        best
    }

    /// Edges of one triangle, from corner to corner as it runs.
    fn open_edges(&self) -> Vec<(u32, u32)> {
        let mut edges: Vec<(u32, u32, bool)> =
            self.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).map(|(a, b)| (a.min(b), a.max(b), a < b)).collect();
        edges.sort_unstable();
        let single = edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|run| run.len() == 1);
        single.map(|run| if run[0].2 { (run[0].0, run[0].1) } else { (run[0].1, run[0].0) }).collect()
    }

    /// For each vertex the first of its group: those of `edges` within `distance` of each other.
    fn groups(&self, edges: &[(u32, u32)], distance: f64) -> Vec<u32> {
        let mut first: Vec<u32> = (0..self.positions.len() as u32).collect();
        let mut ends: Vec<u32> = edges.iter().flat_map(|&(a, b)| [a, b]).collect();
        ends.sort_unstable();
        ends.dedup();
        // Along one axis: few vertices of borders lie within so small a distance of each other there.
        ends.sort_by(|&a, &b| self.positions[a as usize][0].total_cmp(&self.positions[b as usize][0]).then(a.cmp(&b)));
        for (i, &a) in ends.iter().enumerate() {
            let p = self.positions[a as usize];
            for &b in &ends[i + 1..] {
                let q = self.positions[b as usize];
                if q[0] - p[0] > distance {
                    break;
                }
                if (0..3).map(|d| (q[d] - p[d]).powi(2)).sum::<f64>().sqrt() <= distance {
                    let (a, b) = (root(&first, a), root(&first, b));
                    first[a.max(b) as usize] = a.min(b);
                }
            }
        }
        for v in 0..first.len() as u32 {
            first[v as usize] = root(&first, v);
        }
        first
    }
}

fn root(first: &[u32], mut v: u32) -> u32 {
    while first[v as usize] != v {
        v = first[v as usize];
    }
    v
}
