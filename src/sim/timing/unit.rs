//! The unit: its contexts, arbiters, blocks and ports.

use super::context::ContextTiming;
use super::hits::HitQueue;
use super::phases::Watch;
use super::ports::{LineRequest, Ports, Steps, untag};
use super::station::Station;
use super::wheel::{Wheel, bits};
use crate::block::bary_map::BaryMap;
use crate::block::child_test::ChildTest;
use crate::block::hit_select::HitSelect;
use crate::block::node_address::NodeAddress;
use crate::block::tessellate::Tessellate;
use crate::block::tree_deciders::TreeDeciders;
use crate::block::{Operation, Operations, Timing};
use crate::hardware::{Eased, Hardware, MAX_CONTEXTS};
use crate::hardware::{Resource, State};
use crate::sim::unit::Arbiter;
use crate::step::NodeShape;
use std::collections::VecDeque;

/// A unit that takes rays as their steps.
///
/// Who drives it calls [`tick`](Self::tick) in every cycle that [`next`](Self::next) names, and in those in which a port that the unit waits for may move again: the
/// memory's or the hits' that refused, or the rays' that had none while [`is_ready`](Self::is_ready). A call in any other cycle does no harm. Cycles must come in order.
pub struct UnitTiming<R> {
    pub(super) contexts: Vec<ContextTiming<R>>,
    pub(super) wheel: Wheel,
    pub(super) arbiters: [Arbiter; Resource::COUNT],
    /// Who asks for each resource, and since when anybody does; resources that somebody asks for.
    pub(super) asking: [u64; Resource::COUNT],
    pub(super) since: [u64; Resource::COUNT],
    pub(super) asked: u32,
    /// By resource.
    pub(super) stations: [Station; Resource::COUNT],
    pub(super) select: Station,
    /// Names of its setup, its LOD test, its triangle test and its division.
    pub(super) fitted: [&'static str; 4],
    /// The test of a node, by its shape.
    pub(super) nodes: [Timing; NodeShape::ALL.len()],
    /// The hardware has a LOD test, one by other rays, and a map of hits.
    pub(super) chooses_levels: bool,
    pub(super) has_deciders: bool,
    pub(super) hit_mapping: bool,
    /// Lines of a split are asked for with the LOD test.
    pub(super) splits_early: bool,
    registers_results: bool,
    pub(super) idle: u64,
    /// Requests on their way through `node_address`, and since when.
    pub(super) requests: VecDeque<(u64, LineRequest)>,
    pub(super) hits: HitQueue,
    /// The hit port's register.
    pub(super) hit: Option<(R, bool)>,
    /// The first cycle without a tick.
    now: u64,
    next: Option<u64>,
    /// Cycles of contexts by state, but for `IDLE`.
    pub(super) states: [u64; State::ALL.len()],
    /// Of them, those in which a context waited for lines that were asked for with an earlier step's.
    pub(super) late: [u64; State::ALL.len()],
    /// Cycles in `FETCH` that no line ended: all had come when the last was asked for.
    pub(super) port_cycles: u64,
    /// The wait that the line ended that came last, from when to when, if it did.
    pub(super) line_wait: Option<(u64, u64)>,
    /// What contexts have had the blocks do, counted as each act begins.
    pub(super) operations: Operations,
    /// How full its parts are.
    pub(super) watch: Watch,
}

impl<R: Steps> UnitTiming<R> {
    /// A unit behind its reset.
    ///
    /// # Panics
    /// There is no such hardware ([`Hardware::validate`]).
    pub fn new(config: Hardware) -> Self {
        config.validate().unwrap_or_else(|error| panic!("{error}"));
        let node = |shape: NodeShape| {
            let facts = shape.facts();
            let timing = |&(operation, _): &(Operation, u32)| operation.timing(&config.form());
            if let [alone] = facts.path {
                return config.linked(timing(alone));
            }
            let latency: u32 = facts.path.iter().map(|step| timing(step).latency).sum();
            // Where boxes go through fewer tests than there are, each pass but the first takes a cycle more, and so does the next node.
            let interval = config.boxes_per_cycle.passes(facts.children);
            config.linked(Timing { latency: latency + interval - 1, interval })
        };
        let fitted = |operation| Timing { interval: config.interval(operation), ..config.block(operation).timing(&config.form()) };
        let timing = |resource| match resource {
            Resource::Setup => config.linked(fitted(Operation::RaySetup)),
            Resource::Fetch => config.timing::<NodeAddress>(),
            Resource::Child => config.linked(config.timing::<ChildTest>()),
            Resource::Decide => config.linked(config.timing::<TreeDeciders>()),
            Resource::Lod => config.linked(fitted(Operation::LodTest)),
            Resource::Morph => config.linked(config.timing::<Tessellate>()),
            Resource::Tri => config.linked(fitted(Operation::TriTest)),
            Resource::Divide => config.linked(fitted(Operation::HitDivide)),
            Resource::Map => config.linked(config.timing::<BaryMap>()),
            Resource::Hit => Timing::pipelined(1),
        };
        Self {
            contexts: (0..config.contexts).map(|_| ContextTiming::idle()).collect(),
            wheel: Wheel::new(),
            arbiters: Default::default(),
            asking: Default::default(),
            since: Default::default(),
            asked: 0,
            stations: Resource::ALL.map(|resource| Station::new(timing(resource))),
            fitted: [Operation::RaySetup, Operation::LodTest, Operation::TriTest, Operation::HitDivide].map(|of| config.block(of).name()),
            select: Station::new(config.timing::<HitSelect>()),
            nodes: NodeShape::ALL.map(node),
            chooses_levels: config.chooses_levels(),
            has_deciders: config.has_deciders(),
            hit_mapping: config.hit_mapping,
            splits_early: false,
            registers_results: config.registers_results(),
            idle: u64::MAX >> (MAX_CONTEXTS - config.contexts),
            requests: VecDeque::new(),
            hits: HitQueue::default(),
            hit: None,
            now: 0,
            next: None,
            states: Default::default(),
            late: Default::default(),
            port_cycles: 0,
            line_wait: None,
            operations: Operations::default(),
            watch: Watch::default(),
        }
    }

