//! What a scene needs, measured on all its nodes.

use super::needs::{bits, needs, signed_bits};
use crate::format::{BvhNode, ChildRef, Scene, SplitRecord, child_corners};
use crate::mesh::compact::inserted_zero_bits;
use crate::num::{MAX_LEVELS, Wire, bound_decode, displacement_shift};
use rayon::prelude::*;

needs! {
    /// What a scene needs, each number the least that serves it.
    pub struct SceneNeeds {
        most {
            /// Splits N.
            levels: u32,
            /// Levels that a tree is stored to.
            stored_levels: u32,
            /// Quad-BVH nodes on the longest path from the root to a tree.
            bvh_depth: u32,
            /// Entries that can wait on the traversal stack at once.
            stack_entries: u32,
            /// Bits of the number of a quad-BVH node.
            bvh_node_bits: u32,
            /// Bits of the number of a tree.
            tree_bits: u32,
            /// Bits of the number of a memory line.
            line_bits: u32,
            /// Bits of a coordinate in units, with its sign.
            coordinate_bits: u32,
            /// Bits of a box code, with its sign: of the origin of a quad-BVH node's frame.
            frame_bits: u32,
            /// Bits of a plane of a quad-BVH node.
            node_plane_bits: u32,
            /// Largest exponent of a step of a quad-BVH node.
            node_exponent: u32,
            /// Bits of a plane of a split.
            split_plane_bits: u32,
            /// Largest exponent of a step of a split.
            split_exponent: u32,
            /// Some step is half as long again.
            half_steps: bool,
            /// Bits of a bound code.
            code_bits: u32,
            /// Bits of a displacement bound in units.
            bound_bits: u32,
            /// Inserted vertices are stored as displacements.
            compact: bool,
            /// Inserted vertices are stored as they are.
            exact: bool,
            /// Bits of a displacement, with its sign.
            displacement_bits: u32,
            /// Largest shift of a displacement.
            displacement_shift: u32,
        }
        least {
            /// Zero bits at the bottom of every coordinate, of morphed triangles and of the rays' origins too.
            coordinate_zeros,
            /// Zero bits at the bottom of every coordinate of full resolution.
            vertex_zeros,
            /// Zero bits at the bottom of every component of a direction.
            direction_zeros,
        }
    }
}

/// What is met on the way through a scene's trees.
#[derive(Clone, Copy)]
pub(super) struct Met {
    least: i32,
    most: i32,
    /// All bits of all coordinates.
    ones: u32,
    /// Largest code of an edge of each level's nodes.
    pub codes: [u8; MAX_LEVELS as usize],
    /// Nodes of each level that some ray could split: those with a code other than 0, below such nodes.
    pub splits: [u64; MAX_LEVELS as usize],
    /// A node above the finest level has three codes of 0: every ray ends there.
    pub stops_early: bool,
    displacement: [i32; 2],
    shift: u32,
    split_planes: u32,
    split_exponent: u32,
    half: bool,
}

impl Default for Met {
    fn default() -> Self {
        Self {
            least: 0,
            most: 0,
            ones: 0,
            codes: [0; MAX_LEVELS as usize],
            splits: [0; MAX_LEVELS as usize],
            stops_early: false,
            displacement: [0; 2],
            shift: 0,
            split_planes: 0,
            split_exponent: 0,
            half: false,
        }
    }
}

impl Met {
    fn points(&mut self, points: [[i32; 3]; 3]) {
        for c in points.into_iter().flatten() {
            self.least = self.least.min(c);
            self.most = self.most.max(c);
            self.ones |= c.cast_unsigned();
        }
    }

    fn both(mut self, other: Self) -> Self {
        self.least = self.least.min(other.least);
        self.most = self.most.max(other.most);
        self.ones |= other.ones;
        for (code, of) in self.codes.iter_mut().zip(other.codes) {
            *code = (*code).max(of);
        }
        for (splits, of) in self.splits.iter_mut().zip(other.splits) {
            *splits += of;
        }
        self.stops_early |= other.stops_early;
        let [least, most] = other.displacement;
        self.displacement = [self.displacement[0].min(least), self.displacement[1].max(most)];
        self.shift = self.shift.max(other.shift);
        self.split_planes = self.split_planes.max(other.split_planes);
        self.split_exponent = self.split_exponent.max(other.split_exponent);
        self.half |= other.half;
        self
    }

