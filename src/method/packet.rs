//! Packets of rays (paper section 4.4): up to 32 rays with one stack, which read each line once.
//!
//! A packet is the rays that enter the model of those that are traced together; the others are none of it. A node waits with the rays that met it, and with the least of their
//! distances: it is dropped when that lies behind the closest hits of all of them. Each ray tests boxes and triangles as it does alone, so it has the hits of the surface that
//! the packet sees, whatever way the packet takes; a packet of one ray takes that ray's steps.

use super::knob::Knob;
use super::stack::Entry;
use super::{ClosestHit, HitSink, SurfaceHit, TriangleId, is_beyond};
use crate::block::Block;
use crate::block::child_test;
use crate::block::ray_setup::{self, RaySetup};
use crate::block::start_test::Below;
use crate::block::tri_test::{self, TriTest};
use crate::num::{Point, Ray, RayT, TNear};
use crate::rays::{ModelRay, ModelSpace, Query};
use crate::step::{Act, MAX_RUN, Step, StepSink, TriangleRun};

/// Most rays of a packet: 32.
pub const MOST_LANES: usize = MAX_RUN as usize;

/// How many rays are traced together.
pub static PACKET: Knob = Knob {
    name: "packet",
    value_name: "RAYS",
    help: "Rays that are traced together, with one stack and one level of detail (default 1; the paper has 32, in tiles of 8 x 4 pixels); rays that start where others end go alone",
    default: Some("1"),
    words: &[],
    of_frame: false,
    allows: |value| match value.parse() {
        Ok(1..=32) => Ok(()),
        _ => Err(format!("'{value}' is not a number of rays from 1 to {MOST_LANES}")),
    },
};

/// How many rays were chosen.
pub fn chosen(knobs: &super::Knobs) -> usize {
    // Checked when it was chosen.
    knobs.get(&PACKET).and_then(|value| value.parse().ok()).unwrap_or(1)
}

/// Whether several rays are traced together.
pub fn takes_packets(knobs: &super::Knobs) -> bool {
    chosen(knobs) > 1
}

/// A ray of a packet.
pub(super) struct Lane<H> {
    pub ray: Ray,
    pub setup: ray_setup::Out,
    sink: H,
}

impl<H> Lane<H> {
    fn new(ray: &Ray, sink: H) -> Self {
        Self { ray: *ray, setup: RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction }), sink }
    }
}

/// A set of a packet's rays: bit k is the k-th.
pub(super) type Lanes = u32;

/// A node that waits, with the rays that met it.
#[derive(Clone, Copy)]
pub(super) struct Waiting {
    pub entry: Entry,
    pub lanes: Lanes,
}

/// The children of a node that some ray met: which rays, and the least of their distances.
#[derive(Default)]
pub(super) struct Met {
    lanes: [Lanes; 6],
    t_near: [TNear; 6],
}

impl Met {
    /// Ray `lane` met child `k` at `t_near`.
    #[inline(always)]
    pub fn add(&mut self, lane: usize, k: usize, t_near: TNear) {
        if self.lanes[k] == 0 || t_near < self.t_near[k] {
            self.t_near[k] = t_near;
        }
        self.lanes[k] |= 1 << lane;
    }

    /// The same of all children that it met.
    #[inline(always)]
    pub fn add_sorted(&mut self, lane: usize, tests: &child_test::Out) {
        for place in 0..tests.met() as usize {
            let k = tests.order[place].get() as usize;
            self.add(lane, k, tests.t_near[k]);
        }
    }

    /// How many children were met.
    pub fn count(&self) -> u32 {
        self.lanes.iter().filter(|&&lanes| lanes != 0).count() as u32 // at most 6
    }
}

/// Rays that are traced together; keeps its memory from packet to packet.
pub(super) struct Packet<H> {
    pub lanes: Vec<Lane<H>>,
    stack: Vec<Waiting>,
}

impl<H> Default for Packet<H> {
    fn default() -> Self {
        Self { lanes: Vec::new(), stack: Vec::new() }
    }
}

/// Queries that are traced together: those that enter the model as a packet.
#[derive(Default)]
pub(super) struct PacketOfQueries {
    pub packet: Packet<ClosestHit>,
    asked: usize,
    /// The rays of the packet in their model, with their places among the queries.
    rays: Vec<(usize, ModelRay)>,
}

impl PacketOfQueries {
    /// The rays of `queries` that enter a model of `levels` splits.
    pub fn enter(&mut self, queries: &[Query], space: &ModelSpace, delta: f64, levels: u32) {
        debug_assert!(queries.len() <= MOST_LANES);
        let Self { packet, asked, rays } = self;
        packet.stack.clear();
        packet.lanes.clear();
        rays.clear();
        *asked = queries.len();
        for (place, query) in queries.iter().enumerate() {
            let Some(ray) = space.enter(query, delta) else { continue };
            packet.lanes.push(Lane::new(&ray.ray, ClosestHit::of(levels, &ray, query.any)));
            rays.push((place, ray));
        }
    }