    /// The same unit with what is eased.
    pub fn easing(mut self, eased: Eased) -> Self {
        for resource in Resource::ALL.into_iter().filter(|&resource| eased.has(resource)) {
            self.stations[resource as usize] = self.stations[resource as usize].clone().eased();
        }
        if eased.has_latency() {
            // A request's way to the port is none to a result.
            for resource in Resource::ALL.into_iter().filter(|&resource| resource != Resource::Fetch) {
                self.stations[resource as usize] = self.stations[resource as usize].clone().at_once();
            }
            self.nodes = self.nodes.map(Timing::at_once);
        }
        self.splits_early = eased.has_split_lines();
        self
    }

    /// What its rays have had the blocks do so far.
    pub fn operations(&self) -> &Operations {
        &self.operations
    }

    /// A context is idle: a ray would be taken.
    pub fn is_ready(&self) -> bool {
        self.idle != 0
    }

    /// The request that the memory port offers in cycle `now`.
    pub fn request(&self, now: u64) -> Option<LineRequest> {
        let latency = self.stations[Resource::Fetch as usize].latency();
        self.requests.front().filter(|(taken, _)| taken + latency <= now).map(|request| request.1)
    }

    /// The ray whose hit the hit port offers in the next tick's cycle, and whether it met anything.
    pub fn hit(&self) -> Option<(&R, bool)> {
        self.hit.as_ref().map(|(ray, found)| (ray, *found))
    }

    /// The next cycle that needs a [`tick`](Self::tick) if nothing comes and no port that refused moves before; `None`: only then.
    #[inline]
    pub fn next(&self) -> Option<u64> {
        self.next
    }

