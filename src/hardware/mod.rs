//! A hardware as one value: how deep its hierarchies are, how many rays it has under way, how much it tests and divides in a cycle.
//!
//! Everything that depends on such a choice follows from [`Hardware`]: the timing and the parts of each block ([`Block::timing`],
//! [`Block::parts`]), the sizes of the cycle model, the registers of a ray context ([`Hardware::context_registers`]), and `rtl/lod_pkg.sv`
//! ([`Hardware::package`]), from which the RTL takes all its sizes. What goes in and out of a traversal unit ([`ports`]) is the same for
//! every value, so that one memory image, one testbench and one cycle model serve them all: a hardware for fewer levels takes the same bits
//! and has fewer registers inside.

mod area;
mod context;
mod eased;
mod package;
pub mod ports;
mod resource;
mod state;

pub use area::{block_gates, context_gates, unit_gates};
pub use context::Memory;
pub use eased::{Eased, EasedError};
pub(crate) use resource::Resource;
pub use state::{Fetch, RayError, State};

use crate::block::{Block, BoxesPerCycle, EdgesPerCycle, Form, MOST_DIVIDE_BITS, Operation, Timing};
use crate::num::{BOX_SHIFT, MAX_BOUND_OFFSET, MAX_BVH_DEPTH, MAX_LEVELS, MOST_DIRECTION_ZEROS};
use ports::SceneConfig;

/// The widest number of a context: it and two bits of place make the tag of a memory request ([`ports::MemoryRequest`]).
const MAX_CONTEXT_BITS: u32 = 6;
/// The most contexts that a unit can have.
pub const MAX_CONTEXTS: usize = 1 << MAX_CONTEXT_BITS;
/// The most blocks of one kind that take turns ([`Hardware::setup_copies`], [`Hardware::divide_copies`]): with more, two hits would meet in `hit_select`.
pub const MOST_COPIES: u32 = 4;
/// The most bits of a number of nodes, trees and lines of a section ([`L0Record`](crate::format::L0Record), [`BvhNode`](crate::format::BvhNode)).
pub(crate) const MOST_INDEX_BITS: u32 = 28;

/// A hardware: `rtl/lod_pkg.sv` as it stands is that of the default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hardware {
    /// The most 1-to-4 splits N that a model may have, 2 to [`MAX_LEVELS`].
    pub levels: u32,
    /// Levels that trees are stored to ([`Scene::depths`](crate::format::Scene::depths)), if fewer than `levels`: 0 to `levels`. At 0 no triangle is ever split: a unit without LOD
    /// test and tessellation.
    pub fewer_stored_levels: Option<u32>,
    /// The most quad-BVH nodes on a path from the root to a tree, 1 to [`MAX_BVH_DEPTH`].
    pub bvh_depth: u32,
    /// Fewer entries of a traversal stack than its depth asks for, at least 2: for scenes of which is known how many can wait.
    pub fewer_stack_entries: Option<u32>,
    /// Ray contexts of a traversal unit, 1 to 2^`context_bits`.
    pub contexts: usize,
    /// Bits of a context's number, 1 to 6.
    pub context_bits: u32,
    /// Edge functions that the triangle test evaluates in a cycle.
    pub edges_per_cycle: EdgesPerCycle,
    /// Edges of a triangle that the LOD test takes in a cycle.
    pub lod_edges_per_cycle: EdgesPerCycle,
    /// Bits of a quotient that the division of hits finds in a cycle, 1 to 3.
    pub divide_bits: u32,
    /// Bits of each reciprocal that the constants of a ray take in a cycle, 1 to 3.
    pub setup_bits: u32,
    /// Blocks of the constants of a ray that take turns, 1 to [`MOST_COPIES`].
    pub setup_copies: u32,
    /// Blocks of the division of hits that take turns, 1 to [`MOST_COPIES`].
    pub divide_copies: u32,
    /// Boxes that the test of four children tests in a cycle.
    pub boxes_per_cycle: BoxesPerCycle,
    /// Registers between contexts and blocks: 0, 1 for operands, or 2 for results and for answers of memory too. Each makes the way a cycle longer, but for addresses; an FPGA
    /// wants them.
    pub link_registers: u32,
    /// Bits of the number of a quad-BVH node, of a tree, and of a node within its level, as a context keeps them: at most 28.
    pub index_bits: u32,
    /// Levels of detail are chosen. Without it there is no LOD test and no morph, and rays are of full detail or of none ([`Cone::is_of_no_detail`](crate::num::Cone::is_of_no_detail)).
    pub lod_test: bool,
    /// Cones can have a radius where their rays start.
    pub start_radius: bool,
    /// Hits can be above the finest level, and are mapped to it.
    pub hit_mapping: bool,
    /// Inserted vertices can be displacements, and L0 records of one line.
    pub compact_vertices: bool,
    /// They can be stored as they are, and L0 records have two lines.
    pub exact_vertices: bool,
    /// Bits at the bottom of all coordinates that it leaves out, as they are 0 in the scenes that it is for: 0 to 16. Vertices, morphed triangles and origins
    /// have at least as many ([`Meta::coordinate_zeros`](crate::format::Meta::coordinate_zeros)).
    pub coordinate_zeros: u32,
    /// Bits at the bottom of the components of directions that it leaves out likewise: 0 to 14.
    pub direction_zeros: u32,
    /// Rays can start on a surface, count only hits within a range of t, and end at any of them ([`ports::SecondaryIn`]). It leaves out no bits of coordinates and directions.
    pub secondary: bool,
}

