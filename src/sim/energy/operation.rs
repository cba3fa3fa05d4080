//! What is counted of the hardware blocks.

use crate::block::Block;
use crate::block::bary_map::BaryMap;
use crate::block::bound_decode::BoundDecode;
use crate::block::box_test::BoxTest;
use crate::block::box_test32::BoxTest32;
use crate::block::child_sort::ChildSort;
use crate::block::child_test::ChildTest;
use crate::block::hit_divide::HitDivide;
use crate::block::hit_select::HitSelect;
use crate::block::lod_test::LodTest;
use crate::block::node_address::NodeAddress;
use crate::block::ray_setup::RaySetup;
use crate::block::tessellate::Tessellate;
use crate::block::tree_base::TreeBase;
use crate::block::tri_test::TriTest;
use crate::block::widen_box::WidenBox;

/// An operation of a block. Those of a block's parts are counted only where the part stands alone: `child_test` and `lod_test` contain theirs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A ray's constants.
    RaySetup,
    /// A line's address.
    NodeAddress,
    /// A tree's place.
    TreeBase,
    /// Four children of a node with 16-bit boxes.
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
    /// A box of a child widened.
    WidenBox,
    /// A box of 16-bit codes.
    BoxTest,
    /// A box of 32-bit coordinates.
    BoxTest32,
    /// Four children ordered.
    ChildSort,
    /// A displacement bound.
    BoundDecode,
}

impl Operation {
    /// Every operation.
    pub const ALL: [Self; 15] = [
        Self::RaySetup,
        Self::NodeAddress,
        Self::TreeBase,
        Self::ChildTest,
        Self::LodTest,
        Self::Tessellate,
        Self::TriTest,
        Self::HitDivide,
        Self::HitSelect,
        Self::BaryMap,
        Self::WidenBox,
        Self::BoxTest,
        Self::BoxTest32,
        Self::ChildSort,
        Self::BoundDecode,
    ];

    /// Name of the block.
    pub fn name(self) -> &'static str {
        match self {
            Self::RaySetup => RaySetup::NAME,
            Self::NodeAddress => NodeAddress::NAME,
            Self::TreeBase => TreeBase::NAME,
            Self::ChildTest => ChildTest::NAME,
            Self::LodTest => LodTest::NAME,
            Self::Tessellate => Tessellate::NAME,
            Self::TriTest => TriTest::NAME,
            Self::HitDivide => HitDivide::NAME,
            Self::HitSelect => HitSelect::NAME,
            Self::BaryMap => BaryMap::NAME,
            Self::WidenBox => WidenBox::NAME,
            Self::BoxTest => BoxTest::NAME,
            Self::BoxTest32 => BoxTest32::NAME,
            Self::ChildSort => ChildSort::NAME,
            Self::BoundDecode => BoundDecode::NAME,
        }
    }
}

/// How many of each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Operations([u64; Operation::ALL.len()]);

impl Operations {
    /// Counts `count` more of `operation`.
    pub fn add(&mut self, operation: Operation, count: u64) {
        self.0[operation as usize] += count;
    }

    /// Counts all of `other` too.
    pub fn join(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(count, more)| *count += more);
    }

    /// What was counted since `earlier`, which is part of it.
    pub fn since(&self, earlier: &Self) -> Self {
        let mut counts = self.0;
        counts.iter_mut().zip(earlier.0).for_each(|(count, before)| *count -= before);
        Self(counts)
    }

    /// How many of `operation`.
    pub fn get(&self, operation: Operation) -> u64 {
        self.0[operation as usize]
    }

    /// Each with its count.
    pub fn iter(&self) -> impl Iterator<Item = (Operation, u64)> {
        Operation::ALL.into_iter().zip(self.0)
    }
}
