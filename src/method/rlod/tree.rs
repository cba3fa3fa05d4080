//! The structure in memory: nodes of 8 bytes, or 12 with a word for level of detail, siblings side by side; lists of references; a line for each triangle; R-LODs of a line each.

use super::build::{COSTS, Costs, Raw, RawTree, halves, kd_tree};
use super::planes::{Errors, NUMBER_BITS, Planes, Rlod, rlods};
use crate::bvh::{Box32, BvhError};
use crate::format::Scene;
use crate::mesh::Hierarchy;
use crate::method::bvh::level_ids;
use crate::method::mesh_bvh::Corners;
use glam::DVec3;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Where nodes lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum KdOrder {
    /// Depth first.
    Depth,
    /// Together with what a ray is likely to visit next, by the area of cells (paper section 5.2).
    #[default]
    Area,
}

/// How a [`Tree`] is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RlodOptions {
    /// Which nodes have R-LODs, and how they are measured.
    pub planes: Planes,
    /// Where nodes lie.
    pub order: KdOrder,
    /// What the heuristic weighs.
    pub costs: Costs,
}

impl Default for RlodOptions {
    fn default() -> Self {
        Self { planes: Planes { every: 3, weight: 16.0 }, order: KdOrder::default(), costs: COSTS }
    }
}

/// Bytes that are filled with what is likely to be visited together: a page.
const TREELET_BYTES: usize = 4096;

/// Which of a node's lower two bits say that it is a leaf.
const LEAF: u32 = 3;
/// No R-LOD.
const NONE: u32 = u32::MAX;

/// A node as it stands in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Axis of the split, or 3 of a leaf; above, the number of the left child, or of the first reference.
    word: u32,
    /// The split in units, or how many references a leaf has.
    value: i32,
    /// Code of the error in the upper five bits, number of the R-LOD below; all ones if it has none. It is not there in a tree without any.
    lod: u32,
}

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Split at `at` along `axis`; the right child is next to the left one.
    Inner {
        /// 0 to 2.
        axis: usize,
        /// In units.
        at: i32,
        /// Number of the left child.
        left: u32,
    },
    /// References.
    Leaf {
        /// The first.
        first: u32,
        /// How many.
        count: u32,
    },
}

impl Node {
    /// What it is.
    #[inline(always)]
    pub fn kind(&self) -> Kind {
        let (low, high) = (self.word & LEAF, self.word >> 2);
        if low == LEAF {
            Kind::Leaf { first: high, count: self.value.cast_unsigned() }
        } else {
            Kind::Inner { axis: low as usize, at: self.value, left: high }
        }
    }

    /// Code of its error, and number of its R-LOD.
    #[inline(always)]
    pub fn rlod(&self) -> Option<[u32; 2]> {
        (self.lod != NONE).then_some([self.lod >> NUMBER_BITS, self.lod & ((1 << NUMBER_BITS) - 1)])
    }
}

/// A kd-tree with R-LODs over the finest triangles of a scene.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Box of everything.
    pub cell: Box32,
    /// Nodes; the first is the root.
    pub nodes: Vec<Node>,
    /// Places of the triangles of leaves.
    pub references: Vec<u32>,
    /// Corners of triangles, in the order in which leaves first name them.
    pub triangles: Vec<[[i32; 3]; 3]>,
    /// Number of the finest triangle in each place.
    pub ids: Vec<u32>,
    /// R-LODs in the order of their nodes.
    pub rlods: Vec<Rlod>,
    /// Errors by code.
    pub errors: Errors,
    /// Bytes of a node.
    pub node_bytes: u64,
}

impl Tree {
    /// The tree of a scene's finest triangles.
    ///
    /// # Errors
    /// No or too many triangles, or more nodes or R-LODs than can be numbered.
    pub fn new(scene: &Scene, options: &RlodOptions) -> Result<Self, BvhError> {
        let levels = scene.levels();
        let colours = |id: u32| {
            let colour = scene.colour(scene.material((id >> (2 * levels)) as usize));
            colour.map_or(DVec3::ONE, |colour| DVec3::from_array(colour.map(f64::from)))
        };
        Self::over(&scene.decode(), &colours, options)
    }

