//! A full-resolution BVH's tree as a file, for whoever wants to build it once only.
//!
//! | bytes | what |
//! |---|---|
//! | 0..8 | magic |
//! | 8..12 | version |
//! | 12..16 | number of splits N |
//! | 16..32 | key: of what the tree was built |
//! | 32..40 | bytes of a node: 32, 64 or 128; 6 for nodes of six children, which have 64 |
//! | 40..48 | number of nodes |
//! | 48..56 | number of triangles |
//! | 56..64 | number of leaf blocks |
//! | 64..80 | checksum of the first 64 bytes and all from 80 on |
//! | from 80 on | the nodes, then the triangles' ids in leaf order, 4 bytes each, then the blocks' sizes, a byte each: triangles less one in the lower four bits, lines less one above; of the dense geometry format 128 and triangles less one |
//!
//! All numbers are little-endian. A file is a shortcut, not a source: whatever is not as it should be makes it none.

use super::cut::are_of_one_hierarchy;
use super::leaves::{BlockSize, DENSE_PLACES, dense_named};
use super::{FullNodes, FullOptions, FullTree, LeafLayout};
use crate::bvh::{BvhChild32, MAX_DEPTH, MAX_DEPTH_OF_SIX, Node6, Node16, Node32, Options};
use crate::format::{BvhChild, BvhNode, ChildRef, FileSection, Line, Scene, SixNode};
use crate::num::{ROTATIONS, Wire};
use std::io::{self, Read, Write};
use std::sync::Arc;
use xxhash_rust::xxh3::Xxh3Default;

const MAGIC: [u8; 8] = *b"LODRAYBV";
/// Of the file, and of what is built: a test fails when trees change and this does not.
const VERSION: u32 = 4;
/// In place of the bytes of a node: six children in 64 bytes.
const OF_SIX: u64 = 6;
const HEADER: usize = 80;
/// Where the checksum stands, behind all that it covers of the header.
const SUM: usize = 64;

/// What a tree depends on, as a name: equal keys, equal trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TreeKey(u128);

