//! Locally adaptive level of detail: a level chosen for each ray and each edge while it is traced (the paper's method).

mod image;
mod order;
mod packet;
mod trace;

pub use image::{LINE_LAYOUT, LineLayout, LodImage, NODE_BOUNDS, NODES, RECORDS, SPLITS, VERTICES};
pub use order::{LineOrder, morton_ranks};
use packet::PacketTrace;
pub use trace::LodTraverser;

use super::knob::{DELTA, ErrorKnob, octaves};
use super::packet::{PACKET, PacketOfQueries};
use super::{AllHits, ClosestHit, Departure, Knobs, Landing, Method, MethodUnit, Over, Registered, SurfaceHit, Trace, Tracer};
use crate::block::Operation;
use crate::format::{Scene, scene_prisms};
use crate::num::prism::Prisms;
use crate::rays::{ModelSpace, Query, Sight, is_full_detail};
use crate::step::{MemoryMap, NoSteps, StepSink};

/// The method.
pub static METHOD: Registered = Registered {
    name: "lod",
    help: "Locally adaptive level of detail",
    knobs: &[&DELTA, &LINE_LAYOUT, &NODE_BOUNDS, &PACKET],
    error: Some(ErrorKnob { knob: &DELTA, values: octaves, in_steps: false }),
    over: Over::Scene,
    unit: Some(MethodUnit {
        blocks: &[
            Operation::RaySetup,
            Operation::NodeAddress,
            Operation::ChildTest,
            Operation::LodTest,
            Operation::Tessellate,
            Operation::TriTest,
            Operation::HitDivide,
            Operation::HitSelect,
            Operation::BaryMap,
            Operation::TreeDeciders,
        ],
        has_levels: true,
    }),
    works: &[],
    make: |scene, knobs, _| Ok(Box::new(Lod::of(scene, knobs))),
};

/// The method on a scene.
struct Lod {
    scene: Scene,
    layout: LineLayout,
    /// Of the children of each split, if they bound them.
    prisms: Option<Vec<Prisms>>,
    /// Places of trees, if they have an order of their own.
    ranks: Option<Vec<u32>>,
    space: ModelSpace,
    /// Rays that are traced together.
    lanes: usize,
}

impl Lod {
    fn of(scene: &Scene, knobs: &Knobs) -> Self {
        // Checked when it was chosen.
        let layout = knobs.get(&LINE_LAYOUT).and_then(LineLayout::named).unwrap_or_default();
        let prisms = (knobs.get(&NODE_BOUNDS) == Some("prisms")).then(|| scene_prisms(scene));
        let ranks = (layout == LineLayout::Ordered(LineOrder::Morton)).then(|| morton_ranks(scene));
        let lanes = super::packet::chosen(knobs);
        Self { scene: scene.clone(), layout, prisms, ranks, space: ModelSpace::of(scene), lanes }
    }
}

impl Lod {
    fn image(&self) -> LodImage<'_> {
        let image = LodImage::with(&self.scene, self.layout);
        match &self.ranks {
            Some(ranks) => image.ranked_by(ranks),
            None => image,
        }
    }

    fn tracer_as<const COMPACT: bool, const FULL_DETAIL: bool>(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        let image = match &self.prisms {
            Some(prisms) => self.image().bounded_by(prisms),
            None => self.image(),
        };
        let (traverser, space, delta) = (LodTraverser::new(image), self.space, sight.delta);
        Box::new(LodTracer::<COMPACT, FULL_DETAIL> { traverser, space, delta, lanes: self.lanes, packet: PacketOfQueries::default() })
    }
}

impl Method for Lod {
    fn map(&self, _: &Sight) -> MemoryMap {
        self.image().map
    }

    fn alike(&self, sight: &Sight) -> Option<u64> {
        Some(sight.delta.to_bits())
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        match (self.scene.meta().vertices.is_compact(), is_full_detail(sight.delta)) {
            (true, true) => self.tracer_as::<true, true>(sight),
            (true, false) => self.tracer_as::<true, false>(sight),
            (false, true) => self.tracer_as::<false, true>(sight),
            (false, false) => self.tracer_as::<false, false>(sight),
        }
    }
}

/// Compiled for one form of inserted vertices, and for rays that tolerate nothing by itself: which it is is chosen once.
struct LodTracer<'a, const COMPACT: bool, const FULL_DETAIL: bool> {
    traverser: LodTraverser<'a>,
    space: ModelSpace,
    delta: f64,
    lanes: usize,
    packet: PacketOfQueries,
}

impl<const COMPACT: bool, const FULL_DETAIL: bool> Trace for LodTracer<'_, COMPACT, FULL_DETAIL> {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        let ray = self.space.enter(query, self.delta)?;
        let mut hit = ClosestHit::of(self.traverser.levels(), &ray, query.any);
        self.traverser.trace_as::<_, _, COMPACT, FULL_DETAIL, false>(&ray.ray, None, steps, &mut hit);
        hit.surface(&ray)
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        let ray = self.space.enter_from(query, from.map(|from| &from.start), self.delta)?;
        let mut hit = ClosestHit::of(self.traverser.levels(), &ray, query.any);
        match from {
            // Decisions of rays that tolerate nothing are the same by the rule for all.
            Some(_) => self.traverser.trace_as::<_, _, COMPACT, false, true>(&ray.ray, from, steps, &mut hit),
            None => self.traverser.trace_as::<_, _, COMPACT, FULL_DETAIL, false>(&ray.ray, None, steps, &mut hit),
        }
        hit.landing(&ray, |hit, corners| self.traverser.departure(&ray.ray, from, hit, corners))
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        if let Some(ray) = self.space.enter(query, self.delta) {
            let mut all = AllHits::of(self.traverser.levels(), &ray);
            self.traverser.trace_as::<_, _, COMPACT, FULL_DETAIL, false>(&ray.ray, None, &mut NoSteps, &mut all);
            all.surfaces(&ray, hits);
        }
        true
    }

    fn is_mapped(&self) -> bool {
        true
    }

    fn lanes(&self) -> usize {
        self.lanes
    }

    fn packet<S: StepSink>(&mut self, queries: &[Query], hits: &mut Vec<Option<SurfaceHit>>, steps: &mut S) {
        self.packet.enter(queries, &self.space, self.delta, self.traverser.levels());
        PacketTrace::<COMPACT, FULL_DETAIL>::run(self.traverser.image(), &mut self.packet.packet, steps);
        self.packet.hits(hits);
    }
}
