//! A step of a ray: lines that are read or written, and what the hardware does.
//!
//! | act | what it stands for | operations |
//! |---|---|---|
//! | `Fetch` | nothing but the lines | |
//! | `Children` | the children of a node of some shape ([`NodeShape`]) are tested, and `met` of them met | the shape's |
//! | `Decide` | who decides about levels in the tree that is entered | `tree_deciders` |
//! | `LodTest` | does a triangle serve | `lod_test` |
//! | `Tessellate` | the inserted vertices of a triangle are morphed | `tessellate` |
//! | `Triangles` | triangle tests; bit k of `hits`: the k-th is met | `tri_test`, and of those met `hit_divide` and `hit_select` |
//! | `Work` | `count` operations that no block of the RTL does, of number `work` among the method's own | these |
//! | `Pop` | a node is taken from the stack, and `dropped` if it lies behind the closest hit | |
//! | `End` | the ray is done, or those of a packet; `found` of them have a hit, which is `mapped` to the full resolution | for each found two `hit_divide`, `bary_map` if mapped |
//!
//! Each line asked for takes a `node_address`, and each ray begins with a `ray_setup`. Rays of a packet take a step together: what tests a node, or asks whether a triangle
//! serves, is done for each of its `lanes`; lines are asked for once, and a triangle is split once. Hardware for rays that start on a surface has blocks of its own for some of these
//! ([`Hardware::block`](crate::hardware::Hardware::block)).

use super::{NodeShape, SectionId};
use crate::block::{Operation, Operations};

/// Most lines of a fetch: three bits count them.
pub const MAX_FETCH_LINES: u32 = 7;

/// Places of lines in a record: ten bits of a unit's tag.
pub const MAX_PLACES: u32 = 1 << 10;

/// Lines that follow each other, asked for by a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fetch {
    /// What they hold.
    pub section: SectionId,
    /// The first, in the numbers of the method's [`MemoryMap`](super::MemoryMap).
    pub line: u32,
    /// How many, 1 to [`MAX_FETCH_LINES`].
    pub lines: u32,
    /// Place of the first in the record that the ray reads, below [`MAX_PLACES`]: what the unit's tag says of it.
    pub place: u32,
    /// They are asked for together with those of the step before: nothing of that step need be there. Behind any act but `Fetch`, a unit asks for one such step
    /// together with that act's, as it has one register for it.
    pub joins: bool,
    /// They are written, whole, and not read: nothing is fetched for them, and the ray goes on when the L2 has them.
    pub stores: bool,
}

impl Fetch {
    /// `lines` lines of `section` from `line` on, the first of their record, and not asked for with any others.
    #[inline(always)]
    pub const fn new(section: SectionId, line: u32, lines: u32) -> Self {
        Self { section, line, lines, place: 0, joins: false, stores: false }
    }

    /// The same at another place of the record.
    #[inline(always)]
    #[must_use]
    pub const fn at(self, place: u32) -> Self {
        Self { place, ..self }
    }

    /// The same, asked for together with those of the step before.
    #[inline(always)]
    #[must_use]
    pub const fn joining(self) -> Self {
        Self { joins: true, ..self }
    }

    /// The same lines, written.
    #[inline(always)]
    #[must_use]
    pub const fn storing(self) -> Self {
        Self { stores: true, ..self }
    }
}

/// What the hardware does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the table above")]
pub enum Act {
    Fetch,
    Children { shape: NodeShape, met: u32 },
    Decide,
    LodTest { refine: bool },
    Tessellate,
    Triangles { count: u32, hits: u32 },
    Work { work: u32, count: u32 },
    Pop { dropped: bool },
    End { found: u32, mapped: bool },
}

/// A step: the lines it asks for, if any, and the act that follows when they and those of the steps before are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// With this step the ray visits a node: the one that it kept from its last test, or took from the stack.
    pub visits: bool,
    /// The lines; `Triangles`, `Work` and `End` have none.
    pub fetch: Option<Fetch>,
    /// The act.
    pub act: Act,
    /// Rays that take it together, 1 to [`MAX_RUN`](super::MAX_RUN): 1, or those of a packet.
    pub lanes: u32,
}

impl Act {
    /// How many children of a node were met, if it tests those of one.
    #[inline(always)]
    pub const fn met(self) -> Option<u32> {
        match self {
            Self::Children { met, .. } => Some(met),
            _ => None,
        }
    }
}

impl Step {
    /// An act that needs no lines of its own.
    #[inline(always)]
    pub const fn of(act: Act) -> Self {
        Self { visits: false, fetch: None, act, lanes: 1 }
    }

    /// An act on lines.
    #[inline(always)]
    pub const fn on(fetch: Fetch, act: Act) -> Self {
        Self { visits: false, fetch: Some(fetch), act, lanes: 1 }
    }

