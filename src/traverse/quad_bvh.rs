//! The baseline: the full-resolution mesh under a quad-BVH with 16-bit or 32-bit boxes, built from the same blocks (paper section 6.1).

use super::children::bvh_children;
use super::lod::{is_beyond, push_sorted, quarter};
use super::stack::{Entry, Op, TraversalStack};
use super::{HitSink, TriangleId};
use crate::block::Block;
use crate::block::box_test32::{self, BoxTest32};
use crate::block::child_sort;
use crate::block::child_test::sort;
use crate::block::ray_setup::{self, RaySetup};
use crate::block::tri_test::{self, TriTest};
use crate::bvh::{BvhChild32, FullBvh, FullNodes, LINE_BYTES, Leaves};
use crate::format::{BvhChild, ChildRef};
use crate::num::{Point, Ray, U, Wire};
use crate::step::{Act, Fetch, MemoryMap, Section, SectionId, Step, StepSink, TriangleRun};
use std::ops::Range;

/// Nodes.
pub const NODES: SectionId = SectionId::new(0);
/// Triangles: index triples and vertices, packed triangles or triangle lines.
pub const LEAVES: SectionId = SectionId::new(1);

/// Traces rays through a full-resolution quad-BVH; keeps its stack from ray to ray.
pub struct BvhTraverser<'a> {
    levels: u32,
    nodes: &'a FullNodes,
    leaves: &'a Leaves,
    map: MemoryMap,
    stack: TraversalStack,
}

/// The memory of a full-resolution BVH.
pub fn bvh_map(bvh: &FullBvh) -> MemoryMap {
    let sections = [Section::of_bytes("bvh_node", bvh.nodes.bytes()), Section::of_bytes("leaf", bvh.leaves.bytes())];
    MemoryMap::new(&sections, node_lines(&bvh.nodes)).expect("at most 2^28 triangles, of at most eight lines each with their nodes")
}

/// Lines of a node.
fn node_lines(nodes: &FullNodes) -> u32 {
    match nodes {
        FullNodes::Boxes16(_) => 2,
        FullNodes::Boxes32(_) => 4,
    }
}

impl<'a> BvhTraverser<'a> {
    /// A traverser of `bvh`.
    pub fn new(bvh: &'a FullBvh) -> Self {
        Self { levels: bvh.levels, nodes: &bvh.nodes, leaves: &bvh.leaves, map: bvh_map(bvh), stack: TraversalStack::default() }
    }

    /// Number of splits N of the hierarchy below which the mesh lies.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Traces `ray`: every triangle met goes to `sink`, every step to `steps`.
    pub fn trace<S: StepSink, H: HitSink>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H) {
        self.trace_with(ray, steps, sink, |_| ());
    }

    /// The same; the slots of every leaf read go to `leaf` too.
    pub fn trace_with<S: StepSink, H: HitSink>(&mut self, ray: &Ray, steps: &mut S, sink: &mut H, mut leaf: impl FnMut(Range<usize>)) {
        let setup = RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction });
        self.stack.clear();
        let mut next = Some(Entry::default());
        loop {
            // A child just tested is not beyond the closest hit; an entry that waited may be by now.
            let Some(entry) = next.take().or_else(|| self.pop(steps, sink)) else {
                if self.stack.is_empty() {
                    break;
                }
                continue;
            };
            let index = entry.index.get() as usize;
            if entry.kind.get() == Entry::BVH_NODE {
                next = self.node(&setup, index, steps, sink);
            } else {
                // Leaves keep their count in `level`, which trees need and leaves do not.
                let slots = index..index + entry.level.get() as usize + 1;
                leaf(slots.clone());
                self.leaf(ray, slots, steps, sink);
            }
        }
        // A hit is one of the full resolution already.
        steps.step(Step::end(sink.found(), false));
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
    fn node<S: StepSink, H: HitSink>(&mut self, setup: &ray_setup::Out, index: usize, steps: &mut S, sink: &H) -> Option<Entry> {
        let t_max = sink.t_max();
        // Inner nodes and leaves have the kinds of their entries one lower.
        let waiting = |child: ChildRef| Entry {
            kind: U::new(child.kind.get() - 1),
            level: U::new(child.count.get()),
            index: child.index,
            ..Entry::default()
        };
        let lines = node_lines(self.nodes);
        let fetch = Fetch::new(NODES, self.map.line(NODES, u64::from(lines) * index as u64), lines);
        match self.nodes {
            FullNodes::Boxes16(nodes) => {
                let child = |k| quarter::<BvhChild>(&nodes[index], k);
                let tests = bvh_children(setup, t_max, &nodes[index]);
                steps.step(Step::on(fetch, Act::Children { met: tests.met() }).visiting());
                push_sorted(&mut self.stack, &tests, |k| waiting(child(k).child))
            }
            FullNodes::Boxes32(nodes) => {
                let child = |k| BvhChild32::from_words(&nodes[index][4 * k..4 * k + 4]);
                let mut tests = child_sort::In::default();
                for k in 0..4 {
                    let BvhChild32 { child, lo, hi } = child(k);
                    if child.kind.get() != ChildRef::EMPTY {
                        let test = BoxTest32::eval(&box_test32::In { ray: *setup, t_max, lo, hi });
                        (tests.hit[k], tests.t_near[k]) = (test.hit, test.t_near);
                    }
                }
                let tests = sort(&tests);
                steps.step(Step::on(fetch, Act::WideChildren { met: tests.met() }).visiting());
                push_sorted(&mut self.stack, &tests, |k| waiting(child(k).child))
            }
        }
    }

    /// Reads the leaf of the triangles in `slots` and tests them.
    #[inline(always)]
    fn leaf<S: StepSink, H: HitSink>(&mut self, ray: &Ray, slots: Range<usize>, steps: &mut S, sink: &mut H) {
        let mut place = 0;
        self.leaves.lines(slots.clone(), |address| {
            let fetch = Fetch::new(LEAVES, self.map.line(LEAVES, address / LINE_BYTES), 1).at(place);
            let first = place == 0;
            let fetch = if first { fetch } else { fetch.joining() };
            steps.step(Step { visits: first, ..Step::on(fetch, Act::Fetch) });
            place += 1;
        });
        let mut run = TriangleRun::default();
        for slot in slots {
            let (points, id) = self.leaves.triangle(slot);
            let [p0, p1, p2] = points.map(Point::from_i32);
            let test = TriTest::eval(&tri_test::In { origin: ray.origin, direction: ray.direction, p0, p1, p2 });
            run.add(test.hit, steps);
            if test.hit {
                let levels = self.levels;
                let (tree, node) = (id >> (2 * levels), id & ((1 << (2 * levels)) - 1));
                sink.offer(TriangleId { tree, level: levels, node }, &test);
            }
        }
        run.state(steps);
    }
}
