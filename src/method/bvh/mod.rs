//! BVH over the full-resolution mesh: the baseline (paper section 6.1). Nodes have four children and boxes of 16-bit codes, or of 5 bits in a frame of their
//! own, or of 32 bits; or six children and boxes of 8 bits in a frame.

mod map;
mod packet;
mod trace;

pub use super::mesh_bvh::{
    DenseBlock, DenseStrip, FullBuilder, FullBvh, FullNodes, FullOptions, FullTree, Leaf, LeafLayout, Leaves, NoStore, NodeBoxes,
    NodeOrder, TreeKey, TreeStore, check_hierarchy, cut_id, cut_triangle, dense_triangles, level_ids,
};
pub use map::{LEAVES, NODES, bvh_map};
pub use trace::BvhTraverser;

use super::packet::{PACKET, PacketOfQueries};
use super::{AllHits, ClosestHit, Departure, Knob, Knobs, Landing, Method, MethodUnit, Over, Registered, SurfaceHit, Trace, Tracer};
use crate::block::{Operation, Work};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::rays::{ModelSpace, Query, Sight};
use crate::step::{MemoryMap, NoSteps, StepSink};

/// How leaf triangles lie in memory.
pub static LEAF_LAYOUT: Knob = Knob {
    name: "leaf-layout",
    value_name: "LEAF_LAYOUT",
    help: "Leaf layout of a BVH",
    default: Some("block"),
    words: &[
        ("indexed", "Index triples and shared vertices"),
        ("packed", "Nine 32-bit coordinates, 36 bytes"),
        ("line", "One 32-byte line of 28-bit coordinates"),
        ("block", "Leaves of up to 16 triangles that share vertices, in one to four lines"),
        ("dgf", "Blocks of 128 bytes of AMD's dense geometry format, of up to 64 triangles in several leaves; coordinates of 24 bits"),
    ],
    of_frame: false,
    allows: |value| LeafLayout::named(value).map(drop).ok_or_else(|| format!("'{value}' is not indexed, packed, line, block or dgf")),
};

/// Largest number of triangles in a leaf.
pub static LEAF_SIZE: Knob = Knob {
    name: "leaf-size",
    value_name: "LEAF_SIZE",
    help: "Largest number of triangles in a leaf of a BVH: 1, 2, 4, 8 or 16; at most 4 where leaves are no blocks",
    default: Some("16"),
    words: &[],
    of_frame: false,
    allows: |value| if ["1", "2", "4", "8", "16"].contains(&value) { Ok(()) } else { Err(format!("'{value}' is not 1, 2, 4, 8 or 16")) },
};

/// How nodes hold boxes of 16 bits or fewer.
pub static NODE_BOXES: Knob = Knob {
    name: "node-boxes",
    value_name: "NODE_BOXES",
    help: "Boxes of a BVH's nodes",
    default: Some("local"),
    words: &[
        ("local", "Steps in a frame of the node's own: of 5 bits, a node in 32 bytes; in nodes of six of 8 bits"),
        ("codes", "Codes of 16 bits, a node in 64 bytes, as in the paper; not in nodes of six"),
        ("oriented", "In nodes of six: as local, but the frame is turned by one of 125 rotations"),
    ],
    of_frame: false,
    allows: |value| {
        let boxes = NodeBoxes::named(value).or(NodeBoxes::named_of_six(value));
        boxes.map(drop).ok_or_else(|| format!("'{value}' is not local, codes or oriented"))
    },
};

/// Where nodes lie.
pub static NODE_ORDER: Knob = Knob {
    name: "node-order",
    value_name: "NODE_ORDER",
    help: "Order of a BVH's nodes in memory",
    default: Some("depth"),
    words: &[
        ("depth", "Depth first, siblings together"),
        ("treelets", "By treelets of 2 KB, a row of DRAM, that grow along the largest boxes"),
        ("levels", "Level by level"),
        ("veb", "Van Emde Boas' order: the upper levels, then each part below, each again so"),
    ],
    of_frame: false,
    allows: |value| NodeOrder::named(value).map(drop).ok_or_else(|| format!("'{value}' is not depth, treelets, levels or veb")),
};

/// Operations of a unit with these tests of boxes: four at once, then their order.
const fn unit(boxes: Operation) -> [Operation; 10] {
    [
        Operation::RaySetup,
        Operation::NodeAddress,
        boxes,
        boxes,
        boxes,
        boxes,
        Operation::ChildSort,
        Operation::TriTest,
        Operation::HitDivide,
        Operation::HitSelect,
    ]
}

