//! The structure: nodes depth first, blocks of indices, vertices.
//!
//! A node has a box of full precision and a number. Of an inner node that is the size of its left subtree: the left child is the next node, the right child lies behind that subtree, and as
//! many leaves lie in it as a binary tree of that size has. Of a leaf of n triangles it is -n - 1. Leaf k has the index triples 16 k to 16 k + 15, of which the first n are triangles.

use crate::bvh::build::{Binary, Prim, binary_tree_of};
use crate::bvh::{Box32, BvhError, MAX_DEPTH_OF_SIX};
use crate::mesh::Hierarchy;
use crate::method::mesh_bvh::{Corners, shared_vertices};
use crate::num::LINE_BYTES;

/// Most triangles of a leaf, and places for triangles in each.
pub const LEAF: usize = 16;
/// Bins of the surface area heuristic along each axis.
const BINS: usize = 256;
/// Lines of a node: 28 of 32 bytes are used.
pub const NODE_LINES: u64 = 1;
/// Bytes of an index triple, and of a vertex.
pub const TRIPLE_BYTES: u64 = 12;
/// Lines of a leaf's triples.
pub const LEAF_LINES: u64 = LEAF as u64 * TRIPLE_BYTES / LINE_BYTES;
const _: () = assert!(LEAF_LINES * LINE_BYTES == LEAF as u64 * TRIPLE_BYTES);

/// What fills a leaf that has fewer triangles.
const PADDING: [u32; 3] = [0; 3];

/// A node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// The box of everything below.
    pub bounds: Box32,
    /// Nodes of the left subtree, or -n - 1 of a leaf of n triangles.
    offset: i32,
}

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nodes and leaves of its left subtree.
    Inner {
        /// Nodes: the right child is so many behind the left one.
        nodes: u32,
        /// Leaves.
        leaves: u32,
    },
    /// Triangles.
    Leaf(usize),
}

impl Node {
    /// What it is.
    #[inline(always)]
    pub fn kind(&self) -> Kind {
        match u32::try_from(self.offset) {
            Ok(nodes) => Kind::Inner { nodes, leaves: nodes.div_ceil(2) },
            Err(_) => Kind::Leaf((-self.offset - 1) as usize), // 1 to 16
        }
    }
}

/// A binary BVH over the finest triangles of a hierarchy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tree {
    /// Number of splits N of the hierarchy.
    pub levels: u32,
    /// Nodes, depth first; the first is the root.
    pub nodes: Vec<Node>,
    /// Indices of the vertices of triangles, 16 triples for each leaf.
    pub triples: Vec<[u32; 3]>,
    /// Vertices, in the order in which leaves first use them.
    pub vertices: Vec<[i32; 3]>,
    /// Number of the finest triangle in the place of each triple. A design would look it up once for each final hit; it is not part of the memory.
    pub ids: Vec<u32>,
    /// Triangles.
    pub triangles: usize,
    /// Every coordinate is a number of single precision, and stands in memory as one. Otherwise all are whole numbers of 32 bits.
    pub has_floats: bool,
    /// Places for triangles in each leaf.
    pub leaf: usize,
}

impl Tree {
    /// Builds it: the surface area heuristic over 256 bins down to 16 triangles, split until none has more.
    ///
    /// # Errors
    /// No or too many triangles, too many levels, points missing or beyond the coordinate limit.
    pub fn new(hierarchy: &Hierarchy) -> Result<Self, BvhError> {
        Self::with_leaves(hierarchy, LEAF)
    }

    /// The same down to `leaf` triangles, for whom does not ask for lines.
    pub(super) fn with_leaves(hierarchy: &Hierarchy, leaf: usize) -> Result<Self, BvhError> {
        let mesh = Corners::new(hierarchy)?;
        let mut prims = mesh.primitives(0..mesh.count() as u32); // at most 2^28
        let binary = binary_tree_of::<BINS>(&mut prims, MAX_DEPTH_OF_SIX, leaf);
        let mut layout = Layout { prims: &prims, binary: &binary, leaf, nodes: Vec::new(), firsts: Vec::new() };
        layout.subtree(0, prims.len(), binary.root as usize);
        let Layout { nodes, firsts, .. } = layout;
        drop(binary);
        let order: Vec<u32> = prims.iter().map(|prim| prim.id).collect();
        drop(prims);
        let (packed, vertices) = shared_vertices(&mesh, &order);
        let ends = firsts.iter().skip(1).copied().chain([order.len()]);
        let mut triples = Vec::with_capacity(leaf * firsts.len());
        let mut ids = Vec::with_capacity(leaf * firsts.len());
        for (&first, end) in firsts.iter().zip(ends) {
            triples.extend_from_slice(&packed[first..end]);
            ids.extend_from_slice(&order[first..end]);
            let padded = triples.len().next_multiple_of(leaf);
            triples.resize(padded, PADDING);
            ids.resize(padded, 0);
        }
        let has_floats = vertices.iter().flatten().all(|&c| is_float(c));
        Ok(Self { levels: hierarchy.levels, nodes, triples, vertices, ids, triangles: order.len(), has_floats, leaf })
    }

    /// How many leaves there are.
    pub fn leaves(&self) -> usize {
        self.triples.len() / self.leaf
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> u64 {
        NODE_LINES * LINE_BYTES * self.nodes.len() as u64 + TRIPLE_BYTES * (self.triples.len() + self.vertices.len()) as u64
    }
}

/// Whether single precision has this number.
fn is_float(c: i32) -> bool {
    f64::from(c as f32) == f64::from(c)
}

/// A tree while its nodes are put into their order.
struct Layout<'a> {
    prims: &'a [Prim],
    binary: &'a Binary,
    /// Most triangles of a leaf.
    leaf: usize,
    nodes: Vec<Node>,
    /// Of each leaf the first of its primitives.
    firsts: Vec<usize>,
}

impl Layout<'_> {
    /// Appends what is over the primitives from `begin` to before `end`, which are split at `split` if they are more than a leaf holds.
    fn subtree(&mut self, begin: usize, end: usize, split: usize) {
        let count = end - begin;
        if count <= self.leaf {
            let boxes = self.prims[begin..end].iter().map(Prim::bounds);
            let bounds = boxes.reduce(|all, own| all.union(&own)).unwrap_or_default();
            self.firsts.push(begin);
            self.nodes.push(Node { bounds, offset: -(count as i32) - 1 }); // at most 16
            return;
        }
        let node = self.binary.nodes[split - 1];
        let own = self.nodes.len();
        self.nodes.push(Node { bounds: node.bounds, offset: 0 });
        self.subtree(begin, split, node.left as usize);
        self.nodes[own].offset = (self.nodes.len() - own - 1) as i32; // fewer than 2^29 nodes
        self.subtree(split, end, node.right as usize);
    }
}