    /// The same of a hierarchy, whose finest triangles have these linear colours by their numbers.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn over(hierarchy: &Hierarchy, colours: &(dyn Fn(u32) -> DVec3 + Sync), options: &RlodOptions) -> Result<Self, BvhError> {
        let corners = Corners::new(hierarchy)?;
        let triangles: Vec<_> = level_ids(hierarchy, hierarchy.levels).into_iter().map(|id| corners.triangle(id)).collect();
        let cell = triangles.iter().map(|&t| Box32::of_triangle(t)).reduce(|all, own| all.union(&own)).ok_or(BvhError::Empty)?;
        let raw = kd_tree(&triangles, &cell, options.costs);
        // 30 bits name a node, and a reference.
        let most = raw.nodes.len().max(raw.references.len()) as u64;
        if most >= 1 << 30 {
            return Err(BvhError::TooMany(most));
        }
        let planes = rlods(&raw, &triangles, &cell, colours, options.planes);
        if planes.len() >= 1 << NUMBER_BITS {
            return Err(BvhError::TooMany(planes.len() as u64));
        }
        Ok(Self::laid_out(&raw, triangles, cell, planes, options))
    }

    fn laid_out(raw: &RawTree, triangles: Vec<[[i32; 3]; 3]>, cell: Box32, planes: Vec<(u32, Rlod)>, options: &RlodOptions) -> Self {
        let node_bytes = if planes.is_empty() { 8 } else { 12 };
        let order = match options.order {
            KdOrder::Depth => by_depth(raw),
            KdOrder::Area => by_area(raw, &cell, TREELET_BYTES / (2 * node_bytes as usize)),
        };
        let mut places = vec![0u32; raw.nodes.len()];
        order.iter().zip(0..).for_each(|(&at, place)| places[at as usize] = place);

        // References and triangles follow the nodes.
        let mut firsts = Vec::with_capacity(raw.nodes.len());
        let mut sum = 0usize;
        for node in &raw.nodes {
            firsts.push(sum);
            sum += if let Raw::Leaf(count) = node { *count as usize } else { 0 };
        }
        let (mut references, mut ids) = (Vec::with_capacity(raw.references.len()), Vec::with_capacity(triangles.len()));
        let mut known = vec![NONE; triangles.len()];
        let mut first_of = vec![0u32; raw.nodes.len()];
        for &at in &order {
            let Raw::Leaf(count) = raw.nodes[at as usize] else { continue };
            first_of[at as usize] = references.len() as u32; // checked: below 2^30
            for &id in &raw.references[firsts[at as usize]..][..count as usize] {
                let place = &mut known[id as usize];
                if *place == NONE {
                    *place = ids.len() as u32; // at most 2^28
                    ids.push(id);
                }
                references.push(*place);
            }
        }
        let errors = Errors::of(planes.iter().map(|(_, rlod)| rlod.radius).collect());
        let mut lods: Vec<u32> = vec![NONE; raw.nodes.len()];
        let mut by_place: Vec<_> = planes.iter().map(|(at, rlod)| (places[*at as usize], *at, *rlod)).collect();
        by_place.sort_unstable_by_key(|(place, ..)| *place);
        for ((_, at, rlod), number) in by_place.iter().zip(0..) {
            lods[*at as usize] = errors.code(rlod.radius) << NUMBER_BITS | number;
        }
        let node = |&at: &u32| {
            let at = at as usize;
            let (word, value) = match raw.nodes[at] {
                Raw::Inner { axis, at: split, .. } => (places[at + 1] << 2 | u32::from(axis), split),
                Raw::Leaf(count) => (first_of[at] << 2 | LEAF, count.cast_signed()), // at most 2^28
            };
            Node { word, value, lod: lods[at] }
        };
        Self {
            cell,
            nodes: order.iter().map(node).collect(),
            references,
            triangles: ids.iter().map(|&id| triangles[id as usize]).collect(),
            ids,
            rlods: by_place.into_iter().map(|(.., rlod)| rlod).collect(),
            errors,
            node_bytes,
        }
    }

    /// Memory in bytes: nodes, references, triangles, R-LODs.
    pub fn bytes(&self) -> [u64; 4] {
        let lines = |count: usize| 32 * count as u64;
        [self.node_bytes * self.nodes.len() as u64, 4 * self.references.len() as u64, lines(self.triangles.len()), lines(self.rlods.len())]
    }

    /// How many leaves there are.
    pub fn leaves(&self) -> usize {
        self.nodes.len() / 2 + 1
    }
}

/// Siblings side by side, and depth first.
fn by_depth(raw: &RawTree) -> Vec<u32> {
    let mut order = vec![0];
    let mut waiting = vec![0];
    while let Some(at) = waiting.pop() {
        if let Raw::Inner { skip, .. } = raw.nodes[at as usize] {
            let both = [at + 1, at + skip];
            order.extend(both);
            waiting.extend(both.into_iter().rev());
        }
    }
    order
}

/// The children of an inner node, by the area of its cell; of equal areas the first of memory goes first.
#[derive(PartialEq, Eq)]
struct Pair {
    /// Half the area, as bits: not negative, so ordered like the numbers.
    area: u64,
    at: u32,
    cell: Box32,
}

impl Pair {
    fn of(at: u32, cell: Box32) -> Self {
        Self { area: cell.half_area().to_bits(), at, cell }
    }
}

impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Pair {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.area, Reverse(self.at)).cmp(&(other.area, Reverse(other.at)))
    }
}

/// Siblings side by side, in treelets of so many pairs, each the likeliest to be visited of what is next to those before: a ray that visits a node visits a child as often as the area of the
/// child's cell is to that of the node's. Treelets follow each other depth first.
fn by_area(raw: &RawTree, cell: &Box32, pairs: usize) -> Vec<u32> {
    let mut order = vec![0];
    let mut begins = vec![Pair::of(0, *cell)];
    while let Some(begin) = begins.pop() {
        let mut next = BinaryHeap::from([begin]);
        for _ in 0..pairs {
            let Some(Pair { at, cell, .. }) = next.pop() else { break };
            let Raw::Inner { axis, at: split, skip } = raw.nodes[at as usize] else { continue };
            let both = [at + 1, at + skip];
            order.extend(both);
            let below = both.into_iter().zip(halves(&cell, axis.into(), split));
            next.extend(below.filter(|(at, _)| is_inner(raw, *at)).map(|(at, cell)| Pair::of(at, cell)));
        }
        let mut rest = next.into_vec();
        // The first of memory is taken next.
        rest.sort_unstable_by_key(|pair| Reverse(pair.at));
        begins.extend(rest);
    }
    order
}

fn is_inner(raw: &RawTree, at: u32) -> bool {
    matches!(raw.nodes[at as usize], Raw::Inner { .. })
}
