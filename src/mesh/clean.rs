//! Triangle soup to a clean indexed mesh: equal vertices welded, useless triangles and vertices dropped, every change counted.

use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};

/// Largest coordinate magnitude taken: squares and fourth powers of differences stay finite in `f64`.
const MAX_COORDINATE: f64 = 1e60;

/// An indexed triangle mesh in the user's own units, without degenerate or repeated triangles.
///
/// Every position is finite and referenced, no two are equal, and each triangle has three distinct vertices. Open borders, non-manifold
/// edges and inconsistent windings are kept as they came.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Vertex positions.
    pub positions: Vec<[f64; 3]>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Shading normals of the file at the corners of each triangle, of length 1, or zero where a corner has none; empty if the file has none.
    /// The normals in an STL file are those of its flat facets, which the triangles give as well: they are not kept.
    pub normals: Vec<[[f32; 3]; 3]>,
    /// Texture coordinates of the file at the corners of each triangle, v upwards, no numbers where a corner has none; empty if the file has none.
    pub texture: Vec<[[f32; 2]; 3]>,
    /// Of each triangle the polygon of the file that it was cut from; those of one polygon stand side by side. Empty if the file has triangles alone.
    pub polygons: Vec<u32>,
    /// Index into `colours` for each triangle; empty if there are no materials.
    pub materials: Vec<u16>,
    /// Material colours, linear RGB in 0..=1.
    pub colours: Vec<[f32; 3]>,
    /// What cleaning found and did.
    pub report: CleanReport,
    /// What of a file was lost, or changed in a way that a reader should know, a line each.
    pub warnings: Vec<String>,
}

/// Counts of what cleaning found, dropped and kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CleanReport {
    /// Vertices before cleaning.
    pub vertices_read: usize,
    /// Triangles before cleaning, polygons and strips already cut into triangles.
    pub triangles_read: usize,
    /// Vertices merged into an earlier one at the same position.
    pub welded_vertices: usize,
    /// Vertices dropped because no kept triangle refers to them.
    pub unreferenced_vertices: usize,
    /// Triangles dropped for a repeated vertex or an area of exactly zero.
    pub degenerate_triangles: usize,
    /// Triangles dropped because an earlier one has the same three vertices, in any order.
    pub duplicate_triangles: usize,
    /// Edges of three or more kept triangles.
    pub non_manifold_edges: usize,
    /// Edges of one kept triangle.
    pub border_edges: usize,
    /// Edges of two kept triangles that run along it in the same direction.
    pub inconsistent_edges: usize,
    /// Triangles that were turned around, to run as most of those do that are connected with them: see [`TriangleMesh::orient`].
    #[serde(default, skip_serializing_if = "is_zero")]
    pub turned_triangles: usize,
}

impl CleanReport {
    /// A line on triangles without area, if there were any: without them nothing of the surface is lost.
    pub fn flat(&self) -> Option<String> {
        self.dropped(self.degenerate_triangles, "have no area")
    }

    /// A line on triangles with the corners of another, if there were any.
    pub fn repeated(&self) -> Option<String> {
        self.dropped(self.duplicate_triangles, "have the corners of another")
    }

    fn dropped(&self, count: usize, what: &str) -> Option<String> {
        (count > 0).then(|| format!("{count} of its {} triangles {what}, and are dropped", self.triangles_read))
    }
}

/// Most meshes need no line on it.
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// Why vertices and triangles do not make a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle}: vertex index {index} is out of range (there are {vertices} vertices)")]
    Index {
        /// Which triangle, from 0.
        triangle: usize,
        /// The bad index.
        index: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A coordinate is NaN, infinite or too large to compute with.
    #[error("vertex {vertex}: coordinate {value:e} is not a finite number below {MAX_COORDINATE:e}")]
    Coordinate {
        /// Which vertex, from 0.
        vertex: usize,
        /// The bad coordinate.
        value: f64,
    },
    /// A material index does not match a colour, or there is not one for each triangle.
    #[error("triangle {triangle}: its material has no colour")]
    Material {
        /// Which triangle, from 0.
        triangle: usize,
    },
    /// There are not as many normals, texture coordinates or polygons as triangles.
    #[error("there are {what} for {found} triangles, not for {triangles}")]
    Attributes {
        /// Normals, texture coordinates or polygons.
        what: &'static str,
        /// For how many triangles they are.
        found: usize,
        /// Triangles before cleaning.
        triangles: usize,
    },
    /// Nothing is left.
    #[error("no triangle is left of {triangles} after dropping {degenerate} degenerate ones")]
    Empty {
        /// Triangles before cleaning.
        triangles: usize,
        /// Degenerate ones among them.
        degenerate: usize,
    },
}

