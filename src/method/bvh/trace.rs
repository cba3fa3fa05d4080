//! The baseline: the full-resolution mesh under a quad-BVH, built from the same blocks (paper section 6.1).

use super::map::{LEAVES, NODES, bvh_map, node_lines};
use crate::block::Block;
use crate::block::ray_setup::{self, RaySetup};
use crate::block::start_setup::{self, StartSetup};
use crate::block::start_test::{self, Below, StartTest};
use crate::block::tri_test::{self, TriTest};
use crate::bvh::BvhChild32;
use crate::format::{BvhChild, BvhNode, ChildRef, SixNode};
#[cfg(target_arch = "x86_64")]
use crate::method::children::has_lanes;
use crate::method::children::{bvh_children, coded_children, quarter, six_children, wide_children};
use crate::method::leave;
use crate::method::mesh_bvh::{FullBvh, FullNodes, Leaf, Leaves, cut_triangle};
use crate::method::stack::{Entry, Op, TraversalStack, push_nearest, push_sorted};
use crate::method::{Departure, Hit, HitSink, is_beyond};
use crate::num::{LINE_BYTES, Point, Ray, Rotation, Start, U, Wire};
use crate::step::{Act, Fetch, MemoryMap, NodeShape, Step, StepSink, TriangleRun};
use std::sync::Arc;

/// A ray in the frame that it was last turned into.
pub(super) struct Turned {
    rotation: u32,
    pub setup: ray_setup::Out,
}

/// The entry of a child that was met, but for its distance.
#[inline(always)]
pub(super) fn waiting(child: ChildRef) -> Entry {
    // Inner nodes and leaves have the kinds of their entries one lower.
    Entry { kind: U::new(child.kind.get() - 1), level: U::new(child.count.get()), index: child.index, ..Entry::default() }
}

impl Turned {
    /// A ray as it is.
    pub fn not(setup: &ray_setup::Out) -> Self {
        Self { rotation: 0, setup: *setup }
    }

    /// Turns `ray` into the frame of this number, and says whether it was in another one. The ray as it is is kept elsewhere, so number 0 turns nothing.
    #[inline(always)]
    pub fn turn(&mut self, rotation: u32, ray: &Ray) -> bool {
        let turns = rotation != 0 && rotation != self.rotation;
        if turns {
            let (origin, direction) = Rotation::numbered(rotation).ray(ray.origin, ray.direction);
            *self = Self { rotation, setup: RaySetup::eval(&ray_setup::In { origin, direction }) };
        }
        turns
    }
}

/// Traces rays through a BVH; keeps its stack from ray to ray.
pub struct BvhTraverser {
    pub(super) levels: u32,
    pub(super) nodes: Arc<FullNodes>,
    pub(super) leaves: Arc<Leaves>,
    map: MemoryMap,
    /// Lines of other BVHs before its own, in each section.
    before: [u64; 2],
    /// Its hits are on triangles of this level alone, which are those of the full resolution if nothing is finer.
    mapped: bool,
    stack: TraversalStack,
}

impl BvhTraverser {
    /// A traverser of `bvh`.
    pub fn new(bvh: &FullBvh) -> Self {
        let map = bvh_map(&[bvh]);
        Self {
            levels: bvh.levels,
            nodes: Arc::clone(&bvh.nodes),
            leaves: Arc::clone(&bvh.leaves),
            map,
            before: [0; 2],
            mapped: false,
            stack: TraversalStack::default(),
        }
    }

    /// A traverser of a `bvh` of coarse triangles: hits are mapped to the finest.
    pub(in crate::method) fn of_coarse(bvh: &FullBvh) -> Self {
        Self { mapped: true, ..Self::new(bvh) }
    }

    /// A traverser of `bvh` in a memory that has more sections behind those of the BVH.
    pub(in crate::method) fn within(bvh: &FullBvh, all: MemoryMap) -> Self {
        Self { map: all, ..Self::new(bvh) }
    }

    /// A traverser of a level's `bvh` in the memory `all` of the BVHs of all levels, behind those of `before`; hits are mapped to the finest.
    pub(in crate::method) fn behind(bvh: &FullBvh, all: MemoryMap, before: &MemoryMap) -> Self {
        let mut lines = [0; 2];
        before.sections().zip(&mut lines).for_each(|((_, section), lines)| *lines = section.lines);
        Self { map: all, before: lines, ..Self::of_coarse(bvh) }
    }

    /// Number of splits N of the hierarchy below which the mesh lies.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Its hits are on coarse triangles, and are mapped to the finest.
    pub fn is_mapped(&self) -> bool {
        self.mapped
    }

