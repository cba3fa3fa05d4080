//! The traversal stack (paper figure 9): what is still to be visited, nearest on top.
//!
//! Entries carry no vertices: the traversal keeps one triangle with its inserted vertices per level, which a depth-first order never
//! overwrites while a child of it waits.

use crate::block::child_test;
use crate::num::{BoundCode, TNear, U, Wire, wire_struct};

/// Room for a quad-BVH of [`MAX_BVH_DEPTH`](crate::num::MAX_BVH_DEPTH) levels and a tree of ten: each level leaves at most three siblings waiting.
pub const STACK_ENTRIES: usize = 3 * (crate::num::MAX_BVH_DEPTH as usize + crate::num::MAX_LEVELS as usize) + 1;

wire_struct! {
    /// One waiting node.
    pub struct Entry {
        /// Lower bound of the distance to its box.
        t_near: TNear,
        /// 0: quad-BVH node `index`; 1: tree `index`; 2: node `index` on `level` of the current tree.
        kind: U<2>,
        /// Level within the tree, 1 to 9; else 0.
        level: U<4>,
        /// Which one.
        index: U<28>,
        /// Bound code of edge (p1, p2) of a tree's node; else 0.
        e0: BoundCode,
        /// Bound code of edge (p2, p0).
        e1: BoundCode,
        /// Bound code of edge (p0, p1).
        e2: BoundCode,
    }
}

const _: () = assert!(Entry::WIDTH <= 128);

impl Entry {
    /// `kind` of a quad-BVH node.
    pub const BVH_NODE: u64 = 0;
    /// `kind` of a tree (or, in a full-resolution BVH, of a leaf).
    pub const TREE: u64 = 1;
    /// `kind` of a node within the current tree.
    pub const TREE_NODE: u64 = 2;
}

/// What a stack is asked to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// Put an entry on top.
    Push(Entry),
    /// Take the top entry.
    Pop,
}

/// The stack.
#[derive(Clone, Debug)]
pub struct TraversalStack {
    /// As bits, as in hardware: 81 of 128.
    entries: [[u64; 2]; STACK_ENTRIES],
    len: usize,
}

impl Default for TraversalStack {
    fn default() -> Self {
        Self { entries: [[0; 2]; STACK_ENTRIES], len: 0 }
    }
}

impl TraversalStack {
    /// Does `op`; a pop gives the top entry, or `None` if the stack is empty. A push gives `None`; the depth of every checked quad-BVH
    /// and tree keeps it from overflowing.
    #[inline(always)]
    pub fn step(&mut self, op: Op) -> Option<Entry> {
        match op {
            Op::Push(entry) => {
                entry.to_words(&mut self.entries[self.len]);
                self.len += 1;
                None
            }
            Op::Pop => {
                self.len = self.len.checked_sub(1)?;
                Some(Entry::from_words(&self.entries[self.len]))
            }
        }
    }

    /// Number of waiting entries.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Nothing waits.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Forgets everything.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }
}

/// Gives the nearest hit child, to go on with, and pushes the others, farthest first; `entry` makes the entry of child k but for its `t_near`.
#[inline(always)]
pub(super) fn push_sorted(stack: &mut TraversalStack, sorted: &child_test::Out, entry: impl Fn(usize) -> Entry) -> Option<Entry> {
    push_nearest(stack, sorted.count.get() as usize, |place| {
        let k = sorted.order[place].get() as usize;
        Entry { t_near: sorted.t_near[k], ..entry(k) }
    })
}

/// Gives the first of `count` entries, to go on with, and pushes the others, the last first.
#[inline(always)]
pub(super) fn push_nearest(stack: &mut TraversalStack, count: usize, at: impl Fn(usize) -> Entry) -> Option<Entry> {
    for place in (1..count).rev() {
        stack.step(Op::Push(at(place)));
    }
    (count > 0).then(|| at(0))
}
