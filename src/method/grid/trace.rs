//! Rays through grid primitives, while-while (paper section 2.2): one loop goes down the BVH over the primitives, another through the tree of each primitive that is met.
//!
//! The stack holds the number of a node alone, so each visit of a node reads all six vertices of its four triangles, by their final indices, and the four radii. Lines that a visit
//! needs more than once it asks for once, all together.

use super::asked::{Lines, ask, is_heard};
use super::binary::PairNode;
use super::caps::Caps;
use super::children::{Shot, children};
use super::mesh::{GridMesh, NODES};
use super::pattern::{LeafPattern, first_of_depth};
use super::sphere::{SphereRay, in_t};
use super::top::Top;
use super::tuple::Tuple;
use super::works::{INDEX, PAIR};
use crate::block::Block;
use crate::block::box_test32::{self, BoxTest32};
use crate::block::ray_setup::{self, RaySetup};
use crate::block::start_setup::{self, StartSetup};
use crate::block::start_test::{self, Below, StartTest};
use crate::block::tri_test::{self, TriTest};
use crate::format::{BvhNode, ChildRef, SixNode};
#[cfg(target_arch = "x86_64")]
use crate::method::children::has_lanes;
use crate::method::children::{bvh_children, six_children};
use crate::method::stack::{Entry, Op, TraversalStack, push_nearest, push_sorted};
use crate::method::{Departure, HitSink, TriangleId, is_beyond};
use crate::num::{Point, Ray, Start, U, Vec3, Wire};
use crate::step::{Act, Fetch, NodeShape, Step, StepSink, TriangleRun};
use std::sync::Arc;

/// A node of a primitive's tree that waits.
#[derive(Clone, Copy, Debug, Default)]
struct Waiting {
    /// No hit in its bounds lies before.
    near: f64,
    /// Breadth first.
    node: u16,
    depth: u8,
}

/// Most nodes of a primitive's tree that wait: three of each level.
const MOST_WAITING: usize = 3 * 4 + 1;

/// Traces rays through grid primitives; keeps its stack from ray to ray.
pub struct GridTraverser {
    mesh: Arc<GridMesh>,
    caps: Caps,
    /// By cap.
    leaves: Vec<LeafPattern>,
    /// Some hits are on triangles of coarser levels.
    mapped: bool,
    stack: TraversalStack,
    points: Vec<Point>,
}

impl GridTraverser {
    /// A traverser of `mesh` with these caps.
    pub fn new(mesh: Arc<GridMesh>, caps: Caps) -> Self {
        let splits = mesh.pattern.splits;
        let leaves = (0..=splits).map(|cap| mesh.pattern.leaves(cap.min(mesh.bounded), cap)).collect();
        let mapped = match &caps {
            Caps::Frame(cap) => *cap < splits,
            Caps::Each(caps) => caps.iter().any(|&cap| u32::from(cap) < splits),
        };
        Self { mesh, caps, leaves, mapped, stack: TraversalStack::default(), points: Vec::new() }
    }

    /// Some of its hits are on coarse triangles, and are mapped to the finest.
    pub fn is_mapped(&self) -> bool {
        self.mapped
    }

