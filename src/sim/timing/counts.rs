//! What a unit did, as the cycle model reports it.

use super::phases::{PARTS, Phases};
use super::station::Station;
use super::unit::UnitTiming;
use crate::block::Block;
use crate::block::bary_map::BaryMap;
use crate::block::child_test::ChildTest;
use crate::block::hit_select::HitSelect;
use crate::block::node_address::NodeAddress;
use crate::block::tessellate::Tessellate;
use crate::block::tree_deciders::TreeDeciders;
use crate::hardware::Resource;
use crate::sim::unit::{State, UnitCounts};

impl<R> UnitTiming<R> {
    /// What it did in its first `cycles` cycles, behind which all contexts are idle. While rays are under way, the counts run ahead to where each is asked next.
    pub fn counts(&self, cycles: u64) -> UnitCounts {
        let blocks = self.named().into_iter().map(|(name, _, station)| (name, station.counts())).collect();
        let mut states = self.states;
        let busy: u64 = states.iter().sum();
        states[State::Idle as usize] = (cycles * self.contexts.len() as u64).saturating_sub(busy);
        UnitCounts { cycles, states, blocks, longest_queue: self.hits.longest() }
    }
}

impl<R> UnitTiming<R> {
    /// Ends the stretches that ended in cycle `now` or before.
    #[inline]
    pub(super) fn watch(&mut self, now: u64) {
        while self.watch.end() <= now {
            let end = self.watch.end();
            let loaded = self.loaded(end);
            self.watch.close(end, loaded);
        }
    }

    /// Cycles before `end` in which each part could take nothing; it has taken nothing since.
    fn loaded(&self, end: u64) -> [u64; PARTS] {
        std::array::from_fn(|k| self.stations.get(k).unwrap_or(&self.select).loaded(end))
    }

    /// How full its parts were in its first `cycles` cycles, behind which all contexts are idle.
    pub fn phases(&self, cycles: u64) -> Phases {
        let mut watch = self.watch.clone();
        while watch.end() <= cycles {
            watch.close(watch.end(), self.loaded(watch.end()));
        }
        if watch.since < cycles {
            watch.close(cycles, self.loaded(cycles));
        }
        let parts = self.named().into_iter().map(|(name, at, _)| (name, watch.parts[at])).collect();
        Phases { cycles, parts }
    }

    /// Its blocks: name, place among what is watched, and times.
    pub(super) fn named(&self) -> Vec<(&'static str, usize, &Station)> {
        let of = |name, resource: Resource| (name, resource as usize, &self.stations[resource as usize]);
        let mut all = vec![
            of(self.fitted[0], Resource::Setup),
            of(NodeAddress::NAME, Resource::Fetch),
            of(ChildTest::NAME, Resource::Child),
            of(self.fitted[1], Resource::Lod),
            of(Tessellate::NAME, Resource::Morph),
            of(self.fitted[2], Resource::Tri),
            of(self.fitted[3], Resource::Divide),
            (HitSelect::NAME, Resource::COUNT, &self.select),
            of(BaryMap::NAME, Resource::Map),
        ];
        if self.has_deciders {
            all.push(of(TreeDeciders::NAME, Resource::Decide));
        }
        all
    }
}
