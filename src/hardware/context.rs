//! The registers of a ray context (`rtl/ray_context.sv`), one by one.

use super::Hardware;
use super::ports::{Behind, Epoch, HitOut, MemoryAnswer, Owed, RayIn, SceneConfig};
use crate::block::{bary_map, child_test, hit_select, lod_test, node_deciders, parts::Registers, ray_setup, tree_deciders};
use crate::method::Entry;
use crate::num::{Bary, BoundCode, Cone, Field, Ray, RayT, START_BITS, Wire};

/// Bits of an index in a stack entry of any hardware, of a node at the ports, of a level, and of a count up to four.
const INDEX: u32 = 28;
const NODE: u32 = 20;
const LEVEL: u32 = 4;
const COUNT: u32 = 3;
/// Bits of the number of a leaf's triangles, 1 to 4, which a BVH keeps where others have levels.
const LEAF: u32 = 2;
/// Bits of the numbers of states, of what is fetched, and of a child.
const STATE: u32 = 5;
const FETCH: u32 = 2;
const CHILD: u32 = 2;
/// Bits of a cone's offset.
const CONE_OFFSET: u32 = 53;
/// Lines that a context waits for at most, and bits that it keeps of the second: three stored points, or two times three displacements.
const LINES: u32 = 2;
const SECOND_LINE: u32 = 3 * 3 * 28;
/// Whether a tick has passed since something came; and whether what was read of the stack is no longer its top.
const STALE: u32 = 1;
/// Whether a line has corners where there are none.
const MISPLACED: u32 = 1;
/// Whether an age has passed since the context rests.
const RESTED: u32 = 1;
/// Banks of the memory of split triangles.
const BANKS: u32 = 3;

/// A memory of a context: one write port, and one read port with a clock, whose last word stays at its output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Words.
    pub words: u32,
    /// Bits of each.
    pub width: u32,
}

impl Memory {
    /// Bits in it.
    pub const fn bits(&self) -> u32 {
        self.words * self.width
    }

    /// Bits that the RTL declares for it: those in it, and the word that was read.
    const fn declared(&self) -> u32 {
        self.bits() + self.width
    }
}

/// Width of the field of that name.
fn width(fields: &[Field], name: &str) -> u32 {
    fields.iter().find(|field| field.name == name).map_or(0, |field| field.width)
}

impl Hardware {
    /// Bits of the registers of a ray context, memories and all: `rtl/`'s if it `has_levels`. Without them it has no split triangles and no second triangle at full resolution,
    /// and its stack is as deep as the quad-BVH and holds no bound codes, and of levels only what counts the triangles of a leaf.
    pub fn context_registers(&self, has_levels: bool) -> Registers {
        let memories: u32 = self.context_memories(has_levels).iter().map(Memory::declared).sum();
        Registers::bits(self.context_flip_flops(has_levels) + memories)
    }

    /// Those of them that are in no memory.
    pub fn context_flip_flops(&self, has_levels: bool) -> u32 {
        let triangles = if has_levels { self.triangles() } else { 2 * self.triangle() };
        let secondary = if self.secondary { self.secondary_registers(has_levels) } else { 0 };
        self.place() + triangles + self.stack_length(has_levels) + self.lines() + self.bounds() + self.closest() + secondary
    }

    /// What only rays from a surface have: fraction of the start, the smallest t, and whether any hit serves; of the closest hit the corners, and what two numerators have below whole
    /// numbers; and of who decides about levels: whether anyone does, the last hit's triangle with its corners and edges, two rays, and who it is in this tree and at this node.
    fn secondary_registers(&self, has_levels: bool) -> u32 {
        let own = 3 * START_BITS + RayT::WIDTH + 1 + self.triangle() + 2 * START_BITS;
        // Of a stage, with a tag of one bit and whether it is full.
        let node = node_deciders::Out::WIDTH + 2;
        let viewer = Ray::WIDTH - Cone::WIDTH + self.cone();
        let deciders = 1 + self.index_bits + self.triangle() + 3 + 2 * viewer + tree_deciders::Out::WIDTH + node;
        own + if has_levels && self.has_deciders() { deciders } else { 0 }
    }

    /// Its memories: the stack, and the banks of the triangles on the way down a tree.
    pub fn context_memories(&self, has_levels: bool) -> Vec<Memory> {
        let stack = Memory { words: self.waiting(has_levels), width: self.waiting_entry(has_levels) };
        // The root's corners, and corners and inserted vertices of each level that splits into nodes.
        let bank = Memory { words: 2 * self.split_triangles() + 1, width: self.corner() };
        let banks = if has_levels && self.split_triangles() > 0 { BANKS } else { 0 };
        std::iter::once(stack).chain((0..banks).map(|_| bank)).collect()
    }

