//! Levels of detail of a grid: how deep the tree of each primitive is gone through, which triangles are then at its end (paper section 2.2).
//!
//! Corners, boundaries and insides of all levels are those of the hierarchy, so a coarser level has its vertices, whatever they are displaced by: the paper's first limitation does not
//! arise. Its second does: where neighbours have different caps the boundary between them is open, and rays pass through. These edges are counted.

use super::mesh::GridMesh;
use crate::mesh::{Hierarchy, lattice};
use crate::num::bound_decode;
use crate::rays::Sight;
use rayon::prelude::*;
use std::sync::Arc;

/// Splits below primitives.
#[derive(Clone, Debug)]
pub enum Caps {
    /// As many for all.
    Frame(u32),
    /// Of each primitive.
    Each(Arc<Vec<u8>>),
}

impl Caps {
    /// The splits below a primitive.
    #[inline(always)]
    pub fn of(&self, primitive: usize) -> u32 {
        match self {
            Self::Frame(cap) => *cap,
            Self::Each(caps) => caps[primitive].into(),
        }
    }
}

/// Of each primitive the largest bound code of its edges at depth 0 to K - 1, by the rule of which `chunked` chooses.
pub struct Displacements {
    codes: Vec<[u8; 4]>,
    scale: crate::num::BoundScale,
}

impl Displacements {
    /// Those of the primitives of a hierarchy.
    pub fn new(hierarchy: &Hierarchy, mesh: &GridMesh) -> Self {
        let splits = mesh.pattern.splits;
        let level = hierarchy.levels - splits;
        let most = |tree: u32, node: u32, depth: u32| {
            let below = (node << (2 * depth))..((node + 1) << (2 * depth));
            let codes = |node| {
                let p = lattice::node(hierarchy.levels, level + depth, node);
                hierarchy.node_codes(tree as usize, level + depth, p).into_iter().max().unwrap_or(0)
            };
            below.map(codes).max().unwrap_or(0)
        };
        let of = |&(tree, node): &(u32, u32)| {
            std::array::from_fn(|depth| if depth < splits as usize { most(tree, node, depth as u32) } else { 0 })
        };
        Self { codes: mesh.ids.par_iter().map(of).collect(), scale: hierarchy.bounds.scale }
    }

    /// The least caps whose displacement each primitive's nearest point tolerates: h <= 2 r / delta with h the largest bound at that depth and r the least radius of a cone in its box.
    pub fn caps(&self, mesh: &GridMesh, sight: &Sight) -> Vec<u8> {
        let splits = mesh.pattern.splits;
        let of = |(codes, bounds): (&[u8; 4], &crate::bvh::Box32)| {
            let [lo, hi] = [bounds.lo, bounds.hi].map(|corner| corner.map(f64::from));
            let tolerance = if sight.delta > 0.0 { 2.0 * sight.least_radius_in(lo, hi) / sight.delta } else { f64::INFINITY };
            // The finest level has no codes.
            let serves = |&depth: &u32| depth == splits || bound_decode(self.scale, codes[depth as usize]) as f64 <= tolerance;
            (0..=splits).find(serves).unwrap_or(splits) as u8 // at most 4
        };
        // By one thread: those that trace wait for it, and would wait for themselves if they took part.
        self.codes.iter().zip(&mesh.boxes).map(of).collect()
    }
}

/// Edges of triangles that no other triangle has, though the model goes on there: those of boundaries at which only one primitive has its cap.
pub fn open_edges(mesh: &GridMesh, caps: &Caps) -> usize {
    let splits = mesh.pattern.splits;
    if splits == 0 {
        return 0;
    }
    // Of each boundary, how many primitives meet there by cap, at most 255 of each counted.
    let mut uses = vec![[0u8; 5]; mesh.boundary_count()];
    for primitive in 0..mesh.ids.len() {
        let (tuple, cap) = (mesh.tuple(primitive), caps.of(primitive));
        for side in 0..3 {
            let own = &mut uses[tuple.edge(splits, side)][cap as usize];
            *own = own.saturating_add(1);
        }
    }
    let open = |of: &[u8; 5]| {
        let is_shared = of.iter().map(|&count| u32::from(count)).sum::<u32>() > 1;
        (0..5).filter(|&cap| is_shared && of[cap] == 1).map(|cap| 1 << cap).sum::<usize>()
    };
    uses.iter().map(open).sum()
}