/// Operations of a unit for nodes with boxes of up to 16 bits: it has what decodes local ones, used or not.
pub(super) const UNIT: &[Operation] = &{
    let mut operations = [Operation::BoxDecode; 14];
    operations.split_at_mut(10).0.copy_from_slice(&unit(Operation::BoxTest));
    operations
};

/// The method with boxes of up to 16 bits.
pub static METHOD: Registered = Registered {
    name: "bvh",
    help: "Quad-BVH of the full-resolution mesh, boxes of up to 16 bits",
    knobs: &[&NODE_BOXES, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE, &PACKET],
    error: None,
    over: Over::Scene,
    unit: Some(MethodUnit { blocks: UNIT, has_levels: false }),
    works: &[],
    make: |scene, knobs, store| Bvh::of(scene, knobs, NodeBoxes::named, store),
};

/// Operations of a unit for nodes of six.
const UNIT_OF_SIX: &[Operation] = &{
    let mut operations = [Operation::BoxTest; 18];
    operations[0] = Operation::RaySetup;
    operations[1] = Operation::NodeAddress;
    operations[2] = Operation::ChildSort6;
    operations[3] = Operation::TriTest;
    operations[4] = Operation::HitDivide;
    operations[5] = Operation::HitSelect;
    operations.split_at_mut(6).1.split_at_mut(6).0.copy_from_slice(&[Operation::BoxDecode8; 6]);
    operations
};

/// A ray is turned: nine products of its origin and as many of its direction, their sums, and that of rounding to nearest. The ray in its frame is written.
///
/// No block does this yet. Its constants in the frame are those of a `ray_setup`, which [`NodeShape::Turned`](crate::step::NodeShape::Turned) has.
const TURN: Work = Work {
    name: "turn",
    products: &[[9, ORIGIN, FACTOR], [9, COMPONENT, FACTOR]],
    add_bits: 3 * 2 * (ORIGIN + FACTOR) + 3 * 3 * (COMPONENT + FACTOR),
    select_bits: 0,
    written_bits: 3 * (ORIGIN + COMPONENT),
};

/// Bits of a coordinate of an origin, of a component of a direction, and of a number of a [`Rotation`](crate::num::Rotation).
const ORIGIN: u32 = 32;
const COMPONENT: u32 = 31;
const FACTOR: u32 = 8;

/// The method with nodes of six children.
pub static METHOD_SIX: Registered = Registered {
    name: "bvh6",
    help: "BVH of six children a node, in 64 bytes, with boxes in steps of 8 bits",
    knobs: &[&NODE_BOXES, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE, &PACKET],
    error: None,
    over: Over::Scene,
    unit: Some(MethodUnit { blocks: UNIT_OF_SIX, has_levels: false }),
    works: &[TURN],
    make: |scene, knobs, store| Bvh::of(scene, knobs, NodeBoxes::named_of_six, store),
};

/// The method with 32-bit boxes.
pub static METHOD_WIDE: Registered = Registered {
    name: "bvh32",
    help: "Quad-BVH of the full-resolution mesh, 32-bit boxes",
    knobs: &[&NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE, &PACKET],
    error: None,
    over: Over::Scene,
    unit: Some(MethodUnit { blocks: &unit(Operation::BoxTest32), has_levels: false }),
    works: &[],
    make: |scene, knobs, store| Bvh::of(scene, knobs, |_| Some(NodeBoxes::Wide), store),
};

/// [`METHOD`] over the mesh that the scene was made from: what somebody traces who has that mesh and no levels of detail.
pub static METHOD_INPUT: Registered = Registered {
    name: "input-bvh",
    help: "bvh over the triangles of the mesh that the scene was built from",
    knobs: METHOD.knobs,
    error: None,
    over: Over::Input,
    unit: METHOD.unit,
    works: &[],
    make: |scene, knobs, store| Bvh::of(scene.input().ok_or(BvhError::NoInput)?, knobs, NodeBoxes::named, store),
};

/// [`METHOD_SIX`] over that mesh.
pub static METHOD_INPUT_SIX: Registered = Registered {
    name: "input-bvh6",
    help: "bvh6 over the triangles of the mesh that the scene was built from",
    knobs: METHOD_SIX.knobs,
    error: None,
    over: Over::Input,
    unit: METHOD_SIX.unit,
    works: METHOD_SIX.works,
    make: |scene, knobs, store| Bvh::of(scene.input().ok_or(BvhError::NoInput)?, knobs, NodeBoxes::named_of_six, store),
};

/// [`METHOD_WIDE`] over that mesh.
pub static METHOD_INPUT_WIDE: Registered = Registered {
    name: "input-bvh32",
    help: "bvh32 over the triangles of the mesh that the scene was built from",
    knobs: METHOD_WIDE.knobs,
    error: None,
    over: Over::Input,
    unit: METHOD_WIDE.unit,
    works: &[],
    make: |scene, knobs, store| Bvh::of(scene.input().ok_or(BvhError::NoInput)?, knobs, |_| Some(NodeBoxes::Wide), store),
};