    /// A triangle.
    fn triangle(&self) -> u32 {
        3 * 3 * self.form().coordinate()
    }

    /// A corner, at full resolution and, where levels are chosen, as morphed.
    fn corner(&self) -> u32 {
        self.triangle() / 3 * if self.chooses_levels() { 2 } else { 1 }
    }

    /// Triangles outside of memories: a root's where there are roots alone, and inserted vertices as morphed, and of those at full resolution what the second line has no room for.
    fn triangles(&self) -> u32 {
        let root = if self.split_triangles() > 0 { 0 } else { self.triangle() };
        let rest = if self.stored_levels() > 0 { self.triangle().saturating_sub(SECOND_LINE) } else { 0 };
        root + rest + if self.chooses_levels() { self.triangle() } else { 0 }
    }

    /// Ray, and its constants for the box tests: origin, direction, and moment. Of the cone its start may be left out, or all but whether the ray is of no detail.
    fn ray(&self) -> u32 {
        let zeros = self.coordinate_zeros + self.direction_zeros;
        RayIn::WIDTH - Cone::WIDTH + self.cone() + ray_setup::Out::WIDTH - 3 * (zeros + zeros + zeros)
    }

    fn cone(&self) -> u32 {
        match (self.stored_levels() > 0, self.lod_test) {
            (true, true) => Cone::WIDTH - if self.start_radius { 0 } else { CONE_OFFSET },
            (true, false) => 1,
            (false, _) => 0,
        }
    }

    /// A stack entry: of a tree's node, if trees have any, with level and codes.
    pub(super) fn entry(&self) -> u32 {
        let narrow = Entry::WIDTH - INDEX + self.index_bits;
        if self.split_triangles() > 0 { narrow } else { narrow - LEVEL - 3 * BoundCode::WIDTH }
    }

    /// State, ray, constants; the entry under visit, the node and what was found out about it; children and triangles to come.
    fn place(&self) -> u32 {
        let tree = self.index_bits + if self.stored_levels() > 0 { LEVEL + self.index_bits } else { 0 };
        // Where entries have them, level, node and codes are the entry's.
        let place = if self.stored_levels() > 0 && self.split_triangles() == 0 { 3 * BoundCode::WIDTH } else { 0 };
        let lod = if self.chooses_levels() { lod_test::Out::WIDTH } else { 0 };
        let node = tree + place + lod;
        let children = child_test::Out::WIDTH + COUNT;
        // Whether it is four triangles; how many are left and pending, and the next.
        let triangles = 1 + 2 * COUNT + CHILD;
        STATE + FETCH + self.ray() + self.entry() + node + children + triangles
    }

    /// Entries of the stack.
    fn waiting(&self, has_levels: bool) -> u32 {
        // How many can wait is known of trees below a quad-BVH, not of the same quad-BVH over other triangles.
        if has_levels { self.stack_entries() } else { Self { levels: 0, fewer_stack_entries: None, ..*self }.stack_entries() }
    }

    /// Bits of one.
    fn waiting_entry(&self, has_levels: bool) -> u32 {
        if has_levels { self.entry() } else { Entry::WIDTH - LEVEL + LEAF - 3 * BoundCode::WIDTH }
    }

    /// How many there are, and whether the top has been read.
    fn stack_length(&self, has_levels: bool) -> u32 {
        (self.waiting(has_levels) + 1).next_power_of_two().ilog2() + STALE
    }

    /// The lines, which of them are wanted and waited for, and whose they are; and what keeps an epoch from coming again too soon.
    fn lines(&self) -> u32 {
        let kept = Owed::WIDTH + Behind::WIDTH + RESTED;
        width(MemoryAnswer::FIELDS, "line") + SECOND_LINE + MISPLACED + 2 * LINES + Epoch::WIDTH + kept
    }

    /// What bounds the ray's way: its error, how many entries it may still visit, and whether a line is late.
    fn bounds(&self) -> u32 {
        width(HitOut::FIELDS, "error") + width(SceneConfig::FIELDS, "visits") + STALE
    }

    /// The closest hit: whether there is one, t, id, and numerators, whose place the weights take, and the full-resolution triangle, if it can be another and has room.
    fn closest(&self) -> u32 {
        let triangle = self.index_bits + if self.stored_levels() > 0 { LEVEL + self.node_bits() } else { 0 };
        let numerator = self.form().signed_edge() - 1;
        let has_room = numerator >= 2 * Bary::WIDTH + NODE;
        let full = if self.hit_mapping && !has_room { bary_map::Out::WIDTH } else { 0 };
        let front = 1;
        1 + RayT::WIDTH + hit_select::FullId::WIDTH + triangle + front + 3 * numerator + full
    }
}
