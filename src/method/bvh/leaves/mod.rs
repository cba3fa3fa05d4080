//! The triangles of a full-resolution quad-BVH in three layouts.
//!
//! | layout | bytes | read per triangle |
//! |---|---|---|
//! | indexed | 12 per triangle + 12 per vertex | an index triple, three vertices anywhere behind all triples |
//! | packed | 36 per triangle | nine coordinates across two or three lines |
//! | line | 32 per triangle | one line of 28-bit coordinates |
//!
//! The full-resolution triangle id of each slot is kept beside the layout and charged to none: a design would look it up once per final hit.

use super::finest::Finest;
use crate::bvh::BvhError;
use crate::format::VertexData;
use crate::mesh::{Hierarchy, lattice};
use crate::num::{LINE_BYTES, Wire};
use rayon::prelude::*;
use std::ops::Range;

/// How leaf triangles lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeafLayout {
    /// Index triples of 12 bytes, then shared vertices of 12 bytes from the next line on, in the order in which the leaves first use them.
    Indexed,
    /// Nine 32-bit coordinates, 36 bytes, without gaps.
    Packed,
    /// One 32-byte line of 28-bit coordinates ([`VertexData`]).
    Line,
}

impl LeafLayout {
    /// All, with their names.
    const NAMES: [(Self, &'static str); 3] = [(Self::Indexed, "indexed"), (Self::Packed, "packed"), (Self::Line, "line")];

    /// The layout of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES.into_iter().find(|(_, own)| *own == name).map(|(layout, _)| layout)
    }
}

/// Triangles in the order of the tree's leaves, each with a slot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaves {
    storage: Storage,
    /// Full-resolution triangle id of each slot.
    ids: Vec<u32>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Storage {
    Indexed { triples: Vec<[u32; 3]>, vertices: Vec<[i32; 3]> },
    Packed(Vec<[i32; 9]>),
    Line(Vec<[u64; 4]>),
}

impl Leaves {
    /// Stores the full-resolution triangles `ids` of a hierarchy, each of them once, in this order.
    ///
    /// # Errors
    /// A hierarchy that does not add up, or of other triangles.
    pub fn new(hierarchy: &Hierarchy, ids: Vec<u32>, layout: LeafLayout) -> Result<Self, BvhError> {
        let mesh = &Finest::new(hierarchy)?;
        if ids.len() != mesh.count() || ids.par_iter().any(|&id| id as usize >= mesh.count()) {
            return Err(BvhError::OtherHierarchy);
        }
        let storage = match layout {
            LeafLayout::Indexed => indexed(mesh, &ids),
            LeafLayout::Packed => Storage::Packed(ids.par_iter().map(|&id| flat(mesh.triangle(id))).collect()),
            LeafLayout::Line => {
                let line = |&id: &u32| {
                    let mut words = [0; 4];
                    VertexData::from_points(mesh.triangle(id)).to_words(&mut words);
                    words
                };
                Storage::Line(ids.par_iter().map(line).collect())
            }
        };
        Ok(Self { storage, ids })
    }