impl TreeKey {
    /// The key of the tree of `options`, whatever its leaves but for blocks, over the triangles of a level of `scene`.
    pub fn new(scene: &Scene, options: &FullOptions, level: u32) -> Self {
        let Options { max_leaf, collapse, costs } = options.tree;
        let mut hash = Xxh3Default::new();
        let scale = scene.meta().bound_offset;
        let blocks = match options.layout {
            LeafLayout::Indexed | LeafLayout::Packed | LeafLayout::Line => 0,
            LeafLayout::Block => 1,
            LeafLayout::Dgf => 2,
        };
        let [boxes, vertices] = [options.boxes as u32, scene.meta().vertices as u32];
        for number in [VERSION, scene.levels(), level, max_leaf, collapse as u32, boxes, options.order as u32, blocks, scale, vertices] {
            hash.update(&number.to_le_bytes());
        }
        for cost in [costs.node, costs.primitive, costs.line] {
            hash.update(&cost.to_bits().to_le_bytes());
        }
        // Codes say where compact vertices lie.
        for section in [FileSection::Records, FileSection::Splits, FileSection::Vertices] {
            let bytes = scene.section(section);
            hash.update(&(bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        }
        Self(hash.digest128())
    }
}

impl std::fmt::Display for TreeKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

impl FullTree {
    /// Writes it.
    ///
    /// # Errors
    /// What `out` says.
    pub fn write(&self, key: TreeKey, out: &mut dyn Write) -> io::Result<()> {
        let (size, nodes): (u64, &[u8]) = match &*self.nodes {
            FullNodes::Local(nodes) => (32, bytemuck::cast_slice(nodes)),
            FullNodes::Boxes16(nodes) => (64, bytemuck::cast_slice(nodes)),
            FullNodes::Boxes32(nodes) => (128, bytemuck::cast_slice(nodes)),
            FullNodes::Six(nodes) => (OF_SIX, bytemuck::cast_slice(nodes)),
        };
        let ids = bytemuck::cast_slice(&self.ids);
        let mut header = Vec::with_capacity(HEADER);
        header.extend(MAGIC);
        header.extend(VERSION.to_le_bytes());
        header.extend(self.levels.to_le_bytes());
        header.extend(key.0.to_le_bytes());
        for number in [size, self.nodes.len() as u64, self.ids.len() as u64, self.blocks.len() as u64] {
            header.extend(number.to_le_bytes());
        }
        let blocks = bytemuck::cast_slice(&self.blocks);
        header.extend(checksum(&[&header, nodes, ids, blocks]).to_le_bytes());
        [&header, nodes, ids, blocks].into_iter().try_for_each(|part| out.write_all(part))
    }

    /// Reads the tree of `key`, which has `triangles`, from a file of `length` bytes; none if that is not what the file holds, whole and sound.
    pub fn read(key: TreeKey, triangles: u64, length: u64, file: &mut dyn Read) -> Option<Self> {
        let mut header = [0; HEADER];
        file.read_exact(&mut header).ok()?;
        let word = |at: usize| header[at..].first_chunk().map(|bytes| u64::from_le_bytes(*bytes));
        let half = |at: usize| header[at..].first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
        let (size, nodes, ids, blocks) = (word(32)?, word(40)?, word(48)?, word(56)?);
        let bytes = if size == OF_SIX { 64 } else { size };
        let parts = bytes.checked_mul(nodes)?.checked_add(ids.checked_mul(4)?)?.checked_add(blocks)?;
        let fits = parts.checked_add(HEADER as u64)? == length;
        if header[..8] != MAGIC || half(8)? != VERSION || header[16..32] != key.0.to_le_bytes() || ids != triangles || !fits {
            return None;
        }
        // All fit into a file of this length.
        let nodes = match size {
            32 => FullNodes::Local(filled::<Line>(nodes as usize, file)?),
            64 => FullNodes::Boxes16(filled::<Node16>(nodes as usize, file)?),
            128 => FullNodes::Boxes32(filled::<Node32>(nodes as usize, file)?),
            OF_SIX => FullNodes::Six(filled::<Node6>(nodes as usize, file)?),
            _ => return None,
        };
        let tree =
            Self { levels: half(12)?, nodes: Arc::new(nodes), ids: filled(ids as usize, file)?, blocks: filled(blocks as usize, file)? };
        let sum = checksum(&[&header[..SUM], tree.nodes.raw(), bytemuck::cast_slice(&tree.ids), bytemuck::cast_slice(&tree.blocks)]);
        (header[SUM..] == sum.to_le_bytes() && tree.is_sound()).then_some(tree)
    }

    /// Whether traversal stays inside: every reference leads somewhere, inner nodes behind their parents and not too deep.
    fn is_sound(&self) -> bool {
        let triangles = self.ids.len() as u64;
        let count = self.nodes.len();
        if count == 0 || !are_of_one_hierarchy(self.levels, &self.ids) {
            return false;
        }
        // Of each line of leaf blocks the lines of the block that begins there, or 0.
        let lines: Vec<u8> =
            self.blocks.iter().flat_map(|size| (0..size.lines()).map(|k| if k == 0 { size.lines() as u8 } else { 0 })).collect();
        if !self.blocks.is_empty() && self.blocks.iter().map(|size| u64::from(size.triangles())).sum::<u64>() != triangles {
            return false;
        }
        let are_dense = self.blocks.first().is_some_and(|size| size.is_dense());
        if self.blocks.iter().any(|size| size.is_dense() != are_dense) {
            return false;
        }
        if !self.nodes.have_frames() {
            return false;
        }
        let mut depths = vec![0u8; count];
        depths[0] = 1;
        (0..count).all(|at| {
            let below = depths[at] + 1;
            self.nodes.children(at).into_iter().all(|child| {
                let index = child.index.get();
                match child.kind.get() {
                    ChildRef::EMPTY => true,
                    ChildRef::INNER => {
                        let place = index as usize; // 28 bits
                        let ahead = place > at && place < count && u32::from(below) <= self.nodes.most_depth();
                        if ahead {
                            depths[place] = depths[place].max(below);
                        }
                        ahead
                    }
                    ChildRef::LEAF if self.blocks.is_empty() => index + child.count.get() < triangles,
                    ChildRef::LEAF if are_dense => {
                        let (block, place) = (index as usize / DENSE_PLACES, index as usize % DENSE_PLACES); // 28 bits
                        let last = |size: &BlockSize| {
                            dense_named(place, size.triangles() as usize).map(|first| first + child.count.get() as usize)
                        };
                        self.blocks.get(block).is_some_and(|size| last(size).is_some_and(|last| last < size.triangles() as usize))
                    }
                    ChildRef::LEAF => lines.get(index as usize).is_some_and(|&lines| u64::from(lines) == child.count.get() + 1),
                    _ => false,
                }
            })
        })
    }
}

impl FullNodes {
    fn raw(&self) -> &[u8] {
        match self {
            Self::Local(nodes) => bytemuck::cast_slice(nodes),
            Self::Boxes16(nodes) => bytemuck::cast_slice(nodes),
            Self::Boxes32(nodes) => bytemuck::cast_slice(nodes),
            Self::Six(nodes) => bytemuck::cast_slice(nodes),
        }
    }

    /// The children of a node; those beyond the fourth are empty where nodes have four.
    pub(in crate::method) fn children(&self, at: usize) -> [ChildRef; 6] {
        let four = |child: &dyn Fn(usize) -> ChildRef| std::array::from_fn(|k| if k < 4 { child(k) } else { ChildRef::default() });
        match self {
            Self::Local(nodes) => four(&|k| BvhNode::line_child(&nodes[at], k)),
            Self::Boxes16(nodes) => four(&|k| BvhChild::from_words(&nodes[at][2 * k..]).child),
            Self::Boxes32(nodes) => four(&|k| BvhChild32::from_words(&nodes[at][4 * k..]).child),
            Self::Six(nodes) => {
                let node = SixNode::from_words(&nodes[at]);
                std::array::from_fn(|k| node.child(k))
            }
        }
    }

    /// Whether every node names a frame that there is.
    fn have_frames(&self) -> bool {
        match self {
            Self::Six(nodes) => nodes.iter().all(|node| (SixNode::from_words(node).rotation.get() as usize) < ROTATIONS),
            Self::Local(_) | Self::Boxes16(_) | Self::Boxes32(_) => true,
        }
    }

    /// Most nodes on a path from the root.
    fn most_depth(&self) -> u32 {
        if matches!(self, Self::Six(_)) { MAX_DEPTH_OF_SIX } else { MAX_DEPTH }
    }
}

/// `count` values from a file.
fn filled<T: bytemuck::Pod>(count: usize, file: &mut dyn Read) -> Option<Vec<T>> {
    let mut values = vec![T::zeroed(); count];
    file.read_exact(bytemuck::cast_slice_mut(&mut values)).ok()?;
    Some(values)
}

fn checksum(parts: &[&[u8]]) -> u128 {
    let mut hash = Xxh3Default::new();
    parts.iter().for_each(|part| hash.update(part));
    hash.digest128()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::check::synthetic_terrain;
    use crate::method::mesh_bvh::{FullBuilder, NodeBoxes};
    use crate::num::U;
    use proptest::prelude::*;
    use xxhash_rust::xxh3::xxh3_64;

    const KEY: TreeKey = TreeKey(7 << 100 | 3);

    const ALL: [NodeBoxes; 5] = [NodeBoxes::Local, NodeBoxes::Codes, NodeBoxes::Wide, NodeBoxes::Six, NodeBoxes::Oriented];

    const LAYOUTS: [LeafLayout; 2] = [LeafLayout::Line, LeafLayout::Block];

    fn tree(boxes: NodeBoxes, layout: LeafLayout) -> FullTree {
        FullBuilder::new(&synthetic_terrain(3, 2)).unwrap().tree(&FullOptions::new(2, boxes, layout)).unwrap()
    }

    fn file(tree: &FullTree) -> Vec<u8> {
        let mut bytes = Vec::new();
        tree.write(KEY, &mut bytes).unwrap();
        bytes
    }

    fn read(bytes: &[u8]) -> Option<FullTree> {
        FullTree::read(KEY, 288, bytes.len() as u64, &mut &*bytes)
    }

    #[test]
    fn what_was_written_is_read() {
        for (boxes, layout) in ALL.into_iter().flat_map(|boxes| LAYOUTS.map(|layout| (boxes, layout))) {
            let tree = tree(boxes, layout);
            assert_eq!((tree.ids.len(), tree.blocks.is_empty()), (288, layout == LeafLayout::Line));
            assert!(read(&file(&tree)).is_some_and(|read| read == tree), "{boxes:?} {layout:?}");
        }
    }

    #[test]
    fn a_file_of_another_key_or_scene_is_none() {
        let bytes = file(&tree(NodeBoxes::Codes, LeafLayout::Line));
        let of = |key, triangles| FullTree::read(key, triangles, bytes.len() as u64, &mut &*bytes);
        assert!(of(KEY, 288).is_some() && of(TreeKey(8), 288).is_none() && of(KEY, 287).is_none());
    }

    #[test]
    fn references_that_lead_nowhere_make_no_tree_even_with_the_right_sum() {
        let sound = tree(NodeBoxes::Codes, LeafLayout::Line);
        let with = |kind: u64, index: u64, count: u64| {
            let mut tree = sound.clone();
            let FullNodes::Boxes16(nodes) = Arc::make_mut(&mut tree.nodes) else { panic!("16") };
            let child = match kind {
                ChildRef::INNER => ChildRef::inner(index as u32),
                _ => ChildRef::leaf(index as u32, count as u32),
            };
            let mut words = [0; 1];
            child.to_words(&mut words);
            // The first field of a child: its uppermost 32 bits.
            nodes[5][1] = nodes[5][1] & u64::from(u32::MAX) | words[0] << 32;
            read(&file(&tree))
        };
        assert!(with(ChildRef::LEAF, 0, 2).is_some());
        for (kind, index, count) in
            [(ChildRef::INNER, 5, 0), (ChildRef::INNER, 0, 0), (ChildRef::INNER, 1 << 27, 0), (ChildRef::LEAF, 286, 4)]
        {
            assert!(with(kind, index, count).is_none(), "{kind} {index}");
        }
        let mut wrong = sound.clone();
        wrong.ids[7] = 288;
        assert!(read(&file(&wrong)).is_none());
        // A frame that there is none of.
        let mut tree = tree(NodeBoxes::Oriented, LeafLayout::Block);
        assert!(read(&file(&tree)).is_some());
        let FullNodes::Six(nodes) = Arc::make_mut(&mut tree.nodes) else { panic!("6") };
        let mut node = SixNode::from_words(&nodes[1]);
        node.rotation = U::new(ROTATIONS as u64);
        node.to_words(&mut nodes[1]);
        assert!(read(&file(&tree)).is_none());
        // Blocks of other sizes than leaves say, or of fewer triangles.
        let sound = self::tree(NodeBoxes::Local, LeafLayout::Block);
        let with = |at: usize, size: BlockSize| {
            let mut tree = sound.clone();
            tree.blocks[at] = size;
            read(&file(&tree))
        };
        let size = sound.blocks[3];
        assert!(with(3, size).is_some() && with(3, BlockSize::new(16, size.lines())).is_none());
        assert!(with(3, BlockSize::new(size.triangles() as usize, size.lines() + 1)).is_none());
        // Dense blocks that leaves go beyond, and some among others.
        let mut terrain = synthetic_terrain(3, 2);
        terrain.points.iter_mut().flatten().for_each(|c| *c &= !0xffff);
        let sound = FullBuilder::new(&terrain).unwrap().tree(&FullOptions::new(4, NodeBoxes::Six, LeafLayout::Dgf)).unwrap();
        assert!(read(&file(&sound)).is_some_and(|read| read == sound));
        let [one, other] = [1, 2].map(|at| sound.blocks[at].triangles() as usize);
        let with = |sizes: [BlockSize; 2]| {
            let mut tree = sound.clone();
            tree.blocks[1..3].copy_from_slice(&sizes);
            read(&file(&tree))
        };
        assert!(with([one, other].map(BlockSize::dense)).is_some() && with([one - 1, other + 1].map(BlockSize::dense)).is_none());
        let mut mixed = sound.clone();
        mixed.blocks[1] = BlockSize::new(one.min(16), 4);
        mixed.blocks.extend((one > 16).then(|| BlockSize::dense(one - 16)));
        assert!(read(&file(&mixed)).is_none());
    }

    /// Whoever changes what is built must raise [`VERSION`], so that trees of before are not taken for those of now.
    #[test]
    fn the_version_names_what_is_built() {
        let terrain = synthetic_terrain(5, 3);
        let builder = FullBuilder::new(&terrain).unwrap();
        let of = |(size, layout)| {
            let options = FullOptions::new(size, NodeBoxes::Local, layout);
            xxh3_64(&file(&builder.tree(&options).unwrap()))
        };
        let six = xxh3_64(&file(&builder.tree(&FullOptions::new(16, NodeBoxes::Six, LeafLayout::Block)).unwrap()));
        let sums = [(1, LeafLayout::Indexed), (2, LeafLayout::Line), (4, LeafLayout::Line), (16, LeafLayout::Block)].map(of);
        assert_eq!(
            (VERSION, six, sums),
            (4, 0xa38f0713c5f5b7cd, [0x63c49df4f1ae6ed0, 0x5547fcf4f0167064, 0xf4c49ead359ca61d, 0x48ab57d4ddbec6c2])
        );
    }

    proptest! {
        #[test]
        fn damage_is_noticed(at in any::<prop::sample::Index>(), bit in 0u32..8, boxes in prop::sample::select(ALL.to_vec()), layout in prop::sample::select(LAYOUTS.to_vec())) {
            let mut bytes = file(&tree(boxes, layout));
            let at = at.index(bytes.len());
            bytes[at] ^= 1u8 << bit;
            prop_assert!(read(&bytes).is_none());
            bytes[at] ^= 1u8 << bit;
            prop_assert!(read(&bytes[..at]).is_none());
            bytes.push(0);
            prop_assert!(read(&bytes).is_none());
        }
    }
}
