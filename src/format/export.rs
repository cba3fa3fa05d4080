//! Any level of a scene as OBJ, welded by topology.

use super::Scene;
use super::numbering::Numbering;
use crate::mesh::lattice;
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
/// Trees follow each other, each its new vertices (in the order of `Numbering`), then its faces in node order.
///
/// # Errors
/// The scene has no such level ([`io::ErrorKind::InvalidInput`]), or the writer fails.
pub fn export_level(scene: &Scene, level: u32, writer: impl Write) -> io::Result<ExportCounts> {
    let levels = scene.levels();
    if level > levels {
        let message = format!("level {level} does not exist: the finest is {levels}");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let mut out = Writer { inner: BufWriter::with_capacity(1 << 18, writer), placement: scene.meta().placement };
    let (step, len) = (levels - level, lattice::len(levels));
    let mut numbering = Numbering::new(level);
    let mut points = vec![[0; 3]; len];
    let mut ids = vec![0; lattice::len(level)];
    let faces_per_tree = 1u32 << (2 * level);
    for (tree, &triangle) in scene.triangles().iter().enumerate() {
        scene.decode_points(tree, level, &mut points);
        let at = |p: (u32, u32)| points[lattice::index(levels, (p.0 << step, p.1 << step))];
        numbering.tree(triangle, &mut ids, |p| out.vertex(at(p)))?;
        for node in 0..faces_per_tree {
            // Counted from 1.
            let [a, b, c] = lattice::node(level, level, node).map(|p| ids[lattice::index(level, p)] + 1);
            writeln!(out.inner, "f {a} {b} {c}")?;
        }
    }
    out.inner.flush()?;
    Ok(ExportCounts { vertices: numbering.vertices(), faces: scene.trees() as u64 * u64::from(faces_per_tree) })
}

struct Writer<W: Write> {
    inner: BufWriter<W>,
    placement: crate::mesh::Placement,
}

impl<W: Write> Writer<W> {
    fn vertex(&mut self, p: [i32; 3]) -> io::Result<()> {
        let [x, y, z] = self.placement.to_world(p);
        writeln!(self.inner, "v {x} {y} {z}")
    }
}