    /// The node (`level`, `node`) with corners `p` and all below it. What lies below a node with three codes of 0 is read by no ray.
    fn node(&mut self, scene: &Scene, tree: usize, (level, node): (u32, usize), p: [[i32; 3]; 3]) {
        let (levels, meta, lines) = (scene.levels(), scene.meta(), scene.tree_lines(tree));
        if level == levels {
            return;
        }
        let codes = scene.node_codes(tree, level, node);
        let most = codes.into_iter().max().unwrap_or(0);
        let of_level = &mut self.codes[level as usize];
        *of_level = (*of_level).max(most);
        if most == 0 {
            self.stops_early = true;
            return;
        }
        self.splits[level as usize] += 1;
        let q = scene.inserted(tree, level, node, p);
        self.points(q);
        if meta.vertices.is_compact() {
            for c in scene.displacements(tree, level, node).into_iter().flat_map(|v| v.get()) {
                let c = c as i32; // 13 bits
                self.displacement = [self.displacement[0].min(c), self.displacement[1].max(c)];
            }
            let zeros = inserted_zero_bits(levels, level, meta.coordinate_zeros);
            self.shift = codes.into_iter().map(|code| displacement_shift(meta.bound_scale(), code, zeros)).fold(self.shift, u32::max);
        }
        if level + 1 < lines.depth {
            let split = SplitRecord::from_words(&scene.splits()[scene.level_starts().split(lines, level, node)]);
            self.split_planes = split.planes.iter().map(|plane| plane.get() as u32).fold(self.split_planes, u32::max); // 2 bits
            self.split_exponent = split.exponents.iter().map(|e| e.get() as u32).fold(self.split_exponent, u32::max); // 4 bits
            self.half |= split.halves.iter().any(|&half| half);
        }
        for k in 0..4 {
            self.node(scene, tree, (level + 1, 4 * node + k), child_corners(p, q, k));
        }
    }
}

/// Everything met in all trees of a scene.
pub(super) fn met(scene: &Scene) -> Met {
    let tree = |tree: usize| {
        let (mut met, p) = (Met::default(), scene.corners(tree));
        met.points(p);
        met.node(scene, tree, (0, 0), p);
        met
    };
    (0..scene.trees()).into_par_iter().map(tree).reduce(Met::default, Met::both)
}

/// What is met on the way through a quad-BVH.
#[derive(Default)]
struct Nodes {
    depth: u32,
    /// Siblings that can wait while a tree is under visit, in the quad-BVH and in the tree.
    waiting: u32,
    frame: [i64; 2],
    planes: u32,
    exponent: u32,
    half: bool,
}

impl Nodes {
    fn of(scene: &Scene) -> Self {
        let mut nodes = Self::default();
        if !scene.nodes().is_empty() {
            nodes.node(scene, 0, 1, 0);
        }
        nodes
    }

    /// Node `index` on that level of the path from the root, 1 there, with so many siblings waiting. Checked scenes have paths of at most 24.
    fn node(&mut self, scene: &Scene, index: usize, level: u32, waiting: u32) {
        let node = BvhNode::from_words(&scene.nodes()[index]);
        let children: Vec<_> = (0..4).map(|k| node.child(k)).filter(|child| child.kind.get() != ChildRef::EMPTY).collect();
        let waiting = waiting + children.len().saturating_sub(1) as u32; // at most 3
        self.depth = self.depth.max(level);
        for c in node.origin.get() {
            self.frame = [self.frame[0].min(c), self.frame[1].max(c)];
        }
        self.planes = node.planes.iter().map(|plane| plane.get() as u32).fold(self.planes, u32::max); // 5 bits
        self.exponent = node.exponents.iter().map(|e| e.get() as u32).fold(self.exponent, u32::max); // 4 bits
        self.half |= node.halves.iter().any(|&half| half);
        for child in children {
            let index = child.index.get() as usize; // 28 bits
            if child.kind.get() == ChildRef::INNER {
                self.node(scene, index, level + 1, waiting);
            } else {
                // Three children of each level of a tree but the last wait, whose triangles are tested at once.
                self.waiting = self.waiting.max(waiting + 3 * scene.tree_lines(index).depth.saturating_sub(1));
            }
        }
    }
}

impl SceneNeeds {
    pub(super) fn of(scene: &Scene, met: &Met) -> Self {
        let (nodes, levels, compact) = (Nodes::of(scene), scene.levels(), scene.meta().vertices.is_compact());
        let last = |count: usize| (count as u64).saturating_sub(1);
        let lines = scene.nodes().len() + scene.records().len() + scene.splits().len() + scene.vertices().len();
        let code = met.codes.into_iter().max().unwrap_or(0);
        Self {
            levels,
            stored_levels: scene.depths().into_iter().max().unwrap_or(0),
            bvh_depth: nodes.depth,
            stack_entries: nodes.waiting,
            bvh_node_bits: bits(last(scene.nodes().len())),
            tree_bits: bits(last(scene.trees())),
            line_bits: bits(last(lines)),
            coordinate_bits: signed_bits(met.least.into(), met.most.into()),
            frame_bits: signed_bits(nodes.frame[0], nodes.frame[1]),
            node_plane_bits: bits(nodes.planes.into()),
            node_exponent: nodes.exponent,
            split_plane_bits: bits(met.split_planes.into()),
            split_exponent: met.split_exponent,
            half_steps: met.half || nodes.half,
            code_bits: bits(code.into()),
            bound_bits: bits(bound_decode(scene.meta().bound_scale(), code)),
            compact,
            exact: !compact,
            displacement_bits: signed_bits(met.displacement[0].into(), met.displacement[1].into()),
            displacement_shift: met.shift,
            coordinate_zeros: scene.meta().coordinate_zeros,
            vertex_zeros: met.ones.trailing_zeros(),
            direction_zeros: scene.meta().direction_zeros,
        }
    }
}
