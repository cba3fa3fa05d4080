//! What is counted of the hardware blocks.

use super::Block;
use super::bary_map::BaryMap;
use super::bound_decode::BoundDecode;
use super::box_decode::BoxDecode;
use super::box_decode8::BoxDecode8;
use super::box_test::BoxTest;
use super::box_test32::BoxTest32;
use super::child_boxes::ChildBoxes;
use super::child_prisms::ChildPrisms;
use super::child_sort::ChildSort;
use super::child_sort6::ChildSort6;
use super::child_test::ChildTest;
use super::hit_divide::HitDivide;
use super::hit_select::HitSelect;
use super::lod_test::LodTest;
use super::lod_test_by::LodTestBy;
use super::node_address::NodeAddress;
use super::ray_setup::RaySetup;
use super::start_divide::StartDivide;
use super::start_setup::StartSetup;
use super::start_test::StartTest;
use super::tessellate::Tessellate;
use super::tree_deciders::TreeDeciders;
use super::tri_test::TriTest;
use super::{Form, Timing, parts::Parts};

/// Something of the block of an operation, whose type is `$block`.
macro_rules! of_block {
    ($operation:expr, $block:ident => $value:expr) => {
        of_block!($operation, $block => $value; RaySetup, NodeAddress, ChildTest, LodTest, Tessellate, TriTest, HitDivide, HitSelect,
            BaryMap, ChildBoxes, BoxDecode, BoxTest, BoxTest32, ChildSort, BoundDecode, BoxDecode8, ChildSort6, TreeDeciders, LodTestBy, StartSetup,
            StartTest, StartDivide, ChildPrisms)
    };
    ($operation:expr, $block:ident => $value:expr; $($name:ident),+) => {
        match $operation {
            $(Operation::$name => {
                type $block = $name;
                $value
            })+
        }
    };
}

/// An operation of a block. Those of a block's parts are counted only where the part stands alone: `child_test` and `lod_test` contain theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A ray's constants.
    RaySetup,
    /// A line's address.
    NodeAddress,
    /// Four children of a node.
    ChildTest,
    /// Does a triangle serve.
    LodTest,
    /// The inserted vertices of a triangle.
    Tessellate,
    /// A triangle.
    TriTest,
    /// A quotient of a hit.
    HitDivide,
    /// A hit compared with the closest.
    HitSelect,
    /// A hit mapped to the full-resolution mesh.
    BaryMap,
    /// The boxes of four children.
    ChildBoxes,
    /// A box in its node's frame.
    BoxDecode,
    /// A box of 16-bit codes.
    BoxTest,
    /// A box of 32-bit coordinates.
    BoxTest32,
    /// Four children ordered.
    ChildSort,
    /// A displacement bound.
    BoundDecode,
    /// A box in the frame of a node of six.
    BoxDecode8,
    /// Six children ordered.
    ChildSort6,
    /// Which ray decides in a tree.
    TreeDeciders,
    /// Does a triangle serve, where other rays may decide about its edges.
    LodTestBy,
    /// Constants of a ray from an exact start.
    StartSetup,
    /// A triangle and a ray from an exact start.
    StartTest,
    /// A quotient of its hit.
    StartDivide,
    /// Four children of a tree's node by their prisms.
    ChildPrisms,
}

impl Operation {
    /// Every operation.
    pub const ALL: [Self; 23] = [
        Self::RaySetup,
        Self::NodeAddress,
        Self::ChildTest,
        Self::LodTest,
        Self::Tessellate,
        Self::TriTest,
        Self::HitDivide,
        Self::HitSelect,
        Self::BaryMap,
        Self::ChildBoxes,
        Self::BoxDecode,
        Self::BoxTest,
        Self::BoxTest32,
        Self::ChildSort,
        Self::BoundDecode,
        Self::BoxDecode8,
        Self::ChildSort6,
        Self::TreeDeciders,
        Self::LodTestBy,
        Self::StartSetup,
        Self::StartTest,
        Self::StartDivide,
        Self::ChildPrisms,
    ];