    /// The line of request `tag` comes in cycle `now`, before or behind that cycle's tick; no other does in this cycle. [`next`](Self::next) may be sooner then.
    /// Gives from when to when a context waited that goes on with it, if one does.
    #[inline]
    pub fn answer(&mut self, now: u64, tag: u16) -> Option<(u64, u64)> {
        debug_assert!(now + 1 >= self.now, "an answer of cycle {now} comes too late");
        let (who, place) = untag(tag);
        self.now = self.now.max(now);
        self.answered(who, place, now + u64::from(self.registers_results));
        self.next = self.next.into_iter().chain(self.wheel.next(self.now)).min();
        self.line_wait.take()
    }

    /// Cycles by state in which contexts waited for lines, other than `FETCH`; and cycles in `FETCH` that no line ended.
    pub fn line_waits(&self) -> ([u64; State::ALL.len()], u64) {
        (self.late, self.port_cycles)
    }

    /// Cycle `now`; gives the [`next`](Self::next).
    ///
    /// # Panics
    /// A cycle that needed a tick was left out, or a ray's steps are none that a traversal takes.
    pub fn tick<P: Ports<Ray = R>>(&mut self, now: u64, ports: &mut P) -> Option<u64> {
        assert!(now >= self.now && self.next.is_none_or(|next| now <= next), "cycle {now}: was to be ticked in {:?}", self.next);
        self.now = now + 1;
        self.watch(now);
        for who in bits(self.wheel.wake(now)) {
            self.ask(who, now);
        }

        let latency = self.stations[Resource::Fetch as usize].latency();
        let is_wide = self.stations[Resource::Fetch as usize].is_eased();
        let mut memory_waits = false;
        while let Some(request) = self.request(now) {
            memory_waits = !ports.request(request);
            if memory_waits {
                break;
            }
            if let Some((taken, _)) = self.requests.pop_front() {
                self.stations[Resource::Fetch as usize].inside(taken, now);
            }
            if !is_wide {
                break;
            }
        }
        let hit_waits = self.hit.as_ref().is_some_and(|(ray, found)| !ports.hit(ray, *found));
        if !hit_waits {
            self.hit = None;
        }
        let mut another = false;
        if self.idle != 0
            && let Some(ray) = ports.ray()
        {
            self.take(ray, now);
            another = self.idle != 0;
        }

        for resource in bits(u64::from(self.asked)).map(|k| Resource::ALL[k]) {
            let eased = self.stations[resource as usize].is_eased();
            loop {
                let ready = match resource {
                    Resource::Fetch => eased || self.requests.len() < latency as usize,
                    Resource::Hit => !hit_waits,
                    Resource::Divide if self.hits.head().is_some_and(|since| since <= now) => false,
                    _ => self.stations[resource as usize].free() <= now,
                };
                if ready {
                    self.grant(resource, now);
                }
                if !(ready && eased) || self.asking[resource as usize] == 0 {
                    break;
                }
            }
        }
        while self.divide_hit(now) {}

        self.next = if another { Some(now + 1) } else { self.goes_on(now, memory_waits, hit_waits) };
        self.next
    }

    /// The next cycle behind `now` in which anything happens of itself.
    fn goes_on(&self, now: u64, memory_waits: bool, hit_waits: bool) -> Option<u64> {
        let soon = now + 1;
        let mut next = self.wheel.next(soon);
        if next == Some(soon) || self.hit.is_some() && !hit_waits {
            return Some(soon);
        }
        let mut at = |cycle: u64| next = Some(next.map_or(cycle, |next| next.min(cycle)).max(soon));
        let latency = self.stations[Resource::Fetch as usize].latency();
        for resource in bits(u64::from(self.asked)).map(|k| Resource::ALL[k]) {
            match resource {
                // Full, it moves with its first request, below.
                Resource::Fetch if self.requests.len() >= latency as usize && !self.stations[resource as usize].is_eased() => (),
                Resource::Hit if hit_waits => (),
                _ => at(self.stations[resource as usize].free()),
            }
        }
        if let Some(since) = self.hits.head() {
            at(since.max(self.stations[Resource::Divide as usize].free()));
        }
        if let Some((taken, _)) = self.requests.front().filter(|_| !memory_waits) {
            at(taken + latency);
        }
        next
    }
}
