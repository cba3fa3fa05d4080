//! The registers of a ray context (`rtl/ray_context.sv`), one by one.

use super::Hardware;
use super::ports::{Epoch, HitOut, MemoryAnswer, RayIn, SceneConfig};
use crate::block::{bary_map, child_test, hit_select, lod_test, parts::Registers, ray_setup};
use crate::method::Entry;
use crate::num::{Bary, BoundCode, Cone, Field, RayT, Wire};

/// Bits of an index in a stack entry of any hardware, of a level, and of a count up to four.
const INDEX: u32 = 28;
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
/// Lines that a context waits for at most.
const LINES: u32 = 2;
/// Whether a tick has passed since something came.
const STALE: u32 = 1;

/// Width of the field of that name.
fn width(fields: &[Field], name: &str) -> u32 {
    fields.iter().find(|field| field.name == name).map_or(0, |field| field.width)
}

impl Hardware {
    /// Bits of the registers of a ray context: `rtl/`'s if it `has_levels`. Without them it has no split triangles and no second triangle at full resolution,
    /// and its stack is as deep as the quad-BVH and holds no bound codes, and of levels only what counts the triangles of a leaf.
    pub fn context_registers(&self, has_levels: bool) -> Registers {
        let triangles = if has_levels { self.split() + self.splits() } else { 2 * self.triangle() };
        Registers::bits(self.place() + triangles + self.stack(has_levels) + self.lines() + self.bounds() + self.closest())
    }

    /// A triangle.
    fn triangle(&self) -> u32 {
        3 * 3 * self.form().coordinate()
    }

    /// A triangle with its inserted vertices, at full resolution and, where levels are chosen, as morphed.
    fn split(&self) -> u32 {
        let inserted = if self.stored_levels() > 0 { 2 } else { 1 };
        inserted * self.triangle() * if self.chooses_levels() { 2 } else { 1 }
    }

    /// Ray, and its constants for the box tests: origin, direction, and moment. Of the cone its start may be left out, or all but whether the ray is of no detail.
    fn ray(&self) -> u32 {
        let zeros = self.coordinate_zeros + self.direction_zeros;
        let cone = match (self.stored_levels() > 0, self.lod_test) {
            (true, true) => Cone::WIDTH - if self.start_radius { 0 } else { CONE_OFFSET },
            (true, false) => 1,
            (false, _) => 0,
        };
        RayIn::WIDTH - Cone::WIDTH + cone + ray_setup::Out::WIDTH - 3 * (zeros + zeros + zeros)
    }

    /// A stack entry: of a tree's node, if trees have any, with level and codes.
    pub(super) fn entry(&self) -> u32 {
        let narrow = Entry::WIDTH - INDEX + self.index_bits;
        if self.split_triangles() > 0 { narrow } else { narrow - LEVEL - 3 * BoundCode::WIDTH }
    }

    /// State, ray, constants; the entry under visit, the node and what was found out about it; children and triangles to come.
    fn place(&self) -> u32 {
        let tree = self.index_bits + if self.stored_levels() > 0 { LEVEL + 2 * self.line_bits } else { 0 };
        let place = if self.stored_levels() > 0 { LEVEL + self.node_bits() + 3 * BoundCode::WIDTH } else { 0 };
        let lod = if self.chooses_levels() { lod_test::Out::WIDTH } else { 0 };
        let node = tree + place + lod;
        let children = child_test::Out::WIDTH + COUNT;
        // Whether it is four triangles; how many are left and pending, and the next.
        let triangles = 1 + 2 * COUNT + CHILD;
        STATE + FETCH + self.ray() + self.entry() + node + children + triangles
    }

    /// Entries and length.
    fn stack(&self, has_levels: bool) -> u32 {
        // How many can wait is known of trees below a quad-BVH, not of the same quad-BVH over other triangles.
        let entries =
            if has_levels { self.stack_entries() } else { Self { levels: 0, fewer_stack_entries: None, ..*self }.stack_entries() };
        let width = if has_levels { self.entry() } else { Entry::WIDTH - LEVEL + LEAF - 3 * BoundCode::WIDTH };
        entries * width + (entries + 1).next_power_of_two().ilog2()
    }

    /// A triangle with its inserted vertices for each level that splits into nodes.
    fn splits(&self) -> u32 {
        self.split_triangles() * self.split()
    }

    /// The lines, which of them are wanted and waited for, and whose they are.
    fn lines(&self) -> u32 {
        LINES * width(MemoryAnswer::FIELDS, "line") + 2 * LINES + Epoch::WIDTH
    }

    /// What bounds the ray's way: its error, how many entries it may still visit, and whether a line is late.
    fn bounds(&self) -> u32 {
        width(HitOut::FIELDS, "error") + width(SceneConfig::FIELDS, "visits") + STALE
    }

    /// The closest hit: whether there is one, t, id, numerators, weights, and the full-resolution triangle, if it can be another.
    fn closest(&self) -> u32 {
        let triangle = self.index_bits + if self.stored_levels() > 0 { LEVEL + self.node_bits() } else { 0 };
        let full = if self.hit_mapping { bary_map::Out::WIDTH } else { 0 };
        let numerators = 3 * (self.form().signed_edge() - 1);
        let front = 1;
        1 + RayT::WIDTH + hit_select::FullId::WIDTH + triangle + front + numerators + 3 * Bary::WIDTH + full
    }
}