    /// The same as the first step of a node's visit.
    #[inline(always)]
    #[must_use]
    pub const fn visiting(self) -> Self {
        Self { visits: true, ..self }
    }

    /// The same, taken by so many rays together.
    #[inline(always)]
    #[must_use]
    pub const fn by(self, lanes: u32) -> Self {
        Self { lanes, ..self }
    }

    /// The end of a ray.
    #[inline(always)]
    pub const fn end(found: bool, mapped: bool) -> Self {
        Self::of(Act::End { found: found as u32, mapped })
    }

    /// Adds what it has the blocks do.
    pub fn count(&self, operations: &mut Operations) {
        let mut add = |operation, count: u32| operations.add(operation, u64::from(count));
        if let Some(fetch) = self.fetch {
            add(Operation::NodeAddress, fetch.lines);
        }
        match self.act {
            Act::Fetch | Act::Pop { .. } => (),
            Act::Children { shape, .. } => shape.facts().path.iter().for_each(|&(operation, count)| add(operation, self.lanes * count)),
            Act::Work { work, count } => operations.add_work(work as usize, count.into()),
            Act::Decide => add(Operation::TreeDeciders, 1),
            Act::LodTest { .. } => add(Operation::LodTest, self.lanes),
            Act::Tessellate => add(Operation::Tessellate, 1),
            Act::Triangles { count, hits } => {
                add(Operation::TriTest, count);
                add(Operation::HitDivide, hits.count_ones());
                add(Operation::HitSelect, hits.count_ones());
            }
            Act::End { found, mapped } => {
                // Of a packet the first was set up when it began.
                add(Operation::RaySetup, self.lanes - 1);
                add(Operation::HitDivide, 2 * found);
                add(Operation::BaryMap, if mapped { found } else { 0 });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_those_of_the_table() {
        let fetch = Fetch::new(SectionId::new(0), 0, 4);
        let mut operations = Operations::default();
        let steps = [
            Step::on(fetch, Act::Children { shape: NodeShape::Wide, met: 1 }),
            Step::on(fetch, Act::Children { shape: NodeShape::Pair, met: 2 }),
            Step::on(fetch, Act::Children { shape: NodeShape::Plain, met: 1 }),
            Step::on(fetch, Act::Children { shape: NodeShape::Local, met: 1 }),
            Step::on(fetch, Act::Children { shape: NodeShape::Tree, met: 1 }),
            Step::on(fetch, Act::Children { shape: NodeShape::Six, met: 6 }),
            Step::on(fetch, Act::Children { shape: NodeShape::Turned, met: 6 }),
            Step::of(Act::Children { shape: NodeShape::Prisms, met: 3 }),
            Step::of(Act::Decide),
            Step::of(Act::LodTest { refine: true }),
            Step::on(fetch, Act::Tessellate),
            Step::of(Act::Triangles { count: 5, hits: 0b10110 }),
            Step::of(Act::Pop { dropped: true }),
            Step::on(fetch, Act::Fetch),
            Step::end(true, true),
            Step::end(true, false),
            Step::end(false, true),
        ];
        steps.iter().for_each(|step| step.count(&mut operations));
        let some: Vec<_> = operations.iter().filter(|&(_, n)| n > 0).map(|(operation, n)| (operation.name(), n)).collect();
        let wanted = [
            ("ray_setup", 1),
            ("node_address", 36),
            ("child_test", 1),
            ("lod_test", 1),
            ("tessellate", 1),
            ("tri_test", 5),
            ("hit_divide", 7),
            ("hit_select", 3),
            ("bary_map", 1),
            ("box_decode", 4),
            ("box_test", 20),
            ("box_test32", 6),
            ("child_sort", 4),
            ("box_decode8", 12),
            ("child_sort6", 2),
            ("tree_deciders", 1),
            ("child_prisms", 1),
        ];
        assert_eq!(some, wanted);
    }

    #[test]
    fn a_packet_asks_once_and_tests_for_each_of_its_rays() {
        let fetch = Fetch::new(SectionId::new(0), 0, 2);
        let mut operations = Operations::default();
        let steps = [
            Step::on(fetch, Act::Children { shape: NodeShape::Tree, met: 3 }).by(5),
            Step::of(Act::LodTest { refine: true }).by(7),
            Step::on(fetch, Act::Tessellate),
            Step::of(Act::End { found: 4, mapped: true }).by(7),
        ];
        steps.iter().for_each(|step| step.count(&mut operations));
        let some: Vec<_> = operations.iter().filter(|&(_, n)| n > 0).map(|(operation, n)| (operation.name(), n)).collect();
        let mut wanted = [
            ("ray_setup", 6),
            ("node_address", 4),
            ("child_test", 5),
            ("lod_test", 7),
            ("tessellate", 1),
            ("hit_divide", 8),
            ("bary_map", 4),
        ];
        let mut some = some;
        some.sort_unstable();
        wanted.sort_unstable();
        assert_eq!(some, wanted);
    }
}
