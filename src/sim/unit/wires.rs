//! What runs over the wires between contexts and blocks in one cycle.

use super::closest::Met;
use crate::block::{
    bary_map, child_test, hit_divide, hit_select, lod_test, lod_test_by, node_address, ray_setup, start_divide, start_setup, start_test,
    tessellate, tree_deciders,
};
use crate::hardware::Resource;
use crate::hardware::ports::{Corners, HitOut, MemoryAnswer, RayIn, SecondaryIn};
use crate::num::RayT;

/// What a division is for: the upper two bits of its tag.
pub const DIVIDE_FOR_T: u16 = 0;
pub const DIVIDE_FOR_V: u16 = 1;
pub const DIVIDE_FOR_W: u16 = 2;

/// The input side of a block in a cycle.
#[derive(Clone, Copy, Debug)]
pub struct Link<I> {
    /// `valid_i`, `in_i` and `tag_i`; all zero if nobody asks.
    pub input: Option<(I, u16)>,
    /// `ready_o`.
    pub ready: bool,
    /// The context whose input it is, if the arbiter chose it.
    pub winner: Option<usize>,
}

impl<I> Link<I> {
    /// The context whose request is taken in this cycle.
    pub fn granted(&self) -> Option<usize> {
        self.winner.filter(|_| self.ready)
    }
}

/// All inputs of blocks, from registers and the ports' inputs.
#[derive(Clone, Debug)]
pub struct Wires {
    /// The contexts that ask for each resource, one bit each.
    pub asking: [u64; Resource::COUNT],
    /// The context that takes a ray.
    pub take: Option<usize>,
    pub setup: Link<start_setup::In>,
    pub fetch: Link<node_address::In>,
    pub child: Link<child_test::In>,
    pub decide: Link<tree_deciders::In>,
    pub lod: Link<lod_test_by::In>,
    pub morph: Link<tessellate::In>,
    pub tri: Link<start_test::In>,
    pub divide: Link<start_divide::In>,
    /// The head of the hit queue goes to the division.
    pub queue_pop: bool,
    pub select: Link<hit_select::In>,
    pub map: Link<bary_map::In>,
    pub hit: Link<(HitOut, Corners)>,
}

impl Wires {
    /// The contexts whose requests are taken, in the order of `Resource::ALL`.
    pub fn granted(&self) -> [Option<usize>; Resource::COUNT] {
        let Self { setup, fetch, child, decide, lod, morph, tri, divide, map, hit, .. } = self;
        [
            setup.granted(),
            fetch.granted(),
            child.granted(),
            decide.granted(),
            lod.granted(),
            morph.granted(),
            tri.granted(),
            divide.granted(),
            map.granted(),
            hit.granted(),
        ]
    }
}

/// A resource as contexts see it: whose request it takes in this cycle, and whose result comes.
#[derive(Clone, Copy, Debug)]
pub struct Served<T> {
    pub granted: Option<usize>,
    pub result: Option<(usize, T)>,
}

impl<T> Served<T> {
    /// The request of context `me` is taken.
    pub fn granted(&self, me: usize) -> bool {
        self.granted == Some(me)
    }

    /// The result for context `me`.
    pub fn result(&self, me: usize) -> Option<&T> {
        self.result.as_ref().filter(|result| result.0 == me).map(|result| &result.1)
    }
}

/// A quotient and what was divided.
#[derive(Clone, Copy, Debug)]
pub struct Quotient {
    pub what: u16,
    pub out: hit_divide::Out,
}

/// What one cycle brings to the contexts.
#[derive(Clone, Debug)]
pub struct Cycle {
    pub ray: Option<(usize, RayIn)>,
    pub secondary: SecondaryIn,
    /// The scene is one for this hardware.
    pub fits: bool,
    /// Every ray under way ends.
    pub flush: bool,
    /// The limit of answers has passed since the last one.
    pub tick: bool,
    /// An age of ticks has passed since the last one.
    pub age: bool,
    pub setup: Served<ray_setup::Out>,
    /// Its results are memory lines.
    pub fetch: Served<MemoryAnswer>,
    pub child: Served<child_test::Out>,
    pub decide: Served<tree_deciders::Out>,
    pub lod: Served<lod_test::Out>,
    pub morph: Served<tessellate::Out>,
    pub tri: Served<start_test::Out>,
    pub divide: Served<Quotient>,
    /// With the hit that was compared, and its t.
    pub select: Served<(hit_select::Out, RayT, Met)>,
    pub map: Served<bary_map::Out>,
    pub hit: Served<()>,
}