/// What triangles have beside the positions of their corners: for each there is nothing, or as many as triangles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attributes<'a> {
    /// Shading normals, of any length; one that is zero or not finite is none.
    pub normals: &'a [[[f32; 3]; 3]],
    /// Texture coordinates, v upwards; what is not finite is none.
    pub texture: &'a [[[f32; 2]; 3]],
    /// Polygons that they were cut from: those of one number, side by side, are one.
    pub polygons: &'a [u32],
}

/// True if this is a coordinate that a mesh may have.
pub(super) fn is_coordinate(v: f64) -> bool {
    v.abs() <= MAX_COORDINATE
}

/// A normal at length 1; zero, which is none, if it has no direction.
pub(super) fn unit(n: [f64; 3]) -> [f32; 3] {
    // Scaled first: squares of very long and very short ones stay within the range of numbers.
    let size = n.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if !n.iter().all(|v| v.is_finite()) || size == 0.0 {
        return [0.0; 3];
    }
    let n = n.map(|v| v / size);
    let length = n.iter().map(|v| v * v).sum::<f64>().sqrt();
    n.map(|v| (v / length) as f32)
}

impl TriangleMesh {
    /// Cleans vertices and triangles into a mesh; `materials` is empty or has one index into `colours` for each triangle.
    ///
    /// # Errors
    /// If an index is out of range, a coordinate is not finite, materials do not match, or no triangle is left.
    pub fn from_parts(
        positions: &[[f64; 3]],
        triangles: &[[u32; 3]],
        materials: &[u16],
        colours: Vec<[f32; 3]>,
    ) -> Result<TriangleMesh, MeshError> {
        Self::with_attributes(positions, triangles, Attributes::default(), materials, colours)
    }

    /// The same with shading normals, which are brought to length 1, and texture coordinates. Vertices that are welded keep those that their corners came with.
    ///
    /// # Errors
    /// Those of [`Self::from_parts`], or if there are normals, texture coordinates or polygons for another number of triangles.
    pub fn with_attributes(
        positions: &[[f64; 3]],
        triangles: &[[u32; 3]],
        attributes: Attributes<'_>,
        materials: &[u16],
        colours: Vec<[f32; 3]>,
    ) -> Result<TriangleMesh, MeshError> {
        check(positions, triangles, materials, &colours)?;
        let Attributes { normals, texture, polygons } = attributes;
        for (what, found) in [("normals", normals.len()), ("texture coordinates", texture.len()), ("polygons", polygons.len())] {
            if found != 0 && found != triangles.len() {
                return Err(MeshError::Attributes { what, found, triangles: triangles.len() });
            }
        }
        let mut report = CleanReport { vertices_read: positions.len(), triangles_read: triangles.len(), ..Default::default() };
        let first = weld(positions);
        report.welded_vertices = first.iter().enumerate().filter(|&(i, &f)| i != f as usize).count();

        let mut seen = HashSet::with_capacity(triangles.len());
        let mut kept = Vec::with_capacity(triangles.len());
        let (mut kept_normals, mut kept_texture, mut kept_polygons, mut kept_materials) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (t, corners) in triangles.iter().enumerate() {
            let tri = corners.map(|v| first[v as usize]);
            let mut key = tri;
            key.sort_unstable();
            if is_degenerate(tri.map(|v| positions[v as usize])) {
                report.degenerate_triangles += 1;
            } else if !seen.insert(key) {
                report.duplicate_triangles += 1;
            } else {
                kept.push(tri);
                kept_normals.extend(normals.get(t).map(|n| n.map(|n| unit(n.map(f64::from)))));
                kept_texture.extend(texture.get(t));
                kept_polygons.extend(polygons.get(t));
                kept_materials.extend(materials.get(t));
            }
        }
        if kept.is_empty() {
            return Err(MeshError::Empty { triangles: triangles.len(), degenerate: report.degenerate_triangles });
        }

        let positions = compact(positions, &mut kept);
        report.unreferenced_vertices = report.vertices_read - report.welded_vertices - positions.len();
        count_edges(&kept, &mut report);
        if kept_normals.iter().all(|n| *n == [[0.0; 3]; 3]) {
            kept_normals = Vec::new();
        }
        if !kept_texture.iter().flatten().flatten().any(|c: &f32| c.is_finite()) {
            kept_texture = Vec::new();
        }
        Ok(TriangleMesh {
            positions,
            triangles: kept,
            normals: kept_normals,
            texture: kept_texture,
            polygons: kept_polygons,
            materials: kept_materials,
            colours,
            report,
            warnings: Vec::new(),
        })
    }
}