    /// Its number in [`Operation::ALL`].
    #[expect(clippy::as_conversions, reason = "the number of a variant")]
    const fn number(self) -> usize {
        self as usize
    }

    /// Name of the block.
    pub fn name(self) -> &'static str {
        of_block!(self, B => B::NAME)
    }

    /// Timing of the block in hardware of this form.
    pub fn timing(self, form: &Form) -> Timing {
        of_block!(self, B => B::timing(form))
    }

    /// What the block is made of in hardware of this form.
    pub fn parts(self, form: &Form) -> Parts {
        of_block!(self, B => B::parts(form))
    }
}

/// Kinds of [`Work`] that steps can name: those of a method, and [`SHARED_WORKS`].
pub const MAX_WORKS: usize = 16;

/// The number of the first of [`SHARED_WORKS`], which stand behind all of a method's own.
pub const FIRST_SHARED: u32 = 13;
/// The number of [`SHARED_WORKS`] by which a place is binned on a level of a tree over all.
pub const INSTANCE_BIN: u32 = FIRST_SHARED;
/// That of a model's box where it stands.
pub const INSTANCE_BOX: u32 = FIRST_SHARED + 1;
/// That of a ray that enters a model.
pub const INSTANCE: u32 = FIRST_SHARED + 2;

/// The [`Work`] of scenes of several models, whatever the method, all in 32 bits: a box and its bins on three axes, and the boxes of those, which grow; a box behind a 3 x 3 matrix, by its
/// centre and half its sides; a ray's origin and direction behind one.
pub static SHARED_WORKS: [Work; 3] = [
    Work {
        name: "instance_bin",
        products: &[[3, 32, 16]],
        add_bits: 3 * 32 + 3 * 6 * 32,
        select_bits: 3 * 6 * 32,
        written_bits: 3 * 6 * 32,
    },
    Work { name: "instance_box", products: &[[18, 32, 32]], add_bits: 15 * 64 + 6 * 32, select_bits: 0, written_bits: 2 * 3 * 32 },
    Work { name: "instance_transform", products: &[[18, 32, 32]], add_bits: 15 * 64, select_bits: 0, written_bits: 2 * 3 * 32 },
];

/// An operation that no block of the RTL does, such as one of work before a frame. Its energy is that of a block made of the same (`docs/energy.md`); it takes no time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Its name in reports.
    pub name: &'static str,
    /// Its products: how many, bits of one factor, bits of the other.
    pub products: &'static [[u32; 3]],
    /// Bits added or compared.
    pub add_bits: u32,
    /// Bits selected, one of two.
    pub select_bits: u32,
    /// Bits of registers written.
    pub written_bits: u32,
}

/// How many of each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Operations([u64; Operation::ALL.len()], [u64; MAX_WORKS]);

impl Operations {
    /// Counts `count` more of `operation`.
    pub fn add(&mut self, operation: Operation, count: u64) {
        self.0[operation.number()] += count;
    }

    /// Counts `count` more of a method's own, by number.
    ///
    /// # Panics
    /// The number is not below [`MAX_WORKS`].
    pub fn add_work(&mut self, work: usize, count: u64) {
        self.1[work] += count;
    }

    /// How many of a method's own there were, by number.
    pub fn works(&self) -> &[u64; MAX_WORKS] {
        &self.1
    }

    /// Counts all of `other` too.
    pub fn join(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(count, more)| *count += more);
        self.1.iter_mut().zip(other.1).for_each(|(count, more)| *count += more);
    }

    /// What was counted since `earlier`, which is part of it.
    pub fn since(&self, earlier: &Self) -> Self {
        let mut counts = self.0;
        counts.iter_mut().zip(earlier.0).for_each(|(count, before)| *count -= before);
        let mut works = self.1;
        works.iter_mut().zip(earlier.1).for_each(|(count, before)| *count -= before);
        Self(counts, works)
    }

    /// How many of `operation`.
    pub fn get(&self, operation: Operation) -> u64 {
        self.0[operation.number()]
    }

    /// Each with its count.
    pub fn iter(&self) -> impl Iterator<Item = (Operation, u64)> {
        Operation::ALL.into_iter().zip(self.0)
    }
}
