//! The registers of a ray context (`rtl/ray_context.sv`), one by one.

use super::Hardware;
use super::ports::{MemoryAnswer, RayIn};
use crate::block::{bary_map, child_test, hit_select, lod_test, parts::Registers, ray_setup};
use crate::method::Entry;
use crate::num::{Bary, BoundCode, RayT, Wire};

/// Bits of a tree's number, of those of its first group and line, of a level, and of a count up to four.
const TREE: u32 = 28;
const FIRST: u32 = 28;
const LEVEL: u32 = 4;
const COUNT: u32 = 3;
/// Bits of the number of a leaf's triangles, 1 to 4, which a BVH keeps where others have levels.
const LEAF: u32 = 2;
/// Bits of the numbers of states, of what is fetched, and of a child.
const STATE: u32 = 5;
const FETCH: u32 = 2;
const CHILD: u32 = 2;
/// Lines that a context waits for at most.
const LINES: u32 = 2;

impl Hardware {
    /// Bits of the registers of a ray context: `rtl/`'s if it `has_levels`. Without them it has no split triangles and no second triangle at full resolution,
    /// and its stack is as deep as the quad-BVH and holds no bound codes, and of levels only what counts the triangles of a leaf.
    pub fn context_registers(&self, has_levels: bool) -> Registers {
        let levels = if has_levels { self.split() + self.splits() } else { 0 };
        Registers::bits(self.place() + self.stack(has_levels) + levels + self.lines() + self.closest())
    }

    /// A triangle with its inserted vertices.
    fn split(&self) -> u32 {
        6 * 3 * self.form().coordinate()
    }

    /// Ray, and its constants for the box tests: origin, direction, and moment.
    fn ray(&self) -> u32 {
        let zeros = self.coordinate_zeros + self.direction_zeros;
        RayIn::WIDTH + ray_setup::Out::WIDTH - 3 * (zeros + zeros + zeros)
    }

    /// Bits of a node's number within its level.
    const fn node(&self) -> u32 {
        2 * self.levels
    }

    /// State, ray, constants; the entry under visit, the node, its triangle as morphed and what was found out about it; children and triangles to come.
    fn place(&self) -> u32 {
        let tree = TREE + LEVEL + 2 * FIRST;
        let node = tree + LEVEL + self.node() + self.split() + 3 * BoundCode::WIDTH + lod_test::Out::WIDTH;
        let children = child_test::Out::WIDTH + COUNT;
        // Whether it is four triangles; how many are left and pending, and the next.
        let triangles = 1 + 2 * COUNT + CHILD;
        STATE + FETCH + self.ray() + Entry::WIDTH + node + children + triangles
    }

    /// Entries and length.
    fn stack(&self, has_levels: bool) -> u32 {
        // How many can wait is known of trees below a quad-BVH, not of the same quad-BVH over other triangles.
        let entries =
            if has_levels { self.stack_entries() } else { Self { levels: 0, fewer_stack_entries: None, ..*self }.stack_entries() };
        let width = if has_levels { Entry::WIDTH } else { Entry::WIDTH - LEVEL + LEAF - 3 * BoundCode::WIDTH };
        entries * width + (entries + 1).next_power_of_two().ilog2()
    }

    /// A triangle with its inserted vertices, at full resolution and as morphed, for each level that splits into nodes.
    fn splits(&self) -> u32 {
        self.split_triangles() * 2 * self.split()
    }

    /// The lines, and which of them are wanted and waited for.
    fn lines(&self) -> u32 {
        LINES * MemoryAnswer::FIELDS[1].width + 2 * LINES
    }

    /// The closest hit: whether there is one, t, id, numerators, weights, and the full-resolution triangle.
    fn closest(&self) -> u32 {
        let triangle = TREE + LEVEL + self.node();
        let numerators = 3 * (self.form().signed_edge() - 1);
        let front = 1;
        1 + RayT::WIDTH + hit_select::FullId::WIDTH + triangle + front + numerators + 3 * Bary::WIDTH + bary_map::Out::WIDTH
    }
}