impl Default for Hardware {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A field of a hardware that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("hardware: {field} must be {least} to {most}, but is {value}")]
pub struct HardwareError {
    field: &'static str,
    least: u64,
    most: u64,
    value: u64,
}

impl Hardware {
    /// The default as a constant.
    pub const DEFAULT: Self = Self {
        levels: MAX_LEVELS,
        fewer_stored_levels: None,
        bvh_depth: MAX_BVH_DEPTH,
        fewer_stack_entries: None,
        contexts: 4,
        context_bits: MAX_CONTEXT_BITS,
        edges_per_cycle: EdgesPerCycle::One,
        lod_edges_per_cycle: EdgesPerCycle::One,
        divide_bits: MOST_DIVIDE_BITS,
        setup_bits: MOST_DIVIDE_BITS,
        setup_copies: 1,
        divide_copies: 1,
        boxes_per_cycle: BoxesPerCycle::Two,
        link_registers: 0,
        index_bits: MOST_INDEX_BITS,
        lod_test: true,
        start_radius: true,
        hit_mapping: true,
        compact_vertices: true,
        exact_vertices: true,
        coordinate_zeros: 0,
        direction_zeros: 0,
        secondary: false,
    };

    /// The fewest levels: a tree of one split has no nodes below its root, and no register for its triangles.
    pub const LEAST_LEVELS: u32 = 2;

    /// A unit for one ray at a time, the default in all else.
    pub const fn one_context() -> Self {
        Self { contexts: 1, ..Self::DEFAULT }
    }

