//! What a unit did, as the cycle model reports it.

use super::unit::UnitTiming;
use crate::block::Block;
use crate::block::bary_map::BaryMap;
use crate::block::child_test::ChildTest;
use crate::block::hit_divide::HitDivide;
use crate::block::hit_select::HitSelect;
use crate::block::lod_test::LodTest;
use crate::block::node_address::NodeAddress;
use crate::block::ray_setup::RaySetup;
use crate::block::tessellate::Tessellate;
use crate::block::tri_test::TriTest;
use crate::sim::unit::{Resource, State, UnitCounts};

impl<R> UnitTiming<R> {
    /// What it did in its first `cycles` cycles, behind which all contexts are idle. While rays are under way, the counts run ahead to where each is asked next.
    pub fn counts(&self, cycles: u64) -> UnitCounts {
        let counts = |resource: Resource| self.stations[resource as usize].counts();
        let blocks = vec![
            (RaySetup::NAME, counts(Resource::Setup)),
            (NodeAddress::NAME, counts(Resource::Fetch)),
            (ChildTest::NAME, counts(Resource::Child)),
            (LodTest::NAME, counts(Resource::Lod)),
            (Tessellate::NAME, counts(Resource::Morph)),
            (TriTest::NAME, counts(Resource::Tri)),
            (HitDivide::NAME, counts(Resource::Divide)),
            (HitSelect::NAME, self.select.counts()),
            (BaryMap::NAME, counts(Resource::Map)),
        ];
        let mut states = self.states;
        let busy: u64 = states.iter().sum();
        states[State::Idle as usize] = (cycles * self.contexts.len() as u64).saturating_sub(busy);
        UnitCounts { cycles, states, blocks, longest_queue: self.hits.longest() }
    }
}
