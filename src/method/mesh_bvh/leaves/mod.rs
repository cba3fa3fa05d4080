//! The triangles of a full-resolution BVH in five layouts.
//!
//! | layout | bytes | read per triangle |
//! |---|---|---|
//! | indexed | 12 per triangle + 12 per vertex | an index triple, three vertices anywhere behind all triples |
//! | packed | 36 per triangle | nine coordinates across two or three lines |
//! | line | 32 per triangle | one line of 28-bit coordinates |
//! | block | 32, 64, 96 or 128 per leaf | its lines ([`block`]) |
//! | dgf | 128 per block of up to 64 triangles, a few leaves | its four lines, whichever of its triangles are read ([`dgf`]) |
//!
//! The id of each slot's triangle is kept beside the layout and charged to none: a design would look it up once per final hit.

mod block;
mod dgf;

use super::cut::Corners;
use crate::bvh::{BvhError, MAX_LEAF};
use crate::format::{Line, VertexData};
use crate::mesh::{Hierarchy, lattice};
use crate::num::{LINE_BYTES, Wire};
use rayon::prelude::*;
use std::ops::Range;

pub(super) use block::lines as block_lines;
pub use block::{MOST_LINES, MOST_TRIANGLES};
pub use dgf::{Block as DenseBlock, Strip as DenseStrip, all as dense_triangles};
pub(super) use dgf::{PLACES as DENSE_PLACES, in_range as in_dense_range, named as dense_named};

/// How leaf triangles lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LeafLayout {
    /// Index triples of 12 bytes, then shared vertices of 12 bytes from the next line on, in the order in which the leaves first use them.
    Indexed,
    /// Nine 32-bit coordinates, 36 bytes, without gaps.
    Packed,
    /// One 32-byte line of 28-bit coordinates ([`VertexData`]).
    Line,
    /// Leaves of up to 16 triangles that share vertices in one to four lines.
    Block,
    /// Blocks of 128 bytes of the dense geometry format, of up to 64 triangles in several leaves.
    Dgf,
}

impl LeafLayout {
    /// All, with their names.
    const NAMES: [(Self, &'static str); 5] =
        [(Self::Indexed, "indexed"), (Self::Packed, "packed"), (Self::Line, "line"), (Self::Block, "block"), (Self::Dgf, "dgf")];

    /// The layout of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES.into_iter().find(|(_, own)| *own == name).map(|(layout, _)| layout)
    }

    /// Largest number of triangles of a leaf.
    pub fn most_triangles(self) -> u32 {
        if self == Self::Block { MOST_TRIANGLES as u32 } else { MAX_LEAF }
    }
}

/// The sizes of a leaf block: triangles less one in the lower four bits, lines less one above. Of a block of the dense geometry format [`BlockSize::DENSE`], and triangles less one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub(super) struct BlockSize(u8);

impl BlockSize {
    /// Of 1 to 16 triangles in 1 to 4 lines.
    pub fn new(triangles: usize, lines: u32) -> Self {
        Self((triangles as u8 - 1) | (lines as u8 - 1) << 4)
    }

    const DENSE: u8 = 0x80;

    /// Of 1 to 64 triangles of the dense geometry format.
    pub fn dense(triangles: usize) -> Self {
        Self(Self::DENSE | (triangles as u8 - 1))
    }

    pub fn is_dense(self) -> bool {
        self.0 & Self::DENSE != 0
    }

    pub fn triangles(self) -> u32 {
        u32::from(self.0 & if self.is_dense() { dgf::MOST as u8 - 1 } else { 15 }) + 1
    }

    pub fn lines(self) -> u32 {
        if self.is_dense() { dgf::LINES as u32 } else { u32::from(self.0 >> 4) + 1 }
    }
}

/// A leaf to read.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// Its triangles.
    pub slots: Range<usize>,
    /// Its lines, if it is a block or in one.
    block: Range<usize>,
}

/// Triangles in the order of the tree's leaves, each with a slot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaves {
    storage: Storage,
    /// Id of each slot's triangle ([`cut_id`](super::cut_id)).
    ids: Vec<u32>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Storage {
    Indexed {
        triples: Vec<[u32; 3]>,
        vertices: Vec<[i32; 3]>,
    },
    Packed(Vec<[i32; 9]>),
    Line(Vec<[u64; 4]>),
    /// `starts` has the slot of the first triangle of each line's block.
    Block {
        lines: Vec<Line>,
        starts: Vec<u32>,
    },
    /// `turns` has how far a block has turned the corners of each slot's triangle: charged to none, as ids.
    Dgf {
        blocks: Vec<dgf::Block>,
        turns: Vec<u8>,
    },
}