    /// A unit of so many contexts (1 to 64) for an LFE5U-85F (`scripts/synth --fpga`), for models of up to six levels below sixteen of a quad-BVH, on grids of 8 zero bits: one edge, one box and one
    /// bit of each division a cycle, for its multipliers.
    pub const fn fpga(contexts: usize) -> Self {
        let context_bits = if contexts <= 2 { 1 } else { (contexts - 1).ilog2() + 1 };
        Self {
            levels: 6,
            bvh_depth: 16,
            contexts,
            context_bits,
            edges_per_cycle: EdgesPerCycle::One,
            lod_edges_per_cycle: EdgesPerCycle::One,
            divide_bits: 1,
            setup_bits: 1,
            boxes_per_cycle: BoxesPerCycle::One,
            coordinate_zeros: 8,
            direction_zeros: 8,
            ..Self::DEFAULT
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that is out of its range.
    pub fn validate(&self) -> Result<(), HardwareError> {
        let fields = [
            ("levels", u64::from(self.levels), u64::from(Self::LEAST_LEVELS), u64::from(MAX_LEVELS)),
            ("fewer_stored_levels", u64::from(self.stored_levels()), 0, u64::from(self.levels)),
            ("bvh_depth", u64::from(self.bvh_depth), 1, u64::from(MAX_BVH_DEPTH)),
            ("fewer_stack_entries", u64::from(self.stack_entries()), 2, u64::from(self.deepest_stack())),
            ("context_bits", u64::from(self.context_bits), 1, u64::from(MAX_CONTEXT_BITS)),
            ("contexts", self.contexts as u64, 1, 1 << self.context_bits.min(MAX_CONTEXT_BITS)),
            ("divide_bits", u64::from(self.divide_bits), 1, u64::from(MOST_DIVIDE_BITS)),
            ("setup_bits", u64::from(self.setup_bits), 1, u64::from(MOST_DIVIDE_BITS)),
            ("setup_copies", u64::from(self.setup_copies), 1, u64::from(MOST_COPIES)),
            ("divide_copies", u64::from(self.divide_copies), 1, u64::from(MOST_COPIES)),
            ("link_registers", u64::from(self.link_registers), 0, 2),
            ("index_bits", u64::from(self.index_bits), u64::from(self.node_bits()), u64::from(MOST_INDEX_BITS)),
            ("compact_vertices", u64::from(self.compact_vertices), u64::from(!self.exact_vertices), 1),
            // A ray that starts on a surface has all bits.
            ("coordinate_zeros", u64::from(self.coordinate_zeros), 0, u64::from(if self.secondary { 0 } else { BOX_SHIFT })),
            ("direction_zeros", u64::from(self.direction_zeros), 0, u64::from(if self.secondary { 0 } else { MOST_DIRECTION_ZEROS })),
        ];
        match fields.into_iter().find(|(_, value, least, most)| !(least..=most).contains(&value)) {
            Some((field, value, least, most)) => Err(HardwareError { field, least, most, value }),
            None => Ok(()),
        }
    }

    /// The same with what another one does in a cycle: contexts, and how fast its blocks are.
    pub fn as_fast_as(&self, other: &Self) -> Self {
        let Self { contexts, edges_per_cycle, lod_edges_per_cycle, boxes_per_cycle, .. } = *other;
        let Self { divide_bits, setup_bits, setup_copies, divide_copies, .. } = *other;
        Self {
            contexts,
            edges_per_cycle,
            lod_edges_per_cycle,
            boxes_per_cycle,
            divide_bits,
            setup_bits,
            setup_copies,
            divide_copies,
            ..*self
        }
    }

    /// What the blocks of this hardware depend on.
    pub const fn form(&self) -> Form {
        Form {
            levels: self.levels,
            edges_per_cycle: self.edges_per_cycle,
            lod_edges_per_cycle: self.lod_edges_per_cycle,
            divide_bits: self.divide_bits,
            setup_bits: self.setup_bits,
            boxes_per_cycle: self.boxes_per_cycle,
            lod_test: self.chooses_levels(),
            start_radius: self.start_radius,
            compact_vertices: self.compact_vertices,
            exact_vertices: self.exact_vertices,
            coordinate_zeros: self.coordinate_zeros,
            direction_zeros: self.direction_zeros,
        }
    }

    /// Levels that trees are stored to.
    pub const fn stored_levels(&self) -> u32 {
        match self.fewer_stored_levels {
            Some(levels) => levels,
            None => self.levels,
        }
    }

    /// There is something to choose from, and a LOD test that does.
    pub const fn chooses_levels(&self) -> bool {
        self.lod_test && self.stored_levels() > 0
    }

    /// The most levels of a scene: of one whose hits cannot be mapped, those that it is stored to.
    pub const fn scene_levels(&self) -> u32 {
        if self.hit_mapping { self.levels } else { self.stored_levels() }
    }

    /// A scene of this configuration is one for this hardware. Rays of another end early, with [`RayError::Scene`].
    pub fn takes(&self, scene: &SceneConfig) -> bool {
        let (levels, zeros) = (scene.levels.get(), scene.zeros.get());
        let has_form = if scene.compact { self.compact_vertices } else { self.exact_vertices };
        levels <= u64::from(self.scene_levels())
            && zeros >= u64::from(self.coordinate_zeros)
            && levels + zeros <= u64::from(BOX_SHIFT)
            && has_form
            && scene.scale.offset.get() <= MAX_BOUND_OFFSET
    }

    /// Bits of a node's number within its level, two of each level that is stored; at least two.
    pub const fn node_bits(&self) -> u32 {
        let levels = self.stored_levels();
        2 * if levels == 0 { 1 } else { levels }
    }

    /// Rays from a surface have others decide about levels around their start: the hardware is for such rays, and chooses levels.
    pub const fn has_deciders(&self) -> bool {
        self.secondary && self.chooses_levels()
    }

    /// The block of this hardware that does what this one does: where rays can start on a surface, one for exact starts.
    pub const fn block(&self, operation: Operation) -> Operation {
        match operation {
            Operation::RaySetup if self.secondary => Operation::StartSetup,
            Operation::LodTest if self.secondary => Operation::LodTestBy,
            Operation::TriTest if self.secondary => Operation::StartTest,
            Operation::HitDivide if self.secondary => Operation::StartDivide,
            _ => operation,
        }
    }

    /// Whether a unit of this hardware has a block that does this.
    pub const fn has(&self, operation: Operation) -> bool {
        match operation {
            Operation::LodTest | Operation::LodTestBy => self.chooses_levels(),
            Operation::TreeDeciders => self.has_deciders(),
            Operation::Tessellate => self.stored_levels() > 0,
            Operation::BaryMap => self.hit_mapping,
            _ => true,
        }
    }

    /// What it has for these blocks: of several for the boxes of a node as many as test side by side.
    pub fn blocks<'a>(&self, blocks: &'a [Operation]) -> impl Iterator<Item = Operation> + use<'a> {
        let hardware = *self;
        let is_of_boxes =
            |operation| matches!(operation, Operation::BoxDecode | Operation::BoxDecode8 | Operation::BoxTest | Operation::BoxTest32);
        blocks
            .iter()
            .enumerate()
            .filter(move |&(k, &operation)| {
                let before = blocks[..k].iter().filter(|&&other| other == operation).count() as u32; // a handful
                let all = blocks.iter().filter(|&&other| other == operation).count() as u32;
                hardware.has(operation) && (!is_of_boxes(operation) || before < hardware.boxes_per_cycle.side_by_side(all))
            })
            .map(move |(_, &operation)| hardware.block(operation))
    }