    /// The layout.
    pub fn layout(&self) -> LeafLayout {
        match self.storage {
            Storage::Indexed { .. } => LeafLayout::Indexed,
            Storage::Packed(_) => LeafLayout::Packed,
            Storage::Line(_) => LeafLayout::Line,
        }
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Never: there is at least one triangle.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The triangle in `slot` (below [`Leaves::len`]) in units, read from its stored form, and its full-resolution id.
    #[inline]
    pub fn triangle(&self, slot: usize) -> ([[i32; 3]; 3], u32) {
        let corners = match &self.storage {
            Storage::Indexed { triples, vertices } => triples[slot].map(|v| vertices[v as usize]),
            Storage::Packed(records) => {
                let r = &records[slot];
                [[r[0], r[1], r[2]], [r[3], r[4], r[5]], [r[6], r[7], r[8]]]
            }
            // Stored coordinates have 28 + 4 bits.
            Storage::Line(lines) => VertexData::from_words(&lines[slot]).points().map(|p| p.get().map(|c| c as i32)),
        };
        (corners, self.ids[slot])
    }

    /// Byte addresses, relative to the start of the leaf section and multiples of [`LINE_BYTES`], of the lines read for a leaf of the triangles in
    /// `slots` (at most four, below [`Leaves::len`]): each line once for the whole leaf, in the order in which it is first needed.
    #[inline]
    pub fn lines(&self, slots: Range<usize>, mut read: impl FnMut(u64)) {
        match &self.storage {
            Storage::Indexed { triples, .. } => {
                // Four triangles, a triple and three vertices each, in one or two lines.
                let mut seen = [0u64; 32];
                let mut count = 0;
                let mut touch = |first_byte: u64| {
                    // Twelve bytes lie in one or two lines.
                    let lines = [first_byte & !(LINE_BYTES - 1), (first_byte + 11) & !(LINE_BYTES - 1)];
                    for line in lines {
                        if !seen[..count].contains(&line) {
                            seen[count] = line;
                            count += 1;
                            read(line);
                        }
                    }
                };
                slots.clone().for_each(|slot| touch(12 * slot as u64));
                let vertices = vertex_section(triples.len());
                for v in triples[slots].as_flattened() {
                    touch(vertices + 12 * u64::from(*v));
                }
            }
            Storage::Packed(_) => {
                let (first, end) = (36 * slots.start as u64, 36 * slots.end as u64);
                let mut line = first & !(LINE_BYTES - 1);
                while line < end {
                    read(line);
                    line += LINE_BYTES;
                }
            }
            Storage::Line(_) => slots.for_each(|slot| read(LINE_BYTES * slot as u64)),
        }
    }

    /// Memory of the leaf section in bytes, ids not counted.
    pub fn bytes(&self) -> u64 {
        match &self.storage {
            Storage::Indexed { triples, vertices } => vertex_section(triples.len()) + 12 * vertices.len() as u64,
            Storage::Packed(records) => 36 * records.len() as u64,
            Storage::Line(lines) => LINE_BYTES * lines.len() as u64,
        }
    }

    /// Number of shared vertices of the indexed layout; three per triangle in the others.
    pub fn vertices(&self) -> usize {
        match &self.storage {
            Storage::Indexed { vertices, .. } => vertices.len(),
            _ => 3 * self.len(),
        }
    }
}

/// Where the vertices start behind this many index triples.
fn vertex_section(triples: usize) -> u64 {
    (12 * triples as u64).next_multiple_of(LINE_BYTES)
}

fn flat([a, b, c]: [[i32; 3]; 3]) -> [i32; 9] {
    [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]]
}

/// Shares the vertices: those inside a tree by their place in its lattice, those on the borders of trees by position.
fn indexed(mesh: &Finest<'_>, ids: &[u32]) -> Storage {
    const UNUSED: u32 = u32::MAX;
    let m = 1u32 << mesh.levels;
    let border = |k: u32| [(k, 0), (0, k), (m - k, k)].map(|c| lattice::index(mesh.levels, c));
    let mut on_border: Vec<usize> = (0..=m).flat_map(border).collect();
    on_border.sort_unstable();
    on_border.dedup();
    let mut shared: Vec<([i32; 3], u32)> = (0..mesh.trees)
        .into_par_iter()
        .flat_map_iter(|t| on_border.iter().map(move |c| t * mesh.stride + c))
        .map(|at| (mesh.points[at], at as u32)) // fewer than 2^30 points
        .collect();
    shared.par_sort_unstable();
    let mut same: Vec<u32> = (0..mesh.points.len() as u32).into_par_iter().collect();
    for run in shared.chunk_by(|a, b| a.0 == b.0) {
        for &(_, at) in run {
            same[at as usize] = run[0].1;
        }
    }
    drop(shared);

    let mut triples: Vec<[u32; 3]> = ids.par_iter().map(|&id| mesh.corners(id).map(|c| same[c as usize])).collect();
    drop(same);
    let mut renamed = vec![UNUSED; mesh.points.len()];
    let mut vertices = Vec::new();
    for v in triples.iter_mut().flatten() {
        let at = *v as usize;
        if renamed[at] == UNUSED {
            renamed[at] = vertices.len() as u32; // no more than points
            vertices.push(mesh.points[at]);
        }
        *v = renamed[at];
    }
    Storage::Indexed { triples, vertices }
}

#[cfg(test)]
mod tests;
