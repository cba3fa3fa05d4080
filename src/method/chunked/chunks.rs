//! Chunks of a model, and which level each of them has.

use crate::bvh::Box32;
use crate::mesh::{Hierarchy, SharedEdges, edge_index, lattice, parts};
use crate::method::TriangleId;
use crate::method::bvh::cut_id;
use crate::num::{MAX_LEVELS, bound_decode};
use crate::rays::Sight;
use rayon::prelude::*;
use std::collections::HashSet;

/// What a chunk is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChunkShape {
    /// All base triangles that hang together.
    Object,
    /// A triangle of any level, split so many times.
    Splits(u32),
}

/// Box and displacements of a part of a model.
#[derive(Clone, Copy, Debug)]
struct Extent {
    bounds: Box32,
    /// Largest bound code of its edges of each level.
    codes: [u8; MAX_LEVELS as usize + 1],
}

impl Extent {
    fn with(mut self, other: &Self) -> Self {
        self.bounds = self.bounds.union(&other.bounds);
        self.codes.iter_mut().zip(other.codes).for_each(|(code, other)| *code = other.max(*code));
        self
    }
}

/// All chunks of a model.
pub struct Chunks {
    shape: ChunkShape,
    levels: u32,
    trees: u32,
    /// The object of each tree, if chunks are objects.
    objects: Vec<u32>,
    /// Objects; or, level by level, every triangle that may be one.
    extents: Vec<Vec<Extent>>,
    /// Sides of trees, by tree and number, that no other tree shares.
    open: HashSet<(u32, u8)>,
}

impl Chunks {
    /// The chunks of a hierarchy that has its points and bounds.
    ///
    /// # Panics
    /// It lacks some.
    pub fn new(hierarchy: &Hierarchy, shape: ChunkShape) -> Self {
        let levels = hierarchy.levels;
        let last = match shape {
            ChunkShape::Object => 0,
            ChunkShape::Splits(splits) => levels.saturating_sub(splits),
        };
        let trees: Vec<_> = (0..hierarchy.triangles.len())
            .into_par_iter()
            .map(|tree| {
                let mut found = vec![Vec::new(); last as usize + 1];
                measure(hierarchy, tree, 0, lattice::root(levels), &mut found);
                found
            })
            .collect();
        let of_level = |level: usize| trees.iter().flat_map(move |found| &found[level]).copied();
        let (objects, extents) = match shape {
            ChunkShape::Object => {
                let (objects, count) = parts(&hierarchy.triangles);
                let mut extents: Vec<Option<Extent>> = vec![None; count];
                for (&object, extent) in objects.iter().zip(of_level(0)) {
                    let own = &mut extents[object as usize];
                    *own = Some(own.map_or(extent, |own| own.with(&extent)));
                }
                (objects, vec![extents.into_iter().flatten().collect()])
            }
            ChunkShape::Splits(_) => (Vec::new(), (0..=last as usize).map(|level| of_level(level).collect()).collect()),
        };
        let shared = SharedEdges::new(&hierarchy.triangles);
        let open = shared.edges().filter(|uses| uses.len() == 1).flatten().map(|of| (of.tree, of.side)).collect();
        Self { shape, levels, trees: hierarchy.triangles.len() as u32, objects, extents, open } // at most 2^28
    }

    /// Triangles of what is chosen for these rays, by their ids: of each chunk the coarsest level whose displacement its nearest point tolerates.
    pub fn chosen(&self, hierarchy: &Hierarchy, sight: &Sight) -> Vec<u32> {
        let mut ids = Vec::new();
        self.each(hierarchy, sight, |chunk, level| {
            let below = 2 * (level - chunk.level);
            let nodes = chunk.node << below..(chunk.node + 1) << below;
            ids.extend(nodes.map(|node| cut_id(self.levels, TriangleId { tree: chunk.tree, level, node })));
        });
        ids
    }

