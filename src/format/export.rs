//! Any level of a scene as a mesh, welded by topology.

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

/// A level's surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LevelMesh {
    /// World coordinates.
    pub vertices: Vec<[f64; 3]>,
    /// Three vertices each, counter-clockwise from outside.
    pub faces: Vec<[u64; 3]>,
}

/// Writes level `level` in world coordinates. Trees share the vertices of their common base vertices and base edges; nothing is welded by position.
/// Trees follow each other, each its new vertices (in the order of `Numbering`), then its faces in node order.
///
/// # Errors
/// The scene has no such level ([`io::ErrorKind::InvalidInput`]), or the writer fails.
pub fn export_level(scene: &Scene, level: u32, writer: impl Write) -> io::Result<ExportCounts> {
    let mut out = BufWriter::with_capacity(1 << 18, writer);
    let counts = walk(scene, level, |part| match part {
        Part::Vertex([x, y, z]) => writeln!(out, "v {x} {y} {z}"),
        // Counted from 1.
        Part::Face(face) => {
            let [a, b, c] = face.map(|id| id + 1);
            writeln!(out, "f {a} {b} {c}")
        }
    })?;
    out.flush()?;
    Ok(counts)
}

/// Level `level` in memory: vertices and faces as [`export_level`] writes them.
///
/// # Errors
/// The scene has no such level ([`io::ErrorKind::InvalidInput`]).
pub fn level_mesh(scene: &Scene, level: u32) -> io::Result<LevelMesh> {
    let mut mesh = LevelMesh::default();
    walk(scene, level, |part| {
        match part {
            Part::Vertex(point) => mesh.vertices.push(point),
            Part::Face(face) => mesh.faces.push(face),
        }
        Ok(())
    })?;
    Ok(mesh)
}

/// What a level is made of; vertices are counted from 0.
enum Part {
    Vertex([f64; 3]),
    Face([u64; 3]),
}

/// Tells `out` the level's vertices and faces in the order in which they are written.
fn walk(scene: &Scene, level: u32, mut out: impl FnMut(Part) -> io::Result<()>) -> io::Result<ExportCounts> {
    let levels = scene.levels();
    if level > levels {
        let message = format!("level {level} does not exist: the finest is {levels}");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let placement = scene.meta().placement;
    let (step, len) = (levels - level, lattice::len(levels));
    let mut numbering = Numbering::new(level);
    let mut points = vec![[0; 3]; len];
    let mut ids = vec![0; lattice::len(level)];
    let faces_per_tree = 1u32 << (2 * level);
    for (tree, &triangle) in scene.triangles().iter().enumerate() {
        scene.decode_points(tree, level, &mut points);
        let at = |p: (u32, u32)| points[lattice::index(levels, (p.0 << step, p.1 << step))];
        numbering.tree(triangle, &mut ids, |p| out(Part::Vertex(placement.to_world(at(p)))))?;
        for node in 0..faces_per_tree {
            out(Part::Face(lattice::node(level, level, node).map(|p| ids[lattice::index(level, p)])))?;
        }
    }
    Ok(ExportCounts { vertices: numbering.vertices(), faces: scene.trees() as u64 * u64::from(faces_per_tree) })
}
