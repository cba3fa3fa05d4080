//! What a unit did so far, and what it is doing.

use super::TraversalUnit;
use super::context::Context;
use super::register::BlockCounts;
use crate::block::Block;
use crate::block::bary_map::BaryMap;
use crate::block::child_test::ChildTest;
use crate::block::hit_select::HitSelect;
use crate::block::node_address::NodeAddress;
use crate::block::tessellate::Tessellate;
use crate::block::tree_deciders::TreeDeciders;
use crate::hardware::State;

/// What a unit did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UnitCounts {
    /// Cycles.
    pub cycles: u64,
    /// Cycles of all contexts by [`State`].
    pub states: [u64; State::Done as usize + 1],
    /// What each block did, by name.
    pub blocks: Vec<(&'static str, BlockCounts)>,
    /// Most hits that waited for their division at once.
    pub longest_queue: usize,
}

impl UnitCounts {
    /// Adds what another unit did in the same cycles.
    pub fn add(&mut self, other: &Self) {
        self.cycles = self.cycles.max(other.cycles);
        self.longest_queue = self.longest_queue.max(other.longest_queue);
        self.states.iter_mut().zip(other.states).for_each(|(sum, more)| *sum += more);
        if self.blocks.is_empty() {
            self.blocks = other.blocks.iter().map(|&(name, _)| (name, BlockCounts::default())).collect();
        }
        for ((_, sum), (_, more)) in self.blocks.iter_mut().zip(&other.blocks) {
            sum.taken += more.taken;
            sum.refused += more.refused;
            sum.busy += more.busy;
            sum.occupancy += more.occupancy;
        }
    }
}

impl TraversalUnit {
    /// What it did so far.
    pub fn counts(&self) -> UnitCounts {
        let mut blocks = vec![
            self.ray_setup.counts(),
            (NodeAddress::NAME, self.node_address.counts()),
            (ChildTest::NAME, self.child_test.counts()),
            self.lod_test.counts(),
            (Tessellate::NAME, self.tessellate.counts()),
            self.tri_test.counts(),
            self.hit_divide.counts(),
            (HitSelect::NAME, self.hit_select.counts()),
            (BaryMap::NAME, self.bary_map.counts()),
        ];
        if self.hardware.has_deciders() {
            blocks.push((TreeDeciders::NAME, self.tree_deciders.counts()));
        }
        UnitCounts { cycles: self.cycles, states: self.states, blocks, longest_queue: self.longest_queue }
    }

    /// One line per context: its state and place.
    pub fn describe(&self) -> String {
        let line = |(k, c): (usize, &Context)| {
            format!(
                "context {k}: {:?}, ray {}, tree {} level {} node {}, lines wanted {:02b} waiting {:02b}, stack {}, triangles left {} pending {}\n",
                c.state,
                c.tag,
                c.tree.get(),
                c.level.get(),
                c.node.get(),
                c.want,
                c.waiting,
                c.stack.len(),
                c.left.get(),
                c.pending.get()
            )
        };
        self.contexts.iter().enumerate().map(line).collect::<String>() + &format!("hit queue: {}\n", self.queue.len())
    }
}