    /// Adds what each query met to `hits`, in their order.
    pub fn hits(&self, hits: &mut Vec<Option<SurfaceHit>>) {
        let first = hits.len();
        hits.resize(first + self.asked, None);
        for (lane, (place, ray)) in self.packet.lanes.iter().zip(&self.rays) {
            hits[first + place] = lane.sink.surface(ray);
        }
    }
}

impl<H: HitSink> Packet<H> {
    /// These rays, and who keeps what each of them meets.
    ///
    /// # Panics
    /// There are more than [`MOST_LANES`].
    pub fn of(rays: &[Ray], sinks: impl IntoIterator<Item = H>) -> Self {
        assert!(rays.len() <= MOST_LANES, "a packet has at most {MOST_LANES} rays");
        Self { lanes: rays.iter().zip(sinks).map(|(ray, sink)| Lane::new(ray, sink)).collect(), stack: Vec::new() }
    }

    /// Who kept what each of its rays met.
    pub fn into_sinks(self) -> Vec<H> {
        self.lanes.into_iter().map(|lane| lane.sink).collect()
    }

    /// Those of `lanes` that want more.
    #[inline(always)]
    fn living(&self, lanes: Lanes) -> Lanes {
        of(lanes).filter(|&lane| !self.lanes[lane].sink.is_done()).fold(0, |all, lane| all | 1 << lane)
    }

    /// Goes on from the root until nothing waits: `visit` does what a node asks for, and gives the child to go on with.
    pub fn walk<S: StepSink>(&mut self, steps: &mut S, mut visit: impl FnMut(&mut Self, Waiting, &mut S) -> Option<Waiting>) {
        let all = if self.lanes.is_empty() { 0 } else { u32::MAX >> (MAX_RUN - self.lanes.len() as u32) }; // at most 32
        let mut next = (all != 0).then(|| Waiting { entry: Entry::default(), lanes: all });
        loop {
            while let Some(waiting) = next {
                next = visit(self, waiting, steps);
            }
            if self.living(all) == 0 {
                break;
            }
            let Some(waiting) = self.stack.pop() else { break };
            let lanes = self.living(waiting.lanes);
            let dropped = of(lanes).all(|lane| is_beyond(waiting.entry.t_near, self.lanes[lane].sink.t_max()));
            steps.step(Step::of(Act::Pop { dropped }));
            next = (!dropped).then_some(Waiting { lanes, ..waiting });
        }
    }

    /// The children of a node that rays of `lanes` meet, by what `test` says of each of these.
    #[inline(always)]
    pub fn test(&self, lanes: Lanes, mut test: impl FnMut(usize, &Lane<H>, RayT, &mut Met)) -> Met {
        let mut met = Met::default();
        for lane in of(lanes) {
            let own = &self.lanes[lane];
            test(lane, own, own.sink.t_max(), &mut met);
        }
        met
    }

    /// Gives the nearest child that was met, to go on with, and pushes the others, farthest first, those of equal distance by number; `entry` makes the entry of child k but for its distance.
    pub fn push(&mut self, met: &Met, entry: impl Fn(usize) -> Entry) -> Option<Waiting> {
        let mut order: [usize; 6] = std::array::from_fn(|k| k);
        order.sort_by_key(|&k| (met.lanes[k] == 0, met.t_near[k]));
        let waiting = |k: usize| Waiting { entry: Entry { t_near: met.t_near[k], ..entry(k) }, lanes: met.lanes[k] };
        let count = met.count() as usize;
        self.stack.extend(order[..count].iter().skip(1).rev().map(|&k| waiting(k)));
        (count > 0).then(|| waiting(order[0]))
    }

    /// The rays of `lanes` test a triangle with these corners.
    #[inline(always)]
    pub fn triangle<S: StepSink>(&mut self, lanes: Lanes, id: TriangleId, corners: &[Point; 3], run: &mut TriangleRun, steps: &mut S) {
        let [p0, p1, p2] = *corners;
        for lane in of(lanes) {
            let Lane { ray, sink, .. } = &mut self.lanes[lane];
            let test = TriTest::eval(&tri_test::In { origin: ray.origin, direction: ray.direction, p0, p1, p2 });
            run.add(test.hit, steps);
            if test.hit {
                sink.offer(id, corners, &test, &Below::default());
            }
        }
    }
}

/// The numbers of the rays of a set.
#[inline(always)]
pub(super) fn of(lanes: Lanes) -> impl Iterator<Item = usize> {
    (0..MOST_LANES).filter(move |lane| lanes >> lane & 1 == 1)
}