/// The boxes of this name, if a method's nodes can have such boxes.
pub type NamedBoxes = fn(&str) -> Option<NodeBoxes>;

impl FullOptions {
    /// Those that were chosen. `boxes` says which boxes a method's nodes have by a name of [`NODE_BOXES`].
    ///
    /// # Errors
    /// Its nodes have no such boxes.
    pub fn chosen(knobs: &Knobs, boxes: NamedBoxes) -> Result<Self, BvhError> {
        let boxes = knobs.get(&NODE_BOXES).and_then(boxes).ok_or(BvhError::NodeBoxes)?;
        // Checked when they were chosen.
        let layout = knobs.get(&LEAF_LAYOUT).and_then(LeafLayout::named).unwrap_or(LeafLayout::Block);
        let size = knobs.get(&LEAF_SIZE).and_then(|size| size.parse().ok()).unwrap_or(16);
        let order = knobs.get(&NODE_ORDER).and_then(NodeOrder::named).unwrap_or_default();
        Ok(Self { order, ..Self::new(size, boxes, layout) })
    }
}

/// The method on a scene.
struct Bvh {
    bvh: FullBvh,
    space: ModelSpace,
    /// Rays that are traced together.
    lanes: usize,
}

impl Bvh {
    fn of(scene: &Scene, knobs: &Knobs, boxes: NamedBoxes, store: &dyn TreeStore) -> Result<Box<dyn Method>, BvhError> {
        let options = FullOptions::chosen(knobs, boxes)?;
        let hierarchy = scene.decode();
        let key = || TreeKey::new(scene, &options, scene.levels());
        let tree = store.tree(&key, scene.finest_triangles(), &mut || FullBuilder::new(&hierarchy)?.tree(&options))?;
        let bvh = tree.with_leaves(&hierarchy, options.layout)?;
        Ok(Box::new(Self { bvh, space: ModelSpace::of(scene), lanes: super::packet::chosen(knobs) }))
    }
}

impl Method for Bvh {
    fn map(&self, _: &Sight) -> MemoryMap {
        bvh_map(&[&self.bvh])
    }

    fn alike(&self, _: &Sight) -> Option<u64> {
        Some(0)
    }

    fn tracer(&self, _: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(BvhTracer::new(BvhTraverser::new(&self.bvh), self.space, self.bvh.levels).in_packets(self.lanes))
    }
}

/// Rays through a BVH of triangles of a hierarchy.
pub(super) struct BvhTracer {
    traverser: BvhTraverser,
    space: ModelSpace,
    /// Number of splits N of the scene.
    levels: u32,
    /// Rays that are traced together.
    lanes: usize,
    packet: PacketOfQueries,
}

impl BvhTracer {
    pub fn new(traverser: BvhTraverser, space: ModelSpace, levels: u32) -> Self {
        Self { traverser, space, levels, lanes: 1, packet: PacketOfQueries::default() }
    }

    /// The same with so many rays traced together.
    pub fn in_packets(self, lanes: usize) -> Self {
        Self { lanes, ..self }
    }
}

impl Trace for BvhTracer {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        // Its triangles are what they are, whatever the quality.
        let ray = self.space.enter(query, 1.0)?;
        let mut hit = ClosestHit::of(self.levels, &ray, query.any);
        self.traverser.descend(&ray.ray, None, steps, &mut hit);
        hit.surface(&ray)
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        let ray = self.space.enter_from(query, from.map(|from| &from.start), 1.0)?;
        let mut hit = ClosestHit::of(self.levels, &ray, query.any);
        self.traverser.descend(&ray.ray, from, steps, &mut hit);
        hit.landing(&ray, BvhTraverser::departure)
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        if let Some(ray) = self.space.enter(query, 1.0) {
            let mut all = AllHits::of(self.levels, &ray);
            self.traverser.descend(&ray.ray, None, &mut NoSteps, &mut all);
            all.surfaces(&ray, hits);
        }
        true
    }

    fn is_mapped(&self) -> bool {
        self.traverser.is_mapped()
    }

    fn lanes(&self) -> usize {
        self.lanes
    }

    fn packet<S: StepSink>(&mut self, queries: &[Query], hits: &mut Vec<Option<SurfaceHit>>, steps: &mut S) {
        self.packet.enter(queries, &self.space, 1.0, self.levels);
        self.traverser.packet(&mut self.packet.packet, steps);
        self.packet.hits(hits);
    }
}