impl Leaves {
    /// Stores triangles of a hierarchy that cover it, each once, in this order; `blocks` are the sizes of leaf blocks, if they are the layout.
    ///
    /// # Errors
    /// A hierarchy that does not add up, or of other triangles.
    pub(super) fn new(hierarchy: &Hierarchy, ids: Vec<u32>, layout: LeafLayout, blocks: &[BlockSize]) -> Result<Self, BvhError> {
        let mesh = &Corners::new(hierarchy)?;
        if !mesh.are_covered_by(&ids) {
            return Err(BvhError::OtherHierarchy);
        }
        let storage = match layout {
            LeafLayout::Indexed => {
                let (triples, vertices) = shared_vertices(mesh, &ids);
                Storage::Indexed { triples, vertices }
            }
            LeafLayout::Packed => Storage::Packed(ids.par_iter().map(|&id| flat(mesh.triangle(id))).collect()),
            LeafLayout::Line => {
                let line = |&id: &u32| {
                    let mut words = [0; 4];
                    VertexData::from_points(mesh.triangle(id)).to_words(&mut words);
                    words
                };
                Storage::Line(ids.par_iter().map(line).collect())
            }
            LeafLayout::Block => in_blocks(mesh, &ids, blocks).ok_or(BvhError::OtherHierarchy)?,
            LeafLayout::Dgf => in_dense_blocks(mesh, &ids, blocks).ok_or(BvhError::OtherHierarchy)?,
        };
        Ok(Self { storage, ids })
    }

    /// The layout.
    pub fn layout(&self) -> LeafLayout {
        match self.storage {
            Storage::Indexed { .. } => LeafLayout::Indexed,
            Storage::Packed(_) => LeafLayout::Packed,
            Storage::Line(_) => LeafLayout::Line,
            Storage::Block { .. } => LeafLayout::Block,
            Storage::Dgf { .. } => LeafLayout::Dgf,
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

    /// The triangle in `slot` (below [`Leaves::len`]) in units, read from its stored form, and its id.
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
            Storage::Block { lines, starts } => {
                // The first line of the last block that begins at or before the slot.
                let start = starts[starts.partition_point(|&start| start as usize <= slot) - 1];
                let at = starts.partition_point(|&other| other < start);
                block::Block::new(&lines[at..]).triangle(slot - start as usize)
            }
            Storage::Dgf { blocks, turns } => {
                let block = &blocks[blocks.partition_point(|block| dgf::first(block) as usize <= slot) - 1];
                let (own, mut corners) = (slot - dgf::first(block) as usize, [[0; 3]; 3]);
                dgf::triangles(block, own + 1, |_, triangle| corners = triangle);
                turned_back(corners, turns[slot])
            }
        };
        (corners, self.ids[slot])
    }

    /// The leaf that a reference with this index and count stands for.
    #[inline]
    pub fn leaf(&self, index: usize, count: usize) -> Leaf {
        match &self.storage {
            Storage::Block { lines, starts } => {
                let (block, first) = (index..index + count, starts[index] as usize);
                Leaf { slots: first..first + block::Block::new(&lines[block.clone()]).len(), block }
            }
            Storage::Dgf { blocks, .. } => {
                let (block, place) = (index / dgf::PLACES, index % dgf::PLACES);
                let own = dgf::named(place, dgf::len(&blocks[block])).unwrap_or(0); // leaves have names
                let first = dgf::first(&blocks[block]) as usize + own;
                Leaf { slots: first..first + count, block: dgf::LINES * block..dgf::LINES * (block + 1) }
            }
            _ => Leaf { slots: index..index + count, block: 0..0 },
        }
    }

    /// Gives each triangle of a leaf, in order, as [`Leaves::triangle`] does.
    #[inline(always)]
    pub fn triangles(&self, leaf: &Leaf, mut give: impl FnMut([[i32; 3]; 3], u32)) {
        if let Storage::Block { lines, .. } = &self.storage {
            let block = block::Block::new(&lines[leaf.block.clone()]);
            leaf.slots.clone().enumerate().for_each(|(k, slot)| give(block.triangle(k), self.ids[slot]));
        } else if let Storage::Dgf { blocks, turns } = &self.storage {
            let block = &blocks[leaf.block.start / dgf::LINES];
            let first = dgf::first(block) as usize;
            dgf::triangles(block, leaf.slots.end - first, |k, corners| {
                let slot = first + k;
                if slot >= leaf.slots.start {
                    give(turned_back(corners, turns[slot]), self.ids[slot]);
                }
            });
        } else {
            for slot in leaf.slots.clone() {
                let (corners, id) = self.triangle(slot);
                give(corners, id);
            }
        }
    }