fn check(positions: &[[f64; 3]], triangles: &[[u32; 3]], materials: &[u16], colours: &[[f32; 3]]) -> Result<(), MeshError> {
    for (vertex, p) in positions.iter().enumerate() {
        if let Some(&value) = p.iter().find(|&&v| !is_coordinate(v)) {
            return Err(MeshError::Coordinate { vertex, value });
        }
    }
    for (triangle, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&v| v as usize >= positions.len()) {
            return Err(MeshError::Index { triangle, index, vertices: positions.len() });
        }
        if !materials.is_empty() && materials.get(triangle).is_none_or(|&m| m as usize >= colours.len()) {
            return Err(MeshError::Material { triangle });
        }
    }
    Ok(())
}

/// For each vertex the first one at the same position; adding zero makes -0.0 equal 0.0 bit for bit.
fn weld(positions: &[[f64; 3]]) -> Vec<u32> {
    let mut seen = HashMap::with_capacity(positions.len());
    positions.iter().zip(0u32..).map(|(p, i)| *seen.entry(p.map(|v| (v + 0.0).to_bits())).or_insert(i)).collect()
}

/// True for an area of exactly zero; edges are scaled first, so that tiny triangles do not underflow.
pub(super) fn is_degenerate(p: [[f64; 3]; 3]) -> bool {
    let edge = |k: usize| -> [f64; 3] {
        let e: [f64; 3] = std::array::from_fn(|d| p[k][d] - p[0][d]);
        let size = e.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if size > 0.0 { e.map(|v| v / size) } else { e }
    };
    let (a, b) = (edge(1), edge(2));
    p[0] == p[1] || p[1] == p[2] || p[2] == p[0] || (0..3).all(|k| a[k] * b[(k + 1) % 3] == a[(k + 1) % 3] * b[k])
}

/// Referenced positions in order of their old index; `triangles` are renumbered.
fn compact(positions: &[[f64; 3]], triangles: &mut [[u32; 3]]) -> Vec<[f64; 3]> {
    let mut used = vec![false; positions.len()];
    triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
    let mut kept = Vec::new();
    let new: Vec<u32> = positions
        .iter()
        .zip(&used)
        .map(|(p, &used)| {
            let id = kept.len() as u32;
            if used {
                kept.push(p.map(|v| v + 0.0));
            }
            id
        })
        .collect();
    triangles.iter_mut().flatten().for_each(|v| *v = new[*v as usize]);
    kept
}

pub(super) fn count_edges(triangles: &[[u32; 3]], report: &mut CleanReport) {
    (report.border_edges, report.inconsistent_edges, report.non_manifold_edges) = (0, 0, 0);
    let mut edges: Vec<(u32, u32, bool)> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| if a < b { (a, b, true) } else { (b, a, false) })
        .collect();
    edges.sort_unstable();
    for run in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        match run {
            [_] => report.border_edges += 1,
            [a, b] => report.inconsistent_edges += usize::from(a.2 == b.2),
            _ => report.non_manifold_edges += 1,
        }
    }
}