    /// Timing of a block.
    pub fn timing<B: Block>(&self) -> Timing {
        B::timing(&self.form())
    }

    /// The same from a context to the block and back.
    pub const fn linked(&self, timing: Timing) -> Timing {
        Timing { latency: timing.latency + self.link_registers, ..timing }
    }

    /// Blocks of this kind that take turns.
    pub const fn copies(&self, operation: Operation) -> u32 {
        match operation {
            Operation::RaySetup | Operation::StartSetup => self.setup_copies,
            Operation::HitDivide | Operation::StartDivide => self.divide_copies,
            _ => 1,
        }
    }

    /// The module of the RTL that has all blocks of this kind.
    pub fn module(&self, operation: Operation) -> &'static str {
        match (self.copies(operation), operation) {
            (1, _) => operation.name(),
            (_, Operation::RaySetup | Operation::StartSetup) => "setup_copies",
            _ => "divide_copies",
        }
    }

    /// Cycles from one item that a block of this hardware takes to the next, by all of its kind in turns.
    pub fn interval(&self, operation: Operation) -> u32 {
        self.block(operation).timing(&self.form()).interval.div_ceil(self.copies(operation))
    }

    /// Results of blocks and answers of memory have a register on their way to the contexts.
    pub const fn registers_results(&self) -> bool {
        self.link_registers > 1
    }

    /// Entries of a traversal stack.
    pub fn stack_entries(&self) -> u32 {
        self.fewer_stack_entries.unwrap_or_else(|| self.deepest_stack())
    }

    /// Each level of the quad-BVH and of a tree leaves at most three siblings waiting.
    const fn deepest_stack(&self) -> u32 {
        3 * (self.bvh_depth + self.stored_levels()) + 1
    }

    /// Split triangles that a context keeps: one of each stored level but the last, whose children are no nodes.
    pub const fn split_triangles(&self) -> u32 {
        self.stored_levels().saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Wire;

    #[test]
    fn a_value_out_of_range_is_named() {
        let wrong = |hardware: Hardware| hardware.validate().expect_err("an error").to_string();
        let default = Hardware::default();
        assert_eq!(default.validate(), Ok(()));
        assert_eq!(default.form(), Form::FULL);
        assert_eq!(wrong(Hardware { levels: 11, ..default }), "hardware: levels must be 2 to 10, but is 11");
        assert_eq!(wrong(Hardware { levels: 1, ..default }), "hardware: levels must be 2 to 10, but is 1");
        assert_eq!(wrong(Hardware { bvh_depth: 25, ..default }), "hardware: bvh_depth must be 1 to 24, but is 25");
        assert_eq!(
            wrong(Hardware { fewer_stack_entries: Some(104), ..default }),
            "hardware: fewer_stack_entries must be 2 to 103, but is 104"
        );
        assert_eq!(wrong(Hardware { context_bits: 7, ..default }), "hardware: context_bits must be 1 to 6, but is 7");
        assert_eq!(wrong(Hardware { divide_bits: 4, ..default }), "hardware: divide_bits must be 1 to 3, but is 4");
        assert_eq!(wrong(Hardware { setup_bits: 0, ..default }), "hardware: setup_bits must be 1 to 3, but is 0");
        assert_eq!(wrong(Hardware { setup_copies: 0, ..default }), "hardware: setup_copies must be 1 to 4, but is 0");
        assert_eq!(wrong(Hardware { divide_copies: 5, ..default }), "hardware: divide_copies must be 1 to 4, but is 5");
        assert_eq!(wrong(Hardware { coordinate_zeros: 17, ..default }), "hardware: coordinate_zeros must be 0 to 16, but is 17");
        assert_eq!(wrong(Hardware { direction_zeros: 15, ..default }), "hardware: direction_zeros must be 0 to 14, but is 15");
        assert_eq!(
            wrong(Hardware { coordinate_zeros: 1, secondary: true, ..default }),
            "hardware: coordinate_zeros must be 0 to 0, but is 1"
        );
        assert_eq!(wrong(Hardware { link_registers: 3, ..default }), "hardware: link_registers must be 0 to 2, but is 3");
        assert_eq!(wrong(Hardware { contexts: 0, ..default }), "hardware: contexts must be 1 to 64, but is 0");
        assert_eq!(wrong(Hardware { contexts: 5, context_bits: 2, ..default }), "hardware: contexts must be 1 to 4, but is 5");
    }

    #[test]
    fn the_most_is_what_the_functional_traverser_has_room_for() {
        assert_eq!(Hardware::default().stack_entries() as usize, crate::method::STACK_ENTRIES);
        assert_eq!(ports::MemoryRequest::default().tag.get(), 0);
        assert_eq!(MAX_CONTEXT_BITS + 2, ports::MemoryRequest::FIELDS[0].width);
    }
}