    /// Byte addresses, relative to the start of the leaf section and multiples of [`LINE_BYTES`], of the lines read for a leaf: each line once, in the
    /// order in which it is first needed. The leaf may be that of other leaves of the same tree, of any layouts but blocks.
    #[inline]
    pub fn lines(&self, leaf: &Leaf, mut read: impl FnMut(u64)) {
        let slots = leaf.slots.clone();
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
            Storage::Block { .. } | Storage::Dgf { .. } => leaf.block.clone().for_each(|line| read(LINE_BYTES * line as u64)),
        }
    }

    /// Memory of the leaf section in bytes, ids not counted.
    pub fn bytes(&self) -> u64 {
        match &self.storage {
            Storage::Indexed { triples, vertices } => vertex_section(triples.len()) + 12 * vertices.len() as u64,
            Storage::Packed(records) => 36 * records.len() as u64,
            Storage::Line(lines) | Storage::Block { lines, .. } => LINE_BYTES * lines.len() as u64,
            Storage::Dgf { blocks, .. } => size_of_val(blocks.as_slice()) as u64,
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

/// Of blocks of these sizes the first slots; none if they do not hold so many triangles.
fn first_slots(sizes: &[BlockSize], triangles: usize) -> Option<Vec<u32>> {
    let firsts: Vec<u32> = sizes
        .iter()
        .scan(0, |next, size| {
            let first = *next;
            *next += size.triangles(); // at most 2^28
            Some(first)
        })
        .collect();
    let all = firsts.last().zip(sizes.last()).map(|(first, size)| first + size.triangles());
    (all == u32::try_from(triangles).ok()).then_some(firsts)
}

/// Blocks of these sizes; none if they do not hold these triangles.
fn in_blocks(mesh: &Corners<'_>, ids: &[u32], sizes: &[BlockSize]) -> Option<Storage> {
    let firsts = first_slots(sizes, ids.len())?;
    let encode = |(&first, size): (&u32, &BlockSize)| {
        let own = &ids[first as usize..][..size.triangles() as usize];
        let triangles: Vec<_> = own.iter().map(|&id| mesh.triangle(id)).collect();
        let lines = block::encode(&triangles).filter(|lines| lines.len() as u32 == size.lines())?;
        Some(lines.into_iter().map(move |line| (line, first)))
    };
    let blocks: Option<Vec<_>> = firsts.par_iter().zip(sizes).map(encode).collect();
    let (lines, starts) = blocks?.into_iter().flatten().unzip();
    Some(Storage::Block { lines, starts })
}

/// The same in the dense geometry format.
fn in_dense_blocks(mesh: &Corners<'_>, ids: &[u32], sizes: &[BlockSize]) -> Option<Storage> {
    let firsts = first_slots(sizes, ids.len())?;
    let encode = |(&first, size): (&u32, &BlockSize)| {
        let own = &ids[first as usize..][..size.triangles() as usize];
        let coded = DenseStrip::of(own.iter().map(|&id| mesh.triangle(id))).block(first)?;
        Some((coded.block, coded.turns[..own.len()].to_vec()))
    };
    let all: Option<Vec<_>> = firsts.par_iter().zip(sizes).map(encode).collect();
    let (blocks, turns): (Vec<_>, Vec<_>) = all?.into_iter().unzip();
    Some(Storage::Dgf { blocks, turns: turns.concat() })
}

/// Corners that a block has turned so far, as they were.
#[inline]
fn turned_back(corners: [[i32; 3]; 3], turn: u8) -> [[i32; 3]; 3] {
    std::array::from_fn(|k| corners[(k + 3 - usize::from(turn)) % 3])
}

/// Where the vertices start behind this many index triples.
fn vertex_section(triples: usize) -> u64 {
    (12 * triples as u64).next_multiple_of(LINE_BYTES)
}

fn flat([a, b, c]: [[i32; 3]; 3]) -> [i32; 9] {
    [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]]
}

/// An index triple for each of these triangles, in their order, and the vertices that they share, in the order in which they are first used: those inside a tree by their place in its
/// lattice, those on the borders of trees by position.
pub(in crate::method) fn shared_vertices(mesh: &Corners<'_>, ids: &[u32]) -> (Vec<[u32; 3]>, Vec<[i32; 3]>) {
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

    let mut triples: Vec<[u32; 3]> = ids.par_iter().map(|&id| mesh.of(id).map(|c| same[c as usize])).collect();
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
    (triples, vertices)
}

#[cfg(test)]
mod tests;
