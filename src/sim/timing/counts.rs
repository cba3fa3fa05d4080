//! What a unit did, as the cycle model reports it.

use super::unit::UnitTiming;
use crate::block::Block;
use crate::block::bary_map::BaryMap;
use crate::block::child_test::ChildTest;
use crate::block::hit_select::HitSelect;
use crate::block::node_address::NodeAddress;
use crate::block::tessellate::Tessellate;
use crate::block::tree_deciders::TreeDeciders;
use crate::sim::unit::{Resource, State, UnitCounts};

impl<R> UnitTiming<R> {
    /// What it did in its first `cycles` cycles, behind which all contexts are idle. While rays are under way, the counts run ahead to where each is asked next.
    pub fn counts(&self, cycles: u64) -> UnitCounts {
        let counts = |resource: Resource| self.stations[resource as usize].counts();
        let mut blocks = vec![
            (self.fitted[0], counts(Resource::Setup)),
            (NodeAddress::NAME, counts(Resource::Fetch)),
            (ChildTest::NAME, counts(Resource::Child)),
            (self.fitted[1], counts(Resource::Lod)),
            (Tessellate::NAME, counts(Resource::Morph)),
            (self.fitted[2], counts(Resource::Tri)),
            (self.fitted[3], counts(Resource::Divide)),
            (HitSelect::NAME, self.select.counts()),
            (BaryMap::NAME, counts(Resource::Map)),
        ];
        if self.has_deciders {
            blocks.push((TreeDeciders::NAME, counts(Resource::Decide)));
        }
        let mut states = self.states;
        let busy: u64 = states.iter().sum();
        states[State::Idle as usize] = (cycles * self.contexts.len() as u64).saturating_sub(busy);
        UnitCounts { cycles, states, blocks, longest_queue: self.hits.longest() }
    }
}
