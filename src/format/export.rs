//! Any level of a scene as OBJ, welded by topology.

use super::Scene;
use crate::mesh::lattice;
use std::collections::HashMap;
use std::io::{self, BufWriter, Write};

/// What was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExportCounts {
    /// `v` lines.
    pub vertices: u64,
    /// `f` lines.
    pub faces: u64,
}

/// Writes level `level` in world coordinates. Trees share the vertices of their common base vertices and base edges; nothing is welded by position.
/// Trees follow each other, each its new vertices, then its faces in node order.
///
/// # Errors
/// The scene has no such level ([`io::ErrorKind::InvalidInput`]), or the writer fails.
pub fn export_level(scene: &Scene, level: u32, writer: impl Write) -> io::Result<ExportCounts> {
    let levels = scene.levels();
    if level > levels {
        let message = format!("level {level} does not exist: the finest is {levels}");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let mut out = Writer { inner: BufWriter::with_capacity(1 << 18, writer), placement: scene.meta().placement, vertices: 0 };
    let m = 1u32 << level;
    let (step, len) = (levels - level, lattice::len(levels));
    let mut base: HashMap<u32, u64> = HashMap::new();
    let mut edges: HashMap<[u32; 2], u64> = HashMap::new();
    let mut points = vec![[0; 3]; len];
    let mut ids = vec![0u64; lattice::len(level)];
    let faces_per_tree = 1u32 << (2 * level);
    for (tree, triangle) in scene.triangles().iter().enumerate() {
        scene.decode_points(tree, level, &mut points);
        let at = |p: (u32, u32)| points[lattice::index(levels, (p.0 << step, p.1 << step))];
        let corners = [(0, 0), (m, 0), (0, m)];
        for (&v, corner) in triangle.iter().zip(corners) {
            let id = match base.get(&v) {
                Some(&id) => id,
                None => *base.entry(v).or_insert(out.vertex(at(corner))?),
            };
            ids[lattice::index(level, corner)] = id;
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = if triangle[a] < triangle[b] { (a, b) } else { (b, a) };
            // Place 1 to m-1 along the edge from its smaller base vertex.
            let along = |place: u32| {
                let part = |from: u32, to: u32| (from * (m - place) + to * place) / m;
                (part(corners[a].0, corners[b].0), part(corners[a].1, corners[b].1))
            };
            let key = [triangle[a], triangle[b]];
            let first = match edges.get(&key) {
                Some(&first) => first,
                None => {
                    edges.insert(key, out.vertices + 1);
                    let first = out.vertices + 1;
                    for place in 1..m {
                        out.vertex(at(along(place)))?;
                    }
                    first
                }
            };
            for place in 1..m {
                ids[lattice::index(level, along(place))] = first + u64::from(place - 1);
            }
        }
        for j in 1..m {
            for i in 1..m - j {
                ids[lattice::index(level, (i, j))] = out.vertex(at((i, j)))?;
            }
        }
        for node in 0..faces_per_tree {
            let [a, b, c] = lattice::node(level, level, node).map(|p| ids[lattice::index(level, p)]);
            writeln!(out.inner, "f {a} {b} {c}")?;
        }
    }
    out.inner.flush()?;
    Ok(ExportCounts { vertices: out.vertices, faces: scene.trees() as u64 * u64::from(faces_per_tree) })
}

struct Writer<W: Write> {
    inner: BufWriter<W>,
    placement: crate::mesh::Placement,
    vertices: u64,
}

impl<W: Write> Writer<W> {
    /// Writes a vertex and gives its number, from 1.
    fn vertex(&mut self, p: [i32; 3]) -> io::Result<u64> {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| self.placement.offset[k] + self.placement.scale * f64::from(p[k]));
        writeln!(self.inner, "v {x} {y} {z}")?;
        self.vertices += 1;
        Ok(self.vertices)
    }
}