    /// Traces `ray` from its beginning to its end: every triangle met goes to `sink`, every step to `steps`.
    pub fn trace<S: StepSink, H: HitSink>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H) {
        self.descend(ray, None, steps, sink);
        steps.step(Step::end(sink.found(), self.mapped));
    }

    /// Traces `ray` from the surface: its origin is the whole point of `departure.start`.
    pub fn trace_from<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: &Departure, steps: &mut S, sink: &mut H) {
        self.descend(ray, Some(departure), steps, sink);
        steps.step(Step::end(sink.found(), self.mapped));
    }

    /// Either without the ray's end: it may go on elsewhere.
    pub fn descend<S: StepSink, H: HitSink>(&mut self, ray: &Ray, departure: Option<&Departure>, steps: &mut S, sink: &mut H) {
        match departure {
            Some(_) => self.trace_as::<S, H, true>(ray, departure, steps, sink),
            None => self.trace_as::<S, H, false>(ray, None, steps, sink),
        }
    }

    /// The same, compiled for rays that have a departure if they are ones `LEAVING` a surface.
    #[inline(always)]
    fn trace_as<S: StepSink, H: HitSink, const LEAVING: bool>(&mut self, ray: &Ray, from: Option<&Departure>, steps: &mut S, sink: &mut H) {
        #[cfg(target_arch = "x86_64")]
        if has_lanes() {
            #[target_feature(enable = "avx2,bmi1,bmi2")]
            fn lanes<S: StepSink, H: HitSink, const LEAVING: bool>(
                by: &mut GridTraverser,
                ray: &Ray,
                from: Option<&Departure>,
                steps: &mut S,
                sink: &mut H,
            ) {
                by.run::<S, H, LEAVING>(ray, from, steps, sink);
            }
            // SAFETY: the processor has them, as was just asked.
            return unsafe { lanes::<S, H, LEAVING>(self, ray, from, steps, sink) };
        }
        #[cfg(target_arch = "x86_64")]
        self.without_lanes::<LEAVING>(ray, from, steps, sink);
        #[cfg(not(target_arch = "x86_64"))]
        self.run::<S, H, LEAVING>(ray, from, steps, sink);
    }

    /// By a processor without lanes, which few have: compiled once for all sinks.
    #[cfg(target_arch = "x86_64")]
    #[inline(never)]
    fn without_lanes<const LEAVING: bool>(
        &mut self,
        ray: &Ray,
        from: Option<&Departure>,
        mut steps: &mut dyn StepSink,
        mut sink: &mut dyn HitSink,
    ) {
        self.run::<_, _, LEAVING>(ray, from, &mut steps, &mut sink);
    }

    #[inline(always)]
    fn run<S: StepSink, H: HitSink, const LEAVING: bool>(&mut self, ray: &Ray, from: Option<&Departure>, steps: &mut S, sink: &mut H) {
        let (start, setup) = match from {
            Some(from) if LEAVING => {
                debug_assert_eq!(from.start.point, ray.origin);
                (from.start, StartSetup::eval(&start_setup::In { start: from.start, direction: ray.direction }))
            }
            _ => (Start::default(), RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction })),
        };
        let shot = Shot { ray, start, setup, spheres: SphereRay::new(ray.origin, ray.direction) };
        self.stack.clear();
        let mesh = Arc::clone(&self.mesh);
        let mut next = self.root(steps);
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
                next = self.node::<S, H, LEAVING>(&shot, index, steps, sink);
            } else {
                self.primitive::<S, H, LEAVING>(&mesh, &shot, index, steps, sink);
            }
        }
    }

    /// The root; of nodes of two, which hold their own boxes, its line is read first.
    #[inline(always)]
    fn root<S: StepSink>(&self, steps: &mut S) -> Option<Entry> {
        let Top::Two(nodes) = &self.mesh.top else { return Some(Entry::default()) };
        steps.step(Step::on(Fetch::new(NODES, self.mesh.map().line(NODES, 0), 1), Act::Fetch));
        Some(of_pair(nodes, 0))
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
        shot: &Shot<'_>,
        index: usize,
        steps: &mut S,
        sink: &H,
    ) -> Option<Entry> {
        let t_max = sink.t_max();
        let mesh = &*self.mesh;
        // Inner nodes and leaves have the kinds of their entries one lower.
        let waiting = |child: ChildRef| Entry { kind: U::new(child.kind.get() - 1), index: child.index, ..Entry::default() };
        let line = |node: usize, lines: u32| Fetch::new(NODES, mesh.map().line(NODES, u64::from(lines) * node as u64), lines);
        match &mesh.top {
            Top::Four(nodes) => {
                let own = &nodes[index];
                let tests = bvh_children(&shot.setup, t_max, own);
                steps.step(Step::on(line(index, 1), Act::Children { shape: NodeShape::Local, met: tests.met() }).visiting());
                push_sorted(&mut self.stack, &tests, |k| waiting(BvhNode::line_child(own, k)))
            }
            Top::Six(nodes) => {
                let own = SixNode::from_words(&nodes[index]);
                let (tests, t_near) = six_children(&shot.setup, t_max, &own);
                let met = tests.count.get() as usize;
                steps.step(Step::on(line(index, 2), Act::Children { shape: NodeShape::Six, met: met as u32 }).visiting()); // at most 6
                push_nearest(&mut self.stack, met, |place| {
                    let k = tests.order[place].get() as usize;
                    Entry { t_near: t_near[k], ..waiting(own.child(k)) }
                })
            }
            Top::Two(nodes) => {
                // What was read of the node with its box says where its right child is.
                let children = [index + 1, index + 1 + nodes[index].skip as usize];
                steps.step(Step::on(line(children[0], 1), Act::Fetch).visiting());
                steps.step(Step::on(line(children[1], 1).joining(), Act::Fetch));
                steps.step(Step::of(Act::Work { work: PAIR, count: 1 }));
                let tests = children.map(|at| {
                    let bounds = nodes[at].bounds;
                    let [lo, hi] = [bounds.lo, bounds.hi].map(Point::from_i32);
                    // What is ahead of a start is ahead of its whole point, if the box reaches as far down as the start's fraction can.
                    let lo = if LEAVING { Vec3::new(lo.x.get() - 1, lo.y.get() - 1, lo.z.get() - 1) } else { lo };
                    BoxTest32::eval(&box_test32::In { ray: shot.setup, t_max, lo, hi })
                });
                let entry = |k: usize| Entry { t_near: tests[k].t_near, ..of_pair(nodes, children[k]) };
                match tests.map(|test| test.hit) {
                    [false, false] => None,
                    [true, false] => Some(entry(0)),
                    [false, true] => Some(entry(1)),
                    [true, true] => {
                        let first = usize::from(tests[1].t_near < tests[0].t_near);
                        self.stack.step(Op::Push(entry(1 - first)));
                        Some(entry(first))
                    }
                }
            }
        }
    }

    /// Goes through the tree of a primitive.
    #[inline(always)]
    fn primitive<S: StepSink, H: HitSink, const LEAVING: bool>(
        &mut self,
        mesh: &GridMesh,
        shot: &Shot<'_>,
        primitive: usize,
        steps: &mut S,
        sink: &mut H,
    ) {
        steps.step(Step::on(mesh.tuple_fetch(primitive), Act::Fetch).visiting());
        let tuple = *mesh.tuple(primitive);
        let cap = self.caps.of(primitive) as usize;
        let end = self.leaves[cap].depth;
        let mut stack = [Waiting::default(); MOST_WAITING];
        let mut count = 0;
        let mut next = Some(Waiting::default());
        loop {
            let waiting = match next.take() {
                Some(waiting) => waiting,
                None if count == 0 || sink.is_done() => break,
                None => {
                    count -= 1;
                    let waiting = stack[count];
                    let dropped = waiting.near > in_t(sink.t_max());
                    steps.step(Step::of(Act::Pop { dropped }));
                    if dropped {
                        continue;
                    }
                    waiting
                }
            };
            let (node, depth) = (usize::from(waiting.node), u32::from(waiting.depth));
            if depth == end {
                self.leaf::<S, H, LEAVING>(mesh, shot, (primitive, &tuple), cap, node - first_of_depth(depth), steps, sink);
                if sink.is_done() {
                    break;
                }
                continue;
            }
            // At most four, nearest first.
            let (children, met) = children(mesh, shot, primitive, &tuple, node, steps, sink);
            for &(near, k) in children[..met].iter().skip(1).rev() {
                stack[count] = Waiting { near, node: (4 * node + 1 + k) as u16, depth: depth as u8 + 1 }; // at most 340 nodes
                count += 1;
            }
            next = children[..met].first().map(|&(near, k)| Waiting { near, node: (4 * node + 1 + k) as u16, depth: depth as u8 + 1 });
        }
    }

    /// Reads the vertices of a node at which the tree ends, and tests its triangles.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a ray, a place in the structure, and who is told")]
    fn leaf<S: StepSink, H: HitSink, const LEAVING: bool>(
        &mut self,
        mesh: &GridMesh,
        shot: &Shot<'_>,
        (primitive, tuple): (usize, &Tuple),
        cap: usize,
        node: usize,
        steps: &mut S,
        sink: &mut H,
    ) {
        let pattern = &self.leaves[cap];
        let vertices = pattern.vertices(node);
        if is_heard::<S>() {
            let mut lines = Lines::new();
            vertices.iter().for_each(|&vertex| ask(mesh, primitive, tuple, vertex, &mut lines));
            steps.step(Step::of(Act::Work { work: INDEX, count: vertices.len() as u32 })); // at most 153
            lines.state(true, steps);
        }
        self.points.clear();
        self.points.extend(vertices.iter().map(|&vertex| Point::from_i32(mesh.vertex(primitive, tuple, vertex))));
        let (tree, of_level) = mesh.ids[primitive];
        let below = 2 * pattern.splits;
        let first = ((of_level << (2 * pattern.depth)) | node as u32) << below; // as many as the hierarchy has
        let level = mesh.levels - mesh.pattern.splits + cap as u32; // at most 4
        let mut run = TriangleRun::default();
        for (k, places) in (0..).zip(&pattern.triangles) {
            let corners = places.map(|at| self.points[usize::from(at)]);
            let [p0, p1, p2] = corners;
            let start_test::Out { test, below } = if LEAVING {
                StartTest::eval(&start_test::In { start: shot.start, direction: shot.ray.direction, p0, p1, p2 })
            } else {
                let input = tri_test::In { origin: shot.ray.origin, direction: shot.ray.direction, p0, p1, p2 };
                start_test::Out { test: TriTest::eval(&input), below: Below::default() }
            };
            run.add(test.hit, steps);
            if test.hit {
                sink.offer(TriangleId { tree, level, node: first | k }, &corners, &test, &below);
            }
        }
        run.state(steps);
    }
}

/// The entry of a node of two children but for its distance.
#[inline(always)]
fn of_pair(nodes: &[PairNode], at: usize) -> Entry {
    let node = &nodes[at];
    let (kind, index) = if node.skip == 0 { (Entry::TREE, node.leaf as usize) } else { (Entry::BVH_NODE, at) };
    Entry { kind: U::new(kind), index: U::new(index as u64), ..Entry::default() }
}
