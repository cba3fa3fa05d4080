//! Discrete level of detail by object or by chunk, as engines have it: each takes the level that its own distance tolerates, by the rule of `discrete`.
//!
//! Chunks of a surface are triangles of the hierarchy, split so many times: large ones far away, small ones near (chunked level of detail, Ulrich 2002). Where
//! neighbours differ in level the surface has seams that rays pass through: nothing hides them here, they are counted.
//!
//! All triangles of a frame stand under one BVH, which is made for the frame and costs it nothing: less than any engine pays, which keeps one for each chunk and
//! level and a BVH over those. Its bytes are those of the frame's BVH alone. Frames after one another have one choice, by the nearest of their eyes.

mod chunks;

pub use chunks::{ChunkShape, Chunks};

use super::bvh::{
    BvhTracer, BvhTraverser, FullBuilder, FullBvh, FullOptions, LEAF_LAYOUT, LEAF_SIZE, NODE_BOXES, NODE_ORDER, NodeBoxes, bvh_map,
    check_hierarchy,
};
use super::knob::{DELTA, ErrorKnob, octaves};
use super::recent::Recent;
use super::{Knob, Knobs, Method, Over, Registered, Tracer, discrete};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::mesh::Hierarchy;
use crate::num::MAX_LEVELS;
use crate::rays::{ModelSpace, Sight};
use crate::step::MemoryMap;
use std::sync::Arc;

/// What chooses its level by itself.
pub static CHUNK: Knob = Knob {
    name: "chunk",
    value_name: "CHUNK",
    help: "What has a level of its own in the chunked method: object, or how often the triangles of the hierarchy are split that make a chunk, 1 to 10",
    default: Some("2"),
    words: &[],
    of_frame: false,
    allows: |value| shape(value).map(drop).ok_or_else(|| format!("'{value}' is not object, or a number of splits from 1 to {MAX_LEVELS}")),
};

fn shape(value: &str) -> Option<ChunkShape> {
    let splits = || value.parse().ok().filter(|splits| (1..=MAX_LEVELS).contains(splits)).map(ChunkShape::Splits);
    if value == "object" { Some(ChunkShape::Object) } else { splits() }
}

/// The method.
pub static METHOD: Registered = Registered {
    name: "chunked",
    help: "Discrete levels of detail by object or chunk: each has a level for the frame, and seams to its neighbours; its bytes are of the frame's BVH alone",
    knobs: &[&DELTA, &CHUNK, &NODE_BOXES, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE],
    error: Some(ErrorKnob { knob: &DELTA, values: octaves, in_steps: false }),
    over: Over::Scene,
    unit: discrete::METHOD.unit,
    works: &[],
    make: |scene, knobs, _| Ok(Box::new(Chunked::of(scene, knobs)?)),
};

/// Triangles in all of BVHs that are kept for other frames: some 20 bytes each.
const KEPT: usize = 1 << 25;

/// The method on a scene.
struct Chunked {
    hierarchy: Hierarchy,
    chunks: Chunks,
    options: FullOptions,
    space: ModelSpace,
    /// The BVHs of what was seen last.
    made: Recent<FullBvh>,
}

impl Chunked {
    fn of(scene: &Scene, knobs: &Knobs) -> Result<Self, BvhError> {
        let hierarchy = scene.decode();
        check_hierarchy(&hierarchy)?;
        // Checked when it was chosen.
        let shape = knobs.get(&CHUNK).and_then(shape).unwrap_or(ChunkShape::Object);
        Ok(Self {
            chunks: Chunks::new(&hierarchy, shape),
            hierarchy,
            options: FullOptions::chosen(knobs, NodeBoxes::named)?,
            space: ModelSpace::of(scene),
            made: Recent::new(|bvh| bvh.leaves.len(), KEPT),
        })
    }

    /// The BVH of all frames.
    fn bvh(&self, sight: &Sight) -> Arc<FullBvh> {
        let sight = &sight.whole();
        self.made.get(sight, || {
            let ids = self.chunks.chosen(&self.hierarchy, sight);
            let tree = FullBuilder::of_cut(&self.hierarchy, ids).and_then(|builder| builder.tree(&self.options));
            let bvh = tree.and_then(|tree| tree.with_leaves(&self.hierarchy, self.options.layout));
            bvh.expect("the hierarchy was checked, and triangles of a cut are no more than its finest")
        })
    }
}

impl Method for Chunked {
    fn map(&self, sight: &Sight) -> MemoryMap {
        bvh_map(&[&self.bvh(sight)])
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        let bvh = self.bvh(sight);
        Box::new(BvhTracer::new(BvhTraverser::of_coarse(&bvh), self.space, self.hierarchy.levels))
    }

    fn choices(&self, sight: &Sight) -> Vec<(&'static str, String)> {
        let (chunks, seams) = self.chunks.seams(&self.hierarchy, sight);
        let triangles = self.chunks.chosen(&self.hierarchy, sight).len();
        [("chunks", chunks), ("triangles", triangles), ("open edges", seams)].map(|(name, count)| (name, count.to_string())).to_vec()
    }
}