    /// How many chunks are chosen, and how many edges of their triangles are no other's, though the model goes on there: where neighbours differ in level.
    pub fn seams(&self, hierarchy: &Hierarchy, sight: &Sight) -> (usize, usize) {
        let (mut chunks, mut edges) = (0, Vec::new());
        self.each(hierarchy, sight, |chunk, level| {
            chunks += 1;
            // Objects end where others begin.
            if self.shape != ChunkShape::Object {
                self.border(hierarchy, chunk, level, &mut edges);
            }
        });
        if self.shape == ChunkShape::Object {
            chunks = self.extents[0].len();
        }
        edges.par_sort_unstable();
        (chunks, edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).count())
    }

    /// Tells `of` each chunk that is chosen, in order, and the level of its triangles.
    fn each(&self, hierarchy: &Hierarchy, sight: &Sight, mut of: impl FnMut(TriangleId, u32)) {
        let tolerated = |extent: &Extent, level: u32| {
            let [lo, hi] = [extent.bounds.lo, extent.bounds.hi].map(|corner| corner.map(f64::from));
            let tolerance = if sight.delta > 0.0 { 2.0 * sight.least_radius_in(lo, hi) / sight.delta } else { f64::INFINITY };
            // The finest level has no codes.
            level == self.levels || bound_decode(hierarchy.bounds.scale, extent.codes[level as usize]) as f64 <= tolerance
        };
        let root = |tree| TriangleId { tree, level: 0, node: 0 };
        match self.shape {
            ChunkShape::Object => {
                let level = |extent: &Extent| (0..=self.levels).find(|&level| tolerated(extent, level)).unwrap_or(self.levels);
                let of_object: Vec<u32> = self.extents[0].iter().map(level).collect();
                (0..self.trees).zip(&self.objects).for_each(|(tree, &object)| of(root(tree), of_object[object as usize]));
            }
            ChunkShape::Splits(splits) => {
                let mut waiting: Vec<TriangleId> = (0..self.trees).rev().map(root).collect();
                while let Some(chunk) = waiting.pop() {
                    let extent = &self.extents[chunk.level as usize][((chunk.tree as usize) << (2 * chunk.level)) + chunk.node as usize];
                    let finest = (chunk.level + splits).min(self.levels);
                    // Base triangles may be split less often.
                    let coarsest = if chunk.level == 0 { 0 } else { finest };
                    match (coarsest..=finest).find(|&level| tolerated(extent, level)) {
                        Some(level) => of(chunk, level),
                        // Where its last level is the finest, that is tolerated.
                        None => {
                            waiting.extend((0..4).rev().map(|k| TriangleId { level: chunk.level + 1, node: 4 * chunk.node + k, ..chunk }))
                        }
                    }
                }
            }
        }
    }

    /// The edges of a chunk's border, by the positions of their ends; none where the model ends.
    fn border(&self, hierarchy: &Hierarchy, chunk: TriangleId, level: u32, edges: &mut Vec<[[i32; 3]; 2]>) {
        let (points, m) = (hierarchy.tree(chunk.tree as usize), 1 << self.levels);
        let corners = lattice::node(self.levels, chunk.level, chunk.node);
        let count = 1i64 << (level - chunk.level);
        let on_side = |side: u8, (i, j): lattice::LatticePoint| match side {
            0 => i + j == m,
            1 => i == 0,
            _ => j == 0,
        };
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            if (0..3).any(|side| on_side(side, from) && on_side(side, to) && self.open.contains(&(chunk.tree, side))) {
                continue;
            }
            let along = |a: u32, b: u32, at: i64| (i64::from(a) + (i64::from(b) - i64::from(a)) / count * at) as u32;
            let point = |at| points[lattice::index(self.levels, (along(from.0, to.0, at), along(from.1, to.1, at)))];
            edges.extend((0..count).map(|at| {
                let (a, b) = (point(at), point(at + 1));
                [a.min(b), a.max(b)]
            }));
        }
    }
}

/// The extent of a triangle of `level` of a tree, with those of all below it down to the levels that are found.
fn measure(hierarchy: &Hierarchy, tree: usize, level: u32, corners: [lattice::LatticePoint; 3], found: &mut [Vec<Extent>]) -> Extent {
    let levels = hierarchy.levels;
    let mut extent = Extent {
        bounds: Box32::of_triangle(corners.map(|at| hierarchy.tree(tree)[lattice::index(levels, at)])),
        codes: [0; MAX_LEVELS as usize + 1],
    };
    if level < levels {
        let [p, q, r] = corners;
        let code = |a, b| hierarchy.codes(tree)[edge_index(levels, level, a, b)];
        extent.codes[level as usize] = code(p, q).max(code(q, r)).max(code(r, p));
        for k in 0..4 {
            extent = extent.with(&measure(hierarchy, tree, level + 1, lattice::child(corners, k), found));
        }
    }
    if let Some(own) = found.get_mut(level as usize) {
        own.push(extent);
    }
    extent
}