    /// Traces `ray` from its beginning to its end: every triangle met goes to `sink`, every step to `steps`.
    pub fn trace<S: StepSink, H: HitSink>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H) {
        self.trace_with(ray, steps, sink, |_| ());
    }

    /// Traces `ray` from the surface: its origin is the whole point of `departure.start`.
    pub fn trace_from<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: &Departure, steps: &mut S, sink: &mut H) {
        self.descend(ray, Some(departure), steps, sink);
        steps.step(Step::end(sink.found(), self.mapped));
    }

    /// Either without the ray's end: it may go on elsewhere.
    pub fn descend<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: Option<&Departure>, steps: &mut S, sink: &mut H) {
        match departure {
            Some(_) => self.trace_as::<S, H, _, true>(ray, departure, steps, sink, |_| ()),
            None => self.trace_as::<S, H, _, false>(ray, None, steps, sink, |_| ()),
        }
    }

    /// Where rays start that leave the surface at `hit`. All rays see one surface: none of them decides anything.
    pub fn departure(hit: &Hit, corners: &[Point; 3]) -> Departure {
        Departure { start: leave::start(corners, [hit.b0, hit.b1, hit.b2]), corners: *corners, prior: None, crowded: false, clear: 0 }
    }

    /// As [`BvhTraverser::trace`]; every leaf read goes to `leaf` too.
    pub fn trace_with<S: StepSink, H: HitSink, L: FnMut(&Leaf)>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H, leaf: L) {
        self.trace_as::<S, H, L, false>(ray, None, steps, sink, leaf);
        steps.step(Step::end(sink.found(), self.mapped));
    }

    /// The same without the ray's end, compiled for rays that have a departure if they are ones `LEAVING` a surface.
    #[inline(always)]
    fn trace_as<S: StepSink, H: HitSink, L: FnMut(&Leaf), const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        departure: Option<&Departure>,
        steps: &mut S,
        sink: &mut H,
        leaf: L,
    ) {
        #[cfg(target_arch = "x86_64")]
        if has_lanes() {
            #[target_feature(enable = "avx2,bmi1,bmi2")]
            fn lanes<S: StepSink, H: HitSink, L: FnMut(&Leaf), const LEAVING: bool>(
                by: &mut BvhTraverser,
                ray: &Ray,
                departure: Option<&Departure>,
                steps: &mut S,
                sink: &mut H,
                leaf: L,
            ) {
                by.run::<S, H, L, LEAVING>(ray, departure, steps, sink, leaf);
            }
            // SAFETY: the processor has them, as was just asked.
            return unsafe { lanes::<S, H, L, LEAVING>(self, ray, departure, steps, sink, leaf) };
        }
        #[cfg(target_arch = "x86_64")]
        self.without_lanes::<LEAVING>(ray, departure, steps, sink, &mut { leaf });
        #[cfg(not(target_arch = "x86_64"))]
        self.run::<S, H, L, LEAVING>(ray, departure, steps, sink, leaf);
    }

    /// By a processor without lanes, which few have: compiled once for all sinks.
    #[cfg(target_arch = "x86_64")]
    #[inline(never)]
    fn without_lanes<const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        departure: Option<&Departure>,
        mut steps: &mut dyn StepSink,
        mut sink: &mut dyn HitSink,
        leaf: &mut dyn FnMut(&Leaf),
    ) {
        self.run::<_, _, _, LEAVING>(ray, departure, &mut steps, &mut sink, leaf);
    }

    #[inline(always)]
    fn run<S: StepSink, H: HitSink, L: FnMut(&Leaf), const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        departure: Option<&Departure>,
        steps: &mut S,
        sink: &mut H,
        mut leaf: L,
    ) {
        let (start, setup) = match departure {
            Some(from) if LEAVING => {
                debug_assert_eq!(from.start.point, ray.origin);
                (from.start, StartSetup::eval(&start_setup::In { start: from.start, direction: ray.direction }))
            }
            _ => (Start::default(), RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction })),
        };
        let mut turned = Turned::not(&setup);
        self.stack.clear();
        let mut next = Some(Entry::default());
        loop {
            if sink.is_done() {
                break;
            }
            // A child just tested is not beyond the closest hit; an entry that waited may be by now.
            let Some(entry) = next.take().or_else(|| self.pop(steps, sink)) else {
                if self.stack.is_empty() {
                    break;
                }
                continue;
            };
            let index = entry.index.get() as usize;
            if entry.kind.get() == Entry::BVH_NODE {
                next = self.node::<S, H, LEAVING>(ray, &setup, &mut turned, index, steps, sink);
            } else {
                // Leaves keep their count in `level`, which trees need and leaves do not.
                let own = self.leaves.leaf(index, entry.level.get() as usize + 1);
                leaf(&own);
                self.leaf::<S, H, LEAVING>(ray, &start, &own, steps, sink);
            }
        }
    }

    /// Takes the next entry from the stack; `None` if there is none, or it lies behind the closest hit.
    #[inline(always)]
    fn pop<S: StepSink, H: HitSink>(&mut self, steps: &mut S, sink: &H) -> Option<Entry> {
        let entry = self.stack.step(Op::Pop)?;
        let dropped = is_beyond(entry.t_near, sink.t_max());
        steps.step(Step::of(Act::Pop { dropped }));
        (!dropped).then_some(entry)
    }

    #[inline(always)]
    fn node<S: StepSink, H: HitSink, const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        setup: &ray_setup::Out,
        turned: &mut Turned,
        index: usize,
        steps: &mut S,
        sink: &H,
    ) -> Option<Entry> {
        let t_max = sink.t_max();
        let fetch = self.fetch_node(index);
        match &*self.nodes {
            FullNodes::Local(nodes) => {
                let line = &nodes[index];
                let tests = bvh_children(setup, t_max, line);
                steps.step(Step::on(fetch, Act::Children { shape: NodeShape::Local, met: tests.met() }).visiting());
                push_sorted(&mut self.stack, &tests, |k| waiting(BvhNode::line_child(line, k)))
            }
            FullNodes::Boxes16(nodes) => {
                let child = |k| quarter::<BvhChild>(&nodes[index], k);
                let tests = coded_children(setup, t_max, &nodes[index]);
                steps.step(Step::on(fetch, Act::Children { shape: NodeShape::Plain, met: tests.met() }).visiting());
                push_sorted(&mut self.stack, &tests, |k| waiting(child(k).child))
            }
            FullNodes::Boxes32(nodes) => {
                let child = |k| BvhChild32::from_words(&nodes[index][4 * k..4 * k + 4]);
                let tests = wide_children::<LEAVING>(setup, t_max, &nodes[index]);
                steps.step(Step::on(fetch, Act::Children { shape: NodeShape::Wide, met: tests.met() }).visiting());
                push_sorted(&mut self.stack, &tests, |k| waiting(child(k).child))
            }
            FullNodes::Six(nodes) => {
                let node = SixNode::from_words(&nodes[index]);
                let turns = turned.turn(node.rotation.get() as u32, ray);
                let setup = if node.rotation == U::ZERO { setup } else { &turned.setup };
                let (tests, t_near) = six_children(setup, t_max, &node);
                let met = tests.count.get() as usize;
                let shape = if turns { NodeShape::Turned } else { NodeShape::Six };
                steps.step(Step::on(fetch, Act::Children { shape, met: met as u32 }).visiting()); // at most 6
                if turns {
                    steps.step(Step::of(Act::Work { work: 0, count: 1 }));
                }
                push_nearest(&mut self.stack, met, |place| {
                    let k = tests.order[place].get() as usize;
                    Entry { t_near: t_near[k], ..waiting(node.child(k)) }
                })
            }
        }
    }

    /// The lines of node `index`.
    #[inline(always)]
    pub(super) fn fetch_node(&self, index: usize) -> Fetch {
        let lines = node_lines(&self.nodes);
        Fetch::new(NODES, self.map.line(NODES, self.before[NODES.place()] + u64::from(lines) * index as u64), lines)
    }

    /// Reads the lines of a leaf.
    #[inline(always)]
    pub(super) fn fetch_leaf<S: StepSink>(&self, leaf: &Leaf, steps: &mut S) {
        let mut place = 0;
        self.leaves.lines(leaf, |address| {
            let fetch = Fetch::new(LEAVES, self.map.line(LEAVES, self.before[LEAVES.place()] + address / LINE_BYTES), 1).at(place);
            let first = place == 0;
            let fetch = if first { fetch } else { fetch.joining() };
            steps.step(Step { visits: first, ..Step::on(fetch, Act::Fetch) });
            place += 1;
        });
    }

    /// Reads a leaf and tests its triangles.
    #[inline(always)]
    fn leaf<S: StepSink, H: HitSink, const LEAVING: bool>(&mut self, ray: &Ray, start: &Start, leaf: &Leaf, steps: &mut S, sink: &mut H) {
        self.fetch_leaf(leaf, steps);
        let mut run = TriangleRun::default();
        self.leaves.triangles(leaf, |points, id| {
            let corners = points.map(Point::from_i32);
            let [p0, p1, p2] = corners;
            let start_test::Out { test, below } = if LEAVING {
                StartTest::eval(&start_test::In { start: *start, direction: ray.direction, p0, p1, p2 })
            } else {
                let input = tri_test::In { origin: ray.origin, direction: ray.direction, p0, p1, p2 };
                start_test::Out { test: TriTest::eval(&input), below: Below::default() }
            };
            run.add(test.hit, steps);
            if test.hit {
                sink.offer(cut_triangle(self.levels, id), &corners, &test, &below);
            }
        });
        run.state(steps);
    }
}
