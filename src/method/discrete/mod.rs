//! Discrete level of detail: a quad-BVH with boxes of up to 16 bits over each whole level of the hierarchy, of which all rays of a frame use one.
//!
//! The level is the coarsest whose displacement is tolerated where the model is nearest: with h the largest displacement bound of the level's edges, r the
//! smallest radius of any ray's cone at the model, h <= 2 r / delta, as the LOD test has it of each edge (paper section 4.1); or the one that is chosen.

mod levels;

use super::bvh::{
    BvhTracer, BvhTraverser, FullBuilder, FullBvh, FullOptions, LEAF_LAYOUT, LEAF_SIZE, NODE_BOXES, NODE_ORDER, NodeBoxes, TreeKey,
    TreeStore, UNIT, bvh_map, level_ids,
};
use super::knob::{DELTA, ErrorKnob};
use super::packet::{self, PACKET};
use super::{Knob, Knobs, Method, MethodUnit, Over, Registered, Tracer};
use crate::block::Operation;
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::num::MAX_LEVELS;
use crate::rays::{ModelSpace, Sight};
use crate::step::MemoryMap;

use levels::largest_bounds;
use std::sync::Arc;

/// The level for all rays.
pub static LEVEL: Knob = Knob {
    name: "level",
    value_name: "LEVEL",
    help: "Level of the discrete method, 0 the base mesh; the finest if the scene has fewer (default: chosen for the frame by --delta)",
    default: None,
    words: &[],
    of_frame: false,
    allows: |value| {
        let level = value.parse().ok().filter(|level| (0..=MAX_LEVELS).contains(level));
        level.map(|_: u32| ()).ok_or_else(|| format!("'{value}' is not a level from 0 to {MAX_LEVELS}"))
    },
};

/// The method.
pub static METHOD: Registered = Registered {
    name: "discrete",
    help: "Discrete levels of detail: a quad-BVH of each level, one level for the whole frame",
    knobs: &[&DELTA, &LEVEL, &NODE_BOXES, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE, &PACKET],
    // Every level: by quality it has the finest alone where the eye is within the model's box.
    error: Some(ErrorKnob { knob: &LEVEL, values: || (0..=MAX_LEVELS).map(f64::from).collect(), in_steps: true }),
    over: Over::Scene,
    unit: Some(MethodUnit {
        blocks: &{
            // As for a BVH, and a hit on a coarse triangle is mapped to the full resolution.
            let mut operations = [Operation::BaryMap; UNIT.len() + 1];
            operations.split_at_mut(UNIT.len()).0.copy_from_slice(UNIT);
            operations
        },
        has_levels: false,
    }),
    works: &[],
    make: |scene, knobs, store| Discrete::of(scene, knobs, store),
};

/// The method on a scene.
struct Discrete {
    levels: Arc<Levels>,
    chosen: Option<usize>,
    space: ModelSpace,
    /// Rays that are traced together.
    lanes: usize,
}

/// All levels.
pub(super) struct Levels {
    bvhs: Vec<FullBvh>,
    /// Largest displacement bound of each level's edges, in units; 0 for the finest.
    pub bounds: Vec<u64>,
}

impl Levels {
    /// A BVH of each level of a scene.
    ///
    /// # Errors
    /// The knobs do not go together, or a BVH cannot be built.
    pub fn of(scene: &Scene, knobs: &Knobs, store: &dyn TreeStore) -> Result<Self, BvhError> {
        let options = FullOptions::chosen(knobs, NodeBoxes::named)?;
        let hierarchy = scene.decode();
        let bvh = |level| {
            let key = || TreeKey::new(scene, &options, level);
            let triangles = (scene.trees() as u64) << (2 * level);
            let build = &mut || FullBuilder::of_cut(&hierarchy, level_ids(&hierarchy, level))?.tree(&options);
            store.tree(&key, triangles, build)?.with_leaves(&hierarchy, options.layout)
        };
        Ok(Self { bvhs: (0..=scene.levels()).map(bvh).collect::<Result<_, _>>()?, bounds: largest_bounds(&hierarchy) })
    }

    /// The finest.
    pub fn finest(&self) -> usize {
        self.bvhs.len() - 1
    }

    /// The displacement that is tolerated where the model is nearest, in units.
    pub fn tolerance(&self, sight: &Sight) -> f64 {
        if sight.delta > 0.0 { 2.0 * sight.least_radius / sight.delta } else { f64::INFINITY }
    }

    /// The memory of all, whose rays begin with the nodes of this one.
    pub fn map(&self, level: usize) -> MemoryMap {
        let nodes = |bvh: &FullBvh| bvh.nodes.len() as u32; // below 2^28
        let before = self.bvhs[..level].iter().map(nodes).sum();
        bvh_map(&self.bvhs.iter().collect::<Vec<_>>()).from_node(before, nodes(&self.bvhs[level]))
    }

    /// Traces rays through one.
    pub fn tracer(&self, level: usize, space: ModelSpace) -> BvhTracer {
        let before = bvh_map(&self.bvhs[..level].iter().collect::<Vec<_>>());
        let all = bvh_map(&self.bvhs.iter().collect::<Vec<_>>());
        BvhTracer::new(BvhTraverser::behind(&self.bvhs[level], all, &before), space, self.finest() as u32) // at most 10
    }
}

/// The level that was chosen, of this many and a finest.
fn chosen(knobs: &Knobs, finest: u32) -> Option<usize> {
    let level: u32 = knobs.get(&LEVEL)?.parse().ok()?;
    Some(level.min(finest) as usize)
}

impl Discrete {
    fn of(scene: &Scene, knobs: &Knobs, store: &dyn TreeStore) -> Result<Box<dyn Method>, BvhError> {
        Ok(Box::new(Self {
            levels: Arc::new(Levels::of(scene, knobs, store)?),
            chosen: chosen(knobs, scene.levels()),
            space: ModelSpace::of(scene),
            lanes: packet::chosen(knobs),
        }))
    }

    fn level(&self, sight: &Sight) -> usize {
        let bounds = &self.levels.bounds;
        let tolerance = self.levels.tolerance(sight);
        let serves = || bounds.iter().position(|&bound| bound as f64 <= tolerance);
        self.chosen.or_else(serves).unwrap_or(bounds.len() - 1)
    }
}

impl Method for Discrete {
    fn map(&self, sight: &Sight) -> MemoryMap {
        self.levels.map(self.level(sight))
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(self.levels.tracer(self.level(sight), self.space).in_packets(self.lanes))
    }

    fn alike(&self, sight: &Sight) -> Option<u64> {
        Some(self.level(sight) as u64)
    }

    fn again(&self, knobs: &Knobs) -> Option<Box<dyn Method>> {
        let finest = self.levels.finest() as u32; // at most 10
        Some(Box::new(Self { levels: Arc::clone(&self.levels), chosen: chosen(knobs, finest), space: self.space, lanes: self.lanes }))
    }

    fn choices(&self, sight: &Sight) -> Vec<(&'static str, String)> {
        vec![("level", self.level(sight).to_string())]
    }
}
